set multiplot layout 1,2
set xlabel "t / {/Symbol t} of kinetic theory"
set ylabel "T / T_0"
set logscale y
set xrange [0:2.2]; set yrange [0.08:1.1]
set xtics 0.5
set ytics (0.1, 0.2, 0.5, 1)
set key right top noreverse Right
# the curves lie on one another: each restitution has its own symbol, and every fifth time is drawn
tables = system("ls -v cooling-*.tsv")
plot 1 / (1 + x)**2 with lines ls 9 lw 2 dt 1 title "Haff: (1 + t/{/Symbol t})^{-2}", \
     for [k = 1 : words(tables)] f = word(tables, k) dir . "/" . f using 1:2 every 5::(k - 1) with points pt 2 * k + 2 ps 1.4 lw 1.2 \
         lc rgb word("#1f4e79 #c05a1a #4a7d3a #7a4a8a #222222", k) title "e = " . f[9:strlen(f)-4]
unset logscale
set xlabel "restitution e"
set ylabel "cooling rate over that of kinetic theory"
set xrange [0.65:1]; set yrange [0.9:1.05]
set xtics 0.1; set ytics 0.05
set key bottom right
plot 1 with lines ls 9 lw 2 dt 1 title "Enskog", dir . "/rates.tsv" using 1:2:3 with yerrorbars ls 1 title "nsd"
unset multiplot
