set logscale xy
set xlabel "a, height over width"
set ylabel "run-out over width"
plot (x < 2 ? 2.5*x : 3.25*x**0.7) with lines ls 9 title "discs: Staron and Hinch 2005", \
     (x < 2.3 ? 1.2*x : 1.9*x**(2./3)) with lines ls 2 dt 3 title "beads: Lube et al. 2005", \
     dir . "/curve.tsv" using 1:2:3 with yerrorbars ls 1 title "nsd"
