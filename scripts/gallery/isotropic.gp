set multiplot layout 1,2
set xlabel "friction"
set logscale x
set xrange [0.002:20]; set yrange [3.5:6.5]
set xtics ("0" 0.003, "0.01" 0.01, "0.1" 0.1, "1" 1, "10" 10)
set key right top noreverse Right
set ylabel "contacts of a ball, no rattlers"
at(mu) = mu > 0 ? mu : 0.003
plot dir . "/balls.tsv" using (at($1)):2 skip 1 with linespoints ls 1 title "nsd", 6 with lines ls 9 title "2 d", 4 with lines ls 9 title "d + 1"
set ylabel "solid fraction"
set yrange [0.5:0.7]
plot dir . "/balls.tsv" using (at($1)):3 skip 1 with linespoints ls 2 title "nsd", 0.64 with lines ls 9 title "0.64", 0.55 with lines ls 9 title "0.55"
unset multiplot
