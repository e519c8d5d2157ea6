#!/usr/bin/env bash
# refine.sh MU MU_R COUNT: continues the drums of run.sh, drum-15.h5 and drum-45.h5, for SPAN s with these frictions and with more grains, up to
# COUNT of the powder's size, that fall onto the slope; and writes the areas, mm2, in which the last 0.2 s and the photographs differ. A new start
# takes twice as long. The drums are left in refined-15.h5 and refined-45.h5, from which FROM=refined continues. GRAIN, DT and STEP are those of run.sh.
set -euo pipefail
grain=${GRAIN:-2.4} dt=${DT:-1e-3} span=${SPAN:-0.4}
read -ra step <<<"${STEP---small-steps 0.03}"
for rpm in 15 45; do
    nsd-cat --last -o "start-$rpm.h5" "${FROM:-drum}-$rpm.h5"
    there=$(nsd-info "start-$rpm.h5" | jq -s '.[-1].bodies')
    jq -n -f scene.jq --argjson grain "$grain" --argjson dt "$dt" --argjson rpm $rpm --argjson count "$3" --argjson mu "$1" --argjson mu_r_ratio "$2" |
        jq --arg start "start-$rpm.h5" --argjson there "$there" '.allow_overlap = true | (.bodies[0].random.count -= $there) |
            .bodies[0].box = { x: [0.006, 0.028], y: [0, 0.02], z: [0.002, 0.026] } |
            .bodies = [{ document: $start }] + (.bodies | map(select(.random.count > 0)))' >"refined-$rpm.json"
    nsd-gen "refined-$rpm.json" | nsd-step "${step[@]}" --until "$span" --every 0.01s -j 1 -o "refined-$rpm.h5"
    nsd-stat -m silhouette -s "$(jq -n "($span - 0.205) / $dt | round")": --window -0.042,0.042,-0.042,0.042 --radius 0.0325332 \
        --photo "photo-$rpm.png" --silhouette "refined-$rpm.png" "refined-$rpm.h5" | tail -n 1 |
        jq -r --argjson rpm $rpm '.silhouette | [$rpm, (.area, .photo, .differ, .surplus, .missing | . * 1e6)] | @tsv'
done
