#!/usr/bin/env bash
awk '{ high[$1] = $2 } END { exit !(high[0] < 5 && high[100] > 13 && high[100] < 21) }' height.tsv
