#!/usr/bin/env bash
# fit.sh FOLDER [OPTION ...]: calibrates friction, rolling friction and the number of balls on the photographs in FOLDER, by nsd-fit with these
# options. GRAIN, DT, UNTIL and STEP are those of run.sh; LEAST and MOST bound the number of grains of the powder. Continues where it was stopped.
set -euo pipefail
photos=$(cd "$1" && pwd) grain=${GRAIN:-2.4} dt=${DT:-1e-3} until=${UNTIL:-1.1} step=${STEP---small-steps 0.03}
for rpm in 15 45; do
    [ -e "photo-$rpm.png" ] || { gunzip -c "$photos/measured-${rpm}rpm.bmp.gz" >photo.bmp && ffmpeg -nostdin -loglevel error -y -i photo.bmp -pix_fmt rgb24 "photo-$rpm.png"; }
done
jq -n -f scene.jq --argjson grain "$grain" --argjson dt "$dt" --argjson rpm 15 --argjson count 29185 --argjson mu 0.5 --argjson mu_r_ratio 0.3 |
    jq --argjson grain "$grain" --argjson least "${LEAST:-23000}" --argjson most "${MOST:-31000}" --arg measure "bash measure.sh $until $dt $step" \
        '($grain * $grain * $grain) as $g | { scene: ., parameters: { mu: { keys: "mu", range: [0.2, 0.9] },
            mu_r: { keys: "rolling.mu_r_ratio", range: [0.05, 0.5] },
            count: { keys: "bodies[0].random.count", range: [($least / $g | round), ($most / $g | round)], integer: true } },
            command: $measure, targets: { rpm15: { value: 0, error: 20 }, rpm45: { value: 0, error: 20 } } }' >fit.json
nsd-fit "${@:2}" fit.json
