#!/usr/bin/env bash
# nsd-web's page: its numbers are the document's, its options do what they say.
# shellcheck source=tests/support/tap.sh disable=SC2317 # functions called by name
. tests/support/tap.sh

stock run60 >"$tmp/out.h5"
nsd-web -o "$tmp/out.html" "$tmp/out.h5" 2>/dev/null

ok "the same file, the same page" cmp "$tmp/out.html" <(nsd-web "$tmp/out.h5" 2>/dev/null)
ok "a stream, the same page" cmp "$tmp/out.html" <(nsd-cat "$tmp/out.h5" | nsd-web 2>/dev/null)
is "the scene's title is its title" "$(grep -o '<title>[^<]*' "$tmp/out.html")" "<title>Sedimentation of 60 balls"
title() { nsd-web --title 'a <b> & "c"' "$tmp/out.h5" 2>/dev/null | grep -o '<title>.*</title>'; }
is "a title is text, not HTML" "$(title)" '<title>a &lt;b> &amp; "c"</title>'
meta() { sed -n 's/.*id="meta">\(.*\)<\/script>/\1/p' "$1" | jq -r "$2"; }
is "a frame for each" "$(meta "$tmp/out.html" '.frames | length')" 30
nsd-web --every 10 "$tmp/out.h5" >"$tmp/few.html" 2>/dev/null
is "--every" "$(meta "$tmp/few.html" '[.frames[].s] | @csv')" 30,330,630
nsd-web --frames 600: "$tmp/out.h5" >"$tmp/few.html" 2>/dev/null
is "--frames" "$(meta "$tmp/few.html" '.frames[0].s')" 600
is "it says that numbers are rounded" "$(meta "$tmp/out.html" '.said | test("rounded: positions to [0-9.e-]+ m")')" true
energy() { nsd-info "$tmp/out.h5" | jq -s "$1"; }
is "curves are of the document" "$(meta "$tmp/out.html" '.curves["kinetic energy"].value[29] * 1e9 | round')" \
    "$(energy 'last.kinetic_energy * 1e9 | round')"
printf '{"step": 30, "z": {"mean": 4.5}}\n{"step": 90, "z": {"mean": 5}}\n' >"$tmp/stat"
nsd-web --stat "$tmp/stat" "$tmp/out.h5" >"$tmp/few.html" 2>/dev/null
is "curves of nsd-stat, by their steps" "$(meta "$tmp/few.html" '.curves["z.mean"].value[:4] | tojson')" '[4.5,null,5,null]'

# what a chunk says is what the document says, to the rounding that the page states
chunks()
{
    py - "$tmp/out.html" "$tmp/out.h5" <<'PYTHON'
import base64, json, re, sys, zlib
import h5py, numpy as np
page = open(sys.argv[1]).read()
meta = json.loads(re.search(r'id="meta">(.*?)</script>', page).group(1))
file = h5py.File(sys.argv[2])
for k, m in enumerate(meta['frames']):
    data = zlib.decompress(base64.b64decode(re.search(r'id="f%d">(.*?)</script>' % k, page).group(1)))
    n, c = m['n'], m['c']
    x = np.frombuffer(data, '<u2', 4 * n).reshape(n, 4)
    v = np.frombuffer(data, '<i2', 4 * n, 8 * n).reshape(n, 4)
    q = np.frombuffer(data, 'i1', 4 * n, 16 * n).reshape(n, 4)
    a = np.frombuffer(data, '<i4', c, 20 * n)
    b = np.frombuffer(data, '<i4', c, 20 * n + 4 * c)
    f = np.frombuffer(data, '<u2', c, 20 * n + 8 * c)
    assert len(data) == 20 * n + 16 * c
    p = file['particles/all']
    assert np.all(abs(m['lo'] + m['step'] * x[:, :3] - p['position/value'][k]) <= 0.51 * np.array(m['step']) + 1e-12)
    assert np.all(abs(v[:, :3] / 32767 * m['vmax'] - p['velocity/value'][k]) <= 0.51 / 32767 * m['vmax'])
    assert np.all(abs(x[:, 3] / 65535 * m['wmax'] - np.linalg.norm(p['angular_velocity/value'][k], axis=1)) <= 0.51 / 65535 * m['wmax'])
    assert np.all(abs(q / 127 - p['orientation/value'][k]) <= 0.51 / 127)
    s, dt = int(file['contacts/start'][k]), file['nsd'].attrs['dt']
    assert c == file['contacts/count'][k]
    assert np.array_equal(np.stack([a, b], 1), file['contacts/body'][s:s + c])
    assert np.all(abs(f / 65535 * m['fmax'] - file['contacts/reaction'][s:s + c, 0] / dt) <= 0.51 / 65535 * m['fmax'] + 1e-15)
PYTHON
}
ok "a frame's numbers are the document's, to the rounding that it states" chunks

# the shapes of grains: closed surfaces of the right volume in the unit of a radius of 1, and their edges
printf '{"dt": 1e-3, "shapes": {"cube": {"box": [0.1, 0.1, 0.1]}, "pill": {"capsule": {"length": 0.1, "radius": 0.05}}}, "gravity": [0, 0, 0],
    "bodies": [{"x": [0, 0, 0], "shape": "cube", "w": [0, 0, 100]}, {"x": [0.5, 0, 0.3], "radius": 0.1}, {"x": [0.2, 0.4, 0], "shape": "pill"}]}' |
    nsd-gen - | nsd-step -n 3 >"$tmp/shapes.h5" 2>/dev/null
nsd-web "$tmp/shapes.h5" >"$tmp/shapes.html" 2>/dev/null
shapes()
{
    py - "$tmp/shapes.html" <<'PYTHON'
import base64, re, sys, zlib
import numpy as np
page = open(sys.argv[1]).read()
chunk = lambda name: zlib.decompress(base64.b64decode(re.search(r'id="%s">(.*?)</script>' % name, page).group(1)))
assert list(np.frombuffer(chunk('g0'), '<i4')[12:]) == [1, 0, 2]
data = chunk('s0')
count = np.frombuffer(data, '<u4', 1)[0]
each = np.frombuffer(data, '<u4', count, 4)
assert list(each) == [0, 12, 320] and len(data) == 4 + 4 * count + 37 * sum(each)
x = np.frombuffer(data, '<f4', 9 * sum(each), 4 + 4 * count).reshape(-1, 3, 3).astype(float)
edges = np.frombuffer(data, 'u1', sum(each), len(data) - sum(each))
volume = lambda t: sum(np.dot(a, np.cross(b, c)) for a, b, c in t) / 6
for t in (x[:12], x[12:]):
    assert abs(sum(np.cross(b - a, c - a) for a, b, c in t)).max() < 1e-5
assert abs(volume(x[:12]) / (2 / 3 ** 0.5) ** 3 - 1) < 1e-6
assert np.unpackbits(edges[:12]).sum() == 24 and not edges[12:].any()
corners = x[12:].reshape(-1, 3) # half a unit from the pill's axis, which is 1 long
axis = int(np.argmax(abs(corners).max(axis=0)))
along = corners[:, axis]
corners[:, axis] -= np.clip(along, -0.5, 0.5)
assert abs(np.linalg.norm(corners, axis=1) - 0.5).max() < 1e-6
PYTHON
}
ok "shapes are closed surfaces, and cubes have twelve edges, each of two faces" shapes

nsd-gen 20 | nsd-detect --fclib=local | tail -c +513 >"$tmp/both.hdf5"
h5copy -i "$tmp/both.hdf5" -o "$tmp/problem.hdf5" -s /fclib_local -d /fclib_local
refuses 65 "an FCLIB problem has no grains" nsd-web "$tmp/problem.hdf5"
status 66 "a file that is not there" nsd-web "$tmp/none.h5"
refuses 64 "a range that is none" nsd-web --frames 1:x "$tmp/out.h5"
refuses 66 "curves that are not there" nsd-web --stat "$tmp/none" "$tmp/out.h5"

if [ -z "$thin" ]; then
    nsd-gen 500 | nsd-step -n 1000 --contacts >"$tmp/long.h5" 2>/dev/null
    nsd-web "$tmp/long.h5" >"$tmp/long.html" 2>/dev/null
    ok "500 balls, 1000 frames with their contacts: below 30 MB" [ "$(stat -c %s "$tmp/long.html")" -lt 30000000 ]
fi
done_testing
