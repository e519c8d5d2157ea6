#!/usr/bin/env bash
# Loads by the tools: scenes, documents, the chain, FCLIB; the balances; what happens to a wall that is driven
# into a jammed packing.
# shellcheck source=tests/support/tap.sh
. tests/support/tap.sh

steps=600
[ -z "$thin" ] || steps=150

step() { nsd-step --small-steps 0 "$@" 2>/dev/null; } # the solver's freedoms; tests/whole/small_laws.t has those of small steps
solve() { nsd-solve "$@" 2>/dev/null; }
# The energy that is missing from the balance of a log's worst step, in parts of what there is
misfit()
{
    jq -s 'map(.balance | ((.change - (.gravity + .loads + .drives - .dissipation)) | fabs) /
        (.kinetic + (.gravity | fabs) + (.loads | fabs) + (.drives | fabs) + (.dissipation | fabs) + 1e-300)) | max' "$1"
}
# The momentum that is missing, in parts of the largest impulse; the bodies weigh $2 kg and gravity is along z
unexplained()
{
    jq -s --argjson m "$2" '[range(1; length) as $k | .[$k].balance as $b | .[$k - 1].balance as $a |
        ([0, 1, 2] | map($b.momentum[.] - $a.momentum[.] - $b.impulse[.])) | .[2] += $m * 9.81 * '"$3"' |
        map(fabs) | max] as $off | ($off | max) / ([.[].balance.impulse[] | fabs] | max)' "$1"
}
mass() { nsd-info --last -p "$1" | jq -s 'map(.mass) | add'; }

# ---- a piston ----

nsd-gen scenes/press.json >"$tmp/press.h5"
step -n $steps --every 100 --log "$tmp/press.log" -o "$tmp/pressed.h5" "$tmp/press.h5"
load() { nsd-info --last -w "$1" | jq -c 'select(.load).load'; }
like "the piston has come down onto the balls, and nearly stands" \
    "$(load "$tmp/pressed.h5" | jq '.travel < -2e-3 and (.speed | fabs) < 0.01')" true
like "nsd-info -w shows where it is" \
    "$(nsd-info --last -w "$tmp/pressed.h5" | jq 'select(.load) | (.point[2] - 4e-3 - .load.travel | fabs) < 1e-15')" true
like "energy is balanced in every step" "$(misfit "$tmp/press.log" | jq '. < 1e-13')" true
like "and momentum, with the boundary's impulse" \
    "$(unexplained "$tmp/press.log" "$(mass "$tmp/press.h5")" 1e-4 | jq '. < 1e-12')" true
is "the balances are in the document, and nsd-info shows them" \
    "$(nsd-info --last "$tmp/pressed.h5" | jq -c .balance)" "$(tail -n 1 "$tmp/press.log" | jq -c .balance)"

nsd-cat --last "$tmp/pressed.h5" >"$tmp/last.h5"
nsd-detect "$tmp/last.h5" | solve | nsd-move >"$tmp/parts.h5"
step --solver auto -n 1 "$tmp/last.h5" | cat >"$tmp/whole.h5"
for group in /particles /observables; do
    ok "detect | solve | move and step give the same bits of $group" \
        cmp <(dump "$tmp/parts.h5" $group) <(dump "$tmp/whole.h5" $group)
done
for m in sbp sal ebp eal exact; do
    nsd-detect "$tmp/last.h5" | solve -m $m | nsd-move >"$tmp/parts.h5"
    step -m $m -n 1 "$tmp/last.h5" | cat >"$tmp/whole.h5"
    ok "-m $m, too" cmp <(dump "$tmp/parts.h5" /particles/boundary) <(dump "$tmp/whole.h5" /particles/boundary)
done
for j in 2 4; do
    step -j $j -n 20 "$tmp/last.h5" >"$tmp/j$j.h5"
    step -j 1 -n 20 "$tmp/last.h5" >"$tmp/j1.h5"
    ok "-j $j gives the same bytes" cmp "$tmp/j$j.h5" "$tmp/j1.h5"
done
step -n 10 -o "$tmp/ten.h5" "$tmp/last.h5"
step -n 10 -o "$tmp/again.h5" "$tmp/ten.h5"
step -n 20 -o "$tmp/twenty.h5" "$tmp/last.h5"
state() { nsd-info --last -p "$1" && nsd-info --last -w "$1"; }
ok "a run goes on from a document as if it had not stopped" cmp <(state "$tmp/again.h5") <(state "$tmp/twenty.h5")
step -n 5 "$tmp/last.h5" | cat >"$tmp/stream.h5"
step -n 5 -o "$tmp/trajectory.h5" "$tmp/last.h5"
ok "a stream and a trajectory hold the same loads" \
    cmp <(nsd-info -w "$tmp/stream.h5") <(nsd-info -w "$tmp/trajectory.h5")

natural() { step -n 3 --contacts --tolerance 1e-9 "$@" | nsd-err | jq -s 'map(.natural) | max < 2e-9'; }
is "nsd-err finds what the solver has found" "$(natural "$tmp/last.h5")" true
like "after a solve without a step, too" \
    "$(nsd-detect "$tmp/last.h5" | solve --tolerance 1e-9 | nsd-err | jq '.natural < 2e-9')" true

# The problem alone, as FCLIB has it: both forms have the solution of the packing.
nsd-detect "$tmp/last.h5" | solve --tolerance 1e-12 | nsd-move | nsd-info -w | jq -c 'select(.load).load.speed' >"$tmp/speed"
nsd-detect "$tmp/last.h5" | solve --tolerance 1e-12 | nsd-info -c | jq -s 'map(select(.body[0] == -6).r[0])' >"$tmp/pushes"
on_piston=$(jq length "$tmp/pushes")
jq add "$tmp/pushes" >"$tmp/push"
for form in local global; do
    nsd-detect --fclib=$form "$tmp/last.h5" >"$tmp/both.h5"
    rm -f "$tmp/alone.h5"
    h5copy -i "$tmp/both.h5" -o "$tmp/alone.h5" -s /fclib_$form -d /fclib_$form
    solve --tolerance 1e-12 "$tmp/alone.h5" >"$tmp/solved.h5"
    pushed=$(nsd-info -c "$tmp/solved.h5" | jq -s "map(.r[0])[:$on_piston] | add")
    like "--fclib=$form: the same push at the piston" \
        "$(jq -n "$(cat "$tmp/push") / $pushed - 1 | fabs < 1e-6")" true
done
like "the global form ends with the piston's speed" \
    "$(h5dump -d /solution/v -m %.17g "$tmp/solved.h5" | sed -n 's/^ *([0-9]*): //p' | tail -n 1 |
        jq --argjson s "$(cat "$tmp/speed")" '. - $s | fabs < 1e-8')" true

# ---- a plate, a cell ----

jq '.walls += [{point: [0, 0, 0], normal: [0, 0, 1], load: {about: [1e-3, 2e-3, 0], mass: 1e-6, torque: 5e-5}}] |
    .walls[0].box.z = [null, null]' scenes/press.json | nsd-gen - >"$tmp/plate.h5"
step -n $steps --every 100 --log "$tmp/plate.log" -o "$tmp/turned.h5" "$tmp/plate.h5"
like "a floor that a torque turns turns under balls" \
    "$(nsd-info --last -w "$tmp/turned.h5" | jq 'select(.load.about).load.travel > 1e-3')" true
like "energy is balanced there" "$(misfit "$tmp/plate.log" | jq '. < 1e-13')" true
is "and nsd-err agrees" "$(natural "$tmp/turned.h5")" true

cat >"$tmp/cell.json" <<'END'
{ "dim": 2, "dt": 1e-4, "mu": 0.3, "gravity": [0, 0], "density": 2500,
  "cell": { "lengths": [0.012, 0.012], "stress": { "target": [[20, 4], [4, 20]], "mass": 0.02 } },
  "bodies": [{ "count": 64, "radius": { "uniform": [4e-4, 6e-4] }, "box": { "x": [0, 0.012], "y": [0, 0.012] } }] }
END
nsd-gen "$tmp/cell.json" >"$tmp/cell.h5"
step -n $((2 * steps)) --every 100 --contacts --log "$tmp/cell.log" -o "$tmp/squeezed.h5" "$tmp/cell.h5"
like "energy is balanced in a cell under pressure and shear stress" "$(misfit "$tmp/cell.log" | jq '. < 1e-13')" true
nsd-cat --last "$tmp/squeezed.h5" >"$tmp/last-cell.h5"
nsd-detect "$tmp/last-cell.h5" | solve | nsd-move >"$tmp/parts.h5"
step --solver auto -n 1 "$tmp/last-cell.h5" | cat >"$tmp/whole.h5"
ok "detect | solve | move and step give the same bits" same_particles "$tmp/parts.h5" "$tmp/whole.h5"
step -j 4 -n 20 "$tmp/last-cell.h5" >"$tmp/j4.h5"
step -j 1 -n 20 "$tmp/last-cell.h5" >"$tmp/j1.h5"
ok "-j 4 gives the same bytes" cmp "$tmp/j4.h5" "$tmp/j1.h5"
# a projection displaces edges, which nsd-err does not undo; without gravity it also keeps a packing rattling
is "and nsd-err agrees" "$(natural --overlap-rule gap "$tmp/squeezed.h5")" true

# Love's formula: the mean stress of a packing at rest is that of the forces and branches over its volume.
jq '.cell.stress = {pressure: 20, mass: 0.02} | .bodies[0].count = 81' "$tmp/cell.json" | nsd-gen - |
    step --overlap-rule gap -n 3000 --every 3000 --contacts -o "$tmp/rest.h5"
pressure()
{
    local area
    area=$(nsd-info --last "$1" | jq '.edges | .[0][0] * .[1][1] - .[0][1] * .[1][0]')
    jq -n --argjson area "$area" --slurpfile p <(nsd-info --last -p "$1") --slurpfile c <(nsd-info --last -c "$1") \
        '[$c[] | .r[0] / 1e-4 * ($p[.body[0]].radius + $p[.body[1]].radius + .gap)] | add / $area / 2'
}
like "a pressure of 20 N/m is found again in the contacts" "$(pressure "$tmp/rest.h5" | jq '. - 20 | fabs < 1')" true

# ---- drives: a wall with a velocity, a drum of sorts ----

for scene in piston slope column; do
    nsd-gen scenes/$scene.json | step --solver auto -n 200 --every 200 --log "$tmp/$scene.log" -o "$tmp/drive.h5"
    like "scenes/$scene.json: energy is balanced" "$(misfit "$tmp/$scene.log" | jq '. < 1e-13')" true
done
like "the wall of scenes/piston.json works" "$(jq -s 'map(.balance.drives) | add > 1e-8' "$tmp/piston.log")" true
like "and only what rubs or hits dissipates" "$(jq -s 'map(.balance.dissipation) | min > -1e-12' "$tmp/piston.log")" true

# ---- a wall driven into a jammed packing ----

jq '.walls[1] |= (del(.load) | .velocity = [0, 0, -0.2])' scenes/press.json | nsd-gen - |
    step --overlap-rule keep -n 165 --every 165 -o "$tmp/jam.h5" || true
status 1 "a wall driven into a jammed packing makes all steps, and ends with 1" \
    timeout 120 nsd-step --overlap-rule keep -n 3 --log "$tmp/jam.log" -o "$tmp/jam2.h5" "$tmp/jam.h5"
like "each step ends by the limit of the sweeps" "$(jq -s 'map(.sweeps) | max <= 20000' "$tmp/jam.log")" true
like "is not converged" "$(jq -s 'map(.converged) | any | not' "$tmp/jam.log")" true
like "and says how fast bodies still approach" "$(cat "$tmp/err")" 'reactions grow without end, and bodies still approach at up to 0\.[0-9]+ m/s'
like "which the report has, too" "$(jq -s 'map(.max_penetration_true) | min > 0.05' "$tmp/jam.log")" true

nsd-info --scene "$tmp/pressed.h5" | nsd-gen - >"$tmp/on.h5"
is "nsd-info --scene goes on with the piston where it is" "$(load "$tmp/on.h5")" "$(load "$tmp/pressed.h5")"

# ---- a load that changes in time ----

# Speed and way of a piston alone, 2 kg, after 200 steps of 1 ms, under force $1
pushed()
{
    jq --argjson force "$1" '.bodies = [{x: [2e-3, 2e-3, 1e-3], radius: 5e-4}] | .gravity = [0, 0, 0] | .dt = 1e-3 |
        .walls[1].load = {along: [0, 0, 1], mass: 2, force: $force}' scenes/press.json | nsd-gen - >"$tmp/push.h5"
    step -n 200 --every 50 -o "$tmp/pushed.h5" "$tmp/push.h5"
    nsd-info --last -w "$tmp/pushed.h5" | jq -c 'select(.load).load'
}
# linear in each step: its middle is its mean, to rounding
like "a force by table, with a mean" \
    "$(pushed '{"table": [[0.05, 0], [0.1, 40], [0.15, -10]], "mean": 3}' |
        jq '(.speed - (0.2 * 3 + 0.05 * 20 + 0.05 * 15 - 0.05 * 10) / 2 | fabs) < 1e-12')" true
is "nsd-info -w shows it as it then is" "$(nsd-info --last -w "$tmp/pushed.h5" | jq 'select(.load).load.force')" -7
# the middle of a step is wrong for its mean by (pi f dt)^2/6 = 1.6e-6
like "a force by sine, against the integral" \
    "$(pushed '{"amplitude": 6, "frequency": 1, "phase": 0.4, "mean": 1}' |
        jq '((6 * ((0.4 | cos) - (0.4 + 0.4 * 3.141592653589793 | cos)) / (2 * 3.141592653589793) + 0.2) / 2) as $v |
        (.speed / $v - 1 | fabs) < 3e-6')" true
step -n 100 -o "$tmp/half.h5" "$tmp/push.h5"
step -n 100 -o "$tmp/rest.h5" "$tmp/half.h5"
is "resumed, it is where it would have been" "$(nsd-info --last -w "$tmp/rest.h5")" "$(nsd-info --last -w "$tmp/pushed.h5")"
jq '.bodies = [{document: "half.h5"}] | del(.walls) | .gravity = [0, 0, 0] | .dt = 1e-3' scenes/press.json >"$tmp/on.json"
nsd-gen "$tmp/on.json" | step -n 100 -o "$tmp/on.h5"
is "and in a scene that takes the document" "$(nsd-info --last -w "$tmp/on.h5" | jq -c 'select(.load).load')" \
    "$(nsd-info --last -w "$tmp/pushed.h5" | jq -c 'select(.load).load')"
if have_h5py; then
    foreign "$tmp/push.h5" "$tmp/loose.h5"
    py -c 'import h5py, sys; h5py.File(sys.argv[1], "r+")["/particles/boundary/load/way"][:] = 0' "$tmp/loose.h5"
    refuses 65 "a push of a boundary that is not load-controlled is refused" nsd-cat "$tmp/loose.h5"
    like "and named" "$(cat "$tmp/err")" 'push 0: its wall is not load-controlled'
else
    skip "a push of a boundary that is not load-controlled" "no h5py"
fi

# ---- too large, and bad scenes ----

jq '.bodies[0] = {count: 160000, radius: 5e-4, spacing: 1, jitter: 0, box: {x: [0, 0.4], y: [0, 0.4], z: [0, 1e-3]}} |
    .allow_overlap = true | .walls = [{point: [0, 0, 1e-3], normal: [0, 0, -1], load: {along: [0, 0, 1], mass: 1}}]' \
    scenes/press.json | nsd-gen - >"$tmp/many.h5"
refuses 70 "a piston on 160000 balls is too much" nsd-step --solver auto -n 1 -o "$tmp/never.h5" "$tmp/many.h5"
like "and why is said" "$(cat "$tmp/err")" 'the loads couple [0-9.e+]+ pairs of contacts: needs [0-9.e+]+ GB, the machine has'

bad() # "what is true" FILTER REGEX
{
    jq "$2" scenes/press.json >"$tmp/bad.json"
    refuses 65 "$1" nsd-gen "$tmp/bad.json"
    like "and where, is said" "$(cat "$tmp/err")" "$3"
}
bad "no mass is refused where no grain gives one" 'del(.walls[1].load.mass) | .bodies = []' 'walls\[1\].load: no body moves.*give a "mass"'
bad "a rotor needs its mass" '.walls[1].load = {about: [0, 0, 0], torque: 1}' 'walls\[1\].load.mass: is missing'
bad "a mass of 0 is refused" '.walls[1].load.mass = 0' 'walls\[1\].load.mass: must be positive'
bad "no direction is refused" '.walls[1].load.along = [0, 0, 0]' 'walls\[1\].load.along: must not be zero'
bad "two ways are refused" '.walls[1].load.about = [0, 0, 0]' 'walls\[1\].load'
bad "a torque along an axis is refused" '.walls[1].load.torque = 1' 'walls\[1\].load.torque'
bad "a load of a box is refused" '.walls[0].load = .walls[1].load' 'walls\[0\].load'
bad "a force that is a word is refused" '.walls[1].load.force = "much"' 'walls\[1\].load.force'
bad "a table's times must rise" '.walls[1].load.force = {table: [[1, 0], [1, 2]]}' 'walls\[1\].load.force.table\[1\].*times must rise'
bad "a sine needs its frequency" '.walls[1].load.force = {amplitude: 1}' 'walls\[1\].load.force.frequency: is missing'
done_testing
