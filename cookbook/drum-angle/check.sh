#!/usr/bin/env bash
awk '{ good += $2 > 42 && $2 < 66 && $3 > 0.5 && $3 < 4; angle[NR] = $2 } END { exit !(NR == 2 && good == 2 && angle[2] > angle[1]) }' angle.tsv && [ -s surface.png ]
