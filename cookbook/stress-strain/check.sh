#!/usr/bin/env bash
awk '{ if ($2 > peak) peak = $2; if ($1 > 0.15) { s += $2; n++ } } END { print peak, s / n; exit !(peak > 0.35 && peak < 0.65 && s / n > 0.18 && s / n < 0.35) }' stress-strain.tsv && [ -s stress-strain.png ]
