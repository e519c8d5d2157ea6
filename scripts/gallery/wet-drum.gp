set multiplot layout 1,2
set xlabel "Bond number"
set ylabel "angle of the surface, degrees"
set xrange [-0.5:13]
set yrange [15:50]
set arrow 1 from graph 0, first 20 to graph 1, first 20 nohead ls 9
set arrow 2 from graph 0, first 26 to graph 1, first 26 nohead ls 9
set label 1 "dry discs: 20 to 26" at graph 0.98, first 21.2 right
plot dir . "/mean.tsv" using 1:2:3 with yerrorlines ls 1 title "nsd", \
     dir . "/lumps.tsv" using 1:(16.5) with points ls 9 pt 4 dt 1 title (system("cat lumps.tsv") eq "" ? "" : "some drums are one lump")
unset arrow
unset label
set ylabel "roughness of the surface, diameters"
set yrange [0:*]
plot dir . "/mean.tsv" using 1:4:5 with yerrorlines ls 1 title "nsd"
unset multiplot
