# convergence.gp: the four error terms and their sum against the sweep; balls left, discs right.
# gnuplot -e "method='sbp'; balls=...; discs=...; out=..."; columns: sweep motion proj bipotential
# penetration eps_glob, of the paper: m/s, N, W, m/s
stats balls using 1 name "balls" nooutput
stats discs using 1 name "discs" nooutput
set terminal svg size 960, 390 background "white" enhanced font "sans,12"
set output out
set encoding utf8
set logscale y
set format y "10^{%T}"
set yrange [1e-20:1e-1]
set xlabel "sweep" offset 0, 0.5
set ylabel "mean over the contacts" offset 0.5, 0
set grid ytics lc rgb "#dddddd"
set key outside below horizontal samplen 1.5
set rmargin 4
set style line 1 lw 1.5 pt 7 ps 0.5 lc rgb "#1b6ca8"
set style line 2 lw 1.5 pt 7 ps 0.5 lc rgb "#3a7d44"
set style line 3 lw 1.5 pt 7 ps 0.5 lc rgb "#e09f3e"
set style line 4 lw 1.5 pt 7 ps 0.5 lc rgb "#c8402c"
set style line 5 lw 2.5 dt 2 pt 7 ps 0.3 lc rgb "#222222"
positive(x) = x > 0 ? x : NaN

set multiplot layout 1, 2
do for [k = 1:2] {
    file = k == 1 ? balls : discs
    sweeps = k == 1 ? balls_max : discs_max
    set title k == 1 ? method.", balls, nsd's settings" : \
              method eq "exact" ? method.", discs" : method.", discs, the paper's settings"
    set xrange [0:(sweeps > 1 ? sweeps : 2)]
    if (sweeps > 30) { set style data lines } else { set style data linespoints }
    plot file using 1:(positive($2)) ls 1 title "motion, m/s", \
         ''   using 1:(positive($3)) ls 2 title "projection, N", \
         ''   using 1:(positive($4)) ls 3 title "bi-potential, W", \
         ''   using 1:(positive($5)) ls 4 title "penetration, m/s", \
         ''   using 1:(positive($6)) ls 5 title "ε_{glob}, their sum"
}
unset multiplot
