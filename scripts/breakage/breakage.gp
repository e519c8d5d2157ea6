# The pictures of docs/breakage from its tables: folder
set encoding utf8
set grid lc rgb "#dddddd"
set border 3
set tics nomirror out
set key left top reverse Left

set terminal pngcairo size 720,440 font "DejaVu Sans,12"
set output folder . "/weibull.png"
set xlabel "force, N"
set ylabel "broken, of 1000 grains"
set yrange [0:1]
plot folder . "/weibull.tsv" using 1:2 with points pt 7 ps 0.7 lc rgb "#c1440e" title "1000 grains of 2 mm", \
     1 - exp(-(x > 0 ? x / 4 : 0) ** 3) lw 1.5 lc rgb "#444444" title "the distribution put in"

set output folder . "/mill.png"
set xlabel "time, s"
set ylabel "size of the ore, mm"
set y2label "broken"
set yrange [0:8]
set y2range [0:1]
set y2tics
set border 11
set key right bottom
plot folder . "/mill.tsv" using 1:4 with lines lw 2 lc rgb "#e69f00" title "d90", \
     "" using 1:3 with lines lw 2 lc rgb "#c1440e" title "d50", "" using 1:2 with lines lw 2 lc rgb "#56309b" title "d10", \
     "" using 1:5 axes x1y2 with lines lw 2 dt 2 lc rgb "#444444" title "broken, right"
unset y2label
unset y2tics
set border 3

set terminal pngcairo size 1080,440 font "DejaVu Sans,12"
set output folder . "/oedometer.png"
set multiplot layout 1,2
set logscale x
set autoscale y
set key left bottom
set xlabel "stress, Pa"
set ylabel "voids ratio"
plot for [s = 1:2] folder . "/oedometer.tsv" using ($1 == s ? $2 : 1 / 0):3 with linespoints pt 7 ps 0.7 lw 1.5 \
    lc rgb (s == 1 ? "#c1440e" : "#56309b") title sprintf("packing %d", s)
set logscale y
set xrange [0.04:3]
set yrange [100:4000]
set xlabel "size d, mm"
set ylabel "grains of at least d"
plot for [s = 1:2] folder . "/oedometer-grading.tsv" using ($1 == s && $3 > 0 ? $2 : 1 / 0):3 with points pt 7 ps 0.7 \
    lc rgb (s == 1 ? "#c1440e" : "#56309b") title sprintf("packing %d", s)
unset multiplot
