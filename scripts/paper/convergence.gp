# convergence.gp: the four error terms and their sum against the sweep, a panel for each method; balls above, discs below.
# gnuplot -e "balls='FILE ...'; discs='FILE ...'; out=..."; a file for each of sbp sal ebp eal exact, columns: sweep motion proj
# bipotential penetration eps_glob, of the paper: m/s, N, W, m/s
set terminal svg size 1100, 640 background "white" enhanced font "sans,15"
set output out
set encoding utf8
set logscale y
set yrange [1e-20:1e-1]
set ytics 1e-20, 1e5, 1
set grid ytics lc rgb "#dddddd"
set border 3
set tics nomirror scale 0.5
set style line 1 lw 2 pt 7 ps 0.5 lc rgb "#1b6ca8"
set style line 2 lw 2 pt 7 ps 0.5 lc rgb "#3a7d44"
set style line 3 lw 2 pt 7 ps 0.5 lc rgb "#e09f3e"
set style line 4 lw 2 pt 7 ps 0.5 lc rgb "#c8402c"
set style line 5 lw 2.5 dt (6, 5) pt 6 ps 0.8 lc rgb "#222222"
positive(x) = x > 0 ? x : NaN
methods = "sbp sal ebp eal exact"
most(files) = system("cut -f 1 ".files." | sort -n | tail -n 1") + 0

set multiplot
do for [row = 1:2] {
    files = row == 1 ? balls : discs
    n = most(files)
    set xrange [(n > 100 ? 0 : 0.5):n + 0.5]
    if (n > 100) { set xtics 0, n > 2000 ? 2000 : 100 } else { set xtics 10 }
    do for [k = 1:5] {
        file = word(files, k)
        set origin 0.095 + (k - 1) * 0.181, row == 1 ? 0.57 : 0.16
        set size 0.181, 0.42
        set lmargin 0.5; set rmargin 1.5; set tmargin 1.6; set bmargin 1.5
        set format y k == 1 ? "10^{%T}" : ""
        set title (row == 1 ? "{/:Bold ".word(methods, k)."}" : "") offset 0, -0.6
        unset label
        if (k == 1) {
            set label 1 row == 1 ? "balls, nsd's settings" : "discs, the paper's settings" at graph -0.42, graph 0.5 center rotate
        }
        unset key
        set style data lines
        if (system("wc -l <".file) < 4) {
            set style data points
            set label 3 (system("cut -f 6 ".file) == 0 ? "one sweep, 0" : "one sweep") at graph 0.5, graph 0.5 center
        }
        plot for [c = 2:5] file using 1:(positive(column(c))) ls c - 1, file using 1:(positive($6)) ls 5
    }
}
# the legend, below all of them
unset label; unset title; unset tics; unset border; unset grid
set origin 0, 0; set size 1, 0.15
set lmargin 1; set rmargin 1; set tmargin 0; set bmargin 0
set label 2 "sweeps; the terms are means over the contacts" at screen 0.55, 0.125 center
set xrange [0:1]; set yrange [1:10]
set key at screen 0.86, 0.075 horizontal maxrows 2 samplen 2.5 width 2
plot NaN with lines ls 1 title "motion, m/s", NaN with lines ls 2 title "projection, N", NaN with lines ls 3 title "bi-potential, W", \
     NaN with lines ls 4 title "penetration, m/s", NaN with lines ls 5 title "ε_{glob}, their sum"
unset multiplot
