# closed.gp: example 1, errors against its closed solution over the time step.
# gnuplot -e "data=...; out=..."; columns: dim method dt error_x error_v late
set terminal svg size 760, 420 background "white" enhanced font "sans,13"
set output out
set encoding utf8
set logscale xy
set format "10^{%T}"
set xlabel "Δt, s"
set ylabel "error at most, s or m"
set xrange [5e-6:2e-3]
set key top left Left reverse samplen 2 spacing 1.1 width 2 maxrows 3
set yrange [1e-11:1e1]
set ytics 1e-11, 100, 1e-1
of(d, m, y) = column(1) == d && strcol(2) eq m ? y : NaN
plot data using 3:(of(3, "exact", $6)) skip 1 with points pt 7 lc rgb "#c8402c" title "rolling begins late by, s (balls)", \
     data using 3:(of(2, "exact", $6)) skip 1 with points pt 6 lc rgb "#c8402c" title "the same, discs", \
     x with lines dt 2 lc rgb "#c8402c" title "Δt, s", \
     data using 3:(of(3, "exact", $4)) skip 1 with points pt 7 lc rgb "#1b6ca8" title "x, m (balls)", \
     data using 3:(of(2, "exact", $4)) skip 1 with points pt 6 lc rgb "#1b6ca8" title "the same, discs", \
     0.7*9.81/8*x**2 with lines dt 2 lc rgb "#1b6ca8" title "μ g Δt^2/8, m"
