set xlabel "distance from the centre, over the half width of the pile"
set ylabel "pressure, over the weight of a column of the pile's height"
set yrange [0:*]
set key bottom left
plot dir . "/pressure.tsv" index 0 using 1:2:3 with yerrorlines ls 1 title "narrow source", \
     dir . "/pressure.tsv" index 1 using 1:2:3 with yerrorlines ls 2 title "rain", \
     1 - x with lines ls 9 title "weight above"
