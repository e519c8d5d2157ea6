#!/usr/bin/env bash
# Laws beyond friction and restitution, by the tools: cohesion, liquid bridges, rolling, adhesion.
# shellcheck source=tests/support/tap.sh disable=SC2317 # functions called by name
. tests/support/tap.sh

step() { nsd-step "$@" 2>/dev/null; }
solve() { nsd-solve "$@" 2>/dev/null; }
# The energy that is missing from the balance of a log's worst step, in parts of what there is
misfit()
{
    jq -s 'map(.balance | ((.change - (.gravity + .loads + .drives + (.rise // 0) - .dissipation - .bond_change - .broken)) | fabs) /
        (.kinetic + (.gravity | fabs) + (.loads | fabs) + (.drives | fabs) + (.dissipation | fabs) +
         (.bond_change | fabs) + 1e-300)) | max // 1' "$1"
}

# Bits are the plain run's to compare: under the sanitizers threads run once
threads=(2 4) lanes=(1 2)
[ -z "$thin" ] || threads=(2) lanes=()

# whole NAME: a step of document $tmp/NAME by parts and whole, in threads, broken off, judged anew
whole()
{
    local group j m
    nsd-detect "$tmp/$1" | solve >"$tmp/solved.h5"
    nsd-move "$tmp/solved.h5" >"$tmp/parts.h5"
    step --solver auto -n 1 "$tmp/$1" | cat >"$tmp/one.h5"
    for group in /particles /nsd/bonds /nsd/law /nsd/solver; do
        ok "$1: detect | solve | move and step give the same bits of $group" \
            cmp <(dump "$tmp/parts.h5" $group) <(dump "$tmp/one.h5" $group)
    done
    step -n 20 -j 1 -o "$tmp/j1.h5" "$tmp/$1"
    for j in "${threads[@]}"; do
        step -n 20 -j "$j" -o "$tmp/j$j.h5" "$tmp/$1"
        ok "$1: -j $j gives the same bytes" cmp "$tmp/j1.h5" "$tmp/j$j.h5"
        rm "$tmp/j$j.h5"
    done
    for m in "${lanes[@]}"; do
        NSD_LANES=$m nsd-step -n 20 -o "$tmp/lanes.h5" "$tmp/$1" 2>/dev/null
        ok "$1: and $m lanes" cmp "$tmp/j1.h5" "$tmp/lanes.h5"
        rm "$tmp/lanes.h5"
    done
    step -n 12 -o "$tmp/broken.h5" "$tmp/$1"
    step -n 8 -i "$tmp/broken.h5"
    nsd-cat --last "$tmp/broken.h5" >"$tmp/a.h5"
    nsd-cat --last "$tmp/j1.h5" >"$tmp/b.h5"
    for group in /particles /nsd/bonds; do
        ok "$1: a run that was broken off goes on with the same bits of $group" \
            cmp <(dump "$tmp/a.h5" $group) <(dump "$tmp/b.h5" $group)
    done
    nsd-cat "$tmp/j1.h5" | nsd-cat -o "$tmp/packed.h5"
    for group in /nsd/bonds /nsd/law; do
        ok "$1: nsd-cat keeps $group" cmp <(dump "$tmp/j1.h5" $group) <(dump "$tmp/packed.h5" $group)
    done
    rm "$tmp/packed.h5" "$tmp/broken.h5" "$tmp/j1.h5"
    like "$1: nsd-err finds the errors of the report" \
        "$(nsd-err "$tmp/solved.h5" | jq --argjson r "$(nsd-info "$tmp/solved.h5" | tail -n 1)" \
            '(.eps_glob - $r.eps_glob | fabs) <= 1e-9 * $r.eps_glob + 1e-12')" true
}

# ---- cohesion ----

# a ball under a ceiling, with this part of its weight as cohesion
ceiling() { jq -n --argjson f "$1" '{ dt: 1e-3, mu: 0.3, cohesion: { force: ($f * 4 / 3 * 3.141592653589793 * 1e-6 * 2500 * 9.81) },
    walls: [{ normal: [0, 0, -1], point: [0, 0, 0] }], bodies: [{ x: [0, 0, -0.01], radius: 0.01 }] }' | nsd-gen -; }
ceiling 1.001 >"$tmp/holds.h5"
ceiling 0.999 >"$tmp/falls.h5"
height() { nsd-info --last -p "$1" | jq '.x[2]'; }
for m in sbp sal ebp eal exact; do
    step -m $m --criterion natural --tolerance 1e-10 -n 50 -o "$tmp/held.h5" "$tmp/holds.h5"
    like "-m $m: a ball hangs from a ceiling by a little more than its weight" \
        "$(height "$tmp/held.h5" | jq '(. + 0.01 | fabs) < 1e-12')" true
    rm "$tmp/held.h5"
done
step -n 50 -o "$tmp/fallen.h5" "$tmp/falls.h5"
like "and falls from less" "$(height "$tmp/fallen.h5" | jq '. < -0.0105')" true

# ---- liquid bridges ----

pair() # gap (m): two balls without weight, and a bridge of 0.1 mm^3 of water
{
    jq -n --argjson g "$1" '{ dt: 1e-6, gravity: [0, 0, 0], capillary: { volume: 1e-10, tension: 0.072, wetting: 0.3 },
        bodies: [{ x: [0, 0, 0], radius: 1e-3 }, { x: [0.003 + $g, 0, 0], radius: 2e-3 }] }' | nsd-gen -
}
pair 0 >"$tmp/touching.h5"
nsd-detect "$tmp/touching.h5" | solve | nsd-info -c >"$tmp/force"
like "two balls that touch are pressed together by 2 pi R sigma cos(theta)" \
    "$(jq '(.pull / (2 * 3.141592653589793 * (4e-3 / 3) * 0.072 * (0.3 | cos)) - 1 | fabs) < 1e-12' "$tmp/force")" true
like "and push each other as much" "$(jq '(.r | max | fabs) < 1e-20' "$tmp/force")" true
pair 1e-5 >"$tmp/apart.h5"
is "no bridge is made over a gap" "$(nsd-detect "$tmp/apart.h5" | nsd-info | tail -n 1 | jq .contacts)" 0
# pulled apart: 1 m/s and a dt of 1 us, until the bridge ruptures at (1 + theta/2) V^(1/3) = 0.534 mm
jq -n '{ dt: 1e-6, gravity: [0, 0, 0], overlap: true, capillary: { volume: 1e-10, tension: 0.072, wetting: 0.3 },
    bodies: [{ x: [1e-6, 0, 0], radius: 1e-3, density: 1e5, v: [-0.5, 0, 0] }, { x: [0.003, 0, 0], radius: 2e-3, density: 1e5, v: [0.5, 0, 0] }] }' |
    nsd-gen - >"$tmp/parting.h5" # the first step finds them touching
step --solver auto -n 700 --contacts --log "$tmp/parting.log" -o "$tmp/parted.h5" "$tmp/parting.h5"
nsd-info -c "$tmp/parted.h5" >"$tmp/parted"
like "a bridge pulls with the closed form of its length" \
    "$(jq -s 'map(select(.gap > 0) | (4e-3 / 3) as $R | (2e-10 / (3.141592653589793 * $R)) as $c2 |
        (2 * 3.141592653589793 * $R * 0.072 * (0.3 | cos) * (1 - .gap / ((.gap * .gap + $c2) | sqrt)) / .pull - 1 | fabs)) | max < 1e-9' "$tmp/parted")" true
like "and ruptures where Lian's formula says" \
    "$(jq -s '(map(.gap) | max) as $most | (1.15 * pow(1e-10; 1 / 3)) as $reach | $most < $reach and $most > $reach - 2e-6' "$tmp/parted")" true
like "energy is balanced in every step" "$(misfit "$tmp/parting.log" | jq '. < 1e-9')" true
like "and the balls lose what the liquid gave up as it joined: the bridge is broken, and stores nothing" \
    "$(jq -s '(map(.balance.change) | add) as $lost | (map(.balance.broken) | add) as $broken | ($broken / -$lost - 1 | fabs) < 5e-3' "$tmp/parting.log")" true

jq -n '{ dt: 2e-5, mu: 0.4, e_n: 0.2, capillary: { volume: 1e-11, tension: 0.072, wetting: 0.2 },
    walls: [{ box: { x: [0, 0.006], y: [0, 0.006], z: [0, null] } }],
    bodies: [{ random: { count: 80 }, radius: { uniform: [4e-4, 6e-4] }, box: { x: [0, 0.006], y: [0, 0.006], z: [0, 0.006] }, v: [0, 0, -0.2] }] }' |
    nsd-gen - >"$tmp/grains.h5"
step --solver auto -n 400 --every 400 --log "$tmp/wet.log" -o "$tmp/wetted.h5" "$tmp/grains.h5"
nsd-cat --last "$tmp/wetted.h5" >"$tmp/wet.h5"
like "wet grains: energy is balanced in every step" "$(misfit "$tmp/wet.log" | jq '. < 1e-13')" true
like "wet grains: nothing dissipates less than nothing" "$(jq -s 'map(.balance.dissipation) | min > -1e-12' "$tmp/wet.log")" true
whole wet.h5
for g in auto nlgs anderson; do
    nsd-detect "$tmp/wet.h5" | solve --solver $g --criterion natural --tolerance 1e-6 >"$tmp/g.h5"
    like "wet grains: --solver $g solves them" "$(nsd-err "$tmp/g.h5" | jq '.natural <= 1e-6')" true
done
# FORM PACKING CONTACTS: "true" where the problem that FCLIB gets has the velocities of these contacts, more than 20
foreign()
{
    nsd-detect "--fclib=$1" "$2" >"$tmp/fclib.h5"
    py - "$tmp/fclib.h5" "$tmp/problem.h5" "fclib_$1" <<'PYTHON'
import h5py, sys
with h5py.File(sys.argv[1], 'r') as a, h5py.File(sys.argv[2], 'w') as b:
    a.copy(sys.argv[3], b)
PYTHON
    solve --criterion natural --tolerance 1e-10 "$tmp/problem.h5" | nsd-info -c >"$tmp/foreign"
    nsd-info -c "$3" | jq -s --slurpfile f "$tmp/foreign" \
        '[., $f] | transpose | map(.[0].u[0] * (1 + .[0].e_n) - .[1].u[0] | fabs) | length > 20 and max < 1e-6'
}
if have_h5py; then
    like "wet grains: as an FCLIB problem they have the same velocities" "$(foreign local "$tmp/wet.h5" "$tmp/g.h5")" true
else
    skip "wet grains as an FCLIB problem" "no h5py"
fi

# ---- what touches ----

# a wet ball rises to a wet ceiling, and a tenth of the energy of its bridge is left to it after the rebound: it hangs
for dt in 1e-5 2.5e-6; do
    jq -n --argjson dt $dt '{ dt: $dt, e_n: 0.5, capillary: { volume: 1e-10, tension: 0.072 }, walls: [{ point: [0, 0, 2.05e-3], normal: [0, 0, -1] }],
        bodies: [{ x: [0, 0, 1e-3], radius: 1e-3, v: [0, 0, 0.1] }] }' | nsd-gen - | step --until 0.03 --every 0.03s --log "$tmp/rise.log" -o "$tmp/rise.h5"
    like "a wet ball that rebounds has a bridge, dt $dt" "$(height "$tmp/rise.h5" | jq '. > 1e-3 and . < 1.06e-3')" true
    like "and its energy is balanced" "$(misfit "$tmp/rise.log" | jq '. < 1e-9')" true
done
# two wet balls that graze each other: after a step of dt the gap is (v_t dt)^2/4 R, 2.5 times what counts as touch
jq -n '{ dt: 1e-4, gravity: [0, 0, 0], capillary: { volume: 1e-10, tension: 0.072 },
    bodies: [{ x: [0, 0, 0], radius: 1e-3 }, { x: [0.002035, 0, 0], radius: 1e-3, v: [-0.2, 1, 0] }] }' | nsd-gen - | step -n 4 --contacts -o "$tmp/graze.h5"
like "balls that slide past each other have touched" "$(nsd-info --last -c "$tmp/graze.h5" | jq .wet)" true
for dt in 1e-6 3e-7; do
    jq -n --argjson dt $dt '{ dt: $dt, gravity: [0, 0, 0], e_n: 0.5, adhesion: { c_n: 2e9, w: 100, forever: true },
        bodies: [{ x: [0, 0, 0], radius: 1e-3, fixed: true }, { x: [2.023e-3, 0, 0], radius: 1e-3, v: [-0.5, 0, 0] }] }' |
        nsd-gen - | step --until 0.003 --every 0.003s -o "$tmp/stuck.h5"
    like "a ball that is bonded where it touches does not rebound, dt $dt" "$(nsd-info --last -p "$tmp/stuck.h5" | jq -s '.[1].v[0] | fabs < 1e-3')" true
done
# two discs that spin as one body: m w^2 R/(S c_n) = 4e-7 m of stretch, and half a step ahead a gap of 1.25e-6 m
jq -n '{ dim: 2, dt: 1e-3, gravity: [0, 0], mu: 0.3, adhesion: { c_n: 1e9, c_t: 1e9, w: 1000, made: 0 },
    bodies: [{ x: [-0.05, 0], radius: 0.05, v: [0, -0.5], w: 10 }, { x: [0.05, 0], radius: 0.05, v: [0, 0.5], w: 10 }] }' | nsd-gen - >"$tmp/spin.h5"
step --until 1 --every 1s -o "$tmp/spun.h5" "$tmp/spin.h5"
like "discs that touch and spin at the time of bonds are bonded" "$(nsd-info --last -p "$tmp/spun.h5" | jq -s '[.[0].x, .[1].x] | transpose | map(.[0] - .[1] | . * .) | add | sqrt < 0.1001')" true
bonded() { nsd-info --last -c "$1" | jq -s 'map(select(.beta == 1)) | length'; }
while IFS='|' read -r what count scene; do
    echo "{ \"dt\": 1e-3, \"mu\": 0.3, \"adhesion\": { \"c_n\": 1e9, \"w\": 1000, $scene }" | jq '.gravity = [range(.dim // 3) | 0]' | nsd-gen - >"$tmp/parts.h5"
    step -n 10 --every 10 --contacts -o "$tmp/parted.h5" "$tmp/parts.h5"
    is "bonds are made: $what" "$(bonded "$tmp/parted.h5")" "$count"
done <<'SCENES'
a ball that leaves a plane|1|"made": 0 }, "walls": [{ "point": [0, 0, 0], "normal": [0, 0, 1] }], "bodies": [{ "x": [0, 0, 0.05], "radius": 0.05, "v": [0, 0, 0.01] }]
whenever they touch|1|"forever": true }, "e_n": 0.5, "walls": [{ "point": [0, 0, 0], "normal": [0, 0, 1] }], "bodies": [{ "x": [0, 0, 0.05], "radius": 0.05, "v": [0, 0, 0.01] }]
a ball that leaves a sphere|1|"made": 0 }, "walls": [{ "sphere": { "center": [0, 0, -0.5], "radius": 0.5, "side": "outside" } }], "bodies": [{ "x": [0, 0, 0.05], "radius": 0.05, "v": [0, 0, 0.01] }]
through the border of a cell|1|"made": 0 }, "dim": 2, "cell": { "lengths": [1, 1] }, "bodies": [{ "x": [0.05, 0.5], "radius": 0.05, "v": [0.01, 0] }, { "x": [0.95, 0.5], "radius": 0.05 }]
a box that tips on a plane, by four corners|4|"made": 0 }, "shapes": { "b": { "box": [0.1, 0.1, 0.1] } }, "walls": [{ "point": [0, 0, 0], "normal": [0, 0, 1] }], "bodies": [{ "x": [0, 0, 0.05], "shape": "b", "w": [0, 0.3, 0] }]
a box that leaves another|4|"made": 0 }, "shapes": { "b": { "box": [0.1, 0.1, 0.1] } }, "bodies": [{ "x": [0, 0, 0.05], "shape": "b", "v": [0, 0, 0.01] }, { "x": [0, 0, -0.05], "shape": "b" }]
at a time between two steps|1|"made": 0.0025 }, "dim": 2, "bodies": [{ "x": [0.05, 0], "radius": 0.05 }, { "x": [-0.05, 0], "radius": 0.05 }]
at a time that rounding puts before a step|1|"made": 0.003 }, "dim": 2, "bodies": [{ "x": [0.05003, 0], "radius": 0.05, "v": [-0.01, 0] }, { "x": [-0.05, 0], "radius": 0.05 }]
not later than that|0|"made": 0.0025 }, "dim": 2, "bodies": [{ "x": [0.05004, 0], "radius": 0.05, "v": [-0.01, 0] }, { "x": [-0.05, 0], "radius": 0.05 }]
SCENES
whole spin.h5

# ---- attraction by surfaces of several parts ----

# what nsd-detect finds of this scene: FORCE, and how far it acts beside the z axis
resultant() { nsd-gen - | nsd-detect | nsd-info -c | jq -sc '(map(.pull) | add) as $f | [$f, (map(.pull * .point[0]) | add / $f), (map(.pull * (.point[1] // 0)) | add / $f)]'; }
attracts() # NAME FORCE SCENE
{
    like "$1: attracts with $2 N" "$(jq -n "{ dt: 1e-3, gravity: [0, 0, 0] } + $3" | resultant | jq "(.[0] / $2 - 1 | fabs) < 1e-6")" true
}
four='walls: ([[1, 1], [-1, 1], [-1, -1], [1, -1]] | map({ rectangle: { center: [.[0] / 2, .[1] / 2, 0], normal: [0, 0, 1], sides: [1, 1] } }))'
bricks='shapes: { b: { box: [1, 1, 0.2] } }'
for x in 0 1e-5 0.02; do
    for range in 0 0.01; do
        c="cohesion: { force: 7.7, range: $range }"
        attracts "four rectangles that meet $x m beside the ball, range $range" 7.7 "{ $c, $four, bodies: [{ x: [$x, 0, -0.05], radius: 0.05 }] }"
        attracts "two fixed bricks" 7.7 "{ $c, $bricks, bodies: [{ x: [0.5, 0, 0.1], shape: \"b\", fixed: true }, { x: [$x, 0, -0.05], radius: 0.05 }, { x: [-0.5, 0, 0.1], shape: \"b\", fixed: true }] }"
        attracts "two segments" 7.7 "{ dim: 2, gravity: [0, 0], $c, walls: [{ segment: [[0, 0], [1, 0]] }, { segment: [[-1, 0], [0, 0]] }], bodies: [{ x: [$x, -0.05], radius: 0.05 }] }"
    done
done
for a in 0 1e-5 0.01; do
    attracts "two half circles that meet $a rad beside a disc" 7.7 "{ dim: 2, gravity: [0, 0], cohesion: { force: 7.7, range: 0.01 },
        walls: [1, -1 | { arc: { center: [0, 0], radius: 1, along: [., 0], arc: 3.141592653589793 } }], bodies: [{ x: [0.9 * ($a | cos), 0.9 * ($a | sin)], radius: 0.1 }] }"
done
attracts "a box across four rectangles" 7.7 "{ cohesion: { force: 7.7 }, $four, shapes: { b: { box: [0.2, 0.3, 0.1] } }, bodies: [{ x: [0.02, 0.03, 0.05], shape: \"b\" }] }"
attracts "the corner of three planes" 23.1 '{ cohesion: { force: 7.7 }, walls: [{ rectangle: { center: [0.5, 0.5, 0], normal: [0, 0, 1], sides: [1, 1] } },
    { rectangle: { center: [0.5, 0, 0.5], normal: [0, 1, 0], sides: [1, 1] } }, { rectangle: { center: [0, 0.5, 0.5], normal: [1, 0, 0], sides: [1, 1] } }], bodies: [{ x: [0.05, 0.05, 0.05], radius: 0.05 }] }'
attracts "a bridge to four rectangles" '(4 * 3.141592653589793 * 0.05 * 0.072)' "{ capillary: { volume: 1e-8, tension: 0.072 }, $four, bodies: [{ x: [0, 0, -0.05], radius: 0.05 }] }"
for walls in "$four" 'walls: [{ point: [0, 0, 0], normal: [0, 0, -1] }]'; do
    jq -n "{ dt: 1e-3, adhesion: { c_n: 1e8, w: 1e6, area: 1e-4 }, $walls, bodies: [{ x: [0, 0, -0.05], radius: 0.05 }] }" | nsd-gen - |
        step -n 100 --every 100 --tolerance 1e-10 -o "$tmp/hangs.h5"
    height "$tmp/hangs.h5"
done >"$tmp/heights"
like "a ball hangs from a bond to four rectangles as from one to a plane" "$(jq -s '(.[0] - .[1] | fabs) < 1e-8 and .[0] < -0.0515' "$tmp/heights")" true

# the face of a prism is where its centre of mass is: the resultant goes through that, from any surface below
while read -r sides corners; do
    prism=$(jq -nc "{ p: { points: [range(2) as \$z | ${corners}[] | . + [2 * \$z]] }, b: { box: [40, 40, 1] } }")
    while IFS='|' read -r what below; do
        like "a prism of $sides sides on $what: the resultant is at the centre of its face" \
            "$(jq -n "{ dt: 1e-3, gravity: [0, 0, 0], cohesion: { force: 2, range: 1 }, shapes: $prism } + $below" | resultant |
                jq '(.[0] / 2 - 1 | fabs) < 1e-9 and (.[1] | fabs) < 1e-9 and (.[2] | fabs) < 1e-9')" true
    done <<'BELOW'
a plane|{ walls: [{ point: [0, 0, -1.2], normal: [0, 0, 1] }], bodies: [{ x: [0, 0, 0], shape: "p" }] }
two rectangles|{ walls: [10, -10 | { rectangle: { center: [., 0, -1.2], normal: [0, 0, 1], sides: [20, 40] } }], bodies: [{ x: [0, 0, 0], shape: "p" }] }
a fixed brick|{ bodies: [{ x: [0, 0, 0], shape: "p" }, { x: [0, 0, -1.7], shape: "b", fixed: true }] }
a brick|{ bodies: [{ x: [0, 0, -1.7], shape: "b" }, { x: [0, 0, 0], shape: "p" }] }
BELOW
done <<'PRISMS'
4 [[0,0],[5,0],[1,1],[0,1]]
5 [[1,0],[0.309017,0.951057],[-0.809017,0.587785],[-0.809017,-0.587785],[0.309017,-0.951057]]
7 [[0,0],[3,0],[4,1],[3.5,2.5],[1,3],[-1,1.5],[-0.8,0.6]]
PRISMS

# ---- a run continued by its scene ----

# by_scene NAME STEPS MORE: the rest of a run by nsd-step alone and by nsd-info --scene | FILTER | nsd-gen
by_scene()
{
    step -n "$2" --every "$2" -o "$tmp/first.h5" "$tmp/$1"
    step -n "$3" --every "$3" -o "$tmp/whole.h5" "$tmp/first.h5"
    nsd-info --scene "$tmp/first.h5" | jq "${4:-.}" | nsd-gen - >"$tmp/again.h5" 2>"$tmp/said"
    step -n "$3" --every "$3" -o "$tmp/rest.h5" "$tmp/again.h5"
}
jq -n '{ dt: 1e-4, mu: 0.3, adhesion: { c_n: 1e8, w: 10 }, walls: [{ point: [0, 0, 0], normal: [0, 0, -1], velocity: [0.01, 0, 0] }],
    shapes: { b: { box: [0.02, 0.02, 0.02] } },
    bodies: [{ x: [0, 0, -0.01], shape: "b" }, { x: [0, 0, -0.03], radius: 0.01 }, { x: [0.1, 0, -0.01], radius: 0.01 }] }' | nsd-gen - >"$tmp/bond.h5"
jq -n '{ dt: 1e-5, gravity: [0, 0, 0], capillary: { volume: 1e-10, tension: 0.072 }, bodies: [{ x: [0, 0, 0], radius: 1e-3, fixed: true },
        { x: [0, 0, -2.01e-3], radius: 1e-3, v: [0, 0, 0.05] }],
    forces: [{ bodies: [1], along: [0, 0, -1], force: 6e-4, from: 0.002, until: 0.003 }] }' | nsd-gen - >"$tmp/bridge.h5"
for name in bond.h5:200:200 bridge.h5:300:700; do
    IFS=: read -r file before after <<<"$name"
    by_scene "$file" "$before" "$after"
    is "$file: a run continued by its scene has the same bits" "$(nsd-info --last -p "$tmp/rest.h5" | jq -c '[.x, .v, .w]')" "$(nsd-info --last -p "$tmp/whole.h5" | jq -c '[.x, .v, .w]')"
    is "and nothing is said" "$(cat "$tmp/said")" ""
done
by_scene bond.h5 200 20 '.mu = 0.9 | .dt = 5e-5'
like "another mu and dt break no bond" "$(nsd-info --last -p "$tmp/rest.h5" | jq -s 'map(.v[2] | fabs) | max < 1e-2')" true
by_scene bond.h5 200 20 'del(.adhesion)'
like "bonds without a law are lost, which is said" "$(cat "$tmp/said")" "nsd-gen: warning: .*first.h5: 6 bonds or liquid bridges are lost"
by_scene bond.h5 200 20 '.walls[0].point[2] = 0.001'
like "so are those with a wall that is another" "$(cat "$tmp/said")" "first.h5: 5 bonds or liquid bridges are lost"

# ---- rolling and pivoting friction ----

# slope TAN PART: a ball of 1 cm on a slope, with mu_r this part of its radius
slope()
{
    jq -n --argjson t "$1" --argjson m "$2" '{ dt: 1e-3, mu: 0.6, gravity: [(9.81 * $t), 0, -9.81], rolling: { mu_r: ($m * 0.01) },
        walls: [{ normal: [0, 0, 1], point: [0, 0, 0] }], bodies: [{ x: [0, 0, 0.01], radius: 0.01 }] }' | nsd-gen -
}
slope 0.1 0.101 >"$tmp/stays.h5"
slope 0.1 0.04 >"$tmp/rolls.h5"
for m in sbp sal ebp eal exact auto; do
    step -m $m --criterion natural --tolerance 1e-10 -n 100 "$tmp/stays.h5" >"$tmp/stayed.h5"
    like "-m $m: a ball stays on a slope of less than mu_r/R" \
        "$(nsd-info --last -p "$tmp/stayed.h5" | jq '(.v | map(fabs) | max) < 1e-9')" true
    step -m $m --criterion natural --tolerance 1e-10 -n 100 "$tmp/rolls.h5" >"$tmp/rolled.h5"
    like "-m $m: and rolls down a steeper one with 5/7 (g sin - mu_r/R g cos)" \
        "$(nsd-info --last -p "$tmp/rolled.h5" | jq '(.v[0] / (0.1 * 5 / 7 * 9.81 * 0.06) - 1 | fabs) < 1e-9')" true
    rm "$tmp/stayed.h5" "$tmp/rolled.h5"
done
# over the effective radius: r at a wall, r1 r2/(r1 + r2) of two balls
nsd-info --scene "$tmp/rolls.h5" | jq '.rolling = { mu_r_ratio: 0.03, mu_r: 1e-4 }' | nsd-gen - >"$tmp/ratio.h5"
is "mu_r_ratio at a wall is mu_r/R" \
    "$(step -m exact --criterion natural --tolerance 1e-10 -n 100 "$tmp/ratio.h5" | nsd-info --last -p | jq '(.v[0] / (0.1 * 5 / 7 * 9.81 * 0.06) - 1 | fabs) < 1e-9')" true
jq -n '{ dt: 1e-3, mu: 0.6, rolling: { mu_r_ratio: 0.3, mu_p_ratio: 0.06, mu_p: 1e-3 },
    bodies: [{ x: [0, 0, 0], radius: 0.01 }, { x: [0.03, 0, 0], radius: 0.02 }] }' | nsd-gen - | nsd-detect >"$tmp/two.h5"
is "of two balls it is of r1 r2/(r1 + r2), and added" "$(nsd-info -c "$tmp/two.h5" | jq -c '[.mu_r, .mu_p] | map(. * 1e9 | round)')" '[2000000,1400000]'
is "documents keep it" "$(nsd-cat "$tmp/two.h5" | nsd-info | jq -c 'select(.material).material[0].rolling | [.mu_r, .mu_p, .mu_r_ratio, .mu_p_ratio]')" '[0,0.001,0.3,0.06]'
for how in '{ v: [0.1, 0, 0], w: [0, 10, 0] }|.x[0] / (7 * 0.1 * 0.1 / (10 * 0.02 * 9.81))|1e-2' \
    '{ v: [0, 0, 0], w: [0, 0, 10] }|.w[2] / (10 - 0.1 * 2e-4 * 9.81 / (0.4 * 1e-4))|1e-9'; do
    IFS='|' read -r motion what tolerance <<<"$how"
    jq -n '{ dt: 1e-3, mu: 0.6, rolling: { mu_r: 2e-4, mu_p: 2e-4 }, walls: [{ normal: [0, 0, 1], point: [0, 0, 0] }],
        bodies: [{ x: [0, 0, 0.01], radius: 0.01 } + '"$motion"'] }' | nsd-gen - >"$tmp/moves.h5"
    n=1000
    [[ $what != .w* ]] || n=100
    step --tolerance 1e-10 -n $n --every $n --log "$tmp/moves.log" "$tmp/moves.h5" >"$tmp/moved.h5"
    like "a ball that moves as $motion ends as the closed form says" \
        "$(nsd-info --last -p "$tmp/moved.h5" | jq "($what - 1 | fabs) < $tolerance")" true
    like "and its energy is balanced" "$(misfit "$tmp/moves.log" | jq '. < 1e-12')" true
    rm "$tmp/moved.h5"
done
jq -n '{ dt: 2e-5, mu: 0.4, e_n: 0.2, e_t: 0.1, rolling: { mu_r: 1e-4, mu_p: 5e-5 },
    walls: [{ box: { x: [0, 0.006], y: [0, 0.006], z: [0, null] } }],
    bodies: [{ random: { count: 80 }, radius: { uniform: [4e-4, 6e-4] }, box: { x: [0, 0.006], y: [0, 0.006], z: [0, 0.006] }, v: [0, 0, -0.2] }] }' |
    nsd-gen - >"$tmp/grains.h5"
step -n 400 --every 400 --log "$tmp/rolling.log" -o "$tmp/some.h5" "$tmp/grains.h5"
nsd-cat --last "$tmp/some.h5" >"$tmp/rolling.h5"
rm "$tmp/some.h5"
like "rolling grains: energy is balanced in every step" "$(misfit "$tmp/rolling.log" | jq '. < 1e-12')" true
whole rolling.h5
for m in sbp sal ebp eal exact; do
    nsd-detect "$tmp/rolling.h5" | solve -m $m --criterion natural --tolerance 1e-8 --max-sweeps 100000 >"$tmp/m.h5"
    like "rolling grains: -m $m solves them" "$(nsd-err "$tmp/m.h5" | jq '.natural < 2e-8')" true
done
nsd-detect "$tmp/rolling.h5" >"$tmp/contacts.h5"
for g in anderson auto; do
    solve --solver $g --criterion natural --tolerance 1e-8 --max-sweeps 100000 "$tmp/contacts.h5" >"$tmp/g.h5"
    like "rolling grains: --solver $g solves them" "$(nsd-err "$tmp/g.h5" | jq '.natural < 2e-8')" true
    like "in fewer sweeps than Gauss-Seidel" "$(jq -n --argjson a "$(nsd-info "$tmp/g.h5" | tail -n 1)" \
        --argjson b "$(nsd-info "$tmp/m.h5" | tail -n 1)" '$a.sweeps < $b.sweeps')" true
    like "and finds the same velocities" "$(jq -n --slurpfile a <(nsd-info -c "$tmp/m.h5") --slurpfile b <(nsd-info -c "$tmp/g.h5") \
        '[$a, $b] | transpose | map(.[0].u[0] - .[1].u[0] | fabs) | length > 20 and max < 1e-6')" true
done
refuses 65 "rolling grains: nor is there an FCLIB problem of them" nsd-detect --fclib=local "$tmp/rolling.h5"
jq '.rolling = { mu_r: 1e-4 }' scenes/press.json | nsd-gen - >"$tmp/press.h5"
refuses 65 "nor are they solved with loads" nsd-step --solver auto -n 1000 -o "$tmp/pressed.h5" "$tmp/press.h5"
like "moments are within their limits" "$(nsd-info -c "$tmp/m.h5" | jq -s \
    'map(select(.mu_r) | (.moment[1] * .moment[1] + .moment[2] * .moment[2] | sqrt) <= 1e-4 * .r[0] * (1 + 1e-9) + 1e-30 and
        (.moment[0] | fabs) <= 5e-5 * .r[0] * (1 + 1e-9) + 1e-30) | length > 20 and all')" true

# ---- adhesion with damage ----

# pull DT VELOCITY ETA: two heavy balls, bonded, part at 1 m/s; c_n = 1e12, c_t = 5e11, w = 2, S = 1e-6
pull()
{
    jq -n --argjson dt "$1" --argjson v "$2" --argjson eta "$3" '{ dt: $dt, gravity: [0, 0, 0], mu: 0.3, overlap: true,
        adhesion: { c_n: 1e12, c_t: 5e11, w: 2, area: 1e-6, eta: $eta },
        bodies: [{ x: [0, 0, 0], radius: 1e-3, density: 1e12 }, { x: [(0.002 - $dt / 2 * $v[0]), 0, 0], radius: 1e-3, density: 1e12, v: $v }] }' |
        nsd-gen - >"$tmp/pull.h5"
    step -n "$(jq -n "7e-5 / $1 | floor")" --contacts --log "$tmp/pull.log" -o "$tmp/pulled.h5" "$tmp/pull.h5"
    nsd-info -c "$tmp/pulled.h5" >"$tmp/pulled"
    rm "$tmp/pulled.h5"
    jq -n -c --argjson peak "$(jq -s "map(.r | map(. * .) | add | sqrt) | max / $1" "$tmp/pulled")" \
        --argjson broken "$(jq -s 'map(.balance.broken) | add' "$tmp/pull.log")" '[$peak, $broken]'
}
for direction in '[1,0,0] 2e12' '[0,1,0] 1e12' '[0,0,-1] 1e12'; do
    read -r v wc <<<"$direction"
    a=$(pull 1e-7 "$v" 0)
    [ -z "$thin" ] || break
    b=$(pull 2.5e-8 "$v" 0)
    like "pulled along $v a bond bears S sqrt(w c), to first order" "$(jq -n --argjson a "$a" --argjson b "$b" \
        "(\$a[0] / (1e-6 * ($wc | sqrt)) - 1) as \$e | (\$b[0] / (1e-6 * ($wc | sqrt)) - 1) as \$f |
        (\$f | fabs) < 0.02 and (\$f | fabs) < 0.4 * (\$e | fabs)")" true
    like "and costs w S, to first order" "$(jq -n --argjson a "$a" --argjson b "$b" \
        '($a[1] / 2e-6 - 1) as $e | ($b[1] / 2e-6 - 1) as $f | ($f | fabs) < 0.03 and ($f | fabs) < 0.4 * ($e | fabs)')" true
done
like "beta never grows" "$(jq -s 'map(.beta) | . == (sort | reverse) and .[0] == 1 and .[-1] < 0.01' "$tmp/pulled")" true
like "energy is balanced in every step" "$(misfit "$tmp/pull.log" | jq '. < 1e-6')" true
like "viscosity makes it cost more" "$(pull 1e-7 '[1,0,0]' 1e-5 | jq '.[1] > 2.2e-6')" true

# a ball welded below another that is held
jq -n '{ dt: 1e-3, mu: 0.3, adhesion: { c_n: 1e12, w: 1e9, area: 1e-4 },
    bodies: [{ x: [0, 0, 0], radius: 0.01, fixed: true }, { x: [0, 0, -0.02], radius: 0.01, density: 1e4 }] }' | nsd-gen - >"$tmp/weld.h5"
for m in sbp sal ebp eal exact; do
    step -m $m --criterion natural --tolerance 1e-10 -n 20 "$tmp/weld.h5" >"$tmp/welded.h5"
    like "-m $m: a welded ball hangs, its bond as long as its weight makes it" "$(nsd-info --last -p "$tmp/welded.h5" |
        jq -s '(4 / 3 * 3.141592653589793e-6 * 1e4 * 9.81 / 1e8) as $d | (-0.02 - .[1].x[2] - $d | fabs) < 0.01 * $d')" true
    rm "$tmp/welded.h5"
done

# beam N: two rows of N + 1 discs, bonded, held at one end: below rigid, above springs of c_n
beam()
{
    jq -n --argjson n "$1" '{ dim: 2, dt: 1, density: (4 / 3.141592653589793), gravity: [0, -1], adhesion: { c_n: 1e9, w: 1e6, area: 1 },
        bodies: [range(0; $n + 1) as $i | range(0; 2) as $j | { x: [$i, $j], radius: 0.5, fixed: ($i == 0) }] }' | nsd-gen - >"$tmp/beam.h5"
    step --max-sweeps 100000 --criterion natural --tolerance 1e-7 -n 4 "$tmp/beam.h5" >"$tmp/bent.h5"
    nsd-info --last -p "$tmp/bent.h5" | jq -s --argjson n "$1" 'map(select(.x[0] > $n - 0.5).x[1]) | (1 - add) / 2 / (2 * pow($n; 4) / 8e9) - 1'
    rm "$tmp/bent.h5"
}
e=$(for n in 5 10 20; do beam $n; done | jq -s -c .)
like "a bonded beam bends as Euler and Bernoulli have it, in the limit of a slender one" \
    "$(jq -n --argjson e "$e" '$e[2] < 0.09 and $e[1] < 0.5 * $e[0] and $e[2] < 0.5 * $e[1]')" true

# by its weight, of N^2 N m at the wall, and rows 1 m apart, the uppermost bond there bears N^2 N: that it bears, or it breaks
for part in 1.02 0.98; do
    jq -n --argjson part $part '6 as $n | { dim: 2, dt: 1, density: (4 / 3.141592653589793), gravity: [0, -1],
        adhesion: { c_n: 1e9, w: ($part * $n * $n | . * . / 1e9), area: 1 },
        bodies: [range(0; $n + 1) as $i | range(0; 2) as $j | { x: [$i, $j], radius: 0.5, fixed: ($i == 0) }] }' | nsd-gen - |
        step --overlap-rule keep --max-sweeps 100000 --criterion natural --tolerance 1e-8 -n 6 --log "$tmp/breaks.log" -o "$tmp/breaks.h5"
    like "a bonded beam breaks where a bond bears S sqrt(w c_n), not below: $part" \
        "$(jq -s 'map(.balance.broken) | add > 0' "$tmp/breaks.log")" "$(jq -n "$part < 1")"
    rm "$tmp/breaks.h5"
done

# a chain of balls is peeled off a floor: w S a ball
jq -n '{ dt: 5e-7, mu: 0.3, gravity: [0, 0, 0], materials: { hook: {} }, pairs: [{ pair: ["ball", "wall"], adhesion: { c_n: 1e12, w: 1, area: 1e-7 } },
    { pair: ["ball", "ball"], adhesion: { c_n: 1e13, w: 1e6, area: 1e-7 } }, { pair: ["ball", "hook"], adhesion: { c_n: 1e13, w: 1e6, area: 1e-7 } }], walls: [{ normal: [0, 0, 1], point: [0, 0, 0] }],
    bodies: [range(0; 5) as $i | { x: [$i * 2e-3, 0, 1e-3], radius: 1e-3 } | if $i == 0 then . + { material: "hook", density: 1e9, v: [0, 0, 1] } else . end] }' |
    nsd-gen - >"$tmp/chain.h5"
step -n 14000 --every 14000 --log "$tmp/peel.log" -o "$tmp/peeled.h5" "$tmp/chain.h5"
like "peeling a chain of five balls, one free, costs four times w S" \
    "$(jq -s '(map(.balance.broken) | add) / 4e-7 - 1 | fabs < 0.15' "$tmp/peel.log")" true
like "and the balls still hang together" "$(nsd-cat --last "$tmp/peeled.h5" | nsd-detect | nsd-info -c | jq -s 'map(select(.beta == 1 and .body[0] >= 0)) | length')" 4

grains() # ADHESION
{
    jq -n --argjson a "$1" '{ dt: 2e-5, mu: 0.4, e_n: 0.2, walls: [{ box: { x: [0, 0.006], y: [0, 0.006], z: [0, null] } }],
        bodies: [{ random: { count: 80 }, radius: { uniform: [4e-4, 6e-4] }, box: { x: [0, 0.006], y: [0, 0.006], z: [0, 0.006] }, v: [0, 0, -0.2] }] } +
        if $a then { adhesion: $a } else {} end' | nsd-gen - >"$tmp/grains.h5"
    step --solver auto -n 400 --every 400 --log "$tmp/bonded.log" -o "$tmp/some.h5" "$tmp/grains.h5"
    nsd-cat --last "$tmp/some.h5" >"$tmp/bonded.h5"
    rm "$tmp/some.h5"
}
grains null
cp "$tmp/bonded.h5" "$tmp/dry.h5"
grains '{ "c_n": 1e11, "w": 1, "beta": 0, "forever": true }'
ok "with beta = 0 it is Coulomb's law, to the bit" same_particles "$tmp/dry.h5" "$tmp/bonded.h5"
grains '{ "c_n": 1e11, "c_t": 5e10, "w": 0.02, "eta": 1e-6, "area": 1e-7, "forever": true }'
like "bonded grains: energy is balanced in every step" "$(misfit "$tmp/bonded.log" | jq '. < 1e-12')" true
whole bonded.h5
nsd-detect "$tmp/bonded.h5" >"$tmp/contacts.h5"
for m in sbp sal ebp eal exact; do
    solve -m $m --criterion natural --tolerance 1e-8 --max-sweeps 100000 "$tmp/contacts.h5" >"$tmp/m.h5"
    like "bonded grains: -m $m solves them" "$(nsd-err "$tmp/m.h5" | jq '.natural < 1e-7')" true
done
for g in auto anderson; do
    solve --solver $g --criterion natural --tolerance 1e-8 --max-sweeps 100000 "$tmp/contacts.h5" >"$tmp/g.h5"
    like "bonded grains: --solver $g solves them" "$(nsd-err "$tmp/g.h5" | jq '.natural < 1e-7')" true
    like "and finds the same velocities" "$(jq -n --slurpfile a <(nsd-info -c "$tmp/m.h5") --slurpfile b <(nsd-info -c "$tmp/g.h5") \
        '[$a, $b] | transpose | map(.[0].u[0] - .[1].u[0] | fabs) | length > 20 and max < 1e-6')" true
done
# bonded grains as problems of others: r of these is r*, their velocities are the same
for form in local global; do
    if have_h5py; then
        like "bonded grains: as a $form FCLIB problem they have the same velocities" "$(foreign "$form" "$tmp/bonded.h5" "$tmp/m.h5")" true
    else
        skip "bonded grains as a $form FCLIB problem" "no h5py"
    fi
done
jq '.adhesion = { c_n: 1e11, w: 0.1, forever: true } | .capillary = { volume: 1e-11, tension: 0.07 }' scenes/press.json | nsd-gen - | step -n 600 --every 600 --log "$tmp/press.log" -o "$tmp/press.h5"
like "bonded and wet under a piston: energy is balanced" "$(misfit "$tmp/press.log" | jq '. < 1e-11')" true
like "and all steps converge" "$(jq -s 'all(.converged) and .[-1].contacts > 50' "$tmp/press.log")" true

# ---- contacts with a stiffness ----

# soft KEYS HEIGHT VX: a ball of 1 cm above a floor, with these keys of the scene besides
soft()
{
    jq -n --argjson more "$1" --argjson z "$2" --argjson vx "$3" '{ dt: 1e-3, mu: 0.3, stiffness: 1e6,
        walls: [{ normal: [0, 0, 1], point: [0, 0, 0] }], bodies: [{ x: [0, 0, $z], radius: 0.01, v: [$vx, 0, 0] }] } + $more' | nsd-gen -
}
near() { jq -en "($1 - $2 | fabs) <= $3 * (if $2 > 0 then $2 else 1 end)" >/dev/null; } # VALUE WANTED RELATIVE
last() { nsd-info --last -p "$1"; }
weight=$(jq -n '4 / 3 * 3.141592653589793 * 1e-6 * 2500 * 9.81')
for k in 1e5 1e6; do
    soft '{"stiffness": '$k'}' 0.01 0 | step --tolerance 1e-9 -n 400 --every 400 -o "$tmp/rest.h5"
    ok "a ball at rest sinks by m g/k, k = $k" near "$(last "$tmp/rest.h5" | jq '0.01 - .x[2]')" "$(jq -n "$weight / $k")" 1e-6
    rm "$tmp/rest.h5"
done
for e in 0 0.3 0.7 1; do
    soft '{"e_n": '$e'}' 0.11 0 | step --small-steps 0 -n 200 -o "$tmp/bounce.h5"
    ok "a ball rebounds with $e of its speed" near "$(nsd-info -p "$tmp/bounce.h5" | jq -s '-(map(.v[2]) | max) / (map(.v[2]) | min)')" "$e" 1e-4
    rm "$tmp/bounce.h5"
done
for m in sbp sal ebp eal exact; do
    soft '{"e_n": 0.5}' 0.01 1 | step -m $m --tolerance 1e-9 -n 400 --every 400 -o "$tmp/rolled.h5"
    ok "-m $m: a ball slides, then rolls at 5/7 of its speed" near "$(last "$tmp/rolled.h5" | jq '.v[0]')" "$(jq -n 5/7)" 1e-9
    rm "$tmp/rolled.h5"
done
# a brick on a slope below the angle of friction: its springs carry it
jq -n '{ dt: 1e-3, mu: 0.5, gravity: [2, 0, -9], stiffness: { normal: 1e6, tangential: 5e5 },
    walls: [{ normal: [0, 0, 1], point: [0, 0, 0] }], shapes: { brick: { box: [0.04, 0.04, 0.01] } },
    bodies: [{ x: [0, 0, 0.005], shape: "brick", size: 1 }] }' | nsd-gen - | step --tolerance 1e-9 -n 3000 --every 3000 -o "$tmp/brick.h5"
# four springs of 5e5 N/m along the slope, and the turn by its pull at the centre, 5 mm above them
ok "a brick on a slope stays, displaced by m g sin/(4 k_t)" near "$(last "$tmp/brick.h5" | jq '.x[0]')" "$(jq -n '0.08 / 2e6 + 0.08 * 2.5e-5 / (4e6 * 4e-4)')" 1e-2

# with rolling friction: beyond its limit, and below it with springs of k_t R^2; and with cohesion
jq -n '{ dt: 1e-3, mu: 0.6, gravity: [3, 0, -9], stiffness: 1e6, rolling: { mu_r: 1e-3 }, walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }],
    bodies: [{ x: [0, 0, 0.01], radius: 0.01 }] }' | nsd-gen - | step --criterion natural --tolerance 1e-10 -n 100 --every 100 -o "$tmp/down.h5"
ok "a ball rolls down a slope with 5/7 (g sin - mu_r/R g cos)" near "$(last "$tmp/down.h5" | jq '.v[0]')" 0.15 1e-9
# tilted KEYS BODY: below the angle of rolling friction
tilted()
{
    jq -n --argjson more "$1" --argjson body "$2" '{ dt: 1e-3, mu: 0.6, gravity: [1, 0, -9], stiffness: 1e6, rolling: { mu_r: 2e-3 },
        walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }], bodies: [{ x: [0, 0, 0.01] } + $body] } + $more' | nsd-gen -
}
for m in sbp sal ebp eal exact; do
    tilted '{}' '{ "radius": 0.01 }' | step -m $m --criterion natural --tolerance 1e-11 -n 100 --every 100 -o "$tmp/down.h5"
    # F/k_t by the slip, and F R/(k_t R^2) R by the turn
    ok "-m $m: a ball is held on a slope, displaced by 2 F/k_t" near "$(last "$tmp/down.h5" | jq '.x[0]')" \
        "$(jq -n '4 / 3 * 3.141592653589793 * 1e-6 * 2500 * 7 / 1e6')" 1e-6
    rm "$tmp/down.h5"
done
# two balls as one grain, whose bounding ball has a radius of 16 mm: two contacts, each with k_t (16 mm)^2
tilted '{ "shapes": { "pair": { "balls": [[0, 0.006, 0, 0.01], [0, -0.006, 0, 0.01]] } } }' \
    '{ "shape": "pair", "size": 1 }' >"$tmp/pair.h5"
step --criterion natural --tolerance 1e-11 -n 100 --every 100 -o "$tmp/down.h5" "$tmp/pair.h5"
ok "two balls as one grain are held by 2 k_t and 2 k_t R^2" near "$(last "$tmp/down.h5" | jq '.x[0]')" \
    "$(nsd-info -p "$tmp/pair.h5" | jq '.mass * (1 + (1 / 1.6) * (1 / 1.6)) / (2 * 2e6 / 7)')" 1e-5
# k_r h^2/I of a spinning ball in one step
tilted '{ "gravity": [0, 0, -9], "rolling": { "mu_p": 100 } }' '{ "radius": 0.01, "w": [0, 0, 1] }' |
    step --criterion natural --tolerance 1e-12 -n 1 -o "$tmp/spun.h5"
ok "a spring against pivoting: an implicit step of k_t R^2" near "$(last "$tmp/spun.h5" | jq '.w[2]')" \
    "$(jq -n '4 / 3 * 3.141592653589793 * 1e-6 * 2500 * 0.4 | 1 / (1 + 2 / 7 / .)')" 1e-9
for f in 1.001 0.999; do
    jq -n --argjson f "$(jq -n "$f * $weight")" '{ dt: 1e-3, stiffness: 1e6, cohesion: { force: $f },
        walls: [{ normal: [0, 0, -1], point: [0, 0, 0] }], bodies: [{ x: [0, 0, -0.01], radius: 0.01 }] }' | nsd-gen - |
        step --tolerance 1e-9 -n 100 --every 100 | last - | jq '.x[2] > -0.0100001' >>"$tmp/hangs"
done
is "a ball hangs from a ceiling by 1.001 of its weight, and falls from 0.999" "$(tr '\n' ' ' <"$tmp/hangs")" "true false "

# a heap: unique reactions, the same bits by every way, and at rest
nsd-gen 200 | step --stiffness auto -n 1500 --every 1500 -o "$tmp/heap.h5"
nsd-cat --last "$tmp/heap.h5" >"$tmp/springs.h5"
nsd-detect "$tmp/springs.h5" >"$tmp/found.h5"
reactions() # WAY ...
{
    nsd-solve --criterion natural --tolerance 3e-11 --max-sweeps 100000 "$@" "$tmp/found.h5" 2>/dev/null | nsd-info -c | jq -c 'select(.r) | .r'
}
reactions --cold >"$tmp/r"
for way in '-m exact --order random' '-m eal' '--solver nlgs --order natural'; do
    # shellcheck disable=SC2086 # a way is several words
    reactions $way >"$tmp/other"
    ok "$way finds the same reactions, to 1e-5 of their mean" \
        test "$(jq -n --slurpfile a "$tmp/r" --slurpfile b "$tmp/other" \
            '([$a, $b] | transpose | map(transpose | map(.[0] - .[1] | fabs) | max) | max) < 1e-5 * ($a | map(.[0]) | add / length)')" = true
done
whole springs.h5
like "a heap at rest stays at rest" "$(step -n 500 --every 500 "$tmp/springs.h5" | nsd-info | tail -n 1 | jq '.kinetic_energy < 1e-8 and .balance.implicit >= 0')" true
nsd-detect --fclib=global "$tmp/springs.h5" | solve --tolerance 1e-12 | nsd-err >"$tmp/global.err"
like "the global form is the same problem" "$(jq '.natural < 1e-9' "$tmp/global.err")" true

# a wedge that locks itself: Newton's law has no solution there
jq -n '{ dt: 2e-4, mu: 0.5, e_n: 0.9, stiffness: 1e6, bodies: [{ x: [0, 0, 0.01], radius: 1e-3 }],
    walls: [1, -1 | { point: [0, 0, 0], normal: [. * 0.94, 0, 0.34] }] }' | nsd-gen - | nsd-step -e --small-steps 0 -n 400 --contacts -o "$tmp/vee.h5" 2>"$tmp/said" && vee=0 || vee=$?
is "every step of an impact in a self-locking wedge has a solution" "$vee" 0
like "the force is bounded: with e = 0 it is 7.9e-3 N" \
    "$(nsd-stat -m boundaries "$tmp/vee.h5" | jq -s '[.[].boundaries.force | flatten | map(fabs) | max] | max < 0.12')" true
like "the last lines name the stiffness" "$(cat "$tmp/said")" 'stiffness of contacts 1e\+06 N/m, compliance 0.00013'
rm "$tmp"/vee.h5

# bodies that overlap in a scene part slowly
jq -n '{ dt: 1e-3, stiffness: 1e6, overlap: true, walls: [{ normal: [0, 0, 1], point: [0, 0, 0] }],
    bodies: [{ x: [0, 0, 0.0095], radius: 0.01 }] }' | nsd-gen - | step -n 100 --log "$tmp/deep.log" -o "$tmp/deep.h5"
like "its energy is balanced with what the rise gives, and in the sum of all steps" "$(misfit "$tmp/deep.log" | jq '. < 1e-12') \
    $(jq -s 'map(.balance) | (map(.bond_change) | add) / .[-1].bond_energy - 1 | fabs < 1e-6' "$tmp/deep.log")" 'true +true'
like "a ball that is in a floor rises at g dt" "$(nsd-info -p "$tmp/deep.h5" | jq -s '(map(.v[2]) | max) < 0.01 and (.[-1].x[2] | . > 0.00999)')" true

# with rolling friction, and with bonds, which have no springs besides
jq '.stiffness = 1e5 | .rolling = { mu_r: 1e-4, mu_p: 1e-4 } | .walls = .walls[:1]' scenes/press.json | nsd-gen - | step --small-steps 0 -n 600 --every 600 --contacts --log "$tmp/press.log" -o "$tmp/press.h5"
like "a heap with a stiffness and rolling friction: energy is balanced" "$(misfit "$tmp/press.log" | jq '. < 1e-9')" true
like "and what the springs of moments store is positive" "$(nsd-info --last -c "$tmp/press.h5" | jq -s 'map(select(.turn) | .rolling_stiffness * (.turn | map(. * .) | add)) | add > 0')" true
nsd-cat --last "$tmp/press.h5" >"$tmp/rolls.h5"
whole rolls.h5
jq '.stiffness = 1e5 | .adhesion = { c_n: 1e11, w: 0.1, forever: true }' scenes/press.json | nsd-gen - | step -n 600 --every 600 --contacts --log "$tmp/press.log" -o "$tmp/press.h5"
like "with a stiffness and bonds under a piston, energy is balanced" "$(misfit "$tmp/press.log" | jq '. < 1e-9')" true
like "all steps converge, and contacts have one or the other" \
    "$(jq -s 'all(.converged)' "$tmp/press.log") $(nsd-info --last -c "$tmp/press.h5" | jq -s 'map(select(.mu)) | length > 50 and all((.beta > 0) != (.spring[0] > 0)) and any(.beta > 0)')" 'true true'
nsd-cat --last "$tmp/press.h5" >"$tmp/bonds.h5"
whole bonds.h5
refuses 64 "and no word for a stiffness" nsd-step --stiffness soft "$tmp/springs.h5"

# what a scene says of it: the stiffness in N/m of balls of 1 and 2 cm, or of discs
stated() # DIM STIFFNESS
{
    jq -n --argjson dim "$1" --argjson k "$2" '{ dim: $dim, dt: 1e-3, walls: [{ point: [0, 0, 0][:$dim], normal: [0, 0, 1][-$dim:] }],
        bodies: [{ x: [0, 0, 0.01][-$dim:], radius: 0.01 }, { x: [0.1, 0.02, 0.02][:$dim], radius: 0.02 }] } +
        if $k then { stiffness: $k } else {} end' | nsd-gen - >"$tmp/stated.h5"
    nsd-info "$tmp/stated.h5" | jq -c 'select(.type == "packing").material[0].stiffness // empty'
}
for dim in 2 3; do
    both=$(stated $dim '"auto"')$(stated $dim '{ "compliance": 1e-2 }')
    stated $dim null
    nsd-detect --stiffness auto "$tmp/stated.h5" >"$tmp/found.h5"
    is "in ${dim}D \"auto\" in a scene is --stiffness auto, and a compliance of 1e-2" "$both" \
        "$(nsd-info "$tmp/found.h5" | jq -c 'select(.type == "packing").material[0].stiffness | ., .' | paste -sd '')"
done
refuses 64 "a compliance above 1" nsd-step --stiffness auto:2 "$tmp/stated.h5"
refuses 65 "a compliance with a tangential stiffness" nsd-gen <(jq -n '{ dt: 1e-3, stiffness: { compliance: 0.1, tangential: 1e3 }, bodies: [{ x: [0, 0, 0], radius: 1 }] }')

# "auto": k = 1/(alpha W dt^2) of each contact. A ball of 1 cm of density 2500 on a light one, on a floor
light() # DENSITY HEIGHT V KEYS: of the heavy one, its gap and speed
{
    jq -n --argjson density "$1" --argjson gap "$2" --argjson v "$3" --argjson more "$4" '{ density: 2500, stiffness: "auto",
        walls: [{ normal: [0, 0, 1], point: [0, 0, 0] }], materials: { heavy: { density: $density } }, bodies: [{ x: [0, 0, 0.01], radius: 0.01 },
        { x: [0, 0, (0.03 + $gap)], radius: 0.01, v: [0, 0, (-$v)], material: "heavy" }] } + $more' | nsd-gen -
}
for dt in 1e-3 1e-4; do
    light 2500 0 0 '{ "dt": '$dt' }' | step --criterion natural --tolerance 1e-12 -n 100 --every 100 -o "$tmp/stack.h5"
    # W = 1/m at the floor, 2/m between the balls
    ok "auto, dt $dt: two balls sink by alpha W F dt^2 at each contact" near "$(last "$tmp/stack.h5" | jq -s '0.03 - .[1].x[2]')" "$(jq -n "1e-2 * (2 + 2) * 9.81 * $dt * $dt")" 1e-6
    [ $dt = 1e-4 ] || rm "$tmp/stack.h5"
done
for dt in 2.5e-5 4e-4; do
    step --dt $dt --criterion natural --tolerance 1e-12 -n 30 --log "$tmp/dt.log" -o "$tmp/other.h5" "$tmp/stack.h5"
    like "with a time step of $dt they stay at rest: springs push as before" "$(jq -s "(map(.balance.kinetic) | max) < 2e-3 * $weight / 9.81 * (9.81 * $dt) * (9.81 * $dt)" "$tmp/dt.log")" true
    rm "$tmp/other.h5" "$tmp/dt.log"
done
rm "$tmp/stack.h5"
for dt in 1e-3 1e-4 1e-5; do
    for e in 0 0.5 0.9 1; do
        jq -n --argjson e $e --argjson dt $dt '{ dt: $dt, density: 2500, e_n: $e, stiffness: "auto", walls: [{ normal: [0, 0, 1], point: [0, 0, 0] }],
            bodies: [{ x: [0, 0, (0.01 + 2.5 * $dt)], radius: 0.01, v: [0, 0, -1] }] }' | nsd-gen - | nsd-step -n 5 2>/dev/null |
            nsd-info -p | jq -s -c --argjson e $e 'map(.v[2]) | -max / min - $e | fabs < 1e-4'
    done
done | sort -u >"$tmp/rebounds"
is "auto: a ball rebounds with e of its speed at any time step" "$(cat "$tmp/rebounds")" true
jq '.e_n = 0.5' scenes/heap.json | nsd-gen - | step --small-steps 0 --stiffness auto --criterion natural --tolerance 1e-8 -n 300 --every 300 --log "$tmp/heap.log" -o "$tmp/fallen.h5"
like "auto: discs that rebound gain no energy" "$(jq -s 'all(.converged) and (map(.balance | .dissipation / (.kinetic + 1e-9)) | min) > -1e-6' "$tmp/heap.log")" true
rm "$tmp/fallen.h5"
# with C r the heavy ball would keep 0.8 of its speed: C is ten times its 1/m
for dt in 1e-3 1e-5; do
    light 2500000 0 1 '{ "dt": '$dt' }' | step -n 1 -o "$tmp/heavy.h5"
    like "auto, dt $dt: a ball that a light one carries stops within a step" "$(last "$tmp/heavy.h5" | jq -s '.[1].v[2] | fabs < 0.02')" true
    rm "$tmp/heavy.h5"
done
ok "Young's modulus E: pi/4 E d of the smallest ball" near "$(stated 3 '{ "young": 1e7 }' | jq .normal)" "$(jq -n '3.141592653589793 / 4 * 1e7 * 0.02')" 1e-15
is "in the plane E; and 2/7 of it across, or what is given" "$(stated 2 '{ "young": 7e6 }')$(stated 2 '{ "young": 7e6, "tangential": 5e3 }')" \
    '{"normal":7000000,"tangential":2000000}{"normal":7000000,"tangential":5000}'

# ---- grains that are no balls ----

# A brick bonded below another, held by four corners. Its centre of mass is not below the middle of the bond, so that it
# tips a little too; damped by its own implicit step it comes to rest.
jq -n '{ dt: 2e-3, mu: 0.3, density: 1000, shapes: { brick: { box: [0.2, 0.1, 0.1] } },
    adhesion: { c_n: 1e8, c_t: 5e7, w: 1e9, area: 1e-3 },
    bodies: [{ x: [0, 0, 0], shape: "brick", fixed: true }, { x: [0.03, 0, -0.1], shape: "brick" }] }' | nsd-gen - >"$tmp/weld.h5"
for m in sbp sal ebp eal exact; do
    step -m $m --criterion natural --tolerance 1e-10 -n 300 --every 300 --contacts --log "$tmp/weld.log" "$tmp/weld.h5" >"$tmp/welded.h5"
    # the four springs: a force m g, and its moment about the middle of the bond, 15 mm off the centre of mass
    like "-m $m: a brick hangs from its bond" "$(nsd-info -c "$tmp/welded.h5" | jq -s '(2 * 9.81) as $f | (map(.r[0]) | add / -2e-3) as $pull |
        length == 4 and all(.beta == 1) and ($pull / $f - 1 | fabs) < 1e-3 and
        ((map(.gap) | max) / ($f / (1e8 * 1e-3) * (1 + 0.015 / 0.085)) - 1 | fabs) < 0.01')" true
    like "and its energy is balanced" "$(misfit "$tmp/weld.log" | jq '. < 1e-9')" true
done
for w in 2.1 0.95; do # what comes at once stretches a spring up to twice as far
    jq -n --argjson w $w '{ dt: 1e-4, mu: 0.3, density: 1000, shapes: { cube: { box: [0.1, 0.1, 0.1] } },
        adhesion: { c_n: 1e12, c_t: 1e12, w: (($w * 9.81 / 1e-3) as $s | $s * $s / 1e12), area: 1e-3 },
        bodies: [{ x: [0, 0, 0], shape: "cube", fixed: true }, { x: [0, 0, -0.1], shape: "cube", density: 1000 }] }' | nsd-gen - >"$tmp/weld.h5"
    step --criterion natural --tolerance 1e-8 -n 100 --every 100 --contacts "$tmp/weld.h5" >"$tmp/welded.h5"
    like "a cube hangs from a bond of $w times its weight, or does not" \
        "$(nsd-info --last -p "$tmp/welded.h5" | jq -s '.[1].x[2] > -0.1001')" "$(jq -n "$w > 1")"
done
# A brick bonded to a floor that carries it out of a cell that repeats, twice along one edge and once along the other
jq -n '{ dt: 1e-3, mu: 0.3, density: 1000, cell: { lengths: [0.5, 0.5, 1], repeats: [true, true, false] },
    shapes: { brick: { box: [0.2, 0.1, 0.1] } }, adhesion: { c_n: 1e9, c_t: 5e8, w: 1e9, area: 1e-3 },
    walls: [{ point: [0, 0, 0], normal: [0, 0, 1], velocity: [2, -1, 0] }],
    bodies: [{ x: [0.1, 0.1, 0.05], shape: "brick", v: [2, -1, 0] }] }' | nsd-gen - |
    step --criterion natural --tolerance 1e-10 -n 500 --every 500 --contacts -o "$tmp/ride.h5"
like "a brick rides on the floor that it is bonded to, through the border of a cell that repeats" \
    "$(nsd-info --last -p "$tmp/ride.h5" | jq '.image == [2, -1, 0] and ([.x[0] - 0.1, .x[1] - 0.1, .x[2] - 0.05, .w[]] | map(fabs) | max < 1e-9)')" true
like "by its four bonds alone, none of them stretched" \
    "$(nsd-info --last -c "$tmp/ride.h5" | jq -s 'length == 4 and all(.beta == 1 and (.gap | fabs) < 1e-9)')" true

shaped() # LAWS STEPS: bricks, rods, clumps and balls that fall into a box
{
    jq -n '{ dt: 1e-4, mu: 0.4, e_n: 0.2, density: 2500, walls: [{ box: { x: [0, 0.05], y: [0, 0.05], z: [0, null] } }],
        shapes: { cube: { box: [0.008, 0.008, 0.008] }, rod: { capsule: { length: 0.008, radius: 0.003 } },
            duo: { balls: [[-0.003, 0, 0, 0.004], [0.003, 0, 0, 0.004]] } },
        bodies: ([["cube", 0], ["rod", 1], ["duo", 2]] | map({ count: 12, shape: .[0], box: { x: [0, 0.05], y: [0, 0.05], z: [0.03 * .[1], null] }, v: [0, 0, -0.3] }) +
            [{ count: 12, radius: 0.004, box: { x: [0, 0.05], y: [0, 0.05], z: [0.09, null] }, v: [0, 0, -0.4] }]) } + '"$1" | nsd-gen - >"$tmp/fall.h5"
    # what one sweep leaves of the impacts of grains may give energy
    step --missing-impulse 0.01 -n "$2" --every "$2" --log "$tmp/shaped.log" -o "$tmp/some.h5" "$tmp/fall.h5"
    nsd-cat --last "$tmp/some.h5" >"$tmp/shaped.h5"
    rm "$tmp/some.h5"
    like "shaped grains with $1: energy is balanced in every step" "$(misfit "$tmp/shaped.log" | jq '. < 1e-12')" true
    like "and nothing dissipates less than nothing" "$(jq -s '(map(.balance.kinetic) | max) as $most | map(.balance.dissipation) | min > -1e-5 * $most' "$tmp/shaped.log")" true
    nsd-detect "$tmp/shaped.h5" >"$tmp/contacts.h5"
    like "and more than 30 contacts are left" "$(nsd-info -c "$tmp/contacts.h5" | jq -s 'length > 30')" true
    local m
    for m in "${methods[@]}"; do
        solve -m "$m" --solver anderson --criterion natural --tolerance 1e-7 --max-sweeps 20000 "$tmp/contacts.h5" >"$tmp/m.h5"
        like "shaped grains with $1: -m $m solves them" "$(nsd-err "$tmp/m.h5" | jq '.natural < 1e-6')" true
    done
}
methods=(sbp sal ebp eal exact)
shaped '{ cohesion: { force: 5e-3, range: 1e-4 }, capillary: { volume: 1e-9, tension: 0.07 } }' 300
shaped '{ rolling: { mu_r: 1e-4, mu_p: 5e-5 } }' 380
whole shaped.h5
[ -z "$thin" ] || methods=(exact)
shaped '{ adhesion: { c_n: 1e9, c_t: 5e8, w: 5e-4, forever: true }, rolling: { mu_r: 1e-4, mu_p: 5e-5 } }' 500
like "bonds have been made, and some have broken" "$(jq -s '(map(.balance.broken) | add) > 1e-7 and .[-1].contacts > 30' "$tmp/shaped.log")" true
whole shaped.h5
# A brick that stands far away makes all contacts of a problem be taken by matrices: the balls move as they do by numbers.
twice() # BODIES
{
    jq -n '{ dt: 1e-4, mu: 0.4, density: 2500, walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }], shapes: { brick: { box: [0.01, 0.01, 0.01] } },
        rolling: { mu_r: 2e-4, mu_p: 1e-4 }, adhesion: { c_n: 1e10, c_t: 5e9, w: 1e-3, area: 1e-6, forever: true },
        bodies: ([{ count: 20, radius: 0.002, box: { x: [0, 0.02], y: [0, 0.02], z: [0, null] }, v: [0.05, 0, -0.3] }] + '"$1"') }' | nsd-gen - |
        step --solver nlgs --criterion natural --tolerance 1e-11 --overlap-rule keep -n 60 --log "$tmp/twice.log" | nsd-info --last -p | jq -c 'select(.radius == 0.002) | .x'
}
if [ -z "$thin" ]; then # a minute each under the sanitizers, of sweeps that are run elsewhere
    twice '[]' >"$tmp/numbers"
    twice '[{ x: [1, 0, 0.005], shape: "brick" }]' >"$tmp/matrices"
    like "balls move by matrices as by numbers" "$(jq -n --slurpfile a "$tmp/numbers" --slurpfile b "$tmp/matrices" \
        '[$a, $b] | transpose | map([.[0], .[1]] | transpose | map(.[0] - .[1] | fabs)) | flatten | length == 60 and max < 1e-9')" true
    like "where bonds hold and grains roll" "$(jq -s '(map(.balance.bond_energy) | max) > 0 and (map(.contacts) | max) > 20' "$tmp/twice.log")" true
fi
# in the plane
jq -n '{ dim: 2, dt: 2e-4, mu: 0.5, density: 2500, shapes: { tile: { box: [0.02, 0.01] }, five: { regular: { sides: 5, radius: 0.008 } } },
    adhesion: { c_n: 1e9, w: 0.05, forever: true }, rolling: { mu_r: 1e-4 },
    walls: [{ box: { x: [0, 0.1], y: [0, null] } }],
    bodies: [{ count: 15, shape: "tile", box: { x: [0, 0.1], y: [0, null] } }, { count: 15, shape: "five", box: { x: [0, 0.1], y: [0.15, null] } }] }' |
    nsd-gen - | step -n 500 --every 500 --log "$tmp/plane.log" -o "$tmp/plane-end.h5"
like "polygons: energy is balanced in every step" "$(misfit "$tmp/plane.log" | jq '. < 1e-12')" true
nsd-cat --last "$tmp/plane-end.h5" >"$tmp/polygons.h5"
whole polygons.h5

# ---- a boundary that turns does work by forces and by moments ----

for grain in disc box; do
    jq -n --arg grain $grain '{ dim: 2, dt: 5e-4, density: 2500, mu: 0.4, e_n: 0.2, rolling: { mu_r: 3e-4 }, cohesion: { force: 1, range: 1e-5 },
        adhesion: { c_n: 1e9, w: 0.02, forever: true }, shapes: { box: { box: [0.003, 0.002] } },
        walls: [{ circle: { center: [0, 0], radius: 0.03 }, drives: [{ about: [0, 0], speed: 6 }] }],
        bodies: [{ random: { count: 40 }, radius: { uniform: [1.4e-3, 1.6e-3] }, box: { x: [-0.02, 0.02], y: [-0.02, 0.02] } } +
            if $grain == "box" then { shape: "box" } else {} end] }' | nsd-gen - |
        step -n 250 --every 250 --criterion natural --tolerance 1e-3 --log "$tmp/turns.log" -o "$tmp/turned.h5"
    like "a drum of $grain grains that roll, hold together and break: energy is balanced in every step" \
        "$(misfit "$tmp/turns.log" | jq '. < 1e-12')" true
    like "and the drum has done work, and bonds have broken" \
        "$(jq -s '(map(.balance.drives) | add) > 1e-6 and (map(.balance.broken) | add) > 1e-6' "$tmp/turns.log")" true
    rm "$tmp/turned.h5"
done

# ---- bad input ----

bad() { echo "{\"dt\": 1e-3, $1}" | nsd-gen -; }
for law in '"cohesion": {"range": 1}' '"cohesion": {"force": -1}' '"cohesion": 1' '"capillary": {"volume": 1e-9}' \
    '"capillary": {"volume": 1e-9, "tension": 0.07, "wetting": 2}' '"rolling": {"mu_r": -1}' \
    '"adhesion": {"c_n": 1e9}' '"adhesion": {"c_n": 0, "w": 1}' '"adhesion": {"c_n": 1, "w": 1, "beta": 2}' \
    '"adhesion": {"c_n": 1, "w": 1, "made": 0, "forever": true}' \
    '"pairs": [{"pair": ["ball", "ball"], "cohesion": {"power": 1}}]'; do
    refuses 65 "nsd-gen refuses $law" bad "$law"
    like "and says where" "$(cat "$tmp/err")" "standard input:1:[0-9]+: .*(cohesion|capillary|rolling|adhesion)"
done

# ---- hostile documents ----

# changed SOURCE CODE: a copy of a document without its header, changed by Python
changed()
{
    tail -c +513 "$tmp/$1" >"$tmp/changed.h5"
    py -c "import h5py, numpy as np
f = h5py.File('$tmp/changed.h5', 'r+')
$2
f.close()"
}
if have_h5py; then
    nsd-detect "$tmp/wet.h5" | solve >"$tmp/ties.h5"
    while IFS= read -r code; do
        changed ties.h5 "$code"
        refuses 65 "nsd-move refuses $code" nsd-move "$tmp/changed.h5"
    done <<'CODES'
f['/nsd/law/cohesion'][0, 0] = -1
f['/nsd/law/cohesion'][0, 1] = 5
f['/nsd/law/wetting'][...] = 2
f['/nsd/law/c_n'][...] = np.nan
del f['/nsd/law/w']
f['/nsd/bonds/beta'][0] = 2
f['/nsd/bonds/body'][0] = (0, 1 << 30)
f['/nsd/bonds/body'][1] = f['/nsd/bonds/body'][0]
f['/nsd/bonds/normal'][0] = (1, 1, 0)
f['/nsd/bonds/slip'][0] = np.inf
f['/nsd/bonds/wet'][0] = 7
f['/nsd/bonds/count'][0] = 1 << 40
f['/nsd/bonds/start'][0] = -1
del f['/nsd/bonds/gap']
f['/contacts/pull'][0] = -1
f['/contacts/beta'][0] = np.nan
f['/contacts/jump'][0] = np.inf
f['/contacts/tie'][0] = 9
f['/contacts/mu_r'][0] = -1
del f['/contacts/stiffness']
CODES
    nsd-cat --last "$tmp/polygons.h5" >"$tmp/kept.h5"
    while IFS= read -r code; do
        changed kept.h5 "$code"
        refuses 65 "nsd-detect refuses $code" nsd-detect "$tmp/changed.h5"
    done <<'CODES'
f['/nsd/bonds/area'][0] = -1
f['/nsd/bonds/area'][0] = np.nan
f['/nsd/bonds/anchor_a'][0] = np.inf
f['/nsd/bonds/anchor_b'][0] = np.nan
f['/nsd/bonds/axis'][0] = 0
f['/nsd/bonds/feature'][0] = 3
f['/nsd/bonds/anchor_a'][0, 2] = 1e-3
f['/nsd/bonds/anchor_b'][0, 2] = 1e-3
f['/nsd/bonds/axis'][0] = (0, 0, 1)
del f['/nsd/bonds/axis']
CODES
    # bonds of bodies that are all held
    changed kept.h5 "f['/particles/all/mass'][...] = 0"
    is "what cannot move has no contacts, bonded or not" "$(nsd-detect "$tmp/changed.h5" | nsd-info | tail -n 1 | jq .contacts)" 0
else
    skip "hostile documents" "no h5py"
fi
done_testing
