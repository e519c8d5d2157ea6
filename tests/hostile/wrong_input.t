#!/usr/bin/env bash
# Bad input: a clear line and the documented status, or the right result; never a crash, never a hang.
# shellcheck source=tests/support/tap.sh
. tests/support/tap.sh

readers=(nsd-detect nsd-solve nsd-err nsd-info nsd-cat nsd-move nsd-step nsd-view)
stride=4 # of bytes flipped and lengths cut; NSD_DEEP=1: each, in make check-rest
[ -z "$thin" ] || stride=6
[ -z "${NSD_DEEP-}" ] || stride=1

# A document that every reader takes
stock solved4 >"$tmp/good.h5"
size=$(wc -c <"$tmp/good.h5")
mapfile -t byte < <(od -An -v -tu1 -w1 "$tmp/good.h5")
# try TOOL FILE [pipe]: sets s, leaves FILE.out and FILE.err; what libhdf5 leaks of damaged files is its own.
# Pictures are small: a thousand of the usual size take minutes.
try()
{
    local -x ASAN_OPTIONS=$ASAN_OPTIONS:detect_leaks=0
    local small=()
    [ "$1" != nsd-view ] || small=(--size 32x32)
    s=0
    if [ -z "${3-}" ]; then
        timeout 20 "$1" "${small[@]}" "$2" >"$2.out" 2>"$2.err" || s=$?
    else
        { cat "$2" 2>/dev/null || true; } | timeout 20 "$1" "${small[@]}" >"$2.out" 2>"$2.err" || s=$?
    fi
}

for tool in "${readers[@]}"; do
    try "$tool" "$tmp/good.h5"
    is "$tool takes the document that is damaged next" "$s" 0
    mv "$tmp/good.h5.out" "$tmp/good.$tool"
done

# ---- damaged documents ----

# Each tool gets the damages of the header; two, by turns, each of the others.
some() # number all?
{
    local n=${#readers[@]}
    tools=("${readers[@]}")
    [ "$2" = 1 ] || tools=("${readers[$1 % n]}" "${readers[($1 + 3) % n]}")
}

# A status, nothing on stdout and one line on stderr, or a complaint
refused() # tool file status what [pipe]
{
    local s
    try "$1" "$2" "${5-}"
    [ "$s" = "$3" ] && [ ! -s "$2.out" ] && one_line "$s" "$2.err" ||
        echo "$1: $4: status $s, $(wc -c <"$2.out") bytes, $(head -c 300 "$2.err" | head -n 2)"
}

lengths=()
for ((k = 0; k <= 64; k += stride)); do lengths+=("$k"); done
for ((k = 0; k < 120; k += stride)); do lengths+=($((65 + k * (size - 66) / 119))); done
truncated()
{
    local length=${lengths[$1]} f=$tmp/cut.$BASHPID tools tool
    head -c "$length" "$tmp/good.h5" >"$f"
    some "$1" $((length <= 64))
    for tool in "${tools[@]}"; do
        if [ $(($1 % 2)) = 0 ]; then
            refused "$tool" "$f" 65 "$length bytes"
        else
            refused "$tool" "$f" 65 "$length bytes in a pipe" pipe
        fi
    done
}
ok_each "a document truncated at any length is refused with 65 and one line, by any tool" truncated ${#lengths[@]}

# Byte AT of the worker's own copy F, of a file whose bytes are in `byte`, flipped by FLIP
flip() # f original at flip
{
    [ -e "$1" ] || cp "$2" "$1"
    poke "$1" "$3" $((byte[$3] ^ $4))
}
flips=(1 128 255 64 16)
places=()
for ((k = 0; k < 96; k += stride)); do places+=("$k"); done
for ((k = 0; k < 200; k += stride)); do places+=($((96 + k * 163 % (size - 96)))); done
for ((k = 0; k < 60; k += stride)); do places+=($((size - 1 - k * 997 % (size - 96)))); done
damaged()
{
    local at=${places[$1]} how=${flips[$1 % 5]} f=$tmp/flip.$BASHPID tools tool s
    flip "$f" "$tmp/good.h5" "$at" "$how"
    some "$1" $((at < 32))
    for tool in "${tools[@]}"; do
        if [ "$at" -ge 32 ] && [ "$at" -lt 512 ]; then # behind the header: nothing that matters
            try "$tool" "$f"
            [ "$s" = 65 ] || { [ "$s" = 0 ] && cmp -s "$f.out" "$tmp/good.$tool"; } ||
                echo "$tool: byte $at ^ $how: status $s"
        else
            refused "$tool" "$f" 65 "byte $at ^ $how"
        fi
    done
    poke "$f" "$at" "${byte[at]}"
}
ok_each "one flipped byte is noticed by any tool, or changes nothing" damaged ${#places[@]}

cp "$tmp/good.h5" "$tmp/newer.h5"
header "$tmp/newer.h5" 2 0 "$size"
ok "a header written by this test is like nsd's" cmp "$tmp/good.h5" "$tmp/newer.h5"
header "$tmp/newer.h5" 3 0 "$size"
: >"$tmp/empty.h5"
RANDOM=2012
for ((k = 0; k < 1000; k++)); do printf '%b' "\\x$(printf %02x $((RANDOM & 255)))"; done >"$tmp/random.h5"
echo "This is a text, not a document, and longer than eight bytes." >"$tmp/text.h5"
mkdir "$tmp/directory.h5"
h5copy -i "$tmp/good.h5" -o "$tmp/other.h5" -s /nsd -d /something
head -c 512 "$tmp/good.h5" >"$tmp/header.h5"
cat "$tmp/good.h5" "$tmp/text.h5" >"$tmp/tail.h5"
for tool in "${readers[@]}"; do
    refuses 65 "$tool: a document of a newer version" "$tool" "$tmp/newer.h5"
    like "$tool: and says which" "$(cat "$tmp/err")" 'newer.h5: .*3.*2'
    refuses 65 "$tool: an empty file" "$tool" "$tmp/empty.h5"
    refuses 65 "$tool: no input" "$tool" </dev/null
    refuses 65 "$tool: random bytes" "$tool" "$tmp/random.h5"
    refuses 65 "$tool: a text" "$tool" "$tmp/text.h5"
    refuses 65 "$tool: a header alone" "$tool" "$tmp/header.h5"
    refuses 65 "$tool: an HDF5 file with nothing for us in it" "$tool" "$tmp/other.h5"
    refuses 66 "$tool: a directory" "$tool" "$tmp/directory.h5"
    refuses 66 "$tool: a directory on stdin" "$tool" <"$tmp/directory.h5"
    refuses 66 "$tool: a missing file" "$tool" "$tmp/missing.h5"
    like "$tool: and says which" "$(cat "$tmp/err")" "^$tool: $tmp/missing.h5: No such file"
    status 65 "$tool: text behind a document" "$tool" "$tmp/tail.h5"
    like "$tool: and says where" "$(tail -n 1 "$tmp/err")" "^$tool: $tmp/tail.h5: document 2: "
done
cp "$tmp/good.h5" "$tmp/old.h5"
refuses 65 "nsd-step -o: bad input" nsd-step -o "$tmp/old.h5" "$tmp/text.h5"
ok "leaves FILE as it was" cmp "$tmp/good.h5" "$tmp/old.h5"
refuses 65 "nsd-cat -o: bad input" nsd-cat -o "$tmp/old.h5" "$tmp/text.h5"
ok "leaves FILE as it was" cmp "$tmp/good.h5" "$tmp/old.h5"
rm "$tmp/old.h5"
for tool in nsd-cat nsd-step; do
    refuses 65 "$tool -o: bad input" "$tool" -o "$tmp/new.h5" "$tmp/text.h5"
    ok "$tool leaves no new file" test ! -e "$tmp/new.h5"
    rm -f "$tmp/new.h5"
done

# ---- what no checksum vouches for ----

# survives TOOL F WHAT: any answer, but an answer
survives()
{
    local s
    try "$1" "$2"
    case $s in
    0 | 1) ;;
    65) [ ! -s "$2.out" ] && [[ $(tail -n 1 "$2.err") == "${1%-from}: "* ]] || echo "$1: $3: $(head -c 300 "$2.err" | head -n 2)" ;;
    *) echo "$1: $3: status $s: $(head -c 500 "$2.err" | head -n 3)" ;;
    esac
}

# fuzz FILE TOOL ...: flips and truncations, half of them where the metadata are
fuzz()
{
    original=$1 victims=("${@:2}")
    mapfile -t byte < <(od -An -v -tu1 -w1 "$original")
    rm -f "$tmp"/fuzz.*
}
fuzzed()
{
    local n=${#byte[@]} k=$(($1 * stride)) f=$tmp/fuzz.$BASHPID how=${flips[$1 % 5]} at tool
    at=$((k % 2 ? k * 7919 % n : k * 15 % 4096 % n))
    flip "$f" "$original" "$at" "$how"
    for tool in "${victims[@]}"; do survives "$tool" "$f" "byte $at ^ $how"; done
    poke "$f" "$at" "${byte[at]}"
}
cut_short()
{
    local n=${#byte[@]} f=$tmp/short.$BASHPID tool
    head -c $(($1 * stride * n / 60)) "$original" >"$f"
    for tool in "${victims[@]}"; do survives "$tool" "$f" "$(($1 * stride * n / 60)) bytes"; done
}
fuzz_all() # name file flips tool ...
{
    fuzz "$2" "${@:4}"
    ok_each "$1 with a flipped byte: no crash, no hang (${*:4})" fuzzed $(($3 / stride))
    ok_each "$1 truncated: no crash, no hang (${*:4})" cut_short $((60 / stride))
}

nsd-detect --fclib=local "$tmp/good.h5" >"$tmp/local.h5"
nsd-detect --fclib=global "$tmp/good.h5" >"$tmp/global.h5"
for form in local global; do
    h5copy -i "$tmp/$form.h5" -o "$tmp/$form.hdf5" -s /fclib_$form -d /fclib_$form
    fuzz_all "an FCLIB problem ($form)" "$tmp/$form.hdf5" 300 nsd-solve
    foreign <(nsd-solve "$tmp/$form.hdf5" 2>/dev/null) "$tmp/$form-solved.hdf5"
    fuzz_all "a solved FCLIB problem ($form)" "$tmp/$form-solved.hdf5" 100 nsd-err
done
if [ -d "$problems" ]; then
    fuzz_all "a published problem (local)" "$problems/OneObject-i1028-138.hdf5" 150 nsd-solve
    fuzz_all "a published problem (global)" "$(find "$problems/global" -type f -size -100k | sort | head -n 1)" 150 nsd-solve
else
    skip "published problems with a flipped byte" "no ../shared/problems"
fi
cp "$tmp/good.h5" "$tmp/unfinished.h5"
header "$tmp/unfinished.h5" 2 1 0
fuzz_all "an unfinished document" "$tmp/unfinished.h5" 150 nsd-err nsd-step nsd-view

# ---- documents with numbers that cannot be ----

foreign "$tmp/good.h5" "$tmp/base.h5"
# edits FILE CHANGE ...: copies of it in $tmp/wrong.0, .1 ..., each with one change, in Python
edits()
{
    py - "$tmp/wrong." "$@" <<'PYTHON'
import shutil, sys, h5py, numpy as np
out, base, changes = sys.argv[1], sys.argv[2], sys.argv[3:]
for k, change in enumerate(changes):
    shutil.copy(base, out + str(k))
    f = h5py.File(out + str(k), 'r+')
    def new(path, value):
        del f[path]
        f[path] = value
    exec(change, {'f': f, 'np': np, 'nan': np.nan, 'inf': np.inf, 'new': new, 'P': '/particles/all/',
                  'C': '/contacts/', 'L': '/fclib_local/', 'G': '/fclib_global/'})
    f.close()
PYTHON
}
refuses_edits() # what tool file change ...
{
    local k change=("${@:4}")
    edits "${@:3}"
    for k in "${!change[@]}"; do
        refuses 65 "$1 after ${change[k]}" timeout 20 "$2" "$tmp/wrong.$k"
    done
}
wrong_packings=(
    "f[P + 'radius'][0] = -1e-3" "f[P + 'radius'][0] = 0" "f[P + 'radius'][1] = nan" "f[P + 'mass'][0] = -1"
    "f[P + 'mass'][0] = inf" "f[P + 'inertia'][0] = -1" "f[P + 'position/value'][0, 0, 0] = nan"
    "f[P + 'velocity/value'][0, 0, 1] = inf" "f[P + 'angular_velocity/value'][0, 0, 1] = nan"
    "f[P + 'orientation/value'][0, 0] = [1, 1, 0, 0]" "f[P + 'species'][0] = 7" "f[P + 'species'][0] = -1"
    "f['/nsd'].attrs['dim'] = 4" "f['/nsd'].attrs['dt'] = -1." "f['/nsd'].attrs['dt'] = nan"
    "f['/nsd'].attrs['theta'] = 2." "f['/nsd'].attrs['gravity'] = [0., 0., nan]" "del f['/nsd'].attrs['dt']"
    "f['/nsd'].attrs['overlap'] = 'magic'" "f['/nsd'].attrs['overlap'] = 3"
    "f['/nsd'].attrs['dt'] = 'soon'" "f['/nsd/material/mu'][0, 0] = -0.1" "f['/nsd/material/mu'][0, 0] = nan"
    "f['/particles/boundary/body/normal'][0] = [0, 0, 0]" "f['/particles/boundary/body/point'][0] = [nan, 0, 0]"
    "new(P + 'radius', np.ones(3))" "new(P + 'radius', np.ones((4, 1)))" "new(P + 'radius', b'four')"
    "new(P + 'position/value', np.zeros((1, 4, 2)))" "new(P + 'position/value', np.zeros((4, 3)))"
    "del f[P + 'mass']" "del f[P + 'velocity']" "del f[P + 'position/step']" "del f['/nsd/material']" "del f['/nsd']"
    "new(P + 'mass', 1.)" "f['/particles/boundary/body'].move('normal', 'abnormal')"
)
wrong_contacts=(
    "f[C + 'body'][0] = [99, 0]" "f[C + 'body'][0] = [-99, 0]" "f[C + 'body'][0] = [0, 99]" "f[C + 'body'][0] = [0, 0]"
    "f[C + 'body'][0] = [0, -1]" "f[C + 'gap'][0] = nan" "f[C + 'mu'][0] = -1" "f[C + 'en'][0] = 2" "f[C + 'et'][0] = nan"
    "f[C + 'frame'][0] = np.ones((3, 3))" "f[C + 'frame'][0] = f[C + 'frame'][0] * [[1], [1], [-1]]" "f[C + 'point'][0, 0] = nan" "f[C + 'reaction'][0, 0] = nan"
    "f[C + 'velocity'][0, 0] = inf" "new(C + 'gap', np.zeros(1))" "new(C + 'frame', np.zeros((1, 9)))"
    "f[C + 'count'][0] = 999" "f[C + 'count'][0] = -1" "f[C + 'start'][0] = -1" "f[C + 'start'][0] = 2**62"
    "del f[C + 'mu']" "del f[C + 'start']"
)
wrong_local=(
    "new(L + 'vectors/q', np.ones(2))" "new(L + 'vectors/q', np.zeros(0))" "new(L + 'vectors/mu', np.ones(1))"
    "f[L + 'vectors/mu'][0] = -1" "f[L + 'vectors/mu'][0] = nan" "f[L + 'vectors/q'][0] = inf" "f[L + 'W/x'][0] = nan"
    "f[L + 'spacedim'][0] = 0" "f[L + 'spacedim'][0] = 7" "f[L + 'spacedim'][0] = -3" "f[L + 'W/m'][0] = 1"
    "f[L + 'W/n'][0] = -1" "f[L + 'W/m'][0] = 2**31 - 1" "f[L + 'W/nzmax'][0] = -5"
    "f[L + 'W/nz'][0] = 5" "f[L + 'W/nz'][0] = -7" "f[L + 'W/p'][1] = 2**30" "f[L + 'W/p'][1] = -4" "f[L + 'W/p'][-1] = 2**30"
    "f[L + 'W/i'][0] = 2**30" "f[L + 'W/i'][0] = -1" "new(L + 'W/x', np.ones(1))" "new(L + 'W/i', np.ones(1, 'i4'))"
    "new(L + 'W/p', np.zeros(2, 'i4'))" "new(L + 'W/p', np.zeros(0, 'i4'))" "new(L + 'W/x', b'text')" "del f[L + 'W/x']"
    "del f[L + 'W']" "del f[L + 'vectors/mu']" "del f[L + 'spacedim']" "new(L + 'W', np.zeros((3, 3)))"
)
odd_local=("f[L + 'W/x'][...] = 0" "f[L + 'W/x'][...] *= -1" "f[L + 'W/nzmax'][0] = 2**31 - 1" "f[L + 'vectors/mu'][...] = 50"
    "f[L + 'vectors/q'][...] = 0" "f[L + 'vectors/q'][...] = 1e300" "f[L + 'W/x'][...] *= 1e-300" "del f[L + 'info']")
wrong_global=(
    "new(G + 'vectors/f', np.ones(2))" "new(G + 'vectors/w', np.ones(2))" "new(G + 'vectors/mu', np.ones(1))"
    "f[G + 'vectors/f'][0] = nan" "f[G + 'M/x'][0] = inf" "f[G + 'H/x'][0] = nan" "f[G + 'M/x'][...] = 0"
    "f[G + 'M/m'][0] = 1" "f[G + 'H/n'][0] = 1" "f[G + 'H/p'][1] = 2**30" "f[G + 'H/i'][0] = 2**30" "f[G + 'H/i'][0] = -1"
    "f[G + 'M/p'][1] = -9" "new(G + 'M/x', np.ones(1))" "new(G + 'H/x', np.ones(1))" "del f[G + 'H']" "del f[G + 'M']"
    "f[G + 'spacedim'][0] = 9" "del f[G + 'vectors/f']"
)
if have_h5py; then
    refuses_edits "a packing" nsd-step "$tmp/base.h5" "${wrong_packings[@]}"
    # every number of a report and of the account, in a document of which frames have gone before
    nsd-step -n 2 --contacts "$tmp/good.h5" 2>/dev/null >"$tmp/stepped.h5"
    foreign "$tmp/stepped.h5" "$tmp/reported.h5"
    mapfile -t wrong_reports < <(/usr/bin/python3 -c '
import sys, h5py
def see(name, o):
    if isinstance(o, h5py.Dataset) and o.dtype.kind == "f" and not name.endswith("/time"):
        for x in "nan", "inf": print(f"f[{name!r}][1] = {x}")
with h5py.File(sys.argv[1]) as f:
    for group in "nsd/solver", "nsd/account": f[group].visititems(lambda name, o, group=group: see(group + "/" + name, o))
' "$tmp/reported.h5")
    ok "reports and accounts have ${#wrong_reports[@]} such changes" test "${#wrong_reports[@]}" -gt 40
    refuses_edits "a report" nsd-step "$tmp/reported.h5" "${wrong_reports[@]}" "f['nsd/solver/time'][1] = nan"
    for tool in nsd-info nsd-stat "nsd-view -o $tmp/v.png" "nsd-export -t csv" nsd-cat; do
        edits "$tmp/reported.h5" "f['nsd/solver/eps/value'][:, 0] = nan"
        # shellcheck disable=SC2086 # a tool and its options
        refuses 65 "$tool: errors that are no numbers" timeout 20 $tool "$tmp/wrong.0"
    done
    refuses_edits "contacts" nsd-move "$tmp/base.h5" "${wrong_contacts[@]}"
    refuses_edits "a local problem" nsd-solve "$tmp/local.hdf5" "${wrong_local[@]}"
    refuses_edits "a global problem" nsd-solve "$tmp/global.hdf5" "${wrong_global[@]}"
    edits "$tmp/local.hdf5" "${odd_local[@]}"
    for k in "${!odd_local[@]}"; do
        status 0 "a local problem after ${odd_local[k]} has an answer" timeout 20 nsd-solve "$tmp/wrong.$k"
    done
else
    skip "documents with wrong numbers and shapes" "no h5py"
fi

# ---- documents that are not what the tool needs ----

nsd-gen 4 >"$tmp/packing.h5"
nsd-detect "$tmp/good.h5" >"$tmp/contacts.h5"
nsd-move "$tmp/good.h5" >"$tmp/moved.h5"
refuses 65 "nsd-solve needs contacts" nsd-solve "$tmp/packing.h5"
refuses 65 "nsd-move needs contacts" nsd-move "$tmp/packing.h5"
refuses 65 "nsd-move needs solved contacts" nsd-move "$tmp/contacts.h5"
refuses 65 "nsd-err needs contacts" nsd-err "$tmp/packing.h5"
refuses 65 "nsd-err needs solved contacts" nsd-err "$tmp/contacts.h5"
refuses 65 "nsd-err needs a solution" nsd-err "$tmp/local.hdf5"
refuses 65 "nsd-move moves once" nsd-move "$tmp/moved.h5"
for tool in nsd-detect nsd-move nsd-step; do
    refuses 65 "$tool needs bodies" "$tool" "$tmp/local.hdf5"
done

# ---- frames that do not belong into one trajectory ----

one='{"dt": 1e-3, "bodies": [{"x": [0, 0, 0], "radius": 1}], "walls": [{"point": [0, 0, -1], "normal": [0, 0, 1]}]}'
nsd-gen - <<<"$one" >"$tmp/one.h5"
nsd-step --overlap-rule keep --contacts "$tmp/one.h5" 2>/dev/null | nsd-cat --stream >"$tmp/kept.h5"
apart() # what regex jq
{
    jq "$3" <<<"$one" | nsd-gen - >"$tmp/two.h5"
    refuses 65 "$1 in one trajectory" nsd-cat -o "$tmp/joined.h5" "$tmp/one.h5" "$tmp/two.h5"
    like "says what" "$(cat "$tmp/err")" "two.h5: $2"
    is "what came before is there" "$(nsd-info "$tmp/joined.h5" | jq -s -c '[.[].step | numbers]')" '[0]'
    rm -f "$tmp/joined.h5"
}
apart "other numbers of bodies" '2 bodies, and the trajectory has 1' '.bodies += [{"x": [5, 0, 0], "radius": 1}]'
apart "balls and discs" "dim differs from the trajectory's" '.dim = 2 | .bodies[0].x = [0, 0] | .walls = []'
apart "two lengths of a step" "dt is 0.002 s, and the trajectory's is 0.001 s" '.dt = 2e-3'
apart "two thetas" "theta is 0.6, and the trajectory's is 0.5" '.theta = 0.6'
apart "two sizes of a body" "other bodies than the trajectory's: their radius differs" '.bodies[0].radius = 0.9'
apart "a cell and none" "cell: periodic differs from the trajectory's" '.walls = [] | .cell = {"lengths": [9, 9, 9]}'
apart "a pour and none" "other pours or removals than the trajectory's" '.pour = [{"rate": 1, "radius": 1, "opening": {"box": {"x": [0, 1], "y": [0, 1], "z": [5, 6]}}}]'
apart "two frictions" "materials ball and ball: mu is 0.3, and the trajectory's is 0" '.mu = 0.3'
apart "two normals of a wall" "wall 0: normal differs from the trajectory's" '.walls[0].normal = [0, 0.1, 1] | .bodies[0].x[2] = 0.1'
apart "two velocities of a wall" "wall 0: velocity differs from the trajectory's" '.walls[0].velocity = [1, 0, 0]'
apart "a wall that is worn" "wall 0: wear is 1e-09, and the trajectory's is 0" '.walls[0].wear = 1e-9'
apart "a wall under a load" "load 0: way differs from the trajectory's" '.walls[0].load = {"along": [0, 0, 1], "mass": 1, "force": 1}'
apart "other numbers of walls" "the number of walls is 2, and the trajectory's is 1" '.walls += [.walls[0]]'
apart "a wall that is driven" "the number of drives is 1, and the trajectory's is 0" '.walls[0].drives = [{"along": [0, 0, 1], "speed": 1}]'
apart "a wall with a name" "the number of names is 1, and the trajectory's is 0" '.walls[0].name = "floor"'
apart "two gravities" "gravity differs from the trajectory's" '.gravity = [0, 0, -1]'
apart "two densities" "other bodies than the trajectory's: their mass differs" '.density = 7'
apart "pairs that stick together and others" "pairs of materials have laws .* in the frame alone" '.cohesion = {"force": 1, "range": 0.1}'
apart "two seeds" "seed differs from the trajectory's" '.seed = 7'
apart "two scenes" "the scene differs from the trajectory's" '.title = "another"'
apart "a step twice" "step 0 after step 0: a trajectory's steps increase" '.'
nsd-step -n 1 --overlap-rule gap "$tmp/kept.h5" 2>/dev/null | nsd-cat --stream >"$tmp/two.h5"
refuses 65 "two ways against overlap in one trajectory" nsd-cat -o "$tmp/joined.h5" "$tmp/kept.h5" "$tmp/two.h5"
like "says what" "$(cat "$tmp/err")" "overlap differs from the trajectory's"
nsd-step --contacts "$tmp/kept.h5" 2>/dev/null | nsd-cat --stream | nsd-detect >"$tmp/two.h5"
refuses 65 "solved contacts and unsolved ones" nsd-cat -o "$tmp/joined.h5" "$tmp/kept.h5" "$tmp/two.h5"
like "says what" "$(cat "$tmp/err")" 'contacts solved and unsolved in one trajectory'
nsd-step -n 2 -m sbp "$tmp/kept.h5" -o "$tmp/two.h5" 2>/dev/null
status 0 "reports of two methods are joined" nsd-cat -o "$tmp/joined.h5" "$tmp/kept.h5" "$tmp/two.h5"
like "with a warning" "$(cat "$tmp/err")" 'two.h5: solved by -m sbp .* the trajectory states -m [a-z]+ '
rm -f "$tmp/joined.h5"
refuses 65 "an FCLIB problem behind a packing" nsd-cat -o "$tmp/joined.h5" "$tmp/one.h5" "$tmp/local.hdf5"
like "says what" "$(cat "$tmp/err")" 'an FCLIB problem does not go into a trajectory'

# ---- scenes ----

# scene TEXT: nsd-gen of it
scene() { printf '%s' "$1" | nsd-gen -; }
bad_scene() # name text regex; one that begins with line:column has the input's name in front
{
    local regex=$3
    [[ $3 == [\[0-9]* ]] && regex="standard input:$3"
    refuses 65 "nsd-gen: $1" scene "$2"
    like "says where and what" "$(cat "$tmp/err")" "^nsd-gen: $regex"
}
ball='"x": [0, 0, 1], "radius": 0.5'
bad_scene "nothing" '' '[01]:[01]: '
bad_scene "a text" 'balls' '1:[0-9]+: '
bad_scene "JSON that ends too early" '{"dt": 1e-3,' '1:12: '
bad_scene "an error on line 3" $'{"dt": 1e-3,\n "mu": 0.5,\n "seed" 4}' '3:[0-9]+: '
bad_scene "a key twice" '{"dt": 1, "dt": 2}' '1:[0-9]+: duplicate'
bad_scene "an array" '[1, 2]' '1:1: '
bad_scene "NaN" '{"dt": NaN}' '1:[0-9]+: '
bad_scene "a number that overflows" '{"dt": 1e999}' '1:[0-9]+: '
bad_scene "an unknown key" $'{"dt": 1,\n  "colour": 3}' '2:3: colour: unknown key'
bad_scene "an unknown key inside" $'{"dt": 1, "bodies": [\n{"x": [0, 0, 0],\n  "radios": 1}]}' '3:3: bodies\[0\].radios: unknown'
bad_scene "no dt, and nothing that moves" '{"mu": 1}' 'dt: is missing, and nothing in the scene moves'
bad_scene "a negative dt" '{"dt": -1}' '1:2: dt: must be positive'
bad_scene "dim = 4" '{"dt": 1, "dim": 4}' '1:11: dim: '
bad_scene "dim = 2.5" '{"dt": 1, "dim": 2.5}' '1:11: dim: '
bad_scene "a text for a number" '{"dt": 1, "mu": "0.3"}' '1:11: mu: needs a number'
bad_scene "a negative mu" '{"dt": 1, "mu": -0.1}' '1:11: mu: '
bad_scene "e_n = 1.1" '{"dt": 1, "e_n": 1.1}' '1:11: e_n: '
bad_scene "a negative radius" '{"dt": 1, "bodies": [{"x": [0, 0, 0], "radius": -1}]}' '1:39: bodies\[0\].radius: must be positive'
bad_scene "a radius of 0" '{"dt": 1, "bodies": [{"x": [0, 0, 0], "radius": 0}]}' '1:39: bodies\[0\].radius: '
bad_scene "a radius so small that it has no mass" '{"dt": 1, "bodies": [{"x": [0, 0, 0], "radius": 1e-200}]}' '.*mass'
bad_scene "a radius so large that its mass is infinite" '{"dt": 1, "bodies": [{"x": [0, 0, 0], "radius": 1e200}]}' '.*mass'
bad_scene "a negative mass" "{\"dt\": 1, \"bodies\": [{$ball, \"mass\": -1}]}" '1:54: bodies\[0\].mass: '
bad_scene "a negative density" '{"dt": 1, "density": -1}' '1:11: density: '
bad_scene "a place in the plane, and dim is 3" '{"dt": 1, "bodies": [{"x": [0, 0], "radius": 1}]}' '1:23: bodies\[0\].x: needs \[x, y, z\]'
bad_scene "an unknown kind" "{\"dt\": 1, \"bodies\": [{$ball, \"material\": \"jelly\"}]}" '1:54: bodies\[0\].material: no material'
bad_scene "a normal of zero" '{"dt": 1, "walls": [{"point": [0, 0, 0], "normal": [0, 0, 0]}]}' '1:42: walls\[0\].normal: must not be zero'
bad_scene "radii the wrong way round" '{"dt": 1, "bodies": [{"count": 1, "radius": {"uniform": [2, 1]}, "box": {"x": [0, 9], "y": [0, 9], "z": [0, 9]}}]}' \
    '1:[0-9]+: bodies\[0\].radius.uniform: '
bad_scene "more balls than the box holds" '{"dt": 1, "bodies": [{"count": 900, "radius": 1, "box": {"x": [0, 9], "y": [0, 9], "z": [0, 9]}}]}' \
    '1:[0-9]+: bodies\[0\].count: 900 bodies'
bad_scene "a box narrower than a ball" '{"dt": 1, "bodies": [{"count": 1, "radius": 1, "box": {"x": [0, 1], "y": [0, 9], "z": [0, 9]}}]}' \
    '1:[0-9]+: bodies\[0\].box: '
bad_scene "a negative count" '{"dt": 1, "bodies": [{"count": -5, "radius": 1}]}' '1:[0-9]+: bodies\[0\].'
bad_scene "balls that overlap" "{\"dt\": 1, \"bodies\": [{$ball}, {\"x\": [0.9, 0, 1], \"radius\": 0.5}]}" '.*bodies 0 and 1 overlap by 0.1'
bad_scene "identical balls" "{\"dt\": 1, \"bodies\": [{$ball}, {$ball}]}" '.*bodies 0 and 1 overlap by 1 '
bad_scene "a ball in the floor" "{\"dt\": 1, \"bodies\": [{$ball}], \"walls\": [{\"point\": [0, 0, 0.7], \"normal\": [0, 0, 1]}]}" '.*body 0 is 0.2 m deep in wall 0'
deep() { { printf '[%.0s' {1..100000} && printf ']%.0s' {1..100000}; } | nsd-gen -; }
refuses 65 "nsd-gen: 100 000 brackets" deep
binary() { nsd-gen - <"$tmp/good.h5"; }
refuses 65 "nsd-gen: a document for a scene" binary
bytes() { printf '{"dt\0": 1, "a\nb\033[1m": 2}' | nsd-gen -; }
refuses 65 "nsd-gen: a NUL and control characters in a key" bytes
is "are not sent to the terminal" "$(tr -d '[:print:]\n' <"$tmp/err")" ""

table() # lines of it
{
    printf '%b' "$1" >"$tmp/balls.txt"
    echo '{"dt": 1e-3, "bodies": [{"file": "balls.txt"}]}' >"$tmp/table.json"
    nsd-gen "$tmp/table.json"
}
bad_table() # name text line
{
    refuses 65 "nsd-gen: a table with $1" table "$2"
    like "says on which line" "$(cat "$tmp/err")" "^nsd-gen: $tmp/balls.txt:$3: "
}
bad_table "nan" '0 0 0 1\nnan 0 0 1\n' 2
bad_table "inf" '0 0 inf 1\n' 1
bad_table "a negative radius" '# balls\n\n0 0 0 -1\n' 3
bad_table "a radius of 0" '0 0 0 0\n' 1
bad_table "three numbers" '0 0 1\n' 1
bad_table "five numbers" '0 0 1 1 1\n' 1
bad_table "words" '0 0 one 1\n' 1
bad_table "commas" '0,0,0,1\n' 1
bad_table "a NUL" '0 0 0 1\n0 0 5 \x00 1\n' 2
refuses 65 "nsd-gen: a table with the same ball twice" table '0 0 0 1\n0 0 0 1\n'
rm "$tmp/balls.txt"
refuses 66 "nsd-gen: a scene whose table is missing" nsd-gen "$tmp/table.json"
like "says which" "$(cat "$tmp/err")" "^nsd-gen: $tmp/balls.txt: No such file"
mkdir "$tmp/balls.txt"
refuses 66 "nsd-gen: a scene whose table is a directory" nsd-gen "$tmp/table.json"
refuses 66 "nsd-gen: a missing scene" nsd-gen "$tmp/missing.json"
refuses 66 "nsd-gen: a directory for a scene" nsd-gen "$tmp"
refuses 66 "nsd-gen: N = abc is a scene that is missing" nsd-gen abc
identical() { echo "{\"dt\": 1e-3, \"overlap\": true, \"bodies\": [{$ball}, {$ball}]}" | nsd-gen - | nsd-step -n 5 | nsd-info --last -p; }
status 0 "identical balls that may overlap make steps" identical
ok "and stay finite" jq -e -s 'length == 2 and all(.x + .v | all(isfinite))' "$tmp/out"

# ---- usage ----

refuses 64 "nsd-gen: N = -5" nsd-gen -5
refuses 64 "nsd-gen: N = 99999999999" nsd-gen 99999999999
refuses 64 "nsd-gen: N beyond any integer" nsd-gen 99999999999999999999999999
refuses 64 "nsd-gen: two numbers" nsd-gen 4 4
refuses 64 "nsd-gen: no operand" nsd-gen
refuses 64 "nsd-gen: an empty operand" nsd-gen ''
refuses 64 "nsd-gen -d 4" nsd-gen -d 4 10
if ! grep -q __asan_init "$(command -v nsd-gen)"; then # the sanitizer needs terabytes of addresses
    many() { (ulimit -v 2000000 && nsd-gen 2000000000); }
    refuses 65 "nsd-gen: more balls than memory" many
fi
for tool in nsd-gen "${readers[@]}"; do
    refuses 64 "$tool: an unknown option" "$tool" --no-such-option
    refuses 64 "$tool: an unknown letter" "$tool" -Z
done
for tool in nsd-solve nsd-step; do
    for option in '--tolerance -1' '--tolerance nan' '--tolerance inf' '--tolerance 1e' '--tolerance=' '--tolerance 1x' '-m newton' '--local SBP' '-m=' \
        '--criterion best' '--order up' '--newton no' '--max-sweeps -1' '--max-sweeps 2.5' '--max-sweeps 1e30' \
        '--relax 0' '--relax 2' '--relax nan' '--alpha 0' '--alpha -1' '--newton-tolerance 0' '--newton-max 0' '--theta 2' \
        '--theta -0.1' '-j 0' '-j -2' '-j many'; do
        # shellcheck disable=SC2086 # words
        refuses 64 "$tool $option" "$tool" $option "$tmp/contacts.h5"
    done
    for option in --tolerance -m --max-sweeps -j --log; do
        refuses 64 "$tool $option without its argument" "$tool" "$tmp/contacts.h5" $option
    done
done
for option in '-n -1' '-n x' '-n 1e99' '-n 0.5' '--every 0' '--every -1' '--gap -1' '--gap nan'; do
    # shellcheck disable=SC2086 # words
    refuses 64 "nsd-step $option" nsd-step $option "$tmp/packing.h5"
done
for option in '--gap -1' '--theta 1.5' '--fclib=both' '--fclib'; do
    # shellcheck disable=SC2086 # words
    refuses 64 "nsd-detect $option" nsd-detect "$tmp/packing.h5" $option
done
for tool in nsd-cat nsd-info; do
    for steps in x 1-2 5:3 1:2:0 1:2:3:4 -1:2 :: '' 1:2:; do
        case $steps in :: | 1:2:) continue ;; esac
        refuses 64 "$tool --frames '$steps'" "$tool" --frames "$steps" "$tmp/packing.h5"
    done
    refuses 64 "$tool --last --frames 1" "$tool" --last --frames 1 "$tmp/packing.h5"
done
refuses 64 "nsd-solve --overlap-rule that needs other contacts" nsd-solve --overlap-rule gap "$tmp/contacts.h5"
refuses 64 "nsd-solve --theta other than the contacts'" nsd-solve --theta 0.9 "$tmp/contacts.h5"

# ---- found by newcomers ----

one_then_more() # a frame with a single contact is detected again, wider
{
    echo '{"dt": 1e-4, "walls": [{"point": [0, 0, 0], "normal": [0, 0, 1]}],
           "bodies": [{"x": [0, 0, 1e-3], "radius": 1e-3}, {"x": [3e-3, 0, 2e-3], "radius": 1e-3},
                      {"x": [6e-3, 0, 2e-3], "radius": 1e-3}, {"x": [9e-3, 0, 2e-3], "radius": 1e-3}]}' |
        nsd-gen - | nsd-detect | nsd-detect --gap 0.01
}
status 0 "contacts detected again, more of them" one_then_more
is "are all there" "$(nsd-info -c "$tmp/out" | wc -l)" 10

cp "$tmp/packing.h5" "$tmp/kept.h5"
ln -s kept.h5 "$tmp/link.h5"
for log in kept link; do
    refuses 64 "nsd-step --log $log.h5, which it reads" nsd-step --log "$tmp/$log.h5" -o "$tmp/other.h5" "$tmp/kept.h5"
    into() { nsd-step --log "$tmp/$log.h5" <"$tmp/kept.h5"; }
    refuses 64 "nsd-step --log $log.h5 < it" into
done
cp "$tmp/contacts.h5" "$tmp/kept2.h5"
refuses 64 "nsd-solve --log of its input" nsd-solve --log "$tmp/kept2.h5" "$tmp/kept2.h5"
ok "the input is what it was" cmp "$tmp/kept.h5" "$tmp/packing.h5"
ok "here, too" cmp "$tmp/kept2.h5" "$tmp/contacts.h5"
refuses 64 "nsd-step --log of its -o" nsd-step --log "$tmp/both.h5" -o "$tmp/both.h5" "$tmp/kept.h5"
status 0 "nsd-solve --log /dev/null > /dev/null" bash -c "nsd-solve --log /dev/null '$tmp/contacts.h5' >/dev/null"

kinds() { printf '{"dt": 1, "materials": {"%s": {"density": 1}}, "bodies": []}' "$1" | nsd-gen -; }
refuses 65 "nsd-gen: a kind's name of two lines" kinds 'a\nb'
refuses 65 "nsd-gen: a kind without a name" kinds ''
far() { echo '{"dt": 1, "bodies": [{"x": [1e308, 0, 0], "radius": 1, "v": [1e308, 0, 0]}]}' | nsd-gen - | nsd-step; }
status 1 "nsd-step: a step whose result is infinite ends the run" far
if ! grep -q __asan_init "$(command -v nsd-gen)"; then
    endless() { (ulimit -v 1500000 && echo '{"dt": 1, "bodies": [{"file": "/dev/zero"}]}' | nsd-gen -); }
    refuses 66 "nsd-gen: a table without end" endless
fi

done_testing
