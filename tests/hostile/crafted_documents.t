#!/usr/bin/env bash
# Documents made to harm: what was tried once against the tools, each ends with 65 and one line.
# shellcheck source=tests/support/tap.sh disable=SC2154,SC2317 # tap.sh sets tmp; functions called by name
. tests/support/tap.sh

readers=(nsd-cat nsd-info nsd-detect nsd-step nsd-view)
nsd-gen 4 >"$tmp/four.h5"
stock solved4 >"$tmp/solved.h5"
sanitized=
! grep -q __asan_init "$(command -v nsd-gen)" || sanitized=1
# what libhdf5 does in the reading process is not ours, and there a sanitizer would say more than a line
export ASAN_OPTIONS=$ASAN_OPTIONS:detect_leaks=0:handle_segv=0:handle_sigbus=0

if ! have_h5py; then
    skip "hostile documents" "no h5py"
    done_testing
    exit
fi

# make NAME SOURCE CODE: a copy of a document, without its header, changed by Python: f is the open file
make()
{
    tail -c +513 "$tmp/$2" >"$tmp/$1"
    py - "$tmp/$1" "$tmp" "$3" <<'PYTHON'
import os, sys, h5py, numpy as np
from h5py import h5d, h5p, h5s, h5t
path, tmp, code = sys.argv[1:]
P, C = '/particles/all/', '/contacts/'
MOTION = ('position', 3), ('velocity', 3), ('angular_velocity', 3), ('orientation', 4)
BODIES = ('radius', 'f8'), ('mass', 'f8'), ('inertia', 'f8'), ('id', 'i4'), ('species', 'i4')
def external(f, name, size, type):
    p = h5p.create(h5p.DATASET_CREATE)
    p.set_external((tmp + '/secret').encode(), 0, size)
    space = h5s.create(h5s.SCALAR) if type is None else h5s.create_simple((size,))
    if type is None:
        type = h5t.C_S1.copy()
        type.set_size(size)
    h5d.create(f.id, name, type, space, dcpl=p)
def virtual(f, name):
    layout = h5py.VirtualLayout((4,), 'f8')
    layout[:] = h5py.VirtualSource(tmp + '/four.h5', P + 'radius', shape=(4,))
    f.create_virtual_dataset(name, layout)
def new(f, path, **how):
    del f[path]
    f.create_dataset(path, **how)
def bodies(f, n, how):
    for name, width in MOTION: new(f, P + name + '/value', shape=(1, n, width), dtype='f8', **how)
    for name, type in BODIES: new(f, P + name, shape=(n,), dtype=type, **how)
f = h5py.File(path, 'r+')
exec(code)
f.close()
PYTHON
}

# all_refuse NAME REGEX: by every reader
all_refuse()
{
    local tool
    for tool in "${readers[@]}"; do
        refuses 65 "$tool: $1" timeout 20 "$tool" "$tmp/bad.h5"
        like "says what" "$(cat "$tmp/err")" "$2"
    done
}
hostile() # what regex source code
{
    make bad.h5 "$3" "$4"
    cp "$tmp/bad.h5" "$tmp/hostile.$((++copies)).h5" # for Python, below
    all_refuse "$1" "$2"
}

copies=0

# ---- other files ----

echo "secret: nobody shall see this in a document, however long it takes to read it" >"$tmp/secret"
hostile "the scene in another file" '/nsd/scene: .*another file' four.h5 \
    "del f['/nsd/scene']; external(f, b'/nsd/scene', 64, None)"
hostile "an unknown dataset in another file" '/mine: .*another file' four.h5 "external(f, b'/mine', 64, h5t.STD_U8LE)"
hostile "a link into another file" '/mine: .*another file' four.h5 "f['/mine'] = h5py.ExternalLink(tmp + '/four.h5', '/nsd')"
hostile "the scene a link into another file" '/nsd/scene: .*another file' four.h5 \
    "del f['/nsd/scene']; f['/nsd/scene'] = h5py.ExternalLink(tmp + '/four.h5', '/nsd/history')"
hostile "a link through a link into another file" 'another file' four.h5 \
    "f['/a'] = h5py.SoftLink('/z/history'); f['/z'] = h5py.ExternalLink(tmp + '/four.h5', '/nsd')"
hostile "a virtual dataset" '/mine: .*other files' four.h5 "virtual(f, '/mine')"
hostile "masses that are a virtual dataset" '/particles/all/mass: .*other files' four.h5 \
    "del f[P + 'mass']; virtual(f, P + 'mass')"
hostile "a virtual dataset that a link leads to, in the group for VTK" '/mine: .*other files' four.h5 "virtual(f, '/VTKHDF/x'); f['/mine'] = h5py.SoftLink('/VTKHDF/x')"
hostile "and under a second name" '/mine: .*other files' four.h5 "virtual(f, '/VTKHDF/x'); f['/mine'] = f['/VTKHDF/x']"
make bad.h5 four.h5 "virtual(f, '/VTKHDF/x'); f['/VTKHDF/y'] = h5py.ExternalLink(tmp + '/secret', '/'); f['/VTKHDF/a'] = f['/VTKHDF']; external(f, b'/VTKHDF/z', 64, h5t.STD_U8LE)"
ok "the group for VTK is not looked into" sh -c "nsd-cat '$tmp/bad.h5' >'$tmp/copy.h5' && nsd-info '$tmp/bad.h5' >'$tmp/none'"
ok "nor copied" sh -c "! h5ls '$tmp/copy.h5' | grep -q VTKHDF"
make bad.h5 four.h5 "f['/VTKHDF'] = h5py.ExternalLink(tmp + '/secret', '/')"
ok "even where it is a link into another file" sh -c "nsd-info '$tmp/bad.h5' >'$tmp/none'"
hostile "a filter that is not built in" '/mine: .*filter' four.h5 \
    "f.create_dataset('/mine', data=np.zeros(1000), chunks=(100,), compression='lzf')"

# ---- more than there is ----

hostile "bodies that are a fill value" '--unpack' four.h5 "bodies(f, 20000000, {'fillvalue': 1})"
hostile "gzip of nothing much" '--unpack' four.h5 "bodies(f, 3000000, {'compression': 'gzip', 'chunks': True})"
small() { (ulimit -v 400000 && nsd-info "$tmp/bad.h5"); }
[ -n "$sanitized" ] || refuses 65 "which takes little memory" small
packed() # unpacked by permission
{
    make packed.h5 four.h5 "n = 700000
bodies(f, n, {'compression': 'gzip'})
for name, width in MOTION: f[P + name + '/value'][...] = np.full((1, n, width), [1, 0, 0, 0] if width == 4 else 0)
for name, type in BODIES: f[P + name][...] = np.full(n, name != 'species')"
    ! nsd-info "$tmp/packed.h5" && nsd-info --unpack 1 "$tmp/packed.h5" >"$tmp/info" && grep -q '"bodies":700000' "$tmp/info"
}
ok "--unpack raises the limit" packed
hostile "groups 40 deep" 'more than 32 deep' four.h5 "f.create_group('/a' * 40)"
hostile "a name of 500 bytes" 'a name too long' four.h5 "f['/' + 'n' * 500] = 1"
hostile "more objects than anybody has" 'more than 100000 objects' four.h5 "
g, nsd = f.create_group('/many').id, f['/nsd'].id
for k in range(100001): g.links.create_hard(b'%d' % k, nsd, b'scene')"
hostile "a chunk of a filter without a name" 'filter' four.h5 "
p = h5p.create(h5p.DATASET_CREATE); p.set_chunk((4,)); p.set_filter(400, h5py.h5z.FLAG_OPTIONAL, (1, 2))
h5d.create(f.id, b'/mine', h5t.STD_I32LE, h5s.create_simple((4,)), dcpl=p)"
hostile "a group in itself" 'deep|objects' four.h5 "f['/loop/a'] = 1; f['/loop/b'] = f['/loop']; f['/loop/c'] = f['/loop']"
hostile "bodies of which nothing is stored" 'stored' four.h5 \
    "bodies(f, 200000, {})"

# ---- numbers that are not what they say ----

for change in "new(f, P + 'species', data=np.full(4, 0.9))" "new(f, P + 'id', data=np.full(4, np.nan))" \
    "new(f, P + 'id', data=np.full(4, 2**40))" "new(f, '/particles/boundary/body/species', data=np.full(5, 0.5))" \
    "f['/nsd/material/mu'][0, 1] = 0.7" "f['/nsd/material/en'][1, 0] = 0.7"; do
    make bad.h5 four.h5 "$change"
    refuses 65 "$change" nsd-step "$tmp/bad.h5"
done
for change in "f[C + 'status'][0] = 99" "f[C + 'status'][0] = -1" "f[C + 'body'][1] = f[C + 'body'][0]" \
    "f[C + 'body'][...] = f[C + 'body'][()][::-1]" "f['/nsd/solver/sweeps/value'][0] = -5" \
    "f['/nsd/solver/contacts/value'][0] = -1" "f['/nsd/solver/converged/value'][0] = 5"; do
    make bad.h5 solved.h5 "$change"
    refuses 65 "$change" nsd-err "$tmp/bad.h5"
    refuses 65 "$change: nsd-move" nsd-move "$tmp/bad.h5"
done

# the reactions that the next step starts from
nsd-step -n 3000 --every 3000 "$tmp/four.h5" 2>"$tmp/err" >"$tmp/stepped.h5"
for change in "f[M + 'impulse'][0, 1] = np.nan" "f[M + 'body'][0] = [-9, 0]" "f[M + 'body'][0] = [0, 4]" "f[M + 'body'][0] = [2, 2]" \
    "f[M + 'body'][1] = f[M + 'body'][0]" "f[M + 'body'][...] = f[M + 'body'][()][::-1]" "f[M + 'count'][0] = 2**40" \
    "f[M + 'start'][0] = -1" "del f[M + 'impulse']" "new(f, M + 'body', data=np.zeros((3, 2)))"; do
    make bad.h5 stepped.h5 "M = '/nsd/memory/'; $change"
    refuses 65 "$change: nsd-step" nsd-step "$tmp/bad.h5"
    refuses 65 "$change: nsd-info" nsd-info "$tmp/bad.h5"
done

# ---- libhdf5 breaks down ----

# breaks FILE TOOL: the reading process may die, the tool may not
breaks()
{
    local s=0
    timeout 30 "$2" "$1" >"$1.out" 2>"$1.err" || s=$?
    [ $s = 0 ] || { [ $s = 65 ] && { [ -n "$sanitized" ] || one_line 65 "$1.err"; }; } || { echo "$2: $s"; return 1; }
}
if [ -d "$problems/global" ]; then
    cp "$problems/global/GFC3D_Example00_badly_scaled.hdf5" "$tmp/bad.hdf5"
    chmod u+w "$tmp/bad.hdf5"
    poke "$tmp/bad.hdf5" 6153 0 0 0
    for tool in nsd-info nsd-cat nsd-solve; do
        status 65 "$tool: three bytes at which H5Dread crashes" "$tool" "$tmp/bad.hdf5"
        [ -n "$sanitized" ] || like "says that it was libhdf5" "$(cat "$tmp/err")" "^$tool: $tmp/bad.hdf5: libhdf5 breaks down"
    done
else
    skip "three bytes at which H5Dread crashes" "no ../shared/problems"
fi
# one byte each of a document with a right checksum
nsd-detect --fclib=local "$tmp/solved.h5" >"$tmp/export.h5"
size=$(wc -c <"$tmp/export.h5")
mapfile -t byte < <(od -An -v -tu1 -w1 "$tmp/export.h5")
mended()
{
    local at=$((512 + ($1 * 509) % (size - 512))) f=$tmp/mended.$BASHPID tools=(nsd-info nsd-cat nsd-detect)
    cp "$tmp/export.h5" "$f"
    poke "$f" "$at" $((byte[at] ^ (1 << $1 % 8)))
    header "$f" 2 0 "$size"
    breaks "$f" "${tools[$1 % 3]}" || echo "byte $at"
}
ok_each "a byte changed and the checksum mended: an answer, or 65" mended "$([ -n "$thin" ] && echo 24 || echo 90)"

# ---- an input that becomes shorter ----

shorter()
{
    local s=0
    nsd-gen 300000 >"$tmp/long.h5"
    cat "$tmp/long.h5" "$tmp/long.h5" "$tmp/long.h5" >"$tmp/longer.h5"
    # who takes its output begins later than the file is cut
    nsd-cat --stream "$tmp/longer.h5" > >(sleep 1 && cat >"$tmp/cat.out") 2>"$tmp/err" &
    sleep 0.3
    truncate -s 1000000 "$tmp/longer.h5"
    wait $! || s=$?
    [ $s = 65 ] || { echo "status $s: $(cat "$tmp/err")"; return 1; }
    one_line 65 "$tmp/err"
}
ok "an input that becomes shorter while it is read: 65" shorter
rm -f "$tmp"/long*.h5 "$tmp/cat.out"

# ---- two writers, and one who looks on ----

timeout 60 nsd-step -n 20000 -o "$tmp/shared.h5" "$tmp/solved.h5" 2>/dev/null &
writer=$!
for ((w = 0; w < 500; w++)); do
    nsd-info "$tmp/shared.h5" >/dev/null 2>&1 && break
    sleep 0.02
done
refuses 74 "a second nsd-step -o of the same file" nsd-step -o "$tmp/shared.h5" "$tmp/solved.h5"
refuses 74 "nsd-cat -o, too" nsd-cat -o "$tmp/shared.h5" "$tmp/solved.h5"
looks() { /usr/bin/python3 -c "import h5py; assert len(h5py.File('$tmp/shared.h5')['particles/all/position/step']) > 0"; }
ok "h5py looks on" env -u HDF5_USE_FILE_LOCKING bash -c "$(declare -f looks); tmp=$tmp; looks"
s=0
: >"$tmp/shared.h5"
wait $writer || s=$?
is "a writer whose file was cut off: 74" "$s" 74
both() { { nsd-gen 4 && nsd-step -n 2 "$tmp/solved.h5" 2>/dev/null; } >"$tmp/both.h5" && nsd-info "$tmp/both.h5" | grep -c frames; }
ok "two tools in turn into one file" both
appended()
{
    local k
    : >"$tmp/appended.h5"
    for ((k = 0; k < 8; k++)); do nsd-gen 4 >>"$tmp/appended.h5" & done
    wait
    [ "$(nsd-info "$tmp/appended.h5" | grep -c frames)" = 8 ]
}
ok "eight that append at once: eight documents" appended

nowhere() # two at a time
{
    local pid
    nsd-step -n 300 --max-sweeps 3 four.h5 >/dev/null 2>&1 &
    pid=$!
    nsd-step -n 300 --max-sweeps 3 four.h5 >/dev/null && wait $pid
}
cd "$tmp"
ok "two into /dev/null" nowhere
cd - >/dev/null

# ---- what ends ----

crowd() { echo '{"dt": 1e-3, "allow_overlap": true, "bodies": [{"file": "crowd"}]}' >"$tmp/crowd.json" && nsd-gen "$tmp/crowd.json" | nsd-step; }
awk 'BEGIN { for (i = 0; i < 3000; i++) print "0 0 0 1" }' >"$tmp/crowd"
status 65 "3000 balls in one place" timeout 20 bash -c "$(declare -f crowd); tmp=$tmp; set -o pipefail; crowd"
like "says so" "$(cat "$tmp/err")" 'in one place'
crowd_to() { nsd-gen "$tmp/crowd.json" | nsd-step -o "$tmp/none.h5"; }
refuses 65 "the same into a file" timeout 20 bash -c "$(declare -f crowd_to); tmp=$tmp; crowd_to"
ok "which is not left behind empty" [ ! -e "$tmp/none.h5" ]
ln -s none.h5 "$tmp/none.link"
crowd_to() { nsd-gen "$tmp/crowd.json" | nsd-step -o "$tmp/none.link"; }
refuses 65 "the same through a link" timeout 20 bash -c "$(declare -f crowd_to); tmp=$tmp; crowd_to"
ok "which stays" [ -L "$tmp/none.link" ]
table() { echo "{\"dt\": 1, \"bodies\": [{\"file\": \"$1\"}]}" | timeout 20 nsd-gen -; }
refuses 66 "a device for a table" table /dev/zero
mkfifo "$tmp/endless"
{ yes "$(printf '%05000d' 0)" >"$tmp/endless" || true; } 2>/dev/null &
refuses 65 "a table with lines without end" table "$tmp/endless"

alone() # the tool ends, whichever way, and no process of its is left to whoever inherits orphans
{
    py - "$@" <<'PYTHON'
import ctypes, os, subprocess, sys
ctypes.CDLL(None).prctl(36, 1, 0, 0, 0)  # PR_SET_CHILD_SUBREAPER: orphans become ours
s = subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode
try:
    sys.exit("an orphan: %s" % (os.waitpid(-1, 0),))
except ChildProcessError:
    sys.exit(s)
PYTHON
}
status 0 "a tool that is done leaves no process behind" alone nsd-info "$tmp/four.h5"
status 65 "nor one that refuses its input" alone nsd-step -n 1 "$tmp/crowd"
status 64 "nor one that is told nonsense" alone nsd-view --every 1 -o film "$tmp/four.h5"

# ---- copies ----

hostile "a name of two lines" 'a\?b' four.h5 "f['/a\nb'] = h5py.ExternalLink(tmp + '/four.h5', '/nsd')"
kept()
{
    make more.h5 four.h5 "f.create_dataset('/mine', data=np.arange(1000.), chunks=(100,), compression='gzip', shuffle=True, fletcher32=True)
f['/g/x'] = np.int16(3); f['/g/x'].attrs['k'] = np.arange(6, dtype='f4').reshape(2, 3); f['/words'] = np.array([b'a', b'bcd'])
f['/text'] = 'h\\u00e9llo'; f['/flags'] = np.array([True, False]); f['/u'] = np.array([2**64 - 1], 'u8')"
    nsd-cat --stream "$tmp/more.h5" >"$tmp/copy.h5" && py - "$tmp/more.h5" "$tmp/copy.h5" <<'PYTHON'
import sys, h5py, numpy as np
a, b = (h5py.File(p) for p in sys.argv[1:])
for name in '/mine', '/g/x', '/words', '/u', '/flags':
    assert np.array_equal(a[name][()], b[name][()]), name
assert a['/text'][()] == b['/text'][()] and np.array_equal(a['/g/x'].attrs['k'], b['/g/x'].attrs['k'])
PYTHON
}
ok "numbers and texts that nsd does not know are copied" kept
many()
{
    make many.h5 four.h5 "
for k in range(600): f['/g%d/x' % (k % 7) + str(k)] = np.arange(k % 50)" &&
        nsd-cat "$tmp/many.h5" >"$tmp/copy.h5" && py -c "
import h5py, numpy as np
f = h5py.File('$tmp/copy.h5')
for k in range(600): assert np.array_equal(f['/g%d/x' % (k % 7) + str(k)][()], np.arange(k % 50)), k"
}
ok "and hundreds of them" many
labelled()
{
    nsd-detect --fclib=local "$tmp/solved.h5" | tail -c +513 >"$tmp/problem.h5" &&
        /usr/bin/python3 -c "import h5py; f = h5py.File('$tmp/problem.h5', 'r+'); f['fclib_local'].attrs['by'] = 'hand'; f['fclib_local/W'].attrs['k'] = [1, 2]" &&
        nsd-solve "$tmp/problem.h5" 2>/dev/null | nsd-cat >"$tmp/copy.h5" &&
        py -c "import h5py; f = h5py.File('$tmp/copy.h5'); assert f['fclib_local'].attrs['by'] == b'hand' or f['fclib_local'].attrs['by'] == 'hand'; assert list(f['fclib_local/W'].attrs['k']) == [1, 2]"
}
ok "and attributes of the groups of an FCLIB problem from elsewhere" labelled
make compound.h5 four.h5 "f['/mine'] = np.zeros(3, [('a', 'i4'), ('b', 'f8')])"
refuses 65 "a compound would be lost: refused" nsd-cat "$tmp/compound.h5"
like "says which" "$(cat "$tmp/err")" '/mine: neither numbers nor texts'
status 0 "who copies nothing reads it" nsd-info "$tmp/compound.h5"

# ---- Python ----

module() # whatever it makes of these documents: nothing of the file "secret", and the status is that of the tools
{
    PYTHONPATH=$PWD/python NSD_LIBRARY=${NSD_LIBRARY-$(dirname "$(command -v nsd-gen)")/libnsd.so.2} timeout 120 /usr/bin/python3 - "$tmp" <<'PYTHON'
import glob, os, sys, nsd
refused = other = 0
for path in sorted(glob.glob(sys.argv[1] + "/hostile.*.h5")):
    try:
        for document in nsd.documents(path):
            for name in list(document.objects)[:100]:
                o = document[name]
                assert not hasattr(o, "shape") or "secret" not in str(o[()]), (path, name)
                o.attrs
        for frame in nsd.frames(path):
            frame.position, frame.report, frame.contacts
        other += 1
    except nsd.Error as e:
        assert e.status in (64, 65), (path, e.status, e)
        refused += 1
    except (KeyError, ValueError, IndexError, TypeError, MemoryError, EOFError):
        other += 1
assert refused > 2, (refused, other)
assert nsd.last(sys.argv[1] + "/four.h5").position.shape == (4, 3)
PYTHON
}
if grep -q __asan_init "$(command -v nsd-gen)"; then
    skip "the Python module" "its interpreter has no sanitizer"
else
    ok "the Python module reads nothing out of other files, and refuses with 65" module
fi

done_testing
