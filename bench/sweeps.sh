#!/bin/bash
# sweeps.sh [RUNS]: what a contact costs in a sweep, ns on the wall: method x vector width x threads x size,
# each the median of RUNS [5] in turn, with the least and most. Siconos' NSGS beside it where it is
# installed. Leaves bench/results/MACHINE/sweeps.{tsv,md,svg}.
set -euo pipefail
cd "$(dirname "$0")/.."
source bench/common.sh
source bench/heap.sh
runs=${1:-5}
methods=(exact sbp sal ebp eal)
widths=(2)
grep -qw avx2 /proc/cpuinfo && widths+=(4)
grep -qw avx512f /proc/cpuinfo && widths+=(8)
widest=${widths[-1]}
problem=../shared/problems/Spheres500-p1700.hdf5

# file method width threads sweeps order: a line of $work/times. The first 40 sweeps, each judged, are
# taken off: what is left has an evaluation of the criterion every 25 sweeps.
measure()
{
    local n
    rm -f "$work/log"
    for n in 40 $((40 + $5)); do
        NSD_LANES=$3 nsd-solve -m "$2" -j "$4" --order "$6" --criterion glob --tolerance 0 --max-sweeps "$n" --log "$work/one" "$1" \
            > /dev/null 2>&1
        cat "$work/one" >> "$work/log"
    done
    jq -rs --arg file "$(basename "$1" .h5)" --arg width "$3" --arg threads "$4" --arg order "$6" '
        [$file, .[0].method, $order, $width, $threads, .[0].contacts,
            1e9 * (.[1].elapsed - .[0].elapsed) / (.[1].sweeps - .[0].sweeps) / .[0].contacts] | @tsv' \
        "$work/log" >> "$work/times"
}

: > "$work/times"
settle
nsd-detect "$work/pile.h5" > "$work/500.h5"
for ((k = 0; k < runs; k++)); do
    for method in "${methods[@]}"; do
        measure "$work/500.h5" "$method" "$widest" 1 2000 natural
        for width in "${widths[@]}"; do measure "$work/500.h5" "$method" "$width" 1 2000 colour; done
    done
done
for tiles in 2 20 40 200 2000; do
    size=$((500 * tiles))
    echo "sweeps.sh: $size balls" >&2
    heap $tiles | nsd-detect > "$work/$size.h5"
    for ((k = 0; k < runs; k++)); do
        for method in "${methods[@]}"; do
            case $size/$method in ??????*/s* | ??????*/eal) continue ;; esac # as exact and ebp
            for threads in 1 2; do
                measure "$work/$size.h5" "$method" "$widest" $threads $((20000000 / size + 30)) colour
            done
        done
    done
    rm "$work/$size.h5"
done
if [ -f "$problem" ]; then
    ln -s "$PWD/$problem" "$work/p1700.h5"
    for ((k = 0; k < runs; k++)); do
        for method in "${methods[@]}"; do measure "$work/p1700.h5" "$method" "$widest" 1 2000 colour; done
        if ns=$(/usr/bin/python3 bench/nsgs.py 1000 "$problem" 2> /dev/null); then
            printf 'p1700\tSiconos NSGS\tnatural\t\t1\t1135\t%s\n' "$ns" >> "$work/times"
        fi
    done
fi

mkdir -p "$results"
{
    echo "# $(machine); median of $runs"
    printf 'balls\tmethod\torder\tlanes\tthreads\tcontacts\tns a contact\tleast\tmost\n'
    cut -f 1-6 "$work/times" | awk '!seen[$0]++' | while IFS= read -r row; do
        printf '%s\t' "$row"
        awk -F'\t' -v row="$row" 'index($0, row "\t") == 1 { print $7 }' "$work/times" | median |
            awk -F'\t' '{ printf "%.1f\t%.1f\t%.1f\n", $1, $2, $3 }'
    done
} > "$results/sweeps.tsv"
{
    echo "# A contact in a sweep"
    echo
    echo "$(machine). Time on the wall in ns a contact and sweep, the median of $runs runs in turn. The pile of 500"
    echo "balls is the paper's example 3 after 1000 steps; larger heaps are that pile side by side on one floor."
    echo "p1700 is an FCLIB problem, given by its W; Siconos' NSGS has its cheapest local solver there."
    echo
    markdown < "$results/sweeps.tsv"
    echo
    echo "![by size](sweeps.svg)"
} > "$results/sweeps.md"
gnuplot -e "data='$results/sweeps.tsv'; out='$results/sweeps.svg'" bench/sweeps.gp
cat "$results/sweeps.md"
