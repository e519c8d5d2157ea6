#!/usr/bin/env bash
set -euo pipefail
# the instrument itself: GRAIN=1 DT=1e-4 FILL=80 TIP=0.1 SURFACES=FOLDER, where FOLDER has the STL files
grain=${GRAIN:-3.4} dt=${DT:-2.5e-4} fill=${FILL:-20} tip=${TIP:-0.5} surfaces=${SURFACES:-}
read -ra step <<<"${STEP---small-steps 0 --stiffness 5e3}" # options of nsd-step
scene() { jq -n -f scene.jq --argjson grain "$grain" --argjson dt "$dt" --argjson fill "$fill" --argjson tip "$tip" --arg surfaces "$surfaces" --arg settled "$1"; }
scene "" | nsd-gen - | nsd-step "${step[@]}" --until "${SETTLE:-0.15}" --every 1s -o settled.h5
scene settled.h5 >rheometer.json
last=$(jq '[.walls[].drives[0].until // 0] | max' rheometer.json)
nsd-gen rheometer.json | nsd-step "${step[@]}" --wall-loads --until "$last" --every 0.02s -o rheometer.h5
nsd-view -c speed --walls lines --solid blade --clip 0,1,0,0 rheometer.h5 >rheometer.png
# depth to which the blade has descended, mm; its torque, N mm, and the force on it, N; the work done by it so far, mJ
nsd-stat -m wall_loads_by_name rheometer.h5 | jq -rn --argjson v "$tip" 'foreach (inputs | select(.wall_loads_by_name.span[0])) as $f (0;
    . - 1000 * ($f.wall_loads_by_name | .span[0] * .power[(.name | index("blade"))]);
    ($f.wall_loads_by_name.name | index("blade")) as $k | [$f.time * $v * 87.2, -1000 * $f.wall_loads_by_name.torque[$k][2],
        $f.wall_loads_by_name.force[$k][2], .]) | @tsv' | tee energy.tsv
