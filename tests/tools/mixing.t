#!/usr/bin/env bash
# Mixing and motion by nsd-stat: Lacey's index and its kin on lattices whose answers are closed and by brute force,
# diffusion of a random walk, residence times, lifetimes of contacts, fields of strain rate, temperature, inertial number.
# shellcheck source=tests/support/tap.sh disable=SC2154,SC2016 # tap.sh sets tmp; text for other programs
. tests/support/tap.sh

if ! has h5py; then echo "1..0 # SKIP no h5py"; exit; fi
truth() { py tests/support/mixing.py "$@"; }
step() { nsd-step "$@" 2>/dev/null; }

# ---- lattices: N a side, of kinds that an expression of jq gives ----

cubic() { jq -n "{ dt: 1, overlap: true, gravity: [0, 0, -1], materials: { sand: { density: 1 }, clay: { density: 1 } },
    cell: { lengths: [12, 12, 12] }, bodies: [range(6) as \$i | range(6) as \$j | range(6) as \$k |
        { x: ([\$i, \$j, \$k] | map(2 * . + 1)), radius: 0.9, material: ($1) }] }" | nsd-gen -; }
fcc() { jq -n "{ dt: 1, overlap: true, gravity: [0, 0, -1], materials: { sand: { density: 1 }, clay: { density: 1 } },
    cell: { lengths: [6, 6, 6] }, bodies: [range(6) as \$i | range(6) as \$j | range(6) as \$k | select((\$i + \$j + \$k) % 2 == 0) |
        { x: ([\$i, \$j, \$k] | map(. + 0.5)), radius: 0.6, material: ($1) }] }" | nsd-gen -; }

cubic 'if ($i + $j + $k) % 2 == 0 then "sand" else "clay" end' >"$tmp/checker.h5"
ok "a checkerboard: the same share in all samples of 8, unlike half of 12 neighbours" truth lattice "$tmp/checker.h5" 4 \
    bodies=216 tracers=108 samples=27 sample_bodies=8 variance=0 lacey=1.1428571428571428 intensity=0 neighbours=1 segregation=0
cubic 'if $k < 3 then "clay" else "sand" end' >"$tmp/apart.h5"
ok "two halves: 0, and the one above the other" truth lattice "$tmp/apart.h5" 6 lacey=0 intensity=1 segregation=-1.0141851056742201
ok "where samples cut the border they are half and half" truth lattice "$tmp/apart.h5" 4 intensity=0.6666666666666667
fcc 'if $k % 2 == 0 then "sand" else "clay" end' >"$tmp/layers.h5"
ok "layers of a dense lattice: 8 of 12 neighbours are unlike" truth lattice "$tmp/layers.h5" 2 neighbours=1.3333333333333333
fcc 'if $k < 3 then "sand" else "clay" end' >"$tmp/halves.h5"
ok "halves of one: 4 of 12 at the two borders" truth lattice "$tmp/halves.h5" 2 neighbours=0.4444444444444444
py -c '
import json, random
random.seed(6)
print(json.dumps({ "dt": 1, "materials": { "a": {}, "b": {} }, "gravity": [0, 0, -1],
    "bodies": [{ "x": [random.random() for _ in "xyz"], "radius": 0.01, "material": random.choice("ab") } for _ in range(4000)], "allow_overlap": True }))' |
    nsd-gen - >"$tmp/random.h5"
ok "at random: 1" truth at_random "$tmp/random.h5"
py -c '
import json, random
random.seed(7)
print(json.dumps({ "dim": 2, "dt": 1, "materials": { "a": {}, "b": {}, "c": {} }, "gravity": [0, -1], "allow_overlap": True,
    "cell": { "edges": [[10, 0], [3, 8]] },
    "bodies": [{ "x": [9 * random.random(), 7 * random.random()], "radius": random.choice([0.1, 0.2, 0.25]),
        "material": random.choice("aab") } for _ in range(300)] }))' | nsd-gen - >"$tmp/oblique.h5"
ok "discs in an oblique cell: as numpy counts" truth same_as_numpy "$tmp/oblique.h5" 1.3 a
ok "large ones among small ones" truth same_as_numpy "$tmp/oblique.h5" 2 large
jq -n '{ dt: 1e-4, density: 1000, seed: 2, materials: { a: { density: 1000 }, b: { density: 2000 } }, walls: [{ box: { x: [0, 0.1], y: [0, 0.1], z: [0, 0.3] } }], 
    bodies: [{ count: 150, material: "a", radius: { uniform: [0.004, 0.008] }, box: { x: [0, 0.1], y: [0, 0.1], z: [0, null] } }, { count: 150, material: "b", radius: 0.005, box: { x: [0, 0.1], y: [0, 0.1], z: [0.2, null] } }] }' |
    nsd-gen - | step -n 1000 --every 1000 >"$tmp/box.h5"
ok "balls in a box" truth same_as_numpy "$tmp/box.h5" 0.03 b
mixing() { nsd-stat -m mixing "$@" 2>/dev/null | jq -c "${what:-.why.mixing}"; }
refuses 65 "a tracer that is no kind" nsd-stat -m mixing --tracer gravel "$tmp/checker.h5"
like "names the kinds" "$(cat "$tmp/err")" "no material 'gravel' here, but large, ball, wall"
is "bodies of one size" "$(mixing --tracer large "$tmp/checker.h5")" '"all bodies are of one sort: --tracer MATERIAL, or large"'
is "samples of one body" "$(mixing --sample 2 "$tmp/checker.h5")" '"no sample holds two bodies: --sample is too small"'
is "too many samples" "$(mixing --sample 1e-9 "$tmp/checker.h5")" '"--sample makes more than 1e8 samples"'
is "the other kind has the same index" "$(what='.mixing | [.lacey, .variance, .neighbours]' mixing --tracer a "$tmp/random.h5")" \
    "$(what='.mixing | [.lacey, .variance, .neighbours]' mixing --tracer b "$tmp/random.h5")"
refuses 64 "a sample of nothing" nsd-stat --sample 0 "$tmp/checker.h5"
refuses 64 "a tracer without a name" nsd-stat -m mixing --tracer "" "$tmp/checker.h5"

# ---- walks ----

cat >"$tmp/walk.py" <<'E2'
import json, sys
import numpy as np
draw, n, v, m = np.random.default_rng(8), 1500, np.zeros((1500, 3)), float(sys.argv[1])
for line in sys.stdin:
    new = draw.normal(0, 0.3, (n, 3))
    print(json.dumps({"forces": ((new - v) * m / 0.01).round(15).tolist()}), flush=True)
    v = new
E2
jq -n '{ dt: 0.01, gravity: [0, 0, 0], overlap: true, density: 1000,
    bodies: [range(1500) | { x: [100 * (. % 10), 100 * ((. / 10 | floor) % 10), 100 * (. / 100 | floor)], radius: 0.1 }] }' | nsd-gen - >"$tmp/still.h5"
step -n 60 --every 60 --with "/usr/bin/python3 $tmp/walk.py $(nsd-info -p "$tmp/still.h5" | jq -s '.[0].mass')" -o "$tmp/walk.h5" "$tmp/still.h5"
ok "a random walk: 6 D t" truth walk "$tmp/still.h5" "$tmp/walk.h5" 60 0.3 0.01

# ---- residence ----

jq -n '{ dt: 0.1, gravity: [0, 0, 0], bodies: [range(-10; 10) | { x: [0.1 * ., 0, 0], radius: 0.01, v: [0.3, 0, 0] }] }' |
    nsd-gen - | step -n 40 >"$tmp/row.h5"
ok "bodies that pass a box of 0.6 m at 0.3 m/s" truth passing "$tmp/row.h5" 2
jq '.dt = 2e-4 | .pour[0].count = 60 | .pour[0].rate = 1000' scenes/pour.json | nsd-gen - | step -n 1000 --every 37 -o "$tmp/pour.h5"
ok "poured and removed ones: by the document's own times" truth removed "$tmp/pour.h5"

# ---- contacts ----

jq -n '{ dt: 1e-3, e_n: 0, gravity: [0, 0, -10], bodies: [{ x: [0, 0, 0.15], radius: 0.1 }],
    walls: [{ point: [0, 0, 0], normal: [0, 0, 1], until: 0.3 }] }' | nsd-gen - | step -n 500 --every 10 --contacts -o "$tmp/landing.h5"
ok "a ball that lands, and whose floor goes" truth landing "$tmp/landing.h5" 0.1 0.3
nsd-gen 100 | step -n 600 --every 40 --contacts -o "$tmp/heap.h5"
ok "a heap: the pairs that come and go" truth pairs_of_frames "$tmp/heap.h5"
like "without contacts there are no lifetimes" "$(nsd-stat --last -m lifetimes "$tmp/row.h5" 2>/dev/null | jq -r .why.lifetimes)" 'nsd-step --contacts keeps them'

# ---- fields ----

py -c '
import json, random
random.seed(9)
L = [[0.1, 2, 0], [0.3, -0.2, 0.5], [0, 1, 0.4]]
def body():
    x = [random.random() for _ in "xyz"]
    return { "x": x, "radius": random.choice([0.02, 0.05]), "v": [3 + sum(a * b for a, b in zip(row, x)) for row in L] }
print(json.dumps({ "dt": 1, "gravity": [0, 0, 0], "allow_overlap": True, "bodies": [body() for _ in range(800)] }))' | nsd-gen - >"$tmp/affine.h5"
ok "an affine flow of bodies at random: the exact gradient, no temperature" truth affine "$tmp/affine.h5" "$tmp/affine-fields.h5"
py -c '
import json, random
random.seed(10)
def body():
    x = [random.random() for _ in "xyz"]
    return { "x": x, "radius": 0.02, "v": [4 * x[1] + random.gauss(0, 0.5), random.gauss(0, 0.5), random.gauss(0, 0.5)] }
print(json.dumps({ "dt": 1, "gravity": [0, 0, 0], "allow_overlap": True, "bodies": [body() for _ in range(6000)] }))' | nsd-gen - >"$tmp/thermal.h5"
ok "velocities at random in a shear: their variance" truth thermal "$tmp/thermal.h5" "$tmp/thermal-fields.h5" 0.5
py -c '
import json, random
random.seed(11)
def body(i, j, k):
    x = [(a + 0.5) / 18 for a in (i, j, k)]
    return { "x": x, "radius": 0.02, "v": [2 * x[1] + random.gauss(0, 0.25), random.gauss(0, 0.25), random.gauss(0, 0.25)] }
print(json.dumps({ "dt": 1e-5, "gravity": [0, 0, 0],
    "bodies": [body(i, j, k) for i in range(18) for j in range(18) for k in range(18)] }))' | nsd-gen - | nsd-detect >"$tmp/gas.h5"
ok "a gas in plane shear: I = rate d / sqrt(phi T)" truth sheared_gas "$tmp/gas.h5" "$tmp/gas-fields.h5" 2 0.25
jq '.bodies[0].count = 200 | .cell.lengths = [16, 20] | .dt = 0.02' scenes/plane-shear.json | nsd-gen - |
    step -n 3000 --every 3000 | nsd-cat --last | step -n 1 --contacts -o "$tmp/shear.h5"
ok "plane shear under pressure: the inertial number is shear rate, diameter, density and pressure nearby" truth inertial "$tmp/shear.h5" "$tmp/shear-fields.h5"

done_testing
