#!/usr/bin/env bash
# the mean slope after 0.5 s, degrees; a picture
awk '$1 > 0.5 { s += $2; n++ } END { print "degrees:", s / n; exit !(n > 10 && s / n > 20 && s / n < 28) }' angle.tsv && [ -s angle.png ]
