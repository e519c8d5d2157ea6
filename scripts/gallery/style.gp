# style.gp: how the curves of the gallery look. dir: the folder of an experiment; quick: 1 or 0
set terminal pngcairo size 900,640 font "DejaVu Sans,13" linewidth 1.4
set output dir . "/curve.png"
set border 3
set tics nomirror out
set key left top reverse Left samplen 2
set style line 1 lc rgb "#1f4e79" pt 7 ps 1.1
set style line 2 lc rgb "#c05a1a" pt 5 ps 1.1
set style line 3 lc rgb "#4a7d3a" pt 9 ps 1.2
set style line 4 lc rgb "#7a4a8a" pt 11 ps 1.2
set style line 9 lc rgb "#888888" dt 2
