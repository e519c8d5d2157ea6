#!/usr/bin/env bash
# with rough walls the large disc rises by more than 8 diameters of small ones, with smooth ones by less than 1
awk '{ a[NR] = $2; b[NR] = $3 } END { exit !(NR == 9 && a[9] - a[1] > 8 && b[9] - b[1] < 1) }' height.tsv
