#!/usr/bin/env bash
set -euo pipefail
# the instrument itself: GRAIN=1 SIZE=1 DT=1e-4 OMEGA=0.1 LOAD=45 SURFACES=FOLDER, where FOLDER has the STL files
# the shear head of a powder rheometer, in its vessel of 50 mm: CELL=ft4 SIZE=1 GRAIN=2.8 OMEGA=1.5 LOAD=4; DT=1e-4 GRAIN=1 for the powder
grain=${GRAIN:-1.8} size=${SIZE:-0.2} dt=${DT:-4e-4} omega=${OMEGA:-3} load=${LOAD:-1.8} surfaces=${SURFACES:-} name=${CELL:-schulze}
read -ra step <<<"${STEP---small-steps 0 --stiffness $(jq -n "300 * $load")}" # options of nsd-step
cell=$(jq -nc --arg n "$name" '{ schulze: { box: "Schulze-Normal/box.stl", head: "Schulze-Normal/head_full.stl", inner: 50, outer: 100, deep: 40, from: 51, to: 99, vanes: 20 },
    ft4: { box: "FT4/box.stl", head: "FT4/shear_head.stl", inner: 0, outer: 25, deep: 20, from: 0.5, to: 24, vanes: 18 } }[$n]')
# the head: a ring with vanes of 4 mm
jq -r '[.from, .to, .vanes] | @tsv' <<<"$cell" | awk '{ n = $3; m = 3 * n; for (i = 0; i < m; i++) { a = 6.28318530718 * i / m; for (k = 1; k <= 2; k++) for (z = 0; z > -5; z -= 4) print "v", $k * cos(a), $k * sin(a), z }
    for (i = 0; i < m; i++) { a = 4 * i; b = 4 * ((i + 1) % m); print "f", a + 1, b + 1, b + 3, a + 3; if (i % 3 == 0) print "f", a + 1, a + 3, a + 4, a + 2 } }' >head.obj
step() # LOAD ARGUMENT ...: steps under a load, N
{
    local load=$1
    nsd-step "${step[@]}" --wall-loads --every 0.004s --with "jq -cn --unbuffered --argjson load $load -f servo.jq" --with-walls head "${@:2}"
}
jq -n -f scene.jq --argjson grain "$grain" --argjson size "$size" --argjson dt "$dt" --argjson omega "$omega" --arg surfaces "$surfaces" --argjson cell "$cell" |
    nsd-gen - >filled.h5
step "$load" --until "${UNTIL:-0.3}" -o preshear.h5 filled.h5
# the stresses on the head, Pa, by its area and its lever
stresses() { nsd-stat -m wall_loads_by_name "$1" | jq -r --argjson s "$size" --argjson c "$cell" '(.wall_loads_by_name.name | index("head")) as $k | ($c.from * $s / 1000) as $r | ($c.to * $s / 1000) as $q |
    (3.14159265 * ($q * $q - $r * $r)) as $a | (2 / 3 * ($q * $q * $q - $r * $r * $r) / ($q * $q - $r * $r)) as $lever |
    select(.wall_loads_by_name.span[0]) | [.time, .wall_loads_by_name.force[$k][2] / $a, (.wall_loads_by_name.torque[$k][2] | fabs) / ($lever * $a)] | @tsv'; }
stresses preshear.h5 | tail -n 12 | awk '{ s += $2; t += $3 } END { printf "1\t%.0f\t%.0f\n", s / NR, t / NR }' >locus.tsv
for part in 0.3 0.5 0.75; do # of the load: the peak of the mean over three frames
    step "$(jq -n "$part * $load")" --until "$(jq -n "${UNTIL:-0.3} + ${SHEAR:-0.05}")" -o "shear-$part.h5" preshear.h5
    stresses "shear-$part.h5" | awk -v p=$part '{ a[NR] = $3; b[NR] = $2 } END {
        for (i = 5; i <= NR; i++) { t = (a[i] + a[i - 1] + a[i - 2]) / 3; if (t > most) { most = t; at = (b[i] + b[i - 1] + b[i - 2]) / 3 } } printf "%s\t%.0f\t%.0f\n", p, at, most }'
done >>locus.tsv
nsd-view -c speed --solid head --walls lines preshear.h5 >ring-shear.png
# the yield locus: a line through the three points; the effective angle: that of the preshear
awk '$1 == 1 { print "effective angle\t" atan2($3, $2) * 57.29578 } $1 < 1 { n++; x += $2; y += $3; xx += $2^2; xy += $2 * $3 }
    END { b = (n * xy - x * y) / (n * xx - x * x); print "internal friction angle\t" atan2(b, 1) * 57.29578; print "cohesion, Pa\t" y / n - b * x / n }' locus.tsv | tee angles.tsv
gnuplot -e 'set terminal pngcairo size 700,500; set output "locus.png"; set xlabel "normal stress, Pa"; set ylabel "shear stress, Pa"; set key top left; set xrange [0:]; set yrange [0:];
    set fit quiet logfile "/dev/null"; f(x) = a * x + c; fit f(x) "locus.tsv" every ::1 using 2:3 via a, c;
    plot "locus.tsv" every ::1 using 2:3 pt 7 title "shear to failure", "locus.tsv" every ::0::0 using 2:3 pt 9 title "preshear", f(x) title "yield locus"'
