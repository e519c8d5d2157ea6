#!/usr/bin/env bash
set -euo pipefail
# the instrument itself: GRAIN=1 DT=3e-4 TUBE=23.7 ORIFICES="10 14 20" SURFACES=FOLDER, where FOLDER has the STL files
grain=${GRAIN:-1.8} dt=${DT:-6e-4} tube=${TUBE:-13} surfaces=${SURFACES:-} orifices=${ORIFICES:-15.5 18 20.5}
read -ra step <<<"${STEP---small-steps 0.03}" # options of nsd-step
for d in $orifices; do
    jq -n -f scene.jq --argjson grain "$grain" --argjson dt "$dt" --argjson orifice "$d" --argjson tube "$tube" --arg surfaces "$surfaces" |
        nsd-gen - | nsd-step "${step[@]}" --until "${UNTIL:-0.55}" --every 0.01s -o "flow-$d.h5"
    # the rate: the line through the mass that has left, from 10 to 60 % of it
    nsd-info "flow-$d.h5" | jq -rs --argjson d "$d" 'map(select(.step != null)) | map([.time, .removed[0].mass * 1000]) as $m |
        ([$m[][1]] | max) as $most | [$m[] | select(.[1] > 0.1 * $most and .[1] < 0.6 * $most)] |
        (map(.[0]) | add / length) as $t | (map(.[1]) | add / length) as $w |
        [$d, (map((.[0] - $t) * .[1]) | add) / (map(.[0] * (.[0] - $t)) | add)] | @tsv'
done | tee rate.tsv
nsd-view -s "$(jq -n "0.3 / $dt | round")" -c speed --clip 0,1,0,0 --walls lines "flow-${orifices##* }.h5" >funnel-flow.png
# Beverloo: W = C rho sqrt(g) (D - k d)^2.5, a line of W^0.4 against D; rho: bulk density at a fraction of 0.58. And k at his C of 0.58.
awk -v d="$grain" 'BEGIN { d *= 1.22e-3; s = 0.58 * 1580 * sqrt(9.81) }
    { x = $1 / 1000; y = ($2 / 1000) ^ 0.4; n++; sx += x; sy += y; sxx += x * x; sxy += x * y; k += (x - ($2 / 1000 / (0.58 * s)) ^ 0.4) / d }
    END { b = (n * sxy - sx * sy) / (n * sxx - sx * sx)
          printf "C\t%.2f\nk\t%.2f\nk for C = 0.58\t%.2f\n", b ^ 2.5 / s, (sx / n - sy / n / b) / d, k / n }' rate.tsv | tee beverloo.tsv
