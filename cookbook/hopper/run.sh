#!/usr/bin/env bash
set -euo pipefail
nsd-gen scene.json | nsd-step --wall-loads --until "${UNTIL:-0.5}" --every 0.02s -o hopper.h5
nsd-info hopper.h5 | jq -r 'select(.step != null) | [.time, .removed[0].bodies, .removed[0].mass * 1000] | @tsv' >out.tsv
nsd-view -s 1500 -c speed --plain --solid cylinder,cone --camera 20,15 --clip 0,-1,0,0 --size 560x720 hopper.h5 >hopper.png
nsd-stat --last -m wall_loads_by_name hopper.h5 | jq -r '.wall_loads_by_name |
    ["name", "force_z", "friction", "sliding_work", "wear"], ([.name, (.force | map(.[2])), .friction, .sliding_work, .wear] | transpose[]) | @tsv' |
    sed 's/\t$/\t-/' | tee wear.tsv
