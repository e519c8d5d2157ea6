#!/usr/bin/env bash
# Grains of other shapes than balls, through the tools: what is known of bricks, towers, capsules and clumps;
# threads, the pipeline, documents; and shapes that are none.
. tests/support/tap.sh

# scene SHAPES BODIES [REST]: on a floor, in space
scene()
{
    printf '{"dt": 1e-3, "mu": 0.5, "shapes": {%s}, "bodies": [%s], "walls": [{"point": [0, 0, 0], "normal": [0, 0, 1]}] %s}' \
        "$1" "$2" "${3-}"
}
brick='"brick": {"box": [0.2, 0.2, 0.1]}' cube='"cube": {"box": [0.1, 0.1, 0.1]}'
last() { nsd-info --last "$1" | jq "$2"; }
below() { jq -n "($1) < ($2)"; }

# ---- what is known ----

# On a slope of tan = t gravity leans; a brick of width 0.2 and height 0.1 tips only at t = 2.
lean() # t mu shape: the speed after half a second, m/s, and the spin, rad/s
{
    scene "$brick, \"tall\": {\"box\": [0.1, 0.2, 0.2]}" "{\"x\": [0, 0, $4], \"shape\": \"$3\"}" ", \"gravity\": [$(jq -n "9.81 * $1"), 0, -9.81]" |
        jq ".mu = $2" | nsd-gen - | nsd-step -n 500 --every 500 --tolerance 1e-8 --warm 2>/dev/null | nsd-info --last -p | jq -c '[.v[0], .w[1]]'
}
is 'a brick on a slope less steep than its friction stays' "$(lean 0.49 0.5 brick 0.05 | jq 'map(fabs < 1e-3) | all')" true
is 'on a steeper one it slides with g (tan - mu)' \
    "$(lean 0.6 0.5 brick 0.05 | jq '(.[0] / (9.81 * 0.1 * 0.5) - 1 | fabs) < 0.01 and (.[1] | fabs) < 1e-3')" true
is 'twice as high as wide, it stands at tan = 0.49' "$(lean 0.49 0.9 tall 0.1 | jq 'map(fabs < 1e-3) | all')" true
is 'and tips at 0.51, width over height' "$(lean 0.51 0.9 tall 0.1 | jq '.[1] > 0.02')" true

# A cube that falls on a corner comes to rest on a face, and its reactions carry it.
scene "$cube" '{"x": [0, 0, 0.12], "shape": "cube", "orientation": [0.5, 0.3, 0.1]}' |
    nsd-gen - | nsd-step -n 1500 --every 500 --contacts --tolerance 1e-8 --warm 2>/dev/null >"$tmp/cube.h5"
is 'a cube that is dropped rests on four corners' "$(last "$tmp/cube.h5" .contacts)" 4
is 'that carry its weight' \
    "$(nsd-info --last -c "$tmp/cube.h5" | jq -s '(map(.r[0]) | add) / (2500e-3 * 9.81 * 1e-3) - 1 | fabs < 1e-6')" true
is 'flat, and on the floor' "$(nsd-info --last -p "$tmp/cube.h5" | jq '(.x[2] - 0.05 | fabs) < 1e-5')" true
is 'at rest' "$(last "$tmp/cube.h5" '.kinetic_energy < 1e-10')" true

# Symmetric: from a full solution all corners carry the same.
scene "$cube" '{"x": [0, 0, 0.05], "shape": "cube"}' | jq '.mu = 0' | nsd-gen - | nsd-detect --gap 1e-9 |
    nsd-solve -m exact --solver auto --tolerance 1e-10 2>/dev/null | nsd-info -c |
    jq -s 'map(.r[0]) | (max - min) / max < 1e-3' >"$tmp/equal"
is 'its corners carry equal parts' "$(cat "$tmp/equal")" true

# A tower of 20 bricks
scene "$brick" "$(for k in {0..19}; do printf '%s{"x": [0, 0, %s], "shape": "brick"}' "${sep-}" "$(jq -n "0.05 + 0.1 * $k")"; sep=,; done)" |
    nsd-gen - >"$tmp/tower.h5"
nsd-step -n 1000 --every 1000 --contacts --warm "$tmp/tower.h5" 2>/dev/null >"$tmp/stands.h5"
is 'a tower of 20 bricks has four contacts a joint' "$(last "$tmp/stands.h5" .contacts)" 80
is 'and stands' "$(nsd-info --last -p "$tmp/stands.h5" | jq -s '.[-1].x | (.[2] - 1.95 | fabs) < 2e-3 and (.[0] | fabs) < 2e-3')" true

# A capsule rolls down a slope as a cylinder with round ends does: a = g sin / (1 + I/(m r^2)).
scene '"pill": {"capsule": {"length": 0.3, "radius": 0.1}}' '{"x": [0, 0, 0.1], "shape": "pill", "orientation": [0, 0, 1.5707963267948966]}' \
    ', "gravity": [1, 0, -9.81]' | nsd-gen - | nsd-step -n 500 --every 500 --tolerance 1e-10 --warm 2>/dev/null >"$tmp/pill.h5"
is 'a capsule rolls as fast as its moment of inertia lets it' \
    "$(nsd-info --last -p "$tmp/pill.h5" | jq '3.141592653589793 as $p | ($p * 0.3 * 1e-2) as $c | (4 / 3 * $p * 1e-3) as $b |
        (($c / 2 + 0.4 * $b) / ($c + $b)) as $k | (.v[0] / (0.5 / (1 + $k)) - 1 | fabs) < 1e-3')" true

# A clump of one ball is a ball, but for the lever arms in what overlaps.
scene '"one": {"balls": [[0, 0, 0, 0.1]]}' '{"x": [0, 0, 0.1], "shape": "one", "v": [1, 0, 0]}' | nsd-gen - |
    nsd-step -n 400 --every 400 --tolerance 1e-10 2>/dev/null | nsd-info --last -p | jq -c '[.x[0], .v[0], .w[1]]' >"$tmp/clump"
scene '' '{"x": [0, 0, 0.1], "radius": 0.1, "v": [1, 0, 0]}' | nsd-gen - |
    nsd-step -n 400 --every 400 --tolerance 1e-10 --overlap-rule gap-project 2>/dev/null | nsd-info --last -p | jq -c '[.x[0], .v[0], .w[1]]' >"$tmp/ball"
is 'a clump of one ball moves as the ball' \
    "$(jq -s '[.[0], .[1]] | transpose | map((.[0] / .[1] - 1 | fabs) < 1e-4) | all' "$tmp/clump" "$tmp/ball")" true

# In the plane: a polygon of 60 sides rolls as a disc does, to the difference of their sides.
plane()
{
    printf '{"dim": 2, "dt": 1e-3, "mu": 0.9, "gravity": [1, -9.81], "shapes": {"many": {"regular": {"sides": 100, "radius": 0.1}}},
        "bodies": [{"x": [0, 0.1], %s}], "walls": [{"point": [0, 0], "normal": [0, 1]}]}' "$1" |
        nsd-gen - | nsd-step -n 500 --every 500 --warm 2>/dev/null | nsd-info --last -p | jq '.v[0]'
}
disc=$(plane '"radius": 0.1') many=$(plane '"shape": "many"')
is "a polygon of 100 sides rolls nearly as a disc ($many, $disc)" "$(below "($many - $disc) / $disc | fabs" 0.1)" true

# arch THICKNESS BLOCKS: a semicircular arch of mean radius 1 that stands on the floor, its stones not mortared
arch()
{
    awk -v t="$1" -v n="$2" 'BEGIN {
        d = atan2(0, -1) / n; i = 1 - t / 2; o = 1 + t / 2; s = sin(d / 2); c = cos(d / 2)
        g = i * c + (o - i) * c / 3 * (i + 2 * o) / (i + o) # centre of a stone
        printf "{\"dim\": 2, \"dt\": 1e-3, \"mu\": 1, \"walls\": [{\"point\": [0, 0], \"normal\": [0, 1]}], \"shapes\": {\"stone\": {\"polygon\": "
        printf "[[%.15g, %.15g], [%.15g, %.15g], [%.15g, %.15g], [%.15g, %.15g]]}}, \"bodies\": [", i * c, -i * s, o * c, -o * s, o * c, o * s, i * c, i * s
        for (k = 0; k < n; k++)
            printf "%s{\"x\": [%.15g, %.15g], \"shape\": \"stone\", \"orientation\": %.15g}", k ? ", " : "", g * cos((k + 0.5) * d), g * sin((k + 0.5) * d), (k + 0.5) * d
        print "]}" }' | nsd-gen - | nsd-step -n 1000 --every 1000 --warm --tolerance 1e-6 2>/dev/null | nsd-info --last -p | jq -s '.[10].x[1] > 0.95'
}
is 'an arch of 21 stones stands with a thickness of 0.11 radii [Couplet, Heyman: 0.107]' "$(arch 0.11 21)" true
is 'and falls with 0.105' "$(arch 0.105 21)" false

# Two cards of length L lean against each other, a from upright: from the moments about a card's lower edge the other
# pushes it with H = m g (L sin a - c cos a) / 2 / (L cos a + r), c thick and rounded by r, and the floor, which carries
# m g, has to hold H. So mu decides at H / (m g).
lean() # part of the critical mu: how high the cards' centres are after 0.4 s, of their height at the start
{
    awk -v part="$1" 'BEGIN { a = 0.35; L = 0.088; c = 0.0002; r = 0.0001; s = sin(a); k = cos(a)
        x = L / 2 * s - c / 2 * k; z = r + L / 2 * k + c / 2 * s; apex = L * s + r; mu = part * (L * s - c * k) / 2 / (L * k + r)
        printf "{\"dt\": 1e-3, \"mu\": %.12g, \"shapes\": {\"card\": {\"box\": [%g, 0.063, %g], \"round\": %g}}, \"walls\": [{\"point\": [0, 0, 0], \"normal\": [0, 0, 1]}],", mu, c, L, r
        printf "\"bodies\": [{\"x\": [%.12g, 0, %.12g], \"shape\": \"card\", \"orientation\": [0, %g, 0]}, {\"x\": [%.12g, 0, %.12g], \"shape\": \"card\", \"orientation\": [0, %g, 0]}]}", x - apex, z, a, apex - x, z, -a
    }' | nsd-gen - | nsd-step -n 400 --every 400 --warm --tolerance 1e-8 2>/dev/null | nsd-info --last -p | jq -s 'map(.x[2]) | add / 2 / 0.04137'
}
is 'two cards lean against each other with a friction of 1.01 times what statics asks for' "$(below '0.995' "$(lean 1.01)")" true
is 'and slide apart with 0.98 times' "$(below "$(lean 0.98)" 0.9)" true

# The scene: three floors
nsd-gen scenes/cards.json | nsd-step -n 300 --every 300 --warm 2>/dev/null >"$tmp/house.h5"
is 'a house of cards of three floors stands' \
    "$(nsd-info --last -p "$tmp/house.h5" | jq -s 'map(.x[2]) | max > 0.208') $(last "$tmp/house.h5" '.kinetic_energy < 1e-8')" 'true true'

# Dominoes without friction between them, in the plane. Between two hits the row is a mechanism of one freedom: domino
# n, at angle t_n, leans on the next, h sin(t_n - t_n+1) = (s + d) cos t_n+1 - d, and keeps its energy; a hit is
# without rebound [van Leeuwen, Am. J. Phys. 78 (2010) 721].
dominoes() # height thickness gap: the speed by that theory, and by nsd between the 8th and the 18th
{
    awk -v h="$1" -v d="$2" -v s="$3" 'function asin(x) { return atan2(x, sqrt(1 - x * x)) }
        function train(t, m,    k, u, w) { # of m: sum of (dt_n/dt)^2, and of heights
            J = P = 0; w = 1
            for (k = 0; k < m; k++) {
                J += w * w; P += (h * cos(t) + d * sin(t)) / 2
                u = t + asin(((s + d) * cos(t) - d) / h); w *= 1 - (s + d) * sin(t) / (h * cos(u - t)); t = u
            }
        }
        BEGIN {
            g = 9.81; I = (h * h + d * d) / 3; c = asin(s / h); w = 10; N = 500
            for (m = 1; m <= 18; m++) {
                train(0, m); E = I * J * w * w / 2 + g * P; T = 0
                for (i = 0; i < N; i++) { train((i + 0.5) * c / N, m); T += c / N / sqrt(2 * (E - g * P) / (I * J)) }
                train(c, m); w = sqrt(2 * (E - g * P) / (I * J)) * J / (1 + J)
            }
            print (s + d) / T
        }'
    awk -v h="$1" -v d="$2" -v s="$3" 'BEGIN {
        printf "{\"dim\": 2, \"dt\": 2e-4, \"mu\": 0, \"pairs\": [{\"pair\": [\"ball\", \"wall\"], \"mu\": 5}], \"walls\": [{\"point\": [0, 0], \"normal\": [0, 1]}], \"shapes\": {\"domino\": {\"box\": [%g, %g]}}, \"bodies\": [", d, h
        for (k = 0; k < 20; k++) printf "%s{\"x\": [%.9g, %.9g], \"shape\": \"domino\" %s}", k ? ", " : "", k * (s + d), h / 2, k ? "" : ", \"w\": -10, \"v\": [" 5 * h ", " 5 * d "]"
        print "]}" }' | nsd-gen - | nsd-step --until 0.6 --every 5 --warm --tolerance 1e-6 2>/dev/null | nsd-info -p |
        jq -n --argjson pitch "$(jq -n "$2 + $3")" 'reduce (inputs | select(.id == 8 or .id == 18) | select((.w[2] | fabs) > 0.05)) as $b ({};
            if .["\($b.id)"] then . else .["\($b.id)"] = $b.step end) | 10 * $pitch / (.["18"] - .["8"]) / 2e-4'
}
if [ -z "$thin" ]; then
    mapfile -t speed < <(dominoes 0.05 0.01 0.02)
    is "dominoes fall with ${speed[1]} m/s, by theory ${speed[0]}" "$(below "(${speed[1]}) / (${speed[0]}) - 1 | fabs" 0.025)" true
fi

# A capsule, and a clump of 81 balls along its axis, which is the same body to 1e-4: they fall, turn and roll alike.
roll() # shape
{
    awk -v s="$1" 'BEGIN { n = 81
        printf "{\"dt\": 1e-3, \"mu\": 0.3, \"gravity\": [2, 1, -9.81], \"shapes\": {\"pill\": {\"capsule\": {\"length\": 0.2, \"radius\": 0.05}}, \"clump\": {\"balls\": ["
        for (k = 0; k < n; k++) printf "%s[%.12g, 0, 0, 0.05]", k ? ", " : "", -0.1 + 0.2 * k / (n - 1)
        printf "]}}, \"walls\": [{\"point\": [0, 0, 0], \"normal\": [0, 0, 1]}], \"bodies\": [{\"x\": [0, 0, 0.1], \"shape\": \"%s\", \"orientation\": [0.1, 0.3, 0.7]}]}", s
    }' | nsd-gen - | nsd-step -n 400 --every 400 --warm --tolerance 1e-8 2>/dev/null | nsd-info --last -p | jq -c '[.mass, .v[0], .v[1], .w[0], .w[1]]'
}
is 'a clump of balls along a line moves as the capsule' \
    "$(jq -n --argjson a "$(roll pill)" --argjson b "$(roll clump)" '[$a, $b] | transpose | map((.[0] / .[1] - 1 | fabs) < 2e-4) | all')" true

# Polygons of more and more sides, and capsules that are shorter and shorter, pack as discs do: solid fractions of a
# settled box, from its area and the height of its centre
packs() # SHAPE...: as the body's keys
{
    printf '{"dim": 2, "dt": 1e-3, "mu": 0.5, "shapes": {"six": {"regular": {"sides": 6, "radius": 1}}, "many": {"regular": {"sides": 24, "radius": 1}},
        "pill": {"capsule": {"length": 0.05, "radius": 1}}}, "walls": [{"box": {"x": [0, 0.6], "y": [0, null]}}], "bodies": [{"count": 300, %s "radius": {"uniform": [0.01, 0.018]}}]}' "${1-}" |
        nsd-gen - | nsd-step -n 1500 --every 1500 --solver auto 2>/dev/null | nsd-info --last -p |
        jq -s '(map(.mass) | add) as $m | $m / 2500 / (1.2 * (map(.x[1] * .mass) | add) / $m)'
}
if [ -z "$thin" ]; then
    disc=$(packs) six=$(packs '"shape": "six", "orientation": "random",') many=$(packs '"shape": "many", "orientation": "random",')
    pill=$(packs '"shape": "pill", "orientation": "random",')
    is "polygons of 24 sides pack as discs ($many, $disc)" "$(below "$many - $disc | fabs" 0.02)" true
    is "those of 6 sides do not ($six)" "$(below "$six - $disc" -0.03)" true
    is "short capsules do, too ($pill)" "$(below "$pill - $disc | fabs" 0.02)" true
fi

# ---- rims and ridges of boundaries ----

# on WALL X Z SHAPE [TURN]: a body of density 2500 after half a second: height, spin, and what its contacts carry of its weight
on()
{
    printf '{"dt": 1e-3, "mu": 0.5, "shapes": {"plank": {"box": [0.6, 0.1, 0.02]}, "cube": {"box": [0.1, 0.1, 0.1]}, "pill": {"capsule": {"length": 0.5, "radius": 0.01}}},
        "bodies": [{"x": [%s, 0, %s], "shape": "%s", "orientation": %s}], "walls": [%s]}' "$2" "$3" "$4" "${5-[0, 0, 0]}" "$1" >"$tmp/on.json"
    nsd-gen "$tmp/on.json" | nsd-step -n 500 --every 500 --contacts --tolerance 1e-8 --warm 2>/dev/null >"$tmp/on.h5"
    nsd-info --last -p "$tmp/on.h5" | jq -c '[.x[2], (.w | map(. * .) | add | sqrt), .mass]' >"$tmp/body"
    nsd-info --last -c "$tmp/on.h5" | jq -s '[length, (map(.r[0]) | add // 0)]' | jq -c --slurpfile b "$tmp/body" '[$b[0][0], $b[0][1], .[0], .[1] / ($b[0][2] * 9.81e-3)]'
}
rests() { jq -n --argjson of "$1" "(\$of[0] - $2 | fabs) < 1e-5 and \$of[1] < 1e-4 and \$of[2] == $3 and (\$of[3] - 1 | fabs) < 1e-5"; }
rail='{"rectangle": {"center": [0, 0, 0], "normal": [0, 0, 1], "sides": [0.1, 1]}}'
printf 'v %s\n' '-0.5 -1 -0.5' '-0.5 1 -0.5' '0 -1 0' '0 1 0' '0.5 -1 -0.5' '0.5 1 -0.5' >"$tmp/roof.obj"
printf 'f %s\n' '1 3 4' '1 4 2' '3 5 6' '3 6 4' >>"$tmp/roof.obj"
roof='{"mesh": {"file": "roof.obj"}}'
is 'a plank across a rail, all its corners beside it, rests on the rims' "$(rests "$(on "$rail" 0 0.01 plank)" 0.01 4)" true
is 'turned, too' "$(rests "$(on "$rail" 0 0.01 plank '[0, 0, 0.4]')" 0.01 4)" true
is 'while its centre is above the rail' "$(rests "$(on "$rail" 0.04 0.01 plank)" 0.01 4)" true
is 'beyond its rim it tips' "$(on "$rail" 0.06 0.01 plank | jq '.[1] > 0.5')" true
is 'a pill lies on both rims' "$(rests "$(on "$rail" 0 0.01 pill)" 0.01 2)" true
is 'a plank lies on the ridge of a roof' "$(rests "$(on "$roof" 0 0.01 plank)" 0.01 2)" true
is 'a cube stands on it on the edge that crosses it' "$(rests "$(on "$roof" 0 0.0707106781186548 cube '[0.785398163397448, 0, 0]')" 0.0707107 1)" true
is 'what is beside a rectangle falls past it' "$(on "$rail" 0.2 0.05 cube | jq '.[0] < -1 and .[2] == 0')" true
# stones and boxes on the roof and the rail: the same bytes
jq --argjson w "[$roof, $rail]" '.walls = $w | .shapes = {stone: .shapes.stone, cube: .shapes.cube} |
    .bodies = [{count: 60, shape: "stone", orientation: "random", size: 0.05, box: {x: [-0.2, 0.2], y: [-0.3, 0.3], z: [0.2, null]}}]' scenes/rubble.json >"$tmp/roof.json"
nsd-gen "$tmp/roof.json" >"$tmp/roof.h5"
for j in 1 2; do nsd-step -j "$j" -n 350 --every 10 --contacts --warm "$tmp/roof.h5" 2>/dev/null >"$tmp/roof$j.h5"; done
NSD_LANES=2 nsd-step -j 1 -n 350 --every 10 --contacts --warm "$tmp/roof.h5" 2>/dev/null >"$tmp/lanes.h5"
numbers() { h5dump -y -w 1 -d "$1" "$2" | grep -oE '^ *-?[0-9]+'; }
is 'stones meet ridges and rims: more than 10 contacts with boundaries have features of rims, from 2^29 on' \
    "$(paste <(numbers /contacts/body "$tmp/roof1.h5" | paste - -) <(numbers /contacts/feature "$tmp/roof1.h5") |
        awk '$1 < 0 && $3 >= 536870912 { n++ } END { print (n > 10) }')" 1
ok 'with the same bytes in 1 and 2 threads' cmp "$tmp/roof1.h5" "$tmp/roof2.h5"
ok 'and with every width of vectors' cmp "$tmp/roof1.h5" "$tmp/lanes.h5"
# in the plane: a rod across two posts of a chain
printf '{"dim": 2, "dt": 1e-3, "mu": 0.5, "shapes": {"rod": {"box": [0.6, 0.02]}}, "bodies": [{"x": [0, 0.01], "shape": "rod"}],
    "walls": [{"polygon": {"points": [[-0.2, -1], [-0.1, 0], [0, -1], [0.1, 0], [0.2, -1]], "closed": false}}]}' |
    nsd-gen - | nsd-step -n 500 --every 500 --contacts --warm 2>/dev/null >"$tmp/rod.h5"
is 'in the plane a rod lies on two points of a chain' \
    "$(nsd-info --last -p "$tmp/rod.h5" | jq -c '[(.x[1] - 0.01 | fabs) < 1e-5, .w[2] == 0 or (.w[2] | fabs) < 1e-6]') $(last "$tmp/rod.h5" .contacts)" '[true,true] 2'

# Long capsules fall at random and lie down on a flat floor: the mean of (3 cos^2 - 1) / 2 of their axes to the
# vertical is 0 where each direction is as likely, and -1/2 where all lie.
printf '{"dt": 1e-3, "mu": 0.3, "shapes": {"rod": {"capsule": {"length": 0.05, "radius": 0.004}}}, "walls": [{"box": {"x": [0, 0.15], "y": [0, 0.15], "z": [0, null]}}],
    "bodies": [{"count": 60, "shape": "rod", "orientation": "random"}]}' | nsd-gen - >"$tmp/rods.h5"
if [ -z "$thin" ]; then
    nsd-step -n 1500 --every 1500 --warm "$tmp/rods.h5" 2>/dev/null >"$tmp/lie.h5"
    order() { nsd-info --last -p "$1" | jq -s "map(select(.x[2] < $2) | .q as \$q | 2 * (\$q[1] * \$q[3] - \$q[0] * \$q[2]) | 1.5 * . * . - 0.5) | add / length"; }
    is 'capsules that fall point anywhere' "$(below "$(order "$tmp/rods.h5" 99) | fabs" 0.15)" true
    is 'on the floor they lie' "$(below "$(order "$tmp/lie.h5" 0.009)" -0.45)" true
    is 'and above it nearly' "$(below "$(order "$tmp/lie.h5" 99)" -0.35)" true
fi

# Tetrahedra with friction settle as loose as dice do [Baker & Kudrolli, Phys. Rev. E 82 (2010) 061304: 0.51 to 0.64 from
# poured to shaken]: the fraction from how much higher the centre of more of them is, so that floor and top do not count.
column() # COUNT: volume, m^3, and the height of their centre, m
{
    printf '{"dt": 1e-3, "mu": 0.5, "shapes": {"die": {"points": [[1,1,1],[1,-1,-1],[-1,1,-1],[-1,-1,1]]}}, "cell": {"lengths": [0.12, 0.12, 1], "repeats": [true, true, false]},
        "walls": [{"point": [0, 0, 0], "normal": [0, 0, 1]}], "bodies": [{"count": %s, "shape": "die", "size": 0.01, "orientation": "random", "box": {"x": [0, 0.12], "y": [0, 0.12], "z": [0, null]}}]}' "$1" |
        nsd-gen - | nsd-step -n 1500 --every 1500 --warm 2>/dev/null | nsd-info --last -p | jq -sc '(map(.mass) | add) as $m | [$m / 2500, (map(.x[2] * .mass) | add) / $m]'
}
if [ -z "$thin" ]; then
    fraction=$(jq -n --argjson a "$(column 60)" --argjson b "$(column 180)" '($b[0] - $a[0]) / (0.12 * 0.12 * 2 * ($b[1] - $a[1]))')
    is "tetrahedra settle to a solid fraction of $fraction" "$(below 0.47 "$fraction") $(below "$fraction" 0.64)" 'true true'
fi

# ---- a heap of polyhedra comes to rest ----

printf '{"dt": 1e-3, "density": 2600, "mu": 0.5, "shapes": {"stone": %s, "cube": {"box": [1, 1, 1]}, "tetra": {"points": [[1,1,1],[1,-1,-1],[-1,1,-1],[-1,-1,1]]}},
    "walls": [{"box": {"x": [0, 0.4], "y": [0, 0.4], "z": [0, null]}}], "bodies": [{"count": 25, "shape": "stone", "orientation": "random", "size": {"uniform": [0.03, 0.07]}},
    {"count": 25, "shape": "cube", "orientation": "random", "size": {"uniform": [0.05, 0.1]}, "box": {"x": [0, 0.4], "y": [0, 0.4], "z": [1.1, null]}},
    {"count": 25, "shape": "tetra", "orientation": "random", "size": 0.05, "box": {"x": [0, 0.4], "y": [0, 0.4], "z": [2.8, null]}}]}' "$(jq -c .shapes.stone scenes/rubble.json)" >"$tmp/rests.json"
if [ -z "$thin" ]; then
    nsd-gen "$tmp/rests.json" | nsd-step -n 4000 --every 100 --solver auto 2>/dev/null >"$tmp/rests.h5"
    is 'a heap of polyhedra stands still: below 1e-6 m g d in all' \
        "$(nsd-info "$tmp/rests.h5" | jq -s --argjson e "$(nsd-info --last -p "$tmp/rests.h5" | jq -s 'map(.mass * 9.81 * 2 * .radius) | add / length')" \
            'map(select(.step > 3000).kinetic_energy) | length == 10 and max < 1e-6 * $e')" true
    is 'its overlaps are below 1e-4 of a grain' "$(last "$tmp/rests.h5" '.max_overlap < 1e-5')" true
fi

# ---- a heap of all shapes ----

jq '.bodies |= map(.count = ([.count, 14] | min)) | .bodies[1].box.z[0] = 0.9 | .bodies[2].box.z[0] = 1.7 | .bodies[3].box.z[0] = 2.5' \
    scenes/rubble.json | nsd-gen - >"$tmp/rubble.h5"
nsd-step -n 800 --every 800 "$tmp/rubble.h5" 2>/dev/null | nsd-cat --last >"$tmp/heap.h5"
like 'a heap of stones, cubes, rounded bricks and clumps has contacts' "$(nsd-detect "$tmp/heap.h5" | nsd-info --last | jq .contacts)" '^[0-9]{2,4}$'
is 'whose overlaps are small' "$(nsd-detect "$tmp/heap.h5" | nsd-info --last -c | jq -s 'map(.gap) | min > -2e-3')" true
for j in 2 4; do
    nsd-step -j "$j" -n 60 --every 20 --contacts --warm "$tmp/heap.h5" >"$tmp/j$j.h5" 2>/dev/null
done
nsd-step -j 1 -n 60 --every 20 --contacts --warm "$tmp/heap.h5" >"$tmp/j1.h5" 2>/dev/null
ok '1 and 2 threads give the same bytes' cmp "$tmp/j1.h5" "$tmp/j2.h5"
ok '1 and 4 threads give the same bytes' cmp "$tmp/j1.h5" "$tmp/j4.h5"
NSD_LANES=2 nsd-step -j 1 -n 60 --every 20 --contacts --warm "$tmp/heap.h5" >"$tmp/lanes.h5" 2>/dev/null
ok 'and every width of vectors' cmp "$tmp/j1.h5" "$tmp/lanes.h5"

cp "$tmp/heap.h5" "$tmp/pipe.h5"
for _ in 1 2 3; do
    nsd-detect "$tmp/pipe.h5" | nsd-solve 2>/dev/null | nsd-move >"$tmp/next.h5"
    mv "$tmp/next.h5" "$tmp/pipe.h5"
done
nsd-step --solver auto -n 3 "$tmp/heap.h5" 2>/dev/null | nsd-cat --last >"$tmp/three.h5"
ok 'detect | solve | move is nsd-step' same_particles "$tmp/pipe.h5" "$tmp/three.h5"
nsd-step -n 30 "$tmp/heap.h5" 2>/dev/null | nsd-cat --last >"$tmp/whole.h5"
nsd-step -n 17 "$tmp/heap.h5" 2>/dev/null >"$tmp/half.h5"
nsd-step -n 13 "$tmp/half.h5" 2>/dev/null | nsd-cat --last >"$tmp/rest.h5"
ok 'a run that goes on from its file is the run, to the bit' same_particles "$tmp/whole.h5" "$tmp/rest.h5"

nsd-detect "$tmp/heap.h5" >"$tmp/contacts.h5"
for m in sbp sal ebp eal exact; do
    nsd-solve -m "$m" --tolerance 1e-6 --max-sweeps 20000 "$tmp/contacts.h5" 2>/dev/null >"$tmp/$m.h5"
    is "$m solves it" "$(nsd-err "$tmp/$m.h5" | jq '.natural < 1.1e-6')" true
done
for g in nlgs anderson; do
    nsd-solve --solver "$g" --tolerance 1e-4 --max-sweeps 20000 "$tmp/contacts.h5" 2>/dev/null >"$tmp/$g.h5"
    is "and so does $g" "$(nsd-err "$tmp/$g.h5" | jq '.natural < 1.1e-4')" true
done

# The problem as FCLIB has it, in both forms, has the same solution.
for form in local global; do
    nsd-detect --fclib=$form "$tmp/heap.h5" >"$tmp/both.h5"
    foreign "$tmp/both.h5" "$tmp/$form.raw"
    is "as FCLIB's $form problem it can be solved" "$(nsd-solve --tolerance 1e-6 "$tmp/$form.raw" 2>/dev/null | nsd-err | jq '.natural < 1.1e-6')" true
done

# A scene from a document has its shapes.
printf '{"dt": 1e-3, "mu": 0.5, "allow_overlap": true, "bodies": [{"document": "%s"}]}' "$tmp/heap.h5" | nsd-gen - >"$tmp/from.h5"
is 'bodies from a document have their shapes' "$(nsd-info -p "$tmp/from.h5" | jq -s 'map([.shape, .x, .q]) | tojson' | cksum)" \
    "$(nsd-info -p "$tmp/heap.h5" | jq -s 'map([.shape, .x, .q]) | tojson' | cksum)"
is 'nsd-info says which' "$(nsd-info -p "$tmp/heap.h5" | jq -s 'map(.shape) | unique | join(" ")')" '"clump cube rounded stone"'
ok 'nsd-view draws them' sh -c "nsd-view '$tmp/heap.h5' >'$tmp/heap.png' && [ -s '$tmp/heap.png' ]"

# Stones that pour in: the same bytes, whatever the threads, and however often the run is begun again
printf '{"dt": 1e-3, "mu": 0.4, "shapes": {"stone": {"points": [[0.9,0.1,0.2],[-0.8,0.3,0.1],[0.1,1,-0.2],[-0.2,-0.9,0.3],[0.3,-0.1,0.8],[-0.1,0.2,-0.7]]}},
    "walls": [{"point": [0, 0, 0], "normal": [0, 0, 1]}], "bodies": [{"x": [0.5, 0, 0.1], "shape": "stone", "size": 0.05}],
    "pour": [{"rate": 100, "opening": {"disc": {"center": [0, 0, 0.6], "normal": [0, 0, 1], "radius": 0.1}}, "shape": "stone",
        "orientation": "random", "size": {"uniform": [0.03, 0.05]}, "v": [0, 0, -1], "count": 30}]}' | nsd-gen - >"$tmp/pour.h5"
nsd-step -n 500 --every 500 "$tmp/pour.h5" 2>/dev/null | nsd-cat --last >"$tmp/whole.h5"
is 'stones pour in' "$(nsd-info --last -p "$tmp/whole.h5" | jq -s 'map(.shape == "stone") | [length, all] | tojson')" '"[31,true]"'
nsd-step -n 230 "$tmp/pour.h5" 2>/dev/null >"$tmp/half.h5"
nsd-step -n 270 --every 270 -j 2 "$tmp/half.h5" 2>/dev/null | nsd-cat --last >"$tmp/rest.h5"
ok 'a run of them that goes on is the run, to the bit' same_particles "$tmp/whole.h5" "$tmp/rest.h5"

# ---- shapes that are none ----

bad() # name shape [dim]
{
    printf '{"dt": 1e-3, "dim": %s, "shapes": {"it": %s}, "bodies": [{"x": [0, 0%s], "shape": "it"}]}' "${3-3}" "$2" "$([ "${3-3}" = 2 ] || echo ', 0')" >"$tmp/bad.json"
    refuses 65 "$1" nsd-gen "$tmp/bad.json"
    like "  and its place is told" "$(cat "$tmp/err")" 'bad.json:1:[0-9]+: shapes\.it'
}
v='"vertices": [[0,0,0],[1,0,0],[0,1,0],[0,0,1]]'
bad 'a flat hull' '{"points": [[0,0,0],[1,0,0],[0,1,0],[1,1,0],[0.5,0.5,0]]}'
bad 'a hull of one point, many times' '{"points": [[1,1,1],[1,1,1],[1,1,1],[1,1,1]]}'
bad 'a hull that is flat to rounding' '{"points": [[0,0,0],[1,0,0],[0,1,0],[0.3,0.3,1e-13]]}'
bad 'faces turned inside out' "{$v, \"faces\": [[0,1,2],[0,3,1],[0,2,3],[1,3,2]]}"
bad 'one face turned inside out' "{$v, \"faces\": [[0,2,1],[0,3,1],[0,3,2],[1,2,3]]}"
bad 'a surface that is open' "{$v, \"faces\": [[0,2,1],[0,1,3],[0,3,2],[0,1,3]]}"
bad 'a polyhedron that is not convex' '{"vertices": [[0,0,0],[1,0,0],[0,1,0],[0,0,1],[0.2,0.2,0.2]], "faces": [[0,2,1],[0,1,3],[0,3,2],[1,2,4],[2,3,4],[3,1,4]]}'
bad 'a face that is not flat' '{"vertices": [[0,0,0],[1,0,0],[1,1,0.3],[0,1,0],[0,0,1],[1,0,1],[1,1,1],[0,1,1]], "faces": [[3,2,1,0],[4,5,6,7],[0,1,5,4],[1,2,6,5],[2,3,7,6],[3,0,4,7]]}'
bad 'a vertex that is not there' "{$v, \"faces\": [[0,2,1],[0,1,3],[0,3,2],[1,2,9]]}"
bad 'a box without height' '{"box": [1, 1, 0]}'
bad 'a capsule without radius' '{"capsule": {"length": 1, "radius": 0}}'
bad 'a ball of a clump without radius' '{"balls": [[0, 0, 0, 0]]}'
bad 'a clump of nothing' '{"balls": []}'
bad 'a polygon that is not convex' '{"polygon": [[0,0],[1,0],[0.1,0.1],[0,1]]}' 2
bad 'a polygon the wrong way round' '{"polygon": [[0,0],[0,1],[1,0]]}' 2
bad 'a polygon that goes round twice' '{"polygon": [[0,0],[1,0],[1,1],[0,1],[-0.1,-0.1],[1.1,-0.2],[1.2,1.2],[-0.2,1.1]]}' 2
bad 'a rounding of nothing' '{"box": [1, 1, 1], "round": 0}'
bad 'two forms in one shape' '{"box": [1, 1, 1], "balls": [[0, 0, 0, 1]]}'
printf '{"dt": 1e-3, "shapes": {}, "bodies": [{"x": [0, 0, 0], "shape": "it"}]}' >"$tmp/bad.json"
refuses 65 'a shape without a description' nsd-gen "$tmp/bad.json"
printf '{"dt": 1e-3, "shapes": {%s}, "bodies": [{"x": [0, 0, 0], "shape": "cube"}, {"x": [0, 0, 0], "shape": "cube"}]}' "$cube" >"$tmp/bad.json"
refuses 65 'two grains in one place' nsd-gen "$tmp/bad.json"
printf '{"dt": 1e-3, "mu": 0.5, "shapes": {"needle": {"box": [1, 0.001, 0.001]}, "plate": {"box": [1, 1, 0.001]}}, "walls": [{"point": [0,0,0], "normal": [0,0,1]}],
    "bodies": [{"x": [0, 0, 0.001], "shape": "needle"}, {"x": [2, 2, 0.3], "shape": "plate", "orientation": [0.3, 0, 0]}]}' |
    nsd-gen - | nsd-step -n 800 --every 800 2>/dev/null | nsd-info --last -p >"$tmp/thin"
is 'a needle and a plate of 1000 : 1 lie flat' "$(jq -s 'map(.x[2] < 0.002 and .x[2] > 0.0004) | all' "$tmp/thin")" true

# ---- shapes in files ----

# an OBJ of the brick 3 x 2 x 1, corner of x + 2 y + 4 z; and the same as STL of its triangles, as text
obj() # FACES...: a file of those corners on standard output
{
    printf 'v %s\n' '0 0 0' '3 0 0' '0 2 0' '3 2 0' '0 0 1' '3 0 1' '0 2 1' '3 2 1' '1.5 1 0.4'
    printf 'f %s\n' "$@"
}
sides=('1 5 7 3' '2 4 8 6' '1 2 6 5' '3 7 8 4' '1 3 4 2')
obj "${sides[@]}" '5 6 8 7' >"$tmp/brick.obj"
obj "${sides[@]}" >"$tmp/open.obj"
obj "${sides[@]}" '7 8 6 5' >"$tmp/one.obj"
obj '3 7 5 1' '6 8 4 2' '5 6 2 1' '4 8 7 3' '2 4 3 1' '7 8 6 5' >"$tmp/inside.obj"
obj "${sides[@]}" '5 6 9' '6 8 9' '8 7 9' '7 5 9' >"$tmp/dent.obj"
obj '1 2 4' '4 3 1' '1 4 2' '1 3 4' >"$tmp/flat.obj"
mesh() # 'FILE" MORE...': mass and moments of a body of density 1
{
    printf '{"dt": 1e-3, "density": 1, "shapes": {"it": {"mesh": {"file": "%s}}}, "bodies": [{"x": [0, 0, 0], "shape": "it"}]}' "$1" >"$tmp/mesh.json"
    nsd-gen "$tmp/mesh.json" >"$tmp/mesh.h5"
    nsd-info -p "$tmp/mesh.h5" | jq -c '.mass as $m | [$m, .radius]'
}
is_brick() { jq -n --argjson of "$1" '($of[0] - 6 | fabs) < 1e-5 and ($of[1] - (14 | sqrt) / 2 | fabs) < 1e-6'; }
is 'the brick of an OBJ file has its mass and reach' "$(is_brick "$(mesh 'brick.obj"')")" true
nsd-export --to stl -o "$tmp/brick.stl" "$tmp/mesh.h5"
is 'that of a binary STL file, too' "$(is_brick "$(mesh 'brick.stl"')")" true
awk 'BEGIN { print "solid brick" }
    /^v/ { x[++n] = $2 " " $3 " " $4 }
    /^f/ { for (k = 3; k < NF; k++) print "facet normal 0 0 0\nouter loop\nvertex " x[$2] "\nvertex " x[$k] "\nvertex " x[$(k + 1)] "\nendloop\nendfacet" }
    END { print "endsolid brick" }' "$tmp/brick.obj" >"$tmp/text.stl"
is 'and of an STL file of text' "$(is_brick "$(mesh 'text.stl"')")" true
is 'its unit may be a millimetre' "$(mesh 'brick.obj", "scale": 1e-3' | jq '(.[0] / 6e-9 - 1 | fabs) < 1e-12')" true
for file in open one inside dent; do
    is "the hull of $file.obj is the brick" "$(is_brick "$(mesh "$file.obj\", \"hull\": true")")" true
done

# A dodecahedron, turned, and then in single precision: its twelve faces are still pentagons.
printf '{"dt": 1e-3, "density": 1, "shapes": {"it": {"points": [%s]}}, "bodies": [{"x": [7, 0, 0], "shape": "it", "orientation": [0.3, 0.2, 0.5]}]}' "$(
    awk 'BEGIN { g = (1 + sqrt(5)) / 2
        for (a = -1; a <= 1; a += 2) for (b = -1; b <= 1; b += 2) {
            for (c = -1; c <= 1; c += 2) printf "[%d,%d,%d],", a, b, c
            printf "[0,%.17g,%.17g],[%.17g,%.17g,0],[%.17g,0,%.17g]%s", a / g, b * g, a / g, b * g, a * g, b / g, a + b == 2 ? "" : "," } }')" |
    nsd-gen - | nsd-export --to stl -o "$tmp/dod.stl"
is 'a dodecahedron in single precision has its volume' \
    "$(mesh 'dod.stl"' | jq '(.[0] / ((15 + 7 * (5 | sqrt)) / 4 * pow((5 | sqrt) - 1; 3)) - 1 | fabs) < 1e-6')" true
is 'and twelve pentagons' "$(h5dump -d /nsd/shape/face "$tmp/mesh.h5" | grep -o '[(:] *[0-9, ]*5[, 5]*$' | tr -cd 5)" 555555555555

# Grains that pour in: a document keeps the shape, and goes on without the file.
printf '{"dt": 1e-3, "shapes": {"stone": {"mesh": {"file": "dod.stl", "scale": 0.03}}}, "bodies": [], "walls": [{"point": [0, 0, 0], "normal": [0, 0, 1]}],
    "pour": [{"rate": 100, "opening": {"disc": {"center": [0, 0, 0.6], "normal": [0, 0, 1], "radius": 0.1}}, "shape": "stone", "v": [0, 0, -1], "count": 5}]}' >"$tmp/pour.json"
nsd-gen "$tmp/pour.json" >"$tmp/pour.h5"
rm "$tmp/dod.stl"
nsd-step -n 200 "$tmp/pour.h5" 2>/dev/null >"$tmp/poured.h5"
is 'stones of a file pour in, and the file is not needed any more' "$(nsd-info --last -p "$tmp/poured.h5" | jq -s 'map(.shape) | tojson')" \
    '"[\"stone\",\"stone\",\"stone\",\"stone\",\"stone\"]"'

for what in 'open|is open' 'one|turned inside out' 'inside|is turned inside out' 'dent|is not convex: its volume is 4.8 m'; do
    bad "a file that ${what#*|}" "{\"mesh\": {\"file\": \"${what%|*}.obj\"}}"
    like '  and what is wrong' "$(cat "$tmp/err")" "${what#*|}"
done
bad 'a flat file' '{"mesh": {"file": "flat.obj"}}'
bad 'and its hull' '{"mesh": {"file": "flat.obj", "hull": true}}'
bad 'a mesh in the plane' '{"mesh": {"file": "brick.obj"}}' 2
head -c 3000 /dev/urandom >"$tmp/noise.stl"
bad 'a file of noise' '{"mesh": {"file": "noise.stl"}}'
printf '{"dt": 1e-3, "shapes": {"it": {"mesh": {"file": "none.stl"}}}, "bodies": []}' >"$tmp/bad.json"
refuses 66 'a file that is not there' nsd-gen "$tmp/bad.json"

# Superquadrics: of exponent 1 an octahedron, of 2 an ellipsoid, up to its facets
quadric() # radii exponents segments [dim]: the mass of a body of density 1
{
    printf '{"dt": 1e-3, "dim": %s, "density": 1, "shapes": {"it": {"superquadric": {"radii": %s, "exponents": %s, "segments": %s}}}, "bodies": [{"x": %s, "shape": "it"}]}' \
        "${4-3}" "$1" "$2" "$3" "$([ "${4-3}" = 2 ] && echo '[0, 0]' || echo '[0, 0, 0]')" | nsd-gen - | nsd-info -p | jq .mass
}
is 'a superquadric of exponents 1 is an octahedron' "$(below "$(quadric '[1,2,3]' '[1,1]' 4) - 8 | fabs" 1e-6)" true
is 'of exponents 2 an ellipsoid, to 2% with 10 segments' "$(below "1 - $(quadric '[1,2,3]' '[2,2]' 10) / (8 * 3.14159265) | fabs" 0.02)" true
is 'to 0.3% with 24' "$(below "1 - $(quadric '[1,2,3]' '[2,2]' 24) / (8 * 3.14159265) | fabs" 0.003)" true
is 'of exponents 2 and 100 nearly a cylinder' "$(below "1 - $(quadric '[1,1,1]' '[2,100]' 24) / (2 * 3.14159265) | fabs" 0.05)" true
is 'in the plane of exponent 1 a square' "$(below "$(quadric '[1,2]' '[1]' 4 2) - 4 | fabs" 1e-6)" true
bad 'a superquadric that is not convex' '{"superquadric": {"radii": [1,1,1], "exponents": [0.9,2]}}'
bad 'one without a radius' '{"superquadric": {"radii": [1,0,1], "exponents": [2,2]}}'
bad 'one with too many corners' '{"superquadric": {"radii": [1,1,1], "exponents": [2,2], "segments": 40}}'

# ---- documents ----

# A document whose table of shapes has been damaged is refused.
if have_h5py; then
    jq '.walls = [] | .shapes.brick = {"box": [1, 2, 3]} | .bodies = [{"x": [0, 0, 0], "shape": "brick"}, {"x": [9, 0, 0], "shape": "clump"}]' scenes/rubble.json |
        nsd-gen - >"$tmp/good.h5"
    foreign "$tmp/good.h5" "$tmp/good.raw"
    status 0 'a document of shapes is read without its header, too' nsd-info "$tmp/good.raw"
    while IFS='|' read -r what change; do
        cp "$tmp/good.raw" "$tmp/poked.raw"
        py -c "import h5py, numpy; f = h5py.File('$tmp/poked.raw', 'r+'); s = f['/nsd/shape']; a = f['/particles/all/shape']; $change"
        refuses 65 "a document with $what" nsd-info "$tmp/poked.raw"
    done <<'EOS'
a shape that is not there|a[0] = 99
a shape before the first|a[1] = -1
no name for a shape|s.attrs['names'] = b'brick\n'
two shapes of one name|s.attrs['names'] = b'a\na\nb\nc\nd\n'
a form that is none|s['form'][0] = 9
fewer vertices than it says|s['vertices'][0] = 2000000000
a negative number of corners|s['corners'][0] = -5
a corner that is no vertex|s['corner'][3] = 77
a face of two corners|s['face'][0] = 2
a vertex that is no number|s['vertex'][0, 0] = float('nan')
a vertex beyond the ball around it|s['vertex'][0, 0] = 3
a volume of nothing|s['volume'][0] = 0
moments that are no body's|s['moment'][0] = (0.9, 0.1, 0.1)
a rounding below 0|s['round'][0] = -1
a capsule of ten vertices|s['form'][0] = 2
EOS
else
    skip 'documents with damaged shapes' 'no h5py'
fi

# ---- a box between two plates ----

# 1 kg between a fixed plate and one that presses with F, mu = 0.5: held while 2 mu F > m g, else it falls by what is
# missing; of all solutions with the same forces, the one in which it does not turn
between() # DIM F: velocity along gravity after 0.2 s, and the largest spin
{
    jq -n --argjson d "$1" --argjson F "$2" '{ dim: $d, dt: 1e-3, mu: 0.5, shapes: { b: { box: [0.2, 0.16, 0.12][:$d] } },
        bodies: [{ x: [0, 0, 0][:$d], shape: "b", mass: 1 }], walls: [{ point: [-0.1, 0, 0][:$d], normal: [1, 0, 0][:$d] },
            { point: [0.1, 0, 0][:$d], normal: [-1, 0, 0][:$d], load: { along: [1, 0, 0][:$d], mass: 1, force: -$F } }] }' | nsd-gen - |
        nsd-step -n 200 --tolerance 1e-4 --every 200 2>/dev/null | nsd-info --last -p | jq -c --argjson d "$1" '[.v[$d - 1], (.w | map(fabs) | max)]'
}
for d in 2 3; do
    like "a box between two plates stays (${d}D)" "$(between $d 9.9 | jq 'map(fabs) | max < 1e-3')" true
    like "or slides without a turn (${d}D)" "$(between $d 8 | jq '(.[0] + 0.2 * 1.81 | fabs) < 1e-3 and .[1] < 1e-6')" true
done
done_testing
