#!/usr/bin/env bash
# measure.sh <SCENE: what a drum is measured by, as an object: slope (degrees), solid fraction, share of rotation in the energy of motion
set -euo pipefail
nsd-gen - 2>/dev/null | nsd-step --until 0.9 --every 0.03s -j 1 2>/dev/null | nsd-stat -m surface,energy,fraction |
    jq -sc 'def mean: add / length; .[10:] | { slope: (map(.surface.angle) | mean), fraction: (map(.fraction.fraction) | mean),
        spin: ((map(.energy.rotation) | mean) / (map(.energy.kinetic) | mean) | log) }'
