#!/usr/bin/env bash
set -euo pipefail
nsd-gen scene.json | nsd-step --until "${UNTIL:-1.2}" --every 0.02s -o drum.h5
nsd-stat -m surface drum.h5 | jq -r '[.time, .surface.angle] | @tsv' >angle.tsv
nsd-view -c speed drum.h5 >drum.png
gnuplot -e 'set terminal pngcairo size 800,500; set output "angle.png"; set key off;
    set xlabel "time, s"; set ylabel "slope of the surface, degrees"; set yrange [0:40];
    plot "angle.tsv" with linespoints pt 7 ps 0.6'
tail -n 5 angle.tsv
