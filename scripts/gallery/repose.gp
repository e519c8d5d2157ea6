set xlabel "mu_r over the radius; Bond number over 100"
set ylabel "slope of the heap, degrees"
set key right bottom
plot dir . "/rolling.tsv" using 1:2 skip 1 with linespoints ls 1 title "rolling friction", \
     dir . "/cohesion.tsv" using ($1/100):2 skip 1 with linespoints ls 2 title "cohesion"
