#!/usr/bin/env bash
# the closed solution, to 0.3 %: the force is that of the beginning of the step
awk 'function abs(x) { return x < 0 ? -x : x } { if (abs($2 / $3 - 1) > 3e-3) bad = 1 } END { exit bad || NR != 10 }' speed.tsv && [ -s sunk.h5 ]
