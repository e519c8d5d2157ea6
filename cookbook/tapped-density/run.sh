#!/usr/bin/env bash
set -euo pipefail
# the powder itself: GRAIN=1 DT=3e-4 TAPS=500 SURFACES=FOLDER, where FOLDER has the STL files
grain=${GRAIN:-2.4} dt=${DT:-5e-4} taps=${TAPS:-15} surfaces=${SURFACES:-} period=0.08 # s, from tap to tap
read -ra step <<<"${STEP---small-steps 0.03}" # options of nsd-step
jq -n -f scene.jq --argjson grain "$grain" --argjson dt "$dt" --argjson taps "$taps" --argjson period $period --arg surfaces "$surfaces" |
    nsd-gen - | nsd-step "${step[@]}" --until "$(jq -n "0.2 + $taps * $period + 0.04")" --every 0.04s -o taps.h5
# 0.04 s after each tap: the mass over that of the tube up to twice the height of the centre of mass, which is the height of a column
mass=$(nsd-info -b --last taps.h5 | jq -s 'map(.mass) | add')
nsd-stat -m energy taps.h5 | jq -rs --argjson m "$mass" --argjson p $period 'map(.k = (.time - 0.24) / $p) |
    map(select(.k > -0.01 and (.k - (.k | round) | fabs) < 0.01)) | .[] | (.energy.potential / ($m * 9.81)) as $z |
    [(.k | round), $m / (3.14159265 * 0.013 * 0.013 * 2 * $z)] | @tsv' >density.tsv
nsd-view -c height taps.h5 >tube.png
gnuplot -e 'set terminal pngcairo size 700,450; set output "packing.png"; set xlabel "taps"; set ylabel "bulk density, kg/m3"; set key bottom right;
    r0 = 850; r1 = 950; tau = 5; set fit quiet logfile "/dev/null"; r(n) = r1 - (r1 - r0)/(1 + log(1 + n/abs(tau))); fit r(x) "density.tsv" via r0, r1, tau;
    plot "density.tsv" pt 7 title "after each tap", r(x) lw 2 title "r1 - (r1 - r0)/(1 + ln(1 + n/tau))"'
awk 'NR == 1 { a = $2 } { b = $2; n = $1 } END { printf "loose\t%.0f kg/m3\nafter %d taps\t%.0f kg/m3\nHausner ratio\t%.3f\n", a, n, b, b / a }' density.tsv | tee hausner.tsv
