# laws.gp: Signorini's graph, Coulomb's graph, Coulomb's cone; circles: what nsd-solve returns.
# gnuplot -e "law='signorini'; data=...; out=..." ; data: u_n u_t1 u_t2 r_n r_t1 r_t2, m/s and N s
set output out
set encoding utf8
mu = 0.7
unset key

if (law eq "coulombcone") {
    set terminal svg size 560, 460 background "white" enhanced font "sans,13"
    stats data using 4 nooutput
    set view 68, 25, 1, 1.1
    set xyplane 0
    set xrange [-0.75:0.75]
    set yrange [-0.75:0.75]
    set zrange [0:1.05]
    set xlabel "r_{t1}"
    set ylabel "r_{t2}"
    set zlabel "r_n" offset 2
    unset xtics
    unset ytics
    unset ztics
    set parametric
    set urange [0:2*pi]
    set vrange [0:1]
    set isosamples 49, 9
    splot mu*v*cos(u), mu*v*sin(u), v with lines lc rgb "#b0c4d8" lw 0.7, \
          data using ($5/STATS_max):($6/STATS_max):($4/STATS_max) with points pt 7 ps 0.45 lc rgb "#c8402c"
    exit
}

set terminal svg size 440, 340 background "white" enhanced font "sans,13"
set zeroaxis lt 1 lw 1 lc rgb "#888888"
unset border
unset tics
if (law eq "signorini") {
    stats data using 4 nooutput
    m = STATS_max
    set xrange [-0.25:1.2]
    set yrange [-0.25:1.2]
    set label "u_n" at 1.13, -0.08
    set label "r_n" at -0.12, 1.13
    set arrow from 0, 0 to 0, 1.15 nohead lw 4 lc rgb "#1b6ca8"
    set arrow from 0, 0 to 1.15, 0 nohead lw 4 lc rgb "#1b6ca8"
    plot data using ($1/0.1):($4/m) with points pt 6 ps 0.9 lw 1.6 lc rgb "#c8402c"
} else {
    set xrange [-1.2:1.2]
    set yrange [-1.3:1.3]
    set label "u_t" at 1.1, -0.1
    set label "r_t" at 0.04, 1.22
    set label "μ r_n" at 0.05, 1.07
    set label "-μ r_n" at -0.22, -1.07
    set arrow from -1.15, 1 to 0, 1 nohead lw 4 lc rgb "#1b6ca8"
    set arrow from 0, 1 to 0, -1 nohead lw 4 lc rgb "#1b6ca8"
    set arrow from 0, -1 to 1.15, -1 nohead lw 4 lc rgb "#1b6ca8"
    plot data using ($2/0.2):($5/(mu*$4)) with points pt 6 ps 0.9 lw 1.6 lc rgb "#c8402c"
}
