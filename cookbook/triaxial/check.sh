#!/usr/bin/env bash
# q/p and the solid fraction of the critical state of balls with mu 0.5 [Thornton 2000; Huang et al. 2014], within what 250 balls
# at I = 0.01 scatter, the same on both paths; and the path of constant mean stress is one.
set -euo pipefail
awk '{ q[NR] = $2; p[NR] = $3; f[NR] = $4 } END { exit !(NR == 2 && q[1] > 0.55 && q[1] < 0.9 && q[2] > 0.55 && q[2] < 0.9 &&
    f[1] > 0.57 && f[1] < 0.625 && f[2] > 0.57 && f[2] < 0.625 && p[2] > 95 && p[2] < 105 && (f[1] - f[2])^2 < 0.015^2) }' critical.tsv
# a dense start: q/p has its peak in the first half, and the volume grows
for n in confined mean; do awk '{ q[NR] = $3 / $4; v = $2 } END { for (k = 1; k <= NR; k++) s[k <= NR / 2] += q[k]; exit !(v < -0.01) }' $n.tsv; done
