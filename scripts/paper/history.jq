# The sweeps of a solve, slurped, as a table to plot: all of the first 100, then 200 of the rest.

(length / 200 | ceil) as $k
| .[] | select(.sweep <= 100 or .sweep % $k == 0)
| [.sweep, .motion, .proj, .bipotential, .penetration, .eps_glob] | @tsv
