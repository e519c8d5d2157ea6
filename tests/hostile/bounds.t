#!/usr/bin/env bash
# Bounds that multiply: small input that would keep a tool busy for hours, or take all memory, ends soon.
# shellcheck source=tests/support/tap.sh disable=SC2154,SC2317
. tests/support/tap.sh

sanitized=
! grep -q __asan_init "$(command -v nsd-gen)" || sanitized=1
export ASAN_OPTIONS=$ASAN_OPTIONS:detect_leaks=0
cd "$tmp"

# bounded COMMAND ...: in 1 GB of memory and half a minute (the machine may be busy)
bounded()
{
    [ -n "$sanitized" ] || ulimit -v 1500000
    timeout 60 "$@"
}
ends() { (bounded "$@"); }

# ---- images of a periodic cell, and points of a grid ----

echo '{ "dt": 1e-3, "gravity": [0, 0, 0], "cell": { "lengths": [1, 1, 1] }, "bodies": [{ "x": [0.2, 0.2, 0.5], "radius": 0.1 }, { "x": [0.6, 0.6, 0.5], "radius": 0.1 }] }' >cell.json
nsd-gen cell.json >cell.h5
nsd-step -n 1 --contacts cell.h5 2>/dev/null | cat >step.h5
for size in 1e4 1e6 1e9 1e300; do refuses 65 "a box of $size cells along each axis" ends nsd-stat -m fraction --box 0,$size,0,$size,0,$size cell.h5; done
solid() { ends nsd-stat -m fraction --box "0,$1,0,1,0,1" cell.h5 | jq -e --argjson size "$1" '.fraction.solid / $size / (8e-3 * 3.141592653589793 / 3) - 1 | fabs < 1e-6'; }
for size in 7 300 1.2e6; do ok "a row of $size cells has all its images: 2 balls each" solid $size; done
status 65 "fields of a width of 1000 cells" ends nsd-stat -m fraction -f f.h5 --width 1000 cell.h5
is "leave nothing" "$(ls f.h5 .f.h5* 2>/dev/null)" ""
if /usr/bin/python3 -c 'import h5py' 2>/dev/null; then
    tail -c +513 step.h5 >fast.h5
    /usr/bin/python3 -c 'import h5py; f = h5py.File("fast.h5", "r+"); f["particles/all/velocity/value"][-1, 0, 0] = 1e9'
    status 65 "fields of a body that moves 1e6 cells in a step" ends nsd-stat -m fraction -f f.h5 fast.h5
fi
status 65 "fields on a grid of 8e6 points" ends nsd-stat -m fraction -f f.h5 --spacing 0.005 cell.h5

# ---- what is no file has no size ----

mkfifo pipe
from_pipe() # writes for ever what WRITER does, into a pipe that COMMAND reads
{
    sh -c "$1" >pipe 2>/dev/null &
    ends "${@:2}"
}
echo '{"dt": 1e-3, "bodies": [{"file": "pipe"}]}' >table.json
refuses 65 "a table that never ends" from_pipe 'yes "0 0 0 1"' nsd-gen table.json
refuses 65 "and one of zeros" from_pipe 'cat /dev/zero' nsd-gen table.json
refuses 65 "a scene that never ends" eval 'ends nsd-gen - </dev/zero'
nsd-gen 6 >six.h5
refuses 65 "--values that never end" from_pipe 'echo id v; yes "1 2"' nsd-view --values pipe -o v.png six.h5
refuses 65 "in one line" from_pipe 'cat /dev/zero' nsd-view --values pipe -o v.png six.h5

# ---- scenes ----

echo '{"dt": 1e-3, "bodies": [{"random": {"phi": 0.3}, "box": {"x": [0, 1], "y": [0, 1], "z": [0, 1]},
    "radius": {"sieve": [[2e-4, 0], [4e-4, 1]]}}]}' >sieve.json
refuses 65 "a sieve in mm that were m" ends nsd-gen sieve.json
like "says what to do" "$(cat err)" "larger ones, or a smaller box"
jq -n '{ dt: 1e-3, shapes: [range(20000) | { key: "shape \(.)", value: { points: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]] } }] | from_entries,
    bodies: [range(20000) | { x: [3 * ., 0, 0], radius: 1, shape: "shape \(.)" }] }' >shapes.json
refuses 65 "20 000 shapes" ends nsd-gen shapes.json
like "says that their names are too long" "$(cat err)" "/nsd/shape@names: .* bytes"
jq -n '{ dt: 1e-3, materials: [range(1001) | { key: "k\(.)", value: { density: 1 } }] | from_entries, bodies: [] }' >kinds.json
refuses 65 "1001 kinds" ends nsd-gen kinds.json
jq -n '{ dt: 1e-3, shapes: { round: { points: [range(4500) | (1 - (2 * . + 1) / 4500) as $z | (2.39996 * .) as $a |
    (1 - $z * $z | sqrt) as $r | [$r * ($a | cos), $r * ($a | sin), $z]] } }, bodies: [{ x: [0, 0, 0], radius: 1, shape: "round" }] }' >round.json
refuses 65 "a hull of 4500 corners" ends nsd-gen round.json
like "says so" "$(cat err)" "4500 corners, and a shape has 4096 at most"
mesh() { echo "{\"dt\": 1e-3, \"overlap\": true, $1}" >mesh.json; }
awk 'BEGIN { for (k = 0; k <= 2^20; k++) print "v", cos(k), sin(k), k; print "f 1 2 3\nf", 2^20 + 1, "1 2" }' >many.obj
mesh '"shapes": {"many": {"mesh": {"file": "many.obj", "hull": true}}}, "bodies": [{"x": [0, 0, 0], "radius": 1, "shape": "many"}]'
refuses 65 "a grain of 2^20 + 1 corners" ends nsd-gen mesh.json
awk 'BEGIN { for (j = 0; j < 65; j++) { f = "f"; for (i = 0; i < 4096; i++) { r = i % 2 ? 1 : 0.5; a = 6.283185307179586 * i / 4096
    print "v", r * cos(a), r * sin(a), j; f = f " " (4096 * j + i + 1) } print f } }' OFMT=%.12g >stars.obj
mesh '"walls": [{"mesh": {"file": "stars.obj"}}]'
refuses 65 "65 stars of 4096 corners" ends nsd-gen mesh.json
like "says so" "$(cat err)" "too many concave polygons"
echo '{"dt": 1e-3, "gravity": [0, 0, 0], "time": 0, "pour": [{"rate": 1e30, "radius": 1e-6,
    "opening": {"box": {"x": [0, 1], "y": [0, 1], "z": [0, 1]}}}]}' >pour.json
nsd-gen pour.json >pour.h5
status 0 "a pour of all at once" ends nsd-step -n 2 -o poured.h5 pour.h5
is "brings as many as a step may" "$(nsd-info --last poured.h5 | jq .bodies)" 2001

# a fan of N triangles about one corner, and balls above it
fan()
{
    awk -v n="$1" 'BEGIN {
        print "solid fan"
        for (k = 0; k < n; k++) {
            a = 6.283185 * k / n; b = 6.283185 * (k + 1) / n
            printf "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex %.9g %.9g 0\nvertex %.9g %.9g 0\nendloop\nendfacet\n",
                cos(a), sin(a), cos(b), sin(b)
        }
        print "endsolid fan" }' >fan.stl
    jq -n --argjson balls "$2" '{ dt: 1e-3, overlap: true, walls: [{ mesh: { file: "fan.stl" } }],
        bodies: [range($balls) | { x: [0.001 * ., 0.0003, 2], radius: 1.9 }] }' >fan.json
}
fan 20000 20
nsd-gen fan.json >fan.h5
refuses 65 "20 000 triangles at a corner" ends nsd-detect fan.h5
awk 'BEGIN { m = 320; for (i = 0; i <= m; i++) for (j = 0; j <= m; j++) print "v", i / m, j / m, 0
    for (i = 0; i < m; i++) for (j = 0; j < m; j++) { a = i * (m + 1) + j + 1; print "f", a, a + m + 1, a + m + 2, a + 1 } }' >fine.obj
jq -n '{ dt: 1e-3, overlap: true, walls: [{ mesh: { file: "fine.obj" } }],
    bodies: [range(400) | { x: [0.5 + 0.001 * ., 0.5, 2], radius: 2.5 }] }' >fine.json
nsd-gen fine.json >fine.h5
refuses 65 "400 balls each near 204 800 triangles" ends nsd-detect fine.h5
like "says so" "$(cat err)" "elements of meshes near them"
fan 4000 300
nsd-gen fan.json >fan.h5
status 0 "300 balls over 4000 triangles at a corner" ends nsd-detect fan.h5

# ---- documents ----

if ! have_h5py; then
    skip "documents that multiply" "no h5py"
    done_testing
    exit
fi
echo '{"dt": 1e-3, "allow_overlap": true, "gravity": [0, 0, 0], "bodies": [{"x": [0, 0, 0.5], "radius": 0.2, "shape": "cube"}], "shapes":
    {"cube": {"points": [[0,0,0],[1,0,0],[0,1,0],[0,0,1],[1,1,0],[1,0,1],[0,1,1],[1,1,1]]}},
    "walls": [{"point": [0, 0, 0], "normal": [0, 0, 1], "drives": [{"along": [0, 0, 1], "table": [[0, 0], [1, 1]]}]}]}' |
    nsd-gen - >base.h5
nsd-step -n 3 --contacts base.h5 2>/dev/null >frames.h5

# make NAME SOURCE CODE: a copy without our header, changed by Python: f is the file, put(path, array) packs
make()
{
    foreign "$2" "$1"
    py - "$1" "$3" <<'PYTHON'
import sys, h5py, numpy as np
f = h5py.File(sys.argv[1], 'r+', libver='latest')
def put(path, a, **how):
    if path in f: del f[path]
    chunks = (min(len(a), 1 << 20),) + a.shape[1:]
    f.create_dataset(path, data=a, chunks=chunks, compression='gzip', compression_opts=9, shuffle=True, **how)
exec(sys.argv[2])
f.close()
PYTHON
}
refused() # what: by all that read; and soon
{
    for tool in nsd-info nsd-step nsd-cat; do
        refuses 65 "$tool: $1" ends "$tool" bad.h5
    done
}

make bad.h5 frames.h5 "
n = 8000000
put('steps', np.arange(n, dtype='i8'))
for name in '/particles/all/position/step', '/particles/all/position/time', '/contacts/step', '/contacts/start', '/contacts/count':
    del f[name]; f[name] = f['steps']
del f['steps']"
refused "one dataset under five names"

drive='/particles/boundary/drive/'
many="
def drives(D, R):
    g = '$drive'
    for n in 'boundary', 'turns': put(g + n, np.zeros(D, 'i1'))
    put(g + 'signal', np.full(D, 2, 'i1')); put(g + 'until', np.ones(D, 'i1'))
    a = np.zeros((D, 3), 'i1'); a[:, 2] = 1; put(g + 'axis', a); put(g + 'point', np.zeros((D, 3), 'i1'))
    for n in 'value', 'frequency', 'phase', 'from', 'clock': put(g + n, np.zeros(D, 'i1'))
    rows = np.zeros((D, 2), 'i4'); rows[:, 1] = R; put(g + 'rows', rows)
    r = np.zeros((R, 2), 'i4'); r[:, 0] = np.arange(R); put(g + 'row', r)"
make bad.h5 base.h5 "$many
drives(1000000, 1000000)"
refused "a million drives of a million rows"
make bad.h5 base.h5 "$many
drives(900, 300000)"
refused "900 drives that share 300 000 rows"
like "says so" "$(cat err)" "its table is missing or another drive's"
make bad.h5 base.h5 "$many
drives(1001, 1)
rows = np.zeros((1001, 2), 'i4'); rows[:, 0] = np.arange(1001); rows[:, 1] = 1; put('$drive' + 'rows', rows)
put('$drive' + 'row', np.zeros((1001, 2), 'i1'))"
refused "1001 drives of one boundary"
like "says so" "$(cat err)" "more than a wall may have"

make bad.h5 base.h5 "
put('/nsd/shape/corner', np.tile(np.arange(3, dtype='i4'), 2000000))
put('/nsd/shape/face', np.full(2000000, 3, 'i1'))
put('/nsd/shape/faces', np.array([2000000], 'i4')); put('/nsd/shape/corners', np.array([6000000], 'i4'))"
refused "a cube of two million faces"

make bad.h5 base.h5 "
F = 15000000
put('/particles/all/position/step', np.arange(F, dtype='i4')); put('/particles/all/position/time', np.zeros(F, 'i1'))
for n, w in ('position', 3), ('velocity', 3), ('angular_velocity', 3), ('orientation', 4):
    put('/particles/all/%s/value' % n, np.zeros((F, 1, w), 'i1'))"
refused "a document of frames alone"

make bad.h5 base.h5 "
for k in range(1001): f['/nsd'].attrs['mine%d' % k] = k"
refused "1001 attributes of a group"
like "says so" "$(cat err)" "/nsd: more than 1000 attributes"
make bad.h5 base.h5 "
d = f.create_dataset('mine', data=np.zeros(2))
for k in range(60000): d.attrs['a%d' % k] = k"
refuses 65 "60 000 attributes of an object that nobody knows" ends nsd-cat bad.h5
make many.h5 base.h5 "
for k in range(20000): f.create_dataset('mine%05d' % k, data=np.zeros(2))"
status 0 "20 000 objects that nobody knows" ends nsd-cat -o copied.h5 many.h5
is "are copied" "$(h5ls copied.h5 | grep -c mine)" 20000

soon_in() # SECONDS COMMAND ...: of the processor
{
    [ -n "$sanitized" ] || ulimit -t "$1"
    timeout 60 "${@:2}"
}
names="
def shapes(N):
    g = f['/nsd/shape']; n = f.create_group('/nsd/more')
    for k in g:
        a = np.concatenate([g[k][()]] * N)
        n.create_dataset(k, data=a, chunks=(min(len(a), 1 << 16),) + a.shape[1:], compression='gzip', shuffle=True)
        for x in g[k].attrs: n[k].attrs[x] = g[k].attrs[x]
    del f['/nsd/shape']
    n.attrs.create('names', np.bytes_(''.join('s%05d\n' % k for k in range(N)).encode()))
    f.move('/nsd/more', '/nsd/shape')"
make bad.h5 base.h5 "$names
shapes(65534)"
refused_or_not() { (soon_in 5 nsd-info bad.h5 >/dev/null); }
ok "65 534 shapes take no minute" refused_or_not
make bad.h5 base.h5 "$names
shapes(65536)"
refused "65 536 shapes"
make bad.h5 base.h5 "
f['/nsd/material'].attrs['kinds'] = ''.join('k%d\n' % k for k in range(4097))"
refused "4097 kinds"
like "says so" "$(cat err)" "more than 4096 materials"
make bad.h5 base.h5 "
def more(path, axis, n):
    a = np.repeat(f[path][()], n, axis); at = dict(f[path].attrs); put(path, a)
    for k in at: f[path].attrs[k] = at[k]
def each(group, n):
    paths = []
    f[group].visititems(lambda name, o: (isinstance(o, h5py.Dataset) and paths.append((group + '/' + name, o.shape))) or None)
    for path, shape in paths:
        if not path.endswith('step') and not path.endswith('time') and not '/drive/' in path:
            more(path, 0 if len(shape) == 1 or not path.endswith('value') else 1, n)
each('/particles/all', 20000); each('/particles/boundary', 20000)
put('/particles/all/id', np.arange(20000))"
refused "20 000 bodies in 20 000 boundaries"
like "says so" "$(cat err)" "20000 walls: more than 4096 for each body"

make steps.h5 frames.h5 "
F = 30000
old = {n: f[n][()] for n in ('/particles/all/position/step', )}
for n, w in ('position', 3), ('velocity', 3), ('angular_velocity', 3), ('orientation', 4):
    row = f['/particles/all/%s/value' % n][:1]
    put('/particles/all/%s/value' % n, np.repeat(row, F, 0))
steps = 2 * np.arange(F)
del f['/particles/all/position/step'], f['/particles/all/position/time']
put('/particles/all/position/step', steps); put('/particles/all/position/time', 1e-3 * steps)
for g in '/nsd/solver', '/particles/boundary/position', '/particles/boundary/velocity':
    if g in f: del f[g]
C = 1500000
put('/contacts/step', 2 * np.arange(C) + 1); put('/contacts/start', np.zeros(C, 'i1')); put('/contacts/count', np.zeros(C, 'i1'))"
soon() { ends nsd-info --last steps.h5 >/dev/null && ends nsd-info steps.h5 >last; }
if [ -z "$sanitized" ]; then
    ok "30 000 frames and the contacts of a million and a half steps" soon
fi

done_testing
