# demo.gp: the picture of `make demo`: the balls before and after, and the solver on the way.
# gnuplot -e "dir='demo'" scripts/demo.gp
set terminal pngcairo size 1500, 900 enhanced font "sans,11"
set output dir."/demo.png"
set multiplot

unset key
unset border
unset tics
set size ratio -1
set origin -0.02, 0
set size 0.28, 1
set title "500 balls at the start"
plot dir."/start.png" binary filetype=png with rgbimage
set origin 0.24, 0
set title "after 1000 steps (50 ms)"
plot dir."/end.png" binary filetype=png with rgbimage

set size noratio
set border
set tics
set grid
set xrange [0:1000]
set xlabel "step"
set key top left
set origin 0.53, 0.5
set size 0.47, 0.5
set title "the errors of each step"
set logscale y
set format y "10^{%T}"
set yrange [1e-6:1e1]
set ylabel "overlap, impulse"
plot dir."/steps.tsv" using 1:($4 > 0 ? $4 : NaN) with points pt 7 ps 0.3 lc rgb 0x1b6ca8 \
         title "largest overlap, smallest radii", \
     dir."/steps.tsv" using 1:($5 > 0 ? $5 : NaN) with points pt 7 ps 0.3 lc rgb 0xd1495b \
         title "impulse missing to the laws, over the load"
set origin 0.53, 0
set title "contacts, and sweeps of the small steps"
set yrange [1:10000]
set ylabel "number"
plot dir."/steps.tsv" using 1:2 with lines lw 2 lc rgb 0x3a7d44 title "contacts", \
     dir."/steps.tsv" using 1:3 with points pt 7 ps 0.3 lc rgb 0xe09f3e title "sweeps"
unset multiplot
