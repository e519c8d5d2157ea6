#!/usr/bin/env bash
set -euo pipefail
nsd-gen scene.json | nsd-step --until "${UNTIL:-1.2}" --every 0.2s -o polyhedra.h5
nsd-view -c height polyhedra.h5 >polyhedra.png
nsd-stat -m fraction,energy --box 0.05,0.35,0.05,0.35,0,0.15 polyhedra.h5 |
    jq -r '[.time, .fraction.fraction, .energy.kinetic] | @tsv' | tee fraction.tsv
