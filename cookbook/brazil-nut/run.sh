#!/usr/bin/env bash
# Shakes the box with rough and with smooth side walls, side by side, and prints the height of the large disc in time.
set -euo pipefail
for mu in 0.8 0; do
    jq --argjson mu "$mu" '.pairs[].mu = $mu' scene.json | nsd-gen - |
        nsd-step -j 1 --overlap-rule gap --until "${UNTIL:-9}" --every 0.07s -o "nut-$mu.h5" &
done
wait
nsd-view -s 1120 -c material nut-0.8.h5 >start.png
nsd-view -c material nut-0.8.h5 >end.png
heights() { nsd-info -b --only large "$1" | jq -r 'select(.position) | [.step * 2.5e-4, .position[1] / 4e-3] | @tsv'; }
# each second, the mean of a second: seconds, rough walls, smooth walls
join -t $'\t' <(heights nut-0.8.h5 | sort) <(heights nut-0.h5 | sort) | sort -n |
    awk '{ t = int($1); n[t]++; a[t] += $2; b[t] += $3; if (t > last) last = t }
        END { for (t = 0; t <= last; t++) if (n[t] > 5) printf "%d\t%.1f\t%.1f\n", t, a[t] / n[t], b[t] / n[t] }' | tee height.tsv
