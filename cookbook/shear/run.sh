#!/usr/bin/env bash
set -euo pipefail
for rate in 0.05 0.2; do
    jq --argjson g "$rate" '.cell.gradient[0][1] = $g' scene.json | nsd-gen - |
        nsd-step --dt 0.02 --until "$(jq -n "${STRAIN:-4} / $rate")" --every "$(jq -n "0.1 / $rate")s" --contacts -o "shear-$rate.h5"
    # the mean over the second half of the strain
    nsd-stat -m stress,fraction "shear-$rate.h5" | jq -rs --argjson I "$rate" 'map(select(.stress)) | .[length / 2 | floor:] |
        [$I, ((map(.stress.tensor[0][1]) | add) / (map(.stress.tensor[1][1]) | add) | fabs), (map(.fraction.fraction) | add / length)] | @tsv'
done | tee shear.tsv
