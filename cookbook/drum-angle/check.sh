#!/usr/bin/env bash
awk '{ good += $2 > 38 && $2 < 65 && $3 > 0.5 && $3 < 6 } END { exit !(NR == 2 && good == 2) }' angle.tsv && [ -s surface.png ]
