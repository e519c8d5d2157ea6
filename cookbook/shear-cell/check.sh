#!/usr/bin/env bash
# Equilibrium of the lid: the normal stress is the load, to 4 %. The ratio is no more than the walls' friction, and that of discs in
# simple shear [da Cruz et al. 2005] as far as slip at flat walls leaves it.
set -euo pipefail
awk '$1 == "load" { good += $3 > 0.96 && $3 < 1.04 && $4 > 0.15 && $4 < 0.6 && $5 > 0.72 && $5 < 0.86 } $1 == "volume" { good += $3 > 0.05 && $4 > 0.1 && $4 < 0.7 }
    END { exit good != 2 }' shear.tsv
