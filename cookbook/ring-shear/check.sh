#!/usr/bin/env bash
# the servo keeps the loads to 20 %; angles and cohesion as about has them
set -euo pipefail
awk '$1 == 1 { s = $2 } { if ($2 / s / $1 < 0.8 || $2 / s / $1 > 1.25) bad = 1 } END { exit bad || NR != 4 }' locus.tsv
awk -F '\t' '/effective/ { e = $2 } /internal/ { i = $2 } /cohesion/ { c = $2 } END { exit !(e > 28 && e < 46 && i > 25 && i < 48 && c > -150 && c < 250) }' angles.tsv
