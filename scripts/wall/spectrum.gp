# spectrum.gp: out, sizes: the eigenvalues nearest to -1e-4
set terminal svg size 900,330 font "sans,12" background "white"
set output out . "/spectrum.svg"
set multiplot layout 1, words(sizes)
set grid lc rgb "#dddddd"
set xzeroaxis lc rgb "#888888"
set arrow from 0, graph 0 to 0, graph 1 nohead lc rgb "#888888"
set xlabel "10^4 real part"
set ylabel "10^4 imaginary part"
unset key
set xtics rotate by -45
do for [i = 1:words(sizes)] {
    set title word(sizes, i) . " balls"
    plot out . "/spectrum.tsv" index i - 1 using (1e4 * $1):(1e4 * $2) with points pt 7 ps 0.4 lc rgb "#0060ad", \
         "" index i - 1 using ($1 < -1e-6 ? 1e4 * $1 : NaN):(1e4 * $2) with points pt 7 ps 0.6 lc rgb "#c00000"
}
