#!/usr/bin/env bash
set -euo pipefail
nsd-gen scene.json | nsd-step --overlap-rule gap --until "${UNTIL:-0.18}" --every 20 --contacts -o shear.h5
nsd-view --network shear.h5 >direct-shear.png
# the upper half and the lid: horizontal force over vertical load, displacement in mm, height of the lid in mm
nsd-stat -m walls shear.h5 | jq -r '[(.time - 0.1) * 50, ([.walls.force[1:4][][0]] | add | fabs) / 50, .walls.force[3][1] / 50] |
    select(.[0] >= 0) | @tsv' |
    awk '{ r[NR] = $2; n = NR < 25 ? NR : 25; s = 0; for (k = 0; k < n; k++) s += r[NR - k]; print $1, $2, $3, s / n }' >shear.tsv
gnuplot -e 'set terminal pngcairo size 800,450; set output "shear.png"; set xlabel "displacement, mm"; set ylabel "tau/sigma"; set key top right;
    set yrange [0:1.6]; plot "shear.tsv" using 1:2 with lines lc rgb "gray70" title "each frame", "" using 1:4 with lines lw 2 title "mean over 0.5 mm"'
rise=$(nsd-info -w shear.h5 | jq -rs 'map(select(.load)) | map(.point[1] * 1000) | .[-1] - .[length / 2 | floor]')
awk -v rise="$rise" '{ m[NR] = $4; r[NR] = $2 } END { for (k = 25; k <= NR; k++) { if (m[k] > peak) peak = m[k]; if (k > 2 * NR / 3) { s += r[k]; n++ } }
    printf "%.3f\t%.3f\t%.3f\n", peak, s / n, rise }' shear.tsv | tee ratio.tsv
