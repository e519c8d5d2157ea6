set multiplot layout 1,2
set xlabel "strain"
set ylabel "sin of the mobilised friction angle"
set yrange [0:0.8]
set xtics 0.1
set key top right noreverse Right
shapes = quick ? "discs" : "discs balls"
starts = "dense loose"
set style fill transparent solid 0.25 noborder
colour(s, t) = word("#1f4e79 #c05a1a #4a7d3a #7a4a8a", 2 * s + t - 2)
file(s, t) = dir . "/" . word(shapes, s) . "-" . word(starts, t) . ".tsv"
plot for [s = 1 : words(shapes)] for [t = 1 : 2] file(s, t) using 1:($2-$3):($2+$3) with filledcurves lc rgb colour(s, t) notitle, \
     for [s = 1 : words(shapes)] for [t = 1 : 2] file(s, t) using 1:2 with lines lc rgb colour(s, t) title word(shapes, s) . ", " . word(starts, t), \
     0.29 with lines ls 9 title "discs: 0.28 to 0.3", \
     for [k = 2 : words(shapes)] 0.36 with lines lc rgb "#888888" dt 4 title "balls: 0.34 to 0.38"
set ylabel "solid fraction"
set yrange [*:*]
plot for [s = 1 : words(shapes)] for [t = 1 : 2] file(s, t) using 1:($4-$5):($4+$5) with filledcurves lc rgb colour(s, t) notitle, \
     for [s = 1 : words(shapes)] for [t = 1 : 2] file(s, t) using 1:4 with lines lc rgb colour(s, t) notitle
unset multiplot
