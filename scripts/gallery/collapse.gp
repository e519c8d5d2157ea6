set logscale xy
set xlabel "a, height over width"
set ylabel "run-out over width"
plot dir . "/runout.tsv" using 1:2 skip 1 with points ls 1 title "nsd", \
     (x < 2 ? 2.5*x : 3.25*x**0.7) with lines ls 9 title "discs: Staron and Hinch 2005", \
     (x < 2.3 ? 1.2*x : 1.9*x**(2./3)) with lines ls 9 dt 3 title "beads: Lajeunesse et al. 2005"
