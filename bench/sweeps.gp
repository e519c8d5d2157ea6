# sweeps.gp: ns a contact and sweep over the number of balls. gnuplot -e "data=...; out=..."
set terminal svg size 720, 420 background "white" enhanced font "sans,13"
set output out
set datafile separator "\t"
set logscale x
set xlabel "balls"
set ylabel "ns a contact and sweep"
set yrange [0:*]
set xrange [300:2e6]
set format x "10^{%T}"
set grid ytics lc rgb "#dddddd"
set key outside right
of(m, t) = strcol(2) eq m && strcol(3) eq "colour" && strcol(4) eq lanes && column(5) == t ? column(7) : NaN
stats data using 4 skip 2 nooutput
lanes = sprintf("%d", STATS_max)
set datafile missing NaN
names = "exact sbp sal ebp eal"
colours = "#222222 #1b6ca8 #3a7d44 #c8402c #e09f3e"
plot for [i=1:5] data using 1:(of(word(names, i), 1)) skip 2 with linespoints pt 7 ps 0.6 \
         lc rgb word(colours, i) title word(names, i), \
     for [i=1:5] data using 1:(of(word(names, i), 2)) skip 2 with linespoints pt 6 ps 0.6 dt 2 \
         lc rgb word(colours, i) title word(names, i)."  -j 2"
