#!/usr/bin/env bash
# Command lines: help, version, statuses, the log; and that the clock is in no document.
# shellcheck source=tests/support/tap.sh disable=SC2317 # functions called by name
. tests/support/tap.sh

tools=(nsd-gen nsd-detect nsd-solve nsd-move nsd-step nsd-err nsd-info nsd-cat nsd-view)
step() { nsd-step "$@" 2>/dev/null; }

stock heap20 >"$tmp/heap.h5"
nsd-detect "$tmp/heap.h5" >"$tmp/contacts.h5"

# ---- help and version ----

for tool in "${tools[@]}"; do
    status 0 "$tool --help" "$tool" --help
    help=$(<"$tmp/out")
    is "says nothing on stderr" "$(cat "$tmp/err")" ""
    like "begins with how to use it" "$help" "^usage: $tool "
    like "names the manual" "$help" "man $tool"
    is "has no line longer than 100 characters" "$(awk 'length > 100' "$tmp/out")" ""
    # an option with an argument either has its default in brackets or is off without it
    grep -o '^  *\(-., \)\?--[a-z-]* [^ ]*[A-Z|][^ ]*' "$tmp/out" | grep -o -e '--[a-z-]*' >"$tmp/options" || true
    while read -r option; do
        case $option in
        --newton-abs | --log | --fclib) continue ;;
        esac
        like "$tool $option: the default is in brackets" "$(grep -A 2 -e "$option " <<<"$help" | tr '\n' ' ')" '\[[^]]+\]'
    done <"$tmp/options"
    refuses 64 "$tool --help=x" "$tool" --help=x
    status 0 "$tool --version" "$tool" --version
    is "$tool -V is --version, -h --help" "$("$tool" -V; "$tool" -h)" "$(cat "$tmp/out"; "$tool" --help)"
    like "says the version" "$(cat "$tmp/out")" "^$tool \(nsd\) [0-9]+\.[0-9]+$"
done
all() { for t in tools/nsd-*; do basename "$t" .c; done; } # tests/project/docs.t compares their manuals with --help
words() # of a completion: the long options
{
    grep -v '^ *#' "$1" | sed 's/\[.*\]//' | grep -oE -e '[ {,(:]--[a-z0-9-]+' -e "'--[a-z0-9-]+" | grep -o -e '--.*' | sort -u
}
for tool in $(all); do
    "$tool" --help | sed -n '/^Examples/q; s/^ *\(-., \)\{0,1\}\(--[a-z0-9-]*\).*/\2/p' | sort -u >"$tmp/options"
    for shell in bash zsh; do
        status 0 "$tool --completion $shell" "$tool" --completion $shell
        is "has the options of --help, and no other" "$(words "$tmp/out" | grep -v -x -e --completion)" "$(<"$tmp/options")"
    done
    refuses 64 "$tool --completion of another shell" "$tool" --completion fish
    is "$tool has -h, -V and -o" "$("$tool" --help | grep -c -E '^  -(h, --help|V, --version|o, --output) ')" 3
done
# -j has one default, and 0 of it is refused
for tool in $(all); do
    "$tool" --help | grep -q -e '-j, --threads' || continue
    like "$tool -j" "$("$tool" --help | grep -e '-j, ')" '\[1\]$'
    refuses 64 "$tool -j 0" "$tool" -j 0
done
while read -r line; do
    read -r tool option near <<<"$line"
    refuses 64 "$tool $option" "$tool" "$option" 1
    like "names the nearest" "$(head -1 "$tmp/err")" "^$tool: ${option%%=*}: no such option${near:+; did you mean $near\\?}\$"
done <<'END'
nsd-gen --verison --version
nsd-step --stpes=3 --steps
nsd-solve --critreion --criterion
nsd-cat --strem --stream
nsd-fit --tiemout --timeout
nsd-step --foo
nsd-err --foo
END
# names of version 1
while read -r tool was is; do
    refuses 64 "$tool --$was" "$tool" "--$was" 1
    like "names the new one" "$(head -1 "$tmp/err")" "^$tool: --$was: now called --$is\$"
    is "and does not have the old one" "$("$tool" --help | grep -c -e "--${was}[ =]")" 0
done <<'END'
nsd-step global solver
nsd-step method local
nsd-solve method local
nsd-step paper protocol=paper
nsd-step newton-eps newton-tolerance
nsd-cat steps frames
nsd-export steps frames
nsd-info steps frames
nsd-stat steps frames
nsd-web steps frames
nsd-view cut clip
END
solve() { nsd-solve "$@" "$tmp/contacts.h5" 2>/dev/null | nsd-cat; }
while read -r was is; do # scripts that others keep have them
    ok "nsd-solve --$was is --$is" cmp <(solve "--$was") <(solve "--$is")
done <<'END'
global=nlgs solver=nlgs
overlap=keep overlap-rule=keep
eps=1e-3 tolerance=1e-3
END
ok "nsd-view --boundaries is --walls" cmp <(nsd-view --size 64x64 --boundaries lines "$tmp/heap.h5" 2>/dev/null) <(nsd-view --size 64x64 --walls lines "$tmp/heap.h5" 2>/dev/null)
ok "nsd-export --part boundary is --part walls" cmp <(nsd-export -t csv -p boundary "$tmp/heap.h5") <(nsd-export -t csv -p walls "$tmp/heap.h5")
is "nsd-view --surface rub is sliding_work" "$(nsd-view --surface rub "$tmp/heap.h5" 2>&1 >/dev/null)" "$(nsd-view --surface sliding_work "$tmp/heap.h5" 2>&1 >/dev/null)"
is "which --help has, not the former words" "$(for t in view export; do "nsd-$t" --help; done | grep -cwE 'rub|boundary|boundaries')" 0
ok "nsd-step --sums is --wall-loads" cmp <(step -n 2 --sums "$tmp/heap.h5") <(step -n 2 --wall-loads "$tmp/heap.h5")
walls() { nsd-step -n 1 --with "tee $tmp/told$1 | jq -c --unbuffered '{}'" "$1" all "$tmp/heap.h5" >/dev/null 2>&1 && cat "$tmp/told$1"; }
ok "--with-boundaries is --with-walls, with the former keys" cmp <(walls --with-boundaries | jq -c '.walls = .boundaries | .walls[] |= (.wall = .boundary | del(.boundary)) | del(.boundaries)' | jq -cS) <(walls --with-walls | jq -cS)
is "of which a program reads some" "$(walls --with-boundaries | jq '.boundaries | length > 0')" true
ok "nsd-info -p is -b with the former keys" cmp <(nsd-info -p "$tmp/heap.h5" | jq -c '[.id, .radius, .mass, .x, .v, .w, .q]') <(nsd-info -b "$tmp/heap.h5" | jq -c '[.id, .radius, .mass, .position, .velocity, .angular_velocity, .orientation]')
is "and -b has no others" "$(nsd-info -b "$tmp/heap.h5" | head -1 | jq -c 'keys_unsorted')" '["step","id","material","radius","mass","position","velocity","angular_velocity","orientation"]'
is "neither is in --help" "$(nsd-step --help | grep -c -e '--sums' -e '--with-boundaries')" 0
refuses 64 "the beginning of several options" nsd-step --max 3
like "names them" "$(head -1 "$tmp/err")" ': --max: .*: --max-sweeps, --max-seconds$'
refuses 64 "an argument to an option without one" nsd-step --in-place=3
like "names the option" "$(head -1 "$tmp/err")" ': --in-place: takes no argument$'
refuses 64 "an unknown measure" nsd-stat -m energy,sterss "$tmp/heap.h5"
like "names the nearest" "$(head -1 "$tmp/err")" "no 'sterss'; did you mean stress\\?"
echo '{"dt": 0.1, "gravity": [0, 0, -9.81], "bodies": [{"x": [0.30000000000000004, 1e-5, -3], "radius": 1e22}]}' | nsd-gen - >"$tmp/digits.h5"
like "JSON has the fewest digits that are read as the same number" "$(nsd-info -p "$tmp/digits.h5") $(nsd-info "$tmp/digits.h5")" \
    '"radius":1e\+22,.*"x":\[0.30000000000000004,1e-05,-3.0\].*"dt":0.1,.*"gravity":\[0.0,0.0,-9.81\]'
is "nsd-info says what a document is" "$(nsd-info "$tmp/contacts.h5" | jq -r 'select(.frames).type')" packing
# times with a unit; --every without one is of steps, others of seconds
while read -r one other; do
    IFS=, read -ra ones <<<"$one"
    IFS=, read -ra others <<<"$other"
    is "$one is $other" "$(step "${ones[@]}" "$tmp/heap.h5" | nsd-info | jq -c 'select(.step != null) | [.step, .time]')" \
        "$(step "${others[@]}" "$tmp/heap.h5" | nsd-info | jq -c 'select(.step != null) | [.step, .time]')"
done <<'END'
-n40,--every=0.5ms -n40,--every=0.0005s
--until=0.032 --until=32ms
-n2,--dt=1e-4 -n2,--dt=0.1ms
-n2,--max-seconds=600 -n2,--max-seconds=10min
END
step -n 40 "$tmp/heap.h5" >"$tmp/forty.h5"
shown() { nsd-web --every "$1" "$tmp/forty.h5" -o "$tmp/page.html" && grep -o '"s":[0-9]*' "$tmp/page.html" | tr '\n' ' '; }
drawn() { rm -f "$tmp"/f0*.png && nsd-view --every "$1" --size 16x16 -o "$tmp/f%03d.png" "$tmp/forty.h5" 2>/dev/null && find "$tmp" -name 'f0*.png' | wc -l; }
ten=$(nsd-info "$tmp/forty.h5" | jq -n '[inputs.dt // empty][0] * 10')s
is "nsd-view draws the first frame, and one per time" "$(drawn "$ten")" 5
is "or every tenth" "$(drawn 10)" 4
is "nsd-web shows those at or after multiples of a time, and the first" "$(shown "$ten")" '"s":601 "s":610 "s":620 "s":630 "s":640 '
is "or every tenth" "$(shown 10)" '"s":601 "s":611 "s":621 "s":631 '
for wrong in 1x 0s 1.5; do
    refuses 64 "nsd-web --every $wrong" nsd-web --every $wrong "$tmp/heap.h5"
    refuses 64 "nsd-view --every $wrong" nsd-view --every $wrong -o "$tmp/f%03d.png" "$tmp/heap.h5"
done
refuses 64 "nsd-fit --timeout 1x" nsd-fit --timeout 1x none.json
for wrong in --until=1x --until=ms --progress=0 --save=-1s --dt=1x --max-seconds=1d --every=1d --every=0ms --every=1.5; do
    refuses 64 "$wrong" nsd-step "$wrong" -o "$tmp/none.h5" "$tmp/heap.h5"
done
ok "bash reads what it is to complete with" bash -n <(nsd-step --completion bash)
mentions() # tool option default
{
    "$1" --help | tr '\n' ' ' | grep -q -e "$2[ ,].*$3"
}
while read -r tool option default; do
    ok "$tool --help has $option $default" mentions "$tool" "$option" "$default"
done <<'END'
nsd-gen --dim \[3\]
nsd-detect --gap \[0\]
nsd-detect --theta 0\.5\]
nsd-detect --overlap-rule keep|gap|push|project|gap-project.*project\]
nsd-detect --fclib local|global
nsd-solve --local auto|sbp|.*\[auto\]
nsd-solve --solver auto|nlgs|.*\[nlgs with -m
nsd-solve --max-seconds .
nsd-solve --tolerance \[1; 1e-10 for FCLIB\]
nsd-solve --criterion glob|scaled|natural|velocity.*\[velocity; natural for FCLIB\]
nsd-solve --max-sweeps \[5000
nsd-solve --alpha \[1\.75
nsd-solve --newton plain|linesearch.*\[linesearch\]
nsd-solve --newton-tolerance \[1e-13\]
nsd-solve --newton-max \[100\]
nsd-solve --relax \[1\]
nsd-solve --order \[natural for nlgs
nsd-solve --theta \[
nsd-solve --warm \[
nsd-solve --history .
nsd-solve --threads \[1\]
nsd-solve --log .
nsd-solve --strict .
nsd-step --steps \[1\]
nsd-step --every \[1\]
nsd-step --contacts .
nsd-step --warm .
nsd-step --output \[standard output\]
nsd-info --frames \[all\]
nsd-info --last .
nsd-cat --frames \[all\]
nsd-cat --last .
nsd-view --step \[last frame\]
nsd-view --colour radius|speed|material|id.*\[radius\]
nsd-view --camera \[30,15\]
nsd-view --samples \[3\]
nsd-view --plain .
END

# ---- the command line ----

solve() { nsd-solve "$@" 2>/dev/null; }
ok "options may stand behind the operands" cmp <(solve -m sbp "$tmp/contacts.h5") <(solve "$tmp/contacts.h5" -m sbp)
ok "-msbp and --local=sbp are the same" cmp <(solve -msbp "$tmp/contacts.h5") <(solve --local=sbp "$tmp/contacts.h5")
ok "the last of two wins" cmp <(solve -m sbp -m eal "$tmp/contacts.h5") <(solve -m eal "$tmp/contacts.h5")
status 0 "-- ends the options" nsd-info -- "$tmp/heap.h5"
cp "$tmp/contacts.h5" "$tmp/-e"
dash() { (cd "$tmp" && nsd-info -- -e); }
ok "so that a file may be called -e" dash

solve -m eal --max-sweeps 77 --tolerance 1e-9 "$tmp/contacts.h5" >"$tmp/solved.h5"
ok "the document's history has the options given" jq -e -s '.[0].history[-1].options ==
    {local: "eal", tolerance: 1e-9, "max-sweeps": 77}' <(nsd-info "$tmp/solved.h5")
is "and the command before, and the one before that" \
    "$(nsd-info "$tmp/solved.h5" | jq -c -s '.[0].history | map(.command)')" \
    '["nsd-gen","nsd-step","nsd-detect","nsd-solve"]'

# ---- statuses ----

status 0 "a problem that converges: 0" nsd-solve -e "$tmp/contacts.h5"
is "one line on stderr" "$(wc -l <"$tmp/err")" 1
like "sums it up" "$(cat "$tmp/err")" '^nsd-solve: .*contacts.h5: [0-9]+ contacts, auto: [0-9]+ sweeps, velocity [0-9.e-]+, '
status 0 "one that does not: 0" nsd-solve --tolerance 1e-3 --max-sweeps 1 "$tmp/contacts.h5"
mv "$tmp/out" "$tmp/lenient.h5"
like "with a warning" "$(cat "$tmp/err")" 'velocity [0-9.e-]+, [0-9.e-]+ s: NOT CONVERGED to 0.001$'
for e in -e --strict; do
    status 1 "and 1 under $e" nsd-solve $e --tolerance 1e-3 --max-sweeps 1 "$tmp/contacts.h5"
    like "with a warning" "$(cat "$tmp/err")" 'NOT CONVERGED'
    ok "and the document is written, the same" cmp "$tmp/out" "$tmp/lenient.h5"
done
ok "the report has it" jq -e -s '.[-1].converged == false' <(nsd-info "$tmp/lenient.h5")
status 0 "nsd-step that does not converge: 0" nsd-step -n 3 --tolerance 1e-3 --max-sweeps 1 "$tmp/heap.h5"
like "with a warning" "$(cat "$tmp/err")" '3 steps NOT CONVERGED, the first is step 601; the largest velocity is [0-9.e-]+, not 0.001'
status 1 "and 1 under -e" nsd-step -e -n 3 --tolerance 1e-3 --max-sweeps 1 "$tmp/heap.h5"
is "which ends with the first such step" "$(nsd-info "$tmp/out" | jq -c -n '[inputs | select(.step != null).step]')" "[601]"
status 1 "and 1 under -e --keep-going" nsd-step -e --keep-going -n 3 --tolerance 1e-3 --max-sweeps 1 "$tmp/heap.h5"
is "and all frames are written" "$(nsd-info "$tmp/out" | jq -c -n '[inputs | select(.step != null).step]')" "[601,602,603]"
cat "$tmp/contacts.h5" "$tmp/contacts.h5" >"$tmp/two.h5"
status 0 "nsd-solve -e of two problems" nsd-solve -e "$tmp/two.h5"
is "one line for both" "$(wc -l <"$tmp/err")" 1
status 1 "nsd-solve -e of two problems not converged" nsd-solve -e --tolerance 1e-3 --max-sweeps 1 "$tmp/two.h5"
is "both are written" "$(nsd-info "$tmp/out" | jq -s '[.[] | select(.frames)] | length')" 2

# ---- defaults, and the paper's: contacts that are found without gaps ----

nsd-detect --overlap-rule keep "$tmp/heap.h5" >"$tmp/keep.h5"
asked() { nsd-info "$1" | jq -c 'select(.options).options | [.solver, .local, .criterion, .tolerance, .max_sweeps, .order, .relax, .warm]'; }
paper='["nlgs","sbp","glob",1e-10,5000,"natural",1,false]'
solve --protocol paper -m sbp "$tmp/keep.h5" >"$tmp/paper.h5"
is "--protocol paper is the paper's protocol" "$(asked "$tmp/paper.h5")" "$paper"
is "the report has the method" "$(nsd-info --last "$tmp/paper.h5" | jq -r .method)" sbp
step -n 1 -m sbp --protocol paper "$tmp/heap.h5" >"$tmp/paper.h5"
is "of nsd-step too" "$(asked "$tmp/paper.h5")" "$paper"
while read -r want options; do
    for line in "--protocol paper -m sbp $options" "$options -m sbp --protocol paper"; do
        # shellcheck disable=SC2086 # words
        is "nsd-solve $line: what is given wins" "$(solve $line "$tmp/keep.h5" | asked -)" "$want"
    done
done <<'END'
["nlgs","sbp","natural",1e-09,7,"colour",1.5,true] --criterion natural --tolerance 1e-9 --max-sweeps 7 --order colour --relax 1.5 --warm
["auto","sbp","glob",1e-10,5000,"natural",1,false] --solver auto
END
for line in "" "-m auto" "--solver nlgs"; do
    # shellcheck disable=SC2086 # words
    refuses 64 "nsd-solve --protocol paper $line" nsd-solve --protocol paper $line --log "$tmp/solve.log" "$tmp/keep.h5"
    like "needs a method" "$(cat "$tmp/err")" '^nsd-solve: --protocol paper: needs a local method, -m sbp\|sal\|ebp\|eal\|exact'
    ok "and leaves the log alone" [ ! -e "$tmp/solve.log" ]
done
refuses 64 "nsd-step --protocol paper" nsd-step --protocol paper "$tmp/heap.h5"
# What --help has in brackets is what goes: nsd's choice for a packing
bracket() { nsd-solve --help | tr '\n' ' ' | grep -o -e "--$1 [^]]*\]" | sed 's/.*\[//; s/[];,].*//; s/ for nlgs//; s/ nlgs//'; }
solve -m sbp "$tmp/contacts.h5" >"$tmp/usual.h5"
for key in criterion tolerance max-sweeps order relax newton newton-tolerance newton-max; do
    is "the default in --help's brackets goes: --$key" "$(nsd-info "$tmp/usual.h5" |
        jq -r "select(.options).options.\"${key/-/_}\"")" "$(bracket $key)"
done

# ---- the log ----

keys='step time contacts sweeps eps_glob motion proj bipotential penetration max_penetration newton seconds'
nsd-solve -m eal --log "$tmp/solve.log" "$tmp/two.h5" >/dev/null 2>&1
step -m eal -n 5 --log "$tmp/step.log" "$tmp/heap.h5" >/dev/null
for log in solve:2 step:5; do
    is "nsd-${log%:*} --log writes one line a solve" "$(wc -l <"$tmp/${log%:*}.log")" "${log#*:}"
    for key in $keys; do
        ok "nsd-${log%:*} --log: each line has the number $key" \
            jq -e -n "[inputs.$key | numbers] | length == ${log#*:}" "$tmp/${log%:*}.log"
    done
done
is "in the order of the steps" "$(jq -c -n '[inputs.step]' "$tmp/step.log")" "[601,602,603,604,605]"
step -m eal -n 5 "$tmp/heap.h5" >"$tmp/five.h5"
row='select(.sweeps != null) | [.step, .sweeps, .eps_glob, .contacts]'
ok "and has what the document has" cmp <(jq -c "$row" "$tmp/step.log") <(nsd-info "$tmp/five.h5" | jq -c "$row")
refuses 74 "a log that cannot be opened: 74" nsd-step --log "$tmp/missing/log" "$tmp/heap.h5"
status 74 "a log that cannot be written: 74" nsd-step --log /dev/full "$tmp/heap.h5"
nsd-solve --history "$tmp/contacts.h5" >"$tmp/history.h5" 2>/dev/null
is "--history keeps the terms of every sweep" "$(nsd-info --history "$tmp/history.h5" | wc -l)" \
    "$(nsd-info "$tmp/history.h5" | jq -s '.[-1].sweeps')"
ok "the last of them is the report's" jq -e -s '.[0].eps_glob == .[1].eps_glob' \
    <(nsd-info --history --last "$tmp/history.h5" | tail -n 1) <(nsd-info "$tmp/history.h5" | tail -n 1)

# ---- the clock ----

run()
{
    nsd-gen 20 >"$1.gen"
    nsd-detect "$tmp/heap.h5" >"$1.detect"
    nsd-detect --fclib=global "$tmp/heap.h5" >"$1.fclib"
    solve --history --log "$1.log" "$tmp/contacts.h5" >"$1.solve"
    nsd-move "$1.solve" >"$1.move"
    step -n 5 --contacts --log "$1.log" "$tmp/heap.h5" >"$1.step"
    step -n 5 --contacts -j 2 "$tmp/heap.h5" | cat >"$1.stream"
    nsd-cat "$1.stream" >"$1.cat"
    nsd-info "$1.stream" >"$1.info"
    nsd-err "$1.stream" >"$1.err"
    nsd-view "$1.stream" >"$1.view" 2>/dev/null
}
run "$tmp/now"
sleep 1.1
run "$tmp/later"
for what in gen detect fclib solve move step stream cat info err view; do
    ok "$what: a second later the bytes are the same" cmp "$tmp/now.$what" "$tmp/later.$what"
done
ok "threads and logs are in no document" cmp "$tmp/now.cat" "$tmp/now.step"
elsewhere()
{
    cp "$tmp/heap.h5" "$tmp/renamed.h5" && (cd / && TZ=Asia/Tokyo LC_ALL=C.UTF-8 nsd-detect "$tmp/renamed.h5")
}
status 0 "a document from elsewhere, and from another time zone" elsewhere
ok "has the same bytes" cmp "$tmp/out" "$tmp/now.detect"

done_testing
