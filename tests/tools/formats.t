#!/usr/bin/env bash
# Formats that other programs open, each by a reader that is not ours: HOOMD's GSD by python3-gsd; /VTKHDF by h5py,
# against VTK's specification and as its reader goes about it, and by VTK itself as far as Debian's, 9.1, knows it.
# shellcheck source=tests/support/tap.sh disable=SC2317,SC2016 # functions called by name; jq's variables
. tests/support/tap.sh

has() { /usr/bin/python3 -c "import $1" 2>/dev/null; }
other() # "what is true" MODULE ...: as tests/support/formats.py has it, where Python has the module
{
    local name=$1 module=$2
    shift 2
    if has "$module"; then ok "$name" /usr/bin/python3 tests/support/formats.py "$@"; else skip "$name" "no $module"; fi
}

nsd-gen 60 | nsd-step -n 20 --every 5 >"$tmp/balls.h5" 2>/dev/null
jq '.bodies = [{x: [0, 0, 0], radius: 0.1}, {x: [1, 0, 0.1], shape: "stone", orientation: [1, 2, 3], v: [1, 2, 3], w: [3, 4, 5]},
    {x: [3, 0, 0], shape: "cube", size: 0.3, orientation: [0.2, 0, 0.1], w: [1, 0, 2]}, {x: [3, 2, 0], shape: "cube", size: 0.4},
    {x: [0, 3, 0], shape: "pair", size: 0.5, w: [7, 1, 0]}, {x: [2, 3, 0], shape: "rod", size: 0.5, orientation: [0, 1, 0]}] | .walls = [] |
    .shapes.pair = {balls: [[0, 0, 0, 1], [0.8, 0, 0, 0.7]]} | .shapes.rod = {capsule: {length: 1, radius: 0.3}}' scenes/rubble.json |
    nsd-gen - >"$tmp/shaped.h5"
nsd-gen scenes/shear.json | nsd-step -n 2300 --every 1150 >"$tmp/sheared.h5" 2>/dev/null

# ---- GSD ----

for name in balls shaped sheared; do
    nsd-export -o "$tmp/$name.gsd" "$tmp/$name.h5"
    other "python3-gsd reads $name: position, velocity, orientation, angular momentum, image" gsd.hoomd gsd "$tmp/$name.h5" "$tmp/$name.gsd"
done
other "and the shapes of grains" gsd.hoomd gsd_shapes "$tmp/shaped.h5" "$tmp/shaped.gsd"
ok "standard output that is a file is as good" sh -c "nsd-export --to gsd '$tmp/balls.h5' > '$tmp/out.gsd' && cmp '$tmp/out.gsd' '$tmp/balls.gsd'"
pipe() { nsd-export --to gsd "$1" | cat; return "${PIPESTATUS[0]}"; }
refuses 64 "GSD has its index behind all frames: not into a pipe" pipe "$tmp/balls.h5"
jq '.cell.gradient = [[0, 0], [1, 0]]' scenes/shear.json | nsd-gen - | nsd-step -n 100 --every 100 >"$tmp/turned.h5" 2>/dev/null
refuses 65 "a cell whose first edge has left x is no box of GSD" nsd-export --last -o "$tmp/none.gsd" "$tmp/turned.h5"

# ---- /VTKHDF in a document ----

nsd-cat --vtk grains "$tmp/balls.h5" >"$tmp/balls.v.h5"
other "/VTKHDF of balls is as VTK's specification has it, and its numbers the document's" h5py vtkhdf "$tmp/balls.v.h5"
other "nothing of it is stored twice" h5py not_stored_twice "$tmp/balls.v.h5"
nsd-cat --vtk grains --last "$tmp/balls.h5" >"$tmp/one.v.h5"
other "of one frame, too" h5py vtkhdf "$tmp/one.v.h5"
other "VTK 9.1 reads a copy that says it is an unstructured grid" vtk vtk_reads "$tmp/one.v.h5" "$tmp/grid.h5"
jq '.pour[0].from = 0.005' scenes/pour.json | nsd-gen - | nsd-step -n 400 --every 50 >"$tmp/pour.h5" 2>/dev/null
is "a run begins without a grain" "$(nsd-info "$tmp/pour.h5" | jq -s 'map(select(.step != null).bodies) | [.[0] == 0, last > 0]' -c)" "[true,true]"
nsd-cat --vtk grains "$tmp/pour.h5" >"$tmp/pour.v.h5"
other "grains that come and go have a part each frame" h5py vtkhdf "$tmp/pour.v.h5"
jq '.bodies = (.bodies[:2] | map(.count = 6))' scenes/rubble.json | nsd-gen - | nsd-step -n 8 --every 2 2>/dev/null >"$tmp/rubble.h5"
nsd-cat --vtk all "$tmp/rubble.h5" >"$tmp/rubble.v.h5"
density=$(jq '.density // 2500' scenes/rubble.json)
other "with surfaces it is a collection; they hold the grains' mass" h5py blocks "$tmp/rubble.v.h5" "$density"
nsd-cat "$tmp/balls.v.h5" >"$tmp/again.h5"
ok "a copy without it has the bytes of the first" cmp "$tmp/again.h5" "$tmp/balls.h5"
ok "through a pipe it is in each document" sh -c "nsd-cat --vtk grains --stream '$tmp/balls.h5' | nsd-cat --vtk grains > '$tmp/piped.h5'"
ok "and a trajectory of them has the same bytes" cmp "$tmp/piped.h5" "$tmp/balls.v.h5"
ok "a run goes on from it" sh -c "nsd-step -n 1 '$tmp/balls.v.h5' 2>/dev/null | nsd-info >'$tmp/info'"

# ---- ON-DEM's exchange format ----

jq '.walls = [{box: {x: [-1, 9], y: [-1, 9], z: [-2, null]}}]' <<<'{"dt": 1e-4, "mu": 0.4}' >"$tmp/walls"
jq --slurpfile w "$tmp/walls" '.walls = $w[0].walls | .bodies = [{x: [0, 0, 0], radius: 0.1}, {x: [1, 0, 0.1], shape: "stone", orientation: [1, 2, 3], v: [1, 2, 3], w: [3, 4, 5]},
    {x: [3, 0, 0], shape: "cube", size: 0.3, orientation: [0.2, 0, 0.1], w: [1, 0, 2]}, {x: [3, 2, 0], shape: "cube", size: 0.4, fixed: true},
    {x: [0, 3, 0], shape: "pair", size: 0.5, w: [7, 1, 0]}, {x: [2, 3, 0], shape: "rod", size: 0.5, orientation: [0, 1, 0]}] |
    .shapes.pair = {balls: [[0, 0, 0, 1], [0.8, 0, 0, 0.7]]} | .shapes.rod = {capsule: {length: 1, radius: 0.3}}' scenes/rubble.json | nsd-gen - >"$tmp/mixed.h5"
nsd-gen 60 | nsd-step -n 400 --every 400 --contacts >"$tmp/heap.h5" 2>/dev/null
facts() { nsd-info -p "$1" | jq -cS 'del(.step)'; }
for name in heap mixed; do
    nsd-export --last -o "$tmp/$name.vtkhdf" "$tmp/$name.h5"
    other "$name: every column is as ON-DEM's description has it" h5py ondem "$tmp/$name.h5" "$tmp/$name.vtkhdf"
    nsd-gen --from "$tmp/$name.vtkhdf" >"$tmp/$name.back.h5"
    is "$name: the round trip keeps every bit of every body" "$(facts "$tmp/$name.back.h5")" "$(nsd-cat --last "$tmp/$name.h5" | facts -)"
    is "$name: and dt, gravity, friction, walls" "$(nsd-info --last "$tmp/$name.back.h5" >/dev/null; h5dump -A "$tmp/$name.back.h5" 2>/dev/null | grep -A9 'ATTRIBUTE "dt"' | head -n 9)" \
        "$(h5dump -A "$tmp/$name.h5" 2>/dev/null | grep -A9 'ATTRIBUTE "dt"' | head -n 9)"
done
ok "inertia and shapes, too" h5diff "$tmp/mixed.h5" "$tmp/mixed.back.h5" /particles
ok "and the table of shapes" h5diff "$tmp/mixed.h5" "$tmp/mixed.back.h5" /nsd/shape
if has h5py; then
    /usr/bin/python3 tests/support/formats.py ondem_foreign "$tmp/foreign.vtkhdf"
    is "a file of another program: spheres, a box, walls, its kinds" "$(nsd-gen --from "$tmp/foreign.vtkhdf" | nsd-info -p | jq -c '[.id, .kind, .shape, .mass, .v[0]]')" \
        '[2,"rock9","ball",2,1]
[3,"rock4","box 1",2,1]
[5,"rock4","ball",2,1]'
    is "friction is the lesser of two materials', as Yade has it" "$(nsd-gen --from "$tmp/foreign.vtkhdf" >"$tmp/foreign.h5"; nsd-info --scene "$tmp/foreign.h5" | jq -c '[.pairs[].mu]')" "[0.3,0.3,0.5]"
    ok "a run goes on from it" sh -c "nsd-gen --from '$tmp/foreign.vtkhdf' | nsd-step -n 3 >'$tmp/none' 2>&1"
    spoil() { cp "$tmp/foreign.vtkhdf" "$tmp/bad.vtkhdf" && /usr/bin/python3 -c "import h5py; f = h5py.File('$tmp/bad.vtkhdf', 'r+'); $1"; }
    refuses_after() { spoil "$2" && refuses 65 "$1" nsd-gen --from "$tmp/bad.vtkhdf"; }
    refuses_after "a block without body_id" "del f['VTKHDF/Points/PointData/body_id']"
    refuses_after "a sphere without a radius" "f['VTKHDF/Points/PointData/radius'][0] = float('nan')"
    refuses_after "a partly blocked body" "f['VTKHDF/Points/PointData/blocked_dofs'][0] = 5"
    refuses_after "a material that is not there" "f['VTKHDF/Others/PointData/material_id'][0] = 77"
    refuses_after "a shape that is not described" "f['VTKHDF/Others/PointData/shape_type'][0] = 0"
    refuses_after "a shape_type out of the list" "f['VTKHDF/Others/PointData/shape_type'][0] = 44"
    refuses_after "a column of another length" "del f['VTKHDF/Points/PointData/mass']; f['VTKHDF/Points/PointData/mass'] = [1.0]"
    refuses_after "no names of shapes" "del f['ONDEM/Scene/shape_names']"
    refuses_after "two bodies of one id" "f['VTKHDF/Points/PointData/body_id'][0] = 2"
    refuses_after "no group /ONDEM" "del f['ONDEM']"
    refuses_after "a place that is infinite" "f['VTKHDF/Points/Points'][0] = float('inf')"
fi
done_testing
