set multiplot layout 1,2
set xlabel "Froude number w^2 R/g"
set ylabel "angle of the surface, degrees"
set yrange [0:*]
plot dir . "/angle.tsv" using 1:2 skip 1 with linespoints ls 1 title "discs"
set xlabel "velocity down the layer, m/s"
set ylabel "depth, mm"
set yrange [*:0] reverse
set yrange [45:0]
set key bottom right noreverse Right
plot for [f in system("ls -v layer-*.tsv")] dir . "/" . f using 2:(1000*$1) with linespoints title f[7:strlen(f)-4] . " rad/s"
unset multiplot
