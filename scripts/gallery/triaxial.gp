set multiplot layout 1,2
set xlabel "strain"
set key bottom right noreverse Right
set ylabel "sin of the mobilised friction angle"
set yrange [0:0.7]
set xtics 0.1
set key top right
plot dir . "/discs-dense.tsv" using 1:2 skip 1 with lines ls 1 title "discs, dense", \
     dir . "/discs-loose.tsv" using 1:2 skip 1 with lines ls 2 title "discs, loose", \
     for [k = 0 : (quick ? -1 : 0)] dir . "/balls-dense.tsv" using 1:2 skip 1 with lines ls 3 title "balls, dense", \
     for [k = 0 : (quick ? -1 : 0)] dir . "/balls-loose.tsv" using 1:2 skip 1 with lines ls 4 title "balls, loose"
set ylabel "solid fraction"
set yrange [*:*]
plot dir . "/discs-dense.tsv" using 1:3 skip 1 with lines ls 1 notitle, \
     dir . "/discs-loose.tsv" using 1:3 skip 1 with lines ls 2 notitle, \
     for [k = 0 : (quick ? -1 : 0)] dir . "/balls-dense.tsv" using 1:3 skip 1 with lines ls 3 notitle, \
     for [k = 0 : (quick ? -1 : 0)] dir . "/balls-loose.tsv" using 1:3 skip 1 with lines ls 4 notitle
unset multiplot
