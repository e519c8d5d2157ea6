#!/usr/bin/env bash
# Where documents go to and come from: pipes, files, full disks, closed descriptors, kill -9.
# shellcheck source=tests/support/tap.sh disable=SC2317 # functions called by name
. tests/support/tap.sh

small=$tmp/small
trap 'umount -q "$small" || true; rm -rf "$tmp"' EXIT
kills=12
[ -z "$thin" ] || kills=4

step() { nsd-step "$@" 2>/dev/null; }
steps() { nsd-info "$@" | jq -c -n '[inputs | select(.step != null).step]'; }
documents() { nsd-info "$@" | jq -c -n '[inputs | select(.frames).frames]'; }

stock heap20 >"$tmp/heap.h5"
nsd-detect "$tmp/heap.h5" >"$tmp/contacts.h5"
nsd-solve "$tmp/contacts.h5" >"$tmp/solved.h5" 2>/dev/null
commands=("nsd-gen 20" "nsd-detect $tmp/heap.h5" "nsd-solve $tmp/contacts.h5" "nsd-move $tmp/solved.h5"
    "nsd-step -n 3 $tmp/heap.h5" "nsd-cat $tmp/heap.h5" "nsd-view $tmp/heap.h5" "nsd-info $tmp/heap.h5" "nsd-err $tmp/solved.h5")
short() { echo "${1//$tmp\//}"; }

# ---- nobody reads, nothing fits, nothing is open ----

early()
{
    local s
    # shellcheck disable=SC2086 # words
    $1 2>"$tmp/err" | head -c "$2" >/dev/null
    s=${PIPESTATUS[0]}
    [ "$s" = 141 ] && ! grep -v 'sweeps\|solver$' "$tmp/err"
}
ok "nsd-gen 500 | head -c 100 ends quietly" early "nsd-gen 500" 100
ok "nsd-step | head -c 100 ends quietly" early "nsd-step -n 100 $tmp/heap.h5" 100
ok "nsd-cat | head -c 100 ends quietly" early "nsd-cat $tmp/heap.h5 $tmp/heap.h5 $tmp/heap.h5" 100
ok "nsd-info -p | head -c 100 ends quietly" early \
    "nsd-info -p $(yes "$tmp/heap.h5" | head -n 50 | tr '\n' ' ')" 100

for command in "${commands[@]}"; do
    into() { $command >/dev/full; }
    status 74 "$(short "$command") > /dev/full" into
    like "says so" "$(tail -n 1 "$tmp/err")" "^${command%% *}: standard output: "
    into() { $command >&-; }
    status 74 "$(short "$command") >&-" into
    like "says so" "$(tail -n 1 "$tmp/err")" "^${command%% *}: standard output: "
    into() { ${command%% *} --help >/dev/full; }
    refuses 74 "${command%% *} --help > /dev/full" into
    into() { ${command%% *} --version >&-; }
    refuses 74 "${command%% *} --version >&-" into
done
for command in "${commands[@]:1}"; do
    from() { ${command%% *} <&-; }
    refuses 66 "${command%% *} <&-" from
    like "says so" "$(cat "$tmp/err")" "^${command%% *}: standard input: "
done
from() { nsd-gen - <&-; }
refuses 66 "nsd-gen - <&-" from
quiet() { nsd-solve "$tmp/contacts.h5" 2>&- >"$tmp/quiet.h5" && cmp "$tmp/quiet.h5" "$tmp/solved.h5"; }
ok "closed stderr: the document is the same" quiet
all_closed() { nsd-step -n 2 -o "$tmp/closed.h5" "$tmp/heap.h5" <&- >&- 2>&- && nsd-info "$tmp/closed.h5"; }
ok "all three closed: -o FILE is a document" all_closed
if [ -x /usr/bin/python3 ]; then
    for command in "${commands[@]:0:7}"; do
        [[ $command != nsd-step* ]] || command="nsd-step - <$tmp/heap.h5" # a FILE it appends to
        into() { terminal sh -c "$command 2>$tmp/said" >/dev/null; }
        status 64 "$(short "$command") does not write to a terminal" into
        like "says so" "$(cat "$tmp/said")" "^${command%% *}: standard output is a terminal"
    done
    status 0 "nsd-info does" terminal nsd-info "$tmp/heap.h5"
    into() { terminal sh -c "nsd-step -n 200 $tmp/heap.h5 >$tmp/progress.h5"; }
    status 0 "nsd-step shows its progress on a terminal" into
    ok "and writes the same document" cmp "$tmp/progress.h5" <(step -n 200 "$tmp/heap.h5" | nsd-cat -o "$tmp/same.h5"; cat "$tmp/same.h5")
else
    skip "documents do not go to a terminal" "no python3"
fi

# ---- streams ----

{
    nsd-gen 4
    nsd-gen 4
} >"$tmp/two.h5"
is "{ nsd-gen 4; nsd-gen 4; } > f has two documents" "$(documents "$tmp/two.h5")" "[1,1]"
nsd-gen 4 >"$tmp/appended.h5"
nsd-gen 4 >>"$tmp/appended.h5"
ok "so has nsd-gen 4 > f; nsd-gen 4 >> f" cmp "$tmp/two.h5" "$tmp/appended.h5"
step -n 3 "$tmp/heap.h5" >>"$tmp/appended.h5"
is "nsd-step >> f appends a document a frame" "$(documents "$tmp/appended.h5")" "[1,1,1,1,1]"
{
    step -n 3 "$tmp/heap.h5"
    step -n 2 "$tmp/heap.h5"
    nsd-gen 4
} >"$tmp/both.h5"
is "{ nsd-step; nsd-step; nsd-gen; } > f: a trajectory, and what comes after it" "$(steps "$tmp/both.h5")" \
    "[601,602,603,601,602,0]"
like "h5ls opens the first" "$(h5ls "$tmp/both.h5/particles/all/position")" 'value +Dataset \{3/Inf, 20, 3\}'
: >"$tmp/empty.h5"
step -n 3 "$tmp/heap.h5" >>"$tmp/empty.h5"
is "nsd-step >> empty file: documents" "$(documents "$tmp/empty.h5")" "[1,1,1]"

nsd-detect "$tmp/heap.h5" >"$tmp/a.h5"
nsd-detect "$tmp/solved.h5" >"$tmp/b.h5"
several()
{
    local tool=$1 many=$2
    cat "${@:3}" | $tool 2>/dev/null >"$tmp/piped.out"
    $tool "${@:3}" 2>/dev/null >"$tmp/named.out"
    cat "${@:3}" >"$tmp/joined.h5"
    $tool "$tmp/joined.h5" 2>/dev/null >"$tmp/joined.out"
    cmp "$tmp/piped.out" "$tmp/named.out" && cmp "$tmp/piped.out" "$tmp/joined.out" &&
        [ "$(if [ "$many" = lines ]; then wc -l; else documents; fi <"$tmp/piped.out")" = "${many/lines/3}" ]
}
s=$tmp/solved.h5 a=$tmp/a.h5
ok "cat a b c | nsd-detect: three documents" several nsd-detect "[1,1,1]" "$tmp/heap.h5" "$a" "$s"
ok "cat a b c | nsd-solve" several nsd-solve "[1,1,1]" "$a" "$s" "$tmp/b.h5"
ok "cat a b c | nsd-move" several nsd-move "[1,1,1]" "$s" "$s" "$s"
ok "cat a b c | nsd-err" several nsd-err lines "$s" "$s" "$s"
step -n 1 "$tmp/heap.h5" | cat >"$tmp/601.h5"
step -n 1 "$tmp/601.h5" | cat >"$tmp/602.h5"
ok "cat a b c | nsd-cat: a trajectory" several nsd-cat "[3]" "$s" "$tmp/601.h5" "$tmp/602.h5"
refuses_trajectory() { nsd-cat "$@" >"$tmp/refused.h5"; }
refuses 65 "a trajectory's steps increase" refuses_trajectory "$tmp/601.h5" "$tmp/601.h5"
is "and the frame before is left" "$(steps "$tmp/refused.h5")" "[601]"
refuses 65 "a trajectory's frames have the same bodies" refuses_trajectory "$tmp/two.h5" "$tmp/601.h5"
mixed() # frames with reactions and frames without: a trajectory that reads, or none
{
    local s=0
    nsd-cat "$@" >"$tmp/mixed.h5" 2>"$tmp/err" || s=$?
    if [ $s = 65 ]; then one_line 65 "$tmp/err"; else nsd-info "$tmp/mixed.h5" && nsd-info -c --last "$tmp/mixed.h5"; fi
}
nsd-detect "$tmp/601.h5" >"$tmp/601c.h5"
nsd-solve "$tmp/601c.h5" >"$tmp/601s.h5" 2>/dev/null
ok "nsd-cat of solved contacts and of others" mixed "$s" "$tmp/601c.h5"
ok "nsd-cat of contacts and of solved ones" mixed "$a" "$tmp/601s.h5"
ok "nsd-cat of a packing and of contacts" mixed "$tmp/heap.h5" "$tmp/601c.h5"
ok "cat a b c | nsd-step: from the last" several "nsd-step -n 2" "[2]" "$s" "$a" "$tmp/heap.h5"
is "- is standard input, between files" "$(nsd-gen 4 | documents "$tmp/two.h5" - "$tmp/heap.h5")" "[1,1,1,1]"
trickle()
{
    # shellcheck disable=SC2094 # nothing writes it
    { head -c 1000 && sleep 0.1 && head -c 70000 && sleep 0.1 && cat; } <"$tmp/joined.h5" |
        nsd-cat |
        cmp - <(nsd-cat "$tmp/joined.h5" | cat)
}
# A large document goes through nsd-cat as it is; --last decodes it.
nsd-gen 10000 | nsd-detect | nsd-solve --max-sweeps 3 2>/dev/null >"$tmp/large.h5"
ok "a large document: the bytes that decoding it gives" cmp "$tmp/large.h5" <(nsd-cat --last "$tmp/large.h5")
large() { cat "$tmp/large.h5" "$tmp/solved.h5" "$tmp/large.h5" | nsd-cat | cmp - <(cat "$tmp/large.h5" "$tmp/solved.h5" "$tmp/large.h5"); }
ok "large and small ones, as they came" large
large_file() { nsd-cat "$tmp/large.h5" >"$tmp/one.h5" && nsd-cat --stream "$tmp/one.h5" | cmp - "$tmp/large.h5"; }
ok "into a file, a trajectory all the same" large_file
{ head -c 1000000 "$tmp/large.h5" && printf x && tail -c +1000002 "$tmp/large.h5"; } >"$tmp/damaged.h5"
refuses_large() { nsd-cat --stream "$tmp/damaged.h5" >"$tmp/refused.h5"; }
refuses 65 "a large one that is damaged" refuses_large
is "of which nothing goes on" "$(wc -c <"$tmp/refused.h5")" 0
several nsd-err lines "$s" "$s" "$s"
ok "a pipe that gives its bytes as it likes" trickle
fifo() { mkfifo "$tmp/fifo" && { nsd-gen 4 >"$tmp/fifo" & } && nsd-info "$tmp/fifo" && wait $!; }
ok "a named pipe is read, and written" fifo
offset() { { head -c "$(wc -c <"$s")" >/dev/null && nsd-info; } <"$1"; }
cat "$s" "$tmp/two.h5" >"$tmp/three.h5"
ok "a file is read from where its descriptor stands" cmp <(offset "$tmp/three.h5") <(nsd-info "$tmp/two.h5")

step -n 10 "$tmp/heap.h5" >"$tmp/ten.h5"
step -n 10 "$tmp/heap.h5" | cat >"$tmp/ten.stream"
for ten in ten.h5 ten.stream; do
    is "$ten: nsd-cat --last is the last frame" "$(nsd-cat --last "$tmp/$ten" | steps)" "[610]"
    is "$ten: nsd-cat --frames 603" "$(nsd-cat --frames 603 "$tmp/$ten" | steps)" "[603]"
    is "$ten: nsd-cat --frames 608:" "$(nsd-cat --frames 608: "$tmp/$ten" | steps)" "[608,609,610]"
    is "$ten: nsd-cat --frames :602" "$(nsd-cat --frames :602 "$tmp/$ten" | steps)" "[601,602]"
    is "$ten: nsd-cat --frames 601:610:4" "$(nsd-cat --frames 601:610:4 "$tmp/$ten" | steps)" "[601,605,609]"
    is "$ten: nsd-info --frames 601:610:4" "$(steps --frames 601:610:4 "$tmp/$ten")" "[601,605,609]"
    is "$ten: nsd-info --last" "$(steps --last "$tmp/$ten")" "[610]"
    refuses 65 "$ten: nsd-cat --frames of steps that are not there" nsd-cat --frames 900: "$tmp/$ten"
done
is "nsd-step --every 4 keeps every fourth, and the last" "$(step -n 10 --every 4 "$tmp/heap.h5" | steps)" "[604,608,610]"

# ---- the output is the input ----

cp "$tmp/ten.h5" "$tmp/same.h5"
ln -s same.h5 "$tmp/link.h5"
ln "$tmp/same.h5" "$tmp/hard.h5"
for tool in nsd-step nsd-cat; do
    for name in same link hard; do
        refuses 64 "$tool -o $name.h5 same.h5" $tool -o "$tmp/$name.h5" "$tmp/same.h5"
        ok "leaves it alone" cmp "$tmp/ten.h5" "$tmp/same.h5"
    done
    # shellcheck disable=SC2094 # that is the test
    from() { $tool -o "$tmp/same.h5" <"$tmp/same.h5"; }
    refuses 64 "$tool -o same.h5 < same.h5" from
    ok "leaves it alone" cmp "$tmp/ten.h5" "$tmp/same.h5"
    refuses 74 "$tool -o in a directory that is missing" $tool -o "$tmp/missing/o.h5" "$tmp/ten.h5"
    refuses 74 "$tool -o a directory" $tool -o "$tmp" "$tmp/ten.h5"
    status 0 "$tool -o over a file that was longer" $tool -o "$tmp/longer.h5" "$tmp/ten.h5"
    status 0 "$tool -o once more" $tool -o "$tmp/longer.h5" "$tmp/heap.h5"
    ok "is as into a new file" cmp "$tmp/longer.h5" <($tool "$tmp/heap.h5" 2>/dev/null >"$tmp/new.h5"; cat "$tmp/new.h5")
done

# ---- kill -9 ----

long=1200
step -n $long --tolerance 1e-6 --cold "$tmp/heap.h5" >"$tmp/reference.h5"
nsd-info -p "$tmp/reference.h5" >"$tmp/reference"
RANDOM=7
whole() # what a killed run has left is whole frames, the right ones, and a place to go on from
{
    local n
    h5ls "$1/particles/all/position" | grep -q '^value' || { echo "h5ls does not open it"; return 1; }
    nsd-info "$1" && nsd-info -p "$1" >"$tmp/left" || return
    n=$(($(wc -l <"$tmp/left") / 20))
    echo "$n frames"
    [ $n -ge 1 ] && cmp "$tmp/left" <(head -n $((20 * n)) "$tmp/reference") || return
    [ $n -le $((long - 2)) ] || return 0
    step -n 2 --tolerance 1e-6 --cold "$1" >"$tmp/resumed.h5" &&
        cmp <(nsd-info -p "$tmp/resumed.h5") <(tail -n +$((20 * n + 1)) "$tmp/reference" | head -n 40)
}
for ((k = 1; k <= kills; k++)); do
    option=$([ $((k % 2)) = 0 ] || echo --contacts)
    : >"$tmp/killed.h5"
    # shellcheck disable=SC2086 # none or one
    nsd-step -n $long --tolerance 1e-6 --cold $option "$tmp/heap.h5" >"$tmp/killed.h5" 2>/dev/null &
    for ((w = 0; w < 5000; w++)); do # there is nothing to be found before a first frame
        cp "$tmp/killed.h5" "$tmp/left.h5"
        if nsd-info -p "$tmp/left.h5" >"$tmp/left" 2>&1; then break; fi
        sleep 0.002
    done
    sleep "0.$(printf %03d $((RANDOM % 200)))"
    kill -9 $! 2>/dev/null || true
    wait $! 2>/dev/null || true
    ok "kill -9, $k $option: the trajectory opens, its frames are right, and nsd-step resumes" whole "$tmp/killed.h5"
done

# ---- a full file system ----

frames_of() { steps "$1" | jq -e 'length >= 1 and . == [range(601; 601 + length)]'; }

mkdir "$small"
if mount -t tmpfs -o size=1m none "$small" 2>/dev/null; then
    into() { nsd-step -n 2000 "$tmp/heap.h5" >"$small/full.h5"; }
    status 74 "nsd-step into a full file system" into
    like "says so, in the last line" "$(tail -n 1 "$tmp/err")" "^nsd-step: standard output: "
    ok "what is there are frames" frames_of "$small/full.h5"
    ok "that are finite" jq -e -n '[inputs | .x + .v + .w + .q | all(. != null)] | all' <(nsd-info -p "$small/full.h5")
    rm -f "$small"/*
    status 74 "nsd-step -o in a full file system" nsd-step --contacts -n 2000 -o "$small/full.h5" "$tmp/heap.h5"
    like "says so" "$(tail -n 1 "$tmp/err")" "^nsd-step: $small/full.h5: "
    ok "what is there are frames" frames_of "$small/full.h5"
    rm -f "$small"/*
    into() { nsd-cat "$tmp/reference.h5" >"$small/full.h5"; }
    status 74 "nsd-cat into a full file system" into
    ok "what is there are frames" frames_of "$small/full.h5"
    rm -f "$small"/*
    nsd-gen 10000 >"$tmp/10000.h5"
    into() { nsd-gen 10000 >"$small/full.h5"; }
    refuses 74 "nsd-gen into a full file system" into
    is "no half-written file is left" "$(stat -c %s "$small/full.h5")" 0
    nsd-gen 4 >"$small/full.h5"
    into() { nsd-gen 10000 >>"$small/full.h5"; }
    refuses 74 "nsd-gen >> f in a full file system" into
    ok "leaves f as it was" cmp <(nsd-gen 4) "$small/full.h5"
    into() { cat "$tmp/two.h5" "$tmp/10000.h5" | nsd-detect >"$small/full.h5"; }
    status 74 "nsd-detect of three documents, the third does not fit" into
    is "leaves the other two" "$(documents "$small/full.h5")" "[1,1]"
    rm -f "$small"/*
    into() { nsd-info -p "$tmp/reference.h5" >"$small/full.json"; }
    status 74 "nsd-info into a full file system" into
    rm -f "$small"/*
    status 74 "nsd-step --log in a full file system" nsd-step -n 2000 --log "$small/log" -o "$tmp/log.h5" "$tmp/heap.h5"
    like "says so" "$(tail -n 1 "$tmp/err")" "^nsd-step: $small/log: "
    umount "$small"
else
    skip "a full file system" "cannot mount a tmpfs"
fi
limited() # KiB that a file may have, option: what is there then are frames
{
    local s=0
    # shellcheck disable=SC2086 # none or one
    (ulimit -f "$1" && trap '' XFSZ && nsd-step -n 3000 --tolerance 1e-6 $2 "$tmp/heap.h5" >"$tmp/limited.h5") || s=$?
    echo "status $s"
    [ $s = 74 ] && frames_of "$tmp/limited.h5"
}
for limit in 301 418 535 652 769 886; do
    for option in '' --contacts; do
        ok "nsd-step $option into a file of at most $limit KiB: 74, and what is there are frames" limited $limit "$option"
    done
done
tiny() { (ulimit -f 20 && trap '' XFSZ && nsd-step "$tmp/heap.h5" >"$tmp/limited.h5"); }
refuses 74 "nsd-step into a file too small for a frame" tiny
is "is left empty" "$(wc -c <"$tmp/limited.h5")" 0

done_testing
