set xlabel "Bond number: pull over the weight of a disc"
set ylabel "angle of the surface, degrees"
set y2label "its roughness in diameters"
set y2tics
set border 11
set key right bottom
plot dir . "/angle.tsv" using 1:2 skip 1 with linespoints ls 1 title "angle", \
     dir . "/angle.tsv" using 1:3 skip 1 axes x1y2 with linespoints ls 2 title "roughness"
