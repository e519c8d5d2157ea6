set multiplot layout 1,2
set xlabel "inertial number I = rate sqrt(m/P)"
set ylabel "shear stress / pressure"
set xrange [0:*]; set yrange [0:*]
plot dir . "/shear.tsv" using 1:2 skip 1 with points ls 1 title "nsd", 0.25 + 1.1*x with lines ls 9 title "da Cruz et al.: 0.25 + 1.1 I"
set key right top noreverse Right
set ylabel "solid fraction"
set yrange [0.65:0.85]
plot dir . "/shear.tsv" using 1:3 skip 1 with points ls 2 title "nsd", 0.81 - 0.3*x with lines ls 9 title "0.81 - 0.3 I"
unset multiplot
