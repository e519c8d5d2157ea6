#!/usr/bin/env bash
awk '{ whole[NR] = $2 } END { exit !(NR > 5 && whole[1] == 303 && whole[NR] < 300 && whole[NR] > 200) }' bonds.txt && [ -s pillar.png ]
