#!/usr/bin/env bash
set -euo pipefail
nsd-gen scene.json | nsd-step --overlap-rule gap --until "${UNTIL:-0.15}" --every 8 --contacts -o load.h5
# the lid held where it is: no load, the same velocity along x
nsd-info --last -w load.h5 | jq -s '.[1].point[1]' >height
nsd-info --scene load.h5 | jq --argjson h "$(cat height)" '.walls[1] = { point: [0, $h], normal: [0, -1], velocity: [0.2, 0] }' |
    nsd-gen - | nsd-step --overlap-rule gap -n 1500 --every 40 --contacts -o volume.h5
nsd-view --network load.h5 >shear-cell.png
for n in load volume; do
    nsd-stat -m walls,fraction $n.h5 | jq -rs --arg n $n 'def mean: add / length; .[length / 2 | floor:] |
        (map(.walls.force[1][0] / 0.05e3) | mean | fabs) as $tau | (map(.walls.force[1][1] / 0.05e3) | mean | fabs) as $sigma |
        [$n, $tau, $sigma, $tau / $sigma, (map(.fraction.fraction) | mean)] | map(if type == "number" then . * 1e4 | round / 1e4 else . end) | @tsv'
done | tee shear.tsv
