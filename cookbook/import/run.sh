#!/usr/bin/env bash
set -euo pipefail
weight=$(awk 'BEGIN { print 2500 * 4 / 3 * 3.14159265 * 0.001 ^ 3 * 9.81 }') # N, of a ball of 1 mm radius
for times in 0 100; do
    jq --argjson f "$(jq -n "$times * $weight")" '.cohesion = { force: $f, range: 2e-5 }' scene.json |
        nsd-gen - | nsd-step --until "${UNTIL:-0.3}" --every 0.3s -o "block-$times.h5"
    nsd-view -c height "block-$times.h5" >"block-$times.png"
    nsd-info --last -b "block-$times.h5" | jq -rs --arg n "$times" '[$n, (map(.position[2] + .radius) | max) * 1000] | @tsv'
done | tee height.tsv
