#!/usr/bin/env bash
set -euo pipefail
nsd-gen scene.json | nsd-step --until 0.4 --every 0.4s -o settled.h5
for tilt in 10 35; do
    nsd-info --scene settled.h5 |
        jq --argjson a "$tilt" '($a / 57.2957795) as $a | .gravity = [9.81 * ($a | sin), -9.81 * ($a | cos)]' |
        nsd-gen - | nsd-step --until 0.9 --every 0.1s -o "tilted-$tilt.h5"
    nsd-view -c speed "tilted-$tilt.h5" >"tilted-$tilt.png"
    nsd-info --last -b "tilted-$tilt.h5" | jq -rs --arg a "$tilt" 'map(select(.position[1] > 0.006).velocity[0]) | [$a, add / length] | @tsv'
done | tee speed.tsv
