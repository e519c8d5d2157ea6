#!/usr/bin/env bash
# Formats that other programs open, each by a reader that is not ours: HOOMD's GSD by python3-gsd; /VTKHDF by h5py,
# against VTK's specification and as its reader goes about it, and by VTK itself as far as Debian's, 9.1, knows it.
# shellcheck source=tests/support/tap.sh disable=SC2317,SC2016 # functions called by name; jq's variables
. tests/support/tap.sh

other() # "what is true" MODULE ...: as tests/support/formats.py has it, where Python has the module
{
    local name=$1 module=$2
    shift 2
    if has "$module"; then ok "$name" py tests/support/formats.py "$@"; else skip "$name" "no $module"; fi
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
for scene in drum silo cards pour; do # lines of the plane, grains that come, capsules or cards, an empty start
    nsd-gen "scenes/$scene.json" | nsd-step -n 60 --every 20 2>/dev/null | nsd-cat --vtk all >"$tmp/$scene.v.h5"
    other "$scene: each step of each block" h5py collection "$tmp/$scene.v.h5"
done
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
    .shapes.pair = {balls: [[0, 0, 0, 1], [0.8, 0, 0, 0.7]]} | .shapes.rod = {capsule: {length: 1, radius: 0.3}}' scenes/rubble.json >"$tmp/mixed.json"
nsd-gen "$tmp/mixed.json" >"$tmp/mixed.h5"
nsd-gen 60 | nsd-step -n 400 --every 400 --contacts >"$tmp/heap.h5" 2>/dev/null
facts() { nsd-info -p "$1" | jq -cS 'del(.step)'; }
export PYTHONPATH=$PWD/python NSD_LIBRARY=${NSD_LIBRARY-$PWD/build/libnsd.so.2}
ondem() { /usr/bin/python3 -m nsd.ondem "$@"; }
refuses 65 "nsd-gen reads no HDF5 file" nsd-gen --from "$tmp/heap.h5"
like "with the cure" "$(cat "$tmp/err")" 'python3 -m nsd.ondem read FILE'
refuses 64 "nor does nsd-export write ON-DEM's format" nsd-export -o "$tmp/heap.vtkhdf" "$tmp/heap.h5"
like "with the cure" "$(cat "$tmp/err")" 'python3 -m nsd.ondem write FILE -o .*heap.vtkhdf'
if has h5py; then
    for name in heap mixed; do
        ondem write "$tmp/$name.h5" -o "$tmp/$name.vtkhdf"
        other "$name: every column is as ON-DEM's description has it" h5py ondem "$tmp/$name.h5" "$tmp/$name.vtkhdf"
        ondem read "$tmp/$name.vtkhdf" >"$tmp/$name.back.h5"
        is "$name: the round trip keeps every bit of every body" "$(facts "$tmp/$name.back.h5")" "$(nsd-cat --last "$tmp/$name.h5" | facts -)"
        is "$name: and dt, gravity, friction, walls" "$(nsd-info --last "$tmp/$name.back.h5" >/dev/null; h5dump -A "$tmp/$name.back.h5" 2>/dev/null | grep -A9 'ATTRIBUTE "dt"' | head -n 9)" \
            "$(h5dump -A "$tmp/$name.h5" 2>/dev/null | grep -A9 'ATTRIBUTE "dt"' | head -n 9)"
    done
    ok "inertia and shapes, too" h5diff "$tmp/mixed.h5" "$tmp/mixed.back.h5" /particles
    ok "and the table of shapes" h5diff "$tmp/mixed.h5" "$tmp/mixed.back.h5" /nsd/shape
    py tests/support/formats.py ondem_foreign "$tmp/foreign.vtkhdf"
    is "a file of another program: spheres, a box, walls, its kinds" "$(ondem read "$tmp/foreign.vtkhdf" | nsd-info -p | jq -c '[.id, .material, .shape, .mass, .v[0]]')" \
        '[2,"rock9","ball",2,1]
[3,"rock4","box 1",2,1]
[5,"rock4","ball",2,1]'
    # our own file without what is nsd's: balls, boxes and clumps are the format's
    jq '.bodies = [.bodies[0, 2, 4]] | del(.shapes.stone, .shapes.rod)' "$tmp/mixed.json" | nsd-gen - >"$tmp/plain.h5"
    ondem write "$tmp/plain.h5" -o "$tmp/plain.vtkhdf"
    py -c "
import h5py
f = h5py.File('$tmp/plain.vtkhdf', 'r+')
del f['nsd']
for b in f['VTKHDF/Assembly'].values():
    for n in 'nsd_shape', 'nsd_radius', 'nsd_inertia', 'volume': del b['PointData/' + n]"
    ondem read "$tmp/plain.vtkhdf" >"$tmp/plain.back.h5"
    ok "a ball, a box and a clump without nsd's extension: motion, mass and inertia" sh -c "for d in position/value velocity/value angular_velocity/value orientation/value radius mass inertia id
        do h5diff -p 1e-13 '$tmp/plain.h5' '$tmp/plain.back.h5' /particles/all/\$d || exit 1; done"
    ok "and the volume of the clump" py -c "
import h5py
a, b = (h5py.File(f)['nsd/shape'] for f in ('$tmp/plain.h5', '$tmp/plain.back.h5'))
of = lambda g: max(v for v, form in zip(g['volume'], g['form']) if form == 1) # the pair
assert abs(of(a) - of(b)) < 1e-9 * of(a), (of(a), of(b))"
    is "the clump is made of its members" "$(h5dump -d /nsd/shape/form "$tmp/plain.back.h5" 2>/dev/null | grep -m 1 -o '(0): .*')" "(0): 3, 1"
    is "friction is the lesser of two materials', as Yade has it" "$(ondem read "$tmp/foreign.vtkhdf" >"$tmp/foreign.h5"; py -c "import h5py; print(*h5py.File('$tmp/foreign.h5')['nsd/material/mu'][()].ravel())")" "0.3 0.3 0.3 0.5"
    is "time step and gravity are the file's" "$(py -c "import h5py; a = h5py.File('$tmp/foreign.h5')['nsd'].attrs; print(a['dt'], *a['gravity'])")" "1e-05 0.0 1.0 -9.0"
    ok "a run goes on from it" sh -c "nsd-step -n 3 '$tmp/foreign.h5' >'$tmp/none' 2>&1"
    spoil() { cp "$tmp/foreign.vtkhdf" "$tmp/bad.vtkhdf" && py -c "import h5py; f = h5py.File('$tmp/bad.vtkhdf', 'r+'); $1"; }
    refuses_after() # WHAT CHANGE REASON
    {
        spoil "$2"
        status 65 "$1: status 65" ondem read "$tmp/bad.vtkhdf"
        like "$1: one line that says so" "$(cat "$tmp/err")" "^nsd.ondem: $tmp/bad.vtkhdf: .*$3.*$"
    }
    refuses_after "a block without body_id" "del f['VTKHDF/Points/PointData/body_id']" "body_id: no such column"
    refuses_after "a sphere without a radius" "f['VTKHDF/Points/PointData/radius'][0] = float('nan')" "body 5: a sphere without a radius"
    refuses_after "a partly blocked body" "f['VTKHDF/Points/PointData/blocked_dofs'][0] = 5" "body 5: blocked_dofs"
    refuses_after "a material that is not there" "f['VTKHDF/Others/PointData/material_id'][0] = 77" "body 3: material_id"
    refuses_after "a shape that is not described" "f['VTKHDF/Others/PointData/shape_type'][0] = 0" "body 3: a shape that the format does not describe"
    refuses_after "a shape_type out of the list" "f['VTKHDF/Others/PointData/shape_type'][0] = 44" "body 3: shape_type"
    refuses_after "a column of another length" "del f['VTKHDF/Points/PointData/mass']; f['VTKHDF/Points/PointData/mass'] = [1.0]" "mass: not a row for each body"
    refuses_after "no names of shapes" "del f['ONDEM/Scene/shape_names']" "shape_names"
    refuses_after "two bodies of one id" "f['VTKHDF/Points/PointData/body_id'][0] = 2" "body 2: another body has its id"
    refuses_after "no group /ONDEM" "del f['ONDEM']" "without the group /ONDEM"
    refuses_after "a place that is infinite" "f['VTKHDF/Points/Points'][0] = float('inf')" "finite"
    head -c 3000 "$tmp/foreign.vtkhdf" >"$tmp/bad.vtkhdf"
    status 65 "a file that is cut short" ondem read "$tmp/bad.vtkhdf"
    status 66 "no file" ondem read "$tmp/nothing.vtkhdf"
else
    skip "ON-DEM's format" "no h5py"
fi

# ---- LAMMPS, LIGGGHTS, Yade ----

nsd-export --last -o "$tmp/heap.data" "$tmp/heap.h5"
nsd-gen --from "$tmp/heap.data" >"$tmp/data.h5"
like_heap() { nsd-info -p "$1" | jq -cs --argjson d "$2" 'map([.id + $d, .radius, .x, .v, .w])'; }
is "our own data file comes back: place, radius, velocities, bit by bit" "$(like_heap "$tmp/data.h5" 0)" "$(nsd-cat --last "$tmp/heap.h5" | like_heap - 1)"
nsd-export -o "$tmp/sheared.lammpstrj" "$tmp/sheared.h5"
jq -n --arg f "$tmp/sheared.lammpstrj" '{dim: 2, dt: 1e-4, materials: {rock: {}}, bodies: [{import: $f, frame: 1, types: {"1": "rock"}, density: 2600}]}' | nsd-gen - >"$tmp/cell.h5"
jq -n --arg f "$tmp/sheared.h5" '{dim: 2, dt: 1e-4, bodies: [{document: $f, frame: 1}]}' | nsd-gen - >"$tmp/same.h5"
ok "our own dump of a sheared cell, its second frame: places as from the document" h5diff "$tmp/cell.h5" "$tmp/same.h5" /particles/all/position/value
ok "the tilted box" h5diff -d 1e-15 "$tmp/cell.h5" "$tmp/same.h5" /particles/all/box/edges/value
is "and the kind that the type is" "$(nsd-info -p "$tmp/cell.h5" | jq -r .material | sort | uniq -c | xargs)" "400 rock"

cat >"$tmp/in.liggghts" <<EOF
atom_style granular
atom_modify map array
boundary p p f
newton off
communicate single vel yes
units si
read_data heap.data
neighbor 0.0002 bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype 5.e6 5.e6
fix m2 all property/global poissonsRatio peratomtype 0.45 0.45
fix m3 all property/global coefficientRestitution peratomtypepair 2 0.3 0.3 0.3 0.3
fix m4 all property/global coefficientFriction peratomtypepair 2 0.5 0.5 0.5 0.5
pair_style gran model hertz tangential history
pair_coeff * *
timestep 1e-7
fix 1 all gravity 9.81 vector 0.0 0.0 -1.0
fix 2 all nve/sphere
dump 1 all custom 10 dump.liggghts id type x y z vx vy vz omegax omegay omegaz radius mass
run 20
EOF
if command -v liggghts >/dev/null; then
    ok "LIGGGHTS reads our data file" sh -c "cd '$tmp' && liggghts -in in.liggghts >log 2>&1 && grep -q '^ *60 atoms' log"
    is "and its dump has three frames" "$(grep -c TIMESTEP "$tmp/dump.liggghts")" 3
    jq -n --arg f "$tmp/dump.liggghts" '{dt: 1e-5, bodies: [{import: $f, frame: 0}]}' | nsd-gen - >"$tmp/first.h5"
    is "LIGGGHTS' first frame, imported, is our heap to the six digits that it writes" "$(jq -n --argjson a "$(nsd-info -p "$tmp/first.h5" | jq -cs 'sort_by(.id) | map([.radius, .mass, .x, .v, .w])')" \
        --argjson b "$(nsd-cat --last "$tmp/heap.h5" | nsd-info -p | jq -cs 'map([.radius, .mass, .x, .v, .w])')" \
        '[$a, $b] | map([.[] | flatten[]]) | transpose | all((.[0] - .[1] | fabs) <= 6e-6 * (.[1] | fabs) + 1e-12)')" true
    nsd-gen --from "$tmp/dump.liggghts" >"$tmp/last.h5"
    is "its periodic box is the cell" "$(h5dump -a /particles/all/box/boundary "$tmp/last.h5" 2>/dev/null | grep -oE 'periodic|none' | xargs)" "periodic periodic none"
    ok "and a run goes on from its last" sh -c "nsd-step -n 20 '$tmp/last.h5' >'$tmp/on.h5' 2>/dev/null && nsd-info --last '$tmp/on.h5' >'$tmp/none'"
else
    skip "LIGGGHTS reads our data file" "no liggghts"
fi

# as Yade 2023.02 writes them: export.text, export.textExt with three formats, export.textClumps
printf '#format x_y_z_r\n0\t0\t0\t0.5\n2\t0\t0.1\t0.25\n' >"$tmp/y1.txt"
printf '#format x_y_z_r_matId\n0\t0\t0\t0.5\t0\n2\t0\t0.1\t0.25\t1\n' >"$tmp/y2.txt"
printf '#format id_x_y_z_r_matId\n# hello\n0\t0\t0\t0\t0.5\t0\n7\t2\t0\t0.1\t0.25\t1\n' >"$tmp/y3.txt"
printf '#format x_y_z_r_attrs\n# x y z r vx vy vz mass\n0\t0\t0\t0.5\t0\t0\t0\t1361.36\n2\t0\t0.1\t0.25\t1\t2\t3\t130.9\n' >"$tmp/y4.txt"
printf '#format x_y_z_r_clumpId\n4\t0\t0\t0.5\t4\n4.5\t0\t0\t0.4\t4\n' >"$tmp/y5.txt"
second() { nsd-gen --from "$tmp/$1.txt" | nsd-info -p | jq -c 'select(.x[0] == 2) | [.id, .material, .radius, .v, (.mass * 10 | round)]'; }
is "Yade's balls" "$(second y1)" '[1,"ball",0.25,[0,0,0],1636]'
is "with their materials" "$(second y2)" '[1,"1",0.25,[0,0,0],1636]'
is "and ids" "$(second y3)" '[7,"1",0.25,[0,0,0],1636]'
is "and attributes that a comment names" "$(second y4)" '[1,"ball",0.25,[1,2,3],1309]'
refuses 65 "members of clumps are no balls" nsd-gen --from "$tmp/y5.txt"
if command -v yade-double >/dev/null; then
    cat >"$tmp/y.py" <<EOF
from yade import export
O.materials.append(FrictMat(young=1e6, density=2600, label='a')); O.materials.append(FrictMat(young=1e6, density=2000, label='b'))
O.bodies.append([sphere((0, 0, 0), .5, material='a'), sphere((2, 0, .1), .25, material='b')])
O.bodies[1].state.vel = (1, 2, 3)
export.textExt('$tmp/y6.txt', format='x_y_z_r_attrs', comment='vx vy vz mass', attrs=['b.state.vel', 'b.state.mass'])
EOF
    yade-double -n -x "$tmp/y.py" >"$tmp/none" 2>&1 || true
    ok "Yade still writes that" cmp "$tmp/y6.txt" "$tmp/y4.txt"
fi
jq -n --arg f "$tmp/y2.txt" '{dt: 1e-4, bodies: [{import: $f}]}' >"$tmp/types.json"
refuses 65 "a type that is no kind of the scene is asked for" nsd-gen "$tmp/types.json"
like "with the cure" "$(cat "$tmp/err")" '"types": \{"0": NAME\}'

# ---- discs ----

echo '{"dim": 2, "dt": 1e-4, "bodies": [{"x": [0, 0], "radius": 1}]}' | nsd-gen - >"$tmp/disc.h5"
refuses 65 "discs are no balls: --to data" nsd-export --to data -o "$tmp/disc.data" "$tmp/disc.h5"
if has h5py; then
    status 65 "nor for ON-DEM" ondem write "$tmp/disc.h5" -o "$tmp/disc.vtkhdf"
    like "with the cure" "$(cat "$tmp/err")" 'nsd-export --to gsd writes discs'
fi

# ---- many balls: a fifth of a million in a fifth of 2 GB ----

within() { (ulimit -v 420000 && "$@"); }
if [ -z "$thin" ]; then
    nsd-gen 200000 >"$tmp/many.h5"
    for to in vtp lammps csv gsd data; do
        ok "200 000 balls become $to" within nsd-export --to "$to" -o "$tmp/many.$to" "$tmp/many.h5"
    done
    for from in lammps data; do
        ok "and come back from $from" within eval 'nsd-gen --from "$tmp/many.$from" >"$tmp/none"'
    done
    ok "are drawn" within nsd-view -o "$tmp/many.png" "$tmp/many.h5"
    ok "and measured" within nsd-stat "$tmp/many.h5"
    rm "$tmp"/many.*
fi

# ---- hostile files ----

head -c 900 "$tmp/sheared.lammpstrj" >"$tmp/a.lammpstrj" # one line of atoms is cut
printf 'ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp ff ff\n0 1\n0 1\n0 1\nITEM: ATOMS id x y z radius\n1 0 0 0 0.1\n2 1 0 0 0.1\n' >"$tmp/good.dump"
printf 'title\n\n2 atoms\n1 atom types\n0 1 xlo xhi\n0 1 ylo yhi\n0 1 zlo zhi\n\nAtoms # sphere\n\n1 1 0.2 2500 0 0 0\n2 1 0.2 2500 1 0 0\n\nVelocities\n\n1 0 0 1 0 0 0\n2 0 0 1 0 0 0\n' >"$tmp/good.data"
cuts() # each beginning of a file: an answer or one line that names it
{
    local n size s
    size=$(stat -c %s "$1")
    for ((n = 0; n < size; n += 2 + thin0 * 6)); do
        head -c "$n" "$1" >"$tmp/cut"
        s=0
        nsd-gen --from "$tmp/cut" >"$tmp/none" 2>"$tmp/said" || s=$?
        { [ "$s" = 0 ] || { [ "$s" = 65 ] && [ "$(wc -l <"$tmp/said")" = 1 ] && grep -q "^nsd-gen: " "$tmp/said"; }; } ||
            { echo "$n bytes: $s"; cat "$tmp/said"; return 1; }
    done
}
thin0=${thin:-0}
ok "a dump that ends anywhere" cuts "$tmp/good.dump"
ok "a data file that ends anywhere" cuts "$tmp/good.data"
ok "a table of Yade's that ends anywhere" cuts "$tmp/y4.txt"
absurd() # what is true, sed's script, file
{
    sed "$2" "$tmp/$3" >"$tmp/bad.$3"
    refuses 65 "$1" nsd-gen --from "$tmp/bad.$3"
    like "$1: the line is named" "$(cat "$tmp/err")" "${4-line [0-9]+: }"
}
absurd "more atoms than there are" 's/^2$/999999999999/' good.dump
absurd "a negative number of atoms" 's/^2$/-2/' good.dump
absurd "no number where one should be" 's/^1 0 0/1 zero 0/' good.dump
absurd "a place that is not finite" 's/^1 0 0/1 nan 0/' good.dump
absurd "a box without a volume" 's/^0 1$/1 0/' good.dump
absurd "a dump without a radius" 's/ radius/ other/' good.dump
absurd "a column twice, with two numbers" 's/ id x/ x x/' good.dump
absurd "more words than columns" 's/^1 0 0 0 0.1/& 7/' good.dump
absurd "a radius of nothing" 's/^1 0 0 0 0.1/1 0 0 0 0/' good.dump
absurd "two balls of one id" 's/^2 1 0 0/1 1 0 0/' good.dump "id, 1"
absurd "a number beyond doubles" 's/^2 1 0 0/2 1e999 0 0/' good.dump
absurd "a velocity of nobody" 's/^2 0 0 1/9 0 0 1/' good.data
absurd "another style of atoms" 's/sphere/ellipsoid/' good.data
absurd "a diameter below zero" 's/^1 1 0.2/1 1 -0.2/' good.data
absurd "a Yade table without a radius" 's/^#format.*/#format x_y_z/' y1.txt
refuses 65 "a file of nothing that is known" nsd-gen --from README.md

# ---- units, and grains that are no balls ----

sed 's/pp/ff/' "$tmp/good.dump" >"$tmp/apart.dump"
facts_of() { nsd-gen --from "$1" | nsd-info -p | jq -c "$2"; }
sed 's/ id x/ id type type x/; s/^[12] [01] 0 0 0.1/1 7 7 &/; s/^1 7 7 1/1 7 7/; s/^1 7 7 2/2 7 7/' "$tmp/apart.dump" >"$tmp/again.dump"
is "a column twice, with the same numbers, is read" "$(facts_of "$tmp/again.dump" '[.id, .x[0]]' | xargs)" "[1,0] [2,1]"
units() { { printf 'ITEM: UNITS\n%s\n' "$1"; sed 's/ radius/& vx omegaz density/; s/ 0\.1$/& 3 5 2.5/' "$tmp/apart.dump"; } >"$tmp/units.dump"; }
# r, v, w, mass: what a length, a mass and a time are in SI, by hand
for system in si:1:1:1 lj:1:1:1 cgs:1e-2:1e-3:1 micro:1e-6:1e-15:1e-6 nano:1e-9:1e-21:1e-9; do
    IFS=: read -r name L M T <<<"$system"
    units "$name"
    is "$name: radius, place, speed, spin and mass in SI" "$(nsd-gen --from "$tmp/units.dump" | nsd-info -p | jq -s --argjson L "$L" --argjson M "$M" --argjson T "$T" '.[1] |
        [.radius / (0.1 * $L), .x[0] / $L, .v[0] / (3 * $L / $T), .w[2] / (5 / $T), .mass / (2.5 * $M * 4 / 3 * 3.141592653589793e-3)] | map((. - 1 | fabs) < 1e-12) | all')" true
done
for name in real metal electron; do
    units "$name"
    refuses 65 "$name: units of atoms" nsd-gen --from "$tmp/units.dump"
    like "by name, with the cure" "$(cat "$tmp/err")" "line 2: \"$name\" are units of atoms; units si, cgs, micro, nano and lj are read"
done
units feet
refuses 65 "units that are none" nsd-gen --from "$tmp/units.dump"
{ units cgs; cat "$tmp/units.dump"; sed 's/ radius/& vx omegaz density/; s/ 0\.1$/& 3 5 2.5/' "$tmp/apart.dump"; } >"$tmp/two.dump"
is "units before the first frame are those of the second, too" "$(facts_of "$tmp/two.dump" '.radius' | xargs)" "0.001 0.001"
for title in 'LAMMPS data file via write_data, version 29 Aug 2024, timestep = 100, units = cgs' 'a file # units: cgs' 'in cgs # units cgs' 'units=cgs' '# Units : cgs'; do
    sed "1s/.*/$title/; s/^1 1 0.2 2500/1 1 0.2 2.5/" "$tmp/good.data" >"$tmp/cgs.data"
    is "$title: radius and density" "$(facts_of "$tmp/cgs.data" 'select(.id == 1) | [.radius, (.mass / (4 / 3 * 3.141592653589793e-9) | round), .v[2]]')" '[0.001,2500,0.01]'
done
sed '2s/.*/# units = real/' "$tmp/good.data" >"$tmp/real.data"
refuses 65 "units of atoms in a data file" nsd-gen --from "$tmp/real.data"
is "units of a title that names none" "$(sed '1s/.*/units of the box/' "$tmp/good.data" >"$tmp/box.data"; facts_of "$tmp/box.data" .radius | xargs)" "0.1 0.1"
grain() { sed "s/ radius/& $1/; s/ 0\.1\$/& $2/" "$tmp/apart.dump" >"$tmp/grain.dump"; }
while IFS='|' read -r columns numbers said; do
    grain "$columns" "$numbers"
    refuses 65 "no ball: $columns $numbers" nsd-gen --from "$tmp/grain.dump"
    like "by name" "$(cat "$tmp/err")" "$said"
done <<'END'
shapex shapey shapez blockiness1 blockiness2|0.1 0.1 0.2 2 2|superquadric .shapex 0.1, shapey 0.1, shapez 0.2.: only balls
shapex shapey shapez blockiness1 blockiness2|0.1 0.1 0.1 8 8|superquadric .blockiness1 8.: only balls
shape[0] shape[1] shape[2] quatw|1 2 1 1|ellipsoid or superquadric
shapex|0.1|shapex, shapey and shapez are needed together
id_multisphere|3|part of a clump .id_multisphere 3.
diameter|0.3|a radius 0.1, and a diameter 0.3
END
grain 'shapex shapey shapez blockiness1 blockiness2 id_multisphere diameter' '0.1 0.1 0.1 2 2 -1 0.2'
is "equal axes and exponents of 2 are a ball" "$(facts_of "$tmp/grain.dump" .radius | xargs)" "0.1 0.1"
sed -i 's/ radius/ other/; s/ diameter/ none/' "$tmp/grain.dump"
is "whose half axis is the radius" "$(facts_of "$tmp/grain.dump" .radius | xargs)" "0.1 0.1"
absurd "a hybrid style" 's/# sphere/# hybrid sphere bond/' good.data
absurd "a style behind # without a blank" 's/# sphere/#full/' good.data
absurd "bonds" 's/^2 atoms/&\n1 bonds/' good.data
absurd "ellipsoids in a section" 's/^Velocities/Ellipsoids/' good.data
absurd "masses of types before Atoms without a style" 's/^Atoms.*/Masses\n\n1 3.5\n\nAtoms/' good.data
sed 's/^Atoms.*/Atoms #granular/' "$tmp/good.data" >"$tmp/style.data"
is "a style behind # without a blank" "$(facts_of "$tmp/style.data" .radius | xargs)" "0.1 0.1"

# ---- FCLIB problems of other kinds ----

if has h5py; then
    for group in fclib_global_rolling fclib_local_rolling; do
        /usr/bin/python3 -c "import h5py; f = h5py.File('$tmp/rolling.h5', 'w'); f['$group/spacedim'] = [5]; f['info/title'] = 'x'"
        refuses 65 "$group" nsd-solve "$tmp/rolling.h5"
        like "is named, with what is read" "$(cat "$tmp/err")" "/$group: a kind of FCLIB problem that is not solved: only /fclib_local and /fclib_global are read"
    done
fi
refuses 66 "a file that is not there" nsd-gen --from "$tmp/nowhere"
refuses 66 "a directory" nsd-gen --from "$tmp"
mkfifo "$tmp/fifo"
refuses 66 "a pipe does not keep it waiting" nsd-gen --from "$tmp/fifo"
refuses 65 "a document is no file of another program" nsd-gen --from "$tmp/heap.h5"
jq -n --arg f "$tmp/good.dump" '{dt: 1e-4, bodies: [{import: $f, frame: 3}]}' >"$tmp/frame.json"
refuses 65 "a frame that is not there" nsd-gen "$tmp/frame.json"
# 60 MB of one line: bounded in time and memory
head -c 60000000 /dev/zero | tr '\0' ' ' | cat <(printf 'ITEM: TIMESTEP\n') - >"$tmp/blank.dump"
refuses 65 "60 MB of blanks" timeout 60 nsd-gen --from "$tmp/blank.dump"
rm "$tmp/blank.dump"
done_testing
