#!/usr/bin/env bash
# nsd-step --with: what the program is told, what its answers do, that they are kept and done again, and how a run ends with
# a program that fails.
# shellcheck source=tests/support/tap.sh disable=SC2154,SC2317,SC2016 # tap.sh sets tmp; functions called by name; text for other shells
. tests/support/tap.sh

cat >"$tmp/ball.json" <<'EOT'
{ "dt": 1e-3, "gravity": [0, 0, 0], "density": 1000, "bodies": [{ "x": [0, 0, 1], "radius": 0.1 }, { "x": [5, 0, 1], "radius": 0.1 }],
  "walls": [{ "point": [0, 0, 0], "normal": [0, 0, 1], "load": { "along": [0, 0, 1], "mass": 2 } },
            { "point": [0, 0, 9], "normal": [0, 0, -1], "velocity": [0, 0, -1] }] }
EOT
nsd-gen "$tmp/ball.json" >"$tmp/ball.h5"
quiet() { nsd-step "$@" 2>/dev/null; }
number() { nsd-info --last "$@" 2>/dev/null; }
near() # X Y: equal to 1e-12
{
    jq -ne --argjson x "$1" --argjson y "$2" '($x - $y | fabs) <= 1e-12 * (1 + ($y | fabs))'
}

# ---- what answers do, by closed forms ----

answering() { printf 'while read -r line; do echo %q; done' "$1"; } # JSON: a program that always says so

quiet -n 100 --with "$(answering '{"forces":{"0":[1,0,0]},"torques":{"1":[0,0,0.01]}}')" "$tmp/ball.h5" >"$tmp/forces.h5"
m=$(number -p "$tmp/ball.h5" | jq -s '.[0].mass')
ok "a force: v = F t/m" near "$(number -p "$tmp/forces.h5" | jq -s '.[0].v[0]')" "$(jq -n "0.1 / $m")"
ok "a torque: w = T t/(2/5 m r^2)" near "$(number -p "$tmp/forces.h5" | jq -s '.[1].w[2]')" "$(jq -n "0.01 * 0.1 / (0.4 * $m * 0.01)")"
is "and nothing on the other" "$(number -p "$tmp/forces.h5" | jq -sc '[.[1].v, .[0].w]')" '[[0,0,0],[0,0,0]]'
quiet -n 100 --with "$(answering '{"walls":{"0":{"force":3},"1":{"velocity":[0,0,-2]}},"gravity":[0,0,-4]}')" "$tmp/ball.h5" >"$tmp/walls.h5"
place() { /usr/bin/python3 -c 'import h5py, sys; f = h5py.File(sys.argv[1]); print(f["particles/boundary/" + sys.argv[2] + "/value"][-1, int(sys.argv[3]), 2])' "$@"; }
if /usr/bin/python3 -c 'import h5py' 2>/dev/null; then
    ok "a force on a boundary with a load: v = F t/m" near "$(place "$tmp/walls.h5" velocity 0)" 0.15
    ok "a boundary's velocity: x = v t" near "$(place "$tmp/walls.h5" position 1)" 8.8
else
    skip "boundaries" "no h5py"
fi
spins='{ "dt": 1e-3, "bodies": [], "walls": [{ "disc": { "center": [0, 0, 0], "normal": [0, 0, 1], "radius": 0.1 }, "drives": [{ "about": [0, 0, 0], "axis": [0, 0, 1], "speed": 3 }] }] }'
echo "$spins" | nsd-gen - >"$tmp/spins.h5"
quiet -n 100 --with "$(answering '{"walls":{"0":{"velocity":[0,0,2]}}}')" "$tmp/spins.h5" >"$tmp/screw.h5"
is "a boundary that rotates glides along its axis, as a screw" \
    "$(nsd-info -w --last "$tmp/screw.h5" | jq -c '[(.point[2] * 1e6 | round / 1e6), .velocity[2], .spin[2]]')" '[0.2,2,3]'
is "walls under their former name, as programs of version 1 answer" "$(quiet -n 100 --with "$(answering '{"boundaries":{"0":{"velocity":[0,0,2]}}}')" "$tmp/spins.h5" | nsd-info --last -w)" \
    "$(nsd-info --last -w "$tmp/screw.h5")"
status 69 "and not across it" nsd-step -n 2 --with "$(answering '{"walls":{"0":{"velocity":[1,0,0]}}}')" -o "$tmp/across.h5" "$tmp/spins.h5"
ok "gravity: v = g t" near "$(number -p "$tmp/walls.h5" | jq -s '.[0].v[2]')" -0.4
quiet -n 3 --with 'read -r l; echo "{\"velocities\":{\"1\":[0,2,0]},\"angular_velocities\":{\"1\":[0,0,3]}}"; while read -r l; do echo "{}"; done' "$tmp/ball.h5" >"$tmp/moved.h5"
is "velocities of bodies" "$(number -p "$tmp/moved.h5" | jq -sc '[.[1].v, .[1].w, .[0].v]')" '[[0,2,0],[0,0,3],[0,0,0]]'
quiet -n 30 --with-every 10 --with 'n=0; while read -r l; do n=$((n + 1)); echo "{\"forces\":{\"0\":[$n,0,0]}}"; done' "$tmp/ball.h5" >"$tmp/every.h5"
ok "before each tenth step: forces act until the next answer" near "$(number -p "$tmp/every.h5" | jq -s '.[0].v[0]')" "$(jq -n "(1 + 2 + 3) * 0.01 / $m")"
quiet -n 3 --with "$(answering '{"forces":[[0,0,1],[0,0,2]]}')" "$tmp/ball.h5" >"$tmp/all.h5"
is "forces of all bodies in their order" "$(number -p "$tmp/all.h5" | jq -sc '.[1].v[2] / .[0].v[2]')" 2

# ---- what it is told ----

tell() { quiet "$@" --with "tee -a $tmp/told | jq -c --unbuffered '{}'" "$tmp/ball.h5" >"$tmp/plain.h5"; }
tell -n 3 --with-walls all --with-measures energy,fraction
is "a line before each step" "$(jq -c '[.step, .time, .dt, .bodies]' "$tmp/told" | paste -sd ' ')" "[0,0,0.001,2] [1,0.001,0.001,2] [2,0.002,0.001,2]"
is "boundaries, and where they are" "$(jq -c 'select(.step == 2).walls | map([.wall, .position[2], .velocity[2], .force])' "$tmp/told")" "[[0,0,0,[0,0,0]],[1,8.998,-1,[0,0,0]]]"
is "measures, as nsd-stat has them" "$(jq -c 'select(.step == 2).measures | [.energy.kinetic, (.fraction | type)]' "$tmp/told")" '[0,"object"]'
quiet -n 3 "$tmp/ball.h5" >"$tmp/alone.h5"
is "one that changes nothing changes no bit" "$(number -p "$tmp/plain.h5")" "$(number -p "$tmp/alone.h5")"
rm "$tmp/told"
tell -n 1 --with-walls 1
is "some boundaries alone" "$(jq -c '.walls | map(.wall)' "$tmp/told")" "[1]"
nsd-info --scene "$tmp/ball.h5" | jq '.walls = [{ point: [0, 0, 0], normal: [0, 0, 1] }, { point: [0, 0, 9], normal: [0, 0, -1], name: "lid" }]' |
    nsd-gen - | quiet -n 1 --with "tee $tmp/told | jq -c --unbuffered '{}'" --with-walls lid >/dev/null
is "by name" "$(jq -c '.walls | map([.wall, .name])' "$tmp/told")" '[[1,"lid"]]'
cat >"$tmp/reads" <<'EOT'
while IFS= read -r line; do
    head -c "$(printf '%s' "$line" | jq .document)" >>"$1"
    echo '{}'
done
EOT
quiet -n 3 --with-document --with "bash $tmp/reads $tmp/documents" "$tmp/ball.h5" >"$tmp/plain.h5"
is "whole documents" "$(nsd-info "$tmp/documents" | jq -sc 'map(select(.step != null).step)')" "[0,1,2]"

# ---- whether the step has converged, and walls by their names ----

jq -n '{ dt: 1e-3, mu: 1, bodies: [{ x: [0, 0, 0], radius: 0.1, mass: 1 }], walls: [{ point: [0, 0, -0.1], normal: [0, 0, 1], name: "floor" },
    { point: [0, 0, 0.1], normal: [0, 0, -1], name: "lid" }, { point: [9, 0, 0], normal: [-1, 0, 0], name: "lid" }] }' | nsd-gen - >"$tmp/press.h5"
status 1 "a lid that a program drives down" nsd-step --solver auto -n 4 --with "tee $tmp/told | jq -c --unbuffered 'if .step == 2 then {walls: {lid: {velocity: [0, 0, -0.1]}}} else {} end'" \
    --with-walls lid -o "$tmp/pressed.h5" "$tmp/press.h5"
is "it is told whether the step before has converged" "$(jq -c .converged "$tmp/told" | paste -sd ' ')" "null true true false"
is "and the account, with names" "$(jq -c '.account.unconverged | [.value, .step, .bodies[1], .fails]' "$tmp/told" | paste -sd ' ')" \
    "[null,null,null,null] [0,0,null,false] [0,0,null,false] [1,3,0,true]"
is "a name is each wall that has it" "$(nsd-info -w --last "$tmp/pressed.h5" | jq -c .velocity | paste -sd ' ')" "[0,0,0] [0,0,-0.1] [0,0,-0.1]"
status 1 "--replay knows the name, too" nsd-step --solver auto -n 4 --replay "$tmp/pressed.h5" -o "$tmp/again.h5" "$tmp/press.h5"
ok "and gives the same bodies and walls" cmp <(nsd-info -p -w "$tmp/pressed.h5") <(nsd-info -p -w "$tmp/again.h5")

# ---- stop, and failures: whole frames, and the step by its name ----

stops() # NAME PROGRAM FRAMES STATUS MESSAGE [OPTION ...]
{
    local name=$1 program=$2 frames=$3 want=$4 message=$5
    shift 5
    status "$want" "$name: status $want" nsd-step -n 5 "$@" --with "$program" -o "$tmp/end.h5" "$tmp/ball.h5"
    like "$name: the message" "$(<"$tmp/err")" "$message"
    is "$name: whole frames" "$(nsd-info "$tmp/end.h5" | jq -sc 'map(select(.step != null).step)')" "$frames"
}
stops "stop" 'read -r l; echo "{}"; read -r l; echo stop' "[1]" 0 'stopped by the program after step 1'
stops "stop as JSON" 'read -r l; echo "{}"; read -r l; echo "{\"stop\":true}"' "[1]" 0 'stopped by the program after step 1'
stops "a program that ends" 'read -r l; echo "{}"; read -r l; echo "{}"; exit 7' "[1,2]" 69 'step 3: --with: the program has ended, with status 7'
stops "a program that is killed" 'read -r l; echo "{}"; kill -9 $$' "[1]" 69 'step 2: --with: the program was killed'
stops "a program that there is not" "$tmp/nothing" "[0]" 69 'step 1: --with: the program has ended, with status 127'
stops "a program that hangs" 'read -r l; echo "{}"; sleep 60' "[1]" 69 'step 2: --with: the program has not answered for 0.3 s' --with-timeout 0.3
stops "a program that speaks without end" 'read -r l; echo "{}"; yes x | tr -d "\n"' "[1]" 69 'step 2: --with: the program(.s answer has more| has written more) than'
stops "a program that dribbles" 'while :; do printf " "; sleep 0.05; done' "[0]" 69 'step 1: --with: the program has not answered for 0.3 s' --with-timeout 0.3
stops "an empty line" 'read -r l; echo' "[0]" 69 'step 1: --with: the answer is an empty line'
stops "two lines at a time" 'while read -r l; do printf "{}\n{}\n"; done' "[1]" 69 'step 2: --with: the program has written more than its answer'
stops "blank lines between" 'while read -r l; do printf "{}\n\n"; done' "[1]" 69 'step 2: --with: the program has written more than its answer'
stops "answers in advance" 'yes {}' "[1]" 69 'step 2: --with: the program has written more than its answer'
stops "a line more after the last step" 'while read -r l; do echo "{}"; done; echo bye' "[1,2,3,4,5]" 69 '--with: the program has written more than its answer'
stops "half a line at its end" 'read -r l; printf "{"; sleep 0.1' "[0]" 69 'step 1: --with: the program has ended, with status 0, within an answer'
stops "a closed input" 'read -r l; exec <&-; echo "{}"; sleep 9' "[1]" 69 'step 2: --with: the program has closed its input'
stops "a closed output" 'read -r l; exec >&-; sleep 9' "[0]" 69 'step 1: --with: the program has closed its output'
stops "a program that is stopped" 'read -r l; kill -STOP $$' "[0]" 69 'step 1: --with: the program has not answered for 0.3 s' --with-timeout 0.3
stops "a program that fails after the run" 'while read -r l; do echo "{}"; done; exit 7' "[1,2,3,4,5]" 0 '--with: the program has ended after the run, with status 7'
stops "one that does not end after the run" 'while read -r l; do echo "{}"; done; sleep 9' "[1,2,3,4,5]" 0 'had not ended 0.3 s after the end of its input, and was killed' --with-timeout 0.3
stops "nonsense" 'echo hello; cat >/dev/null' "[0]" 69 'step 1: --with: the answer is not JSON'
for answer in '[1]:neither a JSON object' '{"force":{}}:no .force.' '{"forces":{"7":[0,0,1]}}:body .7., which does not exist' \
    '{"forces":{"0":[0,0,1],"00":[0,0,2]}}:body .00.' '{"forces":{"+1":[0,0,1]}}:body .+1.' '{"forces":{" 1":[0,0,1]}}:body . 1.' \
    '{"forces":{"":[0,0,1]}}:body ..' '{"walls":{"00":{"force":1}}}:no wall is named .00.' \
    '{"forces":{"-1":[0,0,1]}}:body .-1.' '{"forces":{"0":[1]}}:vectors' '{"forces":[[0,0,1]]}:1 forces, and there are 2' \
    '{"forces":{"0":[1e999,0,0]}}:not JSON' '{"forces":{"0":["1",0,0]}}:vectors' '{"walls":{"9":{"force":1}}}:no wall 9' \
    '{"walls":{"1":{"force":1}}}:not load-controlled' '{"walls":{"0":{"speed":1}}}:no .speed.' '{"walls":{},"boundaries":{}}:walls twice' '{"walls":{"roof":{"force":1}}}:no wall is named .roof.' '{"walls":{"-1":{"force":1}}}:no wall is named .-1.' '{"velocities":{"0":[1]}}:velocities are vectors' '{"angular_velocities":[[0,0,1]]}:1 angular_velocities, and there are 2' \
    '{"gravity":9.81}:gravity is a vector' \
    '{"friction":[["ball","cheese",1]]}:no material .cheese' '{"friction":[["ball","wall",-1]]}:friction of -1' '{"stop":1}:stop is true or false' \
    '{"gravity":[0,0,1],"gravity":[0,0,2]}:not JSON'; do
    stops "the answer ${answer%:*}" "$(answering "${answer%:*}")" "[0]" 69 "step 1: --with: .*${answer##*:}"
done


# ---- an answer that is refused has changed nothing, as one that stops the run; neither has the frame that is kept ----

nsd-gen 40 >"$tmp/heap.h5"
quiet -n 20 --with "$(answering '{"forces":{"3":[0,0,2e-5]}}')" -o "$tmp/alone.h5" "$tmp/heap.h5"
change='"velocities":{"1":[0,0,9]},"angular_velocities":{"1":[0,0,9]},"walls":{"0":{"velocity":[0,0,9]}},"forces":{"2":[0,0,9]},"gravity":[0,0,9],"friction":[["ball","wall",9]]'
for bad in '"torques":{"999":[0,0,1]}' '"walls":{"0":{"velocity":[0,0,9]},"1":{"speed":1}}' '"friction":[["ball","wall",9],["ball","cheese",1]]' '"stop":true'; do
    bad=$(jq -nc "{$change} + {$bad}")
    nsd-step -n 99 --every 100 --with "n=0; while read -r l; do n=\$((n + 1)); if [ \$n -le 20 ]; then echo '{\"forces\":{\"3\":[0,0,2e-5]}}'; else echo '$bad'; fi; done" -o "$tmp/end.h5" "$tmp/heap.h5" 2>/dev/null || true
    for file in alone end; do # its last frame as a run from there goes on
        quiet -n 20 "$tmp/$file.h5" >"$tmp/$file-on.h5"
    done
    is "the run as it was before $bad" "$(number -p "$tmp/end-on.h5")" "$(number -p "$tmp/alone-on.h5")"
done
status 0 "nor is it stored, and a replay ends before it" nsd-step -n 99 --replay "$tmp/end.h5" -o "$tmp/again.h5" "$tmp/heap.h5"

# ---- a program that reads the documents, and answers in lines ----

if /usr/bin/python3 -c 'import h5py' 2>/dev/null; then
    cat >"$tmp/looks.py" <<'EOT'
import io, json, sys
import h5py
while line := sys.stdin.buffer.readline():
    told = json.loads(line)
    with h5py.File(io.BytesIO(sys.stdin.buffer.read(told["document"])), "r") as f:
        if told["step"]: # it is sent with the forces that were answered before
            assert f["nsd/outside/lasting/force"][0, 0] == told["step"] - 1 + 3
            assert f["nsd/outside/lasting/push"][0, 0] == 5
        answer = {"forces": {"0": [told["step"] + 3, 0, 0]}, "walls": {"0": {"force": 5}},
                  "velocities": {"1": [0, float(f["particles/all/velocity/value"][-1, 1, 1]) + 1, 0]}}
    print(json.dumps(answer), flush=True)
EOT
    status 0 "a program that reads documents with h5py" nsd-step -n 10 --with-document --with "/usr/bin/python3 $tmp/looks.py" -o "$tmp/looked.h5" "$tmp/ball.h5"
    is "has the velocities of the step before" "$(number -p "$tmp/looked.h5" | jq -s '.[1].v[1]')" 10
    quiet -n 10 --replay "$tmp/looked.h5" -o "$tmp/again.h5" "$tmp/ball.h5"
    ok "replayed without the program: the same bytes" cmp "$tmp/looked.h5" "$tmp/again.h5"
else
    skip "documents that are read" "no h5py"
fi
instead='the answer is a document, which is no longer taken: answer a line of JSON with what changes, as ..velocities'
stops "a document as an answer" "read -r l; cat $tmp/heap.h5; cat >/dev/null" "[0]" 69 "step 1: --with: $instead"
stops "a later one" "read -r l; echo '{}'; read -r l; cat $tmp/ball.h5; cat >/dev/null" "[1]" 69 "step 2: --with: $instead"
stops "one without nsd's header" "read -r l; tail -c +513 $tmp/heap.h5; cat >/dev/null" "[0]" 69 "step 1: --with: $instead"
stops "the number of its bytes in front" 'read -r l; echo "{\"document\":4000}"; head -c 4000 /dev/zero' "[0]" 69 "step 1: --with: $instead"
refuses 64 "--with-every alone" nsd-step --with-every 2 "$tmp/ball.h5"
refuses 64 "--with and --replay" nsd-step --with cat --replay "$tmp/ball.h5" "$tmp/ball.h5"
for b in 1,x 2 ball; do refuses 65 "boundaries $b, which are none" nsd-step -n 1 --with cat --with-walls "$b" "$tmp/ball.h5"; done
refuses 64 "a measure that there is not" nsd-step --with cat --with-measures beauty "$tmp/ball.h5"
refuses 65 "a document without answers" nsd-step --replay "$tmp/ball.h5" "$tmp/ball.h5"

# ---- the same again ----

program='jq -c --unbuffered "{forces: {\"3\": [(.step | . * 1e-7), 0, 2e-5]}, gravity: [(.time * 100), 0, -9.81], friction: [[\"ball\", \"wall\", (.step % 7 / 10)]],
    walls: {\"0\": {velocity: [0, 0, (.time | sin * 1e-3)]}}}"'
for how in "" "--contacts" "--every 7" "-j 2"; do
    # shellcheck disable=SC2086 # words
    quiet -n 50 $how --with "$program" -o "$tmp/acted.h5" "$tmp/heap.h5" &&
        quiet -n 50 $how --replay "$tmp/acted.h5" -o "$tmp/again.h5" "$tmp/heap.h5"
    ok "replayed ${how:-as it is}: the same bytes" cmp "$tmp/acted.h5" "$tmp/again.h5"
done
quiet -n 50 --with "$program" "$tmp/heap.h5" | nsd-cat >"$tmp/piped.h5"
quiet -n 50 --with "$program" "$tmp/heap.h5" >"$tmp/acted.h5"
ok "packed from a stream: the same bytes" cmp "$tmp/piped.h5" "$tmp/acted.h5"
quiet -n 23 --with "$program" "$tmp/heap.h5" >"$tmp/part.h5"
quiet -n 27 --with "$program" --in-place "$tmp/part.h5"
is "a run that was acted on resumes with the same bits" "$(number -p "$tmp/part.h5")" "$(number -p "$tmp/acted.h5")"
quiet -n 50 --replay "$tmp/part.h5" "$tmp/heap.h5" >"$tmp/again.h5"
is "and is replayed as a whole" "$(number -p "$tmp/again.h5")" "$(number -p "$tmp/acted.h5")"
refuses 65 "answers of steps that are made already" nsd-step -n 1 --replay "$tmp/acted.h5" -o "$tmp/again.h5" "$tmp/acted.h5"
like "names both steps" "$(<"$tmp/err")" 'ends with step 50, and the run begins after step 50'
quiet -n 20 --with "$program" "$tmp/acted.h5" >"$tmp/later.h5"
quiet -n 25 "$tmp/heap.h5" >"$tmp/early.h5"
refuses 65 "answers of later steps alone" nsd-step -n 1 --replay "$tmp/later.h5" -o "$tmp/again.h5" "$tmp/early.h5"
like "names both steps, too" "$(<"$tmp/err")" 'the first answer is of step 51, and the run begins after step 25'
if /usr/bin/python3 -c 'import h5py' 2>/dev/null; then
    cat >"$tmp/forge.py" <<'EOT'
import json, sys
import h5py, numpy as np
source, to, how = sys.argv[1:]
open(to, "wb").write(open(source, "rb").read()[512:]) # without nsd's header: h5py makes no checksum
with h5py.File(to, "r+") as f:
    text = f["nsd/outside/answer/text"]
    lines = bytes(text[()]).decode().splitlines()
    lines = eval(how)
    new = np.frombuffer("".join(x + "\n" for x in lines).encode(), text.dtype)
    attributes = dict(text.attrs)
    del f["nsd/outside/answer/text"]
    f["nsd/outside/answer/text"] = new
    f["nsd/outside/answer/text"].attrs.update(attributes)
    count = f["nsd/outside/answer/count"] # all with the last frame
    starts = f["nsd/outside/answer/start"]
    count[...], starts[...] = 0, 0
    count[-1] = len(new)
EOT
    forged() # HOW PATTERN
    {
        /usr/bin/python3 "$tmp/forge.py" "$tmp/acted.h5" "$tmp/forged.h5" "$1"
        rm -f "$tmp/again.h5"
        refuses 65 "--replay of $1" nsd-step -n 50 --replay "$tmp/forged.h5" -o "$tmp/again.h5" "$tmp/heap.h5"
        like "says why" "$(<"$tmp/err")" "$2"
        ok "before the run begins" eval "! grep -q ' steps, ' $tmp/err && test ! -e $tmp/again.h5"
    }
    forged 'lines[:9] + [lines[9]] + lines[9:]' 'line 11 is of step 10, and the one before of 10'
    forged 'lines[::-1]' 'line 2 is of step 49, and the one before of 50'
    forged 'lines + ["{\"step\":52,\"answer\":{}}"]' 'an answer is of step 52, and the last frame of step 50'
    for k in 0 -1 2.5 '\"3\"' 1e300; do forged '["{\"step\":'"$k"',\"answer\":{}}"]' 'line 1 is not a step above 0 and an answer'; done
    forged '["{\"step\":1,\"answer\":[]}"]' 'line 1 is not a step above 0 and an answer'
    forged '["{\"step\":1,\"answer\":{}"]' 'line 1 is not a step above 0 and an answer'
    forged '["{\"step\":1,\"answer\":{}}", "{\"step\":30,\"answer\":{\"gravity\":3}}"]' "line 2: the answer.s gravity is a vector"
    forged '["{\"step\":1,\"answer\":{}}", "{\"step\":30,\"answer\":{\"force\":{}}}"]' "line 2: the answer has no .force.; did you mean .forces..: it has"
    forged '["{\"step\":1,\"answer\":{\"gravity\":[" + "[]," * 500000 + "0]}}"]' 'an answer of [0-9]+ bytes: [0-9]+ are allowed'
else
    skip "answers that are forged" "no h5py"
fi
nsd-step -n 1 -o "$tmp/more.h5" "$tmp/acted.h5" 2>"$tmp/err"
like "a run that goes on without its program says so" "$(<"$tmp/err")" "nothing acts on it now: --with or --replay"
quiet -n 5 --contacts --with "$program" "$tmp/acted.h5" >"$tmp/judged.h5"
worst=$(nsd-err "$tmp/judged.h5" | jq -s 'map(.velocity) | max')
ok "nsd-err judges it with the forces that acted" jq -ne "$worst <= 1.01"
done_testing
