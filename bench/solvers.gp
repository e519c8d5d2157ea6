# solvers.gp: performance profiles. gnuplot -e "data=...; out=...; ours='auto ...'; theirs='siconos-prox ...'"
set terminal svg size 1180, 460 background "white" enhanced font "sans,13"
set output out
set datafile separator "\t"
set datafile missing NaN
set logscale x
set xrange [0.95:1e4]
set yrange [0:1.02]
set format x "10^{%T}"
set border 3
set tics nomirror
set grid lc rgb "#dddddd"
set xlabel "times the fastest"
at(e, s) = strcol(1) eq e && strcol(2) eq s ? column(4) : NaN
title(s) = strstrt(s, "siconos-") ? substr(s, 9, strlen(s)) : s
eps = "1e-4 1e-8 1e-12"
blues = "#08306b #1b6ca8 #3a7d44 #00a0a0 #7b3fa0 #6ab04c #8899aa #444466"
reds = "#c8402c #e09f3e #a0522d #d16ba5 #b8860b #ff7f50 #8b0000"
set multiplot
do for [k=1:3] {
    e = word(eps, k)
    set lmargin at screen 0.065 + 0.265 * (k - 1)
    set rmargin at screen 0.065 + 0.265 * (k - 1) + 0.23
    set title "to ".e
    if (k == 1) { set ylabel "solved, of all" } else { set ylabel "" }
    if (k == 3) { set key at screen 0.995, screen 0.93 right top samplen 2 spacing 1.05 font "sans,12" } else { unset key }
    plot for [i=1:words(ours)] data using 3:(at(e, word(ours, i))) with steps \
             lw (i == 1 ? 3.5 : 1.8) lc rgb word(blues, (i - 1) % 8 + 1) title "nsd ".word(ours, i), \
         for [i=1:words(theirs)] data using 3:(at(e, word(theirs, i))) with steps \
             lw 1.5 dt (6,3) lc rgb word(reds, (i - 1) % 7 + 1) title "Siconos ".title(word(theirs, i)), \
         data using 3:(at(e, "theirs")) with steps lw 3 dt (2,2) lc rgb "#000000" title "Siconos, the best"
}
unset multiplot
