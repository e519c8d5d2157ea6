#!/usr/bin/env bash
# coverage.sh BUILD: branches taken of every folder of lib/, from the counts under BUILD; fails below the
# bounds: io/ 90 %, all 85 %.
set -euo pipefail

gcovr --root . --filter 'lib/' --object-directory "$1" --exclude-throw-branches --csv "$1" |
    awk -F, 'NR > 1 { split($1, path, "/"); total[path[2]] += $5; taken[path[2]] += $6; all += $5; hit += $6 }
        END {
            for (f in total) if (total[f]) printf "%-8s %5d of %5d branches, %.1f %%\n", f, taken[f], total[f], 100 * taken[f] / total[f]
            printf "%-8s %5d of %5d branches, %.1f %%\n", "lib", hit, all, 100 * hit / all
            exit 100 * hit / all < 85 || 100 * taken["io"] / total["io"] < 90
        }'
