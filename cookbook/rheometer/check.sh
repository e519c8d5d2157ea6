#!/usr/bin/env bash
# nothing before the blade touches the powder, then work that grows faster than the depth
awk '{ d[NR] = $1; w[NR] = $4 } END { half = 0; for (i = 1; i <= NR; i++) if (d[i] <= 0.75 * d[NR]) half = w[i]
    exit !(w[1] == 0 && w[NR] > 80 && w[NR] < 260 && half > 0 && half < 0.6 * w[NR]) }' energy.tsv && [ -s rheometer.png ]
