#!/usr/bin/env bash
awk '{ v[$1] = $2 } END { exit !(v[10] < 0.01 && v[10] > -0.01 && v[35] > 0.1) }' speed.tsv
