#!/usr/bin/env bash
# Outputs: what the user has stays as it is until there is something whole to take its place.
# shellcheck source=tests/support/tap.sh disable=SC2016 # text for jq and eval; options
. tests/support/tap.sh

cd "$tmp"
nsd-gen 50 >good.h5
head -c 10000 good.h5 >cut.h5
nsd-gen 20 | nsd-step -n 3 >t.h5 2>/dev/null
kill_at() { sleep "$1" && kill "-$2" "$3" && { wait "$3" || echo $?; } 2>/dev/null; }
left() { find . -name '.*nsd*' | wc -l; }

# ---- a bad input costs nothing ----

keeps() # FILE COMMAND ...: it is refused, and the file is what it was
{
    local file=$1
    shift
    echo PRECIOUS >"$file"
    refuses 65 "$1 of a file cut short" "$@"
    is "leaves $file" "$(cat "$file")" PRECIOUS
    rm -f "$file"
}
keeps x.csv nsd-export -o x.csv cut.h5
keeps x.html nsd-web -o x.html cut.h5
keeps x.png nsd-view -o x.png cut.h5
keeps x.h5 nsd-step -o x.h5 cut.h5
keeps x.h5 nsd-cat -o x.h5 cut.h5
keeps x.log nsd-step --log x.log cut.h5
keeps x.log nsd-solve --log x.log cut.h5
keeps_fields() { keeps "$1" eval "nsd-stat -f $1 cut.h5"; }
keeps_fields x.h5
keeps_fields x.vti
keeps x.h5 nsd-cat -o x.h5 good.h5 cut.h5
nsd-step -n 300 good.h5 2>/dev/null | nsd-cat --last | nsd-detect >contacts.h5
nsd-solve contacts.h5 2>/dev/null >solved.h5
# the second document is cut: what the first gives is not written either
for tool in nsd-info nsd-stat 'nsd-stat -t -m fraction' nsd-err nsd-detect nsd-move nsd-solve; do
    # shellcheck disable=SC2086 # words
    case $tool in *err | *move) keeps x $tool -o x solved.h5 cut.h5 ;; *) keeps x $tool -o x contacts.h5 cut.h5 ;; esac
done
echo '{"dt": 1, "bodies": 3}' >bad.json
keeps x nsd-gen -o x bad.json
keeps x nsd-gen -o x --check bad.json
mkdir dir
keeps dir/grains.pvd nsd-export -o dir/ cut.h5
refuses 65 "nsd-export into a folder that is not there" nsd-export -o made/ cut.h5
ok "makes none" test ! -e made
is "and nothing else is left" "$(left)" 0

# ---- -o of every tool: the bytes of standard output ----

while read -r line; do
    [[ $line != *--device* ]] || $line >out.std 2>/dev/null || { skip "$line -o" "no OpenCL"; continue; }
    ok "$line -o FILE has the bytes of standard output" eval "$line >out.std 2>/dev/null && $line -o out.file 2>/dev/null && cmp out.std out.file"
    ok "so has -o -" eval "$line -o x -o - >out.file 2>/dev/null && cmp out.file out.std && test ! -e ./- && test ! -e x"
    refuses 74 "to a full disk" eval "$line -o /dev/full"
    like "names the file" "$(cat err)" "/dev/full: .*(No space|disk full|not written|cannot be written)"
    refuses 74 "into a folder that is not there" eval "$line -o no/x"
    like "names it" "$(cat err)" "no/x: No such file"
done <<'END'
nsd-gen 5
nsd-gen --schema
nsd-gen --keys
nsd-detect good.h5
nsd-solve contacts.h5
nsd-move solved.h5
nsd-err solved.h5
nsd-info -p good.h5
nsd-stat t.h5
nsd-stat --list
nsd-web t.h5
nsd-cat --stream t.h5
nsd-export -t csv t.h5
nsd-step -n 1 good.h5
nsd-solve --device list
END
for tool in nsd-detect nsd-info nsd-stat nsd-web nsd-cat 'nsd-export -t csv' nsd-step; do
    refuses 64 "$tool -o: its input" eval "$tool -o good.h5 good.h5"
    like "is named" "$(head -1 err)" 'good.h5: is also the input'
    refuses 64 "$tool: standard input, too" eval "$tool -o good.h5 <good.h5"
done
nsd-gen --check 5 >out.std 2>/dev/null
ok "nsd-gen --check -o FILE, too" eval 'nsd-gen --check -o out.file 5 2>/dev/null && cmp out.std out.file'
echo '{"dt": 1, "bodies": []}' >own.json
refuses 64 "nsd-gen -o: the scene" nsd-gen -o own.json own.json
ok "a log of nsd-solve is no output" eval '! nsd-solve --log out.file -o out.file contacts.h5 2>err'
is "and nothing else is left" "$(left)" 0

# ---- films ----

if command -v ffmpeg >/dev/null; then
    keeps x.mp4 nsd-view --every 1 -o x.mp4 cut.h5
    echo PRECIOUS >film.part.mp4
    ok "a film" nsd-view --every 1 --size 64x64 -o film.mp4 t.h5
    is "leaves film.part.mp4, which is the user's" "$(cat film.part.mp4)" PRECIOUS
    small() { (ulimit -f 1 && nsd-view --every 1 --size 200x200 -o full.mp4 t.h5); }
    status 74 "a film that the disk has no room for" small
    ok "is not there" eval 'test ! -e full.mp4 && [ "$(left)" = 0 ]'
    # ffmpeg: one that does nothing, and one that does not see the end of its input
    mkdir -p bin
    empty() { printf '#!/bin/sh\ncat >/dev/null\n' >bin/ffmpeg && chmod +x bin/ffmpeg && PATH=$PWD/bin:$PATH nsd-view --every 1 --size 64x64 -o none.mp4 t.h5; }
    refuses 74 "a film that ffmpeg has not written" empty
    ok "is not there" eval 'test ! -e none.mp4 && [ "$(left)" = 0 ]'
    printf '#!/bin/sh\necho $$ >encoder\nexec sleep 60\n' >bin/ffmpeg
    ended() { local s; for ((w = 0; w < 1500; w++)); do s=$(ps -o stat= -p "$(<encoder)") || return 0; [ "${s#Z}" = "$s" ] || return 0; sleep 0.02; done; return 1; }
    refuses 65 "a film whose input ends badly" eval 'PATH=$PWD/bin:$PATH nsd-view --every 1 --size 64x64 -o none.mp4 t.h5 cut.h5'
    ok "leaves no ffmpeg" ended
    rm encoder
    PATH=$PWD/bin:$PATH nsd-view --every 1 --size 64x64 -o none.mp4 t.h5 2>/dev/null &
    pid=$!
    for ((w = 0; w < 3000; w++)); do [ ! -s encoder ] || break; sleep 0.01; done
    s=0
    kill $pid && wait $pid || s=$?
    is "nor does one that is stopped" "$s $(ended && left)" '143 0'
    ok "a name with a colon is no protocol" nsd-view --every 1 --size 64x64 -o a:b.webm t.h5
    ok "but a film" test -s a:b.webm
else
    skip "films" "no ffmpeg"
fi

# ---- rights, links, devices ----

echo >old.csv && chmod 640 old.csv && ln -s old.csv link.csv
ok "an output through a link" nsd-export -o link.csv t.h5
ok "is where the link points, with the rights that were there" test -L link.csv -a "$(stat -c %a old.csv)" = 640 -a -s old.csv
mkdir there && ln -s there/new.csv nowhere.csv && ln -s nowhere.csv again.csv
ok "a link that leads nowhere is followed" nsd-export -o again.csv t.h5
ok "to where it would" test -L again.csv -a -L nowhere.csv -a -s there/new.csv
for tool in 'nsd-view --size 32x32' nsd-web 'nsd-export -t csv' nsd-cat 'nsd-step -n 1'; do
    ok "$tool -o -: standard output" eval "$tool -o x -o - t.h5 2>/dev/null | cmp - <($tool t.h5 2>/dev/null | cat) && test ! -e ./- && test ! -e x"
done
for tool in 'nsd-step -n 1' nsd-solve; do refuses 64 "$tool --log -" eval "$tool --log - good.h5"; done
refuses 64 "a log between the documents" eval 'nsd-step -n 1 --log /dev/stdout good.h5 | cat'
ok "/dev/stdout is no file" eval 'nsd-export -o /dev/stdout -t csv t.h5 | cmp - old.csv'
mkfifo pipe
ok "nor is a pipe" eval 'nsd-export -o pipe -t csv t.h5 & cmp pipe old.csv && wait'
for tool in nsd-view nsd-web 'nsd-export -t csv'; do refuses 74 "$tool to a full disk" eval "$tool -o /dev/full t.h5"; done
for n in 1 40; do # within the buffer, and beyond
    # shellcheck disable=SC2046
    refuses 74 "nsd-export of $n documents to a full disk" eval "nsd-export -t csv $(printf 't.h5 %.0s' $(seq $n)) >/dev/full"
    like "says that it is full" "$(cat err)" "No space left|disk full"
done
refuses 74 "nsd-view into a folder that is not there" nsd-view -o no/x.png t.h5

# ---- SIGXFSZ ----

limited() { (ulimit -f 8 && "$@"); }
refuses 74 "nsd-step into a file that may not grow" limited nsd-step -n 5 -o limited.h5 good.h5
refuses 74 "nsd-view" limited nsd-view -o limited.png --size 900x900 good.h5
refuses 74 "nsd-export" eval 'limited nsd-export -o limited.csv t.h5 t.h5 t.h5'
ok "leave nothing" eval '[ ! -e limited.h5 ] && [ ! -e limited.png ] && [ ! -e limited.csv ] && [ "$(left)" = 0 ]'

# ---- files that are removed ----

removed() # COMMAND: its output is removed while it writes
{
    eval "$1 2>removed.err &"
    local pid=$!
    for ((w = 0; w < 500; w++)); do if [ "$(stat -c %s u.h5 2>/dev/null || echo 0)" -gt 200000 ]; then break; fi; sleep 0.01; done
    rm u.h5
    wait $pid
}
status 74 "nsd-step whose -o is removed" removed 'nsd-step -n 3000 -o u.h5 good.h5'
like "says so" "$(cat removed.err)" 'u.h5: another program has removed it'
status 74 "nsd-step whose output is removed" removed 'nsd-step -n 3000 good.h5 >u.h5'
nameless() { /usr/bin/python3 -c 'import os, subprocess, sys
f = os.open(".", os.O_TMPFILE | os.O_RDWR)
sys.exit(subprocess.call(["nsd-export", "-t", "csv", "t.h5"], stdout=f) or os.fstat(f).st_size < 1000)'; }
ok "a file that never had a name is one" nameless

# ---- a run that is killed before its first frame ----

begun() # OUTPUT ...: killed with 9, it has left a document from which one can begin
{
    nsd-step -n 100000000 --every 100000000 "${@:2}" good.h5 2>/dev/null >"${out:-/dev/null}" &
    local pid=$!
    for ((w = 0; w < 500; w++)); do if [ -s "$1" ]; then break; fi; sleep 0.01; done
    sleep 0.1
    kill -9 $pid
    wait $pid 2>/dev/null
    cmp <(nsd-info -p --last "$1") <(nsd-info -p good.h5) && nsd-step -n 2 "$1" 2>/dev/null | nsd-info >/dev/null
}
ok "leaves its start, by -o" begun start.h5 -o start.h5
out=start2.h5
ok "and by >" begun start2.h5
ok "which is not in a run that has frames" eval 'nsd-step -n 2 -o start.h5 good.h5 2>/dev/null && nsd-info start.h5 | jq -s -e "map(.step)[1:] == [1, 2]"'
nan() { echo '{"dt": 1, "bodies": [{"x": [1e308, 0, 0], "radius": 1, "v": [1e308, 0, 0]}]}' | nsd-gen - | nsd-step "$@"; }
status 1 "a run whose first step would not be finite" nan -o start3.h5
is "leaves its start" "$(nsd-info -p start3.h5 | jq -c '[.step, .x[0]]')" '[0,1e+308]'
like "and says which, and whose" "$(tail -n 1 "$tmp/err")" 'step 1: the (position|energy) of body 0 would not be finite: the run ends before it'

# ---- tables ----

mkdir folder
refuses 66 "--values: a folder is no table" nsd-view --values folder -o v.png good.h5

done_testing
