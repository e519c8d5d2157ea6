#!/usr/bin/env bash
awk '{ f[NR] = $2; e[NR] = $3 } END { exit !(f[NR] > 0.45 && f[NR] < 0.65 && e[NR] < 0.01 * e[3]) }' fraction.tsv && [ -s polyhedra.png ]
