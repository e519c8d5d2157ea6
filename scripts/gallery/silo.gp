set xlabel "orifice, in diameters of a ball"
set ylabel "W^{2/5}, (kg/s)^{2/5}"
set xrange [0:*]
set yrange [0:*]
rho = system(sprintf("cut -f2 '%s/flow.tsv' | awk '{s += $1} END {print s/NR}'", dir)) + 0
W(x, C, k) = x > k ? (C*rho*sqrt(9.81))**0.4*0.002*(x - k) : NaN
stats dir . "/curve.tsv" index 1 using (a = $1, b = $2, 0) nooutput
plot W(x, 0.58, 1.4) with lines ls 2 title "Beverloo: C 0.58, k 1.4", \
     (a + 0.002*b*x > 0 ? a + 0.002*b*x : NaN) with lines ls 9 title "line through the measured flows", \
     dir . "/curve.tsv" index 0 using ($1/0.002):2:3 with yerrorbars ls 1 title "nsd, flat floor"
