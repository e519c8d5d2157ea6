shapes = quick ? "discs" : "discs balls"
starts = "dense loose"
set multiplot layout 2, words(shapes) columnsfirst
set style fill transparent solid 0.25 noborder
# blue: the dense start, orange: the loose one; the band around each curve is the standard error of the mean over the seeds
colour(t) = word("#1f4e79 #c05a1a", t)
file(s, t) = dir . "/" . word(shapes, s) . "-" . word(starts, t) . ".tsv"
least(s) = s == 1 ? 0.28 : 0.34
most(s) = s == 1 ? 0.30 : 0.38
set xtics 0.1
set lmargin 10; set rmargin 2
do for [s = 1 : words(shapes)] {
    set title sprintf("%s; grey: published, %g to %g", word(shapes, s), least(s), most(s)) offset 0, -0.7
    set ylabel s == 1 ? "sin of the friction angle" : ""
    set xlabel ""
    set yrange [0:0.6]; set ytics 0.2
    set object 1 rectangle from graph 0, first least(s) to graph 1, first most(s) behind fc rgb "#cccccc" fs solid noborder
    set key top right horizontal noreverse Right
    plot for [t = 1 : 2] file(s, t) using 1:($2-$3):($2+$3) with filledcurves lc rgb colour(t) notitle, \
         for [t = 1 : 2] file(s, t) using 1:2 with lines lw 1.5 lc rgb colour(t) title word(starts, t)
    unset object 1; unset title; unset key
    set xlabel "strain"
    set ylabel s == 1 ? "solid fraction" : ""
    set yrange [*:*]; set ytics 0.02
    plot for [t = 1 : 2] file(s, t) using 1:($4-$5):($4+$5) with filledcurves lc rgb colour(t) notitle, \
         for [t = 1 : 2] file(s, t) using 1:4 with lines lw 1.5 lc rgb colour(t) notitle
}
unset multiplot
