#!/usr/bin/env bash
set -euo pipefail
# the size of the instrument: GRAIN=1 SIZE=1 DT=1e-4 LOAD=4.6
grain=${GRAIN:-1.8} size=${SIZE:-0.4} dt=${DT:-4e-4} speed=${SPEED:-0.045} load=${LOAD:-0.8}
read -ra step <<<"${STEP---small-steps 0 --stiffness $(jq -n "600 * $load")}" # options of nsd-step
step() # LOAD ARGUMENT ...: steps under a load, N
{
    local load=$1
    nsd-step "${step[@]}" --wall-loads --every 0.004s --with "jq -cn --unbuffered --argjson load $load -f servo.jq" --with-walls head "${@:2}"
}
jq -n -f scene.jq --argjson grain "$grain" --argjson size "$size" --argjson dt "$dt" --argjson speed "$speed" |
    nsd-gen - >filled.h5
step "$load" --until "${UNTIL:-0.3}" -o preshear.h5 filled.h5
# the stresses on the head, Pa
stresses() { nsd-stat -m wall_loads_by_name "$1" | jq -r --argjson s "$size" '(.wall_loads_by_name.name | index("head")) as $k | (2300e-6 * $s * $s) as $a |
    select(.wall_loads_by_name.span[0]) | [.time, .wall_loads_by_name.force[$k][2] / $a, (.wall_loads_by_name.force[$k][0] | fabs) / $a] | @tsv'; }
stresses preshear.h5 | tail -n 12 | awk '{ s += $2; t += $3 } END { printf "1\t%.0f\t%.0f\t%.0f\n", s / NR, t / NR, s / NR }' >locus.tsv
for part in 0.3 0.5 0.75; do # of the load: the peak of the mean over three frames
    step "$(jq -n "$part * $load")" --until "$(jq -n "${UNTIL:-0.3} + ${SHEAR:-0.05}")" -o "shear-$part.h5" preshear.h5
    stresses "shear-$part.h5" | awk -v p=$part '{ a[NR] = $3; b[NR] = $2 } END {
        for (i = 5; i <= NR; i++) { mean += b[i] / (NR - 4); t = (a[i] + a[i - 1] + a[i - 2]) / 3; if (t > most) { most = t; at = (b[i] + b[i - 1] + b[i - 2]) / 3 } } printf "%s\t%.0f\t%.0f\t%.0f\n", p, at, most, mean }'
done >>locus.tsv
nsd-view -c speed --walls lines preshear.h5 >linear-shear.png
# the yield locus: a line through the three points; the effective angle: that of the preshear
awk '$1 == 1 { print "effective angle\t" atan2($3, $2) * 57.29578 } $1 < 1 { n++; x += $2; y += $3; xx += $2^2; xy += $2 * $3 }
    END { b = (n * xy - x * y) / (n * xx - x * x); print "internal friction angle\t" atan2(b, 1) * 57.29578; print "cohesion, Pa\t" y / n - b * x / n }' locus.tsv | tee angles.tsv
gnuplot -e 'set terminal pngcairo size 700,500; set output "locus.png"; set xlabel "normal stress, Pa"; set ylabel "shear stress, Pa"; set key top left; set xrange [0:]; set yrange [0:];
    set fit quiet logfile "/dev/null"; f(x) = a * x + c; fit f(x) "locus.tsv" every ::1 using 2:3 via a, c;
    plot "locus.tsv" every ::1 using 2:3 pt 7 title "shear to failure", "locus.tsv" every ::0::0 using 2:3 pt 9 title "preshear", f(x) title "yield locus"'
