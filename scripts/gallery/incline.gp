load dir . "/fit.gp"
profiles = system("ls -v profile-*.tsv")
set multiplot layout 1,2
set xlabel "angle, degrees"
set ylabel "height, diameters"
set key top right noreverse Right
set xrange [13:28]
set yrange [0:25]
set parametric
set trange [1.5:24]
set arrow 1 from 15, 0 to 15, 25 nohead ls 9
set label 1 "15: Deboeuf 2005" at 15.3, 0.9
plot atan(a + b * exp(-t / L)) * 180 / pi, t with lines ls 3 title "Pouliquen 1999, fitted", \
     dir . "/rest.tsv" using 2:1:3 with xerrorbars ls 1 title "stops, nsd"
unset arrow 1
unset label 1
set xlabel "speed / sqrt(g d)"
set ylabel "height above the bed, diameters"
set key top left reverse Left
set xrange [0:*]
set yrange [0:h * 1.25]
set trange [0:h]
plot us * (1 - (1 - t / h) ** 1.5), t with lines ls 9 title "Bagnold", \
     for [i=1:words(profiles)] dir . "/" . word(profiles, i) using 2:1 with points ls 1 ps 0.8 title (i == 1 ? "nsd, 25 degrees" : "")
unset multiplot
