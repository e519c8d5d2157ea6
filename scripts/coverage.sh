#!/usr/bin/env bash
# coverage.sh BUILD: branches that were taken, of every folder of lib/, from the counts under BUILD; and
# the files that miss most. Fails below the bounds: lib/file 90 %, all of lib/ 85 %.
set -euo pipefail

# Branches in lines that the compiler made by itself are nobody's.
gcovr --root . --filter 'lib/' --object-directory "$1" --exclude-unreachable-branches \
    --csv "$1/coverage.csv" "$1"
awk -F, 'NR > 1 { printf "%4d of %4d branches are not taken in %s\n", $5 - $6, $5, $1 }' "$1/coverage.csv" |
    sort -rn |
    sed -n "1,${LOWEST-12}p" # head would stop reading, and sort fail
awk -F, '
    NR > 1 { split($1, path, "/"); total[path[2]] += $5; taken[path[2]] += $6; all += $5; hit += $6 }
    function line(name, taken, total) { printf "%-8s %5d of %5d branches, %.1f %%\n", name, taken, total, 100 * taken / total }
    END {
        if (!all || !total["file"]) { print "no counts" > "/dev/stderr"; exit 2 }
        for (f in total) if (total[f]) line(f, taken[f], total[f])
        line("lib", hit, all)
        exit 100 * hit / all < 85 || 100 * taken["file"] / total["file"] < 90
    }' "$1/coverage.csv"
