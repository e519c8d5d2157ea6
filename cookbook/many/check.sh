#!/usr/bin/env bash
awk -v n="${N:-2000}" '{ exit !($1 == n && $2 > 100 && $3 >= 1 && $4 > 0 && $4 < 100) }' cost.tsv && [ -s many.png ]
