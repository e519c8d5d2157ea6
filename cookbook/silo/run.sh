#!/usr/bin/env bash
set -euo pipefail
nsd-gen scene.json | nsd-step --until "${UNTIL:-0.4}" --every 0.02s -o silo.h5
nsd-view -c speed --clip 0,1,0,0 --walls lines silo.h5 >silo.png
nsd-info --events silo.h5 | jq -rs 'map(select(.event == "removed")) |
    [foreach .[] as $e ([0, 0]; [.[0] + 1, .[1] + $e.mass * 1000]; [$e.time] + .)] |
    .[] | select(.[1] % 50 == 0) | [.[0], .[2]] | @tsv' | tee mass.tsv
