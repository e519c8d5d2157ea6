load dir . "/fit.gp"
set multiplot layout 1,2
set xlabel "inertial number I"
set ylabel "shear stress / pressure, no friction"
set logscale x
set xrange [0.0025:0.2]; set yrange [0:0.5]
set xtics ("0.005" 0.005, "0.02" 0.02, "0.1" 0.1)
plot dir . "/pentagons.tsv" using 1:2:3 with yerrorbars ls 1 title "pentagons, fit a + b I^{0.38}", mu_pentagons(x) with lines ls 1 notitle, \
     dir . "/discs.tsv" using 1:2:3 with yerrorbars ls 2 title "discs", mu_discs(x) with lines ls 2 notitle, \
     0.183 with lines ls 9 title "Azéma et al., I = 0"
set key left bottom
set ylabel "solid fraction"
set yrange [0.72:0.88]
plot dir . "/pentagons.tsv" using 1:4:5 with yerrorbars ls 1 title "pentagons", phi_pentagons(x) with lines ls 1 notitle, \
     dir . "/discs.tsv" using 1:4:5 with yerrorbars ls 2 title "discs", phi_discs(x) with lines ls 2 notitle, \
     pressed with lines ls 9 title "pentagons, isotropic"
unset multiplot
