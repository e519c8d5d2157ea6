set xlabel "Bond number: pull over the weight of a disc"
set ylabel "run-out over width; height over that of the column"
set key right center
plot dir . "/runout.tsv" using 1:2 skip 1 with linespoints ls 1 title "run-out", \
     dir . "/runout.tsv" using 1:3 skip 1 with linespoints ls 2 title "height left"
