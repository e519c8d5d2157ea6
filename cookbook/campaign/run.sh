#!/usr/bin/env bash
set -euo pipefail
one() # MU SEED: a run, if it is not there; its name is given when it is whole
{
    [ ! -e "mu-$1-seed-$2.h5" ] || return 0
    jq --argjson mu "$1" --argjson seed "$2" '.mu = $mu | .seed = $seed' scene.json | nsd-gen - |
        nsd-step --until "${UNTIL:-0.6}" --every 0.6s -o "mu-$1-seed-$2.part" 2>>campaign.log
    mv "mu-$1-seed-$2.part" "mu-$1-seed-$2.h5"
}
export -f one
printf '%s\n' {0,0.1,0.3,0.6}" "{1..6} | xargs -P "${JOBS:-$(nproc)}" -L 1 bash -c 'one "$@"' _
for mu in 0 0.1 0.3 0.6; do
    for run in mu-"$mu"-seed-*.h5; do
        nsd-stat --last -m fraction --box 0.01,0.09,0.01,0.045 "$run"
    done | jq -rs --arg mu "$mu" 'map(.fraction.fraction) | length as $n | (add / $n) as $mean |
        [$mu, $mean, (map((. - $mean) * (. - $mean)) | add / ($n - 1) | sqrt), $n] | @tsv'
done | tee campaign.tsv
