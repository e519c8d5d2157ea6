#!/usr/bin/env bash
set -euo pipefail
cp scene.json dry.json
jq '.capillary = { volume: 1e-10, tension: 0.072, wetting: 0.2 }' scene.json >wet.json
for name in dry wet; do
    nsd-gen "$name.json" | nsd-step --until "${UNTIL:-0.35}" --every 0.05s -o "$name.h5"
    nsd-view --bonds "$name.h5" >"$name.png"
    nsd-info --last -b "$name.h5" | jq -rs --arg name "$name" '(map(.position[0]) | sort) as $x |
        [$name, ($x[length * 0.9 | floor] - 0.02) * 1000, (map(.position[1]) | max) * 1000] | @tsv'
done | tee runout.tsv
