#!/usr/bin/env bash
# The cell that repeats, through the tools: scenes and their faults, the pipeline, threads, resuming,
# documents, pictures.
. tests/support/tap.sh

# A dense cell under shear, small enough for many runs: of the scene, with what jq makes of it
scene() { jq "${1-.}" scenes/shear.json >"$tmp/scene.json"; }

scene '.bodies[0].count = 144 | .bodies[0].radius.uniform = [0.02, 0.04] | .dt = 2e-3'
nsd-gen "$tmp/scene.json" >"$tmp/start.h5"
nsd-step -n 900 --every 900 "$tmp/start.h5" 2>/dev/null | nsd-cat --last >"$tmp/dense.h5"
like 'a dense cell under shear has contacts' "$(nsd-detect "$tmp/dense.h5" | nsd-info --last | jq .contacts)" '^[0-9]{2,3}$'

# ---- the pipeline, threads, resuming ----

cp "$tmp/dense.h5" "$tmp/pipe.h5"
for _ in 1 2 3; do
    nsd-detect "$tmp/pipe.h5" | nsd-solve 2>/dev/null | nsd-move >"$tmp/next.h5"
    mv "$tmp/next.h5" "$tmp/pipe.h5"
done
nsd-step --solver auto -n 3 "$tmp/dense.h5" 2>/dev/null | nsd-cat --last >"$tmp/three.h5"
ok 'detect | solve | move is nsd-step, edges and images too' same_particles "$tmp/pipe.h5" "$tmp/three.h5"

for j in 2 4; do
    nsd-step -j "$j" -n 200 --every 50 "$tmp/dense.h5" >"$tmp/j$j.h5" 2>/dev/null
done
nsd-step -j 1 -n 200 --every 50 "$tmp/dense.h5" >"$tmp/j1.h5" 2>/dev/null
ok '1 and 2 threads give the same bytes' cmp "$tmp/j1.h5" "$tmp/j2.h5"
ok '1 and 4 threads give the same bytes' cmp "$tmp/j1.h5" "$tmp/j4.h5"

nsd-step -n 300 --every 300 "$tmp/dense.h5" 2>/dev/null | nsd-cat --last >"$tmp/whole.h5"
nsd-step -n 170 --every 10 "$tmp/dense.h5" >"$tmp/half.h5" 2>/dev/null
nsd-step -n 130 --every 130 "$tmp/half.h5" 2>/dev/null | nsd-cat --last >"$tmp/rest.h5"
ok 'a run that goes on from its file is the run, to the bit' same_particles "$tmp/whole.h5" "$tmp/rest.h5"

nsd-step --contacts -n 20 "$tmp/dense.h5" >"$tmp/kept.h5" 2>/dev/null
nsd-err "$tmp/kept.h5" >"$tmp/err"
worst=$(nsd-err "$tmp/kept.h5" | jq -s 'map(.natural) | max')
like "nsd-err judges kept steps as the solver did ($worst)" "$(jq -n "$worst < 1.01e-4")" true
like 'shifts tell contacts across the border' \
    "$(nsd-info -c "$tmp/kept.h5" | jq -s 'map(select(.shift != [0, 0, 0])) | length')" '^[0-9]{2,}$'
is 'the stress of a shear is symmetric to 5 % on the average of 200 steps, and pushes' \
    "$(nsd-step --overlap-rule keep --contacts -n 200 --every 2 "$tmp/dense.h5" 2>/dev/null | nsd-info | jq -s 'map(select(.stress).stress) | [range(2) as $i | [range(2) as $k | map(.[$i][$k]) | add]] | (.[0][1] - .[1][0] | fabs) < 0.05 * .[0][0] and .[1][1] > 0')" true
nsd-cat --stream "$tmp/kept.h5" | nsd-cat -o "$tmp/again.h5"
ok 'a stream joined again is the trajectory' same_particles "$tmp/kept.h5" "$tmp/again.h5"
is 'and its contacts' "$(nsd-info -c "$tmp/kept.h5" | cksum)" "$(nsd-info -c "$tmp/again.h5" | cksum)"

# The height yields to a pressure, the width does not: however flat the cell and oblique its height, its width stays
# along x, for cut by the height it would move as nothing that was asked for.
printf '{"dim": 2, "dt": 0.01, "gravity": [0, 0], "density": 1, "mu": 0.4, "cell": {"lengths": [12, 6], "affine": true,
    "gradient": [[0, 1], [0, 0]], "stress": {"target": [[null, null], [null, 1]], "mass": 10}},
    "bodies": [{"count": 36, "radius": 0.45, "spacing": 1}]}' | nsd-gen - | nsd-step -n 400 2>/dev/null >"$tmp/flat.h5"
is 'a cell is cut only into edges that move as its own' \
    "$(nsd-info --last "$tmp/flat.h5" | jq -c '.edges[0], (.edges[1][1] < 6)' | paste -sd' ')" '[12,0,0] true'

# The contact problem as FCLIB has it: q holds the edges' rates, so that W r + q is what was solved.
nsd-detect --fclib=local "$tmp/dense.h5" >"$tmp/both.h5"
foreign "$tmp/both.h5" "$tmp/both.raw"
if have_h5py; then
    py - "$tmp/both.raw" "$tmp/problem.h5" <<'PY'
import sys, h5py
with h5py.File(sys.argv[1]) as f, h5py.File(sys.argv[2], "w") as g:
    f.copy("fclib_local", g)
PY
    nsd-solve --tolerance 1e-10 "$tmp/problem.h5" 2>/dev/null | nsd-info --last | jq .natural >"$tmp/a"
    like 'the FCLIB problem of a cell is solved' "$(jq '. < 1e-9' "$tmp/a")" true
fi

# ---- a cell becomes one of another scene ----

# Compressed under a stress, then sheared: what goes on are edges, rates and bodies.
jq '.bodies[0].count = 60 | .cell.lengths = [0.4, 0.4] | .cell.stress = {pressure: 50, mass: 10} | del(.cell.gradient) |
    .cell.affine = false' scenes/shear.json | nsd-gen - | nsd-step -n 200 --every 200 -o "$tmp/pressed.h5" 2>/dev/null
edges() { nsd-info --last "$1" | jq -c '[.edges, .rates]'; }
nsd-info --scene "$tmp/pressed.h5" >"$tmp/again.json"
nsd-gen "$tmp/again.json" >"$tmp/again.h5"
is "nsd-info --scene goes on from the edges as they are, and their rates" "$(edges "$tmp/again.h5")" "$(edges "$tmp/pressed.h5")"
bodies() { nsd-info --last -p "$1" | jq -c 'del(.image, .step)'; }
ok "and bodies" cmp <(bodies "$tmp/again.h5") <(bodies "$tmp/pressed.h5")
jq 'del(.cell)' "$tmp/again.json" | nsd-gen - >"$tmp/same.h5"
is "a scene without a cell takes the document's" "$(edges "$tmp/same.h5")" "$(edges "$tmp/pressed.h5")"
is "none where it is null" "$(jq '.cell = null' "$tmp/again.json" | nsd-gen - | nsd-info | jq -s 'map(.edges // empty)')" '[]'
jq '.cell = {gradient: [[0, 2], [0, 0]]}' "$tmp/again.json" | nsd-gen - >"$tmp/sheared.h5"
like "or another motion of the same edges" \
    "$(nsd-info --last "$tmp/sheared.h5" | jq '.rates[1][0] / .edges[1][1]')" '^(2|1\.99999999+\d*|2\.0000000+\d*)$'
jq '.bodies = [] ' "$tmp/again.json" >"$tmp/none.json"
refuses 65 "edges are needed where no document is" nsd-gen "$tmp/none.json"
jq '.bodies[0].document = "'"$tmp/free.h5"'"' "$tmp/again.json" >"$tmp/none.json"
nsd-gen 3 | nsd-cat -o "$tmp/free.h5"
jq '.dim = 3 | .gravity = [0, 0, 0] | .cell = {}' "$tmp/none.json" >"$tmp/free.json"
refuses 65 "and where it has no cell" nsd-gen "$tmp/free.json"
like "which is said" "$(cat "$tmp/err")" 'cell: has no edges, and nor has the first document'

# ---- what a scene may not say ----

# fault 'jq program' 'line and path, and the trouble': a scene as one line
fault()
{
    jq -c ".bodies = [] | $1" scenes/shear.json >"$tmp/bad.json"
    refuses 65 "refused: $1" nsd-gen "$tmp/bad.json"
    like "  $2" "$(cat "$tmp/err")" ":1:[0-9]+: $2"
}

fault '.cell.edges = [[1, 0], [0, 1]]' 'cell: needs one of the keys edges lengths'
fault 'del(.cell.lengths)' 'cell: needs one of'
fault '.cell.lengths = [1, 0]' 'cell.lengths\[1\]: must be positive'
fault '.cell = { edges: [[1, 2], [2, 4]] }' 'cell: the cell: its edges have no volume'
fault '.cell = { edges: [[1, 2]] }' 'cell.edges: needs an array of 2: vector'
fault '.cell.repeats = [true]' 'cell.repeats: needs an array of 2: true or false'
fault '.cell.repeats = [false, false]' 'cell.repeats: no edge is periodic'
fault '.cell.gradient = [[0, 1]]' 'cell.gradient: needs an array of 2: vector'
fault '.cell.gradient = [[0, 1], [0, "x"]]' 'cell.gradient\[1\]\[1\]: '
fault '.cell.gradient[2].t = 0.5' 'cell.gradient\[2\].t: must be later than the one before'
fault '.cell.stress = { mean: 1, mass: 0 }' 'cell.stress.mass: must be positive'
fault '.cell.stress = { pressure: 1, mass: 0 }' 'cell.stress.mass: must be positive'
fault '.cell.stress = { target: [[1, 2], [3, 4]], mass: 1 }' 'cell.stress.target: a stress is symmetric'
fault '.cell.stress = { target: [[1, null], [null, 1]], mass: [[1, 0], [0, 0]] }' \
    'cell.stress.mass: component y of edge 1 is stress-controlled and needs a mass'
fault '.cell.repeats = [true, false] | .cell.stress = { target: [[null, null], [null, 1]], mass: 1 }' \
    'cell.stress.target: edge 1 is not periodic'
fault '.cell.affine = 1' 'cell.affine: '

jq -c '.bodies = [{ x: [0.5, 0.5], radius: 0.6 }]' scenes/shear.json >"$tmp/bad.json"
refuses 65 'a body wider than the cell is refused' nsd-gen "$tmp/bad.json"
jq -c '.walls = [{ point: [0, 0], normal: [0, 1] }] | .cell.repeats = [true, true]' scenes/shear.json >"$tmp/bad.json"
refuses 65 'a wall that the cell repeats across is refused' nsd-gen "$tmp/bad.json"
jq -c '.walls = [{ point: [0, 0], normal: [0, 1] }] | .cell.repeats = [true, false]' scenes/shear.json >"$tmp/bad.json"
refuses 65 'a wall along edges that move is refused' nsd-gen "$tmp/bad.json"
jq -c '.walls = [{ point: [0, 0], normal: [0, 1] }] | .cell.repeats = [true, false] | .cell.affine = false |
    .cell.gradient = [{ t: 5, L: [[0, 0], [0, 0]] }, { t: 6, L: [[1, 0], [0, 0]] }]' scenes/shear.json >"$tmp/bad.json"
refuses 65 'and along edges that will' nsd-gen "$tmp/bad.json"
jq -c 'del(.cell.gradient) | .walls = [{ point: [0, 0], normal: [0, 1] }] | .gravity = [1, -9] |
    .cell.repeats = [true, false]' scenes/shear.json >"$tmp/slope.json"
ok 'a slope that repeats downhill is a scene' nsd-gen "$tmp/slope.json"

# A ball crosses the periodic edge and meets a segment that stands in the cell, after 0.6 s: then it returns with half the speed.
post='{ "dim": 2, "dt": 1e-3, "gravity": [0, 0], "e_n": 0.5, "cell": { "lengths": [1, 1], "repeats": [true, false] },
    "walls": [{ "segment": [[0.5, 0], [0.5, 0.3]] }], "bodies": [{ "x": [0.8, 0.1], "radius": 0.1, "v": [1, 0] }] }'
echo "$post" >"$tmp/post.json"
returned() { nsd-gen "$1" | nsd-step -n 1000 --every 1000 --overlap-rule gap 2>/dev/null | nsd-info --last -p - | jq -e '.x[0] - (.x[0] | floor) - 0.2 | fabs < 1e-3'; }
ok 'a wall that stands in the cell is met from both sides, and across the edge' returned "$tmp/post.json"
jq -c '.walls[0].segment = [[0.19, 0], [0.19, 0.3]]' "$tmp/post.json" >"$tmp/bad.json"
refuses 65 'one that images of bodies would meet is refused' nsd-gen "$tmp/bad.json"
jq -c '.walls[0].drives = [{ along: [1, 0], speed: 1 }]' "$tmp/post.json" >"$tmp/bad.json"
refuses 65 'and one that moves across the edge' nsd-gen "$tmp/bad.json"
jq -c '.walls[0].segment = [[0.15, 0], [0.15, 0.3]] | .bodies[0].radius = 0.05 |
    .pour = [{ count: 5, rate: 1000, radius: 0.1, opening: { box: { x: [0.6, 0.9], y: [0.5, 0.9] } } }]' "$tmp/post.json" | nsd-gen - >"$tmp/poured.h5"
refuses 65 'and one that larger bodies would, which an inlet brings' nsd-step -n 5 -o "$tmp/out.h5" "$tmp/poured.h5"
nsd-gen "$tmp/post.json" >"$tmp/post.h5"
status 69 'also by a program in the loop' nsd-step --with "jq -c --unbuffered '{walls: {\"0\": {velocity: [1, 0]}}}'" -n 3 -o "$tmp/moved.h5" "$tmp/post.h5"
jq -c '.walls = [{ mesh: { file: "tri.obj" } }] | .dim = 3 | .gravity = [0, 0, 0] | .cell = { lengths: [1, 1, 1], repeats: [true, false, false] } |
    .bodies[0] += { x: [0.8, 0.1, 0.1], v: [1, 0, 0] }' "$tmp/post.json" >"$tmp/mesh.json"
printf 'v 0.5 -1 -1\nv 0.5 2 -1\nv 0.5 0 2\nf 1 2 3\n' >"$tmp/tri.obj"
ok 'and so is a mesh' returned "$tmp/mesh.json"

# ---- documents that lie ----

if have_h5py; then
    foreign "$tmp/dense.h5" "$tmp/plain.h5"
    lie() # name, python on f
    {
        cp "$tmp/plain.h5" "$tmp/lie.h5"
        py -c "
import h5py, numpy as np
with h5py.File('$tmp/lie.h5', 'r+') as f:
    box = f['particles/all/box']
    $2"
        refuses 65 "refused: $1" nsd-step "$tmp/lie.h5"
    }
    lie 'edges that are not finite' 'box["edges/value"][0, 1, 1] = np.nan'
    lie 'edges in a line' 'box["edges/value"][0, 1] = 2 * box["edges/value"][0, 0]'
    lie 'edges out of the plane' 'box["edges/value"][0, 0, 2] = 1'
    lie 'edges shorter than the bodies' 'box["edges/value"][0] *= 0.01'
    lie 'no edges' 'del box["edges"]'
    lie 'edges of another shape' 'del box["edges"]; box["edges"] = np.ones((2, 2))'
    lie 'a boundary of another kind' 'box.attrs["boundary"] = np.array([b"open", b"none", b"none"])'
    lie 'two boundaries' 'box.attrs["boundary"] = np.array([b"periodic", b"none"])'
    lie 'z periodic in the plane' 'box.attrs["boundary"] = np.array([b"periodic"] * 3)'
    lie 'rates that are not finite' 'box["rate/value"][0, 0, 0] = np.inf'
    lie 'an origin of another shape' 'del box["origin"]; box["origin"] = np.zeros(2)'
    lie 'an origin that is not finite' 'box["origin"][1] = np.nan'
    lie 'images out of range' 'f["particles/all/image/value"][0, 3, 0] = 2**31 - 1'
    lie 'images of another shape' \
        'del f["particles/all/image"]; f["particles/all/image/value"] = np.zeros((1, 3, 3), "i4")'
    lie 'moments that do not increase' 'f["nsd/cell/time"][2] = 0'
    lie 'a gradient of another length' 'del f["nsd/cell/gradient"]; f["nsd/cell/gradient"] = np.zeros((2, 3, 3))'
    lie 'a mass below 0' 'f["nsd/cell/mass"][0, 0] = -1'
    lie 'a stress that is not symmetric' 'f["nsd/cell/stress"][0, 1] = 1'
    lie 'half of the drive' 'del f["nsd/cell/stress"]'

    cp "$tmp/plain.h5" "$tmp/h5md.h5"
    py -c "
import h5py
with h5py.File('$tmp/h5md.h5', 'r+') as f:
    box = f['particles/all/box']
    e = box['edges/value'][0]
    del box['edges'], box['rate'], box['origin'], f['nsd/cell'], f['particles/all/image']
    box['edges'] = e"
    ok 'constant edges as H5MD has them are read' nsd-step -n 2 "$tmp/h5md.h5"
fi

# ---- the energy of the peculiar velocities ----

# One disc: v is constant, and w_x = 1 - G w_y t, whatever image it is
jq -nc '{ dt: 1e-2, dim: 2, gravity: [0, 0], cell: { lengths: [1, 1], gradient: [[0, 2], [0, 0]] },
    bodies: [{ x: [0.5, 0.5], v: [1, 0.7], radius: 0.01, mass: 2 }] }' | nsd-gen - >"$tmp/lone.h5"
nsd-step -n 500 -o "$tmp/crosses.h5" "$tmp/lone.h5" 2>/dev/null
balances() { nsd-info "$1" | jq -c 'select(.balance)'; }
is "a disc that crosses a sheared border: the peculiar energy is that of the closed form" \
    "$(balances "$tmp/crosses.h5" | jq -s 'map(.balance.peculiar - (0.49 + (1 - 1.4 * .time | . * .)) | fabs) | max < 1e-11')" true
is "the kinetic energy jumps" "$(balances "$tmp/crosses.h5" | jq -s '. as $b | any(range(1; length); $b[.].balance.kinetic - $b[. - 1].balance.kinetic | fabs > 3)')" true
is "nsd-stat has it" "$(nsd-stat -m energy "$tmp/crosses.h5" | jq -s 'map(.energy.peculiar)')" \
    "$(balances "$tmp/crosses.h5" | jq -s '[.[].balance.peculiar]')"
sums() # LOG: of the changes of the peculiar energy over the steps, less the change of the energy, in parts of it
{
    jq -n '[inputs.balance | select(.)] | (.[-1].peculiar - .[0].peculiar - (.[1:] | map(.peculiar_change) | add) | fabs) / .[-1].peculiar' "$1"
}
jq '.bodies[0].count = 100 | .cell.lengths = [0.5, 0.5] | .cell.gradient[2].t = 1.5' scenes/shear.json | nsd-gen - |
    nsd-step -n 1600 --every 1600 --log="$tmp/sheared.log" -o "$tmp/sheared.h5" 2>/dev/null
like "discs under compression and shear: its changes add up to it" "$(sums "$tmp/sheared.log" | jq '. < 1e-11')" true
is "nsd-move puts it into the report" "$(nsd-cat --last "$tmp/sheared.h5" | nsd-detect | nsd-solve 2>/dev/null | nsd-move | balances - | jq -c '.balance | [.peculiar, .peculiar_change]')" \
    "$(nsd-step --solver auto -n 1 "$tmp/sheared.h5" 2>/dev/null | balances - | jq -c '.balance | [.peculiar, .peculiar_change]')"
if have_ranks; then
    ranks 2 nsd-step -n 50 --order block --log="$tmp/ranks.log" -o "$tmp/ranks.h5" "$tmp/sheared.h5" 2>/dev/null
    like "two processes: so they do" "$(sums "$tmp/ranks.log" | jq '. < 1e-11')" true
else
    skip "two processes" "no MPI"
fi
is "a cell at rest has no such term" "$(jq -nc '{ dt: 1e-2, dim: 2, cell: { lengths: [1, 1] }, bodies: [{ x: [0.5, 0.5], radius: 0.01 }] }' | nsd-gen - |
    nsd-step -n 1 2>/dev/null | balances - | jq '.balance | has("peculiar")')" false

# ---- pictures ----

nsd-view --svg --bare -o "$tmp/shown.svg" "$tmp/dense.h5" 2>/dev/null
discs=$(grep -c '<path.*fill-rule' "$tmp/shown.svg")
ok "discs that the border cuts are drawn on both sides ($discs paths)" test "$discs" -gt $((2 * 144 + 40))
done_testing
