#!/usr/bin/env bash
# nsd-view's command line: which frame, into which file, as a PNG that others read.
# shellcheck source=tests/support/tap.sh disable=SC2317 # functions called by name
. tests/support/tap.sh

view() { nsd-view "$@" 2>/dev/null; }

# size FILE: WxH, as the PNG's header has it
size()
{
    local b
    mapfile -t b < <(head -c 24 "$1" | tail -c 8 | od -An -v -tu1 -w1)
    echo "$((b[2] * 256 + b[3]))x$((b[6] * 256 + b[7]))"
}

# python FILE TEXT: TEXT is true of at(x, y), the [r, g, b] of the PNG's pixels, and of w, h
python()
{
    py - "$@" <<'PYTHON'
import struct, sys, zlib
data, at, image = open(sys.argv[1], 'rb').read(), 8, b''
assert data[:8] == b'\x89PNG\r\n\x1a\n'
names = []
while at < len(data):
    n, name = struct.unpack('>I4s', data[at:at + 8])
    body = data[at + 8:at + 8 + n]
    assert zlib.crc32(name + body) == struct.unpack('>I', data[at + 8 + n:at + 12 + n])[0]
    if name == b'IHDR': w, h, depth, kind = struct.unpack('>IIBB', body[:10])
    if name == b'IDAT': image += body
    names.append(name.decode())
    at += 12 + n
assert depth == 8 and kind == 2 and names[0] == 'IHDR' and names[-1] == 'IEND', names
raw, rows, last = zlib.decompress(image), [], bytearray(3 * w)
for y in range(h):
    f, row = raw[y * (3 * w + 1)], bytearray(raw[y * (3 * w + 1) + 1:(y + 1) * (3 * w + 1)])
    for i in range(3 * w):
        a, b, c = row[i - 3] if i > 2 else 0, last[i], last[i - 3] if i > 2 else 0
        p = sorted((abs(p - a - b + c), k) for k, p in enumerate((a, b, c)))[0][1] # Paeth
        row[i] = row[i] + (0, a, b, (a + b) // 2, (a, b, c)[p])[f] & 255
    rows.append(row)
    last = row
def at(x, y): return list(rows[y][3 * x:3 * x + 3])
sys.exit(not eval(sys.argv[2]))
PYTHON
}
picture() # "what is true" FILE TEXT
{
    if [ -x /usr/bin/python3 ]; then ok "$1" python "$2" "$3"; else skip "$1" "no python3"; fi
}

nsd-gen 20 >"$tmp/start.h5"
nsd-step -n 60 --every 10 -o "$tmp/out.h5" "$tmp/start.h5" 2>/dev/null
nsd-cat --stream "$tmp/out.h5" >"$tmp/stream.h5"
nsd-gen scenes/paper/example1.json >"$tmp/ball.h5"
box=(--size 200x160 --camera '0,0' --box '-0.01,0.01,-0.01,0.01,-0.003,0.013')

# ---- a PNG ----

status 0 "a packing becomes a PNG" nsd-view "${box[@]}" "$tmp/ball.h5"
mv "$tmp/out" "$tmp/ball.png"
is "of the size that is asked for" "$(size "$tmp/ball.png")" 200x160
picture "other programs read it, without a date in it" "$tmp/ball.png" \
    "(w, h) == (200, 160) and set(names) == {'IHDR', 'sRGB', 'IDAT', 'IEND'}"
picture "the ball is in the middle, the background in the corners" "$tmp/ball.png" \
    "at(100, 80) != [255] * 3 and at(0, 0) == at(199, 0) == at(0, 159) == [255] * 3"
# 50 000 pixels a metre, r = 5 mm
status 0 "a ball without a soft border" nsd-view --bare --samples 1 --size 1000x800 "${box[@]:2}" "$tmp/ball.h5"
mv "$tmp/out" "$tmp/large.png"
picture "has the area pi r^2 within 1 %" "$tmp/large.png" \
    "abs(sum(at(x, y) != [255] * 3 for x in range(w) for y in range(h)) / (3.14159 * 250**2) - 1) < 0.01"
view --background 102030 "${box[@]}" "$tmp/ball.h5" >"$tmp/dark.png"
picture "the background is what is asked for" "$tmp/dark.png" "at(0, 0) == [0x10, 0x20, 0x30]"

# ---- the same ----

ok "the same bytes twice, and for any number of threads" cmp <(view "$tmp/out.h5") <(view -j 3 "$tmp/out.h5")
view "$tmp/out.h5" >"$tmp/last.png"
ok "also through a pipe" cmp "$tmp/last.png" <(nsd-cat "$tmp/out.h5" | view)
ok "a trajectory and the stream of its frames end alike" cmp "$tmp/last.png" <(view "$tmp/stream.h5")
ok "the last of several files is drawn" cmp "$tmp/last.png" <(view "$tmp/start.h5" "$tmp/out.h5")
ok "--step of the last frame is the last frame" cmp "$tmp/last.png" <(view --step 60 "$tmp/out.h5")
ok "-s 20 is step 20" cmp <(view -s 20 "$tmp/out.h5") <(nsd-cat --frames 20 "$tmp/out.h5" | view)
ok "of a stream, too" cmp <(view -s 20 "$tmp/out.h5") <(view -s 20 <"$tmp/stream.h5")
differs() { ! cmp -s "$@"; }
ok "which looks different" differs "$tmp/last.png" <(view -s 20 "$tmp/out.h5")
view -o "$tmp/file.png" "$tmp/out.h5"
ok "-o FILE gets what standard output gets" cmp "$tmp/file.png" "$tmp/last.png"
ok "and nothing stays beside it" test -z "$(find "$tmp" -name '.nsd*')"
is "as readable as any file" "$(umask 027 && view -o "$tmp/mode.png" "$tmp/ball.h5" && stat -c %a "$tmp/mode.png")" 640
ln -s file.png "$tmp/link.png"
view -o "$tmp/link.png" "$tmp/ball.h5"
ok "a link stays one" test -L "$tmp/link.png"
ok "and what it leads to is the picture" cmp "$tmp/file.png" <(view "$tmp/ball.h5")
for option in '-c speed' '-c material' '-c id' --plain '--camera 10,20' '--range 0,1' '--background 000000' '--samples 1'; do
    # shellcheck disable=SC2086 # words
    ok "$option changes the picture" differs "$tmp/last.png" <(view $option "$tmp/out.h5")
done
status 0 "colours of radii, without words in the picture" nsd-view --bare "$tmp/out.h5"
like "are explained" "$(cat "$tmp/err")" '^nsd-view: radius 0\.[0-9]+ \(violet\) to 0\.[0-9]+ \(yellow\) m$'
status 0 "colours of kinds" nsd-view --bare -c material "$tmp/out.h5"
is "need no word" "$(cat "$tmp/err")" ""

# ---- over the bodies ----

nsd-gen -d 2 60 | nsd-step -n 1200 --every 100 --contacts -o "$tmp/forces.h5" 2>/dev/null
for option in --network --contacts '--network --force 1e9' '-c force' '-c contacts' '-c spin' '-c height' '-c mass' --bare '--pale 0.5' \
    '--clip 1,0,0,0.001'; do
    # shellcheck disable=SC2086 # words
    ok "$option changes the picture" differs <(view "$tmp/forces.h5") <(view $option "$tmp/forces.h5")
    # shellcheck disable=SC2086 # words
    ok "$option: the same for any number of threads" cmp <(view -j 1 $option "$tmp/forces.h5") <(view -j 3 $option "$tmp/forces.h5")
done
for option in '--perspective 40' '--clip 1,0,0,0.001' '--perspective 40 --clip 0,-1,0.3,0'; do
    # shellcheck disable=SC2086 # words
    ok "balls: $option changes the picture" differs "$tmp/last.png" <(view $option "$tmp/out.h5")
done
ok "a plane beyond all cuts nothing" cmp <(view --bare "$tmp/out.h5") <(view --bare --clip 1,0,0,9 "$tmp/out.h5")
ok "the normal may have any length" cmp <(view --clip 1,0,0,0.001 "$tmp/out.h5") <(view --clip 2,0,0,0.002 "$tmp/out.h5")
refuses 65 "forces that were not kept" nsd-view --network "$tmp/out.h5"
like "says what keeps them" "$(cat "$tmp/err")" 'nsd-step --contacts keeps them'
nsd-detect "$tmp/out.h5" >"$tmp/touch.h5"
refuses 65 "contacts that are not solved" nsd-view --network "$tmp/touch.h5"
status 0 "have places all the same" nsd-view --contacts "$tmp/touch.h5"

nsd-info --last -p "$tmp/forces.h5" | jq -r '[.id, .radius] | @tsv' | sed '1i # id size' >"$tmp/size.tsv"
ok "a table's numbers are colours: of radii, the radii's" cmp \
    <(view --bare --values "$tmp/size.tsv" "$tmp/forces.h5") <(view --bare -c radius "$tmp/forces.h5")
{ echo 'step id other speed'; nsd-info -p "$tmp/forces.h5" | jq -r '[.step, .id, 7, (.v | map(. * .) | add | sqrt)] | @tsv'; } >"$tmp/speed.tsv"
ok "rows of a step are of that step" cmp <(view --bare --range 0,0.1 -s 500 --values "$tmp/speed.tsv" "$tmp/forces.h5") \
    <(view --bare --range 0,0.1 -s 500 -c speed "$tmp/forces.h5")
ok "--column chooses" differs <(view --values "$tmp/speed.tsv" "$tmp/forces.h5") <(view --values "$tmp/speed.tsv" --column other "$tmp/forces.h5")
for bad in 'x y\n1 2' 'id a\n1 x' 'id a\n1' 'id a\nnan 2' ''; do
    printf '%b' "$bad" >"$tmp/bad.tsv"
    refuses 65 "a table of '$bad'" nsd-view --values "$tmp/bad.tsv" "$tmp/forces.h5"
done
refuses 65 "a column that is not there" nsd-view --values "$tmp/size.tsv" --column b "$tmp/forces.h5"
refuses 66 "a table that is not there" nsd-view --values "$tmp/none.tsv" "$tmp/forces.h5"

# ---- SVG ----

svg() { py -c 'import sys, xml.dom.minidom as m; m.parse(sys.argv[1])' "$1"; }
nsd-view --svg --network -o "$tmp/a.svg" "$tmp/forces.h5" 2>/dev/null
ok "an SVG is XML" svg "$tmp/a.svg"
ok "the same twice" cmp "$tmp/a.svg" <(view --svg --network "$tmp/forces.h5")
ok "more forces are more lines" [ "$(grep -c '<path' "$tmp/a.svg")" -gt "$(view --svg "$tmp/forces.h5" | grep -c '<path')" ]
refuses 65 "balls have none" nsd-view --svg "$tmp/out.h5"

# ---- stray bodies, and one that is followed ----

stray() { echo '{"dt": 1e-4, "bodies": [{"count": 40, "radius": 1e-3, "box": {"x": [0, 0.01], "y": [0, 0.01], "z": [0, null]}}'"$1"']}' | nsd-gen -; }
stray '' >"$tmp/crowd.h5"
stray ', {"x": [3, 3, 3], "radius": 1e-3}' >"$tmp/stray.h5"
ok "one far from all others does not shrink them" cmp <(view --bare "$tmp/crowd.h5") <(view --bare "$tmp/stray.h5")
ok "but with --strays" differs <(view --bare "$tmp/crowd.h5") <(view --bare --strays "$tmp/stray.h5")
nsd-step -n 300 --every 100 -o "$tmp/roll2.h5" "$tmp/ball.h5" 2>/dev/null
view --bare --every 1 --plain --follow 0 --size 300x100 --camera 0,10 --box 0.005,0.025,-0.01,0.01,-0.003,0.013 -o "$tmp/q%02d.png" "$tmp/roll2.h5"
picture "a ball that is followed stays where it is" "$tmp/q02.png" \
    "at(150, 50) != [255] * 3 and max(at(140, 50)[1], at(140, 50)[2]) - at(140, 50)[0] > 40"
refuses 65 "a body that is not there" nsd-view --follow 7 "$tmp/ball.h5"

# ---- films ----

if command -v ffmpeg >/dev/null; then
    for film in mp4 webm; do
        status 0 "a $film" nsd-view --every 1 --size 128x96 -o "$tmp/film.$film" "$tmp/roll2.h5" "$tmp/roll2.h5"
        is "of every frame" "$(ffprobe -v error -count_frames -select_streams v -show_entries stream=nb_read_frames -of csv=p=0 "$tmp/film.$film")" 6
        is "and nothing beside it" "$(find "$tmp" -name '*.part*')" ''
    done
    refuses 74 "a film in a directory that is missing" nsd-view --every 1 -o "$tmp/missing/a.mp4" "$tmp/roll2.h5"
else
    skip "films" "no ffmpeg"
fi
alone() { (cd "$tmp" && PATH=$(dirname "$(command -v nsd-view)") nsd-view --every 1 --size 64x64 -o alone.mp4 roll2.h5); }
status 0 "without ffmpeg" alone
is "there are pictures" "$(cd "$tmp" && echo alone*)" "alone-00000.png alone-00001.png alone-00002.png"
like "and how to join them" "$(tail -n 1 "$tmp/err")" "ffmpeg -framerate 25 -i 'alone-%05d.png' .* 'alone.mp4'"
refuses 64 "a film needs --every" nsd-view -o "$tmp/b.mp4" "$tmp/roll2.h5"

# ---- series ----

status 0 "--every 1 draws every frame" nsd-view --every 1 --size 64x64 -o "$tmp/f%03d.png" "$tmp/out.h5"
is "numbered from 0" "$(cd "$tmp" && echo f[0-9]*)" "f000.png f001.png f002.png f003.png f004.png f005.png"
is "and nothing on standard output" "$(wc -c <"$tmp/out")" 0
status 0 "--every 2" nsd-view --every 2 --size 64x64 -o "$tmp/g%02d.x" "$tmp/out.h5"
is "draws every second" "$(cd "$tmp" && echo g*)" "g00.x g01.x g02.x"
status 0 "two files are one series" nsd-view --every 4 --size 64x64 -o "$tmp/h%01d.png" "$tmp/out.h5" "$tmp/out.h5"
is "in which frames count on" "$(cd "$tmp" && echo h*)" "h0.png h1.png h2.png"
# a ball that rolls: with a camera of its own each frame would have it in the same place
nsd-step -n 300 --every 100 -o "$tmp/roll.h5" "$tmp/ball.h5" 2>/dev/null
view --every 1 --plain --size 300x100 --camera 0,10 -o "$tmp/r%02d.png" "$tmp/roll.h5"
picture "the camera stands still while a ball rolls to the right: first" "$tmp/r00.png" \
    "max(max(at(x, 50)[1], at(x, 50)[2]) - at(x, 50)[0] for x in range(100)) > 40"
picture "then it is gone from there" "$tmp/r02.png" \
    "max(max(at(x, 50)[1], at(x, 50)[2]) - at(x, 50)[0] for x in range(100)) < 20"

# ---- outputs that fail ----

echo old >"$tmp/old.png"
limited() { (trap '' XFSZ && ulimit -f 8 && nsd-view -o "$tmp/old.png" "$tmp/out.h5"); }
refuses 74 "-o FILE, and the disk is full" limited
is "what was there stays" "$(cat "$tmp/old.png")" old
ok "and nothing beside it" test -z "$(find "$tmp" -name '.nsd*')"
limited() { (trap '' XFSZ && ulimit -f 8 && nsd-view "$tmp/out.h5" >"$tmp/half.png"); }
refuses 74 "> FILE, and the disk is full" limited
is "half a picture is taken back" "$(wc -c <"$tmp/half.png")" 0
refuses 74 "-o /dev/full" nsd-view -o /dev/full "$tmp/out.h5"
ok "which is still a device" test -c /dev/full
refuses 74 "-o in a directory that is missing" nsd-view -o "$tmp/missing/a.png" "$tmp/out.h5"
refuses 74 "-o of a directory" nsd-view -o "$tmp" "$tmp/out.h5"
refuses 74 "--every in a directory that is missing" nsd-view --every 1 -o "$tmp/missing/%02d.png" "$tmp/out.h5"
into() { nsd-view "$tmp/out.h5" >&-; }
refuses 74 "standard output is closed" into
like "says so" "$(cat "$tmp/err")" '^nsd-view: standard output: '

# ---- inputs ----

cp "$tmp/out.h5" "$tmp/keep.h5"
refuses 64 "-o is also the input" nsd-view -o "$tmp/out.h5" "$tmp/out.h5"
cp "$tmp/out.h5" "$tmp/in05.h5"
refuses 64 "a picture of the series is also the input" nsd-view --every 1 -o "$tmp/in%02d.h5" "$tmp/in05.h5"
ok "and the input stays" cmp "$tmp/keep.h5" "$tmp/in05.h5"
refuses 65 "a step that is not there" nsd-view -s 15 "$tmp/out.h5"
like "says so" "$(cat "$tmp/err")" 'out.h5: no such frame$'
nsd-detect --fclib=local "$tmp/ball.h5" >"$tmp/both.h5"
h5copy -i "$tmp/both.h5" -o "$tmp/local.hdf5" -s /fclib_local -d /fclib_local
refuses 65 "an FCLIB problem" nsd-view "$tmp/local.hdf5"
refuses 65 "a series of one" nsd-view --every 1 -o "$tmp/l%02d.png" "$tmp/local.hdf5"
nsd-gen -d 2 4 >"$tmp/discs.h5"
refuses 65 "balls and discs in one series" nsd-view --every 1 --size 64x64 -o "$tmp/m%02d.png" "$tmp/ball.h5" "$tmp/discs.h5"
nothing() { echo "{\"dt\": 1$1}" | nsd-gen - | nsd-view; }
refuses 65 "neither bodies nor walls" nothing ''
status 0 "walls without bodies" nothing ', "walls": [{"box": {"x": [0, 1], "y": [0, 1], "z": [0, null]}}]'
is "are a picture" "$(head -c 4 "$tmp/out" | tail -c 3)" PNG
refuses 65 "no input" nsd-view </dev/null
refuses 66 "a missing file" nsd-view "$tmp/missing.h5"
if ! grep -q __asan_init "$(command -v nsd-view)"; then # the sanitizer needs terabytes of addresses
    large() { (ulimit -v 600000 && nsd-view --size 16384x16384 "$tmp/ball.h5"); }
    refuses 70 "more pixels than memory" large
fi
if [ -x /usr/bin/python3 ]; then
    into() { terminal sh -c "nsd-view $tmp/keep.h5 2>$tmp/said" >/dev/null; }
    status 64 "a picture does not go to a terminal" into
    like "says so" "$(cat "$tmp/said")" '^nsd-view: standard output is a terminal'
else
    skip "a picture does not go to a terminal" "no python3"
fi

# ---- usage ----

for name in a.png %d.png %5d.png %00d.png %010d.png %05u.png %05ld.png %05d%05d.png %%05d.png %05d%.png %s %n %0d '%05d%%' ''; do
    refuses 64 "--every -o '$name'" nsd-view --every 1 -o "$name" "$tmp/keep.h5"
done
for option in '--every 0' '--every -1' '--every 1.5' '-s -1' '-s x' '--every 1' "--every 1 -s 20 -o $tmp/x%02d.png" \
    '--size 900' '--size 0x0' '--size 15x100' '--size 100x16385' '--size 100x' '--size x100' '--size 100x100x' \
    '--size -100x100' '--size 1e2x100' '--size 99999999999999999999x100' '--size=' '--camera 30' '--camera 30,' \
    '--camera 30,91' '--camera nan,0' '--camera 30,15,0' '--camera 1e9,0' '--camera=,' '-c red' '-c=' \
    '--background fff' '--background #ffffff' '--background gggggg' '--background=' '--range 1' '--range 1,1' \
    '--range 2,1' '--range inf,inf' '--range 0,1 -c material' '--box 0,1' '--box 0,1,0,1,0' '--box 0,1,0,1,1,0' \
    '--box 1,0,0,1,0,1' '--box 0,0,0,1,0,1' '--box 0,1e200,0,1,0,1' '--box 0,1,0,1,0,1,' '--samples 0' \
    '--samples 9' '-j 0' '-j x' '--perspective' '--perspective 130' '--clip 0,0,0,1' '--clip 1,0,0' '--clip x' '--pale 2' \
    '--follow x' '--force 0' '-c value' '--column a' '--rate 0'; do
    # shellcheck disable=SC2086 # words
    refuses 64 "nsd-view $option" nsd-view $option "$tmp/keep.h5"
done
status 0 "a box in the plane has four numbers" nsd-view --box 0,1,0,1 "$tmp/discs.h5"
refuses 64 "in space it has six" nsd-view --box 0,1,0,1 "$tmp/ball.h5"

# ---- gravity points down, and far walls leave the picture to the grains ----

# a scene, and the same turned with its gravity
stand() # GRAVITY POINT: what becomes of [x, y, z]
{
    jq -n "def at: $2; { dt: 1e-3, dim: ($1 | length), gravity: $1,
        walls: [{ point: ([0, 0, 0] | at), normal: ([0, 0, 1] | at) }, { rectangle: { center: ([0, 0, 90] | at), normal: ([0, 0, 1] | at), sides: [9, 9] } }],
        bodies: [{ x: ([0, 0, 0.1] | at), radius: 0.1 }, { x: ([0.5, 0.2, 0.2] | at), radius: 0.2 }, { x: ([0.1, 0, 0.5] | at), radius: 0.1 }] } |
        if .dim == 2 then del(.walls[1]) else . end" | nsd-gen -
}
stand '[0, -9.81]' '[.[0], .[2]]' >"$tmp/down.h5"
stand '[9.81, 0]' '[-.[2], .[0]]' >"$tmp/turned.h5"
stand '[0, 9.81]' '[-.[0], -.[2]]' >"$tmp/over.h5"
view --plain "$tmp/down.h5" >"$tmp/down.png"
for other in turned over; do
    ok "in the plane gravity points down in a picture: $other" cmp "$tmp/down.png" <(view --plain "$tmp/$other.h5")
done
ok "--up turns it to another picture" differs "$tmp/down.png" <(view --plain --up 0,1 "$tmp/turned.h5")
ok "and back" cmp "$tmp/down.png" <(view --plain --up -3,0 "$tmp/turned.h5")
ok "an SVG, too" cmp <(view --svg --plain "$tmp/down.h5") <(view --svg --plain "$tmp/over.h5")
stand '[0, 0, -9.81]' . >"$tmp/down.h5"
stand '[0, 0, 9.81]' '[.[0], -.[1], -.[2]]' >"$tmp/over.h5"
stand '[9.81, 0, 0]' '[-.[2], .[1], .[0]]' >"$tmp/turned.h5"
view --plain "$tmp/down.h5" >"$tmp/down.png"
ok "in space gravity points down in a picture" cmp "$tmp/down.png" <(view --plain "$tmp/over.h5")
jq -n '{ dt: 1e-3, bodies: [{ x: [0, 0, 5.04e-4], radius: 5e-4 }, { x: [0, 0, 0.0132], radius: 5e-4 }] }' | nsd-gen - >"$tmp/tall.h5"
view --size 200x900 -c height "$tmp/tall.h5" >"$tmp/tall.png"
picture "the ends of a palette are two numbers, also in a narrow picture" "$tmp/tall.png" \
    "(lambda ink: max(b - a for a, b in zip(ink, ink[1:])))([x for x in range(int(0.45 * w)) if any(max(at(x, y)) < 130 for y in range(h - 14, h))]) > 8"
# the rows and columns that coloured grains fill, above the legend
grains='[[f(k) for f in (min, max) for k in [[(x, y)[j] for x in range(w) for y in range(h - 100) if max(at(x, y)) - min(at(x, y)) > 40]]] for j in (0, 1)]'
/usr/bin/python3 -c '' 2>/dev/null && python "$tmp/down.png" "print($grains, file=open('$tmp/grains', 'w')) or 1"
view --plain "$tmp/turned.h5" >"$tmp/turned.png" && view --plain --strays "$tmp/down.h5" >"$tmp/strays.png"
picture "also when it points along x" "$tmp/turned.png" "all(abs(a - b) <= 2 for c, d in zip($grains, $(cat "$tmp/grains")) for a, b in zip(c, d))"
picture "a wall that is far away does not make the grains small" "$tmp/down.png" "$(cat "$tmp/grains")[1][1] - $(cat "$tmp/grains")[1][0] > 60"
picture "except with --strays" "$tmp/strays.png" "(lambda g: g[1][1] - g[1][0] < 10)($grains)"
for option in '--up 1' '--up 0,0' '--up 0,0,0' '--up x,y' '--up 1,2,3,4'; do
    # shellcheck disable=SC2086 # words
    refuses 64 "nsd-view $option" nsd-view $option "$tmp/down.h5"
done
refuses 64 "discs have no z" nsd-view --up 0,0,1 "$tmp/discs.h5"

done_testing
