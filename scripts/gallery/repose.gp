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
# a heap that is one lump has no slope: its Bond number is marked at the axis
lumps = system("sort -g lumps.tsv | sed 's/ .*//;q'")
if (lumps ne "") {
    set object 1 rectangle from lumps + 0, graph 0 to 32, graph 1 behind fs solid noborder fc rgb "#eeeeee"
    set label 2 "some heaps:\none lump,\nno slope" at lumps + 1, graph 0.5 left tc rgb "#666666"
}
plot dir . "/cohesion-mean.tsv" using 1:2:3 with yerrorlines ls 1 title "cohesion"
unset multiplot
