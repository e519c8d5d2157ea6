#!/usr/bin/env bash
# The lid carries its load, to 5 %, in the mean of the shear; tau/sigma lies below the friction of grains interlocked, above that of
# smooth discs, and its peak above its mean.
set -euo pipefail
awk '{ s += $3; n++ } END { m = s / n; m = m < 0 ? -m : m; exit !(n > 20 && m > 0.95 && m < 1.05) }' shear.tsv
awk '{ good = $1 > $2 && $2 > 0.2 && $2 < 0.9 } END { exit !(good && NR == 1) }' ratio.tsv
