#!/usr/bin/env bash
# Several processes divide small steps: the bytes of one process for any number of them, the run that loses one ends
# clearly, and what is not divided is said.
# shellcheck source=tests/support/tap.sh
. tests/support/tap.sh

# shellcheck source=tests/support/mpi.sh
. tests/support/mpi.sh

ranks() # K ARGUMENT ...: nsd-step by K processes
{
    timeout 300 mpirun --oversubscribe --bind-to none -n "$1" nsd-step "${@:2}" </dev/null # or mpirun reads on where a test does
}
last() { nsd-cat --last "$1"; }
divided() { sed -n 's/.*: \([0-9]*\) small steps divided.*/\1/p' "$tmp/said"; }
same() # FILE "K ..." ARGUMENT ...: the bytes of one process, with small steps that all have divided
{
    local file=$1 many=$2 k
    rm -f "$tmp/one.h5"
    nsd-step "${@:3}" -o "$tmp/one.h5" "$file" 2>/dev/null || return 1
    for k in ${thin:+2} $([ -n "$thin" ] || echo "$many"); do
        rm -f "$tmp/many.h5"
        ranks "$k" "${@:3}" -o "$tmp/many.h5" "$file" 2>"$tmp/said" || { cat "$tmp/said"; return 1; }
        cmp "$tmp/one.h5" "$tmp/many.h5" || return 1
        [ -n "${undivided-}" ] || [ "$(divided)" -gt 0 ] || { cat "$tmp/said"; return 1; }
    done
}
undivided() { undivided=1 same "$@" && [ -z "$(divided)" ]; } # the same by the first process alone
after() # STEPS SCENE: its packing then, into $tmp/NAME.h5
{
    nsd-gen "$2" | nsd-step -n "$1" --every "$1" 2>/dev/null | nsd-cat --last >"$tmp/$(basename "$2" .json).h5"
}

# ---- the same bytes ----

nsd-gen 300 | nsd-step -n 900 --every 900 2>/dev/null | nsd-cat --last >"$tmp/heap.h5"
while read -r before scene many steps name; do
    after "$before" "scenes/$scene.json"
    ok "$name: the bytes of one process" same "$tmp/$scene.h5" "${many//,/ }" -n "$steps" --every $((steps / 2)) --contacts
done <<'END'
200 drum 2,3,4 20 a drum that turns
100 vibrated 3 20 a cell that repeats, over a floor that is shaken
500 pour 3 20 grains that pour and are taken away
300 rolling 3 20 rolling friction
100 cohesive 3 10 cohesion
20 bonded 3 10 bonds
60 column 3 10 a column that flows
END
ok "with contacts that have a stiffness" same "$tmp/rolling.h5" 3 -n 4 --every 2 --contacts --stiffness 1e5
ok "with threads in each" same "$tmp/heap.h5" 2 -n 10 --every 5 -j 2
ok "from no reactions" same "$tmp/heap.h5" 3 -n 5 --cold
jq -n '{ gravity: [0, 0, -9.81], dt: 1e-3, e_n: 0.5, materials: { heavy: { density: 2600000 } }, walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }],
    bodies: ([range(3) as $i | range(3) as $j | range(3) as $k | { x: [0.021 * $i, 0.021 * $j, 0.0101 + 0.0203 * $k], radius: 0.01 }] +
        [{ x: [0.021, 0.021, 0.08], radius: 0.01, material: "heavy", v: [0, 0, -1] }]) }' | nsd-gen - >"$tmp/heavy.h5"
ok "among steps that are made at once" same "$tmp/heavy.h5" 3 -n 60
nsd-gen 3 >"$tmp/three.h5"
ok "of three bodies, by five processes" same "$tmp/three.h5" 5 -n 3

# ---- what the first process does ----

# shellcheck disable=SC2016 # for another shell
acts='jq -c --unbuffered "{forces: [range(.bodies) | [(. * 1e-8), 0, 2e-6]], torques: {\"200\": [0, 0, 1e-8]}, gravity: [(.step | sin), 0, -9.81],
    velocities: (if .step % 4 == 1 then {\"205\": [0.01, 0, 0]} else {} end), friction: [[\"ball\", \"wall\", (.step % 7 / 10)]],
    boundaries: {\"0\": {velocity: [0, 0, (.time | sin * 1e-3)]}}}"'
ok "forces, torques, velocities, gravity, friction, boundaries that a program answers" same "$tmp/heap.h5" 3 -n 8 --contacts --with "$acts" --with-walls all
on_others() # a run on 2, then 3, against one process
{
    rm -f "$tmp"/[ab].h5
    nsd-step -n 10 --every 5 -o "$tmp/a.h5" "$tmp/drum.h5" && nsd-step -n 10 --every 5 -i "$tmp/a.h5" &&
        ranks 2 -n 10 --every 5 -o "$tmp/b.h5" "$tmp/drum.h5" && ranks "${thin:+2}${thin:-3}" -n 10 --every 5 -i "$tmp/b.h5" && cmp "$tmp/a.h5" "$tmp/b.h5"
}
ok "a run resumes on another number of processes" on_others
ok "with a bound on the missing impulse the first makes them alone" undivided "$tmp/heap.h5" 2 -n 5 --missing-impulse 0.1
like "and this is said" "$(cat "$tmp/said")" "2 processes: the first makes all small steps, and the others wait, because of a bound on the missing impulse: use threads"
after 5 scenes/rubble.json
ok "and those of other shapes than balls" undivided "$tmp/rubble.h5" 2 -n 3
like "said, too" "$(cat "$tmp/said")" "because of shapes other than balls, or meshes"
jq -n '{ dt: 1e-3, gravity: [0, 0, -9.81], density: 2600, seed: 5, walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }],
    kinds: { g: { breaks: { by: "energy", strength: 0.1, smallest: 3e-3, into: "balls" } } }, bodies: [{ count: 20, radius: 2e-3, kind: "g",
        v: [0, 0, -1], box: { x: [0, 0.02], y: [0, 0.02], z: [0, null] } }] }' | nsd-gen - >"$tmp/breaks.h5"
ok "and those of grains that break" undivided "$tmp/breaks.h5" 2 -n 15 --every 5 --contacts
ok "they have broken" grep -q "[1-9][0-9]* grains have broken" "$tmp/said"
like "and the processes that wait are said" "$(cat "$tmp/said")" "the first makes all steps of grains that break"
for order in colour block; do
    ok "grains that break, with one solve per step and --order $order" undivided "$tmp/breaks.h5" 2 -n 15 --every 5 --small-steps 0 --order $order
done
ranks 2 -n 1 -o "$tmp/few.h5" "$tmp/heap.h5" 2>"$tmp/err"
like "few bodies: one process is advised" "$(cat "$tmp/err")" "2 processes for [0-9]+ bodies are slower than one, .*: below 10000 bodies per process"

# ---- what goes wrong ----

dies() # RANK: it is killed after some frames; the run ends by itself, with whole frames
{
    rm -f "$tmp/d.h5"
    ranks 2 -n 100000 -o "$tmp/d.h5" "$tmp/heap.h5" >"$tmp/said" 2>&1 &
    local job=$! k victim=
    for ((k = 0; k < 600; k++)); do
        [ "$(nsd-info "$tmp/d.h5" 2>/dev/null | jq -s 'map(select(.step != null)) | length')" -gt 2 ] 2>/dev/null && break
        sleep 0.1
    done
    for k in $(ps -eo pid,args | awk -v f="$tmp/d.h5" 'index($0, f) && $2 ~ /^nsd-step/ { print $1 }'); do
        ! tr '\0' '\n' <"/proc/$k/environ" | grep -qx "OMPI_COMM_WORLD_RANK=$1" || victim=${victim:-$k} # its child comes after it
    done
    if [ -z "$victim" ] || ! kill -9 "$victim"; then cat "$tmp/said"; return 1; fi
    for ((k = 0; k < 600; k++)); do kill -0 "$job" 2>/dev/null || break; sleep 0.1; done
    kill "$job" 2>/dev/null && echo "it has not ended by itself" && return 1
    ! wait "$job" && ranks 2 -n 2 -i "$tmp/d.h5"
}
ok "a process that is killed ends the run of all, which resumes" dies 1
[ -n "$thin" ] || ok "so the first one" dies 0
jq -n '{ dt: 1e-3, density: 1000, cell: { lengths: [1, 1, 1], repeats: [true, true, true] },
    bodies: [{ x: [0.5, 0.5, 0.5], radius: 0.1, v: [1e5, 0, 0] }, { x: [0.2, 0.2, 0.2], radius: 0.1 }] }' | nsd-gen - >"$tmp/fast.h5"
as_alone() # the status of one process, and its line
{
    local s=0 t=0
    nsd-step -n 3 -o "$tmp/one.h5" "$1" 2>"$tmp/single" || s=$?
    ranks 2 -n 3 -o "$tmp/many.h5" "$1" 2>"$tmp/said" || t=$?
    cat "$tmp/single" "$tmp/said"
    [ "$s" = "$t" ]
}
ok "a body that is too fast for any number of steps: the status of one process" as_alone "$tmp/fast.h5"

done_testing
