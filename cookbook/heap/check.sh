#!/usr/bin/env bash
# both views agree to 15 %, in the range of about; a picture
awk '{ a[NR] = $3 } END { exit !(NR == 2 && a[1] > 42 && a[1] < 51 && a[2] / a[1] > 0.85 && a[2] / a[1] < 1.18) }' angle.tsv && [ -s heap.png ]
