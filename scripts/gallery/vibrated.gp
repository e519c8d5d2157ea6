set xlabel "largest acceleration of the floor / g"
set ylabel "part of a period off the floor"
set yrange [-0.02:*]
closed = "< awk '!seen[$1]++' '" . dir . "/curve.tsv'"
plot closed using 1:4 with lines ls 9 title "one ball that does not bounce, closed solution", \
     dir . "/curve.tsv" using 1:2:3 with yerrorbars ls 1 title "bed of discs"
