set multiplot layout 1,2
set xlabel "friction coefficient"
set logscale x
set xrange [0.0015:2.5]; set yrange [3.8:7]
set xtics ("0" 0.002, "0.01" 0.01, "0.1" 0.1, "1" 1)
set key right top noreverse Right
set ylabel "contacts of a ball, without rattlers"
at(mu) = mu > 0 ? mu : 0.002
plot dir . "/means.tsv" using (at($1)):2:3 with yerrorlines ls 1 title "nsd", \
     "+" using (0.3):(4.5) every ::0::0 with points pt 6 ps 1.6 lc rgb "#888888" title "Agnolin and Roux", \
     6 with lines ls 9 title "2 d = 6, d + 1 = 4", 4 with lines ls 9 notitle
set ylabel "solid fraction"
set yrange [0.53:0.69]
plot dir . "/means.tsv" using (at($1)):4:5 with yerrorlines ls 2 title "nsd", \
     "+" using (0.3):(0.593) every ::0::0 with points pt 6 ps 1.6 lc rgb "#888888" title "Agnolin and Roux", \
     0.639 with lines ls 9 title "0.639 and 0.55", 0.55 with lines ls 9 notitle
unset multiplot
