#!/usr/bin/env bash
# table.sh RUN.h5 ...: a line for each run: mu, seed, the volume fraction and the angle of the surface (degrees)
# of its last frame.
set -euo pipefail

printf 'mu\tseed\tfraction\tangle\n'
for run in "$@"; do
    name=${run##*/mu-}
    name=${name%.h5}
    mu=${name%-seed-*} seed=${name#*-seed-}
    nsd-stat --last -m fraction,surface "$run" 2> /dev/null |
        jq -r --arg mu "$mu" --arg seed "$seed" '[$mu, $seed, .fraction.fraction, .surface.angle] | @tsv'
done
