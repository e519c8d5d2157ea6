#!/usr/bin/env bash
# mass.tsv: time, s, and mass, g: the rate is 6 to 8 g/s, and the same early and late
awk '{ t[NR] = $1; m[NR] = $2 } END {
    h = int((NR + 1) / 2); early = (m[h] - m[1]) / (t[h] - t[1]); late = (m[NR] - m[h]) / (t[NR] - t[h])
    print "g/s:", early, late; exit !(NR >= 4 && early > 6 && early < 9 && late / early > 0.75 && late / early < 1.3) }' mass.tsv
