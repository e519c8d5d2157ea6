set xlabel "Bond number + 1: attraction over the weight of a disc"
set ylabel "over the width, over the height of the column"
set logscale x
set yrange [0:*]
set key right center
set arrow from 9, graph 0 to 9, graph 1 nohead ls 9
set arrow from 21, graph 0 to 21, graph 1 nohead ls 9
plot dir . "/curve.tsv" using (1 + $1):2:3 with yerrorlines ls 1 title "run-out", \
     dir . "/curve.tsv" using (1 + $1):4:5 with yerrorlines ls 2 title "height left", \
     3.75 with points ls 3 title "", \
     NaN with lines ls 9 title "critical: closed form, 8 to 20"
