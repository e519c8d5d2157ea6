#!/usr/bin/env bash
# the rate grows with the orifice faster than its area, and k is that of rough grains
set -euo pipefail
awk '{ d[NR] = $1; w[NR] = $2 } END { exit !(NR == 3 && w[2] > w[1] && w[3] > w[2] && w[3] / w[1] > (d[3] / d[1])^2) }' rate.tsv
awk '/C =/ { exit !($NF > 1.7 && $NF < 2.9) }' beverloo.tsv
