# The mean over seeds of what table.sh has written, against mu, with its spread
set terminal pngcairo size 800, 500 font ",11"
set output picture
set xlabel "friction coefficient mu"
set ylabel "volume fraction"
set key off
set grid
set offsets graph 0.05, graph 0.05, graph 0.05, graph 0.05
plot table using 1:3 skip 1 with points pt 6 ps 1.2 lc "gray50", \
     "" using 1:3 skip 1 smooth unique with linespoints pt 7 lc "black"
