#!/usr/bin/env bash
# The measure silhouette: closed forms of projected shapes, a brute force over pixels, photographs.
# shellcheck source=tests/support/tap.sh disable=SC2317,SC2016 # functions called by name; text for eval
. tests/support/tap.sh

cd "$tmp"
window=--window=-0.04,0.04,-0.03,0.05
value() { nsd-stat -m silhouette "$@" | tail -n 1 | jq -c ".silhouette.$name"; }
near() { jq -en "($1 - $2 | fabs) <= $3 * ($2 | fabs)"; }
name=area

# ---- one grain of each shape: the area of its projection ----

scene() { jq -n "{ dt: 1e-3, gravity: [0, 0, 0], shapes: $1, bodies: [$2] }" | nsd-gen - >one.h5; }
scene '{ c: { capsule: { length: 0.03, radius: 0.01 } }, b: { box: [0.02, 0.03, 0.04] } }' '{ x: [0, 0, 0.005], radius: 0.02 }'
ok "a ball" near "$(value "$window" --pixels 800 one.h5)" "$(jq -n '3.14159265 * 4e-4')" 2e-3
scene '{ c: { capsule: { length: 0.03, radius: 0.01 } } }' '{ x: [0, 0, 0.005], shape: "c" }'
is "of a capsule, along its axis or across it" \
    "$(for axis in x y z; do jq -n "$(value "$window" --view $axis --pixels 800 one.h5) * 1e6 | round"; done | sort -n | tr '\n' ' ')" \
    "$(jq -n -j '[3.14159265 * 100, 2 * 10 * 30 + 3.14159265 * 100, 2 * 10 * 30 + 3.14159265 * 100] | map(round | tostring + " ") | add')"
scene '{ b: { box: [0.02, 0.03, 0.04] } }' '{ x: [0, 0, 0.005], shape: "b" }'
is "of a box, along its edges" "$(for axis in x y z; do jq -n "$(value "$window" --view $axis --pixels 800 one.h5) * 1e6 | round"; done | sort -n | tr '\n' ' ')" "600 800 1200 "
scene '{ t: { balls: [[0, 0, -0.012, 0.01], [0, 0, 0.012, 0.01]] } }' '{ x: [0, 0, 0.005], shape: "t", radius: 0.022 }'
ok "of a clump of two balls that are apart" near "$(for axis in x y z; do value "$window" --view $axis --pixels 800 one.h5; done | sort -g | tail -n 1)" "$(jq -n '2 * 3.14159265 * 1e-4')" 2e-2
jq -n '{ dim: 2, dt: 1e-3, gravity: [0, 0], bodies: [{ x: [0, 0.005], radius: 0.02 }] }' | nsd-gen - >disc.h5
ok "in the plane" near "$(value "$window" --pixels 800 disc.h5)" "$(jq -n '3.14159265 * 4e-4')" 2e-3

# ---- many: brute force ----

jq -n '{ dt: 1e-3, mu: 0.5, seed: 3, walls: [{ point: [0, 0, -0.03], normal: [0, 0, 1] }],
    bodies: [{ random: { count: 200 }, radius: { uniform: [1e-3, 2e-3] }, box: { x: [-0.03, 0.03], y: [0, 0.02], z: [-0.03, 0] } }] }' |
    nsd-gen - | nsd-step -n 40 --every 20 -o run.h5 2>/dev/null
if has scipy && have_h5py; then
    py - >brute <<'EOF'
import h5py, numpy as np
from scipy.ndimage import grey_closing
f = h5py.File("run.h5")
x, r = f["particles/all/position/value"][:], f["particles/all/radius"][:]
g = (np.arange(400) + 0.5) * 0.08 / 400
counts = np.zeros((400, 400))
for frame in x:
    for p, s in zip(frame, r):
        counts += (g[None, :] - 0.04 - p[0]) ** 2 + (g[:, None] - 0.03 - p[2]) ** 2 <= s * s
inside = np.hypot(g[None, :] - 0.04, g[:, None] - 0.03) <= 0.025
photo = ((g[:, None] - 0.03 < -0.5 * (g[None, :] - 0.04) - 0.01) * 200 + 20).astype(np.uint8)  # darkness, the lowest row first
def covered(a, cut):
    return (grey_closing(np.where(inside, a, 0).astype(np.uint8), (7, 7)) > cut) & inside
s = covered(counts / counts[inside].max() * 255, 10)
e = covered(photo, 30)
pixel = (0.08 / 400) ** 2
for n in s.sum(), e.sum(), (s != e).sum(), (s & ~e).sum(), (e & ~s).sum(), (s != e[:, ::-1]).sum():
    print(repr(float(n * pixel)))
with open("photo.pgm", "wb") as out:
    out.write(b"P5 400 400 255\n" + (255 - photo[::-1]).tobytes())
import struct, zlib
rows = b"".join(b"\0" + row.tobytes() for row in 255 - photo[::-1])
chunk = lambda k, d: struct.pack(">I", len(d)) + k + d + struct.pack(">I", zlib.crc32(k + d))
with open("photo.png", "wb") as out:
    out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 400, 400, 8, 0, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
EOF
    compared=(-m silhouette "$window" --photo photo.png --radius 0.025)
    nsd-stat "${compared[@]}" --silhouette both.png run.h5 >run.json
    k=0
    for name in area photo differ surplus missing mirrored; do
        k=$((k + 1))
        ok "$name, by brute force" near "$(tail -n 1 run.json | jq ".silhouette.$name")" "$(sed -n ${k}p brute)" 1e-12
    done
    like "the picture" "$(file both.png 2>/dev/null || head -c 4 both.png | tail -c 3)" PNG
    is "frames of a stream, too" "$(nsd-cat run.h5 | nsd-stat "${compared[@]}" | tail -n 1)" "$(tail -n 1 run.json)"
    refuses 64 "the picture over the photograph" nsd-stat "${compared[@]}" --silhouette photo.png run.h5
    head -c $(($(wc -c <photo.png) / 2)) photo.png >cut.png
    refuses 64 "a photograph that is cut short" nsd-stat -m silhouette "$window" --photo cut.png run.h5
    refuses 64 "one of another format" nsd-stat -m silhouette "$window" --photo photo.pgm run.h5
else
    skip "brute force" "no scipy or no h5py"
fi
name=area
is "without a window" "$(nsd-stat -m silhouette run.h5 | jq -r '.why.silhouette' | sort -u)" "the picture has no edges: give --window"
refuses 64 "an empty window" nsd-stat -m silhouette --window 1,0,0,1 run.h5
refuses 64 "no axis" nsd-stat -m silhouette --view w run.h5
refuses 64 "a missing photograph" nsd-stat -m silhouette "$window" --photo none.png run.h5
refuses 64 "the input is no picture to write" nsd-stat "$window" --silhouette run.h5 run.h5
done_testing
