#!/usr/bin/env bash
# da Cruz et al. 2005: 0.25 + 1.1 I, 0.81 - 0.3 I; a small cell: within 0.08 and 0.03
awk 'function abs(x) { return x < 0 ? -x : x } { if (abs($2 - 0.25 - 1.1 * $1) > 0.08 || abs($3 - 0.81 + 0.3 * $1) > 0.03) bad = 1 } END { exit bad || NR != 2 }' shear.tsv
