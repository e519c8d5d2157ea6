#!/usr/bin/env bash
# all balls fall through the funnel, and none beside it: below it they lie in the box
awk '{ n[NR] = $2 } END { exit !(n[1] == 0 && n[NR] == 200) }' below.tsv && [ -s mesh.png ]
