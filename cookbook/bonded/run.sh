#!/usr/bin/env bash
set -euo pipefail
nsd-gen scene.json | nsd-step --small-steps 0.0025 --until "${UNTIL:-0.36}" --every 0.04s --contacts -o pillar.h5
nsd-view --bonds pillar.h5 >pillar.png
nsd-info pillar.h5 | jq -r 'select(.step != null) | [.step, .time, .balance.bond_energy] | @tsv' |
    while read -r step time energy; do
        echo "$time $(nsd-info -s "$step" -c pillar.h5 | jq -s 'map(select(.beta > 0)) | length') $energy"
    done | tee bonds.txt
