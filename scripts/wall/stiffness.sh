#!/usr/bin/env bash
# stiffness.sh BALLS=DOCUMENT ...: what a stiffness of contacts does to the solves of piles. A row of tab-separated numbers for
# each pile, compliance and tolerance: balls, contacts, alpha, static overlap (radii), eps, sweeps, Newton steps, CPU s, the
# map reached. alpha is that of --stiffness auto:ALPHA; 0: rigid. Each pile makes STEPS [300] steps with its stiffness first, so
# that it is loaded, rigid ones and those of 32 000 balls and more a tenth of them; the last contacts are solved cold.
set -euo pipefail
work=$(mktemp -d)
steps=${STEPS:-300} # 0.03 s, in which loads come
trap 'rm -rf "$work"' EXIT
for pile in "$@"; do
    balls=${pile%%=*} document=${pile#*=}
    nsd-cat --last "$document" >"$work/pile.h5"
    for alpha in ${ALPHAS:-0 1e-4 1e-3 3e-3 1e-2 3e-2 1e-1}; do
        k=auto:$alpha
        [ "$alpha" != 0 ] || k=rigid
        n=$steps
        [ "$k" != rigid ] && [ "$balls" -lt 32000 ] || n=$((steps / 10))
        nsd-step --stiffness "$k" --dt 1e-4 -n "$n" --every "$n" "$work/pile.h5" 2>/dev/null | nsd-cat --last | nsd-detect >"$work/found.h5"
        deep=$(nsd-info -c "$work/found.h5" | jq -n '[inputs | if .stretch then -.stretch[0] else 0 end] | max / 4.7e-4')
        for eps in 1e-4 1e-6 1e-8; do
            rm -f "$work/log"
            timeout "${SECONDS_MOST:-60}" nsd-solve --cold --criterion natural --tolerance $eps --max-seconds "${SOLVE_SECONDS:-20}" \
                --max-sweeps 1000000 --log "$work/log" "$work/found.h5" >"$work/solved.h5" 2>/dev/null || true
            row=$(jq -r '[.contacts, .sweeps, .newton, .seconds, .natural, .converged] | @tsv' "$work/log" 2>/dev/null || true)
            IFS=$'\t' read -r contacts sweeps newton seconds natural converged <<<"${row:-nan}"
            printf '%s\t%s\t%s\t%s\t%s\t%s\t%s\t%s\t%s\n' "$balls" "$contacts" "$alpha" "$deep" "$eps" \
                "$sweeps" "$newton" "$seconds" "$natural"
            [ "$converged" = true ] || break
        done
    done
done
