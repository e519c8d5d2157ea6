#!/usr/bin/env bash
# nsd-stat: lattices and motions whose answers are closed, numpy on the same documents, balances; pipes,
# tables, and frames in which there is nothing to measure.
. tests/support/tap.sh

if ! has h5py; then echo "1..0 # SKIP no h5py"; exit; fi
truth() { py tests/support/stat.py "$@"; }
step() { nsd-step "$@" 2>/dev/null; }

# ---- lattices: a hair closer than touching ----

jq -n '{ dim: 2, dt: 1, overlap: true, gravity: [0, 0], cell: { lengths: [20, 20] | map(. * (1 - 1e-9)) },
    bodies: [range(10) as $i | range(10) as $j | { x: ([$i, $j] | map((2 * . + 1) * (1 - 1e-9))), radius: 1 }] }' >"$tmp/square.json"
jq -n '{ dim: 2, dt: 1, overlap: true, gravity: [0, 0], cell: { lengths: [20, (10 * (3 | sqrt))] | map(. * (1 - 1e-9)) },
    bodies: [range(10) as $i | range(10) as $j | { x: ([2 * $i + $j % 2 + 0.5, (3 | sqrt) * $j + 0.5] | map(. * (1 - 1e-9))), radius: 1 }] }' >"$tmp/hexagonal.json"
jq -n '{ dt: 1, overlap: true, gravity: [0, 0, 0], cell: { lengths: [10, 10, 10] | map(. * (1 - 1e-9)) },
    bodies: [range(5) as $i | range(5) as $j | range(5) as $k | { x: ([$i, $j, $k] | map((2 * . + 1) * (1 - 1e-9))), radius: 1 }] }' >"$tmp/cubic.json"
jq -n '{ dt: 1, overlap: true, gravity: [0, 0, 0], cell: { lengths: [1, 1, 1] | map(. * 6 * (2 | sqrt) * (1 - 1e-9)) },
    bodies: [range(6) as $i | range(6) as $j | range(6) as $k | select(($i + $j + $k) % 2 == 0) |
        { x: ([$i, $j, $k] | map((. + 0.5) * (2 | sqrt) * (1 - 1e-9))), radius: 1 }] }' >"$tmp/fcc.json"
while read -r name phi z; do
    nsd-gen "$tmp/$name.json" | nsd-detect >"$tmp/$name.h5"
    ok "a $name lattice: fraction, contacts, fabric" truth lattice "$tmp/$name.h5" "$phi" "$z" 0
done <<'END'
square 0.7853981633974483 4
hexagonal 0.9068996821171089 6
cubic 0.5235987755982988 6
fcc 0.7404804896930609 12
END

pairs() { nsd-stat -m pairs --bins "$2" --distance "$3" "$tmp/$1.h5" 2>/dev/null | jq -c .pairs.pairs; }
is "pairs of a square lattice, two to a body in each shell, whatever is across the border" "$(pairs square 3 3.3)" '[0,200,200]'
is "of a hexagonal one, three" "$(pairs hexagonal 1 3)" '[300]'
is "of a cubic one, three to a body, then six" "$(pairs cubic 3 3.3)" '[0,375,750]'

# bricks in a row that closes through the border of a cell: each touches two others by faces, at two places each; a ball in the
# plane touches at one; two bodies that are each other's neighbours on both sides of a small cell are two neighbours
row() # BODIES
{
    jq -n --argjson n "$1" '{ dim: 2, dt: 1, overlap: true, gravity: [0, 0], shapes: { brick: { polygon: [[-1, -1], [1, -1], [1, 1], [-1, 1]] } },
        cell: { lengths: [2 * $n * (1 - 1e-9), 9] }, bodies: [range($n) | { x: [2 * . * (1 - 1e-9) + 1, 4.5], shape: "brick", radius: (2 | sqrt) }] }' |
        nsd-gen - | nsd-detect | nsd-stat -m coordination,fabric,contact_numbers 2>/dev/null
}
for n in 2 3 7; do
    is "$n bricks in a ring: places, and neighbours once" "$(row $n | jq -c '[.contacts, .coordination.z, .coordination.neighbours, .fabric.tensor[0][0]]')" "[$((2 * n)),4,2,1]"
done
is "of balls both are one" "$(nsd-stat -m coordination "$tmp/fcc.h5" 2>/dev/null | jq -c '.coordination | [.z, .neighbours]')" '[12,12]'

# ---- forces ----

jq -n '{ dt: 1e-5, walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }],
    bodies: [range(10) | { x: [0, 0, 0.01 * (2 * . + 1)], radius: 0.01 }] }' | nsd-gen - |
    step -n 50 --contacts --tolerance 1e-12 --max-sweeps 100000 >"$tmp/column.h5"
ok "a column at rest: the floor's load, and the stress" truth column "$tmp/column.h5"
nsd-gen 200 | step -n 500 --every 100 --contacts --tolerance 1e-8 --max-sweeps 20000 -o "$tmp/heap.h5"
ok "numpy finds the same in a heap: stress, forces, fabric, energies, distributions" truth same_as_numpy "$tmp/heap.h5"
ok "energies, and what a step dissipates, are what its report says" truth balances "$tmp/heap.h5"
jq '.walls[0].drives = [{ along: [0, 0, 1], amplitude: 5e-4, frequency: 20 }] | .bodies[0].count = 100' scenes/shaken.json |
    nsd-gen - | step --solver auto -n 600 --every 100 --contacts -o "$tmp/shaken.h5"
ok "also where boundaries move" truth balances "$tmp/shaken.h5"
step --solver auto -n 60 --every 30 --contacts -o "$tmp/shear.h5" <(jq '.bodies[0].count = 144 | .bodies[0].radius.uniform = [0.02, 0.04] | .dt = 2e-3' scenes/shear.json | nsd-gen -)
ok "and where a cell's edges do" truth balances "$tmp/shear.h5"
# belts, drives, rolling and pivoting friction, grains of all shapes, walls that a load moves or a room; a cell whose rates change
jq -n '{ dt: 1e-3, mu: 0.3, rolling: { mu_r: 2e-4, mu_p: 3e-4 }, seed: 3, shapes: { block: { box: [2, 1, 1] } },
    walls: [{ point: [0, 0, 0], normal: [0, 0, 1], belt: [0.4, 0, 0], drives: [{ about: [0, 0, 0], axis: [0, 0, 1], speed: 3 }] },
        { cylinder: { point: [0, 0, 0], axis: [0, 0, 1], radius: 0.05, length: 0.3 }, drives: [{ about: [0, 0, 0], axis: [0, 0, 1], speed: -2 }] }],
    bodies: [{ count: 20, radius: 0.005, box: { x: [-0.03, 0.03], y: [-0.03, 0.03], z: [0.001, 0.02] } },
        { count: 10, radius: 0.006, shape: "block", orientation: "random", box: { x: [-0.03, 0.03], y: [-0.03, 0.03], z: [0.02, 0.05] } }] }' >"$tmp/works.json"
nsd-gen "$tmp/works.json" | step -n 120 --every 20 --contacts --overlap-rule keep --tolerance 1e-8 -o "$tmp/works.h5"
ok "belts, drives, moments of rolling and pivoting, balls and blocks: the energies of the report" truth balances "$tmp/works.h5" walls
nsd-gen <(jq 'del(.bodies[1])' "$tmp/works.json") | step -n 120 --every 20 --contacts --tolerance 1e-8 -o "$tmp/works.h5"
ok "and of balls that are moved apart" truth balances "$tmp/works.h5" walls
step -n 120 --wall-loads --tolerance 1e-8 -o "$tmp/works.h5" <(nsd-gen "$tmp/works.json")
opposite() { jq -ne --argjson a "$1" --argjson b "$2" '(($a + $b) | fabs) < 1e-9 * ($b | fabs) and $b != 0'; }
ok "the sums of the walls have the work of all steps" opposite \
    "$(nsd-stat --last -m sums "$tmp/works.h5" 2>/dev/null | jq '.sums | (.power | add) * .span[0]')" \
    "$(nsd-info "$tmp/works.h5" 2>/dev/null | jq -s 'map(.balance.drives // 0) | add')"
jq -n '{ dim: 2, dt: 1e-3, gravity: [0, 0], mu: 0.3, cell: { lengths: [1, 1], stress: { pressure: 1000, mass: 20 } },
    bodies: [{ count: 60, radius: { uniform: [0.03, 0.05] }, box: { x: [0, 1], y: [0, 1] } }] }' | nsd-gen - |
    step -n 150 --every 30 --contacts --overlap-rule keep --tolerance 1e-10 --max-sweeps 100000 -o "$tmp/servo.h5"
ok "and a cell that yields to a stress" truth balances "$tmp/servo.h5" edges
if [ -z "${NSD_THIN-}" ]; then
    nsd-gen 500 | step -n 3000 --every 3000 | nsd-cat --last | step -n 2 --contacts --tolerance 1e-7 --max-sweeps 20000 -o "$tmp/pile.h5"
    ok "fields: div stress = rho (g - a) in a settled pile" truth fields "$tmp/pile.h5" "$tmp/fields.h5"
fi

# the same of a small one, whatever the time: a file of fields of frames on one grid, and the sum over it
jq -n '{ dt: 1e-3, gravity: [0, 0, 0], bodies: [range(3) | { x: [0.5, 0.5, (0.4 + 0.1 * .)], radius: 0.03, v: [., 0, 1] }],
    walls: [{ box: { x: [0, 1], y: [0, 1], z: [0, 1] } }] }' | nsd-gen - | step -n 2 --contacts >"$tmp/few.h5"
nsd-stat --width 0.05 --spacing 0.04 -f "$tmp/few-fields.h5" "$tmp/few.h5" >/dev/null 2>&1
mass() # of the fields' last frame, over that of the bodies
{
    py -c 'import h5py, numpy as np, sys
f, p = h5py.File(sys.argv[1]), h5py.File(sys.argv[2])
d, cell = f["fields/density/value"], np.prod(f["fields/spacing"][:])
assert len(d) == 2 and list(f["fields/step"][:]) == [1, 2]
assert abs(d[-1].sum() * cell / p["particles/all/mass"][:].sum() - 1) < 1e-6
v = f["fields/momentum/value"][-1].sum(0) * cell / p["particles/all/mass"][:].sum()
assert np.abs(v - [1, 0, 1]).max() < 1e-6, v' "$@"
}
ok "fields have the mass and the momentum of the bodies" mass "$tmp/few-fields.h5" "$tmp/few.h5"
# a lattice that moves with a cell until this is oblique: at the border images count with their own velocities
jq -n '{ dim: 2, dt: 1e-3, gravity: [0, 0], density: 1, cell: { lengths: [10, 10], gradient: [[0, 2], [0, -0.5]] },
    bodies: [range(100) | { x: [(. % 10) + 0.5, (. / 10 | floor) + 0.5], radius: 0.3 }] }' | nsd-gen - |
    step -n 250 --every 250 --contacts -o "$tmp/lattice.h5"
ok "images move as their cell does, in fields and layers" truth images "$tmp/lattice.h5" "$tmp/lattice-fields.h5"
status 74 "fields in a folder that is not there" nsd-stat -f "$tmp/none/fields.h5" "$tmp/few.h5"
status 65 "fields without bodies" nsd-stat -f "$tmp/none.h5" <(nsd-gen - <<<'{"dt": 1}')
status 65 "fields on a grid of too many points" nsd-stat --spacing 1e-6 -f "$tmp/none.h5" "$tmp/few.h5"
ok "nothing is left of a file of fields that is refused" test ! -e "$tmp/none.h5"

# ---- motion, places ----

jq -n '{ dt: 1e-3, gravity: [0, 0, 0], seed: 5, bodies: [{ count: 300, radius: 1e-6, spacing: 1e5, thermal: 0.1,
    box: { x: [0, 1], y: [0, 1], z: [0, null] } }] }' | nsd-gen - >"$tmp/gas.h5"
step -n 50 --every 10 -o "$tmp/flight.h5" "$tmp/gas.h5"
ok "free flight: <v^2> t^2" truth flight "$tmp/flight.h5"
py -c '
import json, random
random.seed(6)
print(json.dumps({ "dt": 1, "gravity": [0, 0, 0], "bodies": [{ "x": [random.random() for _ in "xyz"], "radius": 1e-9 } for _ in range(4000)] }))' |
    nsd-gen - >"$tmp/points.h5"
ok "points at random are even" truth scattered "$tmp/points.h5"
for degrees in 10 25; do
    jq -n --argjson a "$degrees" '($a * 3.141592653589793 / 180) as $a | { dim: 2, dt: 1, overlap: true,
        bodies: [range(60) as $i | range(3) as $j | { x: [$i, ($a | sin) / ($a | cos) * $i - 1.2 * $j], radius: 0.5 }] }' |
        nsd-gen - >"$tmp/slope.h5"
    ok "a surface at $degrees degrees" truth slope "$tmp/slope.h5" $degrees
done
jq -n '(30 * 3.141592653589793 / 180 | sin / cos) as $t | { dt: 1, overlap: true, bodies: [range(-12; 13) as $i | range(-12; 13) as $j |
    ($i * $i + $j * $j | sqrt) as $d | select($d <= 12) | { x: [$i, $j, -$t * $d], radius: 0.5 }] }' | nsd-gen - >"$tmp/cone.h5"
ok "and a cone of 30 degrees" truth cone "$tmp/cone.h5" 30

# ---- ties ----

# bonded, wet and cohesive discs that a gravity of its own pulls apart from the floor that holds them
tied() { jq -n "$1"' + { dim: 2, dt: 1e-4, mu: 0.5, gravity: [2, 9.81], density: 1000, walls: [{ point: [0, 0], normal: [0, 1] }],
    bodies: [range(16) | { x: [0.002 * (. % 4), 0.001 + 0.00199999 * (. / 4 | floor)], radius: 0.001 }], overlap: true }' | nsd-gen - |
    step -n 60 --every 20 --contacts --tolerance 1e-10 --max-sweeps 100000 -o "$tmp/tied.h5" && truth tied "$tmp/tied.h5"; }
ok "bonds: pairs in tension count, and store" tied '{ adhesion: { c_n: 1e7, w: 10, forever: true, area: 1e-3, beta: 0.9 } }'
ok "liquid: the same" tied '{ capillary: { volume: 1e-11, tension: 0.072 } }'
ok "cohesion: the same" tied '{ cohesion: { force: 0.4, range: 1e-5 } }'
jq -n '{ dt: 0.1, gravity: [0, 0, 0], bodies: [range(10) | { x: [0.1 * ., 0, 0], radius: 0.01, v: [0.3, 0, 0] }] }' |
    nsd-gen - | step -n 10 >"$tmp/row.h5"
ok "three balls have crossed a plane" truth flow "$tmp/row.h5" 3
jq -n '{ dt: 1, bodies: [range(20) | { x: [3 * ., 0, (if . < 10 then 1 else 5 end)], radius: (if . < 10 then 0.5 else 1 end) }] }' |
    nsd-gen - >"$tmp/sorted.h5"
ok "large ones above small ones" truth sorted_by_size "$tmp/sorted.h5"

# ---- the solid fraction inside a bed: no more than that of a block when the box around is empty above ----

jq -n '{ dt: 1e-3, walls: [{ box: { x: [0, 20], y: [0, 20], z: [0, null] } }], overlap: true,
    bodies: [(range(10) as $i | range(10) as $j | range(8) as $k | { x: ([$i, $j, $k] | map(2 * . + 1)), radius: 1 }), { x: [10, 10, 60], radius: 1 }] }' |
    nsd-gen - | nsd-detect >"$tmp/block.h5"
ok "the fraction inside a block of 800 balls with one far above is pi/6" truth inside "$tmp/block.h5" 0 0.50 0.55
if [ -z "${NSD_THIN-}" ]; then
    ok "and inside a bed at rest that of random points" truth inside "$tmp/pile.h5" 0 0.55 0.66
fi
status 65 "a name that is not in a document is refused before contacts are missed" nsd-stat -m names --only NOSUCH <(nsd-gen 5)
like "with the names that are" "$(cat "$tmp/err")" "no 'NOSUCH' here, but"
is "--box is taken as it is" "$(nsd-stat -l -m fraction -b 0,20,0,20,0,16 "$tmp/block.h5" 2>/dev/null | jq '.fraction.fraction * 6 / 3.141592653589793 - 1 | fabs < 1e-9')" true

# ---- pipes and tables ----

ok "--tsv says what JSON says" truth table "$tmp/heap.h5"
nsd-stat "$tmp/heap.h5" >"$tmp/one" 2>/dev/null
nsd-cat --stream "$tmp/heap.h5" | nsd-stat 2>/dev/null >"$tmp/two"
ok "a stream and a trajectory give the same lines" cmp "$tmp/one" "$tmp/two"
is "a line for each frame, live" "$(nsd-gen 20 | step -n 7 | nsd-stat 2>/dev/null | wc -l)" 7
is "--last and --frames" "$(nsd-stat --last "$tmp/heap.h5" 2>/dev/null | jq .step) $(nsd-stat -s 200:400:200 "$tmp/heap.h5" 2>/dev/null | jq .step | tr '\n' ' ')" \
    "500 200 400 "
for j in 1 2 4; do
    nsd-gen 200 | step -j $j -n 20 --contacts | nsd-stat -m all 2>/dev/null >"$tmp/j$j"
done
ok "runs of 1, 2 and 4 threads measure the same" cmp "$tmp/j1" "$tmp/j2"
ok "all of them" cmp "$tmp/j1" "$tmp/j4"
nsd-stat --last --grains "$tmp/heap.h5" >"$tmp/grains.tsv"
nsd-view --size 100x100 --values "$tmp/grains.tsv" --column p -c value "$tmp/heap.h5" >"$tmp/p.png" 2>/dev/null
ok "--grains is a table that nsd-view colours by" test -s "$tmp/p.png" -a "$(wc -l <"$tmp/grains.tsv")" = 201
nsd-web --stat "$tmp/one" "$tmp/heap.h5" >"$tmp/page.html"
ok "nsd-web takes the lines for its curves" grep -q 'z_mechanical' "$tmp/page.html"
nsd-stat --last -f "$tmp/f%05d.vti" "$tmp/heap.h5" >/dev/null 2>&1
ok "fields for ParaView" grep -q '<ImageData' "$tmp/f00000.vti"

# ---- nothing to measure: null with a reason, never NaN ----

none() # NAME SCENE
{
    nsd-gen - <<<"$2" >"$tmp/none.h5"
    nsd-stat -m all "$tmp/none.h5" >"$tmp/none.json" 2>/dev/null
    is "$1: one object, of numbers and null" "$(jq -s 'length == 1 and (.[0] | has("why"))' "$tmp/none.json")" true
    is "$1: no NaN" "$(grep -ci 'nan\|inf[^l]' "$tmp/none.json" || true)" 0
}
none "no bodies" '{"dt": 1}'
none "one ball without contacts" '{"dt": 1, "bodies": [{"x": [0, 0, 0], "radius": 1}]}'
none "no gravity" '{"dt": 1, "gravity": [0, 0, 0], "bodies": [{"x": [0, 0, 0], "radius": 1}, {"x": [3, 0, 0], "radius": 1}]}'
none "a cell that repeats" '{"dt": 1, "dim": 2, "gravity": [0, 0], "cell": {"lengths": [4, 4]}, "bodies": [{"x": [0, 0], "radius": 1}]}'
none "a body in a wall of no volume" '{"dt": 1, "walls": [{"box": {"x": [-1, 1], "y": [-1, 1], "z": [-1, 1]}}], "bodies": [{"x": [0, 0, 0], "radius": 1, "fixed": true}]}'
like "a reason in words" "$(nsd-stat -m stress "$tmp/gas.h5" 2>/dev/null | jq -r .why.stress)" 'no contacts: .*nsd-step --contacts'
nsd-stat -m all -b 5,6,5,6,5,6 "$tmp/heap.h5" >"$tmp/empty.json" 2>/dev/null
is "a box with nothing in it: no NaN" "$(grep -ci nan "$tmp/empty.json" || true)" 0
# a box of a cell that repeats has the images that lie in it: four quarters of a disc at a corner
jq -n '{ dim: 2, dt: 1, overlap: true, gravity: [0, 0], cell: { edges: [[4, 0], [1, 4]] }, bodies: [{ x: [0, 0], radius: 1 }, { x: [2, 2], radius: 0.5 }] }' | nsd-gen - >"$tmp/corner.h5"
is "a box around a corner of a cell: the disc there" "$(nsd-stat -m fraction -b -1,1,-1,1 "$tmp/corner.h5" 2>/dev/null | jq '.fraction.fraction * 4 / 3.141592653589793 - 1 | fabs < 1e-6')" true
is "and one around its image" "$(nsd-stat -m fraction -b 4,6,3,5 "$tmp/corner.h5" 2>/dev/null | jq '.fraction.fraction * 4 / 3.141592653589793 - 1 | fabs < 1e-6')" true
is "the whole cell has both" "$(nsd-stat -m fraction "$tmp/corner.h5" 2>/dev/null | jq '.fraction.fraction * 16 / 3.141592653589793 / 1.25 - 1 | fabs < 1e-9')" true
why() { nsd-stat -m "$1" "${@:3}" "$2" 2>/dev/null | tail -n 1 | jq -r ".why.$1"; }
like "layers along an axis that two edges lean along" "$(why profile "$tmp/corner.h5" --layers x:3)" 'several edges of the cell lean'
like "pairs in a box of a periodic cell" "$(why pairs "$tmp/corner.h5" -b -1,1,-1,1)" 'fewer than two bodies|a box in a periodic cell'
like "pairs beyond two edges" "$(why pairs "$tmp/corner.h5" --distance 99)" "distances beyond two of the cell's edges"
like "pairs beyond the bodies" "$(why pairs "$tmp/points.h5" --distance 0.9)" 'null|distances beyond the smallest side'
like "pairs on a line" "$(why pairs "$tmp/row.h5" --distance 0.1)" 'no extent along an axis'
is "shells around an axis" "$(nsd-stat --last -m profile --layers r:4 --point 0.5,0.5,0 "$tmp/points.h5" 2>/dev/null | jq '.profile | [.[] | arrays | length] | unique | .[-1] >= 4')" true
is "flux through a disc" "$(nsd-stat -m flux --plane 1,0,0 --point 0.5,0.5,0.5 --radius 0.1 "$tmp/flight.h5" 2>/dev/null | tail -n 1 | jq '.flux | type')" '"object"'
is "--list names every measure once" "$(nsd-stat --list | grep -c '^[a-z_]*: ')" "$(nsd-stat --list | sed -n 's/^\([a-z_]*\): .*/\1/p' | sort -u | wc -l)"
ok "a table of one row of each measure that has one" test "$(nsd-stat --last --tsv -m fraction,energy,stress "$tmp/heap.h5" 2>/dev/null | awk '{ print NF }' | uniq | wc -l)" = 1
refuses 64 "a box that is empty" nsd-stat -b 1,0,0,1 "$tmp/corner.h5"
refuses 64 "a box of five numbers" nsd-stat -b 0,1,0,1,0 "$tmp/corner.h5"
refuses 64 "a plane of no direction" nsd-stat --plane 0,0,0 "$tmp/heap.h5"
refuses 64 "--grains and --measures" nsd-stat --grains -m stress "$tmp/heap.h5"
refuses 64 "--last and --frames" nsd-stat --last -s 1:2 "$tmp/heap.h5"
refuses 65 "a step that is not there" nsd-stat -s 99999 "$tmp/heap.h5"
refuses 64 "no such measure" nsd-stat -m heat "$tmp/heap.h5"
refuses 64 "a box of three numbers" nsd-stat -b 0,1,2 "$tmp/heap.h5"
refuses 64 "layers of nothing" nsd-stat --layers z:0 "$tmp/heap.h5"
refuses 64 "two measures of many rows in one table" nsd-stat --tsv -m profile,pairs "$tmp/heap.h5"
refuses 64 "fields in a text" nsd-stat -f fields.txt "$tmp/heap.h5"
refuses 66 "a file that is not there" nsd-stat "$tmp/nothing.h5"

# former names of measures, as scripts of others have them
nsd-gen 20 | nsd-step --solver auto --wall-loads --contacts -n 200 --every 100 >"$tmp/walls.h5" 2>"$tmp/err"
for pair in boundaries=walls sums=wall_loads sums_by_face=wall_loads_by_face; do
    is "-m ${pair%=*} is -m ${pair#*=}, with its former names" \
        "$(nsd-stat -m "${pair%=*}" "$tmp/walls.h5" 2>"$tmp/err" | jq -c ".${pair%=*} | if .boundary then .wall = .boundary | del(.boundary) else . end |
            if .rub then .sliding_work = .rub | del(.rub) else . end" | jq -S -c .)" \
        "$(nsd-stat -m "${pair#*=}" "$tmp/walls.h5" 2>"$tmp/err" | jq -S -c ".${pair#*=}")"
done
is "and only these" "$(nsd-stat --last -m boundaries,sums "$tmp/walls.h5" 2>"$tmp/err" | jq -c '[.boundaries, .sums | has("wall", "boundary", "sliding_work", "rub")]')" \
    '[false,true,false,false,false,true,false,true]'
is "an unknown measure is answered with a name of today" "$(nsd-stat -m boundarie "$tmp/walls.h5" 2>&1 | head -n 1)" \
    "nsd-stat: --measures: no 'boundarie' (nsd-stat --list names them)"

done_testing
