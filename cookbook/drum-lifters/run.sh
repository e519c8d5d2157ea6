#!/usr/bin/env bash
# Turns the drum, draws the end, and prints angle and temperature in time.
set -euo pipefail
nsd-gen scene.json | nsd-step --until "${UNTIL:-1.5}" --every 0.25s -o drum.h5
nsd-view drum.h5 >drum.png
nsd-stat -m surface,temperature drum.h5 | jq -r '[.time, .surface.angle, .temperature.temperature] | @tsv'
