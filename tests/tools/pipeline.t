#!/usr/bin/env bash
# The tools together: what flows through the pipes is right, whole, and the same every time.
# shellcheck source=tests/support/tap.sh
. tests/support/tap.sh

methods=(sbp sal ebp eal exact)
orders=(natural reverse random colour)
frames=300
[ -z "$thin" ] || frames=60

step() { nsd-step "$@" 2>/dev/null; }
solve() { nsd-solve "$@" 2>/dev/null; }

# Packings with contacts: 20 balls in a heap, 4 of the paper's example 2, 20 discs
stock heap20 >"$tmp/heap.h5"
stock heap4 >"$tmp/four.h5"
nsd-gen -d 2 20 |
    step -n 600 --every 600 --tolerance 1e-8 |
    nsd-cat --last >"$tmp/discs.h5"
nsd-detect "$tmp/heap.h5" >"$tmp/contacts.h5"
like "the heap has settled: more contacts than balls" \
    "$(nsd-info "$tmp/contacts.h5" | jq -r 'select(.step != null).contacts > 20')" true

# ---- as issue 2 has them ----

long() { nsd-gen 500 | nsd-step -m ebp -n $frames >"$tmp/long.h5"; }
status 0 "gen 500 | step -m ebp > out.h5 runs" long
is "and every step is in the file" "$(h5ls "$tmp/long.h5/particles/all/position" | grep ^value)" \
    "value                    Dataset {$frames/Inf, 500, 3}"
last()
{
    nsd-gen 500 |
        nsd-step -m sbp -n $frames --every $frames |
        nsd-cat --last |
        nsd-detect >"$tmp/last.h5" && h5dump -n "$tmp/last.h5"
}
status 0 "gen 500 | step -m sbp | cat --last | detect > contacts.h5 is a file for h5dump" last
like "with contacts in it" "$(cat "$tmp/out")" /contacts/frame
again() { nsd-solve -m eal <"$tmp/contacts.h5" >"$tmp/solved.h5" && nsd-err "$tmp/solved.h5" | jq .natural; }
status 0 "solve -m eal < contacts.h5 > solved.h5, nsd-err solved.h5 | jq .natural" again
ok "gives a number at most 1e-4" jq -e '. <= 1e-4' "$tmp/out"
columns()
{
    nsd-info "$tmp/long.h5" |
        jq -r 'select(.step != null) | [.step, .contacts, .sweeps, .eps_glob, .max_penetration] | @tsv'
}
is "nsd-info | jq | @tsv gives five numbers a step" \
    "$(columns | awk -F'\t' '/^[0-9.eE\t-]+$/ && NF == 5' | wc -l)" $frames
is "with the steps in order" "$(columns | cut -f1)" "$(seq $frames)"

# ---- one step: by its parts and as a whole ----

parts() { nsd-detect "$1" | solve -m "$2" | nsd-move >"$tmp/parts.h5"; }
for m in "${methods[@]}"; do
    for from in four heap discs; do
        parts "$tmp/$from.h5" "$m"
        step -m "$m" -n 1 "$tmp/$from.h5" | cat >"$tmp/whole.h5"
        ok "$m, $from: detect | solve | move and step -n 1 give the same bits" \
            same_particles "$tmp/parts.h5" "$tmp/whole.h5"
    done
done

two()
{
    nsd-detect --theta 0.7 "$tmp/heap.h5" |
        solve |
        nsd-move |
        nsd-detect |
        solve |
        nsd-move >"$tmp/parts.h5"
    step -n 2 --solver auto --theta 0.7 "$tmp/heap.h5" | nsd-cat --last >"$tmp/whole.h5"
    same_particles "$tmp/parts.h5" "$tmp/whole.h5"
}
ok "two steps with another theta, too" two

# ---- streams and trajectories ----

gen() { step -n 30 --tolerance 1e-8 "$@" "$tmp/heap.h5"; }
for option in --cold --contacts --warm --every=7; do
    gen $option >"$tmp/trajectory.h5"
    gen $option | cat >"$tmp/stream.h5"
    nsd-cat <"$tmp/stream.h5" >"$tmp/packed.h5"
    ok "$option: stream | nsd-cat > f and > f give the same bytes" cmp "$tmp/trajectory.h5" "$tmp/packed.h5"
    for what in -p -w ''; do
        info() { nsd-info $what "$1" | jq -c 'select(.step != null)'; }
        ok "$option: nsd-info $what shows the same of the stream and of the trajectory" \
            cmp <(info "$tmp/trajectory.h5") <(info "$tmp/stream.h5")
    done
    nsd-cat "$tmp/trajectory.h5" | cat >"$tmp/unpacked.h5"
    frame_count=$(nsd-info "$tmp/stream.h5" | jq -n '[inputs | select(.frames)] | length')
    is "$option: nsd-cat makes a stream of it again, a document a frame" \
        "$(nsd-info "$tmp/unpacked.h5" | jq -n '[inputs | select(.frames)] | length')" "$frame_count"
    ok "$option: of the same bodies and moments" cmp <(nsd-info -p "$tmp/stream.h5") <(nsd-info -p "$tmp/unpacked.h5")
done
gen --contacts >"$tmp/trajectory.h5"
gen --contacts | cat >"$tmp/stream.h5"
ok "contacts are the same in a stream and in a trajectory" \
    cmp <(nsd-info -c "$tmp/trajectory.h5") <(nsd-info -c "$tmp/stream.h5")
nsd-cat --frames 610:615 "$tmp/trajectory.h5" >"$tmp/cut.h5"
is "a cut trajectory has the steps asked for" \
    "$(nsd-info "$tmp/cut.h5" | jq -n -c '[inputs | select(.step != null).step]')" \
    "[610,611,612,613,614,615]"

# ---- same bytes ----

ok "the same seed gives the same bytes" cmp <(nsd-gen 500) <(nsd-gen 500)
other() { ! cmp <(jq '.seed = 2' scenes/paper/example3.json | nsd-gen -) <(nsd-gen scenes/paper/example3.json); }
ok "another seed gives other bytes" other
for scene in 3:500 2:4; do
    nsd-gen ${scene#*:} >"$tmp/number.h5"
    nsd-gen scenes/paper/example${scene%:*}.json >"$tmp/scene.h5"
    ok "nsd-gen ${scene#*:} is the paper's example ${scene%:*}" same_particles "$tmp/number.h5" "$tmp/scene.h5"
done
jq '.bodies[0] = {count: 343, radius: 5e-4, spacing: 1, jitter: 0} |
    .walls[0].box = {x: [0, 0.007], y: [0, 0.007], z: [0, null]}' scenes/paper/example3.json |
    nsd-gen - >"$tmp/crystal.h5"
crystal() { step -n 2 --contacts --gap 1e-7 --max-sweeps 20 "$@" "$tmp/crystal.h5"; }
ok "a crystal of 343 balls has contacts enough for threads" \
    jq -e '.contacts > 800' <(crystal | nsd-info --last)
for m in "${methods[@]}"; do
    for order in "${orders[@]}"; do
        ok "$m, $order: 1 and 2 threads give the same bytes" \
            cmp <(crystal -m "$m" --order "$order" -j 1) <(crystal -m "$m" --order "$order" -j 2)
    done
done
# So many that detection, preparation and motion are shared, and frames written behind the next step
nsd-gen 40000 >"$tmp/many.h5"
many() { step -n 3 --contacts "$@" "$tmp/many.h5"; }
for j in 2 3; do
    ok "40 000 balls: 1 and $j threads give the same bytes" cmp <(many -j 1) <(many -j $j)
done
# stderr has the summary alone, also of the thread that writes
nsd-gen 20 | nsd-step --solver auto -n 3 -j 2 -o "$tmp/told.h5" 2>"$tmp/told"
nsd-gen 20 | nsd-step --solver auto -n 3 -j 1 -o "$tmp/one.h5" 2>"$tmp/alone"
ok "two threads say no more than one" cmp <(sed "s/[^ ]* s in/T s in/" "$tmp/told") <(sed "s/[^ ]* s in/T s in/" "$tmp/alone")
is "two lines: the steps, and what went worst" "$(wc -l <"$tmp/told")" 2
# In a cell two bricks long each meets the next one twice: both times by the same thread
jq -n '{ dt: 1e-4, gravity: [0, 0, 0], shapes: { brick: { box: [1.001, 1.001, 1.001] } }, overlap: true,
         cell: { lengths: [2, 20, 20] }, bodies: [range(800) |
             { shape: "brick", x: [. % 2 + 0.5, (. / 2 | floor) % 20 + 0.5, (. / 40 | floor) + 0.5] }] }' |
    nsd-gen - >"$tmp/bricks.h5"
bricks() { step -n 2 --contacts --max-sweeps 20 "$@" "$tmp/bricks.h5"; }
for j in 2 3; do
    ok "800 bricks that repeat: 1 and $j threads give the same bytes" cmp <(bricks -j 1) <(bricks -j $j)
done
nsd-detect "$tmp/heap.h5" >"$tmp/one"
sleep 1.1
ok "and so does another time of day" cmp "$tmp/one" <(nsd-detect "$tmp/heap.h5")

# ---- resuming ----

half=$((frames / 2))
nsd-gen 20 | step -n $((2 * half)) --cold --tolerance 1e-8 >"$tmp/all.h5"
nsd-gen 20 | step -n $half --cold --tolerance 1e-8 >"$tmp/first.h5"
step -n $half --cold --tolerance 1e-8 -o "$tmp/second.h5" "$tmp/first.h5"
ok "half the steps and then the other half are all the steps" cmp \
    <(nsd-info -p "$tmp/all.h5") <(nsd-info -p "$tmp/first.h5" "$tmp/second.h5")
ok "in a pipe as well" cmp <(nsd-info -p --last "$tmp/all.h5") \
    <(nsd-gen 20 | step -n $half --cold --tolerance 1e-8 | step -n $half --cold --tolerance 1e-8 | nsd-info -p --last)
ok "nsd-step -n 0 is the last frame alone" cmp \
    <(step -n 0 "$tmp/first.h5" | nsd-info -p) <(nsd-info -p --last "$tmp/first.h5")

# ---- what nsd-err says ----

# agree DOCUMENT TINY: nsd-err recomputes what the solver told, up to rounding (TINY, absolute)
agree()
{
    local errors='select(.eps_glob) | [.contacts, .eps_glob, .motion, .proj, .bipotential, .penetration,
        .max_penetration, .max_penetration_true, .max_overlap, .natural, .natural_q, .scaled.eps_glob] | @tsv'
    nsd-info "$1" | jq -r "$errors" >"$tmp/told" &&
        nsd-err "$1" | jq -r "$errors" >"$tmp/seen" &&
        paste "$tmp/told" "$tmp/seen" |
        awk -v tiny="$2" '
            function abs(x) { return x < 0 ? -x : x }
            { for (k = 1; k <= 12; k++)
                  if (NF != 24 || abs($k - $(k + 12)) > 1e-6 * abs($k) + tiny) {
                      print "line " NR ", error " k ": " $k " and " $(k + 12)
                      bad = 1
                  } }
            END { exit bad || !NR }'
}
for m in "${methods[@]}"; do
    solve -m "$m" --max-sweeps 3 "$tmp/contacts.h5" >"$tmp/rough.h5"
    ok "$m: nsd-err finds the errors that nsd-solve reports, three sweeps in" agree "$tmp/rough.h5" 1e-15
done
step -n 20 --contacts --max-sweeps 5 "$tmp/heap.h5" >"$tmp/rough.h5"
ok "nsd-err finds the errors that nsd-step --contacts reports, from moved bodies" agree "$tmp/rough.h5" 1e-11
step -n 20 --contacts --max-sweeps 5 "$tmp/heap.h5" | cat >"$tmp/rough.h5"
ok "in a stream as well" agree "$tmp/rough.h5" 1e-11

# ---- FCLIB ----

reactions() { h5dump -y -w 1 -m %.17g -d "$2" "$1" | sed -n 's/^ *\(-\?[0-9][-+.e0-9]*\),\?$/\1/p'; }
alike() # file dataset file dataset tolerance, relative to the largest
{
    paste <(reactions "$1" "$2") <(reactions "$3" "$4") |
        awk -v tolerance="$5" '
            function abs(x) { return x < 0 ? -x : x }
            { if (abs($1) > most) most = abs($1); if (abs($1 - $2) > worst) worst = abs($1 - $2) }
            END { print NR " numbers, the largest " most ", they differ by " worst
                  exit !(NR > 0 && most > 0 && worst <= tolerance * most) }'
}
sweeps=(--tolerance 0 --max-sweeps 50 --criterion glob)
for form in local global; do
    nsd-detect --fclib=$form <"$tmp/heap.h5" >"$tmp/both.h5"
    like "nsd-detect --fclib=$form adds /fclib_$form" "$(h5ls "$tmp/both.h5")" "fclib_$form +Group"
    rm -f "$tmp/alone.h5"
    h5copy -i "$tmp/both.h5" -o "$tmp/alone.h5" -s /fclib_$form -d /fclib_$form
    solve "${sweeps[@]}" "$tmp/contacts.h5" >"$tmp/solved.h5"
    solve "${sweeps[@]}" "$tmp/both.h5" >"$tmp/solved-both.h5"
    solve "${sweeps[@]}" "$tmp/alone.h5" >"$tmp/solved-alone.h5"
    ok "$form: beside the problem the contacts are the same, and so are their reactions" cmp \
        <(dump "$tmp/solved.h5" /contacts) <(dump "$tmp/solved-both.h5" /contacts)
    ok "$form: the problem alone has the reactions of the contacts" \
        alike "$tmp/solved.h5" /contacts/reaction "$tmp/solved-alone.h5" /solution/r 1e-9
    ok "$form: and their velocities" \
        alike "$tmp/solved.h5" /contacts/velocity "$tmp/solved-alone.h5" /solution/u 1e-9
    solve "$tmp/alone.h5" >"$tmp/solved-alone.h5"
    ok "$form: nsd-err finds the errors that nsd-solve reports" agree "$tmp/solved-alone.h5" 1e-15
    nsd-detect --fclib=$form "$tmp/discs.h5" >"$tmp/both.h5"
    rm -f "$tmp/alone.h5"
    h5copy -i "$tmp/both.h5" -o "$tmp/alone.h5" -s /fclib_$form -d /fclib_$form
    ok "$form: a problem in the plane is solved" \
        jq -e '.natural <= 1e-10' <(solve "$tmp/alone.h5" | nsd-err)
done

published=(CubeH8-local GFC3D_TwoRods1-local OneObject-i1028-138 Rover1040 gfc2d_granularflowonwall_00069_00350-local)
published() { solve -m exact --max-sweeps 20000 "$1" | nsd-err | jq -e '.natural <= 1e-8 and .motion < 1e-6'; }
if [ -d "$problems" ]; then
    for file in "${published[@]/#/$problems/}"; do
        ok "solve | err of ${file##*/}" published "$file.hdf5"
    done
    tried() { nsd-solve --max-sweeps 20 "$1" | nsd-err; }
    for file in "$problems"/global/*; do
        # a big one need not be solved here, but has to be read
        status 0 "solve | err of global/${file##*/}" tried "$file"
        ok "tells a finite error" jq -e '.natural | isfinite and . >= 0' "$tmp/out"
    done
    kaplas() { nsd-solve -m exact --max-sweeps 5 "$problems/KaplasTower-i1061-4.hdf5" | nsd-err; }
    status 0 "solve -m exact KaplasTower | err" kaplas
    ok "is one line of JSON" jq -e -s 'length == 1 and .[0].contacts == 570' "$tmp/out"
else
    skip "published problems" "no ../shared/problems"
fi

# ---- methods and orders ----

tight() { solve --tolerance 1e-13 --max-sweeps 50000 "$@" "$tmp/contacts.h5"; }
tight >"$tmp/exact.h5"
for m in "${methods[@]}"; do
    for order in "${orders[@]}"; do
        tight -m "$m" --order "$order" >"$tmp/other.h5"
        ok "$m, $order: the velocities of exact, natural" \
            alike "$tmp/exact.h5" /contacts/velocity "$tmp/other.h5" /contacts/velocity 1e-8
    done
done

# ---- scenes ----

ok "jq '.mu = 0.5' | nsd-gen - sets mu" jq -e -s '.[0].material | all(.mu == 0.5)' \
    <(jq '.mu = 0.5' scenes/paper/example3.json | nsd-gen - | nsd-info)
ok "a table of the balls is a scene" jq -e -s '.[0].bodies == 2' <(
    printf '# x y z r\n0 0 1 0.5\n0 0 3 0.5 # above\n' >"$tmp/balls.txt"
    echo '{"dt": 1e-3, "bodies": [{"file": "balls.txt"}]}' >"$tmp/table.json"
    nsd-gen "$tmp/table.json" | nsd-info)
for scene in scenes/*.json scenes/paper/*.json; do
    ok "$scene runs" jq -e '.step == 10 and .max_speed < 10' <(nsd-gen "$scene" | step -n 10 | nsd-info --last)
done
plane() { nsd-info -p "$1" | jq -e -n '[inputs | .x[2] == 0 and .v[2] == 0 and .w[0] == 0 and .w[1] == 0] | all'; }
ok "discs stay in their plane" plane "$tmp/discs.h5"
ok "and they have settled on its bottom" jq -e '.contacts > 15' <(nsd-info --last "$tmp/discs.h5")

# ---- none, one, smooth, rough, elastic ----

through() # scene: the long way, 3 steps; in the end nsd-err of each
{
    echo "$1" | nsd-gen - >"$tmp/a.h5" || return
    for _ in 1 2 3; do
        nsd-detect "$tmp/a.h5" | solve -e >"$tmp/b.h5" && nsd-err "$tmp/b.h5" && nsd-move "$tmp/b.h5" >"$tmp/a.h5" ||
            return
    done
    echo "$1" | nsd-gen - | step -e --solver auto -n 3 | nsd-cat --last >"$tmp/c.h5" && same_particles "$tmp/a.h5" "$tmp/c.h5"
}
floor='"dt": 1e-4, "walls": [{"point": [0, 0, 0], "normal": [0, 0, 1]}]'
ball='"x": [0, 0, 0.001], "radius": 0.001'
for n in 0 1; do
    status 0 "N = $n goes through every tool" through "$(jq ".bodies[0].count = $n" scenes/paper/example3.json)"
    is "N = $n: no contact, no error" "$(jq -s -c 'map([.contacts, .eps_glob, .natural | if . == 0 then 0 else . end])' "$tmp/out")" \
        "[[0,0,0],[0,0,0],[0,0,0]]"
    is "nsd-gen $n has $n bodies" "$(nsd-gen $n | nsd-info | jq -s '.[0].bodies')" $n
    run() { nsd-gen "$1" | nsd-step -n 2 --contacts >"$tmp/a.h5"; }
    status 0 "nsd-gen $n | nsd-step > f" run $n
    is "is a trajectory" "$(nsd-info "$tmp/a.h5" | jq -s '.[0].frames')" 2
    as_problem() { nsd-gen "$1" | nsd-detect --fclib="$2" >"$tmp/a.h5"; }
    status 0 "nsd-gen $n | nsd-detect --fclib=local" as_problem $n local
    status 0 "nsd-gen $n | nsd-detect --fclib=global" as_problem $n global
done
status 0 "a scene without bodies or walls" through '{"dt": 1e-3}'
for mu in 0 0.5 1.5; do
    status 0 "mu = $mu: a ball slides on the floor" \
        through "{$floor, \"mu\": $mu, \"bodies\": [{$ball, \"v\": [0.5, 0, 0]}]}"
    # shellcheck disable=SC2016 # jq's $mu
    ok "mu = $mu: with friction $mu times the weight, as long as it slides" \
        jq -e --argjson mu $mu '.r[0] > 0 and (.r[1:] | map(. * .) | add | sqrt) <= $mu * .r[0] * (1 + 1e-9) and
            (.status != "slide" or (.r[1:] | map(. * .) | add | sqrt) >= $mu * .r[0] * (1 - 1e-9))' \
        <(nsd-info -c "$tmp/b.h5")
done
ok "mu = 0: no friction in a heap" jq -e -n '[inputs | .r[1] == 0 and .r[2] == 0] | all and length > 20' <(
    jq '.mu = 0 | .bodies[0].count = 20' scenes/paper/example2.json |
        nsd-gen - |
        step -n 600 --every 600 --contacts --tolerance 1e-8 |
        nsd-info --last -c)
bounce() # e [OPTION ...]: how fast a ball leaves that has fallen on the floor with 1 m/s, without gravity
{
    echo "{$floor, \"gravity\": [0, 0, 0], \"e_n\": $1,
           \"bodies\": [{\"x\": [0, 0, 0.00105], \"radius\": 0.001, \"v\": [0, 0, -1]}]}" |
        nsd-gen - |
        step -n 10 "${@:2}" |
        nsd-info --last -p |
        jq '.v[2]'
}
ok "e = 1: what falls on the floor leaves as fast" jq -e '(. - 1 | fabs) < 1e-9' <(bounce 1)
ok "e = 0.5: half as fast" jq -e '(. - 0.5 | fabs) < 1e-9' <(bounce 0.5)
ok "e = 0: not at all" jq -e 'fabs < 1e-9' <(bounce 0 --solver auto)
ok "e = 1, mu = 0: a gas keeps its energy" jq -e -s '[.[] | select(.step != null).kinetic_energy] |
    length == 100 and (max - min) / max < 1e-9' <(nsd-gen scenes/gas.json | step -n 100 --tolerance 1e-13 | nsd-info)

diverging() # a ball so fast that its place after the third step overflows
{
    echo '{"dt": 1e155, "gravity": [0, 0, 0], "bodies": [{"x": [-0.8e308, 0, 0], "radius": 1e-3, "v": [1e153, 0, 0]}]}' |
        nsd-gen - |
        nsd-step -n 10 --every "$1" -o "$tmp/diverged.h5"
}
for every in 1 2 10; do
    status 1 "--every $every: a step whose result is infinite, the run ends before it" diverging $every
    is "and its last frame is there" "$(nsd-info --last -p "$tmp/diverged.h5" | jq -c '[.step, .x[2] != null]')" "[2,true]"
    rm "$tmp/diverged.h5"
done

# ---- what is not ours ----

foreign "$tmp/contacts.h5" "$tmp/mixed.h5"
h5copy -p -i "$tmp/heap.h5" -o "$tmp/mixed.h5" -s /particles/all/mass -d /lab/notes/mass
h5copy -i "$tmp/heap.h5" -o "$tmp/mixed.h5" -s /particles/all/radius -d /particles/all/charge
h5copy -i "$tmp/heap.h5" -o "$tmp/mixed.h5" -s /nsd -d /nsd/inner
kept() { h5diff "$tmp/mixed.h5" "$tmp/kept.h5" "$1" && [ -n "$(h5ls "$tmp/kept.h5/$1")" ]; }
nsd-detect "$tmp/mixed.h5" >"$tmp/detected.h5"
solve "$tmp/detected.h5" >"$tmp/solved.h5"
keepers=("nsd-cat $tmp/mixed.h5" "nsd-cat --last $tmp/mixed.h5" "cat $tmp/detected.h5" "cat $tmp/solved.h5"
    "nsd-move $tmp/solved.h5" "step -n 3 $tmp/mixed.h5" "nsd-cat $tmp/solved.h5")
for command in "${keepers[@]}"; do
    rm -f "$tmp/kept.h5"
    $command >"$tmp/kept.h5"
    for what in /lab/notes/mass /particles/all/charge /nsd/inner/scene; do
        ok "${command//$tmp\//} keeps $what, which nsd does not know" kept $what
    done
done

# a solver of the user's own, in Python: nsd-err judges it, and the step is nsd-solve's
if have_h5py && has scipy; then
    nsd-gen 20 | nsd-step --solver auto -n 500 --every 500 2>"$tmp/err" | nsd-detect --fclib=local >"$tmp/problem.h5"
    own() { /usr/bin/python3 docs/examples/solver.py <"$tmp/problem.h5" >"$tmp/own.h5"; }
    judged() { nsd-err "$tmp/own.h5" | jq -e '.natural < 1e-6 and .contacts > 10'; }
    ok "docs/examples/solver.py solves a packing" own
    ok "to a natural map of 1e-6" judged
    velocities() { nsd-move "$1" | nsd-info -p | jq -c '.v[]'; }
    nsd-solve --tolerance 1e-9 "$tmp/problem.h5" >"$tmp/solved.h5" 2>"$tmp/err"
    paste <(velocities "$tmp/own.h5") <(velocities "$tmp/solved.h5") >"$tmp/both"
    # shellcheck disable=SC2016 # columns of awk
    ok "and the bodies move as by nsd-solve" awk '($1 - $2) ^ 2 > 1e-14 { bad = 1 } END { exit bad || NR < 60 }' "$tmp/both"
else
    skip "docs/examples/solver.py solves a packing" "no h5py, scipy"
fi

done_testing
