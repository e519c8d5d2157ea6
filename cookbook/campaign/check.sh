#!/usr/bin/env bash
# 24 runs, and a fraction that falls with mu by more than its error
awk '{ f[NR] = $2; n += $4; e[NR] = $3 / sqrt($4) } END { exit !(NR == 4 && n == 24 && f[1] > 0.81 && f[1] < 0.85 && f[1] - f[4] > 4 * (e[1] + e[4])) }' campaign.tsv
