# strobe.gp: the ball of example 1, every 20 ms; x z radius angle, m and rad.
set terminal svg size 960, 140 background "white" enhanced font "sans,12"
set output out
unset key
set size ratio -1
unset border
unset ytics
set xtics nomirror out
set xlabel "x, mm"
set xrange [-8:236]
set yrange [-1:11]
set arrow from -8, 0 to 236, 0 nohead lw 2 lc rgb "#888888"
set label "it slides" at 42, 13 center
set label "it rolls" at 160, 13 center
plot data using ($1*1e3):($2*1e3):($3*1e3) with circles fs solid 0.2 border lc rgb "#1b6ca8", \
     data using ($1*1e3):($2*1e3):(sin($4)*$3*1e3):(cos($4)*$3*1e3) with vectors head filled size 1,20 lw 1.5 lc rgb "#c8402c"
