#!/usr/bin/env bash
# the stress at a peak is near its load; the servo keeps the mean loads to 10 %; angles and cohesion as about has them
set -euo pipefail
awk '$1 == 1 { s = $4 } { if ($2 / s / $1 < 0.75 || $2 / s / $1 > 1.4) bad = 1 } { if ($4 / s / $1 < 0.9 || $4 / s / $1 > 1.1) bad = 1 } END { exit bad || NR != 4 }' locus.tsv
awk -F '\t' '/effective/ { e = $2 } /internal/ { i = $2 } /cohesion/ { c = $2 } END { exit !(e > 24 && e < 42 && i > 22 && i < 45 && c > -250 && c < 250) }' angles.tsv
