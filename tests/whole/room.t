#!/usr/bin/env bash
# Rooms: walls that move in proportion under one mean pressure, or at constant volume: closed solutions, work and energy, tests at
# constant pressure and volume, documents, resumed runs, processes, and what is refused.
# shellcheck source=tests/support/tap.sh disable=SC2016,SC2094 # jq programs; names of tests with what is read
. tests/support/tap.sh

step() { nsd-step "$@" 2>/dev/null; }
holds() { jq -e "$@" >/dev/null; }
near() { awk -v a="$1" -v b="$2" -v eps="$3" 'BEGIN { d = a - b; exit !(d < eps && -d < eps) }'; }
box='{ dt: 1e-3, gravity: [0, 0, 0], mu: 0.3, density: 1000, walls: [{ box: { x: [-0.05, 0.05], y: [-0.05, 0.05], z: [-0.05, 0.05] }, name: "box" }],
    room: { walls: "box", pressure: 100 }, bodies: [{ x: [0, 0, 0], radius: 0.05 }] }'

# ---- equilibrium: the force of a wall is p A ----

jq -n "$box" >"$tmp/one.json"
nsd-gen "$tmp/one.json" >"$tmp/one.h5"
step -n 50 --wall-loads --tolerance 1e-12 -o "$tmp/pressed.h5" "$tmp/one.h5"
is "one ball between six walls: each carries p A = 1 N, to 1e-6, by sums over steps" \
    "$(nsd-stat --last -m sums "$tmp/pressed.h5" | jq -c '.sums.normal | map(. - 1 | fabs < 1e-6)')" '[true,true,true,true,true,true]'
is "and along its normal" "$(nsd-stat --last -m sums "$tmp/pressed.h5" | jq -c '.sums.force | map(map((. + 0.5) | floor))')" \
    '[[-1,0,0],[1,0,0],[0,-1,0],[0,1,0],[0,0,-1],[0,0,1]]'
ok "nothing moves" holds '[.load.growth, .load.travel] | map(fabs < 1e-12) | all' < <(nsd-info -w --last "$tmp/pressed.h5")
# Forces in a rigid row are not unique, their mean is: F_x l_x + F_y l_y = 2 p A with the distances l of the walls
jq -n '{ dim: 2, dt: 1e-3, gravity: [0, 0], mu: 0.4, density: 1000, walls: [{ box: { x: [0, 0.5], y: [0, 0.1] }, name: "box" }], room: { walls: "box", pressure: 40, mass: 1 },
    bodies: [range(5) | { x: [0.05 + 0.1 * ., 0.05], radius: 0.05 }] }' | nsd-gen - >"$tmp/row.h5"
step -n 40 --wall-loads --tolerance 1e-12 -o "$tmp/rows.h5" "$tmp/row.h5"
mean() # of the walls over the last span: the sum of force times distance by that of face times distance
{
    paste <(nsd-stat --last -t -m sums "$1" 2>/dev/null | tail -n +2 | cut -f 12) <(nsd-info -w --last "$1" | jq .load.lever) <(nsd-info -w --last "$1" | jq .load.face) |
        awk '{ f += $1 * $2; a += $2 * $3 } END { printf "%.12g\n", f / a }'
}
ok "a row of five discs in the plane: their mean pressure is p, to 1e-6" near "$(mean "$tmp/rows.h5")" 40 4e-5
jq '.walls = [{ point: [0, -0.05, 0], normal: [0, 1, 0] }, { point: [0, 0.05, 0], normal: [0, -1, 0] }, { point: [-0.05, 0, 0], normal: [1, 0, 0] }, { point: [0.05, 0, 0], normal: [-1, 0, 0] },
    { point: [0, 0, -0.05], normal: [0, 0, 1], name: "floor" }, { point: [0, 0, 0.05], normal: [0, 0, -1], name: "lid" }] | .room.walls = "lid" | .gravity = [0, 0, -10]' "$tmp/one.json" | nsd-gen - >"$tmp/lid.h5"
step -n 50 --wall-loads --tolerance 1e-12 -o "$tmp/lidded.h5" "$tmp/lid.h5"
is "the lid alone: the floor, where the centre is, carries p A and the weight" \
    "$(nsd-stat --last -m sums "$tmp/lidded.h5" | jq -c --argjson m "$(nsd-info -p --last "$tmp/lid.h5" | jq .mass)" '[.sums.normal[4] - 1 - 10 * $m, .sums.normal[5] - 1] | map(fabs < 1e-6)')" '[true,true]'
is "it is where the floor is" "$(nsd-info -w --only lid "$tmp/lid.h5" | jq -c '[.load.center, .load.lever]')" '[[0,0,-0.05],-0.1]'
# a column of three in a cell that is periodic along x: the face of the floor is the edge
jq -n '{ dim: 2, dt: 1e-3, gravity: [0, 0], density: 1000, cell: { lengths: [0.3, 1], repeats: [true, false] }, walls: [{ box: { y: [0, 0.3] }, name: "plates" }],
    room: { walls: "plates", pressure: { table: [[0, 20], [0.01, 50]] }, mass: 1 }, bodies: [range(3) | { x: [0.1, 0.05 + 0.1 * .], radius: 0.05 }] }' | nsd-gen - >"$tmp/plates.h5"
step -n 20 --wall-loads --every 10 --tolerance 1e-12 -o "$tmp/plated.h5" "$tmp/plates.h5"
is "between plates along a periodic edge: p by the edge, which rises with its table" \
    "$(nsd-stat -m sums "$tmp/plated.h5" 2>/dev/null | jq -c '.sums.normal | map(. * 1e9 | round / 1e9)' | tr '\n' ' ')" '[10.5,10.5] [15,15] '

# ---- dynamics: an empty room falls in by (3 p V)/M; its energy is the work of the pressure, - p dV ----

volume() { jq -s '[.[] | .load.lever] | (.[0] + .[1]) * (.[2] + .[3]) * (.[4] + .[5]) | -.'; }
fall() # DT: relative error of M s^2/2 = p (V0 - V), and the growth
{
    jq --argjson dt "$1" '.dt = $dt | .room.mass = 0.1 | .room.pressure = 1 | .bodies[0].radius = 0.01 | .bodies[0].fixed = true' "$tmp/one.json" | nsd-gen - |
        step --until 0.1 --every 0.1s -o "$tmp/fall.h5"
    nsd-info -w --last "$tmp/fall.h5" >"$tmp/fall.json"
    jq -s -c --argjson v "$(volume <"$tmp/fall.json")" '(6 * 0.1 * 0.05 * 0.05) as $M | .[0].load.growth as $s | [($M * $s * $s / 2) / (1e-3 - $v) - 1, $s, $v]' "$tmp/fall.json"
}
coarse=$(fall 2e-3) fine=$(fall 1e-3)
diag "coarse $coarse fine $fine"
ok "an empty room: M s^2/2 = p (V0 - V), to 1e-5" holds '.[0] | fabs < 1e-5' <<<"$fine"
ok "of second order in dt" holds -n "$coarse as \$c | $fine as \$f | \$c[0] / \$f[0] | . > 3.5 and . < 4.5"
# the equation of motion M ds/dt = -3 p V, dV/dt = 3 s V, by scipy
if has scipy; then
    ode=$(py -c '
from scipy.integrate import solve_ivp
M = 6 * 0.1 * 0.05 ** 2
y = solve_ivp(lambda t, y: [-3 * y[1] / M, 3 * y[0] * y[1]], [0, 0.1], [0, 1e-3], rtol=1e-10, atol=1e-14).y[:, -1]
print([y[0], y[1]])')
    ok "growth and volume are those of the equation of motion" holds -n "$fine as \$f | $ode as \$o | (\$f[1] / \$o[0] - 1 | fabs) < 1e-4 and (\$f[2] / \$o[1] - 1 | fabs) < 1e-4"
else
    skip "growth and volume are those of the equation of motion" "no scipy"
fi

# ---- grains between the walls: work, energy, the pressure, then tests ----

# Balls of mean diameter 1 m and mass 1 kg under 1 Pa; dense: pressed together without friction
jq -n '{ dt: 0.01, gravity: [0, 0, 0], density: 1.88, seed: 3, mu: 0, walls: [{ box: { x: [0, 6.6], y: [0, 6.6], z: [0, 6.6] }, name: "box" }],
    room: { walls: "box", pressure: { table: [[0, 0.1], [4, 1]] } }, bodies: [{ random: { count: 150 }, radius: { uniform: [0.4, 0.6] } }] }' | nsd-gen - >"$tmp/loose.h5"
step --overlap-rule gap -n 200 -o "$tmp/falls.h5" "$tmp/loose.h5"
balances() { nsd-info "$1" | jq -c 'select(.balance) | .balance'; }
is "energy: what it changes by is what loads, drives and contacts do, in every step" \
    "$(balances "$tmp/falls.h5" | jq -s 'map((.change - .loads - .drives - .gravity + .dissipation | fabs) <= 1e-12 + 1e-9 * (.loads | fabs)) | all')" true
nsd-gen <(nsd-info --scene "$tmp/falls.h5" | jq '.room.pressure = 0.7') >"$tmp/held.h5"
step --overlap-rule gap -n 200 -o "$tmp/helds.h5" "$tmp/held.h5"
before=$(nsd-info -w --last "$tmp/held.h5" | volume) after=$(nsd-info -w --last "$tmp/helds.h5" | volume)
ok "the work of the pressure over 200 steps is - p dV, to 1e-5" \
    near "$(balances "$tmp/helds.h5" | jq -s 'map(.loads) | add')" "$(jq -n "0.7 * ($before - $after)")" "$(jq -n "1e-5 * ($before - $after | fabs) + 1e-9")"

step --overlap-rule gap --until 30 --every 30s --wall-loads -o "$tmp/dense.h5" "$tmp/falls.h5"
# at rest single walls differ and their mean does not; the sums are those of the last steps only
step --overlap-rule gap -n 20 --every 20 --wall-loads --tolerance 1e-6 -o "$tmp/rest.h5" <(nsd-info --scene "$tmp/dense.h5" | jq '.bodies[0].at_rest = true | .room.growth = 0' | nsd-gen -)
ok "150 balls at rest: the mean pressure of the walls is p, to 0.2 %" near "$(mean "$tmp/rest.h5")" 1 2e-3

down='[0.005, 0.005, -0.01]'
nsd-info --scene "$tmp/dense.h5" | jq --argjson e "$down" '.mu = 0.5 | .pairs = [{ pair: ["ball", "wall"], mu: 0 }] | .bodies[0].at_rest = true |
    .room.pressure = 1 | .room.strain_rate = $e' >"$tmp/test.json"
nsd-gen "$tmp/test.json" >"$tmp/test.h5"
step --overlap-rule gap -n 2400 --every 24 --contacts --wall-loads -o "$tmp/tests.h5" "$tmp/test.h5"
# [frames][walls]: p by the forces over the 24 steps between two frames, by the faces of the later one
paste <(nsd-stat -m sums "$tmp/tests.h5" | jq -c '.sums.normal') <(nsd-info -w "$tmp/tests.h5" | jq -s -c '[_nwise(6)][] | [map(.load.lever), map(.load.face)]') |
    jq -c -n '[inputs as $f | input as [$l, $a] | ([$f, $l] | transpose | map(.[0] * .[1]) | add) / ([$l, $a] | transpose | map(.[0] * .[1]) | add)]' >"$tmp/p.json"
diag "p of the walls, second half: $(jq -c '.[50:] | [min, add / length, max]' "$tmp/p.json")"
ok "triaxial test at constant p: the mean of the walls' pressure is p, to 1 %" holds '.[50:] | add / length - 1 | fabs < 0.01' "$tmp/p.json"
ok "and over 24 steps to 8 % at any time" holds '.[50:] | map(. - 1 | fabs < 0.08) | all' "$tmp/p.json"
nsd-stat -m strain,stress,fraction "$tmp/test.h5" "$tmp/tests.h5" | jq -s -c '.[-1].strain.tensor as $e | [$e[2][2] - $e[0][0], $e[0][0] - $e[1][1], .[-1].strain.volumetric] + (map(select(.stress.p)) |
    .[length / 2 | floor:] | [(map(.stress.q) | add) / (map(.stress.p) | add), (map(.fraction.fraction) | add / length), (map(.stress.p) | add / length)])' >"$tmp/path.json"
diag "path $(cat "$tmp/path.json")"
# E t = 0.24 on z, half of it off the others
ok "the shape has the strain that is prescribed, 3/2 E t, to 1e-6" holds '(.[0] - 0.36 | fabs < 1e-6) and (.[1] | fabs < 1e-6)' "$tmp/path.json"
ok "dense grains dilate" holds '.[2] < -0.01' "$tmp/path.json"
# q/p of rigid balls with mu = 0.5 [Thornton 2000; Huang et al. 2014], see laboratory.t; smooth walls make layers of so few
ok "q/p is 0.5 to 0.95 and the stress of the contacts within 5 % that of the walls" holds '.[3] > 0.5 and .[3] < 0.95 and (.[5] - 1 | fabs < 0.05)' "$tmp/path.json"

# ---- constant volume: rates with the sum 0, no pressure ----

jq '.room = { walls: "box", strain_rate: [0.05, 0.05, -0.1] } | .bodies[0].random.count = 60' < <(nsd-info --scene "$tmp/loose.h5" | jq '.bodies = [{ random: { count: 60 }, radius: 0.5 }] | .time = 0') >"$tmp/volume.json"
nsd-gen "$tmp/volume.json" >"$tmp/volume.h5"
step --overlap-rule gap --until 3 --every 1s -o "$tmp/volumes.h5" "$tmp/volume.h5"
# each step multiplies an edge by (1 + x/2)/(1 - x/2), x = e dt, whose logarithm is x + x^3/12: 300 steps make -1.9e-8 of the volume
is "constant volume: z is exp(-0.3) as long, to 1e-6, and the volume is the same but for (e dt)^2/12" \
    "$(nsd-info -w "$tmp/volume.h5" "$tmp/volumes.h5" | jq -s -c 'map(.load.lever) as $l | ($l[-1] / $l[5] / (-0.3 | exp) - 1 | fabs < 1e-6),
        (([0, 2, 4] | map($l[. - 6] / $l[.]) | .[0] * .[1] * .[2]) - 1 + 1.875e-8 | fabs < 1e-9)' | tr '\n' ' ')" 'true true '
ok "the walls do the work as drives do" holds -s 'map((.change - .drives + .dissipation | fabs) <= 1e-12 + 1e-9 * (.drives | fabs)) and (map(.loads) | all(. == 0))' <<<"$(balances "$tmp/volumes.h5")"
ok "no wall yields to a push" eval '! echo "{\"walls\": {\"0\": {\"force\": 1}}}" | nsd-step -n 1 --with cat "$tmp/volume.h5" >/dev/null 2>&1'

# ---- documents, resumed runs, threads, processes ----

jq '.theta = 0.6 | .walls[0].drives = [{ along: [0, 0, 1], speed: 0.01, from: .time }] | .walls += [{ point: [0, 0, 20], normal: [0, 0, -1], load: { along: [0, 0, 1], mass: 1, force: { table: [[0, 0], [1, -1]] } } }]' "$tmp/test.json" | nsd-gen - >"$tmp/all.h5"
run() { nsd-step --overlap-rule gap -n "$1" --every "$1" --contacts --wall-loads "${@:2}" 2>/dev/null; }
run 40 -o "$tmp/whole.h5" "$tmp/all.h5"
run 20 -o "$tmp/half.h5" "$tmp/all.h5" && run 20 -o "$tmp/rest2.h5" "$tmp/half.h5"
state() { nsd-info -p -w --last "$1" >"$tmp/state" && [ -s "$tmp/state" ] && md5sum <"$tmp/state"; }
is "a resumed run has the same bits" "$(state "$tmp/rest2.h5")" "$(state "$tmp/whole.h5")"
cp "$tmp/half.h5" "$tmp/grown.h5" && run 20 -i "$tmp/grown.h5"
is "and so has one that is appended" "$(state "$tmp/grown.h5")" "$(state "$tmp/whole.h5")"
nsd-detect --overlap-rule gap "$tmp/all.h5" 2>/dev/null | nsd-solve 2>/dev/null | nsd-move 2>/dev/null >"$tmp/hand.h5"
step --overlap-rule gap -n 1 "$tmp/all.h5" >"$tmp/tool.h5"
is "a step by hand is one of nsd-step" "$(state "$tmp/hand.h5")" "$(state "$tmp/tool.h5")"
run 40 -j 3 -o "$tmp/threads.h5" "$tmp/all.h5"
ok "three threads write the same bytes" cmp "$tmp/threads.h5" "$tmp/whole.h5"
if have_ranks; then
    for doc in all volume; do
        run 40 -o "$tmp/serial.h5" "$tmp/$doc.h5"
        for order in colour block; do
            ranks 2 nsd-step --overlap-rule gap --order $order -n 40 --every 40 --contacts --wall-loads -o "$tmp/ranks.h5" "$tmp/$doc.h5" 2>/dev/null
            [ $order = block ] && run 40 --order block -o "$tmp/serial.h5" "$tmp/$doc.h5"
            is "two processes in order $order: the state of one, $doc" "$(state "$tmp/ranks.h5")" "$(state "$tmp/serial.h5")"
        done
    done
else
    skip "two processes" "no MPI"
fi
is "a document without rates has no dataset of them" "$(h5ls -r "$tmp/one.h5" | grep -c 'load/rate' || true)" 0
is "a document of a room has the way 3, and its rates where there are any" \
    "$(h5dump -d /particles/boundary/load/way "$tmp/test.h5" | grep -o '3, 3, 3, 3, 3, 3') $(h5ls -r "$tmp/test.h5" | grep -c 'load/rate')" '3, 3, 3, 3, 3, 3 1'
nsd-cat "$tmp/whole.h5" "$tmp/rest2.h5" 2>/dev/null | nsd-info -w --last | md5sum >"$tmp/cat"
is "nsd-cat keeps them" "$(cat "$tmp/cat")" "$(nsd-info -w --last "$tmp/whole.h5" | md5sum)"
jq -n --arg d "$tmp/whole.h5" '{ dt: 0.01, theta: 0.6, gravity: [0, 0, 0], mu: 0.5, time: 30.4, bodies: [{ document: $d }] }' | nsd-gen - | nsd-info -w |
    jq -s -c 'map(.load.growth // .load.speed)' >"$tmp/taken"
is "walls that are taken out of a document bring their room" "$(cat "$tmp/taken")" "$(nsd-info -w --last "$tmp/whole.h5" | jq -s -c 'map(.load.growth // .load.speed)')"

# ---- what is refused ----

scene() { jq "$1" "$tmp/one.json" >"$tmp/wrong.json"; }
wrong() # NAME CHANGE MESSAGE
{
    scene "$2"
    refuses 65 "$1" nsd-gen "$tmp/wrong.json"
    like "$1: the message" "$(cat "$tmp/err")" "$3"
}
is "the key room is a former name of servo" "$(jq '.servo = .room | del(.room)' "$tmp/one.json" | nsd-gen - | nsd-info -p)" "$(nsd-gen "$tmp/one.json" | nsd-info -p)"
is "also where nsd-info continues a scene" "$(nsd-gen "$tmp/one.json" | nsd-info -w)" "$(jq '.servo = .room | del(.room)' "$tmp/one.json" | nsd-gen - | nsd-info -w)"
wrong "an unknown wall" '.room.walls = "boxes"' "room.walls: no wall 'boxes', but box"
wrong "walls without names" 'del(.walls[0].name)' 'none has a name: give them a "name"'
wrong "a wall that is named twice" '.room.walls = ["box", "box"]' 'names walls.0. twice'
wrong "an unknown key" '.room.presure = 1' 'room.presure: '
wrong "nothing to do" '.room = { walls: "box" }' 'needs at least one of the keys pressure strain_rate'
wrong "rates that change the volume" '.room.strain_rate = [1, 0, 0]' 'changes the volume at 1 per s'
wrong "a mass without a pressure" '.room = { walls: "box", strain_rate: [1, 0, -1], mass: 1 }' 'only a servo with a "pressure" has a mass'
wrong "growth without a pressure" '.room = { walls: "box", strain_rate: [1, 0, -1], growth: 1 }' 'only a servo with a "pressure" grows'
wrong "a wall on the wrong side of the centre" '.room.center = [0.1, 0, 0]' 'servo.center: lies behind walls.0., by 0.05'
wrong "travel of another number of walls" '.room.travel = [0, 0]' 'needs 6 numbers'
wrong "a surface that is no plane" '.walls += [{ disc: { center: [0, 0, 1], normal: [0, 0, -1], radius: 1 }, name: "box" }]' 'walls.1. is no plane'
wrong "a wall with a load of its own" '.walls = [{ point: [0, 0, 1], normal: [0, 0, -1], load: { along: [0, 0, 1], force: 1 }, name: "box" }]' 'has a load of its own'
wrong "a wall that nothing faces" '.walls = [{ point: [0, 0, 1], normal: [0, 0, -1], name: "box" }]' 'no plane faces walls.0.: give a "center"'
wrong "a room that is open" '.walls = [{ box: { z: [-0.05, 0.05] }, name: "box" }]' 'its servo needs planes on all sides of its face'
wrong "a wall that rotates" '.walls[0].drives = [{ about: [0, 0, 0], axis: [0, 0, 1], speed: 1 }]' 'belongs to a servo, and turns'
wrong "a wall that is removed" '.walls[0].until = 1' 'belongs to a servo, and vanishes'
wrong "rates that are too fast" '.room.strain_rate = [100, 0, -100]' 'more than a tenth in a step: take a smaller dt'
wrong "no body for the mass" 'del(.bodies)' 'give a "mass", kg'
wrong "a room without walls" 'del(.walls)' 'needs "walls" in the scene'
jq '.dt = 1 | .room.mass = 1e-3 | .bodies[0].radius = 0.01' "$tmp/one.json" | nsd-gen - >"$tmp/fast.h5"
status 65 "a room that falls in faster than a step ends the run" eval 'nsd-step --solver auto -n 5 -o "$tmp/fasts.h5" "$tmp/fast.h5"'
like "and says how to go on" "$(cat "$tmp/err")" "changes by -.* of its size in step 1, and a tenth is the most: take a smaller dt, a larger mass"
# documents that say what no scene can
if has h5py; then
    bent() # DATASET ROW VALUE MESSAGE
    {
        nsd-cat --last "$tmp/test.h5" | tail -c +513 >"$tmp/bent.h5"
        py -c 'import h5py, sys
f = h5py.File(sys.argv[1], "r+"); f["particles/boundary/load/" + sys.argv[2]][eval(sys.argv[3])] = float(sys.argv[4])' "$tmp/bent.h5" "$1" "$2" "$3"
        refuses 65 "a document whose $1 is $3 at $2" nsd-info -w "$tmp/bent.h5"
        like "why" "$(cat "$tmp/err")" "$4"
    }
    bent speed/value '0, 3' 0.5 'another centre or growth'
    bent speed/value '0, slice(None)' 1e300 'more than a tenth in a step'
    bent point '2, 0' 9 'another centre or growth'
    bent rate '1' nan 'strain rate that is not finite'
    bent rate '4' -1e9 'more than a tenth in a step'
    bent mass 'slice(None)' 0 'grows, and has no mass'
    bent mass '1' -1 'mass of its load must be positive'
    bent way '2' 1 'strain rate that is not finite, or no servo'
    bent way '2' 4 'neither translates nor rotates it'
    bent axis '0, 0' -1 'not on the side of its normal'
else
    skip "documents that say what no scene can" "no h5py"
fi
done_testing
