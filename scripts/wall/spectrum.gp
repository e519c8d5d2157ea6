# spectrum.gp: data, out, sizes: the eigenvalues nearest to -1e-4; a block of data for each size. Modes with a negative real part grow:
# red, in the shaded half.
set terminal svg size 1100,450 font "sans,17" background "white"
set output out
set multiplot
set border 3
set tics nomirror scale 0.5
set xzeroaxis lc rgb "#aaaaaa"
set xlabel "real part, 10^{-4}"
set style line 1 pt 7 ps 0.7 lc rgb "#1b6ca8"
set style line 2 pt 9 ps 1.1 lc rgb "#c8402c"
unset key
do for [i = 1:words(sizes)] {
    set xrange [*:*]
    stats data index i - 1 using (1e4 * $1):($1 < -1e-6) nooutput
    grow = int(STATS_sum_y)
    left = grow ? 1.1 * STATS_min_x : -0.08 * STATS_max_x
    set xrange [left:1.05 * STATS_max_x]
    span = STATS_max_x - left
    set xtics span > 8 ? 5 : span > 2.5 ? 1 : 0.5
    set object 1 rectangle from graph 0, graph 0 to first 0, graph 1 behind fs solid noborder fc rgb "#fbeae7"
    set title word(sizes, i)." balls: ".(grow ? "".grow." modes grow" : "no mode grows")
    set ylabel i == 1 ? "imaginary part, 10^{-4}" : ""
    set lmargin at screen 0.085 + 0.315 * (i - 1)
    set rmargin at screen 0.085 + 0.315 * (i - 1) + 0.265
    set tmargin at screen 0.86
    set bmargin at screen 0.27
    plot data index i - 1 using ($1 < -1e-6 ? NaN : 1e4 * $1):(1e4 * $2) with points ls 1 notitle, \
         data index i - 1 using ($1 < -1e-6 ? 1e4 * $1 : NaN):(1e4 * $2) with points ls 2 notitle
}
# the legend, below all of them
unset title; unset xlabel; unset ylabel; unset tics; unset border; unset object; unset xzeroaxis
set lmargin at screen 0.02; set rmargin at screen 0.98; set tmargin at screen 0.1; set bmargin at screen 0.01
set xrange [0:1]; set yrange [0:1]
set key at screen 0.7, screen 0.07 right horizontal maxrows 1 samplen 1 width 2
plot NaN with points ls 1 title "decays", NaN with points ls 2 title "grows: negative real part"
unset multiplot
