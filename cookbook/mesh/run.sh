#!/usr/bin/env bash
set -euo pipefail
nsd-gen scene.json | nsd-step --until "${UNTIL:-0.6}" --every 0.05s -o mesh.h5
nsd-view -c height --walls lines mesh.h5 >mesh.png
nsd-info -b mesh.h5 | jq -rs 'group_by(.step)[] | [.[0].step * 5e-4, (map(select(.position[2] < 0.04)) | length)] | @tsv' | tee below.tsv
