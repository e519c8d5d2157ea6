#!/usr/bin/env bash
# Small steps with grains of any shape and with surfaces: sliding, tipping, rolling, impacts, free turning and rest in closed
# form, surfaces as planes, a pour as the large step makes it, the same bytes for threads, vector widths and resumed runs.
# shellcheck source=tests/support/tap.sh disable=SC2154,SC2016 # jq, tap.sh sets tmp
. tests/support/tap.sh
# shellcheck source=tests/support/small.sh
. tests/support/small.sh

floor='walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }], gravity: [0, 0, -9.81], dt: 1e-3, density: 1000'
cube='shapes: { it: { box: [1, 1, 1] } }'
at_rest() # ENERGY: J; nothing overlaps by more than 0.01 of a radius
{
    near "$(last .kinetic_energy)" 0 "$1" && near "$(last .account.overlap.value)" 0 0.01
}

# ---- one body ----

scene "$floor, mu: 0.3, shapes: { it: { box: [2, 1, 0.5] } }, bodies: [{ shape: \"it\", size: 0.1, x: [0, 0, 0.025], v: [1, 0, 0] }]"
small_alone 500
ok "a box that slides stops after v^2/(2 mu g)" near "$(body '.x[0]')" "1 / (2 * 0.3 * 9.81)" 1e-5
ok "the floor's impulse is m g dt" near "$(last '.balance.impulse[2]')" "9.81e-3" 1e-6
scene 'dim: 2, walls: [{ point: [0, 0], normal: [0, 1] }], gravity: [0, -9.81], dt: 1e-3, mu: 0.3,
    shapes: { it: { points: [[-1, -0.5], [1, -0.5], [1, 0.5], [-1, 0.5]] } }, bodies: [{ shape: "it", size: 0.1, x: [0, 0.05], v: [1, 0] }]'
small_alone 500
ok "so does a polygon in the plane" near "$(body '.x[0]')" "1 / (2 * 0.3 * 9.81)" 1e-5
incline() # SLOPE GRAVITY, as jq has it
{
    echo "gravity: ($1 | atan | [9.81 * sin, 0, -9.81 * cos]), walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }], dt: 1e-3, density: 1000"
}
scene "$(incline 0.49), mu: 0.5, $cube, bodies: [{ shape: \"it\", size: 0.1, x: [0, 0, 0.05] }]"
small_alone 500
ok "a cube on a slope of 0.49 stays with mu 0.5" near "$(body '.v[0]')" 0 1e-8
scene "$(incline 0.51), mu: 0.5, $cube, bodies: [{ shape: \"it\", size: 0.1, x: [0, 0, 0.05] }]"
small_alone 500
ok "and slides on one of 0.51" near "$(body '.v[0]')" "0.5 * 9.81 * 0.01 * (0.51 | atan | cos)" 1e-3
for slope in 0.24 0.26; do
    scene "$(incline $slope), mu: 0.9, shapes: { it: { box: [1, 1, 4] } }, bodies: [{ shape: \"it\", size: 0.1, x: [0, 0, 0.2] }]"
    small_alone 500
    ok "a tower four times as high as wide on a slope of $slope $([ $slope = 0.24 ] && echo stands || echo tips)" \
        eval "jq -en '($(body '.w[1]') > 0.1) == ($slope > 0.25)' >\"\$tmp/near\""
done
scene "$floor, mu: 0.3, shapes: { it: { balls: [[0, 0, 0, 1]] } }, bodies: [{ shape: \"it\", size: 0.1, x: [0, 0, 0.1], v: [1, 0, 0] }]"
small_alone 500
ok "a clump of one ball rolls at 5/7" near "$(body '.v[0]')" "5 / 7" 1e-4
scene 'dim: 2, walls: [{ point: [0, 0], normal: [0, 1] }], gravity: [0, -9.81], dt: 1e-3, mu: 0.3,
    shapes: { it: { balls: [[0, 0, 1]] } }, bodies: [{ shape: "it", size: 0.1, x: [0, 0.1], v: [1, 0] }]'
small_alone 500
ok "one of one disc at 2/3" near "$(body '.v[0]')" "2 / 3" 1e-4
for e in 0 0.5 1; do
    scene "$floor, gravity: [0, 0, 0], mu: 0.4, e_n: $e, $cube, bodies: [{ shape: \"it\", size: 0.1, x: [0, 0, 0.06], v: [0, 0, -1] }]"
    small_alone 40
    ok "a cube that lands flat rebounds with e $e" near "$(body '.v[2]')" "$e" 2e-3
    ok "and does not turn" near "$(body '.w | map(. * .) | add | sqrt')" 0 0.1
done
# A cube that strikes with an edge, its centre at (c, h) from it: J = (1 + e) v m/(1 + c^2 m/I)
scene "$floor, gravity: [0, 0, 0], mu: 0, e_n: 0.5, $cube,
    bodies: [{ shape: \"it\", size: 0.1, x: [0, 0, 0.08], v: [0, 0, -1], orientation: [0, 0.3926990817, 0] }]"
small_alone 20
ok "a cube that strikes with an edge" near "$(body '.v[2]')" "-1 + 1.5 / (1 + 6 * (0.3926990817 | (cos - sin) * 0.5 | . * .))" 0.02
# A rod at an angle whose tip reverses its slip: Newton's law with friction would give it 1.15 times its energy [Kane 1984].
scene "$floor, gravity: [0, 0, 0], mu: 1.5, e_n: 1, shapes: { it: { capsule: { length: 1, radius: 0.02 } } },
    bodies: [{ shape: \"it\", x: [0, 0, 0.365], v: [-0.3, 0, -0.5], orientation: [0, 0.7, 0] }]"
before=$(nsd-info --last -l "$tmp/in.h5" | jq .kinetic_energy)
small_alone 120
ok "a rod gains no energy from an impact" near "$(last .kinetic_energy) / $before" 0.995 0.005
scene "gravity: [0, 0, 0], dt: 1e-3, shapes: { it: { box: [3, 2, 1] } }, bodies: [{ shape: \"it\", size: 0.1, x: [0, 0, 0], w: [0.1, 10, 0.1] }]"
before=$(nsd-info --last -l "$tmp/in.h5" | jq .kinetic_energy)
small_alone 2000
ok "a body that turns about its middle axis keeps its energy" near "$(last .kinetic_energy) / $before" 1 1e-5
q=$(body .q)
nsd-step -n 2000 --every 2000 -o "$tmp/out.h5" "$tmp/in.h5" 2>"$tmp/err"
ok "and tumbles as in large steps" near "[$q, $(body .q)] | transpose | map(.[0] * .[1]) | add" 1 1e-3


# ---- laws ----

block='shapes: { it: { box: [3, 2, 1] } }, bodies: [{ shape: "it", size: 0.1, x: [0, 0, 0.05], v: [1, 0, 0] }]' # m = 6 kg
scene "gravity: [0, 0, 0], dt: 1e-3, density: 1000, $block, forces: [{ bodies: [0], about: [0, 0, 1], torque: 0.1 }]"
ok "a torque on a box is made in small steps" small_alone 100
ok "a constant torque about a principal axis: w = T t/I" near "$(body '.w[2]')" "0.1 * 0.1 / (6 * 0.13 / 12)" 1e-9
ok "its work is the kinetic energy: nothing is dissipated" near "$(last '.balance | .dissipation / .loads')" 0 1e-9
sums() # JQ PROGRAM: of the sums that walls keep
{
    nsd-stat --last -m sums "$tmp/out.h5" 2>"$tmp/stat" | jq -c ".sums | $1"
}
scene "$floor, mu: 0.3, $block"
ok "sums of walls are kept" small_alone 400 --wall-loads
ok "a box that slides until it rests: friction takes its energy" near "$(sums '.friction[0]') / 3" 1 2e-3
ok "and pushes the floor by its momentum" near "$(sums '.force[0][0] * 0.4') / 6" 1 2e-3
ok "which carries m g" near "$(sums '.normal[0]') / (6 * 9.81)" 1 1e-3
for mu in 0.45 0.55; do
    scene "$(incline 0.5), mu: 0.3, mu_s: $mu, v_s: 1e-3, $cube, bodies: [{ shape: \"it\", size: 0.1, x: [0, 0, 0.05] }]"
    small_alone 300
    ok "static friction of $mu $([ $mu = 0.55 ] && echo holds || echo releases) a cube on a slope of 0.5" \
        eval "jq -en '($(body '.v[0]') > 0.3) == ($mu < 0.5)' >\"\$tmp/near\""
done

# ---- loads ----

load() # JQ PROGRAM: of the first load of the last frame
{
    nsd-info --last -w "$tmp/out.h5" | jq -c "select(.load) | .load | $1" | head -n 1
}
scene "$floor, walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }, { point: [0, 0, 0.12], normal: [0, 0, -1], load: { along: [0, 0, -1], force: 20, mass: 0.5 } }],
    mu: 0.5, e_n: 0.2, $cube, bodies: [{ shape: \"it\", size: 0.1, x: [0, 0, 0.05] }]"
small_alone 400
ok "a lid that falls on a cube comes to rest on it" near "$(load '[.travel - 0.02, .speed] | map(fabs) | max')" 0 1e-4
cp "$tmp/out.h5" "$tmp/in.h5"
small_alone 20 --wall-loads
ok "the cube carries the load" near "$(sums '.normal[1]')" 20 1e-5
ok "and the floor carries both" near "$(sums '.normal[0]')" "20 + 9.81" 1e-4
scene "dt: 1e-3, gravity: [0, 0, 0], density: 1000, mu: 0, e_n: 0.5, $cube, bodies: [{ shape: \"it\", size: 0.1, x: [0, 0, 0.052] }],
    walls: [{ point: [0, 0, 0], normal: [0, 0, 1], load: { along: [0, 0, 1], mass: 1, speed: 1 } }]"
small_alone 30
ok "a wall of 1 kg strikes a cube of 1 kg at 1 m/s, e 0.5: 0.75 and 0.25 m/s" near "$(body '.v[2]') + $(load .speed) / 1e3" 0.75025 1e-3
# One column of boxes in 45 carries the whole lid.
scene "dt: 1e-3, gravity: [0, 0, 0], density: 2500, mu: 0.3, e_n: 0.2, shapes: { it: { box: [1, 0.8, 0.9] } },
    walls: [{ box: { x: [0, 0.03], y: [0, 0.03], z: [0, null] } }, { point: [0, 0, 0.065], normal: [0, 0, -1], load: { pressure: 1000 } }],
    bodies: [range(3) as \$i | range(3) as \$j | range(5) as \$k | { shape: \"it\", size: 0.006, orientation: [\$i, \$j, \$k],
        x: [0.0055 + 0.0095 * \$i, 0.0055 + 0.0095 * \$j, 0.006 + 0.012 * \$k] }]"
ok "boxes below a lid: the same bytes" same_bytes 60
small_alone 300 --log "$tmp/log"
ok "and overlaps of 0.015 of half their thickness at rest, from no load to that of the lid" near "$(jq -s 'last.max_overlap / 0.0024' "$tmp/log")" 0 0.015
scene 'dim: 2, dt: 1e-3, gravity: [0, 0], density: 2500, mu: 0.3, e_n: 0.2, walls: [{ name: "box", box: { x: [0, 0.05], y: [0, 0.05] } }],
    room: { walls: "box", pressure: 500 }, shapes: { it: { regular: { sides: 5, radius: 1 } } },
    bodies: [range(5) as $i | range(5) as $j | { shape: "it", size: 0.004, x: [0.005 + 0.0099 * $i, 0.005 + 0.0099 * $j], orientation: ($i + $j) }]'
small_alone 400
cp "$tmp/out.h5" "$tmp/in.h5"
small_alone 20 --wall-loads
ok "a room around pentagons comes to rest at the mean pressure" near "$(sums '.normal | add') / $(load .face) / 4" 500 1e-3

# ---- attraction ----

ceiling='gravity: [0, 0, -9.81], dt: 1e-3, density: 1000, e_n: 0, mu: 0.5'
plane='{ point: [0, 0, 0], normal: [0, 0, -1] }'
four='[-0.5, -0.5], [-0.5, 0.5], [0.5, -0.5], [0.5, 0.5] | { rectangle: { center: (. + [0]), normal: [0, 0, -1], along: [1, 0, 0], sides: [1, 1] } }'
for wall in "$plane" "$four"; do
    for part in 1.1 0.9; do
        scene "$ceiling, walls: [$wall], cohesion: { force: ($part * 9.81) }, $cube, bodies: [{ shape: \"it\", size: 0.1, x: [0.02, 0.03, -0.05] }]"
        small_alone 100
        ok "cohesion of $part times the weight $([ $part = 1.1 ] && echo holds || echo "does not hold") a cube at a ceiling" \
            near "$(body '.v[2]')" "if $part > 1 then 0 else -0.981 end" 0.03
    done
done
scene "$ceiling, walls: [$plane], cohesion: { force: (0.9 * 9.81), range: 1e-3 }, $cube, bodies: [{ shape: \"it\", size: 0.1, x: [0, 0, -0.05] }]"
rm -f "$tmp/log"
small_alone 100 --log "$tmp/log" # 1 mm at 0.1 g, then g
ok "a cube falls out of the range of cohesion" near "$(body '.v[2]')" "-((2e-3 * 0.981 | sqrt) + 9.81 * (0.1 - (2e-3 / 0.981 | sqrt)))" 0.01
ok "and nothing is dissipated" near "$(jq -s 'map(.balance.dissipation) | add' "$tmp/log")" 0 1e-4
scene "gravity: [0, 0, 0], dt: 1e-3, density: 1000, mu: 0.5, e_n: 0, $cube, capillary: { volume: 1e-9, tension: 0.07 },
    bodies: [{ shape: \"it\", size: 0.01, x: [0, 0, 0], v: [0, 0, 0.1] }, { shape: \"it\", size: 0.01, x: [0, 0, 0.0101] }]"
small_alone 30
ok "two cubes that meet stay together by their bridge" near "$(body '.v[2]') - $(body '.v[2]' 1)" 0 1e-4
ok "which is one" near "$(nsd-info --last -l "$tmp/out.h5" | jq -s 'map(select(.balance)) | last.balance.bond_energy')" "-9.1e-7" 2e-8
ok "the same bytes" same_bytes 30

# ---- surfaces ----

{
    for i in 0 1 2 3 4 5 6; do
        for j in 0 1 2 3 4 5 6; do
            jq -nr "\"v \(-1 + 0.4 * $i + 0.03 * ((7 * $i + 3 * $j) % 5)) \(-1 + 0.4 * $j + 0.02 * ((3 * $i + 5 * $j) % 4)) 0\""
        done
    done
    for i in 0 1 2 3 4 5; do
        for j in 0 1 2 3 4 5; do
            a=$((7 * i + j + 1))
            echo "f $a $((a + 7)) $((a + 8))"
            echo "f $a $((a + 8)) $((a + 1))"
        done
    done
} >"$tmp/floor.obj"
mesh="walls: [{ mesh: { file: \"$tmp/floor.obj\" } }], gravity: [0, 0, -9.81], dt: 1e-3, density: 1000"
scene "$mesh, mu: 0.3, bodies: [{ radius: 0.1, x: [-0.5, 0, 0.1], v: [1, 0.2, 0] }]"
small_alone 700
ok "a ball rolls over the edges of a surface" near "$(body '.v[0]')" "5 / 7" 1e-4
ok "without a bump" near "$(body '.v[2]')" 0 1e-6
small_alone 700 --wall-loads
ok "friction on the triangles takes 2/7 of its energy" near "$(sums '.friction | add') / (1000 * 4 / 3 * 3.14159265 * 1e-3 * 1.04 / 7)" 1 1e-3
ok "and straight" near "$(body '.v[1] / .v[0]')" 0.2 1e-5
boxes='shapes: { it: { box: [2, 1, 0.5] } }, mu: 0.3, bodies: [{ shape: "it", size: 0.1, x: [-0.5, 0, 0.025], v: [1, 0.2, 0] }]'
scene "$mesh, $boxes"
small_alone 500
over=$(body '.x[0]')
scene "$floor, $boxes"
small_alone 500
ok "a box slides over them as on a plane" near "$over" "$(body '.x[0]')" 1e-5

tiles='walls: [-0.35, 1.65 | { rectangle: { center: [., 0, 0], normal: [0, 0, 1], along: [1, 0, 0], sides: [2, 2] } }]'
scene "$tiles, gravity: [0, 0, -9.81], dt: 1e-3, mu: 0.3, bodies: [{ radius: 0.1, x: [0.3, 0, 0.1], v: [1, 0, 0] }]"
small_alone 600 # from one rectangle to the next at x = 0.65
ok "a ball rolls from one rectangle to the next" near "$(body '.v[0]')" "5 / 7" 2e-5
ok "without a bump, too" near "$(body '.v[2]')" 0 1e-6
scene "$tiles, gravity: [0, 0, 9.81], dt: 1e-3, cohesion: { force: 30 }, bodies: [{ radius: 0.1, x: [0.65, 0, 0.1], density: 1000 }]"
small_alone 100
ok "at the seam one of them attracts a ball, which falls: both would hold it" near "$(body '.v[2]')" 0.97 0.02

# ---- many ----

scene "$floor, mu: 0.5, $cube, bodies: [range(5) | { shape: \"it\", size: 0.1, x: [0.01 * (. % 2), 0, 0.05 + 0.105 * .] }]"
small_alone 2000
ok "five cubes that fall on each other rest" at_rest 1e-12
scene 'dim: 2, walls: [{ point: [0, 0], normal: [0, 1] }], gravity: [0, -9.81], dt: 1e-3, mu: 0.5, density: 1000,
    shapes: { it: { regular: { sides: 4, radius: 1 } } }, bodies: [range(4) | { shape: "it", size: 0.1, x: [0.01 * (. % 2), 0.0708 + 0.145 * .], orientation: 0.785398163 }]'
small_alone 2000
ok "four squares in the plane, too" at_rest 1e-12
scene "$floor, mu: 0.5, shapes: { it: { balls: [[-1, 0, 0, 0.6], [0, 0.6, 0, 0.6], [1, 0, 0, 0.6]] } },
    bodies: [range(3) | { shape: \"it\", size: 0.1, x: [0, 0, 0.065 + 0.13 * .], orientation: [0, 0, 1.3 * .] }]"
small_alone 3500
ok "concave clumps fall over and rest" at_rest 1e-12

# elastic boxes in shear flow, in a periodic cell whose edges do work
scene 'dt: 1e-3, gravity: [0, 0, 0], mu: 0, e_n: 1, density: 2500, shapes: { it: { box: [1, 0.8, 1.2] } },
    cell: { lengths: [0.05, 0.05, 0.05], gradient: [[0, 0, 20], [0, 0, 0], [0, 0, 0]] },
    bodies: [range(5) as $i | range(5) as $j | range(5) as $k | { shape: "it", radius: 0.004, x: [$i, $j, $k] | map((. + 0.5) * 0.01) }
        | .v = [(.x[0] * 7e4 | sin), (.x[1] * 5e4 + 1 | sin), (.x[2] * 6e4 + 2 | sin)]]'
ok "boxes in a cell that shears are made in small steps" small_alone 10 --log "$tmp/log"
jq -s 'map(.balance) | [(map(.drives) | add), (map(.dissipation) | add), .[-1].kinetic]' "$tmp/log" >"$tmp/first"
ok "what the edges do is not dissipated" near "$(jq '.[1] / .[2]' "$tmp/first")" 0 0.02
energy=$(last .kinetic_energy)
nsd-step --small-steps 0 --dt 5e-5 -n 200 --every 200 -o "$tmp/out.h5" "$tmp/in.h5" 2>"$tmp/err"
ok "their energy is that of many solves" near "$energy / $(last .kinetic_energy)" 1 0.03
ok "they have the same bytes" same_bytes 10

pour='walls: [{ box: { x: [0, 0.06], y: [0, 0.06], z: [0, null] } }], gravity: [0, 0, -9.81], dt: 1e-3, density: 2000, mu: 0.4, seed: 2,
    shapes: { box: { box: [0.01, 0.008, 0.006] }, clump: { balls: [[0, 0, 0, 0.004], [0.005, 0, 0, 0.004]] },
        capsule: { capsule: { length: 0.008, radius: 0.003 } } },
    bodies: ([["box", 60, 0], ["clump", 40, 0.08], ["capsule", 40, 0.16], [null, 30, 0.24]] | map({ shape: .[0], count: .[1],
        orientation: "random", box: { x: [0, 0.06], y: [0, 0.06], z: [.[2], null] } }
        | if .shape then . else del(.shape, .orientation) + { radius: 0.004 } end))'
scene "$pour"
small_alone 300
ok "a pour of several shapes: overlaps of at most 0.02 radii" near "$(last .account.overlap.value)" 0 0.02
height=$(last .potential_energy) energy=$(last .kinetic_energy)
nsd-step -n 300 --every 300 -o "$tmp/out.h5" "$tmp/in.h5" 2>"$tmp/err"
ok "as high as the large step makes it" near "$height / $(last .potential_energy)" 1 0.05
ok "and nearly at rest" near "$energy / $height" 0 0.01
ok "it has the same bytes for threads, lanes and resumed runs" same_bytes 60

done_testing
