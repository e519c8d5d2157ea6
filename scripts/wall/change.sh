#!/usr/bin/env bash
# change.sh DOCUMENT: for each compliance alpha, as stiffness.sh has it, the contacts of a pile solved cold to 1e-10 by auto and by
# Gauss-Seidel in a random order. A row each: alpha, both natural maps, the largest difference of a force over the mean normal
# force, the root mean square.
set -euo pipefail
here=$(dirname "$0")
work=$(mktemp -d)
steps=${STEPS:-300} # 0.03 s, in which loads come
trap 'rm -rf "$work"' EXIT
nsd-cat --last "$1" >"$work/pile.h5"
map() { jq -r '.natural' "$work/log"; }
for alpha in ${ALPHAS:-0 1e-4 1e-3 1e-2}; do
    k=auto:$alpha
    [ "$alpha" != 0 ] || k=rigid
    nsd-step --stiffness "$k" --dt 1e-4 -n "$steps" --every "$steps" "$work/pile.h5" 2>/dev/null | nsd-cat --last | nsd-detect >"$work/found.h5"
    row=$alpha
    for way in '--solver auto' '--solver nlgs -m exact --order random'; do
        rm -f "$work/log"
        # shellcheck disable=SC2086 # a way is several words
        nsd-solve --cold $way --criterion natural --tolerance 1e-10 --max-sweeps 100000 --max-seconds "${SOLVE_SECONDS:-15}" --log "$work/log" \
            "$work/found.h5" 2>/dev/null | nsd-info -c >"$work/${way##* }"
        row+=$'\t'$(map)
    done
    printf '%s\t%s\n' "$row" "$("$here/change.py" "$work/auto" "$work/random")"
done
