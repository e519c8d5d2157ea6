#!/usr/bin/env bash
set -euo pipefail
nsd-gen scene.json | nsd-step --until "${UNTIL:-0.4}" --every 0.4s -o bed.h5
while read -r tilt mu; do
    run=tilt-$tilt-mu-$mu
    # gravity turns instead of the box; the time is that of the bed's last frame
    nsd-info --scene bed.h5 | jq --argjson tilt "$tilt" --argjson mu "$mu" '($tilt * 3.14159265 / 180) as $a |
        .gravity = [9.81 * ($a | sin), -9.81 * ($a | cos)] | .mu = $mu | .bodies[0].at_rest = true' | nsd-gen - >"$run-start.h5"
    nsd-step -n 2000 --every 100 -o "$run.h5" "$run-start.h5"
    nsd-stat -m displacement,temperature "$run-start.h5" "$run.h5" | jq -rs --arg t "$tilt" --arg m "$mu" '.[-1] |
        [$t, $m, (.displacement.msd | sqrt * 1e5 | round / 100), (.temperature.velocity | map(. * .) | add | sqrt * 1e5 | round / 100)] | @tsv'
done <<'END' | tee tilted.tsv
15 0.5
30 0.5
30 0.25
END
nsd-view -c speed tilt-30-mu-0.25.h5 >tilted.png
