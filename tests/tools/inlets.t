#!/usr/bin/env bash
# Inlets and outlets in periodic cells; removal by id, by kind, by name, in time; random starts that fill a cell; the height
# that a group needs. Sums of what comes and goes, resuming, threads, ranks, hostile scenes.
# shellcheck source=tests/support/tap.sh disable=SC2016,SC2094 # jq programs; names of tests with what is read
. tests/support/tap.sh

step() { nsd-step "$@" 2>/dev/null; }
holds() { jq -e "$@" >/dev/null; }

# ---- pours and removals in a cell that is sheared: grains rain through it ----

cat >"$tmp/rain.json" <<'END'
{ "dt": 5e-4, "mu": 0.3, "gravity": [0, 0, -9.81], "seed": 3,
  "materials": { "sand": {}, "iron": { "density": 7800 } },
  "cell": { "lengths": [0.03, 0.03, 1], "repeats": [true, true, false], "gradient": [[0, 0.5, 0], [0, 0, 0], [0, 0, 0]] },
  "bodies": [{ "random": { "phi": 0.002 }, "radius": 1.5e-3, "material": "iron" }],
  "pour": [{ "rate": 2000, "opening": { "box": { "x": [-0.01, 0.04], "y": [0, 0.03], "z": [0.5, 0.52] } },
             "radius": { "uniform": [1e-3, 2e-3] }, "v": [0, 0, -1], "material": "sand", "until": 0.15 }],
  "remove": [{ "below": { "point": [0, 0, 0.35], "normal": [0, 0, 1] }, "material": "sand" },
             { "inside": { "x": [0, 0.01] }, "material": "sand", "from": 0.1, "until": 0.1024 }] }
END
nsd-gen "$tmp/rain.json" >"$tmp/rain.h5"
step -n 400 --every 40 -o "$tmp/out.h5" "$tmp/rain.h5"
nsd-info --events "$tmp/out.h5" >"$tmp/events"
counts=$(nsd-info --last "$tmp/out.h5" | jq -c 'select(.poured) | [.poured[0].bodies, .removed[0].bodies, .removed[1].bodies]')
ok "300 grains are poured into a sheared cell, as many as are due: $counts" holds '.[0] > 270 and .[0] <= 301 and .[1] > 50 and .[2] > 5' <<<"$counts"
first=$(nsd-info -p "$tmp/rain.h5" | jq -s 'map(select(.radius)) | length')
ok "bodies are those at the start, and what came, without what has gone" \
    holds ". == $first + $(jq '.[0] - .[1] - .[2]' <<<"$counts")" < <(nsd-info --last "$tmp/out.h5" | jq 'select(.bodies).bodies')
ok "those that go by the region are in it, at the time of it, in the cell" \
    holds -s 'map(select(.event == "removed" and .by == 1)) | length > 5 and all(.[]; .time >= 0.1 - 1e-9 and .time <= 0.1024 + 1e-9)' <"$tmp/events"
step -n 150 --every 150 -o "$tmp/half.h5" "$tmp/rain.h5"
step -n 250 --every 250 -o "$tmp/rest.h5" "$tmp/half.h5"
ok "a run resumes to the bit" cmp <(nsd-info --last -p "$tmp/rest.h5") <(nsd-info --last -p "$tmp/out.h5")
step -j 4 -n 400 --every 40 -o "$tmp/j4.h5" "$tmp/rain.h5"
ok "4 threads give the bytes of one" cmp "$tmp/j4.h5" "$tmp/out.h5"
step -n 400 --every 40 "$tmp/rain.h5" | nsd-cat >"$tmp/stream.h5"
ok "a stream packed is the trajectory, byte for byte" cmp "$tmp/stream.h5" "$tmp/out.h5"
if have_ranks; then
    step --solver auto -n 400 --every 40 -o "$tmp/once.h5" "$tmp/rain.h5"
    ranks 3 nsd-step --solver auto -n 400 --every 40 -o "$tmp/ranks.h5" "$tmp/rain.h5" >/dev/null 2>&1 || true
    ok "3 processes give the bytes of one" cmp "$tmp/ranks.h5" "$tmp/once.h5"
else
    skip "3 processes give the bytes of one" "no MPI"
fi

# A grain waits where an image is in its way: one that fills the opening across the border
jq -n '{ dim: 2, dt: 1e-3, gravity: [0, 0], cell: { lengths: [1, 1] }, bodies: [{ x: [0.95, 0.5], radius: 0.1 }],
    pour: [{ rate: 1e6, count: 1, opening: { box: { x: [0, 0.01], y: [0.49, 0.51] } }, radius: 0.01 }] }' | nsd-gen - |
    step -n 5 | nsd-info --last - | jq -c 'select(.poured).poured[0].bodies' >"$tmp/poured"
is "nothing comes in where the image of a grain is" "$(cat "$tmp/poured")" 0

# ---- removal by id, by kind, in time ----

jq -n '{ dim: 2, dt: 1, gravity: [0, 0], materials: { a: {}, b: {} }, bodies: [range(6) | { x: [., 0], radius: 0.1, material: (if . % 2 == 0 then "a" else "b" end) }] }' >"$tmp/six.json"
left() # REMOVALS STEPS: ids that are left
{
    jq --argjson r "$1" '.remove = $r' "$tmp/six.json" | nsd-gen - | step -n "$2" --every "$2" | nsd-info --last -p - | jq -s -c 'map(select(.id != null).id)'
}
is "by id, one" "$(left '[{"id": 3}]' 1)" '[0,1,2,4,5]'
is "several, and one that is not there" "$(left '[{"id": [5, 0, 77]}]' 1)" '[1,2,3,4]'
is "by kind" "$(left '[{"material": "a"}]' 1)" '[1,3,5]'
is "by kind, id and place together" "$(left '[{"material": "a", "id": [0, 1, 4], "inside": {"x": [1, 9]}}]' 1)" '[0,1,2,3,5]'
is "not before its time" "$(left '[{"material": "a", "from": 3}]' 3)" '[0,1,2,3,4,5]'
is "from its time on" "$(left '[{"material": "a", "from": 3}]' 4)" '[1,3,5]'
is "not after its end" "$(left '[{"id": 1, "from": 2, "until": 2.5}, {"id": 2, "from": 2.2, "until": 2.5}]' 6)" '[0,2,3,4,5]'

bad() # "what is true" FILE FILTER REGEX
{
    jq "$3" "$tmp/$2.json" >"$tmp/bad.json"
    refuses 65 "$1" nsd-gen "$tmp/bad.json"
    like "and where, and the cure" "$(cat "$tmp/err")" "$4"
}
bad "a removal of nothing said is refused" six '.remove = [{}]' 'remove\[0\]: needs at least one of the keys outside inside below material id name'
bad "an id that is a word is refused" six '.remove = [{id: "x"}]' 'remove\[0\].id: '
bad "no ids are refused" six '.remove = [{id: []}]' 'remove\[0\].id: needs the numbers'
bad "an end before the beginning is refused" six '.remove = [{id: 1, from: 2, until: 1}]' 'remove\[0\].until: must not lie before'

# ---- removal by name; pours that have one ----

cat >"$tmp/named.json" <<'END'
{ "dt": 5e-4, "mu": 0.3, "gravity": [0, 0, -9.81], "seed": 3,
  "walls": [{ "box": { "x": [0, 0.03], "y": [0, 0.03], "z": [0, null] }, "name": "tray" }],
  "bodies": [{ "x": [0.015, 0.015, 0.002], "radius": 2e-3, "name": "old" }, { "x": [0.005, 0.005, 0.002], "radius": 2e-3 }],
  "pour": [{ "rate": 500, "opening": { "box": { "x": [0.003, 0.027], "y": [0.003, 0.027], "z": [0.03, 0.04] } },
             "radius": 1.5e-3, "name": "new", "until": 0.1 },
           { "rate": 300, "opening": { "box": { "x": [0.003, 0.027], "y": [0.003, 0.027], "z": [0.05, 0.06] } },
             "radius": 1e-3, "name": "old", "until": 0.1 }],
  "remove": [{ "name": "new", "from": 0.15, "inside": { "x": [0, 0.015] } },
             { "name": "old", "from": 0.2 }] }
END
nsd-gen "$tmp/named.json" >"$tmp/named.h5"
step -n 420 --every 20 -o "$tmp/named_run.h5" "$tmp/named.h5"
groups() { nsd-info "${@:2}" -p "$1" | jq -s -c 'map(select(.id != null).group // "-") | group_by(.) | map({ (.[0]): length }) | add'; }
is "the grains of a pour have its name, as bodies of a group: 51, and 31 with the one that there was" \
    "$(groups "$tmp/named_run.h5" -s 220)" '{"-":1,"new":51,"old":32}'
is "a group goes where and when its removal says: none is left of one, of the other none in the box" \
    "$(nsd-info --last -p "$tmp/named_run.h5" | jq -s -c 'map(select(.id != null)) | [any(.[]; .group == "old"), any(.[]; .group == "new" and .x[0] < 0.0149), any(.[]; .group == "new"), any(.[]; .group == null)]')" \
    '[false,false,true,true]'
is "all that were of it are counted" "$(nsd-info --last "$tmp/named_run.h5" | jq -c 'select(.removed).removed[1].bodies')" 32
is "--only: what has come by name" "$(nsd-info -s 220 -p --only new "$tmp/named_run.h5" | jq -s 'map(select(.id != null)) | length')" 51
for cut in 60 250 402; do
    step -n "$cut" --every "$cut" -o "$tmp/named_half.h5" "$tmp/named.h5"
    step -n $((420 - cut)) --every $((420 - cut)) -o "$tmp/named_rest.h5" "$tmp/named_half.h5"
    ok "a run that resumes at step $cut has the same bodies and groups, to the bit" \
        cmp <(nsd-info --last -p "$tmp/named_rest.h5") <(nsd-info --last -p "$tmp/named_run.h5")
done
step -j 4 -n 420 --every 20 -o "$tmp/named_j4.h5" "$tmp/named.h5"
ok "4 threads give the bytes of one, names too" cmp "$tmp/named_j4.h5" "$tmp/named_run.h5"
if have_ranks; then
    step --solver auto -n 420 --every 20 -o "$tmp/named_once.h5" "$tmp/named.h5"
    ranks 3 nsd-step --solver auto -n 420 --every 20 -o "$tmp/named_ranks.h5" "$tmp/named.h5" >/dev/null 2>&1 || true
    ok "3 processes give the bytes of one, names too" cmp "$tmp/named_ranks.h5" "$tmp/named_once.h5"
else
    skip "3 processes give the bytes of one, names too" "no MPI"
fi
nsd-info --scene "$tmp/named_run.h5" | nsd-gen - >"$tmp/named_again.h5" 2>"$tmp/err" && s=0 || s=$?
is "a scene goes on from a document that has no body of the name any more" "$s" 0
# poured by halves: by nsd-step alone and by the scene of the first half
jq -n '{ dt: 1e-3, mu: 0.4, walls: [{ box: { x: [0, 0.3], y: [0, 0.3], z: [0, null] } }], remove: [{ inside: { z: [null, -1] } }],
    pour: [{ rate: 100, count: 60, radius: { uniform: [0.01, 0.02] }, opening: { box: { x: [0.05, 0.25], y: [0.05, 0.25], z: [0.5, 1.5] } } }] }' | nsd-gen - >"$tmp/pours.h5"
step -n 250 --every 250 -o "$tmp/half.h5" "$tmp/pours.h5"
step -n 450 --every 450 -o "$tmp/on.h5" "$tmp/half.h5"
nsd-info --scene "$tmp/half.h5" | nsd-gen - 2>"$tmp/err" | step -n 450 --every 450 -o "$tmp/by_scene.h5"
is "a pour continued by its scene brings the grains that are left, as it would" "$(nsd-info --last -p "$tmp/by_scene.h5" | jq -sc 'map([.id, .radius])')" \
    "$(nsd-info --last -p "$tmp/on.h5" | jq -sc 'map([.id, .radius])')"
is "which are 60, and nothing is said" "$(nsd-info --last "$tmp/by_scene.h5" | jq .bodies) $(cat "$tmp/err")" "60 "
nsd-info --scene "$tmp/half.h5" | jq 'del(.pour[0].poured)' | nsd-gen - 2>"$tmp/err" >/dev/null
like "a pour that begins again is reported" "$(cat "$tmp/err")" "half.h5: the pours begin again from 0"
# a document's names come after the scene's: the rows are others
jq -n --arg d "$tmp/named_half.h5" '{ dt: 5e-4, walls: [{ point: [0, 0, 0], normal: [0, 0, 1], name: "floor" }],
    bodies: [{ document: $d }], remove: [{ name: "new" }, { name: "old" }] }' >"$tmp/taken.json"
is "a removal names groups of a document, one without a body left" "$(nsd-gen "$tmp/taken.json" | step -n 1 | nsd-info --last -p - | jq -s 'map(select(.group == "new")) | length')" 0
bad "a removal of an unknown name" named '.remove[0].name = "newer"' 'remove\[0\].name: no group of bodies and no pour has the name "newer"'
bad "a removal by the name of a wall" named '.remove[0].name = "tray"' 'remove\[0\].name: no group of bodies and no pour has the name "tray"'
bad "a removal by a name that is a kind" named '.remove[0].name = "ball"' 'remove\[0\].name: "ball" is a material'
bad "a pour with the name of a wall" named '.pour[0].name = "tray"' '"tray" is the name of a wall and of a group'
bad "a pour with a name that is none" named '.pour[0].name = "1"' 'pour\[0\].name: a name is a number'

# ---- random starts that fill a cell ----

fills() # PHI DIM CELL: the solid fraction, and whether any two images overlap
{
    jq -n --argjson phi "$1" --argjson dim "$2" --argjson cell "$3" '{ dim: $dim, dt: 1e-3, gravity: [range($dim) | 0], cell: $cell,
        bodies: [{ random: { phi: $phi }, radius: { uniform: [2e-3, 3e-3] } }] }' | nsd-gen - >"$tmp/full.h5"
    nsd-stat -m fraction "$tmp/full.h5" | jq '.fraction.fraction'
    nsd-detect "$tmp/full.h5" | nsd-info -c | jq -s 'map(select(.gap < -1e-9)) | length'
}
while read -r what phi dim cell; do
    mapfile -t got < <(fills "$phi" "$dim" "$cell")
    ok "$what: a fraction of $phi, to half a grain, and no overlap: ${got[*]}" \
        holds ". - $phi | fabs < 0.006" <<<"${got[0]}"
    is "$what: no two overlap, images included" "${got[1]}" 0
done <<'END'
small,cell 0.55 3 {"lengths":[0.03,0.03,0.03]}
discs 0.8 2 {"lengths":[0.06,0.06]}
oblique 0.5 3 {"edges":[[0.03,0,0],[0.012,0.03,0],[0,-0.01,0.03]]}
loose 0.2 2 {"edges":[[0.06,0],[0.03,0.06]]}
slab 0.5 3 {"lengths":[0.03,0.03,0.04],"repeats":[true,true,false]}
END
fills 0.5 3 '{"lengths":[0.03,0.03,0.03]}' >/dev/null
cp "$tmp/full.h5" "$tmp/once.h5"
fills 0.5 3 '{"lengths":[0.03,0.03,0.03]}' >/dev/null
ok "the same scene gives the same bytes" cmp "$tmp/full.h5" "$tmp/once.h5"
# the distribution across the border is that within: no layer of centres is missing
fills 0.45 3 '{"lengths":[0.04,0.04,0.04]}' >/dev/null
ok "as many centres near the border as elsewhere, to 5 sigma" \
    holds -s 'map(select(.radius).x[0]) | length as $n | (map(select(. < 0.004 or . > 0.036)) | length) as $near | ($near - 0.2 * $n | fabs) < 5 * (0.16 * $n | sqrt)' \
    < <(nsd-info -p "$tmp/full.h5")

# ---- the height that a group needs ----

jq -n '{ dt: 1e-3, bodies: [{ count: 100, radius: 1e-3, spacing: 1, box: { x: [0, 0.01], y: [0, 0.01], z: [0, 0.02] } }] }' >"$tmp/tall.json"
like "a lattice: four layers of 25" "$(nsd-gen --check "$tmp/tall.json" 2>/dev/null | jq '.heights[0].height * 1e6 | round')" '^8000$'
bad "too many are refused" tall '.bodies[0].count = 1000' 'they need a height of 0.08 m along z'
bad "too many in cells of their own" tall '.bodies[0] |= (.count = 1000 | .cells = "own")' 'they need a height of 0.08 m along z'
bad "too many at random" tall '.bodies[0] = {random: {count: 1000}, radius: 1e-3, box: .bodies[0].box}' 'cannot fill .* of its box.*: at 0.6 it is 0.069[0-9]* m high'
like "a random start: its volume over that of a floor at 0.6" \
    "$(jq '.bodies[0] = {random: {count: 100}, radius: 1e-3, box: .bodies[0].box}' "$tmp/tall.json" | nsd-gen --check - 2>/dev/null |
        jq '.heights[0].height / (100 * 4.18879e-9 / (0.6 * 1e-4)) - 1 | fabs < 1e-4')" true
done_testing
