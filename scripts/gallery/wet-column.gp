set xlabel "Bond number + 1: attraction over the weight of a disc"
set ylabel "over the width, over the height of the column"
set logscale x
set yrange [0:5]
set key top right
set arrow from 11, graph 0 to 11, graph 1 nohead ls 9
set arrow from 25, graph 0 to 25, graph 1 nohead ls 9
plot dir . "/curve.tsv" using (1 + $1):2:3 with yerrorlines ls 1 title "run-out", \
     dir . "/curve.tsv" using (1 + $1):4:5 with yerrorlines ls 2 title "height left", \
     "< echo 1 3.75" using 1:2 with points ls 3 title "dry discs: Staron and Hinch 2005", \
     NaN with lines ls 9 title "the column stands: closed form"
