set multiplot layout 1,2
set xlabel "Bond number"
set logscale x
# 0 stands at 1 of a logarithmic axis of 1 + Bond number
set xrange [0.8:200]
set xtics ("0" 1, "3" 4, "10" 11, "30" 31, "100" 101)
set object 1 rectangle from 11, graph 0 to 25, graph 1 behind fs solid noborder fc rgb "#eeeeee"
set label 1 "grey: closed\nform of the\nlimit" at 28, graph 0.55 left tc rgb "#666666"
set ylabel "run-out over the width of the column"
set yrange [0:5]
set key top right
plot dir . "/curve.tsv" using (1 + $1):2:3 with yerrorlines ls 1 title "nsd", \
     "< echo 1 3.75" using 1:2 with points ls 3 ps 1.8 title "dry: Staron and Hinch 2005"
unset label 1
set ylabel "height left over the height of the column"
set yrange [0:1.2]
set key bottom right
plot dir . "/curve.tsv" using (1 + $1):4:5 with yerrorlines ls 1 title "nsd"
unset multiplot
