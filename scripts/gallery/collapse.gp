set logscale xy
set xrange [0.5:8]
set yrange [0.5:20]
set xtics (0.5, 1, 2, 4, 8)
set ytics (0.5, 1, 2, 5, 10, 20)
set xlabel "a, height over width"
set ylabel "run-out over width"
plot sample [0.5:2] 2.5*x with lines ls 9 title "discs: Staron and Hinch 2005", \
     [2:8] 3.25*x**0.7 with lines ls 9 notitle, \
     [0.5:2.3] 1.2*x with lines ls 2 dt 3 title "beads: Lube et al. 2005", \
     [2.3:8] 1.9*x**(2./3) with lines ls 2 dt 3 notitle, \
     dir . "/curve.tsv" using 1:2:3 with yerrorbars ls 1 title "nsd"
