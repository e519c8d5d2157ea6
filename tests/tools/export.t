#!/usr/bin/env bash
# What other programs read: nsd-export's files by VTK, ASE and MDAnalysis; documents by MDAnalysis and
# h5py; import nsd. The numbers are compared with the documents' own, and the forces with Newton's law.
# shellcheck source=tests/support/tap.sh disable=SC2317,SC2016 # functions called by name; backquotes of Markdown
. tests/support/tap.sh

other() # "what is true" MODULE ...: as tests/support/export.py has it, where Python has the module
{
    local name=$1 module=$2
    shift 2
    if has "$module"; then ok "$name" py tests/support/export.py "$@"; else skip "$name" "no $module"; fi
}

nsd-gen 60 >"$tmp/gen.h5"
stock run60 >"$tmp/out.h5"
nsd-step -n 6 --forces "$tmp/out.h5" >"$tmp/each.h5" 2>/dev/null

# ---- VTK ----

nsd-export -o "$tmp/vtp/" "$tmp/out.h5"
nsd-export -o "$tmp/vtu/" --to vtu "$tmp/out.h5"
other "VTK reads grains, contacts and walls of .vtp" vtk directory "$tmp/out.h5" "$tmp/vtp" vtp
other "and of .vtu" vtk directory "$tmp/out.h5" "$tmp/vtu" vtu
other "a list has all frames' files and times" h5py pvd "$tmp/out.h5" "$tmp/vtp"
nsd-export -o "$tmp/newton/" "$tmp/each.h5"
other "exported forces are those of Newton's law" vtk newton "$tmp/each.h5" "$tmp/newton"
mkdir "$tmp/series"
nsd-export -o "$tmp/series/f%03d.vtp" "$tmp/out.h5"
ok "a series is the same files" cmp "$tmp/series/f029.vtp" "$tmp/vtp/grains-00029.vtp"
ok "a pipe gives the same files" cmp <(nsd-cat --last "$tmp/out.h5" | nsd-export --to vtp) "$tmp/vtp/grains-00029.vtp"
ok "the last frame alone" cmp <(nsd-export --last --to vtp "$tmp/out.h5") "$tmp/vtp/grains-00029.vtp"
ok "a part alone" cmp <(nsd-export --last --part contacts --to vtp "$tmp/out.h5") "$tmp/vtp/contacts-00029.vtp"
grows()
{
    nsd-gen 20 | nsd-step -n $((thin ? 600 : 1000)) 2>/dev/null | nsd-export -o "$tmp/live/" &
    /usr/bin/python3 tests/support/export.py growing "$tmp/live"
    local s=$?
    wait
    return $s
}
two_writers() # the second is refused, and the first ends well
{
    mkdir "$tmp/both"
    (flock 9 && ! nsd-export -o "$tmp/both/" "$tmp/out.h5" 2>"$tmp/err" && grep -q "both/: another program is writing into it" "$tmp/err") 9<"$tmp/both" &&
        nsd-export -o "$tmp/both/" "$tmp/out.h5" && cmp "$tmp/both/grains.pvd" "$tmp/vtp/grains.pvd"
}
ok "a folder has one writer" two_writers
if has h5py; then ok "a list is whole while it grows" grows; else skip "a list is whole while it grows" "no h5py"; fi

# ---- grains that come and go ----

nsd-gen scenes/pour.json | nsd-step -n 400 --every 50 --contacts 2>/dev/null >"$tmp/pour"
nsd-cat "$tmp/pour" >"$tmp/pour.h5"
is "grains come" "$(nsd-info "$tmp/pour.h5" | jq -s 'map(select(.step).bodies) | last > first')" true
nsd-export -o "$tmp/pour.csv" "$tmp/pour.h5"
ok "a stream and a trajectory of them give the same table" cmp "$tmp/pour.csv" <(nsd-export --to csv "$tmp/pour")
other "nsd.py sees those that are there" h5py table "$tmp/pour.csv" "$tmp/pour.h5" grains ,
other "MDAnalysis reads it" MDAnalysis readable "$tmp/pour.h5"
nsd-export --part contacts -o "$tmp/pour.csv" "$tmp/pour.h5"
other "and their contacts" h5py table "$tmp/pour.csv" "$tmp/pour.h5" contacts ,

# ---- a cell that repeats ----

nsd-gen scenes/shear.json | nsd-step -n 2300 --every 2300 >"$tmp/sheared.h5" 2>/dev/null
nsd-step -n 6 --contacts "$tmp/sheared.h5" >"$tmp/shear.h5" 2>/dev/null
nsd-export -o "$tmp/shear/" "$tmp/shear.h5"
nsd-export -o "$tmp/shear.xyz" "$tmp/shear.h5"
nsd-export -o "$tmp/shear.lammpstrj" "$tmp/shear.h5"
other "a contact's line goes to the image that it is with" vtk images "$tmp/shear.h5" "$tmp/shear"
other "the cell's lines are its edges" vtk cell "$tmp/shear.h5" "$tmp/shear"
other "forces are Newton's there, too" vtk newton "$tmp/shear.h5" "$tmp/shear"
# a body that crosses the borders of an oblique cell several times, both ways: x + sum of image e is x_0 + v t
jq -n '{ dt: 1e-2, gravity: [0, 0, 0], cell: { edges: [[1, 0, 0], [0.3, 1, 0], [0.2, 0.1, 1]] },
    bodies: [{ x: [0.5, 0.5, 0.5], radius: 0.1, v: [3.7, -2.9, 1.3] }] }' | nsd-gen - | nsd-step -n 100 --every 25 2>/dev/null -o "$tmp/cross.h5"
unwrapped() # of "x y z i j k time": how many; whether they are on the straight line; along how many edges the last has crossed a border
{
    awk '{ t = $7; x = $1 + $4 + 0.3 * $5 + 0.2 * $6; y = $2 + $5 + 0.1 * $6; z = $3 + $6
        d = (x - 0.5 - 3.7 * t) ^ 2 + (y - 0.5 + 2.9 * t) ^ 2 + (z - 0.5 - 1.3 * t) ^ 2; if (d > m) m = d; n++; last = ($4 > 1) + ($5 < -1) + ($6 > 0) }
        END { print n, (m < 1e-24 ? "straight" : m), last }'
}
is "tables: images unwrap a path across the borders" \
    "$(nsd-export --to tsv "$tmp/cross.h5" | awk 'NR == 1 { for (i = 1; i <= NF; i++) c[$i] = i; next } { print $c["x"], $c["y"], $c["z"], $c["image_x"], $c["image_y"], $c["image_z"], $c["time"] }' | unwrapped)" "4 straight 3"
is "LAMMPS' dump: ix iy iz" "$(nsd-export --to lammps "$tmp/cross.h5" | awk '$2 == "TIMESTEP" { getline; t = $1 / 100 } $2 == "ATOMS" { for (i = 3; i <= NF; i++) c[$i] = i - 2; getline
    print $c["x"], $c["y"], $c["z"], $c["ix"], $c["iy"], $c["iz"], t }' | unwrapped)" "4 straight 3"
is "extended XYZ: image" "$(nsd-export --to xyz "$tmp/cross.h5" | awk '/orientation:R:4:image:I:3 / { sub(".*Time=", ""); t = $1; getline; print $2, $3, $4, $(NF - 2), $(NF - 1), $NF, t }' | unwrapped)" "4 straight 3"
is "LAMMPS' data file: flags, and nsd-gen reads it" "$(nsd-export --last --to data "$tmp/cross.h5" | tee "$tmp/cross.data" | awk '$1 == "Atoms" { getline; getline; print $5, $6, $7, $8, $9, $10, 1 }' | unwrapped
    nsd-gen --from "$tmp/cross.data" | nsd-info -p | jq -c .radius)" "1 straight 3
0.1"
other "ASE reads the cell" ase ase_cell "$tmp/shear.h5" "$tmp/shear.xyz" "$tmp/shear.lammpstrj"
other "MDAnalysis reads it from the document" MDAnalysis box "$tmp/shear.h5"

# ---- other shapes ----

jq '.bodies = [{"x": [0, 0, 0], "radius": 0.1}, {"x": [1, 0, 0.1], "shape": "stone", "orientation": [1, 2, 3], "v": [1, 2, 3]},
    {"x": [3, 0, 0], "shape": "cube", "size": 0.3, "orientation": [0.2, 0, 0.1]}] | .walls = []' scenes/rubble.json | nsd-gen - >"$tmp/shaped.h5"
nsd-export --part surfaces -o "$tmp/shaped.vtp" "$tmp/shaped.h5"
nsd-export --part surfaces -o "$tmp/shaped.vtu" "$tmp/shaped.h5"
other "VTK reads the faces of stones, which hold their mass" vtk surfaces "$tmp/shaped.vtp" "$tmp/shaped.h5" 2600
other "as an unstructured grid, too" vtk surfaces "$tmp/shaped.vtu" "$tmp/shaped.h5" 2600
refuses 65 "balls alone have no surfaces" nsd-export --last --part surfaces -o "$tmp/none.vtp" "$tmp/out.h5"
nsd-export -o "$tmp/shaped/" "$tmp/shaped.h5"
ok "a directory has them" cmp "$tmp/shaped/surfaces-00000.vtp" "$tmp/shaped.vtp"

# ---- the others ----

nsd-export -o "$tmp/out.xyz" "$tmp/out.h5"
nsd-export -o "$tmp/out.lammpstrj" "$tmp/out.h5"
other "ASE reads extended XYZ" ase xyz "$tmp/out.xyz" "$tmp/out.h5"
is "without a periodic cell there are no images" "$(grep -c 'ix iy' "$tmp/out.lammpstrj" || true)" 0
other "ASE and MDAnalysis read LAMMPS' dump" MDAnalysis lammps "$tmp/out.lammpstrj" "$tmp/out.h5"
for part in grains contacts; do
    nsd-export -o "$tmp/$part.csv" --part $part "$tmp/out.h5"
    nsd-export -o "$tmp/$part.tsv" --part $part "$tmp/out.h5"
    other "a table of $part by commas" h5py table "$tmp/$part.csv" "$tmp/out.h5" $part ,
    other "a table of $part by tabs" h5py table "$tmp/$part.tsv" "$tmp/out.h5" $part '\t'
done
ok "a table in a pipe is the same" cmp "$tmp/grains.csv" <(nsd-cat "$tmp/out.h5" | cat | nsd-export --to csv)
is "five walls" "$(nsd-export --to csv --last --part walls "$tmp/out.h5" | wc -l)" 6
for detail in 0 2; do
    nsd-export --last --detail $detail -o "$tmp/out.stl" "$tmp/out.h5"
    other "VTK reads STL, balls of detail $detail" vtk stl "$tmp/out.stl" "$tmp/out.h5" $detail
done

# ---- documents as they are ----

other "MDAnalysis reads a trajectory" MDAnalysis mdanalysis "$tmp/out.h5"
nsd-cat --last "$tmp/out.h5" | nsd-detect | nsd-solve 2>/dev/null >"$tmp/solved.h5"
other "and a document of nsd-solve's" MDAnalysis mdanalysis "$tmp/solved.h5"
nsd-gen 20 | nsd-cat - <(nsd-gen 20 | nsd-step -n 5 2>/dev/null) >"$tmp/mixed.h5"
other "and one whose first frame has no report" MDAnalysis mdanalysis "$tmp/mixed.h5"
other "/contacts/force: N, in space" h5py forces "$tmp/each.h5"
ok "nsd-cat keeps the forces" cmp "$tmp/each.h5" <(nsd-cat "$tmp/each.h5" | nsd-cat >"$tmp/again.h5"; cat "$tmp/again.h5")
nsd-cat --last "$tmp/out.h5" | nsd-detect | nsd-solve --forces 2>/dev/null >"$tmp/forces.h5"
other "nsd-solve --forces" h5py forces "$tmp/forces.h5"
grows_too()
{
    nsd-step -n 1000000 -o "$tmp/grows.h5" "$tmp/gen.h5" 2>/dev/null &
    local s=0
    /usr/bin/python3 tests/support/export.py looks_on "$tmp/grows.h5" || s=$?
    kill $!
    wait
    return $s
}
if has h5py; then ok "nsd.py reads a trajectory that grows" grows_too; else skip "a trajectory that grows" "no h5py"; fi
other "nsd.py reads a pipe" h5py stream "$tmp/out.h5"
nsd-cat --last "$tmp/out.h5" | nsd-detect --fclib=local | tail -c +513 >"$tmp/both.hdf5"
h5copy -i "$tmp/both.hdf5" -o "$tmp/problem.hdf5" -s /fclib_local -d /fclib_local
nsd-solve --tolerance 1e-12 "$tmp/problem.hdf5" 2>/dev/null >"$tmp/problem.h5"
other "nsd.py reads a problem of FCLIB's, and its solution" h5py fclib "$tmp/problem.h5"

# until nsd 0.1 the report was elsewhere
moved_report()
{
    tail -c +513 "$tmp/out.h5" >"$tmp/old.hdf5"
    py -c "import h5py, sys
f = h5py.File(sys.argv[1], 'r+')
f.create_group('observables'); f.move('/nsd/solver', '/observables/solver')" "$tmp/old.hdf5" &&
        cmp <(nsd-info "$tmp/old.hdf5") <(nsd-info "$tmp/out.h5") &&
        nsd-cat "$tmp/old.hdf5" >"$tmp/new.h5" && cmp "$tmp/new.h5" "$tmp/out.h5"
}
if has h5py; then
    ok "a report where it was until 0.1 is read, and written in its new place" moved_report
else
    skip "a report where it was until 0.1" "no h5py"
fi

# ---- the plot of nsd-python(7) ----

cp docs/examples/forces.py "$tmp/plot.py"
plots()
{
    (cd "$tmp" && PYTHONPATH=$OLDPWD/python MPLBACKEND=Agg /usr/bin/python3 plot.py) &&
        [ "$(head -c 4 "$tmp/forces.png" | tail -c 3)" = PNG ]
}
if has matplotlib; then ok "plot the forces" plots; else skip "plot the forces" "no matplotlib"; fi

# ---- bounds ----

if [ -z "$thin" ]; then
    nsd-gen 2000 >"$tmp/many.h5"
    nsd-step -n 10 "$tmp/many.h5" 2>/dev/null | cat >"$tmp/few"
    nsd-step -n 100 "$tmp/many.h5" 2>/dev/null | cat >"$tmp/more"
    # GNU time: what starts the tool must be smaller than it, for a process begins with the peak of that
    kilobytes() { command time -o "$tmp/peak" -f %M nsd-export --to csv >/dev/null && tail -n 1 "$tmp/peak"; }
    if [ -x /usr/bin/time ]; then
        few=$(kilobytes <"$tmp/few") more=$(kilobytes <"$tmp/more")
        ok "100 frames of a stream in a file take the memory of 10: $more, $few kB" [ $((4 * more)) -lt $((5 * few)) ]
        few=$(kilobytes < <(cat "$tmp/few")) more=$(kilobytes < <(cat "$tmp/more"))
        ok "and in a pipe: $more, $few kB" [ $((4 * more)) -lt $((5 * few)) ]
    else
        skip "100 frames of a stream take the memory of 10" "no time(1)"
    fi
fi

# ---- what is not as usual ----

echo '{"dim": 2, "dt": 1e-3, "gravity": [0, -9.81], "density": 1, "bodies": [{"x": [0, 1], "radius": 0.1}]}' >"$tmp/one.json"
if nsd-gen "$tmp/one.json" >"$tmp/one.h5" 2>/dev/null; then
    for format in vtp vtu xyz lammps csv tsv stl; do
        status 0 "one disc, no wall, no contact: $format" nsd-export --to $format "$tmp/one.h5"
    done
    refuses 65 "no wall to export" nsd-export --to csv --part walls "$tmp/one.h5"
else
    ok "a scene of one disc" false
fi
refuses 65 "no contacts to export" nsd-export --to csv --part contacts "$tmp/gen.h5"
refuses 65 "no cell to export" nsd-export --to csv --part cell "$tmp/gen.h5"
refuses 64 "no format" nsd-export "$tmp/out.h5"
refuses 64 "an ending of no format" nsd-export -o "$tmp/out.doc" "$tmp/out.h5"
refuses 64 "a number that is none" nsd-export -o "$tmp/f%s.vtp" "$tmp/out.h5"
refuses 64 "many frames in a file of one" nsd-export -o "$tmp/f.vtp" "$tmp/out.h5"
refuses 64 "contacts as XYZ" nsd-export --part contacts -o "$tmp/f.xyz" "$tmp/out.h5"
refuses 64 "contacts as triangles" nsd-export --last --part contacts -o "$tmp/f.stl" "$tmp/out.h5"
refuses 64 "the input as output" nsd-export --to csv -o "$tmp/out.h5" "$tmp/out.h5"
refuses 65 "no such step" nsd-export --frames 5000: -o "$tmp/f.csv" "$tmp/out.h5"
refuses 65 "a problem without bodies" nsd-export --to csv "$tmp/problem.h5"
refuses 74 "a directory that cannot be" nsd-export -o "$tmp/no/such/" "$tmp/out.h5"
refuses 74 "a file that cannot be" nsd-export -o "$tmp/no/such.csv" "$tmp/out.h5"
if [ -e /dev/full ]; then
    refuses 74 "a full disk" nsd-export --to csv -o /dev/full "$tmp/out.h5"
    status 74 "a full standard output" bash -c "nsd-export --to csv '$tmp/out.h5' >/dev/full"
fi
done_testing
