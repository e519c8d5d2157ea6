#!/usr/bin/env bash
set -euo pipefail
nsd-gen scene.json | nsd-step --overlap-rule gap --until 30 --every 30s -o pressed.h5
nsd-info --scene pressed.h5 | jq '.mu = 0.5 | .time = 0 | .bodies[0].at_rest = true |
    .cell = { gradient: [[0, 0], [0, -0.004]], stress: { target: [[1, null], [null, null]], mass: 10 } }' |
    nsd-gen - | nsd-step --overlap-rule gap --until "${UNTIL:-50}" --every 1s --contacts -o biaxial.h5
nsd-stat -m stress biaxial.h5 | jq -r 'select(.stress) | .stress.tensor as $s |
    [.time * 0.004, ($s[1][1] - $s[0][0]) / ($s[1][1] + $s[0][0])] | @tsv' >stress-strain.tsv
gnuplot -e 'set terminal pngcairo size 800,500; set output "stress-strain.png"; set key off;
    set xlabel "axial strain"; set ylabel "sin phi"; plot "stress-strain.tsv" with linespoints pt 7 ps 0.6'
tail -n 5 stress-strain.tsv
