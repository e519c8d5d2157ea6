#!/usr/bin/env bash
# Several processes make the steps of one: the same bits in the order of all contacts, the same solution in
# blocks; the run that loses one ends clearly, and goes on.
# shellcheck source=tests/support/tap.sh
. tests/support/tap.sh

# shellcheck source=tests/support/mpi.sh
. tests/support/mpi.sh

# With sanitizers each process takes a second to start, and three on two cores wait for each other: there two of
# them, few steps, and once what other tests here only repeat with other numbers. Three where $three says so, of which
# one has two neighbours.
all=${thin:+3}
all=${all:-2 3 4 8}

ranks() # K ARGUMENT ...: nsd-step by K processes
{
    local k=$1
    [ -z "$thin" ] || [ -n "${three-}" ] || k=2
    shift
    timeout 300 mpirun --oversubscribe --bind-to none -n "$k" nsd-step --small-steps 0 "$@" </dev/null # or mpirun reads on where a test does
}

by_first() # how many steps the first process has solved alone, as $tmp/said says
{
    sed -n 's/.*; \([0-9]*\) steps solved by the first alone.*/\1/p' "$tmp/said"
}
same() # FILE "K ..." ARGUMENT ...: the bytes of one process; $alone [0] steps are solved by the first alone
{
    local file=$1 many=$2 k
    shift 2
    rm -f "$tmp"/one.h5 "$tmp"/many.h5
    nsd-step --small-steps 0 "$@" -o "$tmp/one.h5" "$file" || return 1
    for k in $many; do
        rm -f "$tmp/many.h5"
        ranks "$k" "$@" -o "$tmp/many.h5" "$file" 2>"$tmp/said" || { cat "$tmp/said"; return 1; }
        cmp "$tmp/one.h5" "$tmp/many.h5" || return 1
        [ "$(by_first)" = "${alone:-0}" ] || { cat "$tmp/said"; return 1; }
    done
}

after() # STEPS SCENE: its packing then, into $tmp/NAME.h5
{
    nsd-gen "$2" | nsd-step --small-steps 0 -n "$1" --every "$1" 2>/dev/null | nsd-cat --last >"$tmp/$(basename "$2" .json).h5"
}

# ---- the order of all contacts ----

nsd-gen 300 | nsd-step --small-steps 0 -n 900 --every 900 2>/dev/null | nsd-cat --last >"$tmp/heap.h5"
three=1 ok "300 balls: the bytes of one process on $all" same "$tmp/heap.h5" "$all" -n 10 --contacts
ok "with a stiffness of contacts" same "$tmp/heap.h5" 3 -n 5 --stiffness auto --contacts
ok "in the natural order, by nlgs" same "$tmp/heap.h5" 3 -n 5 -m sbp --order natural --max-sweeps 30
ok "by Anderson's acceleration, to a tight criterion" same "$tmp/heap.h5" 3 -n 3 --solver anderson --tolerance 1e-7
[ -n "$thin" ] || ok "by another criterion, with warm starts" same "$tmp/heap.h5" 3 -n 5 --criterion scaled --warm
jq '.seed = 7' scenes/paper/example2.json | nsd-gen - | nsd-step --small-steps 0 -n 216 --every 216 --overlap-rule keep 2>/dev/null | nsd-cat --last >"$tmp/jam.h5"
alone=1 ok "where auto goes on with Newton's method, which the first makes alone" same "$tmp/jam.h5" 2 -n 1 --overlap-rule keep --tolerance 1e-10

while read -r before scene ranks steps alone name; do
    [ -z "$thin" ] || [ "$alone" != 0 ] || steps=1
    after "$before" "scenes/$scene.json"
    ok "$name" same "$tmp/$scene.h5" "$ranks" -n "$steps"
done <<'END'
200 drum 3 1 0 a drum that turns
60 shear 3 20 0 a cell that is sheared
100 vibrated 3 10 0 a cell that repeats, over a floor that is shaken
30 rubble 3 3 0 clumps, capsules, hulls
100 cohesive 3 5 0 cohesion
300 rolling 3 5 0 rolling friction
20 bonded 3 5 0 bonds
50 press 2 5 5 a piston under a load
500 pour 3 20 0 grains that pour and are taken away
END
ok "rolling friction with a stiffness" same "$tmp/rolling.h5" 2 -n 20 --stiffness 1e5 --contacts
ok "bonds with a stiffness" same "$tmp/bonded.h5" 2 -n 5 --stiffness 1e5 --contacts

unset alone

# ---- a program in the loop, which the first process talks to ----

# shellcheck disable=SC2016 # for another shell
acts='jq -c --unbuffered "{forces: [range(.bodies) | [(. * 1e-8), 0, 2e-6]], torques: {\"200\": [0, 0, 1e-8]}, gravity: [(.step | sin), 0, -9.81],
    velocities: (if .step % 4 == 1 then {\"205\": [0.01, 0, 0]} else {} end), friction: [[\"ball\", \"wall\", (.step % 7 / 10)]],
    walls: {\"0\": {velocity: [0, 0, (.time | sin * 1e-3)]}}}"'
three=1 ok "forces, torques, velocities, gravity, friction, boundaries that a program answers: the same bytes" \
    same "$tmp/heap.h5" "$all" -n 8 --contacts --with "$acts" --with-walls all
ranks 2 -n 8 --contacts --replay "$tmp/one.h5" -o "$tmp/replayed.h5" "$tmp/heap.h5" 2>/dev/null
ok "replayed" cmp "$tmp/one.h5" "$tmp/replayed.h5"
ok "where grains pour and are taken away" same "$tmp/pour.h5" 3 -n 20 --with 'jq -c --unbuffered "{forces: [range(.bodies) | [1e-6, 0, 0]]}"'
alone=5 ok "on a piston under a load" same "$tmp/press.h5" 2 -n 5 --with 'jq -c --unbuffered "{walls: {\"5\": {force: (.step * 1e-4)}}}"'
ends() { ranks 2 -n 5 --with 'read -r l; echo "{}"; exit 3' -o "$tmp/ended.h5" "$tmp/heap.h5"; }
status 69 "a program that ends, ends the run of all" ends
is "with whole frames" "$(nsd-info "$tmp/ended.h5" | jq -sc 'map(select(.step != null).step)')" "[901]"
if /usr/bin/python3 -c 'import numpy' 2>/dev/null && ! grep -q __asan_init "$(command -v nsd-gen)"; then
    PYTHONPATH=python NSD_LIBRARY=$(dirname "$(command -v nsd-gen)")/libnsd.so.2 /usr/bin/python3 - "$tmp/heap.h5" "$tmp/lasting.h5" <<'EOF'
import sys, nsd
run = nsd.Run.from_document(sys.argv[1])
run.force[:] = [1e-6, 0, 0]
run.save(sys.argv[2])
EOF
    ok "forces that last in a document" same "$tmp/lasting.h5" 3 -n 5 --contacts
fi

jq '.adhesion = { c_n: 1e9, c_t: 5e8, w: 1, eta: 1e-5, forever: true } | .capillary = { volume: 1e-11, tension: 0.07 } | .rolling = { mu_r: 1e-3, mu_p: 1e-3 }' \
    scenes/rubble.json >"$tmp/glued.json"
after 400 "$tmp/glued.json"
ok "bonds of clumps, capsules, hulls, with liquid and rolling friction" same "$tmp/glued.h5" 3 -n 3 --contacts
on_others() # a run on 2, then 3, against one process
{
    rm -f "$tmp"/[ab].h5
    nsd-step --small-steps 0 -n 4 -o "$tmp/a.h5" "$tmp/heap.h5" && nsd-step --small-steps 0 -n 4 -i "$tmp/a.h5" &&
        ranks 2 -n 4 -o "$tmp/b.h5" "$tmp/heap.h5" && ranks 3 -n 4 -i "$tmp/b.h5" && cmp "$tmp/a.h5" "$tmp/b.h5"
}
ok "a run goes on on another number of processes" on_others
ok "and by threads in each" same "$tmp/heap.h5" 2 -n 3 -j 2

# ---- blocks ----

natural() { nsd-cat --last "$1" | nsd-err | jq .natural; }
blocks() # FILE K EPS ARGUMENT ...: to the criterion, and moving as the order of all has it
{
    local file=$1 k=$2 eps=$3
    shift 3
    rm -f "$tmp"/one.h5 "$tmp"/block.h5
    set -- --criterion natural "$@"
    nsd-step --small-steps 0 "$@" --tolerance "$eps" -o "$tmp/one.h5" "$file" &&
        ranks "$k" "$@" --tolerance "$eps" --contacts --order block -o "$tmp/block.h5" "$file" || return 1
    jq -n --argjson e "$(natural "$tmp/block.h5")" --argjson eps "$eps" -e '($e | type) == "number" and $e <= $eps' && /usr/bin/python3 - "$eps" "$tmp/one.h5" "$tmp/block.h5" <<'EOF'
import io, sys, h5py
import numpy as np
def last(path):
    f = h5py.File(io.BytesIO(open(path, "rb").read()[512:]), "r")["particles/all"]
    return f["position/value"][-1], f["velocity/value"][-1]
(x, v), (y, w) = last(sys.argv[2]), last(sys.argv[3])
here = ~np.isnan(x).any(axis=1) # bodies that have not come yet have rows
far, off, top = abs(x - y)[here].max(), abs(v - w)[here].max(), abs(v[here]).max()
print("positions differ by", far, "velocities by", off, "of", top)
sys.exit(not (off < 100 * float(sys.argv[1]) * top and far < 1e-7))
EOF
}
# grains that still move: a pile at rest has several solutions, and each order of sweeps finds its own
nsd-gen 300 | nsd-step --small-steps 0 -n 400 --every 400 2>/dev/null | nsd-cat --last >"$tmp/moving.h5"
# positions that overlap are moved apart by ten sweeps, which end where they end: so without, or one step
ok "blocks on 2: the motion of one process, to the criterion" blocks "$tmp/moving.h5" 2 1e-8 -n 5 --overlap-rule keep
[ -n "$thin" ] || ok "on 8" blocks "$tmp/moving.h5" 8 1e-8 -n 5 --overlap-rule keep
three=1 ok "with bodies moved apart" blocks "$tmp/moving.h5" 3 1e-8 -n 1
ok "over a floor that is shaken, in a cell that repeats" blocks "$tmp/vibrated.h5" 3 1e-8 -n 2 --overlap-rule keep
ok "in a cell that is sheared" blocks "$tmp/shear.h5" 3 1e-8 -n 2 --overlap-rule keep
ok "with springs that an option gives" blocks "$tmp/moving.h5" 3 1e-8 -n 2 --stiffness 1e4
ok "with clumps, capsules, hulls" blocks "$tmp/rubble.h5" 2 1e-8 -n 1 --overlap-rule gap
ok "with cohesion" blocks "$tmp/cohesive.h5" 3 1e-8 -n 2 --overlap-rule keep
after 300 scenes/rolling.json
nsd-step --small-steps 0 -n 1 -o "$tmp/solved.h5" --contacts "$tmp/rolling.h5" 2>/dev/null
ok "with bonds of clumps, capsules, hulls" blocks "$tmp/glued.h5" 3 1e-6 -n 1 --overlap-rule keep
ok "with rolling friction" blocks "$tmp/rolling.h5" 3 1e-6 -n 1 --overlap-rule keep
ok "by Anderson's acceleration" blocks "$tmp/rolling.h5" 2 1e-6 -n 1 --solver anderson --overlap-rule keep
ok "with bonds" blocks "$tmp/bonded.h5" 3 1e-8 -n 3 --overlap-rule keep
ok "with rolling friction, from the last reactions and moments" blocks "$tmp/solved.h5" 3 1e-6 -n 2 --warm --overlap-rule keep
ok "with grains that pour" blocks "$tmp/pour.h5" 2 1e-8 -n 3 --overlap-rule keep
ok "with a program in the loop" blocks "$tmp/moving.h5" 3 1e-8 -n 3 --overlap-rule keep --with "$acts"
overlaps() # FILE: m, the largest of the last frames
{
    nsd-info "$1" | jq -s 'map(select(.max_overlap != null)) | last | .max_overlap'
}
moved_apart() # after as many steps overlaps are as small as those of one process
{
    rm -f "$tmp"/[ab].h5
    nsd-step --small-steps 0 -n 60 -o "$tmp/a.h5" "$tmp/heap.h5" && ranks 4 -n 60 --order block -o "$tmp/b.h5" "$tmp/heap.h5" &&
        jq -n --argjson a "$(overlaps "$tmp/a.h5")" --argjson b "$(overlaps "$tmp/b.h5")" -e '($b | type) == "number" and $b <= 1.5 * $a'
}
[ -n "$thin" ] || ok "and their overlaps do not grow" moved_apart
last_of() { nsd-info --last -p "$1" | grep .; }
frames_alike() # the same processes: the same bytes; and as many frames as may be kept change no motion
{
    rm -f "$tmp"/[abc].h5
    for f in a b; do ranks 3 -n 6 --order block -o "$tmp/$f.h5" "$tmp/heap.h5" || return 1; done
    ranks 3 -n 6 --order block -o "$tmp/c.h5" "$tmp/heap.h5" && cmp "$tmp/a.h5" "$tmp/b.h5" &&
        last_of "$tmp/a.h5" >"$tmp/a" && last_of "$tmp/c.h5" >"$tmp/c" && cmp "$tmp/a" "$tmp/c"
}
[ -n "$thin" ] || ok "as many processes give the same bytes, whatever frames are kept" frames_alike

# ---- nobody has the whole: rows of bodies from and to files ----

forms() # FILE K ARGUMENT ...: all ranks write, or the first what they send it: the same bytes
{
    local file=$1 k=$2
    shift 2
    rm -f "$tmp"/[ab].h5
    ranks "$k" "$@" --order block -o "$tmp/a.h5" "$file" && NSD_GATHER=1 ranks "$k" "$@" --order block -o "$tmp/b.h5" "$file" &&
        cmp "$tmp/a.h5" "$tmp/b.h5" && nsd-info "$tmp/a.h5" >"$tmp/info"
}
written_alike() # ROMIO locks what it writes
{
    forms "$tmp/rubble.h5" 4 -n 2 && { [ -n "$thin" ] || { forms "$tmp/vibrated.h5" 8 -n 3 && OMPI_MCA_io=romio321 forms "$tmp/heap.h5" 2 -n 2; }; } &&
        forms "$tmp/heap.h5" 3 -n 4 --contacts
}
ok "frames that all processes write, and that the first writes for them: the same bytes" written_alike
balances() # of each frame: the change of the energy is the work, no body or contact twice
{
    jq -es 'map(select(.balance) | .balance) | length == 4 and all(.[];
        (.change - (.gravity + .drives + .loads - .dissipation) | fabs) < 1e-12 * ([.kinetic, .gravity, .dissipation | fabs] | add) and
        .dissipation != 0)' "$tmp/info"
}
ok "their balances close" balances

# Rods and balls in a cell that repeats, too far from each other to touch: no order changes a bit
jq -n '{ dt: 1e-3, gravity: [0, 0, -9.81], density: 1000, cell: { lengths: [10, 10, 10], repeats: [true, true, true] },
    shapes: { rod: { capsule: { length: 2, radius: 0.5 } } }, bodies: [range(101) |
    { x: [(. % 5) * 2 + 1, (. / 5 | floor) % 5 * 2 + 1, (. / 25 | floor) * 1.9 + 1], v: [300, -200, 50], w: [1, 2, 3] } +
    if . % 3 == 0 then { shape: "rod", size: 0.1 } else { radius: 0.1 } end] }' >"$tmp/gas.json"
nsd-gen "$tmp/gas.json" >"$tmp/gas.h5"
same_particles() # FILE FILE ...: the bytes of all that is in /particles
{
    /usr/bin/python3 - "$@" <<'EOF'
import io, sys, h5py
import numpy as np
def columns(path):
    found = {}
    f = h5py.File(io.BytesIO(open(path, "rb").read()[512:]), "r")
    f["particles"].visititems(lambda name, o: found.update({ name: o[()] }) if isinstance(o, h5py.Dataset) else None)
    return found
one = columns(sys.argv[1])
assert np.abs(one["all/image/value"]).max() > 0 and one["all/shape"].max() > 0
for path in sys.argv[2:]:
    other = columns(path)
    assert one.keys() == other.keys(), path
    for name in one:
        assert one[name].dtype == other[name].dtype and one[name].tobytes() == other[name].tobytes(), (path, name)
EOF
}
gas() # in each step a frame; and on from it, on another number of processes
{
    local k
    rm -f "$tmp"/gas-*
    nsd-step --small-steps 0 -n 20 --every 5 -o "$tmp/gas-1" "$tmp/gas.h5" && nsd-step --small-steps 0 -n 4 -i "$tmp/gas-1" || return 1
    for k in $all; do
        ranks "$k" -n 20 --every 5 --order block -o "$tmp/gas-$k" "$tmp/gas.h5" && ranks $((k / 2 + 1)) -n 4 --order block -i "$tmp/gas-$k" &&
            NSD_GATHER=1 ranks "$k" -n 20 --every 5 --order block -o "$tmp/gas-first-$k" "$tmp/gas.h5" &&
            NSD_GATHER=1 ranks 2 -n 4 --order block -i "$tmp/gas-first-$k" || return 1
    done
    same_particles "$tmp"/gas-*
}
ok "bodies that do not touch: the bytes of one process on $all, in both forms, and where a run goes on" gas
none_of_all() # more processes than bodies; no step; a stream, which is no file that all can open
{
    nsd-gen 3 >"$tmp/three.h5" && rm -f "$tmp"/[ab].h5 && mkfifo "$tmp/pipe" && ranks 5 -n 3 --order block -o "$tmp/a.h5" "$tmp/three.h5" &&
        nsd-step --small-steps 0 -n 3 -o "$tmp/b.h5" "$tmp/three.h5" && [ "$(last_of "$tmp/a.h5")" = "$(last_of "$tmp/b.h5")" ] || return 1
    cat "$tmp/pipe" >"$tmp/streamed.h5" &
    rm -f "$tmp"/[ab].h5
    ranks 3 -n 2 --order block -o "$tmp/pipe" "$tmp/heap.h5" && wait $! && ranks 3 -n 2 --order block -o "$tmp/a.h5" "$tmp/heap.h5" &&
        cmp <(nsd-cat "$tmp/a.h5") <(nsd-cat "$tmp/streamed.h5") && ranks 3 -n 0 --order block -o "$tmp/b.h5" "$tmp/heap.h5" &&
        [ "$(last_of "$tmp/heap.h5")" = "$(last_of "$tmp/b.h5")" ]
}
ok "a few bodies, no step, a pipe to write to" none_of_all

harm() # NAME CODE: a copy of gas.h5, without its header, changed by Python; and what one process says of it
{
    tail -c +513 "$tmp/gas.h5" >"$tmp/$1.h5"
    /usr/bin/python3 -c "import sys, h5py, numpy as np
f, P = h5py.File(sys.argv[1], 'r+'), '/particles/all/'
$2" "$tmp/$1.h5"
}
harm nan 'f[P + "position/value"][0, 77, 1] = np.nan'
harm kind 'f[P + "species"][100] = 7'
harm shape 'f[P + "shape"][99] = -3'
harm image 'f[P + "image/value"][0, 3, 0] = 2**31 - 1'
harm large 'f[P + "radius"][5] = 6'
harm short 'del f[P + "velocity/value"]; f.create_dataset(P + "velocity/value", shape=(1, 100, 3), dtype="f8")'
harm missing 'del f[P + "mass"]'
harm text 'del f[P + "mass"]; f[P + "mass"] = np.array([b"x"] * 101)'
refused() # the same status, and the same line, as in one process, and no file is left
{
    local name s
    for name in nan missing $([ -n "$thin" ] || echo kind shape image large short text); do
        s=0
        nsd-step --small-steps 0 -o "$tmp/refused.h5" "$tmp/$name.h5" 2>"$tmp/single" && return 1
        ranks 3 --order block -o "$tmp/refused.h5" "$tmp/$name.h5" 2>"$tmp/said" || s=$?
        if [ "$s" != 65 ] || ! grep -qxF "$(cat "$tmp/single")" "$tmp/said" || [ -e "$tmp/refused.h5" ]; then
            echo "$name: $s" && cat "$tmp/single" "$tmp/said"
            return 1
        fi
    done
}
ok "bad bodies: the status and the line of one process" refused

# Many bodies that fall: nearly all of the time goes into frames
awk 'BEGIN { for (i = 0; i < 17576; i++) print i % 26, int(i / 26) % 26, int(i / 676), 0.1 }' >"$tmp/many.txt"
jq -n --arg file "$tmp/many.txt" '{ dt: 1e-4, density: 1000, gravity: [0, 0, -1], bodies: [{ file: $file, w: [1, 0, 2] }] }' |
    nsd-gen - >"$tmp/many.h5"
left_whole() # FILE OF: the frames of FILE are those that OF begins with; says how many
{
    nsd-cat "$1" >"$tmp/left.h5" && /usr/bin/python3 - "$tmp/left.h5" "$2" <<'EOF'
import io, sys, h5py
left, whole = (h5py.File(io.BytesIO(open(path, "rb").read()[512:]), "r")["particles/all"] for path in sys.argv[1:])
n = len(left["position/step"])
assert 0 < n
for k in range(min(n, len(whole["position/step"]))):
    for name in "position", "velocity", "angular_velocity", "orientation":
        assert (left[name]["value"][k] == whole[name]["value"][k]).all(), (k, name)
for name in "radius", "mass", "inertia", "id", "species":
    assert (left[name][()] == whole[name][()]).all(), name
print(n)
EOF
}
killed_writing() # a process is killed, again and again at another moment; all frames are whole, those of a run that was not
{
    local k job pid victim n frames=0
    rm -f "$tmp/w.h5" && ranks 2 -n 60 --order block -o "$tmp/w.h5" "$tmp/many.h5" || return 1
    for k in 1 2 3; do
        rm -f "$tmp/d.h5"
        ranks 2 -n 1000 --order block -o "$tmp/d.h5" "$tmp/many.h5" >"$tmp/said" 2>&1 &
        job=$! victim=
        # a step is there: before it a run that is killed leaves its start, which the whole run does not keep
        until nsd-info --last "$tmp/d.h5" 2>/dev/null | jq -s -e 'any(.[]; .step > 0)' || ! kill -0 "$job"; do sleep 0.02; done
        sleep "0.$((k * 37 % 100))"
        for pid in $(ps -eo pid,args | awk -v f="$tmp/d.h5" 'index($0, f) && $2 ~ /^nsd-step/ { print $1 }'); do
            ! tr '\0' '\n' <"/proc/$pid/environ" | grep -qx "OMPI_COMM_WORLD_RANK=$((k % 2))" || victim=${victim:-$pid} # its child comes after it
        done
        [ -n "$victim" ] && kill -9 "$victim" || return 1
        if wait "$job"; then return 1; fi
        n=$(left_whole "$tmp/d.h5" "$tmp/w.h5") || { echo "$n"; return 1; }
        frames=$((frames + n))
    done
    echo "$frames frames"
    [ "$frames" -gt 2 ] && ranks 3 -n 1 --order block -i "$tmp/d.h5" && left_whole "$tmp/d.h5" "$tmp/w.h5"
}
[ -n "$thin" ] || ok "a process that is killed while all write leaves whole frames, and the run goes on" killed_writing

# ---- balance ----

even() # MEAN MOST CUTS: in the run of $tmp/said the fullest had less than these, over the mean, and there were more cuts
{
    local mean most cuts
    cat "$tmp/said"
    read -r mean most cuts < <(sed -n 's/.*fullest \([0-9.]*\) of the mean on average, \([0-9.]*\) at most, \([0-9]*\) cuts.*/\1 \2 \3/p' "$tmp/said")
    [ -n "$cuts" ] && awk "BEGIN { exit !($mean >= 1 && $mean < $1 && $most < $2 && $cuts > $3) }"
}
# a heap is kept between two boundaries until it is settled; then it slides out of where it was cut
nsd-gen - 2>/dev/null <<'EOF' | nsd-step --small-steps 0 -n 250 --every 250 2>/dev/null | nsd-cat --last >"$tmp/slide.h5"
{ "dim": 2, "dt": 1e-3, "gravity": [6, -8], "mu": 0.1, "density": 1000,
  "bodies": [{ "count": 400, "radius": 0.01, "box": { "x": [0, 0.5], "y": [0, null] } }],
  "walls": [{ "point": [0, 0], "normal": [0, 1] }, { "point": [0.5, 0], "normal": [-1, 0], "until": 0.25 },
            { "point": [0, 0], "normal": [1, 0], "until": 0.25 }] }
EOF
if [ -z "$thin" ]; then
    ok "a heap that slides across the parts: the bytes of one process" same "$tmp/slide.h5" 3 -n 120 --every 120
    ok "and it is cut anew, so that the work stays even" even 1.15 1.5 2
    ok "a drum that turns through them: the bytes of one process" same "$tmp/drum.h5" 3 -n 25 --every 25
    ok "and the work stays even" even 1.15 1.3 1
else
    ok "a heap that slides across the parts: the bytes of one process" same "$tmp/slide.h5" 2 -n 20 --every 20
fi
jq -n '{ dim: 2, dt: 1e-3, walls: [{ normal: [0, 1], point: [0, 0] }], bodies: [{ x: [0, 0.01], radius: 0.01 }] }' | nsd-gen - >"$tmp/disc.h5"
ok "of one disc" same "$tmp/disc.h5" 3 -n 2
ok "and in blocks" blocks "$tmp/moving.h5" 3 1e-8 -n 2 --overlap-rule keep

# ---- what goes wrong ----

not_to_stdout() { ranks 2 -n 1 "$tmp/heap.h5"; }
status 64 "no document to what mpirun calls standard output" not_to_stdout
like "and it says what to do" "$(cat "$tmp/err" "$tmp/out")" "nsd-step: under mpirun the output goes to a file"

ranks 2 -n 1 -o "$tmp/few.h5" "$tmp/heap.h5" 2>"$tmp/err"
like "few bodies: one process is advised" "$(cat "$tmp/err")" '2 processes for [0-9]+ bodies are slower than one, .*: below 20000 bodies per process use threads, nsd-step -j 2'
ranks 2 --order block -n 1 -o "$tmp/few.h5" "$tmp/heap.h5" 2>"$tmp/err"
like "in blocks, too" "$(cat "$tmp/err")" 'below 2000 bodies per process'

mkdir "$tmp/alone"
cp "$(command -v nsd-step)" "$tmp/alone"
without_mpi() { OMPI_COMM_WORLD_SIZE=2 "$tmp/alone/nsd-step" -n 1 -o "$tmp/c.h5" "$tmp/heap.h5"; }
status 69 "a build without MPI does not step twice" without_mpi
like "and says so" "$(cat "$tmp/err")" "^nsd-step: 2 processes were started together, and this nsd-step has no MPI: .*/alone/nsd-step-mpi is missing.*: nsd-step -j 2"

dies() # one of three is killed after some frames; whole frames are left, and the run goes on
{
    rm -f "$tmp/d.h5"
    ranks 3 -n 100000 --progress 1 -o "$tmp/d.h5" "$tmp/heap.h5" >"$tmp/said" 2>&1 &
    local job=$! k victim=
    for ((k = 0; k < 900; k++)); do
        [ "$(nsd-info "$tmp/d.h5" 2>/dev/null | jq -s 'map(select(.step != null)) | length')" -gt 2 ] 2>/dev/null && break
        sleep 0.1
    done
    for k in $(ps -eo pid,args | awk -v f="$tmp/d.h5" 'index($0, f) && $2 ~ /^nsd-step/ { print $1 }'); do
        ! tr '\0' '\n' <"/proc/$k/environ" | grep -qx OMPI_COMM_WORLD_RANK=2 || victim=$k
    done
    [ -n "$victim" ] || { cat "$tmp/said"; return 1; }
    kill -9 "$victim" || return 1
    for ((k = 0; k < 900; k++)); do kill -0 "$job" 2>/dev/null || break; sleep 0.1; done
    kill "$job" 2>/dev/null && echo "it has not ended by itself" && return 1
    wait "$job" && return 1
    # whoever is first says so: a process that waits, or mpirun, which ends them all
    grep -qE 'nsd-step: another process of the run has ended|exited on signal 9' "$tmp/said" || { cat "$tmp/said"; return 1; }
    nsd-step --small-steps 0 -n 2 -i "$tmp/d.h5" && nsd-info "$tmp/d.h5" >/dev/null
}
three=1 ok "a process that dies ends the run, whose frames are whole, and it goes on" dies

done_testing
