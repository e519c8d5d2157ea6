#!/usr/bin/env bash
# Surfaces out of files of other programs: the same cube as STL, OBJ and PLY in all the ways in which programs write
# them, as a wall and as a grain; what is refused, and why; files that are cut off; bounds.
. tests/support/tap.sh

if ! has h5py; then echo "1..0 # SKIP no h5py"; exit; fi
root=$PWD
cd "$tmp"

# ---- what is read ----

py "$root/tests/support/mesh.py" write . && : >said
while read -r name _; do
    for k in wall grain; do nsd-gen "$name.$k.json" >"$name.$k.h5" 2>>said || :; done
    nsd-detect --gap 0.5 "$name.wall.h5" >"$name.gap.h5"
done <list
is "a cube in $(wc -l <list) files: corners, triangles, area, volume; the gap of a ball; a grain's mass and reach" \
    "$(py "$root/tests/support/mesh.py" judge . 2>&1)" ""
is "what is left out of a wall is counted" "$(cat said)" \
    "nsd-gen: twice.stl: left out: 5 triangles that have no area, or the corners of another
nsd-gen: turned.stl: left out: 1 triangles that have no area, or the corners of another"

wall() { echo "{\"dt\": 1e-3, \"walls\": [{\"mesh\": {\"file\": \"$1\"}}]}" >bad.json; }
area() # FILE: the number of its triangles, and their area
{
    wall "$1"
    nsd-gen bad.json >area.h5 && py -c 'import h5py, numpy as np
m = h5py.File("area.h5")["particles/boundary/mesh"]; v, e = m["vertex"][:], m["element"][:]
a = np.linalg.norm(np.cross(v[e[:, 1]] - v[e[:, 0]], v[e[:, 2]] - v[e[:, 0]]), axis=1).sum() / 2
print(len(e), round(a, 9))'
}
printf 'v %s\n' '0 0 0' '4 0 0' '4 4 0' '3 4 0' '3 1 0' '1 1 0' '1 4 0' '0 4 0' >u.obj
echo 'f 1 2 3 4 5 6 7 8' >>u.obj
is "a concave polygon has the area that it has" "$(area u.obj)" "6 10.0"
printf 'v %s\n' '0 0 0' '2 0 0' '2 1 0' '1 1 0' '0 1 0' >line.obj
echo 'f 1 2 3 4 5' >>line.obj
is "a corner on a straight side makes no triangle without an area" "$(area line.obj)" "3 2.0"
awk 'BEGIN { n = 4000; for (i = 0; i < n; i++) { r = i % 2 ? 1 : 0.5; printf "v %.17g %.17g 0\n", r * cos(i * 6.283185307179586 / n), r * sin(i * 6.283185307179586 / n) }
    printf "f"; for (i = 1; i <= n; i++) printf " %d", i; print "" }' >star.obj
is "a star of 4000 corners" "$(area star.obj)" "3998 $(awk 'BEGIN { printf "%.9f", 2000 * 0.5 * sin(6.283185307179586 / 4000) }')"

grain() # FILE: the mass of the grain
{
    echo "{\"dt\": 1e-3, \"shapes\": {\"it\": {\"mesh\": {\"file\": \"$1\"}}}, \"bodies\": [{\"x\": [0, 0, 0], \"shape\": \"it\", \"density\": 1}]}" >bad.json
    nsd-gen bad.json | nsd-info -p | jq .mass
}
awk '/vertex/ { $1 = "vertex"; for (k = 2; k <= 4; k++) $k = sprintf("%.17g", $k + 1e-8 * ((NR * 7 + k) % 5)) } { print }' text.stl >noisy.stl
is "corners that differ by some 1e-8 close a grain" "$(grain noisy.stl | jq '(. - 2.197 | fabs) < 1e-6')" true

# ---- what is refused ----

awk 'BEGIN { for (i = 0; i < 5000; i++) { z = 1 - (2 * i + 1) / 5000; r = sqrt(1 - z * z); printf "v %.17g %.17g %.17g\n", r * cos(2.4 * i), r * sin(2.4 * i), z }
    for (i = 1; i < 4999; i++) print "f", i, i + 1, i + 2 }' >round.obj
echo '{"dt": 1e-3, "shapes": {"it": {"mesh": {"file": "round.obj", "hull": true}}}, "bodies": []}' >bad.json
refuses 65 "a hull of 5000 corners" nsd-gen bad.json
like "  with a cure that helps" "$(cat "$tmp/err")" 'its hull has 5000 corners, and a shape has 4096 at most: leave out points \(decimate the mesh\), or make a "clump" of it$'

bad() # NAME FILE PATTERN < CONTENT
{
    cat >"$2"
    wall "$2"
    refuses 65 "$1" nsd-gen bad.json
    like "  and why" "$(cat "$tmp/err")" "$2: $3"
}
stl() { printf 'solid x\nfacet normal 0 0 1\nouter loop\n'; printf 'vertex %s\n' "$@"; printf 'endloop\nendfacet\nendsolid\n'; }
bad "a facet of four corners" a.stl 'line 7: "vertex" where endloop should be: a facet has three' < <(stl '0 0 0' '1 0 0' '1 1 0' '0 1 0')
bad "one of two" a.stl 'line 6: "endloop" where vertex should be' < <(stl '0 0 0' '1 0 0')
bad "a corner nan" a.stl 'line 6: "nan" is no finite' < <(stl '0 0 0' '1 0 0' '1 nan 0')
bad "a corner in hexadecimal" a.stl 'line 6: "0x1p3" is no' < <(stl '0 0 0' '1 0 0' '1 0x1p3 0')
bad "a corner beyond numbers" a.stl 'line 6: "1e999" is too large' < <(stl '0 0 0' '1 0 0' '1 1e999 0')
bad "a corner of two numbers" a.stl 'line 6: a number is missing' < <(stl '0 0 0' '1 0 0' '1 1')
bad "nothing with an area" a.stl 'no triangle with an area' < <(stl '0 0 0' '1 0 0' '2 0 0')
bad "words behind the end" a.stl 'line 10: "more" where solid' < <(stl '0 0 0' '1 0 0' '0 1 0'; echo more)
bad "a binary STL with 3 bytes behind it" a.stl '3 bytes behind' < <(cat binary.stl; printf '\0\0\0')
bad "noise" a.stl '' < <(head -c 3000 /dev/urandom)
bad "one word" a.stl 'line 1: ends without endsolid' < <(printf 'solid')
bad "an empty file" a.stl 'no STL: 0 bytes' < <(:)
obj() { printf 'v %s\n' '0 0 0' '1 0 0' '1 1 0' '0 1 0' '0.5 0.5 0.9'; printf '%s\n' "$@"; }
bad "a corner that is not there" a.obj 'line 6: .* does not exist \(6 of 5\)' < <(obj 'f 1 2 6')
bad "one before the first" a.obj 'line 6: .*does not exist' < <(obj 'f 1 2 -6')
bad "a corner 0" a.obj 'line 6: "0" is no number of a corner' < <(obj 'f 0 1 2')
bad "a corner 3.5" a.obj 'line 6: "3.5" is no number' < <(obj 'f 1 2 3.5')
bad "a texture x" a.obj 'line 6: "2/x" is no' < <(obj 'f 1 2/x 3')
bad "a corner of 20 digits" a.obj 'line 6: .*does not exist' < <(obj 'f 1 2 99999999999999999999')
bad "a polygon of two corners" a.obj 'line 6: a polygon of 2 corners' < <(obj 'f 1 2')
bad "a polygon that crosses itself" a.obj 'line 6: .*crosses itself' < <(obj 'f 1 3 2 4')
bad "one that is not flat" a.obj 'line 6: .*not flat' < <(obj 'f 1 2 5 4')
bad "a corner of two coordinates" a.obj 'line 7: a number is missing' < <(obj 'f 1 2 3' 'v 1 1')
bad "curves" a.obj 'line 7: "cstype" is free-form' < <(obj 'f 1 2 3' 'cstype bezier')
bad "another file" a.obj 'line 7: "call" names another file' < <(obj 'f 1 2 3' 'call more.obj')
bad "a corner of four numbers" a.obj 'line 6: "1/1/1/1" is no corner' < <(obj 'f 1/1/1/1 2 3')
bad "points alone" a.obj 'no triangles' < <(obj)
bad "a polygon of 1e5 corners" a.obj 'line 7: a polygon of more than 4096' < <(obj; printf 'f '; seq -s ' ' 1 100000)
bad "one of 5000" a.obj 'line 5001: a polygon of more than 4096' < <(for i in {1..5000}; do echo "v $i 0 0"; done; echo f {1..5000})
ply() { sed "$1" ascii.ply; }
bad "a byte order of no machine" a.ply 'line 2: "binary_middle_endian"' < <(ply 's/^format.*/format binary_middle_endian 1.0/')
bad "version 2" a.ply 'line 2: .*version' < <(ply 's/ascii 1.0/ascii 2.0/')
bad "a type that is not known" a.ply 'line 7: "quad"' < <(ply 's/property double x/property quad x/')
bad "no x" a.ply 'line 1[01]: no x of vertex' < <(ply '/property double x/d')
bad "a list of 4.0 corners" a.ply 'line 10: ' < <(ply 's/list uchar/list float/')
bad "corners that are floats" a.ply 'line 10: ' < <(ply 's/uchar int/uchar float/')
bad "strips" a.ply 'line 12: no vertex_indices of face: strips' < <(ply 's/vertex_indices/strips/')
bad "a vertex too many" a.ply 'line 20: ' < <(ply 's/element vertex 8/element vertex 9/')
bad "a face too many" a.ply 'line [0-9]+: ends before its last element' < <(ply 's/element face 6/element face 7/')
bad "one too few" a.ply 'line [0-9]+: .*behind the last element' < <(ply 's/element face 6/element face 5/')
bad "-6 faces" a.ply 'line 9: a negative' < <(ply 's/element face 6/element face -6/')
bad "6e18 of them" a.ply 'line 9: ' < <(ply 's/element face 6/element face 6e18/')
bad "corner 8 of 8" a.ply 'line 20: .*does not exist' < <(ply 's/^4 0 2/4 0 8/')
bad "a list that is longer than its line" a.ply 'line 20: a number is missing' < <(ply 's/^4 0 2/5 0 2/')
bad "and a shorter one" a.ply 'line 20: "1" is too much' < <(ply 's/^4 0 2/3 0 2/')
bad "a byte behind the last element" a.ply '1 bytes behind' < <(cat little.ply; printf 'x')
bad "another format" a.off 'neither STL, OBJ nor PLY' < <(printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n')
bad "one that names other files" a.gltf 'neither STL, OBJ nor PLY' < <(printf '{"asset": {"version": "2.0"}}')
py - <<'END'
import struct
for name, east in ("far.stl", 4649776), ("near.stl", 1300):
    t = [(east + a, b, 0) for a, b in ((0, 0), (1.3, 0), (0, 1.3))]
    open(name, "wb").write(b" " * 80 + struct.pack("<I", 1) + struct.pack("<12fH", 0, 0, 1, *[c for x in t for c in x], 0))
END
cp far.stl a.bin && bad "binary STL so far away that its numbers are too coarse" far.stl 'its corners, up to 4.65e\+06 from the origin, are rounded to 0.4 of its size' <a.bin
is "not nearer" "$(area near.stl | cut -d ' ' -f 1)" 1

# ---- files that are cut off ----

cut_off() # K: the K-th length of each file
{
    local file size n
    for file in text.stl binary.stl extra.ply big-extra.ply little.ply; do
        size=$(wc -c <$file)
        n=$((size * $1 / 24))
        head -c $n $file >"cut$1-$file"
        echo "{\"dt\": 1, \"walls\": [{\"mesh\": {\"file\": \"cut$1-$file\"}}]}" >"cut$1.json"
        s=0
        nsd-gen "cut$1.json" >/dev/null 2>"cut$1.err" || s=$?
        [ $s = 65 ] && [ "$(wc -l <"cut$1.err")" = 1 ] || echo "$n bytes of $file: $s $(cat "cut$1.err")"
    done
    head -c $(($(wc -c <plain.obj) * $1 / 24)) plain.obj >"cut$1.obj"
    echo "{\"dt\": 1, \"shapes\": {\"it\": {\"mesh\": {\"file\": \"cut$1.obj\"}}}, \"bodies\": []}" >"cut$1.json"
    s=0
    nsd-gen "cut$1.json" >/dev/null 2>"cut$1.err" || s=$?
    [ $s = 65 ] || echo "a part of plain.obj as a grain: $s"
}
ok_each "an STL or PLY file that is cut off is refused, wherever it is; an OBJ file as a grain" cut_off 24

# ---- what is no file, and bounds ----

mkfifo fifo.stl
ln -s /dev/zero zero.stl
mkdir folder.stl
for what in fifo:pipe zero:device folder:directory; do
    wall "${what%:*}.stl"
    refuses 66 "a ${what%:*} is no mesh" timeout 5 nsd-gen bad.json
    like "  and why" "$(cat "$tmp/err")" "no plain file: .*${what#*:}"
done
truncate -s 2G large.stl
wall large.stl
refuses 65 "a file of 2 GiB" nsd-gen bad.json
like "  and why" "$(cat "$tmp/err")" "more than 1073741824 bytes in all"
rm large.stl

# ---- byte order marks ----

mark=$'\357\273\277'
printf '%s# x y z r\n0 0 0 1\n' "$mark" >marked.txt
printf '%s{"dt": 1e-3, "bodies": [{"file": "marked.txt"}]}' "$mark" >marked.json
is "a byte order mark in front of a scene and of a table is no part of them" "$(nsd-gen marked.json | nsd-info -p | jq -c .x)" '[0,0,0]'
printf '%s0 0 0 1\n' "$mark" >marked.txt
is "nor in front of a table without names" "$(nsd-gen marked.json | nsd-info -p | jq -c .x)" '[0,0,0]'

done_testing
