#!/usr/bin/env bash
set -euo pipefail
grain=${GRAIN:-2.8} dt=${DT:-4e-4} surfaces=${SURFACES:-} # the powder itself: GRAIN=1 DT=2e-4 SURFACES=FOLDER, where FOLDER has the STL files
read -ra step <<<"${STEP---small-steps 0.03}" # options of nsd-step
jq -n -f scene.jq --argjson grain "$grain" --argjson dt "$dt" --arg surfaces "$surfaces" | nsd-gen - |
    nsd-step "${step[@]}" --until "${UNTIL:-0.52}" --every 0.1s -o beaker.h5
nsd-view -c height --walls lines beaker.h5 >beaker.png
# what is left in the beaker over its volume
nsd-info -b --last beaker.h5 | jq -rs 'map(select(.position[2] > 0)) | [length, (map(.mass) | add) / (3.14159265 * 4e-4 * 0.055)] | @tsv' | tee density.tsv
