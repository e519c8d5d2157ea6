#!/usr/bin/env bash
# Several processes make the steps of one: the same bits in the order of all contacts, the same solution in
# blocks; the run that loses one ends clearly, and goes on.
# shellcheck source=tests/tap.sh
. tests/tap.sh

if ! command -v mpirun >/dev/null || ! command -v nsd-step-mpi >/dev/null; then
    echo "1..0 # SKIP there is no MPI: packages openmpi-bin, libopenmpi-dev, libtrilinos-zoltan-dev"
    exit 0
fi
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_mpi_yield_when_idle=1
export ASAN_OPTIONS=detect_leaks=0:$ASAN_OPTIONS # MPI's own

ranks() # K ARGUMENT ...: nsd-step by K processes
{
    local k=$1
    shift
    timeout 300 mpirun --oversubscribe --bind-to none -n "$k" nsd-step "$@" </dev/null # or mpirun reads on where a test does
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
    nsd-step "$@" -o "$tmp/one.h5" "$file" || return 1
    for k in $many; do
        rm -f "$tmp/many.h5"
        ranks "$k" "$@" -o "$tmp/many.h5" "$file" 2>"$tmp/said" || { cat "$tmp/said"; return 1; }
        cmp "$tmp/one.h5" "$tmp/many.h5" || return 1
        [ "$(by_first)" = "${alone:-0}" ] || { cat "$tmp/said"; return 1; }
    done
}

after() # STEPS SCENE: its packing then, into $tmp/NAME.h5
{
    nsd-gen "$2" | nsd-step -n "$1" --every "$1" 2>/dev/null | nsd-cat --last >"$tmp/$(basename "$2" .json).h5"
}

# ---- the order of all contacts ----

nsd-gen 300 | nsd-step -n 900 --every 900 2>/dev/null | nsd-cat --last >"$tmp/heap.h5"
ok "300 balls: the bytes of one process on 2, 3, 4 and 8" same "$tmp/heap.h5" "2 3 4 8" -n 10 --contacts
ok "in the natural order, by nlgs" same "$tmp/heap.h5" 3 -n 5 -m sbp --order natural --max-sweeps 30
ok "by Anderson's acceleration, to a tight criterion" same "$tmp/heap.h5" 3 -n 3 --global anderson --eps 1e-7
ok "by another criterion, with warm starts" same "$tmp/heap.h5" 3 -n 5 --criterion scaled --warm
jq '.seed = 7' scenes/paper/example2.json | nsd-gen - | nsd-step -n 216 --overlap keep 2>/dev/null | nsd-cat --last >"$tmp/jam.h5"
alone=1 ok "where auto goes on with Newton's method, which the first makes alone" same "$tmp/jam.h5" 2 -n 1 --overlap keep --eps 1e-10
alone=1 ok "as the interior point method" same "$tmp/heap.h5" 2 -n 1 --global ipm

while read -r before scene ranks steps alone name; do
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

unset alone
jq '.adhesion = { c_n: 1e9, c_t: 5e8, w: 1, eta: 1e-5, forever: true } | .capillary = { volume: 1e-11, tension: 0.07 } | .rolling = { mu_r: 1e-3, mu_p: 1e-3 }' \
    scenes/rubble.json >"$tmp/glued.json"
after 400 "$tmp/glued.json"
ok "bonds of clumps, capsules, hulls, with liquid and rolling friction" same "$tmp/glued.h5" 3 -n 3 --contacts
on_others() # a run on 2, then 3, against one process
{
    rm -f "$tmp"/[ab].h5
    nsd-step -n 4 -o "$tmp/a.h5" "$tmp/heap.h5" && nsd-step -n 4 -i "$tmp/a.h5" &&
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
    nsd-step "$@" --eps "$eps" -o "$tmp/one.h5" "$file" &&
        ranks "$k" "$@" --eps "$eps" --contacts --order block -o "$tmp/block.h5" "$file" || return 1
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
# positions that overlap are moved apart by ten sweeps, which end where they end: so without, or one step
ok "blocks on 2: the motion of one process, to the criterion" blocks "$tmp/heap.h5" 2 1e-8 -n 5 --overlap keep
ok "on 8" blocks "$tmp/heap.h5" 8 1e-8 -n 5 --overlap keep
ok "with bodies moved apart" blocks "$tmp/heap.h5" 3 1e-8 -n 1
ok "over a floor that is shaken, in a cell that repeats" blocks "$tmp/vibrated.h5" 3 1e-8 -n 2 --overlap keep
ok "in a cell that is sheared" blocks "$tmp/shear.h5" 3 1e-8 -n 2 --overlap keep
ok "with clumps, capsules, hulls" blocks "$tmp/rubble.h5" 2 1e-8 -n 1 --overlap gap
ok "with cohesion" blocks "$tmp/cohesive.h5" 3 1e-8 -n 2 --overlap keep
after 300 scenes/rolling.json
nsd-step -n 1 -o "$tmp/solved.h5" --contacts "$tmp/rolling.h5" 2>/dev/null
ok "with bonds of clumps, capsules, hulls" blocks "$tmp/glued.h5" 3 1e-6 -n 1 --overlap keep
ok "with rolling friction" blocks "$tmp/rolling.h5" 3 1e-6 -n 1 --overlap keep
ok "by Anderson's acceleration" blocks "$tmp/rolling.h5" 2 1e-6 -n 1 --global anderson --overlap keep
ok "with bonds" blocks "$tmp/bonded.h5" 3 1e-8 -n 3 --overlap keep
ok "with rolling friction, from the last reactions and moments" blocks "$tmp/solved.h5" 3 1e-6 -n 2 --warm --overlap keep
ok "with grains that pour" blocks "$tmp/pour.h5" 2 1e-8 -n 3 --overlap keep
overlaps() # FILE: m, the largest of the last frames
{
    nsd-info "$1" | jq -s 'map(select(.max_overlap != null)) | last | .max_overlap'
}
moved_apart() # after as many steps overlaps are as small as those of one process
{
    rm -f "$tmp"/[ab].h5
    nsd-step -n 60 --every 60 -o "$tmp/a.h5" "$tmp/heap.h5" && ranks 4 -n 60 --every 60 --order block -o "$tmp/b.h5" "$tmp/heap.h5" &&
        jq -n --argjson a "$(overlaps "$tmp/a.h5")" --argjson b "$(overlaps "$tmp/b.h5")" -e '($b | type) == "number" and $b <= 1.5 * $a'
}
ok "and their overlaps do not grow" moved_apart
last_of() { nsd-info --last -p "$1" | grep .; }
frames_alike() # the same processes: the same bytes; and as many frames as may be kept change no motion
{
    rm -f "$tmp"/[abc].h5
    for f in a b; do ranks 3 -n 6 --order block -o "$tmp/$f.h5" "$tmp/heap.h5" || return 1; done
    ranks 3 -n 6 --every 6 --order block -o "$tmp/c.h5" "$tmp/heap.h5" && cmp "$tmp/a.h5" "$tmp/b.h5" &&
        last_of "$tmp/a.h5" >"$tmp/a" && last_of "$tmp/c.h5" >"$tmp/c" && cmp "$tmp/a" "$tmp/c"
}
ok "as many processes give the same bytes, whatever frames are kept" frames_alike

# ---- balance ----

even() # MEAN MOST CUTS: in the run of $tmp/said the fullest had less than these, over the mean, and there were more cuts
{
    local mean most cuts
    cat "$tmp/said"
    read -r mean most cuts < <(sed -n 's/.*fullest \([0-9.]*\) of the mean on average, \([0-9.]*\) at most, \([0-9]*\) cuts.*/\1 \2 \3/p' "$tmp/said")
    [ -n "$cuts" ] && awk "BEGIN { exit !($mean >= 1 && $mean < $1 && $most < $2 && $cuts > $3) }"
}
# a heap is kept between two boundaries until it is settled; then it slides out of where it was cut
nsd-gen - 2>/dev/null <<'EOF' | nsd-step -n 250 --every 250 2>/dev/null | nsd-cat --last >"$tmp/slide.h5"
{ "dim": 2, "dt": 1e-3, "gravity": [6, -8], "mu": 0.1, "density": 1000,
  "bodies": [{ "count": 400, "radius": 0.01, "box": { "x": [0, 0.5], "y": [0, null] } }],
  "walls": [{ "point": [0, 0], "normal": [0, 1] }, { "point": [0.5, 0], "normal": [-1, 0], "until": 0.25 },
            { "point": [0, 0], "normal": [1, 0], "until": 0.25 }] }
EOF
ok "a heap that slides across the parts: the bytes of one process" same "$tmp/slide.h5" 3 -n 120 --every 120
ok "and it is cut anew, so that the work stays even" even 1.15 1.5 2
ok "the same in cells of a grid, by a hypergraph" same "$tmp/slide.h5" 4 -n 60 --every 60 --cut hypergraph
ok "as even" even 1.2 1.5 2
jq -n '{ dim: 2, dt: 1e-3, walls: [{ normal: [0, 1], point: [0, 0] }], bodies: [{ x: [0, 0.01], radius: 0.01 }] }' | nsd-gen - >"$tmp/disc.h5"
ok "of one disc" same "$tmp/disc.h5" 3 -n 2 --cut hypergraph
ok "and in blocks" blocks "$tmp/heap.h5" 3 1e-8 -n 2 --overlap keep --cut hypergraph
ok "a drum that turns through them: the bytes of one process" same "$tmp/drum.h5" 3 -n 25 --every 25
ok "and the work stays even" even 1.15 1.3 1

# ---- what goes wrong ----

not_to_stdout() { ranks 2 -n 1 "$tmp/heap.h5"; }
status 64 "no document to what mpirun calls standard output" not_to_stdout
like "and it says what to do" "$(cat "$tmp/err" "$tmp/out")" "nsd-step: under mpirun the output goes to a file"

mkdir "$tmp/alone"
cp "$(command -v nsd-step)" "$tmp/alone"
without_mpi() { OMPI_COMM_WORLD_SIZE=2 "$tmp/alone/nsd-step" -n 1 -o "$tmp/c.h5" "$tmp/heap.h5"; }
status 69 "a build without MPI does not step twice" without_mpi
like "and says so" "$(cat "$tmp/err")" "^nsd-step: 2 processes were started together, and this nsd-step has no MPI"

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
    grep -q 'nsd-step: another process of the run has ended' "$tmp/said" || { cat "$tmp/said"; return 1; }
    nsd-step -n 2 -i "$tmp/d.h5" && nsd-info "$tmp/d.h5" >/dev/null
}
ok "a process that dies ends the run, whose frames are whole, and it goes on" dies

done_testing
