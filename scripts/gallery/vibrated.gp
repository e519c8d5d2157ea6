set xlabel "largest acceleration / g"
set ylabel "part of a period off the floor"
set yrange [-0.02:*]
plot dir . "/flight.tsv" using 1:2 skip 1 with points ls 1 title "bed of discs", \
     dir . "/flight.tsv" using 1:3 skip 1 with lines ls 9 title "a ball that does not bounce"
