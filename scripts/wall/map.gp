# map.gp: out, sizes: how the natural map falls with the sweeps, and how long proximal steps are
set terminal svg size 900,330 font "sans,12" background "white"
set output out . "/map.svg"
set multiplot layout 1, 2
set logscale xy
set format "10^{%T}"
set grid lc rgb "#dddddd"
set xlabel "sweeps"
set ylabel "natural map"
set key bottom left
plot for [i = 1:words(sizes)] out . "/follow.tsv" index i - 1 using 1:($2 < 1e-15 ? 1e-15 : $2) with linespoints pt 7 ps 0.4 lw 1.5 title word(sizes, i) . " balls"
unset logscale x
set format x "%g"
set format y "%.1e"
set xlabel "proximal step, sigma = 100"
set ylabel "its length"
set key top right
plot out . "/steps.tsv" index 0 using 1:2 with linespoints pt 7 ps 0.4 lw 1.5 title "Coulomb's law", \
     "" index 1 using 1:2 with linespoints pt 7 ps 0.4 lw 1.5 title "radii of the discs held"
