# solvers.gp: performance profiles. gnuplot -e "data=...; out=...; ours='auto ...'; theirs='siconos-prox ...'"
# Blue is nsd, red Siconos. Thick: the default of nsd, and of Siconos the best solver for each problem, which nobody has, and the first of
# theirs, which solves most; thin: the other solvers, whose figures the table in the .md has.
set terminal svg size 1100, 520 background "white" enhanced font "sans,17"
set output out
set datafile separator "\t"
set datafile missing NaN
set logscale x
set xrange [0.95:1e4]
set yrange [0:1.02]
set xtics ("1" 1, "10" 10, "100" 100, "1000" 1000, "" 1e4)
set ytics 0.2
set border 3
set tics nomirror scale 0.5
set grid lc rgb "#e4e4e4"
set xlabel "time over that of the fastest"
at(e, s) = strcol(1) eq e && strcol(2) eq s ? column(4) : NaN
eps = "1e-4 1e-8 1e-12"
set multiplot
do for [k=1:3] {
    e = word(eps, k)
    set lmargin at screen 0.09 + 0.31 * (k - 1)
    set rmargin at screen 0.09 + 0.31 * (k - 1) + 0.28
    set tmargin at screen 0.88
    set bmargin at screen 0.33
    set title "to ".e
    if (k == 1) { set ylabel "part of the problems solved" } else { set ylabel "" }
    unset key
    plot for [i=2:words(theirs)] data using 3:(at(e, word(theirs, i))) with steps lw 1.2 lc rgb "#e3a59b" notitle, \
         for [i=2:words(ours)] data using 3:(at(e, word(ours, i))) with steps lw 1.2 lc rgb "#8fb4d6" notitle, \
         data using 3:(at(e, word(theirs, 1))) with steps lw 3 lc rgb "#c8402c" notitle, \
         data using 3:(at(e, "theirs")) with steps lw 3 dt (3, 3) lc rgb "#c8402c" notitle, \
         data using 3:(at(e, word(ours, 1))) with steps lw 4 lc rgb "#08306b" notitle
}
# the legend, below all of them
unset title; unset xlabel; unset ylabel; unset tics; unset border; unset grid; unset logscale
set lmargin at screen 0.02; set rmargin at screen 0.98; set tmargin at screen 0.16; set bmargin at screen 0.01
set xrange [0:1]; set yrange [0:1]
set key at screen 0.95, screen 0.155 right horizontal maxrows 2 samplen 3 width 1
plot NaN with lines lw 4 lc rgb "#08306b" title "nsd ".word(ours, 1), \
     NaN with lines lw 1.2 lc rgb "#8fb4d6" title words(ours) > 1 ? "other solvers of nsd" : "", \
     NaN with lines lw 3 dt (3, 3) lc rgb "#c8402c" title "best of Siconos for each problem", \
     NaN with lines lw 3 lc rgb "#c8402c" title word(theirs, 1), \
     NaN with lines lw 1.2 lc rgb "#e3a59b" title words(theirs) > 1 ? "other solvers of Siconos" : ""
unset multiplot
