set multiplot layout 1,2
set xlabel "orifice, mm"
set ylabel "W^{2/5}, (kg/s)^{2/5}"
plot dir . "/flow.tsv" using (1000*$1):($2**0.4) skip 1 with points ls 1 title "flat floor", \
     dir . "/hopper.tsv" using (1000*$1):($2**0.4) with points ls 2 title "hopper, 30 degrees"
set xlabel "depth, mm"
set ylabel "vertical stress, Pa"
plot dir . "/stress.tsv" using (1000*$1):2 with points ls 3 title "slender fill", \
     2500*0.58*9.81*x/1000 with lines ls 9 title "its weight"
unset multiplot
