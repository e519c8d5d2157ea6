#!/usr/bin/env bash
set -euo pipefail
nsd-gen scene.json >start.h5
nsd-step --small-steps 0 --until "${UNTIL:-1}" --every 0.05s -o mill.h5 start.h5
nsd-view --colour generation mill.h5 >mill.png
# time (s), sizes that 10, 50 and 90 % of the mass is smaller than (mm), fraction of the grains that have broken, grains, dust (g)
nsd-stat --only ore -m breakage mill.h5 | jq -r '.breakage as $b |
    [.time, 1e3 * $b.d10, 1e3 * $b.d50, 1e3 * $b.d90, $b.broken, $b.bodies, 1e3 * $b.dust] | map(. * 1e3 | round / 1e3) | @tsv' |
    tee mill.tsv
