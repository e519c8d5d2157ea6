#!/usr/bin/env bash
# Loads that small steps have no law for, and loads that driven walls make: momentum, forces, overlaps, against closed forms.
# shellcheck source=tests/support/tap.sh disable=SC2154,SC2016 # jq, tap.sh sets tmp
. tests/support/tap.sh
# shellcheck source=tests/support/small.sh
. tests/support/small.sh

sums() # JQ PROGRAM: of the sums of the frames
{
    nsd-stat -m sums "$tmp/out.h5" 2>"$tmp/stat" | jq -sc "map(.sums) | $1"
}
travel() # of the load of the last frame
{
    nsd-info --last -w "$tmp/out.h5" | jq -c "select(.load) | .load.travel" | head -n 1
}

# ---- a lid of 52 layers, which falls on 320 balls of 5 layers with 0.2 m/s, under a force of 4 N ----

scene "dt: 1e-3, gravity: [0, 0, -9.81], density: 2500, mu: 0.3, e_n: 0.2, walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }, { point: [0, 0, 0], normal: [1, 0, 0] },
    { point: [0, 0, 0], normal: [0, 1, 0] }, { point: [0.063, 0, 0], normal: [-1, 0, 0] }, { point: [0, 0.063, 0], normal: [0, -1, 0] },
    { point: [0, 0, 0.042], normal: [0, 0, -1], load: { along: [0, 0, -1], force: 4, mass: 1, speed: 0.2 } }], bodies: [range(8) as \$i | range(8) as \$j | range(5) as \$k |
    { radius: (0.003 + 0.0002 * ((\$i * 7 + \$j * 3 + \$k * 11) % 5)), x: [\$i, \$j, \$k] | map((. + 0.55) * 0.0077) }
    | .x[0] += 2e-4 * (\$k * 12 | sin) | .x[1] += 2e-4 * (\$k * 7 | cos)]"
heavy() # STEPS OPTION ...
{
    nsd-step -n "$1" --wall-loads --log "$tmp/log" "${@:2}" -o "$tmp/out.h5" "$tmp/in.h5" 2>"$tmp/err"
}
ok "a heavy lid falls on balls: the same bytes" same_bytes 60
heavy 400 -e --every 400
is "a heavy lid falls on balls: no step fails" $? 0
ok "they are solved at once, in parts where they are fast" grep -q "steps that were made at once were divided" "$tmp/err"
ok "the balls get the momentum of the lid, and of its force" near "$(sums 'last.normal[5]') * 0.4" "0.2 + 4 * 0.4" 1e-4
ok "with overlaps of 4 R" near "$(jq -s 'map(.max_overlap) | max / 0.003' "$tmp/log")" 0 0.045
ok "the lid rests" near "$(jq -s 'last.balance.kinetic' "$tmp/log")" 0 1e-6
cp "$tmp/out.h5" "$tmp/in.h5"
heavy 40 --every 1
ok "they carry its force in each step: it does not shake" near "$(sums '.[1:] | map(.normal[5] / 4 - 1 | fabs) | max')" 0 1e-3
weight=$(nsd-info --last -p "$tmp/in.h5" | jq -s 'map(.mass // 0) | add * 9.81')
ok "and the floor and the sides carry it and their weight" near "$(sums 'last.force[0:5] | map(.[2]) | add')" "-4 - $weight" 1e-3
nsd-gen scenes/press.json | nsd-step -e -n 400 >"$tmp/out.h5" 2>"$tmp/err"
is "a piston of eight layers falls on 48 balls: no step fails" $? 0

# ---- walls that a torque turns ----

printf '%s\n' "v 0 -0.005 0.042" "v 0.09 -0.005 0.042" "v 0.09 0.07 0.042" "v 0 0.07 0.042" "f 1 2 3" "f 1 3 4" >"$tmp/flap.obj"
flap() # INERTIA SPEED TORQUE: of a flap that hangs at x = 0, z = 42 mm, and falls
{
    echo "{ mesh: { file: \"$tmp/flap.obj\" }, load: { about: [0, 0, 0.042], axis: [0, 1, 0], mass: $1, speed: $2, torque: $3 } }"
}
of_flap() # JQ PROGRAM: of its load in the last frame
{
    nsd-info --last -w "$tmp/out.h5" | jq -c "select(.load) | .load | $1" | head -n 1
}
mass='(2500 * 4e-6 / 3 * 3.14159265358979 * 0.216)' # of a radius of 6 mm
for inertia in 1e-6 1e-3; do # a touch at x = 0.05 moves by 0.05 per rad, along z
    scene "dt: 1e-4, gravity: [0, 0, 0], mu: 0, e_n: 0.5, walls: [$(flap $inertia 2 0)], bodies: [{ x: [0.05, 0.03, 0.0359], radius: 0.006, density: 2500 }]"
    nsd-step -n 40 --every 40 -o "$tmp/out.h5" "$tmp/in.h5" 2>"$tmp/err"
    ok "a flap of $inertia kg m^2 meets a ball: 1.5 u/(1 + m L^2/I)" \
        near "$(body '.v[2]') / (-1.5 * 2 * 0.05 / (1 + $mass * 0.0025 / $inertia))" 1 5e-3
    ok "and keeps its angular momentum with it" near "($(of_flap .speed) * $inertia - $(body '.v[2] * .x[0]') * $mass) / $inertia / 2" 1 5e-3
done
scene "dt: 1e-3, gravity: [0, 0, 0], walls: [$(flap 1 10 0)], bodies: [{ x: [0.05, 0.03, -0.1], radius: 0.006, fixed: true }]"
small_alone 10
# 10 rad/s 1e-3 s 0.114 m/(R r) = 19, and up to half more, for what is farthest is bounded
ok "small steps count the speed of its tip" near "$(sed -n 's/.*made in \([0-9]*\) small ones/\1/p' "$tmp/err") / 10" 24 5
scene "dt: 1e-3, gravity: [0, 0, -9.81], density: 2500, mu: 0.3, e_n: 0.2, walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }, { point: [0, 0, 0], normal: [1, 0, 0] },
    { point: [0, 0, 0], normal: [0, 1, 0] }, { point: [0.063, 0, 0], normal: [-1, 0, 0] }, { point: [0, 0.063, 0], normal: [0, -1, 0] }, $(flap 1.3e-3 3 0.12)],
    bodies: [range(8) as \$i | range(8) as \$j | range(5) as \$k | { radius: (0.003 + 0.0002 * ((\$i * 7 + \$j * 3 + \$k * 11) % 5)),
        x: [\$i, \$j, \$k] | map((. + 0.55) * 0.0077) } | .x[0] += 2e-4 * (\$k * 12 | sin) | .x[1] += 2e-4 * (\$k * 7 | cos)]"
ok "a heavy flap: the same bytes" same_bytes 40
heavy 260 -e --every 1
is "a heavy flap falls on balls: no step fails" $? 0
ok "it does not rebound" near "$(nsd-info -w "$tmp/out.h5" | jq -s 'map(select(.load) | .load.speed) | min')" 0 0.1
ok "and comes to rest" near "$(of_flap .speed)" 0 0.02

# ---- edges of a cell that are lighter than a row of grains ----

jq '.mu = 0.3 | .dt = 0.1 | .cell.lengths = [6.1, 6.1, 6.1] | .cell.stress = { pressure: 1, mass: 1 } | .bodies[0].random.count = 150 |
    .bodies[0].box = { x: [0, 6.1], y: [0, 6.1], z: [0, 6.1] }' scenes/isotropic.json | nsd-gen - >"$tmp/in.h5"
nsd-step -e -n 200 --every 200 --contacts --log "$tmp/log" -o "$tmp/out.h5" "$tmp/in.h5" 2>"$tmp/err"
is "a cell with light edges: no step fails" $? 0
ok "with overlaps of 4 R" near "$(jq -s 'map(.max_overlap) | max / 0.4' "$tmp/log")" 0 0.05
ok "it comes to rest at its pressure" near "$(nsd-stat --last -m stress "$tmp/out.h5" 2>"$tmp/stat" | jq '.stress.tensor | [.[0][0], .[1][1], .[2][2]] | map(. - 1 | fabs) | max')" 0 1e-3

# ---- a driven wall ----

# It pushes a small cube, with eight larger ones before it, over a floor with mu 1: 217 weights of the small one, in its 1200 N/m^2
row()
{
    scene "dt: 1e-3, gravity: [0, 0, -9.81], mu: 0, density: 2500, materials: { rough: {} }, shapes: { it: { box: [1, 1, 1] } },
        walls: [{ point: [0, 0, 0], normal: [0, 0, 1], material: \"rough\" }, { point: [-0.01, 0, 0], normal: [1, 0, 0], velocity: [0.01, 0, 0] }],
        pairs: [{ pair: [\"ball\", \"rough\"], mu: 1 }], bodies: [{ x: [0, 0, 0.01], shape: \"it\", size: 0.02 },
        (range(8) | { x: [(. * 0.06 + 0.04), 0, 0.03], shape: \"it\", size: 0.06 })]"
}
row
small_alone 200 --log "$tmp/log"
cp "$tmp/out.h5" "$tmp/in.h5"
small_alone 40 --wall-loads --log "$tmp/log"
ok "a driven wall pushes a row of cubes over a rough floor: it carries their friction" near "$(sums 'last.normal[1] / (217 * 9.81 * 0.02)')" 1 1e-3
ok "the cube that carries all of it overlaps by little more than 2 R" near "$(jq -s 'map(.max_overlap) | max / 0.03' "$tmp/log")" 0 0.025

# ---- orders of contacts ----

nsd-gen scenes/drum.json | nsd-step -n 300 --log "$tmp/small" >"$tmp/out.h5" 2>"$tmp/err"
for order in natural reverse random colour block; do
    nsd-gen scenes/drum.json | nsd-step --order "$order" -n 300 --log "$tmp/log" >"$tmp/out.h5" 2>"$tmp/err"
    ok "--order $order: it is said that one solve per step is made" [ "$(grep -c "one solve per step, as --order asks" "$tmp/err")" = 1 ]
    ok "with the kinetic energy of small steps, within its scatter" near "$(jq -s 'last.balance.kinetic' "$tmp/log") / $(jq -s 'last.balance.kinetic' "$tmp/small")" 1 0.2
    nsd-gen scenes/drum.json | nsd-step --order "$order" --small-steps 0.01 -n 300 --log "$tmp/both" >"$tmp/out.h5" 2>"$tmp/err"
    ok "with --small-steps they are made, and have their own order" cmp -s <(jq -c .balance "$tmp/both") <(jq -c .balance "$tmp/small")
done
ok "--solver says nothing of it" eval 'nsd-gen scenes/drum.json | nsd-step --solver nlgs --order natural -n 1 2>"$tmp/err" >"$tmp/out.h5" && ! grep -q "one solve per step" "$tmp/err"'
done_testing
