#!/usr/bin/env bash
set -euo pipefail
steps=${STEPS:-1500}
nsd-gen scene.json | nsd-step --overlap-rule gap --until 0.01 --every 0.01s -o start.h5
test() # NAME FROM CHANGE: what the servo then does; z becomes shorter at 30 per s
{
    nsd-info --scene "$2.h5" | jq ".bodies[0].at_rest = true | .servo.strain_rate = [15, 15, -30] | $3" | nsd-gen - >"$1-start.h5"
    nsd-step --overlap-rule gap -n "$4" --every 25 --wall-loads -o "$1.h5" "$1-start.h5"
    # a row for each frame: axial and volumetric strain, pressures of the lid and the sides, mean of all by their distances
    paste <(nsd-stat -m strain "$1-start.h5" "$1.h5" | jq -r 'select(.step > '"$(nsd-info "$1-start.h5" | jq 'select(.step != null) | .step')"') | [.strain.tensor[2][2], .strain.volumetric] | @tsv') \
        <(nsd-stat -m wall_loads "$1.h5" 2>/dev/null | jq -c '.wall_loads.normal') \
        <(nsd-info -w "$1.h5" | jq -s -c '[_nwise(6)][] | [map(.load.face), map(.load.lever)]') |
        jq -R -r 'split("\t") | (.[2] | fromjson) as $f | (.[3] | fromjson) as [$a, $l] | [range(6) | $f[.] / $a[.]] as $p |
            [.[0], .[1], ($p[4] + $p[5]) / 2, ($p[0] + $p[1] + $p[2] + $p[3]) / 4, ([range(6) | $f[.] * $l[.]] | add) / ([range(6) | $a[.] * $l[.]] | add)] | @tsv' >"$1.tsv"
}
test mean start '.mu = 0.5 | .pairs = [{ pair: ["ball", "wall"], mu: 0 }] | .servo.pressure = 1e5' "$steps"
test volume mean 'del(.servo.pressure) | .servo.growth = 0' $((steps / 6))
gnuplot -e 'set terminal pngcairo size 1000,450; set output "triaxial-walls.png"; set multiplot layout 1,2; set xlabel "axial strain";
    set ylabel "pressure (kPa)"; set yrange [0:300]; plot "mean.tsv" using 1:(column(3)/1e3) with lines lw 2 title "lid and floor", "" using 1:(column(4)/1e3) with lines lw 2 title "sides",
    "" using 1:(column(5)/1e3) with lines lw 2 title "mean"; set ylabel "volumetric strain"; set autoscale y; plot for [n in "mean volume"] n.".tsv" using 1:2 with lines lw 2 title n'
awk '{ z[NR] = $3; x[NR] = $4; p[NR] = $5; v = $2 } END { for (k = int(NR / 2) + 1; k <= NR; k++) { n++; q += z[k] - x[k]; s += p[k] }
    printf "mean\t%.3f\t%.2f\t%.4f\n", q / s, s / n / 1e3, v }' mean.tsv | tee result.tsv
awk 'END { printf "volume\t%.1e\n", $2 }' volume.tsv | tee -a result.tsv
