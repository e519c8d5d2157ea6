#!/usr/bin/env bash
awk '{ run[$1] = $2; high[$1] = $3 } END { exit !(run["dry"] > 30 && run["wet"] < run["dry"] / 2 && high["wet"] > 1.3 * high["dry"]) }' runout.tsv
