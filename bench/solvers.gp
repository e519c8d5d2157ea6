# solvers.gp: performance profiles. gnuplot -e "data=...; out=...; ours='auto ...'; theirs='siconos-prox ...'"
# Two curves stand out: nsd's default, and of Siconos the best solver for each problem. The rest, singly, is in two pale
# colours; the table in the .md has their figures.
set terminal svg size 1000, 430 background "white" enhanced font "sans,16"
set output out
set datafile separator "\t"
set datafile missing NaN
set logscale x
set xrange [0.95:1e4]
set yrange [0:1.02]
set format x "10^{%T}"
set xtics (1, 100, 1e4)
set border 3
set tics nomirror
set grid lc rgb "#dddddd"
set xlabel "times the fastest"
at(e, s) = strcol(1) eq e && strcol(2) eq s ? column(4) : NaN
eps = "1e-4 1e-8 1e-12"
rest = words(ours) - 1
set multiplot
do for [k=1:3] {
    e = word(eps, k)
    set lmargin at screen 0.075 + 0.315 * (k - 1)
    set rmargin at screen 0.075 + 0.315 * (k - 1) + 0.275
    set tmargin at screen 0.76
    set bmargin at screen 0.17
    set title "to ".e
    if (k == 1) { set ylabel "part that is solved" } else { set ylabel "" }
    if (k == 3) { set key at screen 0.98, screen 0.995 right top maxrows 2 samplen 2.5 width 1 } else { unset key }
    plot for [i=1:words(theirs)] data using 3:(at(e, word(theirs, i))) with steps \
             lw 1.5 dt (6,3) lc rgb "#e3a59b" title (i == 1 ? "Siconos, each of ".words(theirs)." solvers" : ""), \
         for [i=2:words(ours)] data using 3:(at(e, word(ours, i))) with steps \
             lw 1.5 lc rgb "#a9c3dc" title (i == 2 ? "nsd, each of ".rest." others" : ""), \
         data using 3:(at(e, "theirs")) with steps lw 3 dt (2,2) lc rgb "#c8402c" title "Siconos, the best for each problem", \
         data using 3:(at(e, word(ours, 1))) with steps lw 3.5 lc rgb "#08306b" title "nsd ".word(ours, 1)
}
unset multiplot
