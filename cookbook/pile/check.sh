#!/usr/bin/env bash
awk '{ s[NR] = $2 } END { exit !(NR == 2 && s[1] > 6 && s[1] < 20 && s[2] > s[1] + 10 && s[2] < 45) }' slope.tsv
