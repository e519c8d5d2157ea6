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
done_testing
