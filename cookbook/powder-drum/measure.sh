#!/usr/bin/env bash
# measure.sh UNTIL DT <SCENE: the areas, mm2, in which the drum of a scene and the photographs at 15 and 45 turns a minute differ
set -euo pipefail
scene=$(cat)
for rpm in 15 45; do
    jq --argjson w "$(jq -n "$rpm * 0.104719755")" '.walls[].drives[].speed = $w' <<<"$scene" | nsd-gen - 2>/dev/null |
        nsd-step --until "$1" --every 0.01s -j 1 2>/dev/null |
        nsd-stat -m silhouette -s "$(jq -n "($1 - 0.205) / $2 | round")": --window -0.042,0.042,-0.042,0.042 --radius 0.0325332 --photo photo-$rpm.png |
        tail -n 1 | jq --arg k rpm$rpm '{ ($k): (.silhouette.differ * 1e6) }'
done | jq -sc add
