set multiplot layout 1,2
set xlabel "friction coefficient"
set ylabel "solid fraction"
set xrange [-0.05:1.05]; set yrange [0.45:0.75]
set xtics 0.25
set key right top noreverse Right
set style fill transparent solid 0.2 noborder
plot "+" using 1:(0.66):(0.68) with filledcurves lc rgb "#888888" title "dice, densest", \
     "+" using 1:(0.53):(0.55) with filledcurves lc rgb "#c05a1a" title "dice, loosest", \
     dir . "/cubes.tsv" using 1:2:3 with yerrorlines ls 1 title "nsd"
set ylabel "cubatic order above that at random"
set yrange [-0.2:0.8]
plot dir . "/cubes.tsv" using 1:4:5 with yerrorlines ls 1 title "nsd", 0 with lines ls 9 notitle
unset multiplot
