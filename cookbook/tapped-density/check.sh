#!/usr/bin/env bash
# the powder becomes denser; the ratio lies between 1 and that of dense to loose random packings
awk -F '\t' '/loose/ { a = $2 + 0 } /Hausner/ { r = $2 } END { exit !(a > 740 && a < 860 && r > 1.05 && r < 1.13) }' hausner.tsv &&
    awk '{ up += NR > 1 && $2 > last; last = $2 } END { exit !(NR >= 16 && up >= 0.8 * (NR - 1)) }' density.tsv && [ -s packing.png ]
