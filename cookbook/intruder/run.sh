#!/usr/bin/env bash
# Lets the bed settle while the disc falls, draws the end, and prints the step, height and velocity of the disc.
set -euo pipefail
nsd-gen scene.json | nsd-step --until "${UNTIL:-0.7}" --every 0.02s -o intruder.h5
nsd-view intruder.h5 >intruder.png
nsd-info -b intruder.h5 | jq -r 'select(.id == 0) | [.step, .position[1], .velocity[1]] | @tsv'
