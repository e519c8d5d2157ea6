#!/bin/bash
# run.sh [RUNS]: the figures that nsd is to reach, each the median of RUNS [3] with its least and most.
# One thread throughout. Leaves bench/results/figures.{tsv,md}.
set -euo pipefail
cd "$(dirname "$0")/.."
source bench/common.sh
runs=${1:-3}
TIMEFORMAT='%R %U %S' # seconds: on the wall, of user and of system
steps=20               # of the settled pile, for the figures of a sweep
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

# sums of a --log: seconds, sweeps, sweeps x contacts
sums() {
    jq -rs '[(map(.seconds) | add), (map(.sweeps) | add), (map(.sweeps * .contacts) | add)] | @tsv' "$1"
}

# Steps on from the settled pile, with a log. nsd-step's own output is of no interest.
pile() {
    nsd-step -n "$steps" --every "$steps" --log "$work/log" "$@" < "$work/pile.h5" \
        > /dev/null 2>&1
}

# ns a contact and sweep of the last run
cost() { sums "$work/log" | awk '{ print 1e9 * $1 / $3 }'; }

a_sweep() {
    local method limit
    for method in exact sbp sal ebp eal; do
        limit=60
        case $method in e[ab]*) limit=150 ;; esac
        for ((k = 0; k < runs; k++)); do
            pile -m "$method" --eps 1e-8
            cost
        done | figure "a sweep, $method, $steps steps of the settled pile" "ns/contact" "$limit"
    done
}

# 1000 steps of what a command makes, from r = 0 and then with what helps
thousand() {
    local name=$1 limit how
    shift
    for limit in 12 6; do
        how=(--cold)
        [ "$limit" = 12 ] || how=(--warm --relax 1.5)
        for ((k = 0; k < runs; k++)); do
            { time "$@" |
                nsd-step -m exact -n 1000 --eps 1e-8 "${how[@]}" > "$work/out.h5" 2> /dev/null; } 2>&1
        done > "$work/times"
        awk '{ print $1 }' "$work/times" |
            figure "$name | nsd-step -m exact -n 1000 --eps 1e-8 ${how[*]}" s "$limit"
        awk '{ print $2 + $3 }' "$work/times" | figure "the same" "s of CPU" ""
    done
}

# The paper's 500 balls as nsd-gen lays them, and those on which other codes were measured
whole_runs() {
    local balls=../shared/problems/example3-balls.txt
    thousand "nsd-gen 500" nsd-gen 500
    [ -f "$balls" ] || return 0
    jq --arg file "$PWD/$balls" '.bodies = [{ file: $file }]' scenes/paper/example3.json \
        > "$work/balls.json"
    thousand "nsd-gen example3-balls" nsd-gen "$work/balls.json"
}

# The criterion's share of a run. With the number of sweeps fixed (--eps 0 is never met) a sweep costs
# s + c with the criterion after each and s + c/25 as it comes: that gives s, a sweep with no criterion
# at all. Of a run that stops by the criterion, as many sweeps of s are what is not the criterion's.
criterion() {
    local sweeps each seldom run
    pile -m exact --eps 1e-8
    sweeps=$(sums "$work/log" | awk -v n="$steps" '{ print int($2 / n + 0.5) }')
    for ((k = 0; k < runs; k++)); do
        pile -m exact --eps 0 --max-sweeps "$sweeps" --every-sweep
        each=$(cost)
        pile -m exact --eps 0 --max-sweeps "$sweeps"
        seldom=$(cost)
        pile -m exact --eps 1e-8
        run=$(cost)
        awk -v each="$each" -v seldom="$seldom" -v run="$run" 'BEGIN {
            c = (each - seldom) / (1 - 1 / 25); s = seldom - c / 25
            print 100 * (run - s) / run, c }' >> "$work/share"
    done
    awk '{ print $1 }' "$work/share" | figure "the criterion's share of a run, exact" "%" 10
    awk '{ print $2 }' "$work/share" | figure "one evaluation of the criterion" "ns/contact" ""
}

million() {
    local tool
    for ((k = 0; k < runs; k++)); do
        /usr/bin/time -f '%e %M' -o "$work/nsd-gen" nsd-gen 1000000 |
            /usr/bin/time -f '%e %M' -o "$work/nsd-detect" nsd-detect > "$work/million.h5"
        paste -d ' ' "$work/nsd-gen" "$work/nsd-detect" >> "$work/million"
        rm "$work/million.h5"
    done
    # both started together: the slower is the pipe
    awk '{ print ($1 > $3 ? $1 : $3) }' "$work/million" | figure "1 000 000 balls, gen | detect" s 20
    for tool in gen detect; do
        awk -v gen="$([ $tool = gen ] && echo 1 || echo 0)" '{ print (gen ? $2 : $4) / 1048576 }' \
            "$work/million" | figure "1 000 000 balls, peak memory of nsd-$tool" GiB 1.5
    done
}

: > "$work/rows"
say "a settled pile: 1000 steps of 500 balls"
nsd-gen 500 |
    nsd-step -m exact -n 1000 --every 1000 --eps 1e-8 2> /dev/null |
    nsd-cat --last > "$work/pile.h5"
a_sweep
whole_runs
criterion
million

mkdir -p "$results"
{
    echo "# $(machine); median of $runs"
    printf 'figure\tunit\tat most\tmedian\tleast\tmost\treached\n'
    cat "$work/rows"
} > "$results/figures.tsv"
{
    echo "# Figures"
    echo
    echo "$(machine). One thread; the median of $runs runs, and the least and most."
    echo
    markdown < "$results/figures.tsv"
} > "$results/figures.md"
cat "$results/figures.md"
