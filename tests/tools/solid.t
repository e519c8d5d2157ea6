#!/usr/bin/env bash
# Walls with names in pictures and exports: nsd-view --solid and --surface, the legend of kinds and names, forces and sums
# on nsd-export --part walls and surfaces.
# shellcheck source=tests/support/tap.sh disable=SC2317,SC2054,SC2016 # functions called by name; commas are of the options; eval
. tests/support/tap.sh

view() { nsd-view "$@" 2>/dev/null; }
# A floor of two triangles with a ball on each, the second heavier by 8; and a lid that is a plane's disc
cat >"$tmp/floor.obj" <<'END'
v -1 -1 0
v 1 -1 0
v 1 1 0
v -1 1 0
g left
f 1 2 4
g right
f 2 3 4
END
jq -n --arg file "$tmp/floor.obj" '{ dt: 1e-3, mu: 0.5, materials: { steel: {}, glass: {} },
    walls: [{ mesh: { file: $file, parts: "groups" }, name: "floor", wear: 1e-12 },
            { disc: { center: [0, 0, 2], normal: [0, 0, -1], radius: 0.4 }, name: "lid" }],
    bodies: [{ x: [-0.5, -0.5, 0.1], radius: 0.1, material: "steel" }, { x: [0.5, 0.5, 0.2], radius: 0.2, material: "glass" }] }' |
    nsd-gen - | nsd-step -n 20 --wall-loads --contacts --tolerance 1e-12 -o "$tmp/run.h5" 2>/dev/null

# ---- pictures: the colours of points whose faces are known ----

pixel() # FILE X Y: r g b
{
    py - "$@" <<'END'
import struct, sys, zlib
data = open(sys.argv[1], "rb").read()
at, parts = 8, b""
while at < len(data):
    n, kind = struct.unpack(">I4s", data[at:at + 8])
    if kind == b"IHDR": w, h = struct.unpack(">II", data[at + 8:at + 16])
    if kind == b"IDAT": parts += data[at + 8:at + 8 + n]
    at += 12 + n
raw, line, rows = zlib.decompress(parts), 3 * w + 1, []
for y in range(h):
    f, row = raw[line * y], bytearray(raw[line * y + 1:line * (y + 1)])
    for i in range(3 * w):
        a, b = (row[i - 3] if i > 2 else 0), (rows[-1][i] if rows else 0)
        c = rows[-1][i - 3] if rows and i > 2 else 0
        p = a + b - c
        paeth = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
        row[i] = (row[i] + (0, a, b, (a + b) // 2, paeth)[f]) & 255
    rows.append(row)
x, y = int(sys.argv[2]), int(sys.argv[3])
print(*rows[y][3 * x:3 * x + 3])
END
}
look=(--bare --camera 0,90 --box -1,1,-1,1,-0.1,0.5 --size 200x200)
view "${look[@]}" --solid left "$tmp/run.h5" >"$tmp/left.png"
view "${look[@]}" --solid floor "$tmp/run.h5" >"$tmp/floor.png"
view "${look[@]}" --surface pressure "$tmp/run.h5" >"$tmp/pressure.png"
view "${look[@]}" --solid floor --surface pressure --surface-range 0,1000000000 "$tmp/run.h5" >"$tmp/dark.png"
view "${look[@]}" "$tmp/run.h5" >"$tmp/glass.png"
# corners of the picture: lower left is of the first triangle, upper right of the second; both away from the balls
read -r a1 _ a3 < <(pixel "$tmp/left.png" 20 150) && read -r b1 _ b3 < <(pixel "$tmp/left.png" 180 50)
read -r c1 _ c3 < <(pixel "$tmp/floor.png" 180 50)
is "a part is solid, and its neighbour is not" "$((a1 > a3 + 30)) $((b1 > b3 + 30))" '1 0'
is "a name that is the whole wall's: both are" "$((c1 > c3 + 30))" 1
read -r d1 _ d3 < <(pixel "$tmp/pressure.png" 20 150) && read -r e1 e2 e3 < <(pixel "$tmp/pressure.png" 180 50)
is "the largest pressure is yellow, an eighth of it is violet or blue" "$((e1 > e3 && e2 > e3)) $((d3 > d1))" '1 1'
read -r f1 _ f3 < <(pixel "$tmp/dark.png" 180 50)
is "--surface-range" "$((f3 > f1))" 1
ok "without them pictures are as before: glass" eval '! cmp -s "$tmp/glass.png" "$tmp/left.png"'
ok "threads do not change a picture" cmp "$tmp/floor.png" <(view "${look[@]}" -j 2 --solid floor "$tmp/run.h5")
ok "--walls lines leaves solid ones" eval 'view "${look[@]}" --walls lines --solid left "$tmp/run.h5" >"$tmp/lines.png" && read -r g1 _ g3 < <(pixel "$tmp/lines.png" 20 150) && [ "$g1" -gt "$((g3 + 30))" ]'
height() { od -An -j 20 -N 4 -t u1 --endian=big "$1" | awk '{ print $3 * 256 + $4 }'; }
view --size 400x400 -c material "$tmp/run.h5" >"$tmp/kinds.png"
view --size 400x400 -c material --solid floor "$tmp/run.h5" >"$tmp/both.png"
is "pictures have the size that is asked for, with one row of legend or two" "$(height "$tmp/kinds.png") $(height "$tmp/both.png")" '400 400'
jq -n '{ dt: 1e-3, bodies: [{ x: [-0.5, 0, 0], radius: 0.4, name: "a" }, { x: [0.5, 0, 0], radius: 0.4, name: "b" }, { x: [0, 0, 0.8], radius: 0.3 }] }' | nsd-gen - >"$tmp/groups.h5"
view --bare --plain -c group --camera 0,90 --box -1,1,-1,1,-1,1 --size 200x200 "$tmp/groups.h5" >"$tmp/groups.png"
read -r h1 _ h3 < <(pixel "$tmp/groups.png" 40 100) && read -r i1 _ i3 < <(pixel "$tmp/groups.png" 165 100)
is "groups have colours of their own" "$((h3 > h1 + 30)) $((i1 > i3 + 30))" '1 1'
refuses 65 "a name that is not there" nsd-view --solid lids "$tmp/run.h5"
like "lists what is there" "$(cat "$tmp/err")" 'lids.*floor, lid, left, right'
refuses 64 "a range the wrong way round" nsd-view --solid floor --surface-range 2,1 "$tmp/run.h5"
nsd-gen -d 2 10 >"$tmp/discs.h5"
refuses 64 "in the plane boundaries are lines" nsd-view --solid 0 "$tmp/discs.h5"
nsd-gen 10 >"$tmp/none.h5"
refuses 65 "colours by sums that there are not" nsd-view --surface sliding_work "$tmp/none.h5"
like "says what keeps them" "$(cat "$tmp/err")" 'nsd-step --wall-loads'

# ---- exports ----

export_() { nsd-export --to csv --last --part walls "$@" "$tmp/run.h5" 2>/dev/null; }
column() { awk -F, -v name="$1" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) k = i } NR > 1 && k { print $k }'; }
g=$(nsd-info --last -p "$tmp/run.h5" | jq -s -r 'map(.mass * 9.81) | @tsv')
export_ >"$tmp/boundary.csv"
is "forces of contacts stand at their faces: weights" "$(export_ --only floor | column contact_force_z | awk '{ printf "%.6f ", -$1 }')" "$(awk '{ printf "%.6f %.6f ", $1, $2 }' <<<"$g")"
is "how many contacts push" "$(export_ --only floor | column contacts | paste -sd' ')" '1 1'
is "mean forces of the run, from the sums" "$(export_ --only floor | column mean_force_z | awk '{ printf "%.4f ", -$1 }')" "$(awk '{ printf "%.4f %.4f ", $1, $2 }' <<<"$g")"
is "and pressures, on 2 m2 each" "$(export_ --only floor | column mean_pressure | awk '{ printf "%.4f ", $1 }')" "$(awk '{ printf "%.4f %.4f ", $1 / 2, $2 / 2 }' <<<"$g")"
is "--only a part: its faces" "$(export_ --only right | column face)" 1
is "the columns of wear" "$(export_ --only lid | column wear | sort -u)" 0
refuses 65 "grains have no names of walls" nsd-export --to csv --only floor "$tmp/run.h5"
refuses 65 "a name that is not there" nsd-export --to csv --part walls --only lids --last "$tmp/run.h5"
jq -n '{ dt: 1e-3, shapes: { box: { box: [0.2, 0.2, 0.2] } }, walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }], bodies: [{ x: [0, 0, 0.1], shape: "box", size: 1 }] }' |
    nsd-gen - | nsd-step -n 5 --contacts --tolerance 1e-12 -o "$tmp/box.h5" 2>/dev/null
is "surfaces have the force of contacts on their grain" \
    "$(nsd-export --to csv --last --part surfaces "$tmp/box.h5" | column contact_force_z | sort -u | awk '{ printf "%.4f ", $1 }')" \
    "$(nsd-info --last -p "$tmp/box.h5" | jq -r '.mass * 9.81' | awk '{ printf "%.4f ", $1 }')"
done_testing
