set multiplot layout 1,2
set xlabel "angle, degrees"
set ylabel "height, diameters"
set key top right noreverse Right
set yrange [0:*]
plot dir . "/stop.tsv" using 2:1 skip 1 with linespoints ls 1 title "stops"
set xlabel "speed / sqrt(g d)"
set ylabel "height above the bed, diameters"
set key top left reverse Left
plot dir . "/profile.tsv" using 2:1 with linespoints ls 2 title "at 24 degrees"
unset multiplot
