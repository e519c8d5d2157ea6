set multiplot layout 1,2
set logscale x
set key left bottom
set xlabel "stress, Pa"
set ylabel "voids ratio less that at 127 Pa"
names = "discs few balls"
titles = '"1000 discs" "125 balls" "1000 balls"'
file(s) = dir . "/" . word(names, s) . ".tsv"
sizes(s) = dir . "/" . word(names, s) . "-sizes.tsv"
first = 0
was = last = 0
plot for [s = 1 : 3] file(s) using 2:(first = $1 != was || $2 < last ? $3 : first, was = $1, last = $2, $3 - first) with points ls s title word(titles, s)
set logscale y
set xlabel "size d, mm"
set ylabel "grains of at least d"
set xrange [0.04:3]
set yrange [5:2e4]
plot for [s = 1 : 3] sizes(s) using ($3 > 0 ? $2 : 1 / 0):3 with points ls s title word(titles, s), \
     300 * x ** -2.5 with lines ls 9 title "d^{-2.5}"
unset multiplot
