#!/bin/bash
# run.sh [RUNS]: the figures that nsd is to reach, each the median of RUNS [3] with its least and most.
# One thread where nothing is said. Leaves bench/results/MACHINE/figures.{tsv,md}, steps.{tsv,svg}.
set -euo pipefail
cd "$(dirname "$0")/.."
source bench/common.sh
source bench/heap.sh
runs=${1:-3}
TIMEFORMAT='%R %U %S' # seconds: on the wall, of user and of system
steps=200              # of the settled pile, for the figures of a sweep: a process's first 30 ms are dear
say() { echo "run.sh: $*" >&2; }

# name, unit, what it is to be at most, and its values on standard input: a line of the TSV
figure() {
    local stats
    stats=$(median)
    printf '%s\t%s\t%s\t%s\n' "$1" "$2" "$3" "$stats" |
        awk -F'\t' -v OFS='\t' '{ print $1, $2, $3, sprintf("%.3g", $4), sprintf("%.3g", $5),
            sprintf("%.3g", $6), $3 == "" ? "" : $4 <= $3 ? "yes" : "no" }' >> "$work/rows"
    tail -n 1 "$work/rows" >&2
}

# sums of a --log: seconds on the wall, sweeps, sweeps x contacts
sums() {
    jq -rs '[(map(.elapsed) | add), (map(.sweeps) | add), (map(.sweeps * .contacts) | add)] | @tsv' "$1"
}

# Steps on from the settled pile, with a log. nsd-step's own output is of no interest.
pile() {
    nsd-step -n "$steps" --every "$steps" --criterion glob --order colour --log "$work/log" "$@" < "$work/pile.h5" \
        > /dev/null 2>&1
}

# ns a contact and sweep of the last run
cost() { sums "$work/log" | awk '{ print 1e9 * $1 / $3 }'; }

a_sweep() {
    local method limit
    for method in exact sbp sal ebp eal; do
        limit=10
        case $method in e[ab]*) limit=30 ;; esac
        for ((k = 0; k < runs; k++)); do
            pile -m "$method" --tolerance 1e-8
            cost
        done | figure "a sweep with its share of the criterion, $method, $steps steps of the settled pile" ns/contact "$limit"
    done
}

# limit command ...: 1000 steps of $work/start.h5, the whole command on the wall
thousand() {
    local limit=$1
    shift
    for ((k = 0; k < runs; k++)); do
        { time nsd-step -m exact -n 1000 --criterion glob --overlap-rule keep "$@" < "$work/start.h5" > "$work/out.h5" 2> /dev/null; } 2>&1 |
            awk '{ print $1 }'
    done | figure "$start | nsd-step -m exact -n 1000 $*" s "$limit"
}

# The paper's 500 balls as nsd-gen lays them, and those on which other codes were measured
whole_runs() {
    local balls=../shared/problems/example3-balls.txt
    start="nsd-gen 500"
    nsd-gen 500 > "$work/start.h5"
    thousand 25 --tolerance 0 --max-sweeps 5000 --order colour
    thousand "" --tolerance 1e-8
    thousand 1.5 --tolerance 1e-8 --order colour --relax 1.5
    thousand 1.5 --tolerance 1e-8 --order colour --relax 1.5 --warm
    thousand 1.5 --tolerance 1e-8 --solver auto
    thousand 10 --tolerance 1e-12 --solver auto
    thousand 10 --tolerance 1e-12 --solver auto --warm
    [ -f "$balls" ] || return 0
    start="nsd-gen example3-balls"
    jq --arg file "$PWD/$balls" '.bodies = [{ file: $file }]' scenes/paper/example3.json |
        nsd-gen - > "$work/start.h5"
    thousand "" --tolerance 1e-8
    thousand 1.5 --tolerance 1e-8 --order colour --relax 1.5
    thousand 1.5 --tolerance 1e-8 --order colour --relax 1.5 --warm
    thousand 1.5 --tolerance 1e-8 --solver auto
    thousand 10 --tolerance 1e-12 --solver auto
    thousand 10 --tolerance 1e-12 --solver auto --warm
}

# Every frame or the last one only, in turn: what writing costs
writing() {
    local every
    nsd-gen 500 > "$work/start.h5"
    for ((k = 0; k < runs; k++)); do
        for every in 1 1000; do
            { time nsd-step -m exact -n 1000 --criterion glob --overlap-rule keep --tolerance 0 --max-sweeps 5000 --order colour --every $every \
                < "$work/start.h5" > "$work/out.h5" 2> /dev/null; } 2>&1 | awk '{ printf "%s ", $2 + $3 }'
        done | awk '{ print 100 * ($1 - $2) / $1 }'
    done | figure "writing 1000 frames of the run with 5000 sweeps a step" "% of its CPU" 5
}

reading() {
    nsd-gen 20 | nsd-step -n 10000 > "$work/long.h5" 2> /dev/null
    for ((k = 0; k < runs; k++)); do
        { time nsd-info "$work/long.h5" > /dev/null; } 2>&1 | awk '{ print ($2 + $3) / 10 }'
    done | figure "nsd-info, a frame of 20 balls" "ms of CPU" 0.3
}

# The criterion's share of a run. With the number of sweeps fixed (--tolerance 0 is never met) a sweep costs
# s + c with the criterion after each and s + c/25 as it comes: that gives s, a sweep with no criterion
# at all. Of a run that stops by the criterion, as many sweeps of s are what is not the criterion's.
criterion() {
    local sweeps each seldom run
    pile -m exact --tolerance 1e-8
    sweeps=$(sums "$work/log" | awk -v n="$steps" '{ print int($2 / n + 0.5) }')
    for ((k = 0; k < runs; k++)); do
        pile -m exact --tolerance 0 --max-sweeps "$sweeps" --every-sweep
        each=$(cost)
        pile -m exact --tolerance 0 --max-sweeps "$sweeps"
        seldom=$(cost)
        pile -m exact --tolerance 1e-8
        run=$(cost)
        awk -v each="$each" -v seldom="$seldom" -v run="$run" 'BEGIN {
            c = (each - seldom) / (1 - 1 / 25); s = seldom - c / 25
            print 100 * (run - s) / run, c }' >> "$work/share"
    done
    awk '{ print $1 }' "$work/share" | figure "the criterion's share of a run, exact" "%" 10
    awk '{ print $2 }' "$work/share" | figure "one evaluation of the criterion" "ns/contact" ""
}

# Steps of heaps of 1000 to 1 000 000 balls, 100 sweeps each: what a step costs, and the search in it
sizes() {
    local tiles size some
    printf 'balls\tcontacts\tns a step and ball\tns a search and ball\n' > "$work/steps"
    for tiles in 2 20 200 2000; do
        size=$((500 * tiles))
        say "$size balls"
        heap $tiles > "$work/heap.h5"
        some=$((size < 100000 ? 500000 / size + 1 : 6)) # enough of them for a second
        for ((k = 0; k < runs; k++)); do
            nsd-step -m exact -n $some --every $some --order colour --max-sweeps 100 --criterion glob --tolerance 0 --log "$work/log" \
                < "$work/heap.h5" 2> /dev/null > "$work/out.h5"
            # the first step makes the list of neighbours
            jq -rs --argjson n $size '.[1:] | [(map(.contacts) | add / length),
                1e9 * (map(.seconds + .detection) | add) / length / $n,
                1e9 * (map(.detection) | add) / length / $n] | @tsv' "$work/log"
        done > "$work/size"
        cut -f 3 "$work/size" | figure "the search for contacts in a step, $size balls" ns/ball 150
        printf '%s\t%s\t%s\t%s\n' $size "$(cut -f 1 "$work/size" | head -n 1)" \
            "$(cut -f 2 "$work/size" | median | cut -f 1)" "$(cut -f 3 "$work/size" | median | cut -f 1)" \
            | awk -F'\t' -v OFS='\t' '{ print $1, int($2), sprintf("%.0f", $3), sprintf("%.1f", $4) }' >> "$work/steps"
    done
    awk 'NR == 2 { least = $3 } END { print $3 / least }' "$work/steps" |
        figure "a step a ball, 1 000 000 balls over 1000" times ""
    { echo "# $(machine); 100 sweeps a step, exact, by colour"; cat "$work/steps"; } > "$results/steps.tsv"
    gnuplot -e "data='$results/steps.tsv'; out='$results/steps.svg'" bench/steps.gp
}

# One step of the heap of a million by hand
million() {
    local tool tools=("nsd-detect" "nsd-solve" "nsd-solve by auto" "nsd-move")
    for ((k = 0; k < runs; k++)); do
        for tool in "${tools[@]}"; do
            case $tool in
            nsd-detect) command=(nsd-detect "$work/heap.h5") ;;
            nsd-solve) command=(nsd-solve -m exact --order colour --max-sweeps 100 --criterion glob --tolerance 0 "$work/nsd-detect") ;;
            *auto) command=(nsd-solve --max-sweeps 100 --criterion glob --tolerance 0 "$work/nsd-detect") ;;
            nsd-move) command=(nsd-move "$work/nsd-solve") ;;
            esac
            /usr/bin/time -a -f '%e %M' -o "$work/$tool.time" "${command[@]}" > "$work/$tool" 2> /dev/null
        done
    done
    for tool in "${tools[@]}"; do
        awk 'NF == 2 { print $1 }' "$work/$tool.time" | figure "1 000 000 balls in a heap, $tool" s ""
        awk 'NF == 2 { print $2 / 1e6 }' "$work/$tool.time" |
            figure "1 000 000 balls in a heap, peak memory of $tool" "KiB/ball" 1
    done
}

: > "$work/rows"
mkdir -p "$results"
say "a settled pile: 1000 steps of 500 balls"
settle
a_sweep
whole_runs
writing
reading
criterion
sizes
million

{
    echo "# $(machine); median of $runs"
    printf 'figure\tunit\tat most\tmedian\tleast\tmost\treached\n'
    cat "$work/rows"
} > "$results/figures.tsv"
{
    echo "# Figures"
    echo
    echo "$(machine). The median of $runs runs, and the least and most."
    echo
    markdown < "$results/figures.tsv"
} > "$results/figures.md"
cat "$results/figures.md"
