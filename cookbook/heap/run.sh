#!/usr/bin/env bash
set -euo pipefail
grain=${GRAIN:-2} dt=${DT:-5e-4} surfaces=${SURFACES:-} # GRAIN=1: the powder itself; SURFACES: the folder of the STL files
read -ra step <<<"${STEP---small-steps 0.03}" # options of nsd-step
jq -n -f scene.jq --argjson grain "$grain" --argjson dt "$dt" --arg surfaces "$surfaces" | nsd-gen - |
    nsd-step "${step[@]}" --until "${UNTIL:-1.3}" --every 0.1s -o heap.h5
nsd-view -c height --solid base heap.h5 >heap.png
# the angle of the triangle with the area A of the silhouette above the base, whose radius is R: tan = A/R^2
for view in x y; do
    nsd-stat --last -m silhouette --view $view --window -0.02,0.02,0,0.03 --pixels 600 heap.h5 |
        jq -r --arg v $view '[$v, .silhouette.area * 1e6, (.silhouette.area / 4e-4 | atan * 57.29578)] | @tsv'
done | tee angle.tsv
