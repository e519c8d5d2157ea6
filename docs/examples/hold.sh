#!/usr/bin/env bash
# hold.sh: a controller in shell and jq holds a piston of 2 kg at 0.5 m, as a spring and a damper would: F = -m (w^2 (z - 0.5) + 2 w v)
# with w = 10 1/s. Prints where it is after 0.3 s, m, beside 0.5 + 0.5 (1 + w t) exp(-w t).
set -euo pipefail

scene='{ "dt": 1e-3, "gravity": [0, 0, 0],
         "walls": [{ "point": [0, 0, 1], "normal": [0, 0, 1], "load": { "along": [0, 0, 1], "mass": 2 } }] }'
controller='jq -c --unbuffered ".walls[0] | {walls: {\"0\": {
    force: (-2 * (100 * (.position[2] - 0.5) + 20 * .velocity[2]))}}}"'

nsd-gen - <<<"$scene" |
    nsd-step -n 300 --with "$controller" --with-walls all 2>/dev/null |
    nsd-info --last --walls |
    jq -c '{case: "piston", place: (1 + .load.travel), expected: (0.5 + 0.5 * 4 * (-3 | exp))}'
