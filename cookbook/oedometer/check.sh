#!/usr/bin/env bash
# The lid is in equilibrium: its mean force is the load, to 1 %; the beads' vertical stress is that less wall friction, or more by their
# weight; the horizontal one lies between Rankine's active and passive limits at 35 degrees; strain is not given back.
set -euo pipefail
awk 'BEGIN { split("1 2 4 2", load, " ") } { bad += !($2 / load[NR] > 0.99 && $2 / load[NR] < 1.01 && $3 < 1.35 * $2 && $3 > 0.7 * $2 && $5 > 0.27 && $5 < 3.7); e[NR] = $7 }
    END { exit !(NR == 4 && !bad && e[1] >= e[2] && e[2] > e[3] && e[4] < e[1] + 1e-4) }' oedometer.tsv
