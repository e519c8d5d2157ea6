set multiplot layout 1,2
set xlabel "friction coefficient"
set logscale x
set xrange [0.0015:2.5]
set xtics ("0" 0.002, "0.01" 0.01, "0.1" 0.1, "1" 1)
set key bottom left
at(mu) = mu > 0 ? mu : 0.002
# grey: the limits of isostatic packings, of the frictionless and of the very rough one
set ylabel "contacts of a ball, without rattlers"
set yrange [3.5:6.5]
set label 1 "2 d = 6" at 2.4, 6.1 right tc rgb "#666666"
set label 2 "d + 1 = 4" at 0.0017, 4.1 left tc rgb "#666666"
plot 6 with lines ls 9 notitle, 4 with lines ls 9 notitle, \
     dir . "/means.tsv" using (at($1)):2:3 with yerrorlines ls 1 title "nsd", \
     "+" using (0.3):(4.5) every ::0::0 with points ls 3 ps 1.8 title "Agnolin and Roux"
set ylabel "solid fraction"
set yrange [0.53:0.66]
set label 1 "0.639" at 2.4, 0.6435 right tc rgb "#666666"
set label 2 "0.55" at 0.0017, 0.5545 left tc rgb "#666666"
plot 0.639 with lines ls 9 notitle, 0.55 with lines ls 9 notitle, \
     dir . "/means.tsv" using (at($1)):4:5 with yerrorlines ls 1 notitle, \
     "+" using (0.3):(0.593) every ::0::0 with points ls 3 ps 1.8 notitle
unset multiplot
