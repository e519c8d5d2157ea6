#!/usr/bin/env bash
# both views agree to 15 %, in the range of about; a picture
awk '{ a[NR] = $3 } END { exit !(NR == 2 && a[1] > 40 && a[1] < 60 && a[2] / a[1] > 0.85 && a[2] / a[1] < 1.18) }' angle.tsv && [ -s heap.png ]
