#!/usr/bin/env bash
# Boundaries of all shapes and their drives, through the tools: scenes and their faults, the pipeline,
# threads, resuming, documents, meshes from files, pictures.
. tests/support/tap.sh

thin=${NSD_THIN-}
steps=$((thin ? 200 : 300))
step() { nsd-step "$@" 2>/dev/null; }
numbers() { py - "$@"; }
if ! has h5py; then echo "1..0 # SKIP no h5py"; exit; fi

# ---- a drum of each kind: of a cylinder, and of 10 000 triangles in a file ----

mkdir "$tmp/scene"
numbers "$tmp/scene/drum.stl" <<'END'
import math, struct, sys
n, m, R, L = 100, 50, 0.05, 0.06
def at(i, j):
    a = 2 * math.pi * (i % n) / n
    return R * math.cos(a), -L / 2 + L * j / m, R * math.sin(a)
with open(sys.argv[1], "wb") as f:
    f.write(b"drum".ljust(80) + struct.pack("<I", 2 * n * m))
    for i in range(n):
        for j in range(m):
            for t in ((at(i, j), at(i + 1, j), at(i + 1, j + 1)), (at(i, j), at(i + 1, j + 1), at(i, j + 1))):
                f.write(struct.pack("<12fH", 0, 0, 0, *[x for p in t for x in p], 0))
END
jq -n '{ dt: 2e-4, mu: 0.5, density: 2500,
    walls: [{ mesh: { file: "drum.stl" } }, { disc: { center: [0, -0.03, 0], normal: [0, 1, 0], radius: 0.05 } },
            { disc: { center: [0, 0.03, 0], normal: [0, 1, 0], radius: 0.05 } }],
    bodies: [{ count: 400, radius: { uniform: [0.0015, 0.0021] },
               box: { x: [-0.033, 0.033], y: [-0.03, 0.03], z: [-0.033, 0.033] } }] } |
    .walls[].drives = [{ about: [0, 0, 0], axis: [0, 1, 0], speed: 3 }]' >"$tmp/scene/mesh.json"
jq '.walls[0] = { cylinder: { point: [0, -0.03, 0], axis: [0, 1, 0], radius: 0.05, length: 0.06 },
    drives: .walls[0].drives }' "$tmp/scene/mesh.json" >"$tmp/scene/drum.json"
for k in mesh drum; do
    nsd-gen "$tmp/scene/$k.json" >"$tmp/$k.h5"
    step -n $((3 * steps)) --every 10 "$tmp/$k.h5" >"$tmp/$k-out.h5"
done
is "the triangles are read from a file" "$(nsd-info -w "$tmp/mesh.h5" | jq -r .shape | head -n 1)" mesh
ok "balls stay in a drum of triangles, and do what they do in a cylinder" numbers "$tmp/mesh-out.h5" "$tmp/drum-out.h5" <<'END'
import sys, h5py, numpy as np
heights = []
for name in sys.argv[1:]:
    f = h5py.File(name)
    x, r = f["particles/all/position/value"][:], f["particles/all/radius"][:]
    assert (np.hypot(x[..., 0], x[..., 2]) + r).max() < 0.05 * 1.002
    assert (abs(x[..., 1]) + r).max() < 0.03 * 1.002
    heights.append(x[-1].mean(0))
assert np.abs(heights[0] - heights[1]).max() < 1e-3, heights
END
ok "the work of drives and gravity is energy and what friction took" numbers "$tmp/drum-out.h5" "$tmp/mesh-out.h5" <<'END'
import sys, h5py, numpy as np
for name in sys.argv[1:]:
    s = h5py.File(name)["nsd/solver"]
    v = lambda n: s[n + "/value"][:]
    off = v("work_drives") + v("work_gravity") - v("dissipation") - v("kinetic_change")
    assert np.abs(off).max() < 1e-13 and np.abs(v("work_drives")).max() > 1e-9
END
step -n 30 "$tmp/drum-out.h5" >"$tmp/each.h5"
ok "momentum is what gravity and the boundaries give" numbers "$tmp/each.h5" <<'END'
import sys, h5py, numpy as np
f = h5py.File(sys.argv[1])
p, b = [f["nsd/solver/" + n + "/value"][:] for n in ("momentum", "boundary_impulse")]
weight = f["particles/all/mass"][:].sum() * f["nsd"].attrs["gravity"] * f["nsd"].attrs["dt"]
assert np.abs(np.diff(p, axis=0) - b[1:] - weight).max() < 1e-12 * np.abs(weight).max() * 100
assert np.abs(b).max() > 0.1 * np.abs(weight).max()
END
ok "positions of boundaries are there as those of grains are" numbers "$tmp/drum-out.h5" <<'END'
import sys, h5py, numpy as np
f = h5py.File(sys.argv[1])
b, t = f["particles/boundary"], f["particles/boundary/orientation/time"][:]
q = b["orientation/value"][:, 0]
half = 1.5 * t
assert np.allclose(np.abs(q[:, 0]), np.abs(np.cos(half)), atol=1e-12)
assert np.allclose(np.abs(q[:, 2]), np.abs(np.sin(half)), atol=1e-12)
assert np.allclose(b["angular_velocity/value"][:, 0], [0, 3, 0])
assert b["position/value"].shape == (len(t), 3, 3)
END
step -n $steps --every $steps "$tmp/drum.h5" | nsd-cat --last >"$tmp/last.h5"
step -n $steps --every $steps "$tmp/mesh.h5" | nsd-cat --last >"$tmp/last-mesh.h5"

# ---- the pipeline, threads, resuming ----

for k in last last-mesh; do
    nsd-detect "$tmp/$k.h5" | nsd-solve 2>/dev/null | nsd-move >"$tmp/parts.h5"
    step --solver auto -n 1 "$tmp/$k.h5" | cat >"$tmp/whole.h5"
    ok "detect | solve | move is nsd-step, $k" same_particles "$tmp/parts.h5" "$tmp/whole.h5"
    for j in 2 4; do
        step -j $j -n 20 "$tmp/$k.h5" >"$tmp/j$j.h5"
        step -j 1 -n 20 "$tmp/$k.h5" >"$tmp/j1.h5"
        ok "-j $j gives the same bytes, $k" cmp "$tmp/j$j.h5" "$tmp/j1.h5"
    done
    step -n 40 "$tmp/$k.h5" | nsd-cat --last >"$tmp/whole.h5"
    step -n 25 -o "$tmp/half.h5" "$tmp/$k.h5"
    step -n 15 "$tmp/half.h5" | nsd-cat --last >"$tmp/parts.h5"
    rm "$tmp/half.h5"
    ok "a run that goes on from its file is the run, to the bit, $k" same_particles "$tmp/parts.h5" "$tmp/whole.h5"
done
for m in sbp sal ebp eal; do
    step -m $m --tolerance 1e-8 --max-sweeps 20000 -n 2 --contacts "$tmp/last.h5" | nsd-cat --last >"$tmp/one.h5"
    is "-m $m: nsd-err finds it solved" "$(nsd-err "$tmp/one.h5" | jq '.natural < 1.1e-8')" true
done
step --contacts -n 3 "$tmp/last-mesh.h5" >"$tmp/kept.h5"
ok "contacts say which triangle" numbers "$tmp/kept.h5" <<'END'
import sys, h5py
c = h5py.File(sys.argv[1])["contacts"]
of_mesh = c["body"][:, 0] == -1
assert of_mesh.any() and len(set(c["feature"][:][of_mesh])) > 3
END
is "a mesh goes through a pipe of three" "$(nsd-cat --last "$tmp/kept.h5" | nsd-detect | nsd-info -w | jq -r 'select(.wall == 0).shape')" mesh

# ---- the same wall said in two ways ----

plane() # JQ of a wall
{
    jq -n --argjson wall "$1" '{ dim: 2, dt: 1e-4, mu: 0.4, walls: [$wall], density: 2500,
        bodies: [{ count: 30, radius: { uniform: [0.9e-3, 1e-3] }, box: { x: [-5e-3, 5e-3], y: [2e-4, null] } }] }'
}
plane '{"point": [0, 0], "normal": [0, 1]}' | nsd-gen - | step -n $steps --every $steps --tolerance 1e-11 --max-sweeps 100000 | nsd-cat --last | nsd-info -p >"$tmp/plane"
for wall in '{"segment": [[-0.1, 0], [0.1, 0]]}' '{"polygon": {"points": [[-0.1, 0], [0, 0], [0.1, 0], [0.1, -0.1]]}}' \
    '{"polygon": {"points": [[-0.1, 0], [-0.001, 0], [0.0003, 0], [0.1, 0]], "closed": false}}'; do
    plane "$wall" | nsd-gen - | step -n $steps --every $steps --tolerance 1e-11 --max-sweeps 100000 | nsd-cat --last | nsd-info -p >"$tmp/other"
    like "discs fall on it as on a line: ${wall:0:40}" "$(jq -s '[.[] | .x[0:2]] | (length / 2) as $n |
        [range($n) as $i | range(2) as $k | .[$i][$k] - .[$i + $n][$k] | fabs] | max < 1e-7' "$tmp/plane" "$tmp/other")" true
done

# ---- drives ----

# shellcheck disable=SC2016 # jq's variable
one='{ dt: 1e-3, gravity: [0, 0, 0], bodies: [{ x: [0, 0, 9], radius: 1 }], walls: [{ point: [0, 0, 0], normal: [0, 0, 1], drives: [$drive] }] }'
heights() # DRIVE: the wall's height at 0.1, 0.2, ... 1 s
{
    jq -n --argjson drive "$1" "$one" | nsd-gen - | step -n 1000 --every 100 | nsd-info -w | jq -c '.point[2] * 1e9 | round / 1e9'
}
is "a speed between two times" "$(heights '{"along": [0, 0, 1], "speed": 2, "from": 0.25, "until": 0.6}' | tr '\n' ' ')" \
    '0 0 0.1 0.3 0.5 0.7 0.7 0.7 0.7 0.7 '
is "a table" "$(heights '{"along": [0, 0, 1], "table": [[0.2, 1], [0.4, 2], [0.5, 0]]}' | tr '\n' ' ')" \
    '1 1 1.5 2 0 0 0 0 0 0 '
ok "a sine" test "$(heights '{"along": [0, 0, 1], "amplitude": 0.5, "frequency": 1.25, "phase": 1}' | tr '\n' ' ')" = \
    "$(jq -rn '[range(1; 11) / 10 | 0.5 * (2 * 3.141592653589793 * 1.25 * . + 1 | sin) * 1e9 | round / 1e9] | map(tostring) | join(" ") + " "')"
jq '.walls[2].until = 0.005' scenes/silo.json | nsd-gen - >"$tmp/silo.h5"
is "a gate vanishes at its time" "$(step -n 60 --every 10 "$tmp/silo.h5" | nsd-info -w | jq -c 'select(.wall == 2).gone' | tr '\n' ' ')" \
    'null null null null true true '
jq -n --argjson drive '{"along": [0, 0, 1], "table": [[0.2, 1], [0.4, 2], [0.5, 0]]}' "$one" | nsd-gen - |
    step -n 300 --every 300 | nsd-cat --last >"$tmp/moved.h5"
jq -n --arg f "$tmp/moved.h5" '{ dt: 1e-3, gravity: [0, 0, 0], bodies: [{ document: $f }] }' | nsd-gen - >"$tmp/again.h5"
is "a scene takes boundaries from a document, and their drives go on" \
    "$(step -n 200 --every 100 "$tmp/again.h5" | nsd-info -w | jq -c '.point[2] * 1e9 | round / 1e9' | tr '\n' ' ')" '2 0 '

# a rotor that yields to a torque: I dw/dt = M, with nothing that touches it
jq -n '{ dt: 1e-3, bodies: [{ x: [0, 0, 9], radius: 1 }], walls: [{ cylinder: { point: [0, 0, 0], axis: [1, 0, 0], radius: 0.5, side: "both" },
    load: { about: [0, 0, 0], mass: 2, torque: 3 } }] }' | nsd-gen - | step -n 100 | nsd-info --last -w >"$tmp/rotor"
is "a cylinder yields to a torque" "$(jq -c '.spin | map(. * 1e9 | round / 1e9)' "$tmp/rotor")" '[0.15,0,0]'

# ---- documents of version 1 ----

gzip -dc tests/support/golden/version1.h5.gz >"$tmp/v1.h5"
is "a document of version 1 is read, walls and loads" "$(nsd-info -w "$tmp/v1.h5" | jq -c '.shape, (.load.travel // 0) * 1e9 | if type == "number" then round else . end' | tr '\n' ' ')" \
    '"plane" 0 "plane" 0 "plane" 0 "plane" 0 "plane" -400000 "plane" 100000 '
step -n 5 "$tmp/v1.h5" | nsd-cat --last >"$tmp/v2.h5"
is "and stepped, into one of version 2" "$(nsd-info "$tmp/v2.h5" | jq -s '.[1].step')" 25

# ---- faults, with line and column ----

bad() # NAME WALL PATTERN
{
    printf '{"dt": 1, "dim": %d,\n"walls": [%s]}\n' "${4-3}" "$2" >"$tmp/bad.json"
    refuses 65 "$1" nsd-gen "$tmp/bad.json"
    like "$1: said where" "$(cat "$tmp/err")" "$3"
}
bad "two shapes" '{"disc": {}, "sphere": {}}' 'bad.json:2:'
bad "no shape" '{"velocity": [0, 0, 1]}' 'bad.json:2:11'
bad "an unknown key" '{"sphere": {"center": [0, 0, 0], "radius": 1, "colour": 1}}' 'walls\[0\].sphere.colour: unknown'
bad "a radius of 0" '{"sphere": {"center": [0, 0, 0], "radius": 0}}' 'sphere.radius: must be positive'
bad "a hole as large as the disc" '{"disc": {"center": [0, 0, 0], "normal": [0, 0, 1], "radius": 1, "hole": 1}}' 'disc.hole: must be smaller'
bad "an axis of zero" '{"cylinder": {"point": [0, 0, 0], "axis": [0, 0, 0], "radius": 1}}' 'cylinder.axis: must not be zero'
bad "an arc of more than a turn" '{"cylinder": {"point": [0, 0, 0], "axis": [0, 0, 1], "radius": 1, "arc": 7}}' 'cylinder.arc: must be below'
bad "a point for a cone" '{"cone": {"point": [0, 0, 0], "axis": [0, 0, 1], "radii": [0, 0], "length": 1}}' 'cone.radii: must not both be 0'
bad "no such side" '{"sphere": {"center": [0, 0, 0], "radius": 1, "side": "left"}}' 'sphere.side'
echo '{"dt": 1, "walls": [{"mesh": {"file": "none.stl"}}]}' >"$tmp/bad.json"
refuses 66 "a mesh that is not there" nsd-gen "$tmp/bad.json"
like "and which" "$(cat "$tmp/err")" '/none.stl: cannot be read'
bad "a drive without an axis" '{"sphere": {"center": [0, 0, 0], "radius": 1}, "drives": [{"speed": 1}]}' 'drives\[0\]'
bad "a drive of two signals" '{"sphere": {"center": [0, 0, 0], "radius": 1}, "drives": [{"speed": 1, "table": [], "along": [1, 0, 0]}]}' 'drives\[0\]'
bad "times that fall" '{"point": [0, 0, 0], "normal": [0, 0, 1], "drives": [{"along": [1, 0, 0], "table": [[0, 1], [0, 2]]}]}' 'table\[1\]\[0\]: times must rise'
bad "a disc in the plane" '{"disc": {"center": [0, 0], "normal": [0, 1], "radius": 1}}' 'walls\[0\]' 2
bad "a segment without a length" '{"segment": [[1, 1], [1, 1]]}' 'segment: is without a length' 2
bad "a polygon of one point" '{"polygon": {"points": [[1, 1]]}}' 'points: needs two points' 2
bad "a polygon that stands still" '{"polygon": {"points": [[1, 1], [2, 1], [2, 1]]}}' 'points\[2\]: lies where' 2
printf 'solid x\nendsolid x\n' >"$tmp/empty.stl"
bad "a mesh without triangles" '{"mesh": {"file": "empty.stl"}}' 'empty.stl: '
head -c 3000 /dev/urandom >"$tmp/noise.stl"
bad "a mesh of noise" '{"mesh": {"file": "noise.stl"}}' 'noise.stl: '
echo '{"dt": 1, "walls": [{"sphere": {"center": [0, 0, 0], "radius": 2}}], "bodies": [{"x": [2, 0, 0], "radius": 0.5}]}' >"$tmp/deep.json"
refuses 65 "a ball that sticks out of a sphere" nsd-gen "$tmp/deep.json"
like "and how deep" "$(cat "$tmp/err")" 'body 0 is 0.5 m deep in wall 0'
wrong=("f[B + 'shape'][0] = 99" "f[B + 'size'][0] = nan" "f[B + 'elements'][0] = [5, 2**30]" "f[B + 'side'][0] = -1"
    "f[D + 'boundary'][0] = 7" "f[D + 'boundary'][:] = [2, 1, 0]" "f[D + 'signal'][0] = 3" "f[D + 'axis'][0] = [1, 1, 1]" "f[D + 'from'][0] = nan"
    "f[M + 'element'][0] = [0, 1, 2**29]" "f[M + 'vertex'][0] = [nan, 0, 0]" "del f[M + 'vertex']" "del f[D + 'row']")
for w in "${wrong[@]}"; do
    cp "$tmp/mesh.h5" "$tmp/wrong.h5"
    numbers "$tmp/wrong.h5" "$w" <<'END'
import sys, h5py
import numpy as np
nan = np.nan
f = h5py.File(sys.argv[1], "r+")
B, D, M = ["/particles/boundary/" + n + "/" for n in ("body", "drive", "mesh")]
exec(sys.argv[2])
END
    foreign "$tmp/wrong.h5" "$tmp/wrong-foreign.h5"
    refuses 65 "a document in which $w" nsd-detect "$tmp/wrong-foreign.h5"
done

# ---- pictures and other programs ----

nsd-view --size 200x200 "$tmp/drum-out.h5" >"$tmp/drum.png"
nsd-view --size 200x200 --plain "$tmp/mesh-out.h5" >"$tmp/mesh.png"
ok "a picture shows boundaries" test -s "$tmp/drum.png" -a -s "$tmp/mesh.png"
nsd-export --to stl --last --part walls -o "$tmp/again.stl" "$tmp/mesh.h5"
ok "the triangles leave as they came" numbers "$tmp/scene/drum.stl" "$tmp/again.stl" <<'END'
import sys, struct, numpy as np
def read(name):
    b = open(name, "rb").read()
    n = struct.unpack("<I", b[80:84])[0]
    t = np.frombuffer(b[84:84 + 50 * n], dtype=np.dtype([("n", "<f4", 3), ("x", "<f4", 9), ("a", "<u2")]))
    return t["x"]
one, other = read(sys.argv[1]), read(sys.argv[2])
assert np.array_equal(one, other[:len(one)]), (one.shape, other.shape)
END

done_testing
