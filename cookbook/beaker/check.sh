#!/usr/bin/env bash
awk '{ exit !($1 > 700 && $2 > 700 && $2 < 900) }' density.tsv && [ -s beaker.png ]
