#!/usr/bin/env bash
# The walls carry the mean pressure that was asked for; q/p of balls with mu 0.5 [Thornton 2000; Huang et al. 2014: 0.6 to 0.75 in slow
# shear], more at I = 0.01; dense beads dilate; the volume is constant where nothing yields.
set -euo pipefail
awk '$1 == "mean" { exit !($2 > 0.55 && $2 < 0.9 && $3 > 99 && $3 < 101 && $4 < -0.01) }' result.tsv
awk '$1 == "volume" { exit !($2 < 1e-6 && $2 > -1e-6) }' result.tsv
