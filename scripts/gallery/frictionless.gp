load dir . "/fit.gp"
set multiplot layout 1,2
set xlabel "inertial number I"
set ylabel "shear stress / pressure"
set logscale x
set xrange [0.003:0.15]; set yrange [0:0.4]
set xtics ("0.005" 0.005, "0.02" 0.02, "0.1" 0.1)
plot dir . "/shear.tsv" using 1:2:3 with yerrorbars ls 1 title "nsd", fit_mu(x) with lines ls 1 title "a + b I^{0.38}", \
     0.101 with lines ls 9 title "Peyneau and Roux, I = 0"
set key left bottom
set ylabel "solid fraction"
set yrange [0.58:0.66]
plot dir . "/shear.tsv" using 1:4:5 with yerrorbars ls 1 title "nsd", fit_phi(x) with lines ls 1 title "a - b I^{0.38}", \
     0.639 with lines ls 9 title "random close packing"
unset multiplot
