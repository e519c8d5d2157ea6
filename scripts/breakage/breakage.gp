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

set terminal pngcairo size 1080,300 font "DejaVu Sans,12"
set output folder . "/grain.png"
set multiplot layout 1,3 margins 0.01,0.99,0.02,0.88 spacing 0.01
set size ratio -1
unset border; unset tics; unset key; unset grid; unset xlabel; unset ylabel
set autoscale
do for [k = 1 : 3] {
    set title sprintf("%s ms", word("50 51 80", k))
    plot folder . sprintf("/grain-%s.png", word("500 510 800", k)) binary filetype=png with rgbimage
}
unset multiplot
