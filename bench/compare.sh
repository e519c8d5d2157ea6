#!/bin/bash
# compare.sh: the results at hand beside the last that were kept of this machine (the repository's), as ratios.
set -euo pipefail
cd "$(dirname "$0")/.."
source bench/common.sh

# file, columns that name a row, column of its median
beside() {
    git show "HEAD:$results/$1" > "$work/kept" 2> /dev/null || return 0
    echo "# $results/$1: now, kept, now/kept"
    awk -F'\t' -v names="$2" -v at="$3" '
        function name(    i, s) { for (i = 1; i <= names; i++) s = s $i "  "; return s }
        /^#/ { next }
        NR == FNR { kept[name()] = $at; next }
        name() in kept && kept[name()] > 0 && $at + 0 == $at {
            printf "%-100s %10s %10s %6.2f\n", name(), $at, kept[name()], $at / kept[name()] }' \
        "$work/kept" "$results/$1"
}
if ! git cat-file -e "HEAD:$results" 2> /dev/null; then
    echo "compare.sh: nothing is kept of this machine ($results), but of" bench/results/*/ >&2
    exit 0
fi
beside figures.tsv 2 4
beside sweeps.tsv 6 7
