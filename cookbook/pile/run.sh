#!/usr/bin/env bash
set -euo pipefail
for mu_r in 0 4e-4; do
    jq --argjson m "$mu_r" '.rolling = { mu_r: $m }' scene.json | nsd-gen - |
        nsd-step --until "${UNTIL:-1.2}" --every 1.2s -o "pile-$mu_r.h5"
    nsd-view -c height "pile-$mu_r.h5" >"pile-$mu_r.png"
    # the slope: a line through the highest disc of each of ten columns, on either side of the middle
    nsd-info --last -b "pile-$mu_r.h5" | jq -rs --arg m "$mu_r" '
        group_by(.position[0] / 0.006 | floor) | map(max_by(.position[1]).position | [(.[0] | fabs), .[1]]) | map(select(.[0] > 0.01)) |
        (map(.[0]) | add / length) as $x | (map(.[1]) | add / length) as $y |
        (map((.[0] - $x) * (.[1] - $y)) | add) / (map((.[0] - $x) * (.[0] - $x)) | add) |
        [$m, (-. | atan) * 57.2957795] | @tsv'
done | tee slope.tsv
