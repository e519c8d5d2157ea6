set multiplot layout 1,2 margins 0.1,0.98,0.12,0.97 spacing 0.13
frictions = system(sprintf("grep '^#' '%s/load.tsv' | cut -c3-", dir))
set xlabel "depth over the width of the tube"
set ylabel "load, in weights of a layer as deep as wide" offset 1,0
set key top left
set yrange [0:*]
plot x with lines ls 9 dt 3 title "weight", \
     for [k=1:words(frictions)] dir . "/load.tsv" index k-1 using 1:4 with lines ls (k < 5 ? k : 9) dt 2 notitle, \
     for [k=1:words(frictions)] dir . "/load.tsv" index k-1 using 1:2:3 with yerrorbars ls (k < 5 ? k : 9) title "friction ".word(frictions, k)
set xlabel "friction of the wall"
set ylabel "K"
set xrange [0:0.55]
set yrange [0:1.2]
s = sin(21*pi/180)
walker(m) = m < tan(21*pi/180) ? (1 - s*cos(asin(sin(atan(m))/s) - atan(m)))/(1 + s*cos(asin(sin(atan(m))/s) - atan(m))) : (1 - s*s)/(1 + s*s)
plot walker(x) with lines ls 9 title "active state (Walker)", \
     dir . "/k.tsv" using 1:2:3 with yerrorbars ls 1 title "nsd"
unset multiplot
