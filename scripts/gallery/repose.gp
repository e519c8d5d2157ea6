set multiplot layout 1,2
set xlabel "mu_r over the radius"
set ylabel "slope of the heap, degrees"
set yrange [0:60]
set xrange [-0.01:0.32]
set xtics 0.1
set key top left reverse Left
set arrow 1 from graph 0, first 15 to graph 1, first 15 nohead ls 9
set label 1 "15: discs (Deboeuf 2005)" at graph 0.98, first 12.5 right
plot dir . "/rolling-mean.tsv" using 1:2:3 with yerrorlines ls 1 title "rolling friction"
unset label 1
set xlabel "Bond number"
unset ylabel
set xrange [-1:32]
set xtics 10
plot dir . "/cohesion-mean.tsv" using 1:2:3 with yerrorlines ls 2 title "cohesion", \
     dir . "/lumps.tsv" using 1:(3) with points ls 9 pt 4 dt 1 title (system("cat lumps.tsv") eq "" ? "" : "some heaps are one lump")
unset multiplot
