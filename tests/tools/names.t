#!/usr/bin/env bash
# Names of walls, parts of surfaces and groups of bodies: from scenes and OBJ files into documents, through resumed
# runs, nsd-cat, scenes out of documents and several processes; --only; sums by name; what is refused.
# shellcheck source=tests/support/tap.sh disable=SC2016 # eval
. tests/support/tap.sh

step() { nsd-step "$@" 2>/dev/null; }
python=/usr/bin/python3

# Four corners of a floor of two triangles, in two groups of an object, and a wall behind it
cat >"$tmp/floor.obj" <<'END'
v -1 -1 0
v 1 -1 0
v 1 1 0
v -1 1 0
v -1 1 1
v 1 1 1
o plate
g left
f 1 2 4
g right
f 2 3 4
g default
f 3 4 5 6
END
jq -n --arg file "$tmp/floor.obj" '{ dt: 1e-3, mu: 0.5, materials: { steel: {} },
    walls: [{ mesh: { file: $file, parts: "groups" }, name: "tray" },
            { point: [-2, 0, 0], normal: [1, 0, 0], name: "side" }, { point: [2, 0, 0], normal: [-1, 0, 0], name: "side" },
            { point: [0, 0, -5], normal: [0, 0, 1], material: "steel" }],
    bodies: [{ x: [-0.5, -0.5, 0.1], radius: 0.1, name: "first" }, { x: [0.5, 0.5, 0.2], radius: 0.2, name: "second" },
             { x: [-1.9, 0, 0.6], radius: 0.1, v: [-1, 0, 0], name: "first" }, { x: [1.9, 0, 0.6], radius: 0.1, v: [2, 0, 0], material: "steel" }] }' \
    >"$tmp/scene.json"
nsd-gen "$tmp/scene.json" >"$tmp/start.h5"
step -n 4 --contacts -o "$tmp/run.h5" "$tmp/start.h5"

is "walls have their names, and surfaces those of the file's objects and groups" \
    "$(nsd-info -w "$tmp/start.h5" | jq -c '[.name, .parts]')" \
    '["tray",{"plate":[[0,3]],"left":[[0,0]],"right":[[1,1]]}]
["side",null]
["side",null]
[null,null]'
is "bodies have the names of their groups" "$(nsd-info --last -p "$tmp/run.h5" | jq -r '.group // "-"' | tr '\n' ' ')" 'first second first - '
is "contacts are of a wall, its name or that of its part" \
    "$(nsd-info -s 1 -c "$tmp/run.h5" | jq -c '[.body[1], .wall, .name]' | sort)" \
    '[0,0,"left"]
[1,0,"right"]
[2,1,"side"]
[3,2,"side"]'
is "--only: walls by name or number" "$(nsd-info --last -w --only side,3 "$tmp/run.h5" | jq -c .wall | tr '\n' ' ')" '1 2 3 '
is "a part names the wall that it is of" "$(nsd-info --last -w --only left "$tmp/run.h5" | jq -c .wall)" 0
is "a kind: its walls and its bodies" "$(nsd-info --last -w -p --only steel "$tmp/run.h5" | jq -c '.id // .wall' | tr '\n' ' ')" '3 3 '
is "a group: its bodies" "$(nsd-info --last -p --only first "$tmp/run.h5" | jq -c .id | tr '\n' ' ')" '0 2 '
is "contacts of a part" "$(nsd-info -s 1 -c --only right "$tmp/run.h5" | jq -c .body[1])" 1
refuses 65 "an unknown name" nsd-info -w --only lid "$tmp/run.h5"
like "names what there is" "$(cat "$tmp/err")" "no 'lid' here, but .*tray.*steel, or a wall's number, 0 to 3"
refuses 64 "--only needs -p, -w or -c" nsd-info --only side "$tmp/run.h5"

is "sums by name: several walls sum up, and parts are apart" \
    "$(nsd-stat -s 1 -m boundaries,names "$tmp/run.h5" | jq -c '
        (.boundaries.normal[1] + .boundaries.normal[2]) as $sides | .boundaries.normal[0] as $tray |
        [.names.name, .names.normal] | transpose | map({ (.[0]): .[1] }) | add |
        [((.side - $sides) | fabs) < 1e-9, ((.tray - $tray) | fabs) < 1e-9, ((.left + .right - .plate) | fabs) < 1e-9, .left > 0, .right > .left]')" \
    '[true,true,true,true,true]'
is "nsd-stat --only" "$(nsd-stat -s 1 -m boundaries --only side "$tmp/run.h5" | jq -c '[.boundaries.boundary, .boundaries.name]')" '[[1,2],["side","side"]]'
refuses 65 "an unknown name there" nsd-stat -m boundaries --only lid "$tmp/run.h5"
like "a table has names as words" "$(nsd-stat -s 1 -t -m names "$tmp/run.h5" | cut -f 3 | tr '\n' ' ')" '^name .*side'

# ---- they last ----

names() { h5dump -d /nsd/names/text -d /nsd/names/name -d /nsd/names/boundary -d /nsd/names/faces "$1" | tail -n +2 | md5sum; }
step -n 2 -o "$tmp/half.h5" "$tmp/start.h5" && step -n 2 -o "$tmp/rest.h5" "$tmp/half.h5"
is "a resumed run has them" "$(names "$tmp/rest.h5")" "$(names "$tmp/start.h5")"
nsd-cat --last "$tmp/run.h5" >"$tmp/last.h5"
is "nsd-cat keeps them" "$(names "$tmp/last.h5")" "$(names "$tmp/start.h5")"
nsd-info --scene "$tmp/run.h5" | nsd-gen - 2>/dev/null >"$tmp/again.h5"
is "a scene that goes on from a document has them, and groups" \
    "$(nsd-info -w -p "$tmp/again.h5" | jq -c '[.name, .parts, .group]')" "$(nsd-info --last -w -p "$tmp/run.h5" | jq -c '[.name, .parts, .group]')"
jq -n --arg d "$tmp/run.h5" '{ dt: 1e-3, materials: { steel: {} }, bodies: [{ document: $d }] }' | nsd-gen - >"$tmp/taken.h5"
is "walls and bodies that are taken out of a document bring theirs" \
    "$(nsd-info -w -p "$tmp/taken.h5" | jq -c '[.name, .parts, .group]')" "$(nsd-info --last -w -p "$tmp/run.h5" | jq -c '[.name, .parts, .group]')"
jq '.remove = [{ below: { point: [0, 0, 0.3], normal: [0, 0, 1] } }] | .gravity = [0, 0, 0]' "$tmp/scene.json" | nsd-gen - |
    step -n 3 -o "$tmp/removed.h5"
is "bodies that are removed take theirs with them" "$(nsd-info --last -p "$tmp/removed.h5" | jq -c '[.id, .group]' | tr '\n' ' ')" '[2,"first"] [3,null] '
step -n 2 -o "$tmp/removed2.h5" "$tmp/removed.h5"
is "and a run goes on from there" "$(nsd-info --last -p "$tmp/removed2.h5" | jq -c '[.id, .group]' | tr '\n' ' ')" '[2,"first"] [3,null] '
jq 'del(.walls[].name, .walls[].mesh.parts, .bodies[].name)' "$tmp/scene.json" | nsd-gen - >"$tmp/bare.h5"
ok "a document without names has no dataset of them" eval '! h5ls -r "$tmp/bare.h5" | grep -E "names|group"'
jq '.walls[1].name = .walls[2].name' "$tmp/scene.json" | nsd-gen - | cmp -s - "$tmp/start.h5" && same=0 || same=$?
is "the same scene gives the same bytes" "$same" 0

# ---- unknown names are refused, whatever else the document lacks ----

step -n 4 -o "$tmp/without.h5" "$tmp/start.h5"
jq -n '{ dt: 1e-3, bodies: [{ x: [0, 0, 1], radius: 0.1 }] }' | nsd-gen - >"$tmp/unwalled.h5"
jq 'del(.bodies)' "$tmp/scene.json" | nsd-gen - >"$tmp/empty.h5"
for doc in without unwalled empty bare; do
    for m in $(nsd-stat --list | sed -n 's/^\([a-z_]*\): .*/\1/p'); do
        nsd-stat -m "$m" --only NOSUCH "$tmp/$doc.h5" >"$tmp/out" 2>"$tmp/err" && s=0 || s=$?
        [ "$s" = 65 ] && [ ! -s "$tmp/out" ] && grep -q "no 'NOSUCH' here, but" "$tmp/err" || echo "$m $s"
    done >"$tmp/taken"
    is "nsd-stat --only, $doc: every measure" "$(cat "$tmp/taken")" ""
    refuses 65 "--tracer, $doc" nsd-stat -m fraction --tracer gravel "$tmp/$doc.h5"
    like "and the materials are named" "$(cat "$tmp/err")" "no material 'gravel' here, but large, ball, wall"
    for part in -p -w -c; do refuses 65 "nsd-info $part --only, $doc" nsd-info "$part" --only NOSUCH "$tmp/$doc.h5"; done
    refuses 65 "nsd-export --only, $doc" nsd-export --to csv --part walls --only NOSUCH "$tmp/$doc.h5"
    like "and names are named" "$(cat "$tmp/err")" "no 'NOSUCH' here, but"
    refuses 65 "nsd-view --solid, $doc" nsd-view --solid NOSUCH --surface pressure "$tmp/$doc.h5"
    like "and names are named" "$(cat "$tmp/err")" "no 'NOSUCH' here, but"
done
nsd-detect --fclib=local "$tmp/start.h5" 2>/dev/null >"$tmp/both.h5"
refuses 65 "a document with an FCLIB problem too" nsd-info -c --only NOSUCH "$tmp/both.h5"
refuses 64 "--only with --scene" nsd-info --scene -p --only side "$tmp/run.h5"

if have_ranks; then
    step --solver auto -n 4 --contacts -o "$tmp/once.h5" "$tmp/start.h5"
    ranks 2 nsd-step --solver auto -n 4 --contacts -o "$tmp/ranks.h5" "$tmp/start.h5" 2>/dev/null
    ok "two processes write the bytes of one" cmp "$tmp/ranks.h5" "$tmp/once.h5"
else
    skip "two processes write the bytes of one" "no MPI"
fi
like "messages have them" "$(jq '.bodies = [{ x: [-1.95, 0, 3], radius: 0.1, v: [-50, 0, 0] }] | .allow_overlap = true' "$tmp/scene.json" | nsd-gen - | nsd-step -n 3 2>&1 >/dev/null)" 'wall 1 \(side\)'
jq -n '{ dim: 2, dt: 1e-3, walls: [{ polygon: { points: [[0, 0], [1, 0], [1, 1]], closed: false, parts: [{ name: "slab", faces: [0, 0] }, { name: "slab", faces: [1, 1] }] } }] }' |
    nsd-gen - >"$tmp/plane.h5"
is "ranges of faces in the scene, which join" "$(nsd-info -w "$tmp/plane.h5" | jq -c .parts)" '{"slab":[[0,1]]}'

# ---- refused ----

wall() { jq -n --argjson name "$1" '{ dt: 1, walls: [{ point: [0, 0, 0], normal: [0, 0, 1], name: $name }] }'; }
while IFS='|' read -r name what; do
    wall "$name" >"$tmp/bad.json"
    refuses 65 "a name that $what" nsd-gen "$tmp/bad.json"
done <<'END'
""|is empty
"a,b"|has a comma
"12"|is a number
"a\u001bb"|has a control character
"a\u009bb"|has a control character of the second kind
"a\"b"|has a quote
" a"|begins with a blank
"ball"|is a kind
"0123456789012345678901234567890123456789012345678901234567890"|is too long
7|is no text
END
ok "a name in another script" eval 'wall "\"Gehäuse 2\"" | nsd-gen - | nsd-info -w | jq -e ".name == \"Gehäuse 2\""'
jq '.bodies[0].name = "side"' "$tmp/scene.json" >"$tmp/bad.json"
refuses 65 "one name for a wall and a group" nsd-gen "$tmp/bad.json"
jq '.walls[0].mesh.parts = [{ name: "rim", faces: [2, 4] }]' "$tmp/scene.json" >"$tmp/bad.json"
refuses 65 "faces that are not there" nsd-gen "$tmp/bad.json"
like "says how many there are" "$(cat "$tmp/err")" 'it has 4'
sed 's/left/a,b/' "$tmp/floor.obj" >"$tmp/comma.obj"
jq --arg file "$tmp/comma.obj" '.walls[0].mesh.file = $file' "$tmp/scene.json" >"$tmp/bad.json"
refuses 65 "a group of a file whose name is none" nsd-gen "$tmp/bad.json"
like "says where" "$(cat "$tmp/err")" 'comma.obj: line 8: .*comma'
jq 'del(.walls[0].mesh.parts)' "$tmp/bad.json" | nsd-gen - >/dev/null 2>"$tmp/err" && s=0 || s=$?
is "which does not matter where groups are not asked for" "$s" 0
if $python -c 'import h5py' 2>/dev/null; then
    craft() # what to do with the file f
    {
        $python - "${from:-$tmp/start.h5}" "$tmp/crafted.h5" "$1" <<'END'
import sys, h5py
f = h5py.File(sys.argv[1], "r")
with h5py.File(sys.argv[2], "w") as g:
    for name in f: f.copy(name, g)
    f = g
    exec(sys.argv[3])
END
    }
    while IFS='|' read -r what how; do
        craft "$how"
        refuses 65 "a document with $what" nsd-info -w "$tmp/crafted.h5"
    done <<'END'
a name of no wall|f["nsd/names/boundary"][0] = 9
a row of no name|f["nsd/names/name"][0] = 99
faces that are not there|f["nsd/names/faces"][2] = [3, 7]
a face twice|f["nsd/names/faces"][:] = [[0, 0], [0, 0], [0, 0], [0, 0], [0, 0], [0, 0]][:len(f["nsd/names/faces"])]; f["nsd/names/name"][:] = 0; f["nsd/names/boundary"][:] = 0
a control character in a name|t = f["nsd/names/text"][()]; del f["nsd/names/text"]; f["nsd/names/text"] = t.replace(b"side", b"s\x1bde")
a name twice|t = f["nsd/names/text"][()]; del f["nsd/names/text"]; f["nsd/names/text"] = t.replace(b"right", b"left")
a group without a name|f["particles/all/group"][0] = 77
END
    jq '.remove = [{ name: "first" }] | .pour = [{ rate: 1, opening: { disc: { center: [0, 0, 3], normal: [0, 0, 1], radius: 0.5 } }, radius: 0.1, name: "second" }]' \
        "$tmp/scene.json" | nsd-gen - >"$tmp/flow.h5"
    ok "the document of a scene that pours and removes by name runs" eval 'nsd-step -n 1 "$tmp/flow.h5" >/dev/null 2>&1'
    while IFS='|' read -r what how; do
        from=$tmp/flow.h5 craft "$how"
        refuses 65 "a document whose scene pours or removes by name, $what" nsd-step -n 1 "$tmp/crafted.h5"
    done <<'END'
without the groups of its bodies|del f["particles/all/group"]
without the name|t = f["nsd/names/text"][()]; del f["nsd/names/text"]; f["nsd/names/text"] = t.replace(b"first", b"third")
END
fi
# ---- scenes of version 1 say kind and kinds ----

jq -n '{ dt: 1e-3, gravity: [0, 0, 0], materials: { steel: { density: 7800 } }, walls: [{ point: [0, 0, -1], normal: [0, 0, 1], material: "steel" }],
    bodies: [{ x: [0, 0, 0], radius: 0.1, material: "steel" }, { count: 3, radius: 0.1, material: "steel", box: { x: [1, 2], y: [1, 2], z: [1, 2] } }],
    pour: [{ rate: 1, radius: 0.1, material: "steel", opening: { box: { x: [4, 5], y: [4, 5], z: [4, 5] } } }], remove: [{ material: "steel", from: 1 }] }' >"$tmp/new.json"
sed 's/material/kind/' "$tmp/new.json" >"$tmp/old.json"
ok "the old words are there" grep -q '"kinds"' "$tmp/old.json"
ok "and make the packing of the new ones" cmp <(nsd-gen "$tmp/old.json" | nsd-info -p -w) <(nsd-gen "$tmp/new.json" | nsd-info -p -w)
is "of that material" "$(nsd-gen "$tmp/old.json" | nsd-info -p -w | jq -s -c 'map(.material) | unique')" '["steel"]'
printf '# x y z r kind\n0 0 0 1 steel\n' >"$tmp/old.txt"
is "so does a column of a table of grains" \
    "$(jq --arg f "$tmp/old.txt" '.bodies = [{ file: $f }]' "$tmp/old.json" | nsd-gen - | nsd-info -p | jq -r .material)" steel
done_testing
