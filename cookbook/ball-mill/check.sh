#!/usr/bin/env bash
# Grains have broken, ever more of them, and are smaller; mass is that of the start
set -euo pipefail
awk '{ bad += $5 < broken || $7 < dust; broken = $5; dust = $7; if (NR == 1) d = $2 } END { exit !(NR > 10 && !bad && broken > 0.02 && $2 < d) }' mill.tsv
mass() { nsd-info -b "$@" | jq -s 'map(select(.material == "ore").mass) | add'; }
jq -en "($(mass --last mill.h5) + $(tail -n 1 mill.tsv | cut -f 7) / 1e3) / $(mass start.h5) - 1 | fabs < 1e-4"
