#!/usr/bin/env bash
# scale.sh [PART ...]: what several processes tell each other, what they take and how long it takes: the
# figures of docs/scale. Parts: messages strong weak memory; all by default. MPI and build/nsd-step-mpi.
#
# A cube of equal balls on a lattice, between a floor and four walls, under leaning gravity: every rank has as
# much to do, and 3 contacts a ball. Processes beyond the cores count for bytes, messages and memory, not for
# time; processor time is without waiting for others, since machines are shared. QUICK=1: no cube of more than
# 97 336 balls; REPEATS=3
set -euo pipefail
export PATH=$PWD/build:$PATH OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_mpi_yield_when_idle=1
[ $# -gt 0 ] || set -- messages strong weak memory
sizes=(16 24 32 46) million=46 half=36
[ -n "${QUICK-}" ] || sizes+=(64) million=100 half=79
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT

cube() # SIDE: its file, made once
{
    local f=$tmp/cube$1.h5
    # from a table: a scene of a million bodies is itself as large as they are
    [ -e "$f" ] || awk -v n="$1" 'BEGIN { for (k = 0; k < n; k++) for (j = 0; j < n; j++) for (i = 0; i < n; i++)
        print 0.001 + 0.002 * i, 0.001 + 0.002 * j, 0.001 + 0.002 * k, 0.001 }' >"$tmp/balls.txt"
    [ -e "$f" ] || jq -n --argjson n "$1" --arg balls "$tmp/balls.txt" '{ dt: 1e-4, mu: 0.3, density: 2500, gravity: [0.3, 0.2, -9.81],
        walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }, { point: [0, 0, 0], normal: [1, 0, 0] },
                { point: [0, 0, 0], normal: [0, 1, 0] }, { point: [$n * 0.002, 0, 0], normal: [-1, 0, 0] },
                { point: [0, $n * 0.002, 0], normal: [0, -1, 0] }],
        bodies: [{ file: $balls }] }' |
        nsd-gen - >"$f"
    echo "$f"
}
run() # RANKS SIDE ARGUMENT ...: said on standard error, and the log in $tmp/log
{
    local k=$1 f
    f=$(cube "$2")
    shift 2
    rm -f "$tmp/out.h5"
    if [ "$k" = 1 ]; then
        nsd-step --criterion natural --gap 1e-8 --every 1000 --log "$tmp/log" -o "$tmp/out.h5" "$@" "$f" 2>&1
    else
        mpirun --oversubscribe --bind-to none -n "$k" nsd-step --criterion natural --gap 1e-8 --every 1000 --log "$tmp/log" -o "$tmp/out.h5" "$@" "$f" 2>&1
    fi
}
said() { sed -n "s/.*ranks: \([^ ]*\) bytes in \([^ ]*\) messages.*memory \([^ ]*\) MB, of the largest \([^ ]*\) MB.*/\1 \2 \3 \4/p"; }

messages() # bytes and messages a sweep and rank, 8 ranks, and the fit c N^(2/3)
{
    local n order bytes many _rest
    for order in block colour; do
        for n in "${sizes[@]}"; do
            read -r bytes many _rest < <(run 8 "$n" -n 1 -m exact --order $order --max-sweeps 100 --tolerance 1e-30 | said)
            echo "$order $((n * n * n)) $((n * n * n / 8)) $bytes $many"
        done
    done | awk '{ c = $4 / $3 ^ (2 / 3); printf "| %s | %d | %d | %.0f | %.1f | %.1f |\n", $1, $2, $3, $4, $5, c }'
}
pair() # SIDE SIDE2 STEPS: one process on the one cube, two ranks on the other, in turn: s of a processor in the solver
{
    local k t s t2 s2
    for ((k = 0; k < ${REPEATS:-3}; k++)); do
        read -r s t < <(run 1 "$1" -n "$3" --order block --tolerance 1e-3 | sed -n 's/.* steps, \([0-9]*\) sweeps, \([^ ]*\) s in.*/\1 \2/p')
        run 2 "$2" -n "$3" --order block --tolerance 1e-3 >"$tmp/said"
        s2=$(sed -n 's/.* steps, \([0-9]*\) sweeps, .*/\1/p' "$tmp/said")
        t2=$(sed -n 's/.* \([^ ]*\) s of them in the solver.*/\1/p' "$tmp/said")
        echo "$(($1 * $1 * $1)) $(($2 * $2 * $2)) $t $s $t2 $s2"
    done | awk -v weak="$([ "$1" = "$2" ] || echo 1)" '
        { e = $3 / $5 * (weak ? $2 / $1 / 2 : 1 / 2)
          printf "| %d | %d | %.3g | %d | %.3g | %d | %.0f %% | %.0f %% |\n", $1, $2, $3, $4, $5, $6, 100 * e, 100 * e * $6 / $4 }'
}
memory() # ORDER SIDE: MB of all, of the largest: one process, and 2, 4, 8
{
    local k all most _bytes _many one f
    f=$(cube "$2")
    one=$(/usr/bin/python3 -c 'import resource, subprocess, sys
subprocess.run(sys.argv[1:], stderr=subprocess.DEVNULL)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024)' nsd-step --criterion natural --gap 1e-8 -n 1 --every 1000 --order "$1" --tolerance 1e-2 -o "$tmp/one.h5" "$f")
    for k in 2 4 8; do
        read -r _bytes _many all most < <(run "$k" "$2" -n 1 --order "$1" --tolerance 1e-2 | said)
        echo "$1 $(($2 * $2 * $2)) $k $one $all $most"
    done | awk '{ printf "| %s | %d | %d | %.0f | %.0f | %.0f | %.2f |\n", $1, $2, $3, $4, $5, $6, $6 / ($4 / $3) }'
}

for part; do
    case $part in
    messages) printf '| order | balls | a rank | bytes a sweep | messages a sweep | bytes / N^(2/3) |\n|---|---|---|---|---|---|\n'; messages ;;
    strong) printf '| balls, one process | balls, two ranks | s | sweeps | s of a rank | sweeps | efficiency | of a sweep |\n|---|---|---|---|---|---|---|---|\n'
        pair 46 46 4; [ -n "${QUICK-}" ] || pair "$million" "$million" 3 ;;
    weak) printf '| balls, one process | balls, two ranks | s | sweeps | s of a rank | sweeps | efficiency | of a sweep |\n|---|---|---|---|---|---|---|---|\n'
        pair "$half" "$million" 3 ;;
    memory) printf '| order | balls | ranks | one process, MB | all ranks, MB | the largest, MB | of its share |\n|---|---|---|---|---|---|---|\n'
        memory block 46; [ -n "${QUICK-}" ] || memory block 100; memory colour 46 ;;
    *) echo "usage: scale.sh [messages] [strong] [weak] [memory]" >&2; exit 64 ;;
    esac
    echo
done
