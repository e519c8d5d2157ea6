#!/usr/bin/env bash
# Bonds of adhesion of other shapes than balls, and of balls with surfaces, in small steps: closed forms, one solve per step, and what a
# resumed run finds.
# shellcheck source=tests/support/tap.sh
. tests/support/tap.sh
# shellcheck source=tests/support/small.sh
. tests/support/small.sh

shapes='shapes: { cube: { box: [0.1, 0.1, 0.1] }, brick: { box: [0.2, 0.1, 0.1] } }, mu: 0.3, density: 1000' # 1 kg, 2 kg
printf 'v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv 0.003 0.002 0\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n' >"$tmp/square.obj"
mesh="{ mesh: { file: \"$tmp/square.obj\" } }"
below='{ normal: [0, 0, -1], point: [0, 0, 0] }' # a ceiling
contacts() { nsd-info --last -c "$tmp/out.h5" | jq -s -c "$1"; }

# ---- at rest ----

# the four springs of the corners carry m g, and its moment about the middle of the bond, 15 mm off the centre of mass, as in laws.t
scene "dt: 2e-3, $shapes, adhesion: { c_n: 1e8, c_t: 5e7, w: 1e9, area: 1e-3 },
    bodies: [{ x: [0, 0, 0], shape: \"brick\", fixed: true }, { x: [0.03, 0, -0.1], shape: \"brick\" }]"
ok "a brick below another one is made in small steps" small_alone 3000 --contacts
ok "it hangs from the bonds of four corners, each of a quarter of the area" near "$(contacts 'map(select(.beta == 1 and .stiffness[0] == 2.5e4)) | length')" 4 0
ok "which carry its weight" near "$(contacts 'map(.r[0]) | add / (-2e-3) / 19.62')" 1 1e-5
ok "and its moment" near "$(contacts 'map(.gap) | max / (19.62 / 1e5 * (1 + 0.015 / 0.085))')" 1 1e-3
nsd-step --small-steps 0 --criterion natural --tolerance 1e-10 -n 300 --every 300 -o "$tmp/once.h5" "$tmp/in.h5" 2>"$tmp/err"
ok "as low as one solve per step leaves it" near "$(body '.x[2]' 1) / $(nsd-info --last -p "$tmp/once.h5" | jq 'select(.id == 1) | .x[2]')" 1 1e-6
cp "$tmp/once.h5" "$tmp/in.h5"
small_alone 100 --contacts
ok "small steps go on with what one solve per step has bonded" near "$(contacts 'map(.r[0]) | add / (-2e-3) / 19.62')" 1 1e-3
nsd-step --small-steps 0 --criterion natural --tolerance 1e-10 -n 100 --every 100 --contacts -o "$tmp/in.h5" "$tmp/out.h5" 2>"$tmp/err"
ok "and it with theirs" near "$(nsd-info --last -c "$tmp/in.h5" | jq -s 'map(select(.beta == 1) | .r[0]) | add / (-2e-3) / 19.62')" 1 1e-3
for wall in "$below" "$mesh"; do
    for it in 'shape: "cube"' 'radius: 0.05'; do
        scene "dt: 1e-3, $shapes, walls: [$wall], adhesion: { c_n: 1e8, w: 1e6, area: 1e-3 }, bodies: [{ x: [0, 0, -0.05], $it }]"
        small_alone 2000
        ok "below ${wall%%:*} }, ${it%%:*}: as low as its weight makes the bond" near "$(body '(-0.05 - .x[2]) / (.mass * 9.81 / 1e5)')" 1 1e-6
    done
done

# ---- strength ----

for w in 2.1 0.95; do # what comes at once stretches a spring up to twice as far
    scene "dt: 1e-4, $shapes, adhesion: { c_n: 1e12, c_t: 1e12, w: (($w * 9.81 / 1e-3) as \$s | \$s * \$s / 1e12), area: 1e-3 },
        bodies: [{ x: [0, 0, 0], shape: \"cube\", fixed: true }, { x: [0, 0, -0.1], shape: \"cube\" }]"
    small_alone 100
    ok "a cube hangs from a bond of $w times its weight, or does not" near "$(body '.x[2] > -0.1001 | if . then 1 else 0 end' 1)" "$w | floor | if . > 1 then 1 else 0 end" 0
done
# A force that grows by 1000 N/s reaches S (w c_n)^(1/2) = 100 N at 0.1 s. The bond then has the way (w/c_n)^(1/2), 1e-5 m, and opens at
# once: what the force does later moves the body. 0.01 (kg m/s): of what it does before
pulled="dt: 1e-4, gravity: [0, 0, 0], $shapes, adhesion: { c_n: 1e10, c_t: 1e10, w: 1, area: 1e-3 },
    forces: [{ bodies: [0], along: [0, 0, -1], force: { table: [[0, 0], [1, 1000]] } }]"
for wall in "$below" "$mesh"; do
    for it in 'shape: "cube"' 'radius: 0.05'; do
        scene "$pulled, walls: [$wall], bodies: [{ x: [0, 0, -0.05], $it }]"
        small_alone 990
        ok "below ${wall%%:*} }, ${it%%:*}: it bears 99 N" near "$(body '.x[2]')" -0.05 2e-5
        small 1500
        ok "and not more than 100 N: then the force moves it" near "$(body '-.v[2] * .mass')" "1000 * (0.15 * 0.15 - 0.1 * 0.1) / 2" 0.12
    done
done
scene "${pulled/bodies: \[0\]/bodies: [2]}, bodies: [{ x: [0, 0, 0], shape: \"cube\", fixed: true }, { x: [0, 0, -0.1], shape: \"cube\", density: 2 },
    { x: [0, 0, -0.2], shape: \"cube\" }]"
small_alone 980
ok "a light cube between two others bears 98 N" near "$(body '.x[2]' 2)" -0.2 4e-5
small 1500
ok "and not more than 100 N" near "$(body '-.v[2] * .mass' 2)" "1000 * (0.15 * 0.15 - 0.1 * 0.1) / 2" 0.2
# The force acts 5 cm above the floor: the two corners behind are pulled and sheared by F/4 each, which they bear up to 25 N/2^(1/2)
scene "${pulled/0, 0, -1/1, 0, 0}, walls: [{ normal: [0, 0, 1], point: [0, 0, 0] }], bodies: [{ x: [0, 0, 0.05], shape: \"cube\" }]"
small_alone 690
ok "on a floor, a cube bears 69 N from the side" near "$(body '.x[0]')" 0 5e-5
small 1500
ok "and not more than 71 N" near "$(body '.v[0] * .mass')" "1000 * (0.15 * 0.15 - 0.0707 * 0.0707) / 2" 0.25

# pulled apart at 1 m/s: S (w c)^(1/2) at most, and w S in all, to first order
for direction in '[1,0,0] 1e10' '[0,1,0] 5e9' '[0,0,-1] 5e9'; do
    read -r v c <<<"$direction"
    for dt in 2.5e-7 6.25e-8; do
        scene "dt: $dt, gravity: [0, 0, 0], mu: 0.3, allow_overlap: true, adhesion: { c_n: 1e10, c_t: 5e9, w: 0.02, area: 1e-6 }, shapes: { cube: { box: [2e-3, 2e-3, 2e-3] } },
            bodies: [{ x: [0, 0, 0], shape: \"cube\", density: 1e12 }, { x: [(0.002 - $dt / 2 * ${v}[0]), 0, 0], shape: \"cube\", density: 1e12, v: $v }]"
        rm -f "$tmp/log"
        nsd-step --small-steps 0.01 -n "$(jq -n "7e-5 / $dt | floor")" --contacts --log "$tmp/log" -o "$tmp/out.h5" "$tmp/in.h5" 2>"$tmp/err"
        jq -n -c --argjson peak "$(nsd-info -c "$tmp/out.h5" | jq -s "group_by(.step) | map(map(.r) | transpose | map(add) | map(. * .) | add | sqrt) | max / $dt")" \
            --argjson broken "$(jq -s 'map(.balance.broken) | add' "$tmp/log")" "[\$peak / (1e-6 * (0.02 * $c | sqrt)) - 1, \$broken / 2e-8 - 1]"
    done >"$tmp/bears"
    ok "pulled along $v four corners bear S sqrt(w c), and cost w S, to first order" jq -e -s \
        'map(map(fabs)) | .[1][0] < 0.04 and .[1][1] < 0.04 and .[1][0] < 0.4 * .[0][0] and .[1][1] < 0.4 * .[0][1]' "$tmp/bears"
done

# ---- made, broken, made again ----

for wall in "$below" "$mesh"; do
    for it in 'shape: "cube"' 'radius: 0.05'; do
        scene "dt: 1e-4, gravity: [0, 0, 0], $shapes, e_n: 0.8, walls: [$wall], adhesion: { c_n: 1e10, w: 1, area: 1e-3, forever: true }, bodies: [{ x: [0, 0, -0.0502], $it, v: [0, 0, 0.1] }]"
        small_alone 300
        ok "below ${wall%%:*} }, ${it%%:*}: what is bonded where it touches does not rebound" near "$(body '.x[2]')" -0.05 1e-6
    done
done
scene "dt: 1e-4, gravity: [0, 0, 0], $shapes, walls: [$below], adhesion: { c_n: 1e10, w: 1, area: 1e-3, forever: true }, bodies: [{ x: [0, 0, -0.05], shape: \"cube\" }],
    forces: [{ bodies: [0], along: [0, 0, -1], force: { table: [[0, 0], [0.02, 120], [0.021, -120], [0.03, -120], [0.031, 0]] } }]"
rm -f "$tmp/log"
small_alone 1000 --contacts --log "$tmp/log"
ok "a cube that has been torn off and pressed on again is bonded again, by the same area" near "$(contacts 'map(select(.beta == 1) | .stiffness[0]) | add')" 1e7 1
ok "for which w S has been given up once" near "$(jq -s 'map(.balance.broken) | add' "$tmp/log")" 1e-3 1e-4

# ---- bodies that move ----

for it in 'shape: "cube"' 'radius: 0.05'; do
    scene "dt: 1e-3, gravity: [0, 0, 0], $shapes, adhesion: { c_n: 1e7, c_t: 1e7, w: 1e6, made: 0 },
        bodies: [{ x: [-0.05, 0, 0], shape: \"cube\", v: [0, -0.5, 0], w: [0, 0, 10] }, { x: [0.05, 0, 0], $it, v: [0, 0.5, 0], w: [0, 0, 10] }]"
    rm -f "$tmp/log"
    small_alone 1000 --log "$tmp/log"
    for frame in in out; do
        nsd-info --last -p "$tmp/$frame.h5" | jq -s -c 'map([.mass * .v[0], .mass * .v[1],
            .mass * (.x[0] * .v[1] - .x[1] * .v[0] + .w[2] * 0.01 * (if .radius > 0.06 then 1 / 6 else 0.1 end))]) | transpose | map(add)'
    done >"$tmp/kept"
    ok "a cube and what is bonded to it, ${it%%:*}, spin as one body: they keep momentum and angular momentum" \
        jq -e -s 'transpose | map(.[0] - .[1] | fabs) | max < 1e-12' "$tmp/kept"
    ok "and the bond carries the force of their circle" near "$(nsd-info --last -p "$tmp/out.h5" | jq -s '.[0] as $a | .[1] as $b | [$a.x, $b.x] | transpose | map(.[0] - .[1] | . * .) | add | sqrt - 0.1 |
        . / (([$a.radius, $b.radius] | min) as $r | $a.mass * $b.mass / ($a.mass + $b.mass) * 0.1 * 99.8 / (3.14159265 * $r * $r * 1e7))')" 1 0.03
    ok "and they dissipate what the bonds have damped, not less than nothing" near "$(jq -s 'map(.balance) | (map(.dissipation) | min) / .[0].kinetic' "$tmp/log")" 0 1e-7
done
# A brick bonded to a floor that carries it out of a cell that repeats, twice along one edge and once along the other
scene "dt: 1e-3, $shapes, cell: { lengths: [0.5, 0.5, 1], repeats: [true, true, false] }, adhesion: { c_n: 1e9, c_t: 5e8, w: 1e9, area: 1e-3 },
    walls: [{ point: [0, 0, 0], normal: [0, 0, 1], velocity: [2, -1, 0] }], bodies: [{ x: [0.1, 0.1, 0.05], shape: \"brick\", v: [2, -1, 0] }]"
small_alone 500 --contacts
ok "a brick rides on the floor that it is bonded to, through the border of a cell that repeats" \
    near "$(body 'if .image == [2, -1, 0] then [.x[0] - 0.1, .x[1] - 0.1, .x[2] - 0.05, .w[]] | map(fabs) | max else 1 end')" 0 1e-7
ok "by its four bonds" near "$(contacts 'map(select(.beta == 1)) | length')" 4 0
# a ball that rolls down a slope, bonded: the place of its bond goes with it
for wall in '{ normal: [0, 0, 1], point: [0, 0, 0] }' "$mesh"; do
    scene "dt: 1e-4, gravity: [2, 1, -1], $shapes, walls: [$wall], adhesion: { c_n: 1e7, w: 1e6, area: 1e-3 }, bodies: [{ x: [0, 0, 0.05], radius: 0.05 }]"
    small_alone 1500
    ok "a ball bonded to ${wall%%:*} } rolls: 5/14 g t^2" near "$(body '.x[0]')" "5 / 14 * 2 * 0.15 * 0.15" 1e-5
done
# a lid, bonded to a cube on a floor, that a force lifts
for force in 90 110; do
    scene "dt: 1e-4, gravity: [0, 0, 0], $shapes, adhesion: { c_n: 1e10, w: 1, area: 1e-3 }, walls: [{ normal: [0, 0, 1], point: [0, 0, 0] },
        { normal: [0, 0, -1], point: [0, 0, 0.1], load: { along: [0, 0, 1], force: { table: [[0, 0], [0.1, $force]] }, mass: 0.1 } }], bodies: [{ x: [0, 0, 0.05], shape: \"cube\" }]"
    small_alone 1100
    ok "a lid that is bonded to a cube on a floor bears 90 N and not 110 N: $force" \
        near "$(nsd-info --last -w "$tmp/out.h5" | jq 'select(.load) | .load.travel < 4e-5 | if . then 1 else 0 end' | head -n 1)" "if $force < 100 then 1 else 0 end" 0
done

# ---- many ----

grains() # LAW: cubes, rods, clumps and balls that fall into a box, or on a surface, and stick
{
    jq -n "{ dt: 1e-4, mu: 0.4, e_n: 0.2, density: 2500, adhesion: { c_n: 1e8, c_t: 5e7, w: 5e-4, forever: true },
        shapes: { cube: { box: [0.008, 0.008, 0.008] }, rod: { capsule: { length: 0.008, radius: 0.003 } }, duo: { balls: [[-0.003, 0, 0, 0.004], [0.003, 0, 0, 0.004]] } },
        bodies: ([[\"cube\", 0], [\"rod\", 1], [\"duo\", 2]] | map({ count: 12, shape: .[0], box: { x: [0, 0.05], y: [0, 0.05], z: [0.03 * .[1], null] }, v: [0, 0, -0.3] }) +
            [{ count: 12, radius: 0.004, box: { x: [0, 0.05], y: [0, 0.05], z: [0.09, null] }, v: [0, 0, -0.4] }]) } + $1" | nsd-gen - >"$tmp/in.h5"
}
box='walls: [{ box: { x: [0, 0.05], y: [0, 0.05], z: [0, null] } }]'
grains "{ walls: [$mesh], capillary: { volume: 1e-10, tension: 0.07 }, rolling: { mu_r: 1e-4, mu_p: 5e-5 } }"
ok "wet grains that stick to a surface: the same bytes" same_bytes 300
for law in "{ $box }" "{ walls: [$mesh] }"; do
    grains "$law"
    ok "grains that stick, ${law:9:4}: the same bytes" same_bytes 450
    rm -f "$tmp/log"
    small_alone 900 --log "$tmp/log"
    ok "bonds have been made, and some have broken" jq -e -s '(map(.balance.broken) | max) > 1e-7 and (map(.balance.bond_energy) | max) > 1e-8' "$tmp/log"
    ok "a step gains no energy" near "$(jq -s 'map(.balance) | (map(.dissipation) | min) / (map(.kinetic) | max)' "$tmp/log")" 0 2e-3
    ok "and overlaps are those of other grains" near "$(last .account.overlap.value)" 0 0.01
done
# Three cubes in a row, held at one end, bend by their weight: as many solves have it
scene "dt: 1e-3, $shapes, adhesion: { c_n: 1e8, c_t: 5e7, w: 1e9, area: 1e-3 }, bodies: [{ x: [0, 0, 0], shape: \"cube\", fixed: true },
    { x: [0.1, 0, 0], shape: \"cube\" }, { x: [0.2, 0, 0], shape: \"cube\" }]"
small_alone 20
nsd-step --small-steps 0 --dt 1e-4 --tolerance 1e-4 --until 0.02 --every 0.02s -o "$tmp/once.h5" "$tmp/in.h5" 2>"$tmp/err"
ok "cubes in a row that are bonded bend as with many solves" near "$(body '.x[2]' 2) / $(nsd-info --last -p "$tmp/once.h5" | jq 'select(.id == 2) | .x[2]')" 1 0.03

done_testing
