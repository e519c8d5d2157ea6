#!/usr/bin/env bash
set -euo pipefail
# the powder itself: GRAIN=1 DT=3e-4 SPEEDS="10 15 20 30 45" UNTIL=3 SURFACES=FOLDER, where FOLDER has the STL files
grain=${GRAIN:-2.8} dt=${DT:-5e-4} surfaces=${SURFACES:-}
read -ra step <<<"${STEP---small-steps 0.03}" # options of nsd-step
for rpm in ${SPEEDS:-15 45}; do
    jq -n -f scene.jq --argjson grain "$grain" --argjson dt "$dt" --argjson rpm "$rpm" --arg surfaces "$surfaces" | nsd-gen - |
        nsd-step "${step[@]}" --until "${UNTIL:-1}" --every 0.02s -o "drum-$rpm.h5"
    # in columns of 4 mm, frames from 0.5 s on: the mean height of the highest grain and its standard deviation
    nsd-info -b -s "$(jq -n "0.5 / $dt | ceil")": "drum-$rpm.h5" | jq -r '[.step, (.position[0] / 0.004 | floor), .position[2] + .radius] | @tsv' |
        awk -v rpm="$rpm" '{ k = $1 "\t" $2; if (!(k in h) || $3 > h[k]) h[k] = $3 }
        END { for (k in h) { split(k, a, "\t"); s[a[2]] += h[k]; q[a[2]] += h[k]^2; n[a[2]]++ }
              for (x in s) if (x >= -8 && x < 8) { m = s[x] / n[x]; print rpm "\t" (x + 0.5) * 4 "\t" m * 1000 "\t" 1000 * sqrt((q[x] / n[x] - m * m > 0) ? q[x] / n[x] - m * m : 0) } }' | sort -k2g >"surface-$rpm.tsv"
    # the angle in the middle fifth of the drum; the cohesive index: the mean of the standard deviations, mm
    awk '{ c += $4; n++ } $2 > -9 && $2 < 9 { k++; x += $2; y += $3; xx += $2^2; xy += $2 * $3 }
        END { t = (k * xy - x * y) / (k * xx - x * x); printf "%d\t%.1f\t%.2f\n", $1, atan2(t < 0 ? -t : t, 1) * 57.29578, c / n }' "surface-$rpm.tsv"
done | tee angle.tsv
gnuplot -e 'set terminal pngcairo size 700,600; set output "surface.png"; set xlabel "x, mm"; set ylabel "z, mm"; set size ratio -1; set key top center;
    plot for [f in system("ls surface-*.tsv")] f using 2:3:4 with yerrorlines title f'
