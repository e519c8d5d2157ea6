#!/usr/bin/env bash
set -euo pipefail
nsd-gen scene.json | nsd-step --contacts --until "${UNTIL:-0.5}" --every 0.01s -o pour.h5
nsd-stat -m energy,temperature,coordination pour.h5 >stat.jsonl
nsd-web --stat stat.jsonl -o page.html pour.h5
nsd-view -c material --size 480x560 pour.h5 >pour.png
sed -n 's/.*id="meta">\(.*\)<\/script>/\1/p' page.html | jq -r '.curves | to_entries[] | [.key, .value.unit] | @tsv' | tee curves.tsv
