speeds = system("ls layer-*-*.tsv | sed 's/^layer-//; s/-.*//' | sort -gu")
colours = "#1f4e79 #2a9d8f #8ab17d #e09f3e #c0392b"
set multiplot layout 1,2
set xlabel "Froude number w^2 R/g"
set ylabel "angle of the surface, degrees"
set yrange [10:50]
set xrange [0:0.3]
set xtics 0.1
set key left top
set arrow 1 from 0, 15 to 0.3, 15 nohead ls 9
set arrow 2 from 0, 21 to 0.3, 21 nohead ls 9
set label 1 "avalanches of discs start: 21" at 0.295, 19.8 right
set label 2 "they stop: 15 (Deboeuf 2005)" at 0.295, 13.8 right
plot dir . "/angle-mean.tsv" using 1:2:3 with yerrorlines ls 1 title "discs, nsd", \
     dir . "/balls-mean.tsv" using 1:2:3 with yerrorbars ls 3 title (quick ? "" : "balls, nsd"), \
     "<echo 0.003 25 2" using 1:2:3 with yerrorbars ls 9 pt 4 title "balls (Kleinhans 2011)"
unset arrow
unset label
set xlabel "velocity down the layer / sqrt(g d)"
set ylabel "depth, diameters"
set xrange [-2:*]
set xtics autofreq
set yrange [18:0]
set key bottom right noreverse Right
plot for [i=1:words(speeds)] "<cat layer-" . word(speeds, i) . "-*.tsv" using 2:1 with points pt 2 * i + 3 ps 0.7 lc rgb word(colours, i) \
         title word(speeds, i) . " rad/s", \
     [t=0:4] "+" using (0.5 * (8 - 2 * $1)):(2 * $1) with lines ls 9 title "0.5 sqrt(g/d)", \
     [t=0:4] "+" using (0.3 * (8 - 2 * $1)):(2 * $1) with lines ls 9 dt 3 title "0.3 sqrt(g/d)"
unset multiplot
