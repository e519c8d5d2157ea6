#!/usr/bin/env bash
# grains leave, from the gate's end on at a rate; the cone wears most, by its coefficient; a picture
awk '{ t[NR] = $1; n[NR] = $2 } END { exit !(n[1] == 0 && n[NR] > 200) }' out.tsv &&
    awk '$1 == "cone" { r = $4; w = $5 } $1 == "cylinder" { c = $4 } END { exit !(r > c && c > 0 && w > 0.999e-13 * r && w < 1.001e-13 * r) }' wear.tsv &&
    [ -s hopper.png ]
