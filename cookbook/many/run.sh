#!/usr/bin/env bash
set -euo pipefail
n=${N:-2000}
nsd-gen "$n" | nsd-step -j "${THREADS:-2}" -n "${STEPS:-400}" --every 0.01s --save 10min --log log.jsonl -o many.h5
nsd-view -c height many.h5 >many.png
jq -rs --argjson n "$n" '[$n, length, (map(.sweeps) | add) / length, (map(.seconds) | add) / length / $n * 1e6] | @tsv' log.jsonl |
    tee cost.tsv
