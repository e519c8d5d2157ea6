#!/usr/bin/env bash
# A document from elsewhere may have its numbers in any type of HDF5, and its texts of either kind: the same
# packing is read, from small documents and from large ones. What does not fit is refused.
# shellcheck source=tests/support/tap.sh disable=SC2154,SC2317 # tap.sh sets tmp; functions called by name
. tests/support/tap.sh

if ! have_h5py; then
    skip "types of numbers" "no h5py"
    done_testing
    exit
fi

# numbers that every type of reals holds: binary fractions
scene() # bodies
{
    jq -n --argjson n "$1" '{ dt: 0.0009765625, gravity: [0, 0, -8], title: "a scene",
        bodies: [range($n) | { x: [. , (. % 7) / 8, 1], radius: 0.25, v: [(. % 5) - 2, 0, 1] }], walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }] }' |
        nsd-gen - |
        tail -c +513
}
scene 40 >"$tmp/small.h5"
scene 30000 >"$tmp/large.h5"
for size in small large; do
    nsd-info -p "$tmp/$size.h5" >"$tmp/$size.bodies"
    nsd-info "$tmp/$size.h5" >"$tmp/$size.info"
done

# changed SIZE CODE: $tmp/bad.h5, changed by Python. retype: the dataset anew in another type; attr: an attribute
changed()
{
    cp "$tmp/$1.h5" "$tmp/bad.h5"
    py - "$tmp/bad.h5" "$2" <<'PYTHON'
import sys, h5py, numpy as np
f = h5py.File(sys.argv[1], 'r+')
A = '/particles/all/'
def retype(path, type, **how):
    data = f[path][()]
    attributes = dict(f[path].attrs)
    del f[path]
    f.create_dataset(path, data=data.astype(type), **how)
    f[path].attrs.update(attributes)
def attr(path, name, type):
    value = np.asarray(f[path].attrs[name])
    del f[path].attrs[name]
    f[path].attrs.create(name, value.astype(type))
exec(sys.argv[2])
f.close()
PYTHON
}
same() { changed "$1" "$2" && nsd-info -p "$tmp/bad.h5" | cmp - "$tmp/$1.bodies" && nsd-info "$tmp/bad.h5" | cmp - "$tmp/$1.info"; }
refused() # SIZE CODE REGEX
{
    changed "$1" "$2" || return 1
    refuses 65 "$1: $2" nsd-info -p "$tmp/bad.h5"
    like "says what" "$(cat "$tmp/err")" "$3"
}

for size in small large; do
    for type in u2 u4 u8 i2 i4 i8 '>i2' '>u4' '>i8'; do
        ok "$size: ids as $type" same $size "retype(A + 'id', '$type')"
    done
    for type in f4 f8 '>f4' '>f8'; do
        ok "$size: positions as $type" same $size "retype(A + 'position/value', '$type')"
    done
    for type in i1 i2 i4 i8 '>i4' f2 f4; do
        ok "$size: velocities, which are whole, as $type" same $size "retype(A + 'velocity/value', '$type')"
    done
    for type in u1 u2 u4 u8 f2; do
        ok "$size: orientations as $type" same $size "retype(A + 'orientation/value', '$type')"
    done
    ok "$size: packed, in chunks" same $size \
        "[retype(A + n, 'f8', chunks=(7,), compression='gzip', shuffle=True) for n in ('radius', 'mass', 'inertia')]"
    ok "$size: compact" same small "retype(A + 'species', 'i1')"
    refused $size "retype(A + 'id', 'f8')" 'id: .*integers are needed'
    refused $size "d = f[A + 'id'][()].astype('i8'); d[-1] = 2**31; del f[A + 'id']; f[A + 'id'] = d" 'id: '
    refused $size "d = f[A + 'id'][()].astype('u8'); d[0] = 2**63; del f[A + 'id']; f[A + 'id'] = d" 'id: '
    refused $size "d = f[A + 'id'][()].astype('i8'); d[0] = -2**31 - 1; del f[A + 'id']; f[A + 'id'] = d" 'id: '
    refused $size "retype(A + 'radius', 'S8')" 'radius: .*numbers are needed'
    refused $size "d = f[A + 'radius'][:-1]; del f[A + 'radius']; f[A + 'radius'] = d" 'position/value: not of shape'
    refused $size "d = f[A + 'radius'][()]; del f[A + 'radius']; f[A + 'radius'] = d.reshape(-1, 2)" 'radius: '
    refused $size "del f[A + 'mass']; f.create_group(A + 'mass')" 'mass: '
    refused $size "del f[A + 'mass']" 'mass: '
done

for type in u1 i2 i8 '>u4'; do ok "dim as $type" same small "attr('/nsd', 'dim', '$type')"; done
for type in f4 '>f4' '>f8'; do ok "dt as $type" same small "attr('/nsd', 'dt', '$type')"; done
for type in i1 f2 i8; do ok "gravity as $type" same small "attr('/nsd', 'gravity', '$type')"; done
for type in u1 u8 '>i4'; do ok "seed as $type" same small "attr('/nsd', 'seed', '$type')"; done
refused small "attr('/nsd', 'dim', 'f8')" 'dim: integers are needed'
refused small "f['/nsd'].attrs['dim'] = 4" 'dim'
refused small "f['/nsd'].attrs['dim'] = np.uint64(2**63 + 3)" 'dim'
refused small "f['/nsd'].attrs['dim'] = [3, 3]" 'dim: 2 values, 1 are needed'
refused small "f['/nsd'].attrs['gravity'] = [0.0, 1.0]" 'gravity: 2 values, 3 are needed'
refused small "f['/nsd'].attrs['dt'] = 'soon'" 'dt: numbers are needed'
refused small "del f['/nsd'].attrs['dt']" 'dt: no such attribute'
refused small "f['/nsd/material'].attrs['kinds'] = 3" 'kinds: cannot be read as a text'

# texts: fixed, of any length, padded otherwise
text() # code
{
    same small "$1" && cmp <(nsd-info --scene "$tmp/bad.h5" | sed s/bad.h5/small.h5/) <(nsd-info --scene "$tmp/small.h5")
}
nsd-info --help | grep -q -- --scene || text() { same small "$1"; }
ok "the scene as a string of any length" text "t = f['/nsd/scene'][()]; del f['/nsd/scene']; f['/nsd/scene'] = t.decode()"
ok "padded by zeros" text "t = f['/nsd/scene'][()]; del f['/nsd/scene']; f['/nsd/scene'] = np.bytes_(t)"
ok "kinds as a string of any length" text "k = f['/nsd/material'].attrs['kinds']; f['/nsd/material'].attrs['kinds'] = k if isinstance(k, str) else k.decode()"
refused small "del f['/nsd/scene']; f['/nsd/scene'] = 3" 'scene: a text is needed'

# documents of more than 64 MiB are given back to the system part by part, and read all the same
nsd-gen 600000 >"$tmp/huge.h5"
ok "a large document is one" [ "$(stat -c %s "$tmp/huge.h5")" -gt 70000000 ]
huge() { cmp <(nsd-cat "$tmp/huge.h5") <(nsd-cat <"$tmp/huge.h5") && cmp <(cat "$tmp/huge.h5" "$tmp/huge.h5" | nsd-info) <(nsd-info "$tmp/huge.h5" "$tmp/huge.h5"); }
ok "from a file and from a pipe, one after another" huge
foreign "$tmp/huge.h5" "$tmp/hugeforeign.h5"
ok "and without our header" cmp <(nsd-info "$tmp/huge.h5") <(nsd-info "$tmp/hugeforeign.h5")
rm "$tmp"/huge*

# copies of what nsd does not know, whatever its type and size
kept() # SIZE CODE: f['/mine'] and its attributes
{
    changed "$1" "$2" && nsd-cat --stream "$tmp/bad.h5" >"$tmp/copy.h5" && py - "$tmp/bad.h5" "$tmp/copy.h5" <<'PYTHON'
import sys, h5py, numpy as np
a, b = (h5py.File(p) for p in sys.argv[1:])
def text(v): return v.decode() if isinstance(v, bytes) else v # h5py has two kinds
def same(name, x):
    y = b[name]
    assert type(x) is type(y), name
    if isinstance(x, h5py.Dataset): assert x.shape == y.shape and np.array_equal(x[()], y[()]), name
    assert set(x.attrs) == set(y.attrs), (name, set(y.attrs))
    for k, v in x.attrs.items(): assert np.array_equal(text(v), text(y.attrs[k])), (name, k)
same('/mine', a['/mine'])
if isinstance(a['/mine'], h5py.Group): a['/mine'].visititems(lambda name, x: same('/mine/' + name, x))
PYTHON
}
types=(i1 u1 i2 u2 i4 u4 i8 u8 f4 f8 '>i2' '>u8' '>f4' S5)
[ -z "$thin" ] || types=(i1 u2 u8 f4 '>f4' S5)
for type in "${types[@]}"; do
    ok "$type is copied" kept small "f['/mine'] = np.arange(24).reshape(2, 3, 4).astype('$type'); f['/mine'].attrs['a'] = np.arange(6).reshape(2, 3).astype('$type')"
    ok "and a lot of it" kept small "f['/mine'] = np.arange(300000).reshape(300, 10, 100).astype('$type')"
    ok "and one of it" kept small "f['/mine'] = np.asarray(5).astype('$type'); f['/mine'].attrs['a'] = np.asarray(7).astype('$type')"
done
ok "and none of it" kept small "f.create_dataset('/mine', shape=(0, 3), dtype='f8')"
ok "and groups, with texts" kept small "g = f.create_group('/mine/deep/er'); g.attrs['t'] = 'text'; f['/mine'].attrs['n'] = [1, 2]; g['x'] = 'of any length'; f['/mine/y'] = np.bytes_('fixed')"
ok "and a name twice" kept small "f['/mine/a'] = [1, 2]; f['/mine/b'] = f['/mine/a']; f['/mine/soft'] = h5py.SoftLink('/mine/a')"
if command -v h5repack >/dev/null; then
    nsd-gen 50 | nsd-step -n 40 --contacts >"$tmp/whole.h5" 2>/dev/null
    h5repack -f GZIP=5 "$tmp/whole.h5" "$tmp/repacked.h5"
    refuses 65 "a document that h5repack has made smaller" nsd-info "$tmp/repacked.h5"
    like "is not only called truncated: the cure is given" "$(cat "$tmp/err")" 'bytes, where its header says [0-9]+: truncated, or rewritten \(h5repack\?\): then tail -c \+513'
    tail -c +513 "$tmp/repacked.h5" >"$tmp/plain.h5"
    is "which helps" "$(nsd-info -p "$tmp/plain.h5" | cksum)" "$(nsd-info -p "$tmp/whole.h5" | cksum)"
else
    skip "a document that h5repack has made smaller" "no h5repack"
fi
lost() # code
{
    changed small "$1" || return 1
    refuses 65 "$1 would be lost" nsd-cat --stream "$tmp/bad.h5"
    like "says so" "$(cat "$tmp/err")" 'cannot be copied'
}
lost "f['/mine'] = np.zeros(3, [('a', 'i4')])"
lost "f['/mine'] = np.zeros((1,) * 9)"
lost "f.create_dataset('/mine', data=['a', 'bc'], dtype=h5py.string_dtype())"
lost "f['/mine'] = h5py.Empty('f8')"
lost "f['/mine'] = np.dtype('f8')"
lost "f['/mine'] = np.array([f['/nsd'].ref], dtype=h5py.ref_dtype)"
lost "f['/mine'] = 1; f['/mine'].attrs['a'] = h5py.Empty('f8')"
lost "f['/mine'] = 1; f['/mine'].attrs.create('a', ['x', 'yz'], dtype=h5py.string_dtype())"
done_testing
