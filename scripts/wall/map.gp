# map.gp: out, sizes: how the natural map falls with the sweeps, and how long proximal steps are
set terminal svg size 1000,430 font "sans,16" background "white"
set output out . "/map.svg"
set multiplot layout 1, 2
colours = "#1b6ca8 #c8402c #3a7d44"
set border 3
set tics nomirror
set logscale xy
set format "10^{%T}"
set grid lc rgb "#dddddd"
set xlabel "sweeps"
set ylabel "natural map"
set key bottom left reverse Left
plot for [i = 1:words(sizes)] out . "/follow.tsv" index i - 1 using 1:($2 < 1e-15 ? 1e-15 : $2) with linespoints pt 2 * i + 3 ps 0.8 lw 1.5 \
     lc rgb word(colours, (i - 1) % 3 + 1) title word(sizes, i) . " balls"
unset logscale x
set format x "%g"
set xtics 10
set xlabel "proximal step, sigma = 100"
set ylabel "length of the step"
set key top right noreverse Right
plot out . "/steps.tsv" index 0 using 1:2 with linespoints pt 7 ps 0.6 lw 1.5 lc rgb "#1b6ca8" title "Coulomb's law", \
     "" index 1 using 1:2 with linespoints pt 5 ps 0.6 lw 1.5 lc rgb "#c8402c" title "radii of the discs held"
