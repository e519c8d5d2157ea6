# sweeps.gp: ns a contact and sweep over the number of balls, by 1 and by 2 threads. gnuplot -e "data=...; out=..."
set terminal svg size 900, 430 background "white" enhanced font "sans,16"
set output out
set datafile separator "\t"
set logscale x
set xlabel "balls"
set xrange [300:2e6]
set xtics (1e3, 1e4, 1e5, 1e6)
set format x "10^{%T}"
set grid ytics lc rgb "#dddddd"
set border 3
set tics nomirror
of(m, t) = strcol(2) eq m && strcol(3) eq "colour" && strcol(4) eq lanes && column(5) == t ? column(7) : NaN
stats data using 4 skip 2 nooutput
lanes = sprintf("%d", STATS_max)
stats data using (strcol(3) eq "colour" && strcol(4) eq lanes ? column(7) : NaN) skip 2 nooutput
set yrange [0:1.4 * STATS_max]
set datafile missing NaN
names = "exact sbp sal ebp eal"
colours = "#222222 #1b6ca8 #3a7d44 #c8402c #e09f3e"
set multiplot
do for [t=1:2] {
    set lmargin at screen (t == 1 ? 0.1 : 0.57)
    set rmargin at screen (t == 1 ? 0.505 : 0.99)
    set title (t == 1 ? "1 thread" : "2 threads")
    if (t == 1) { set ylabel "time per contact and sweep, ns" } else { set ylabel "" }
    if (t == 2) { set key top right maxrows 2 samplen 2 } else { unset key }
    plot for [i=1:5] data using 1:(of(word(names, i), t)) skip 2 with linespoints lw 1.5 pt (2 * i + 3) ps 0.8 \
             lc rgb word(colours, i) title word(names, i)
}
unset multiplot
