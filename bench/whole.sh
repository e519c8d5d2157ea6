#!/bin/bash
# whole.sh [RUNS]: what is around the sweep: the start of tools, pipes, threads on whole steps, also beside a
# program that needs a core, the step outside the sweep, and what a contact costs where the bus brings it. The
# least of RUNS [5], beside that of another build (OTHER=DIR, the last that landed) in turn with it. Leaves bench/results/MACHINE/whole.{tsv,md}.
# Steps are those of the results kept: to 1e-4 of the natural map, cold but where a row says warm.
# shellcheck disable=SC2016 # commands that another shell expands
set -euo pipefail
cd "$(dirname "$0")/.."
source bench/common.sh
source bench/heap.sh
runs=${1:-5} ours=$(cd "${NSD_BUILD:-build}" && pwd) other=${OTHER:+$(cd "$OTHER" && pwd)}

# The least of the numbers on standard input
least() { sort -g | head -n 1; }

# Where the numbers of a build go
key() { echo "$(tr / - <<< "$1").times"; }

# figure, unit, at most; a command that prints a number
row()
{
    local figure=$1 unit=$2 most=$3 command=$4 dir n
    for ((n = 0; n < runs; n++)); do
        for dir in "$ours" ${other:+"$other"}; do
            PATH=$dir:$PATH bash -euo pipefail -c "$command" >> "$work/$(key "$dir")"
        done
    done
    printf '%s\t%s\t%s\t%.4g' "$figure" "$unit" "$most" "$(least < "$work/$(key "$ours")")"
    [ -z "$other" ] || printf '\t%.4g' "$(least < "$work/$(key "$other")")"
    printf '\n'
    rm -f "$work"/*.times
}

nsd-gen 1000000 > "$work/million.h5"
nsd-gen 500 | nsd-step --criterion natural -n 800 --every 800 2> /dev/null | nsd-cat --last > "$work/pile.h5"
nsd-step --criterion natural --warm -n 3000 --every 3000 "$work/pile.h5" 2> /dev/null | nsd-cat --last > "$work/rest.h5"
heap 16 > "$work/flat.h5"
for n in 200 2000; do heap $n | nsd-detect > "$work/heap$n.h5"; done
nsd-gen 100000 | nsd-step --criterion natural -n 700 --every 700 2> /dev/null | nsd-cat --last > "$work/column.h5"
jq -n '{ dt: 1e-5, gravity: [0.3, 0.2, -9.81], walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }], bodies:
    [range(27000) | { radius: 0.0005, x: [. % 30 / 1000, (. / 30 | floor) % 30 / 1000, 0.0005 + (. / 900 | floor) / 1000] }] }' |
    nsd-gen - > "$work/cube.h5"

# of the processor, ms; each tool says its version ten times
start='TIMEFORMAT="%U %S"; { time for k in 1 2 3 4 5 6 7 8 9 10; do TOOL --version > /dev/null; done; } 2>&1 | awk "{ print 100 * (\$1 + \$2) }"'
# seconds for the document, to be turned into MB/s by the reader: 136 MB
pipe='TIMEFORMAT=%R; { time cat "$work/million.h5" | CHAIN > /dev/null; } 2>&1'
four='TIMEFORMAT=%R; { time cat "$work/million.h5"{,,,} | CHAIN > /dev/null; } 2>&1'
# seconds on the wall of nsd-step
steps='TIMEFORMAT=%R; { time nsd-step --criterion natural -j THREADS -n STEPS --every STEPS "$work/FILE.h5" > /dev/null 2>&1; } 2>&1'
# the share of nsd-step's time that is not the solver's, %
outside='TIMEFORMAT=%R; t=$({ time nsd-step --criterion natural -j 2 -n 200 --every 200 --log "$work/log" "$work/column.h5" > /dev/null 2>&1; } 2>&1)
    jq -s --argjson t "$t" "100 * (1 - (map(.elapsed) | add) / \$t)" "$work/log"'
# ns a contact and sweep: what sweeps beyond the first 40, each of which is judged, take
sweep='for n in 40 SWEEPS; do nsd-solve -m exact -j THREADS --order colour --criterion glob --tolerance 0 --max-sweeps $n --log "$work/log$n" "$work/FILE.h5" \
    > /dev/null 2>&1; done; jq -s "1e9 * (.[1].elapsed - .[0].elapsed) / (.[1].sweeps - .[0].sweeps) / .[0].contacts" "$work/log40" "$work/logSWEEPS"'

rows()
{
    local tool file tiles n
    for tool in nsd-gen nsd-cat nsd-solve nsd-step nsd-view; do
        row "$tool --version" "ms of CPU" 10 "${start//TOOL/$tool}"
    done
    row "136 MB through nsd-cat" s 0.34 "${pipe//CHAIN/nsd-cat}"
    row "136 MB through nsd-cat, three in a row" s 0.34 "${pipe//CHAIN/nsd-cat | nsd-cat | nsd-cat}"
    row "four times 136 MB through nsd-cat, three in a row" s 1.36 "${four//CHAIN/nsd-cat | nsd-cat | nsd-cat}"
    for file in pile:200 flat:20 column:20 cube:10; do
        n=${steps//STEPS/${file#*:}} n=${n//FILE/${file%:*}}
        row "${file#*:} steps, ${file%:*}, -j 1" s "" "${n//THREADS/1}"
        row "${file#*:} steps, ${file%:*}, -j 2" s "" "${n//THREADS/2}"
        row "${file#*:} steps, ${file%:*}, -j 2, and a neighbour that needs a core" s "" \
            "while :; do :; done & trap 'kill \$!' EXIT; ${n//THREADS/2}"
    done
    row "2000 steps, 500 warm balls at rest" s "" \
        'TIMEFORMAT=%R; { time nsd-step --criterion natural --warm -n 2000 --every 2000 "$work/rest.h5" > /dev/null 2>&1; } 2>&1'
    row "200 steps, column, -j 2: outside the solver" % 40 "$outside"
    for file in heap200:340 heap2000:90; do
        tiles=${file%:*} tiles=${tiles#heap} n=${sweep//SWEEPS/${file#*:}} n=${n//FILE/${file%:*}}
        row "a contact in a sweep, $((500 * tiles)) balls, -j 1" ns "" "${n//THREADS/1}"
        row "a contact in a sweep, $((500 * tiles)) balls, -j 2" ns 8 "${n//THREADS/2}"
    done
}

mkdir -p "$results"
{
    echo "# $(machine); the least of $runs"
    printf 'figure\tunit\tat most\tleast%s\n' "${other:+$'\t'the other build}"
    rows | tee /dev/stderr
} > "$results/whole.tsv"
{
    echo "# Around the sweep"
    echo
    echo "$(machine). The least of $runs runs."
    echo
    markdown < "$results/whole.tsv"
} > "$results/whole.md"
