#!/usr/bin/env bash
set -euo pipefail
nsd-gen scene.json >start.h5
nsd-step --overlap-rule gap --until "${UNTIL:-0.48}" --every 20 --contacts -o oedometer.h5 start.h5
nsd-view --network oedometer.h5 >oedometer.png
# each stage once its load is constant, from 40 ms on: means
nsd-stat -m strain,stress,fraction,walls start.h5 oedometer.h5 | jq -rs 'def mean: add / length;
    . as $all | [0.08, 0.2, 0.32, 0.44][] as $t | $all | map(select(.time >= $t and .time <= $t + 0.04 and .stress.p)) | select(length > 0) |
    (map(.walls.force[5][2] / 2.5) | mean | fabs) as $lid |
    (map(.fraction.void_ratio) | mean) as $e | (map(.strain.tensor[2][2]) | mean) as $strain |
    (map(.stress.tensor[2][2]) | mean / 1000) as $v | (map((.stress.tensor[0][0] + .stress.tensor[1][1]) / 2) | mean / 1000) as $h |
    [$t, $lid, $v, $h, $h / $v, $strain, $e] | map(. * 1e4 | round / 1e4) | @tsv' | tee oedometer.tsv
