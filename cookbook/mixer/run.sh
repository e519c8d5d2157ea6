#!/usr/bin/env bash
# Writes a blade as STL, runs the mixer, and prints Lacey's index in time.
set -euo pipefail
# a thin box of 12 triangles: 90 mm along x, 4 mm across, 30 mm high
awk 'BEGIN {
    x[0] = -0.045; x[1] = 0.045; y[0] = -0.002; y[1] = 0.002; z[0] = 0.002; z[1] = 0.032
    n = split("0 2 1 1 2 3 4 5 6 5 7 6 0 1 4 1 5 4 2 6 3 3 6 7 0 4 2 2 4 6 1 3 5 3 7 5", c, " ")
    print "solid blade"
    for (i = 1; i <= n; i++) {
        if (i % 3 == 1) print "facet normal 0 0 0\nouter loop"
        print "vertex", x[c[i] % 2], y[int(c[i] / 2) % 2], z[int(c[i] / 4)]
        if (i % 3 == 0) print "endloop\nendfacet"
    }
    print "endsolid blade"
}' >blade.stl
nsd-gen scene.json | nsd-step --until "${UNTIL:-0.9}" --every 0.1s -o mixer.h5
nsd-view -c material --solid blade mixer.h5 >mixer.png
nsd-stat -m mixing --tracer red --sample 0.02 --tsv mixer.h5 | cut -f 2,3,4,8,10
