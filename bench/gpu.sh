#!/bin/bash
# gpu.sh [DEVICE] [RUNS]: a device [opencl:0] beside the CPU in the same run: ns a contact and sweep, the bandwidth that
# this is, whole steps, bytes over the bus; the median of RUNS [3], with the least and most. Where the device is a GPU, or
# FORCE=1 (to try this script), it leaves bench/results/MACHINE/gpu.{tsv,md}. Elsewhere it measures nothing and prints a model: launches a
# sweep, counted, and bytes a sweep; with BANDWIDTH=GB/s LAUNCH=us what these would take there, which is no figure.
# QUICK=1: small heaps.
set -euo pipefail
cd "$(dirname "$0")/.."
source bench/common.sh
source bench/heap.sh
device=${1:-opencl:0}
runs=${2:-3}
if [ -n "${QUICK-}" ]; then heaps=(16 64); else heaps=(200 2000 8000); fi
say() { echo "gpu.sh: $*" >&2; }

line=$(nsd-solve --device list | awk -F'\t' -v d="$device" '$1 == d')
[ -n "$line" ] || { say "$device: no such device: nsd-solve --device list"; exit 69; }
gpu=$(cut -f 2 <<< "$line") name=$(cut -f 3 <<< "$line")

# Bytes that a contact reads and writes in a sweep of exact: its lines of a bundle (n, arms, 1/w, mu, places), r in and
# out, two bodies in and out. A cache that holds bodies from one contact to the next needs less.
bytes=$((72 + 2 * 24 + 4 * 64))

# METHOD SWEEPS OPTION ...: seconds in the solver, sweeps, contacts, kernels, bytes to the device and from it
solve()
{
    local method=$1 sweeps=$2
    shift 2
    rm -f "$work/log"
    nsd-solve -m "$method" --order colour --criterion glob --tolerance 0 --max-sweeps "$sweeps" --log "$work/log" "$@" \
        "$work/heap.h5" > /dev/null 2>&1
    jq -r '[.elapsed, .sweeps, .contacts, .device.kernels // 0, .device.bytes_to // 0, .device.bytes_from // 0] | @tsv' "$work/log"
}

# METHOD OPTION ...: ns a contact and sweep. The first 40 sweeps, each judged, are taken off, and with them what is sent.
sweep()
{
    local method=$1 few many
    shift
    few=$(solve "$method" 40 "$@")
    many=$(solve "$method" $((40 + more)) "$@")
    awk '{ printf "%.3g\n", 1e9 * ($7 - $1) / ($8 - $2) / $9 }' <<< "$few"$'\t'"$many"
}

# OPTION ...: steps a second, of ten that follow a first; what these send and get, bytes
steps()
{
    rm -f "$work/log"
    nsd-step -n 11 --every 11 --order colour --log "$work/log" "$@" < "$work/start.h5" > /dev/null 2>&1
    jq -rs '.[1:] | [(1000 * length / (map(.elapsed + .detection) | add) | round) / 1000, (map(.device.bytes_to // 0) | add / length),
        (map(.device.bytes_from // 0) | add / length)] | @tsv' "$work/log"
}

model()
{
    local one two
    echo "Nothing is measured: $name is no GPU. A model of a sweep of exact:"
    printf 'balls\tcontacts\tlaunches a sweep\tcontacts a launch\tMB a sweep\tMB to the device\tmodelled us\n'
    for tiles in "${heaps[@]}"; do
        heap "$tiles" | nsd-detect > "$work/heap.h5"
        one=$(solve exact 1 --device "$device")
        two=$(solve exact 2 --device "$device")
        awk -v balls=$((500 * tiles)) -v bytes=$bytes -v bandwidth="${BANDWIDTH-}" -v launch="${LAUNCH-}" '
            # a sweep is the difference of one and two, but for the judgement of each of the first 40: two launches
            { n = ($10 - $4) - 2
              printf "%d\t%d\t%d\t%.0f\t%.1f\t%.1f\t%s\n", balls, $3, n, $3 / (n - 1), 1e-6 * bytes * $3, 1e-6 * $5,
                  bandwidth && launch ? sprintf("%.0f", n * launch + bytes * $3 / bandwidth / 1e3) : "-" }' <<< "$one"$'\t'"$two"
    done
}

measured()
{
    echo "# $name ($device) beside $(machine); median of $runs"
    printf 'balls\tcontacts\twhat\ton\tmedian\tleast\tmost\n'
    local tiles contacts balls method where
    for tiles in "${heaps[@]}"; do
        balls=$((500 * tiles))
        say "$balls balls"
        heap "$tiles" > "$work/start.h5"
        nsd-detect "$work/start.h5" > "$work/heap.h5"
        contacts=$(solve exact 1 | cut -f 3)
        for where in "--device $device" "-j 1" "-j $(nproc)"; do
            more=$((20000000 / contacts + 100)) # sweeps: a tenth of a second and more
            [[ $where == -j* ]] && more=$((more / 4 + 5))
            for method in exact sbp ebp; do
                [[ $where == -j* ]] || solve $method 1 --device "$device" > "$work/warm" # the driver keeps what it compiles
                # shellcheck disable=SC2086 # words
                for ((k = 0; k < runs; k++)); do sweep $method $where; done | median > "$work/median"
                printf '%d\t%d\tns a contact and sweep, %s\t%s\t%s\n' "$balls" "$contacts" $method "$where" "$(cat "$work/median")"
                [ $method = exact ] && awk -v OFS='\t' -v balls="$balls" -v contacts="$contacts" -v where="$where" -v bytes=$bytes '
                    { print balls, contacts, "GB/s, exact", where, sprintf("%.3g\t%.3g\t%.3g", bytes / $1, bytes / $3, bytes / $2) }' "$work/median"
            done
            # shellcheck disable=SC2086
            for ((k = 0; k < runs; k++)); do steps $where; done > "$work/steps"
            printf '%d\t%d\tsteps a second\t%s\t%s\n' "$balls" "$contacts" "$where" "$(cut -f 1 "$work/steps" | median)"
            [[ $where == -j* ]] || awk -v OFS='\t' -v balls="$balls" -v contacts="$contacts" -v where="$where" '
                NR == 1 { print balls, contacts, "MB to it a step", where, 1e-6 * $2
                          print balls, contacts, "MB from it a step", where, 1e-6 * $3 }' "$work/steps"
        done
        rm "$work/heap.h5"
    done
}

if [ "$gpu" != GPU ] && [ -z "${FORCE-}" ]; then
    model
    exit
fi
measured > "$work/gpu.tsv"
mkdir -p "$results"
cp "$work/gpu.tsv" "$results/gpu.tsv"
{
    echo "# The sweep on a device"
    echo
    echo "$name beside $(machine), the median of $runs runs. A sweep of exact counts as $bytes bytes a contact."
    echo
    markdown < "$results/gpu.tsv"
} > "$results/gpu.md"
cat "$results/gpu.md"
