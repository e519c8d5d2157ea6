#!/usr/bin/env bash
set -euo pipefail
nsd-gen scene.json | nsd-step --overlap-rule gap --until 0.01 --every 0.01s -o start.h5
test() # NAME CELL: friction, and what the cell then does; z becomes shorter at 30 per s
{
    nsd-info --scene start.h5 | jq --argjson cell "$2" '.mu = 0.5 | .dt = 7e-6 | .bodies[0].at_rest = true | .cell = $cell' |
        nsd-gen - >"$1-start.h5"
    nsd-step --overlap-rule gap -n "${STEPS:-1500}" --every 25 --contacts -o "$1.h5" "$1-start.h5"
    nsd-stat -m strain,stress,fraction,coordination,fabric "$1-start.h5" "$1.h5" | jq -r 'select(.stress.p) |
        [.strain.tensor[2][2], .strain.volumetric, .stress.q, .stress.p, .fraction.fraction, .fraction.void_ratio,
        .coordination.z_mechanical, .fabric.anisotropy] | @tsv' >"$1.tsv"
}
test confined '{"gradient": [[0, 0, 0], [0, 0, 0], [0, 0, -30]], "stress": {"target": [[1e5, null, null], [null, 1e5, null], [null, null, null]]}}'
test mean '{"gradient": [[15, 0, 0], [0, 15, 0], [0, 0, -30]], "stress": {"mean": 1e5}}'
nsd-view --network mean.h5 >triaxial-cell.png
gnuplot -e 'set terminal pngcairo size 1000,450; set output "triaxial.png"; set multiplot layout 1,2; set xlabel "axial strain"; set key bottom right;
    set ylabel "q/p"; set yrange [0:1.2]; plot for [n in "confined mean"] n.".tsv" using 1:(column(3)/column(4)) with lines lw 2 title n;
    set ylabel "solid fraction"; set yrange [0.54:0.68]; plot for [n in "confined mean"] n.".tsv" using 1:5 with lines lw 2 notitle'
for n in confined mean; do # mean q/p, p (kPa) and fraction of the second half
    awk -v name=$n '{ q[NR] = $3; p[NR] = $4; f[NR] = $5 } END { for (k = int(NR / 2) + 1; k <= NR; k++) { n++; s += q[k]; r += p[k]; t += f[k] }
        printf "%s\t%.3f\t%.1f\t%.4f\n", name, s / r, r / n / 1e3, t / n }' $n.tsv
done | tee critical.tsv
