#!/usr/bin/env bash
# measure.sh UNTIL DT [OPTION ...] <SCENE: the areas, mm2, in which the drum of a scene and the photographs at 15 and 45 turns a minute differ:
# means of those of the last 0.2 s and of the 0.2 s before them; OPTION: of nsd-step
set -euo pipefail
scene=$(cat) until=$1 dt=$2 drum=${NSD_FIT_WORK:-.}/drum.h5
for rpm in 15 45; do
    jq --argjson w "$(jq -n "$rpm * 0.104719755")" '.walls[].drives[].speed = $w' <<<"$scene" | nsd-gen - 2>/dev/null |
        nsd-step "${@:3}" --until "$until" --every 0.01s -j 1 -o "$drum" 2>/dev/null
    for end in "$until" "$(jq -n "$until - 0.2")"; do
        nsd-stat -m silhouette -s "$(jq -nr "[$end - 0.205, $end + 0.001] | map(. / $dt | round) | join(\":\")")" \
            --window -0.042,0.042,-0.042,0.042 --radius 0.0325332 --photo photo-$rpm.png "$drum" | tail -n 1
    done | jq -s --arg k rpm$rpm '{ ($k): (map(.silhouette.differ) | add / length * 1e6) }'
done | jq -sc add
