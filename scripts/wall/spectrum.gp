# spectrum.gp: out, sizes: the eigenvalues nearest to -1e-4; those with a negative real part in red
set terminal svg size 1000,400 font "sans,16" background "white"
set output out . "/spectrum.svg"
set multiplot layout 1, words(sizes)
set grid lc rgb "#dddddd"
set xzeroaxis lc rgb "#888888"
set arrow from 0, graph 0 to 0, graph 1 nohead lc rgb "#888888"
set xlabel "real part, 10^{-4}"
set ylabel "imaginary part, 10^{-4}"
unset key
do for [i = 1:words(sizes)] {
    set title word(sizes, i) . " balls"
    # about four labels, so that they do not meet
    stats out . "/spectrum.tsv" index i - 1 using (1e4 * $1) nooutput
    least = STATS_min < 0 ? STATS_min : 0
    span = STATS_max - least
    set xrange [least - 0.05 * span:STATS_max + 0.05 * span]
    step = span > 8 ? 4 : span > 2.5 ? 1 : 0.5
    set xtics step
    plot out . "/spectrum.tsv" index i - 1 using (1e4 * $1):(1e4 * $2) with points pt 7 ps 0.5 lc rgb "#0060ad", \
         "" index i - 1 using ($1 < -1e-6 ? 1e4 * $1 : NaN):(1e4 * $2) with points pt 7 ps 0.8 lc rgb "#c00000"
}
