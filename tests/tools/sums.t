#!/usr/bin/env bash
# nsd-step --wall-loads and nsd-stat -m sums: forces, works and wear of walls, summed over steps, against closed forms; faces of
# meshes; spans between frames; the same for any number of threads and processes, and when a run goes on.
. tests/support/tap.sh

step() { nsd-step --wall-loads "$@" 2>/dev/null; }
stat() { nsd-stat "$@" 2>/dev/null; }
near() { jq -ne --argjson a "$1" --argjson b "$2" --argjson t "$3" '(($a - $b) | fabs) <= $t * ($b | fabs)'; }

# ---- a block that slides until it stops: m = 16 kg, mu = 0.25, v = 1 m/s; the way is v^2/(2 mu g) = 0.20387 m ----

block='{ dt: 2e-4, mu: 0.25, shapes: { block: { box: [0.4, 0.4, 0.1] } },
    walls: [{ point: [0, 0, 0], normal: [0, 0, 1], name: "floor", wear: 2e-12 }],
    bodies: [{ x: [0, 0, 0.05], shape: "block", size: 1, density: 1000, v: [1, 0, 0] }] }'
jq -n "$block" | nsd-gen - >"$tmp/block.h5"
step -n 2500 --every 250 --tolerance 1e-10 -o "$tmp/slid.h5" "$tmp/block.h5"
stat --last -m sums "$tmp/slid.h5" | jq -c .sums >"$tmp/slid"
of() { jq ".$1[0]" "$tmp/slid"; }
ok "friction takes the kinetic energy, m v^2/2 = 8 J" near "$(of friction)" 8 1e-6
ok "and is mu m g times the way" near "$(of rub)" 32 1e-6
ok "wear is k m g times the way" near "$(of wear)" 64e-12 1e-6
ok "the floor carries the weight, m g" near "$(jq '.force[0][2]' "$tmp/slid")" "$(jq -n '-16 * 9.81')" 1e-6
ok "and is pushed forward by the momentum, m v, in all" near "$(jq '.force[0][0] * .span[0]' "$tmp/slid")" 16 1e-6
ok "by a torque about the origin: the weight where the block is, before its middle by mu times its height as long as it slides" \
    near "$(jq '.torque[0][1] * .span[0] / (16 * 9.81)' "$tmp/slid")" \
    "$(jq -n '(0.25 * 9.81) as $a | (1 / $a) as $t | $t * $t / 2 - $a * $t * $t * $t / 6 + (0.5 - $t) / (2 * $a) + 0.25 * 0.05 * $t')" 1e-4
is "a floor that rests has no power" "$(of power)" 0
is "a plane has no area, and why says so" "$(jq -c '[.area[0], .pressure[0]]' "$tmp/slid")" '[null,null]'
ok "--wear in place of the scene's coefficient" near "$(stat --last -m sums --wear 5e-12 "$tmp/slid.h5" | jq '.sums.wear[0]')" 160e-12 1e-6
is "and where it is given it is not advised" "$(stat --last -m sums --wear 5e-12 "$tmp/slid.h5" | jq -r .why.sums)" "a wall without ends has no area, unless it is a plane between others upright to it or across a periodic cell"
jq -n "$block | del(.walls[0].wear)" | nsd-gen - | step -n 1 | stat -m sums | jq -c '[.sums.wear[0], .why.sums != null]' >"$tmp/none"
is "and without either null" "$(cat "$tmp/none")" '[null,true]'

is "spans follow one another: their works sum up to that of the whole" \
    "$(stat -m sums "$tmp/slid.h5" | jq -s '([.[].sums.friction[0]] | add) - 8 | fabs < 1e-5')" true
is "a span is from the frame before of those that are measured" \
    "$(stat -s 500:2500:1000 -m sums "$tmp/slid.h5" | jq -c '.sums.span[0] | . * 1e6 | round')" $'100000\n200000\n200000'
step -n 2500 --every 2500 --tolerance 1e-10 -o "$tmp/few.h5" "$tmp/block.h5"
is "every step counts, whichever are kept" "$(stat --last -m sums "$tmp/few.h5" | jq -c .sums)" "$(cat "$tmp/slid")"

# ---- a belt takes a block along: friction takes m v^2/2, and the belt gives m v^2 ----

jq -n "$block | .bodies[0].v = [0, 0, 0] | .walls[0].velocity = [1, 0, 0]" | nsd-gen - | step -n 2500 --every 2500 --tolerance 1e-10 |
    stat -m sums | jq -c .sums >"$tmp/belt"
ok "a belt: what friction takes" near "$(jq '.friction[0]' "$tmp/belt")" 8 1e-6
ok "and its work, by which it is braked" near "$(jq '.power[0] * .span[0]' "$tmp/belt")" -16 1e-6

jq -n "$block | .bodies[0].v = [0, 0, 0] | .walls[0].belt = [1, 0, 0]" | nsd-gen - | step -n 2500 --every 2500 --tolerance 1e-10 |
    stat -m sums | jq -c .sums >"$tmp/running"
is "the key belt in place of the wall's velocity: all numbers are the same" \
    "$(jq -sc 'map([.friction, .rub, .wear, .power, .normal, .tangential] | map(.[0])) | transpose | all(.[]; ((.[0] - .[1]) | fabs) < 1e-9 * (.[0] | fabs))' "$tmp/belt" "$tmp/running")" true
# a roller of belts: the belt along x turns with its wall; a block at rest on the axis feels both
jq -n "$block | .bodies[0].v = [1, 0, 0] | .walls[0].belt = [1, 0, 0] | .walls[0].velocity = [0.5, 0, 0]" | nsd-gen - |
    step -n 2500 --every 2500 --tolerance 1e-10 | stat -m sums | jq -c .sums >"$tmp/both"
ok "a belt on a moving wall: their velocities add up, friction takes m (1.5 - 1)^2/2" near "$(jq '.friction[0]' "$tmp/both")" 2 1e-6

# ---- moments: a ball on the axis of a turntable of 5 rad/s, spun up by pivoting friction, N mu_p = 4 pi/3 1e-9 N m ----

jq -n '{ dt: 1e-3, gravity: [0, 0, -10], density: 1000, mu: 0.5, e_n: 0, rolling: { mu_p: 1e-4 }, bodies: [{ x: [0, 0, 0.01], radius: 0.01 }],
    walls: [{ name: "table", point: [0, 0, 0], normal: [0, 0, 1], drives: [{ about: [0, 0, 0], axis: [0, 0, 1], speed: 5 }] }] }' >"$tmp/table.json"
nsd-gen "$tmp/table.json" | step -n 100 --every 50 --contacts --tolerance 1e-12 -o "$tmp/table.h5"
nsd-stat --last -m sums,boundaries,names,energy "$tmp/table.h5" 2>/dev/null >"$tmp/table"
moment=$(jq -n '1e-4 * 10 * 1000 * 4 / 3 * 3.141592653589793 * 1e-6')
for m in sums boundaries names; do
    ok "pivoting friction: torque by $m" near "$(jq ".$m.torque[0][2]" "$tmp/table")" "-$moment" 1e-9
done
ok "power is torque times angular velocity" near "$(jq '.sums.power[0]' "$tmp/table")" "$(jq -n "-5 * $moment")" 1e-9
# the spin of the ball is w = M t/I, so that friction takes M (5 t - w t/2) in the time t
ok "friction takes the moment times the difference of the spins" near "$(jq '.sums.friction[0]' "$tmp/table")" \
    "$(jq -n "$moment as \$M | (4e-6 / 3 * 3.141592653589793 * 1000 * 0.4 * 1e-4) as \$I | \$M * 0.1 * (5 - \$M * 0.05 / \$I)")" 1e-9
ok "energy: boundaries give moment times spin times dt" near "$(jq '.energy.walls' "$tmp/table")" "$(jq -n "5e-3 * $moment")" 1e-9
ok "also under their former name" jq -e '.energy.boundaries == .energy.walls' "$tmp/table"
if /usr/bin/python3 -c 'import numpy' 2>/dev/null; then
    ok "and the same torque in a program" env PYTHONPATH=python NSD_LIBRARY="$PWD/build/libnsd.so" /usr/bin/python3 -c 'import nsd, sys
r = nsd.Run.from_scene(open(sys.argv[1]).read()).set(small_steps=0)
r.step(20)
assert abs(r.wall_torque[0][2] / -float(sys.argv[2]) - 1) < 1e-6, r.wall_torque' "$tmp/table.json" "$moment"
fi

# ---- a heap: the walls carry its weight; spans of one step are the forces of its contacts ----

nsd-gen 50 | step -n 1500 --every 100 --contacts --tolerance 1e-8 -o "$tmp/heap.h5"
fall=$(nsd-info -s 1000:1500:500 -p "$tmp/heap.h5" | jq -s '(map(select(.step == 1500) | .mass) | add * 9.81) +
    ((map(select(.step == 1500) | .mass * .v[2]) | add) - (map(select(.step == 1000) | .mass * .v[2]) | add)) / 0.025')
ok "walls carry the weight of a heap, and what its momentum changes" \
    near "$(stat -s 1000:1500:500 -m sums "$tmp/heap.h5" | tail -1 | jq '[.sums.force[][2]] | -add')" "$fall" 1e-9
nsd-gen 50 | step -n 60 --contacts --tolerance 1e-8 -o "$tmp/each.h5"
is "the sums of one step are the forces of its contacts" \
    "$(stat -m boundaries,sums "$tmp/each.h5" | jq -s 'all(.[1:][]; [.boundaries.force, .sums.force] | transpose | all(.[]; [.[0], .[1]] | transpose | all(.[]; (.[0] - .[1]) | fabs < 1e-9)))')" true
is "and their normal forces" \
    "$(stat -m boundaries,sums "$tmp/each.h5" | jq -s 'all(.[1:][]; [.boundaries.normal, .sums.normal] | transpose | all(.[]; (.[0] - .[1]) | fabs < 1e-9))')" true

# a plane between planes upright to it, or across a periodic cell, has a face; the sides of an open box have none
jq -n '{ dt: 1e-3, walls: [{ box: { x: [0, 0.3], y: [0, 0.2], z: [0, null] } }], bodies: [{ x: [0.1, 0.1, 0.05], radius: 0.05 }] }' >"$tmp/box.json"
nsd-gen "$tmp/box.json" | step -n 20 --every 20 --tolerance 1e-12 -o "$tmp/box.h5"
stat --last -m sums "$tmp/box.h5" | jq -c '.sums + { why: (.why.sums // "") }' >"$tmp/box"
is "the area of a floor is that between the sides, which end nowhere above" \
    "$(jq -c '[.area | map(. != null)] | .[0] | sort' "$tmp/box") $(jq '.area | add * 1e9 | round' "$tmp/box")" "[false,false,false,false,true] 60000000"
ok "its pressure the weight over it" near "$(jq '.pressure | add' "$tmp/box")" "$(nsd-info -p "$tmp/box.h5" | jq -s '.[0].mass * 9.81 / 0.06')" 1e-9
like "and why the others have none" "$(jq -r .why "$tmp/box")" 'without ends has no area'
nsd-gen <(jq '.walls = [{ point: [0, 0, 0], normal: [0, 0, 1] }] | .cell = { lengths: [0.3, 0.2, 1], repeats: [true, true, false] }' "$tmp/box.json") | step -n 20 --every 20 --tolerance 1e-12 -o "$tmp/box.h5"
ok "across a periodic cell" near "$(stat --last -m sums "$tmp/box.h5" | jq '.sums.area[0]')" 0.06 1e-12

# ---- a drum: its power is torque by angular velocity; the balances have the same work ----

jq ".bodies[0].count = 100" scenes/drum.json | nsd-gen - | step -n 500 --warm -o "$tmp/drum.h5"
spin=$(nsd-info --last -w "$tmp/drum.h5" | jq '.spin[2]')
axis=$(nsd-info --last -w "$tmp/drum.h5" | jq -r '.point | "\(.[0]),\(.[1])"')
ok "a drum: power = torque x angular velocity" near "$(stat --last -m sums --point "$axis" "$tmp/drum.h5" | jq '.sums.power[0]')" \
    "$(stat --last -m sums --point "$axis" "$tmp/drum.h5" | jq ".sums.torque[0][2] * $spin")" 1e-9
is "its work is what drives give, by the balance of each step" \
    "$(stat -m sums "$tmp/drum.h5" | jq -s '[.[].sums | .power[0] * .span[0]] | -add' | jq --argjson b "$(nsd-info "$tmp/drum.h5" | jq -s '[.[] | select(.step != null).balance.drives] | add')" '(. - $b | fabs) < 1e-9 * ($b | fabs)')" true
is "which is not 0" "$(stat --last -m sums "$tmp/drum.h5" | jq '.sums.power[0] | fabs > 1e-6')" true
ok "a circle has its length for an area" near "$(stat --last -m sums "$tmp/drum.h5" | jq '.sums.area[0]')" "$(nsd-info --last -w "$tmp/drum.h5" | jq '2 * 3.141592653589793 * .size[0]')" 1e-12

# ---- a piston: power by the motion that its load makes ----

jq -n '{ dt: 1e-4, overlap: true, walls: [{ point: [0, 0, 0], normal: [0, 0, 1] },
    { rectangle: { center: [0, 0, 0.21], normal: [0, 0, -1], sides: [1, 1] }, name: "piston", load: { along: [0, 0, 1], mass: 2, speed: -1 } }],
    bodies: [{ x: [0, 0, 0.1], radius: 0.1, v: [0, 0, 0] }], gravity: [0, 0, 0] }' | nsd-gen - | step -n 300 --tolerance 1e-12 -o "$tmp/piston.h5"
ok "a piston that is stopped: the work on it is - m v^2/2" near "$(stat --last -m sums --only piston "$tmp/piston.h5" | jq '.sums.power[0] * .sums.span[0]')" -1 1e-3

# ---- faces ----

cat >"$tmp/tray.obj" <<'END'
v -1 -1 0
v 1 -1 0
v 1 1 0
v -1 1 0
g left
f 1 2 4
g right
f 2 3 4
END
jq -n --arg file "$tmp/tray.obj" '{ dt: 1e-3, mu: 0.3, walls: [{ mesh: { file: $file, parts: "groups" }, name: "tray", wear: 1e-12 }],
    bodies: [{ x: [-0.5, -0.5, 0.1], radius: 0.1 }, { x: [0.5, 0.5, 0.2], radius: 0.2, v: [0.1, 0, 0] }] }' | nsd-gen - |
    step -n 200 --every 100 --tolerance 1e-12 -o "$tmp/tray.h5"
g=$(nsd-info --last -p "$tmp/tray.h5" | jq -s -c 'map(.mass * 9.81)')
stat --last -m sums_by_face "$tmp/tray.h5" | jq -c .sums_by_face >"$tmp/faces"
ok "a ball rests on its triangle" near "$(jq '.normal[0]' "$tmp/faces")" "$(jq '.[0]' <<<"$g")" 1e-9
ok "the other on its own" near "$(jq '.normal[1]' "$tmp/faces")" "$(jq '.[1]' <<<"$g")" 1e-9
ok "pressures are of triangles of 2 m^2" near "$(jq '.pressure[1]' "$tmp/faces")" "$(jq '.[1] / 2' <<<"$g")" 1e-9
is "the ball that slid has worn its triangle alone" "$(jq -c '.wear | [.[0] < 1e-18, .[1] > 1e-15]' "$tmp/faces")" '[true,true]'
ok "a ball slides until it rolls, at 5/7 of its speed: friction takes m v^2/7" near "$(jq '.friction[1]' "$tmp/faces")" "$(jq '.[1] / 9.81 * 0.01 / 7' <<<"$g")" 1e-3
is "faces have the names of their parts" "$(jq -c .name "$tmp/faces")" '["left","right"]'
is "sums by name" "$(stat --last -m sums_by_name "$tmp/tray.h5" | jq -c '.sums_by_name | [.name, (.normal | map(. * 100 | round))]')" \
    "$(jq -c '[["tray","left","right"], [([.normal[] ] | add), .normal[0], .normal[1]]] | [.[0], (.[1] | map(. * 100 | round))]' "$tmp/faces")"
is "--only of a part: its faces" "$(stat --last -m sums_by_face --only right "$tmp/tray.h5" | jq -c .sums_by_face.face)" '[1]'

# ---- the same, however it is made ----

step -n 30 -o "$tmp/a.h5" "$tmp/each.h5" && step -n 10 -o "$tmp/b1.h5" "$tmp/each.h5" && nsd-step -n 20 -o "$tmp/b2.h5" "$tmp/b1.h5" 2>/dev/null
is "a run that goes on has the same sums, to the bit, and needs no option" "$(stat --last -m sums "$tmp/b2.h5")" "$(stat --last -m sums "$tmp/a.h5")"
dump() { h5dump -d /particles/boundary/sums/rub/value -d /particles/boundary/sums/moment/value "$1" | tail -n +2; }
is "to the bit in the document" "$(nsd-cat --last "$tmp/b2.h5" >"$tmp/c1.h5" && dump "$tmp/c1.h5")" "$(nsd-cat --last "$tmp/a.h5" >"$tmp/c2.h5" && dump "$tmp/c2.h5")"
step -n 30 -j 2 -o "$tmp/two.h5" "$tmp/each.h5"
ok "two threads give the bytes of one" cmp "$tmp/two.h5" "$tmp/a.h5"
if have_ranks; then
    step --solver auto -n 30 -o "$tmp/once.h5" "$tmp/each.h5"
    ranks 2 nsd-step --solver auto --wall-loads -n 30 -o "$tmp/ranks.h5" "$tmp/each.h5" 2>/dev/null
    ok "two processes give the bytes of one" cmp "$tmp/ranks.h5" "$tmp/once.h5"
else
    skip "two processes give the bytes of one" "no MPI"
fi
nsd-step -n 30 -o "$tmp/without.h5" <(nsd-gen 50) 2>/dev/null
nsd-step -n 30 --wall-loads -o "$tmp/with.h5" <(nsd-gen 50) 2>/dev/null
is "the motion is that of a run without sums" "$(nsd-info --last -p "$tmp/with.h5")" "$(nsd-info --last -p "$tmp/without.h5")"
nsd-gen 50 | nsd-detect | nsd-solve 2>/dev/null | nsd-move >"$tmp/hand0.h5"
step --solver auto -n 1 "$tmp/each.h5" >"$tmp/one.h5"
nsd-cat --last "$tmp/each.h5" | nsd-detect | nsd-solve 2>/dev/null | nsd-move >"$tmp/hand.h5"
is "a step by hand adds to them" "$(stat -m sums "$tmp/hand.h5")" "$(stat -m sums "$tmp/one.h5" | jq -c 'del(.unconverged)')"
# a run continued by its scene: the edges gone, what the run does about overlaps
echo '{ "dt": 1e-3, "mu": 0.3, "cell": { "lengths": [0.3, 0.3, 1], "repeats": [true, true, false] }, "walls": [{ "point": [0, 0, 0], "normal": [0, 0, 1] }],
    "bodies": [{ "count": 20, "radius": 0.02, "v": [0.7, 0.2, 0], "box": { "x": [0, 0.3], "y": [0, 0.3], "z": [0, 0.4] } }] }' | nsd-gen - >"$tmp/slides.h5"
step -n 300 --every 300 --wall-loads --overlap-rule gap -o "$tmp/half.h5" "$tmp/slides.h5"
step -n 300 --every 300 -o "$tmp/on.h5" "$tmp/half.h5"
nsd-info --scene "$tmp/half.h5" | nsd-gen - 2>"$tmp/err" | step -n 300 --every 300 -o "$tmp/by_scene.h5"
is "a scene continues what the run does about overlaps" "$(nsd-info "$tmp/by_scene.h5" | jq -c 'select(.overlap_rule).overlap_rule')" '"gap"'
is "and bodies, to the bit, with the edges that they have gone" "$(nsd-info --last -p "$tmp/by_scene.h5" | jq -c '[.x, .v, .w, .image]')" "$(nsd-info --last -p "$tmp/on.h5" | jq -c '[.x, .v, .w, .image]')"
like "the sums begin again, which is said" "$(cat "$tmp/err")" "half.h5: the sums of its walls begin again from 0"
cp "$tmp/without.h5" "$tmp/grown.h5"
refuses 64 "a trajectory without sums takes none" nsd-step --wall-loads -i "$tmp/grown.h5"
like "says what to do" "$(cat "$tmp/err")" '-o FILE'
nsd-step --wall-loads -n 1 -o "$tmp/later.h5" "$tmp/without.h5" 2>/dev/null
refuses 65 "nor are sums joined that began at different times" nsd-cat -o "$tmp/joined.h5" "$tmp/a.h5" "$tmp/later.h5"
is "without sums a measure is null, and says what keeps them" "$(nsd-stat --last -m sums "$tmp/without.h5" | jq -c '[.sums, (.why.sums | test("--wall-loads"))]')" '[null,true]'
if has h5py; then
    nsd-cat --last "$tmp/a.h5" >"$tmp/crafted.h5"
    while IFS='|' read -r what how; do
        py -c 'import h5py, sys; f = h5py.File(sys.argv[1], "r"); g = h5py.File(sys.argv[2], "w"); [f.copy(n, g) for n in f]; s = g["particles/boundary/sums"]; exec(sys.argv[3])' \
            "$tmp/crafted.h5" "$tmp/bad.h5" "$how"
        refuses 65 "$what" nsd-stat -m sums "$tmp/bad.h5"
    done <<'END'
sums that are no numbers|s["rub/value"][0, 0] = float("nan")
sums of which one is not there|del s["work/value"]
sums of other faces than there are|del s["impulse/value"]; s["impulse/value"] = [[[0.0, 0, 0]] * 3]
sums of no known beginning|del s.attrs["since"]
sums that begin at no number|s.attrs["since"] = float("inf")
END
fi
done_testing
