#!/usr/bin/env bash
awk '{ exit !($1 > 700 && $2 > 760 && $2 < 880) }' density.tsv && [ -s beaker.png ]
