#!/usr/bin/env bash
set -euo pipefail
nsd-gen scene.json | nsd-step --overlap gap --until "${UNTIL:-0.18}" --every 50 --contacts -o shear.h5
nsd-view --network shear.h5 >direct-shear.png
# the upper half and the lid: horizontal force over vertical load, displacement in mm, height of the lid in mm
nsd-stat -m boundaries shear.h5 | jq -r '[(.time - 0.1) * 50, ([.boundaries.force[1:4][][0]] | add | fabs) / 50, .boundaries.force[3][1] / 50] |
    select(.[0] >= 0) | @tsv' >shear.tsv
gnuplot -e 'set terminal pngcairo size 800,450; set output "shear.png"; set xlabel "displacement, mm"; set ylabel "tau/sigma"; set key off;
    set yrange [0:1.2]; plot "shear.tsv" using 1:2 with lines lw 2'
rise=$(nsd-info -w shear.h5 | jq -rs 'map(select(.load)) | map(.point[1] * 1000) | .[-1] - .[length / 2 | floor]')
awk -v rise="$rise" '{ r[NR] = $2 } END { for (k = 1; k <= NR; k++) { if (k > 4 && (m = (r[k] + r[k-1] + r[k-2] + r[k-3] + r[k-4]) / 5) > peak) peak = m
    if (k > 2 * NR / 3) { s += r[k]; n++ } } printf "%.3f\t%.3f\t%.3f\n", peak, s / n, rise }' shear.tsv | tee ratio.tsv
