set multiplot layout 1,2
set xlabel "inertial number I"
set ylabel "shear stress / pressure"
set xrange [0:0.25]; set yrange [0:0.6]
set xtics 0.1
plot dir . "/shear.tsv" using 1:2:3 with yerrorbars ls 1 title "nsd", 0.25 + 1.1*x with lines ls 9 title "da Cruz et al.: 0.25 + 1.1 I"
set key right top noreverse Right
set ylabel "solid fraction"
set yrange [0.7:0.84]
plot dir . "/shear.tsv" using 1:4:5 with yerrorbars ls 1 title "nsd", 0.81 - 0.3*x with lines ls 9 title "da Cruz et al.: 0.81 - 0.3 I"
unset multiplot
