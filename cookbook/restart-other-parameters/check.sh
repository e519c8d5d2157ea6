#!/usr/bin/env bash
# Below the angle of repose of discs, some 20 degrees, the bed stays; above it flows, the farther the less friction there is.
set -euo pipefail
awk '{ d[NR] = $3 } END { exit !(NR == 3 && d[1] < 2.5 && d[2] > 4 * d[1] && d[3] > d[2]) }' tilted.tsv
