# steps.gp: what a step costs, over the number of balls. gnuplot -e "data=...; out=..."
set terminal svg size 620, 400 background "white" enhanced font "sans,13"
set output out
set datafile separator "\t"
set logscale xy
set xlabel "balls"
set ylabel "time per step, s"
set xrange [500:2e6]
set format "10^{%T}"
set grid lc rgb "#dddddd"
set key top left
plot data using 1:($1*$3*1e-9) skip 2 with linespoints lw 1.5 pt 7 lc rgb "#1b6ca8" title "100 sweeps and the search", \
     data using 1:($1*$4*1e-9) skip 2 with linespoints lw 1.5 pt 7 lc rgb "#c8402c" title "the search for contacts", \
     x*2e-5 with lines dt 2 lc rgb "#888888" title "linear"
