#!/usr/bin/env bash
# What the experiments of the gallery share: . common.sh, in one whose only operand is the folder that it makes
# [scripts/gallery.mk]. QUICK=1 in the environment: in seconds, with fewer grains.
set -euo pipefail

P=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
name=$(basename "$0" .sh)
mkdir -p "$1"
out=$(cd "$1" && pwd)

# pick QUICK FULL: one of them
pick() { if [ -n "${QUICK:-}" ]; then echo "$1"; else echo "$2"; fi; }

# seeds of the random numbers, one run for each; SEEDS in the environment has others
# shellcheck disable=SC2034 # of the experiments
read -ra seeds <<<"${SEEDS:-$(pick 1 '1 2 3')}"

# scene NAME [jq's arguments]: scenes/NAME.json as a filter changes it. Relative names start at the folder.
scene()
{
    local file=$P/../../scenes/$1.json
    shift
    jq "$@" "$file"
}

# Status 1: a step had no solution, or the run ended early. The frames that there are are used; an experiment that needs a later
# one fails in its measure. The figures of docs/gallery are those of one solve per step.
nsd-step() { command nsd-step --small-steps 0 "$@" || [ $? = 1 ]; }

# step FILE.h5 [arguments of nsd-step]: what comes in makes steps, and the trajectory is in the folder. What
# it says goes to FILE.log, and is shown where it fails.
step()
{
    local file=$out/$1
    shift
    nsd-step "$@" -o "$file" 2>"${file%.h5}.log" || { cat "${file%.h5}.log" >&2; return 1; }
}

# on FILE.json FILE.h5 [jq's arguments]: a scene that goes on from the trajectory, as a filter changes it
on() { nsd-info --scene "$out/$1" | jq "${@:2}" >"$out/on.json"; nsd-gen "$out/on.json"; }

# inside RADIUS: a table of the balls of what comes in that lie inside a cylinder about the z axis
inside()
{
    nsd-info -p | jq -r --argjson r "$1" 'select((.x[0] * .x[0] + .x[1] * .x[1] | sqrt) + .radius < $r) | [.x[], .radius] | map(tostring) | join(" ")'
}

# front FILE.h5: of the discs that are connected by contacts to the most others, the right-most point
front()
{
    { nsd-info --last -p "$out/$1" | jq -r '"b \(.id) \(.x[0] + .radius)"'; nsd-info --last -c "$out/$1" | jq -r 'select(.body[0] >= 0) | "c \(.body[0]) \(.body[1])"'; } | awk '
        function root(i) { while (up[i] != i) i = up[i] = up[up[i]]; return i }
        $1 == "b" { x[$2] = $3; up[$2] = $2 }
        $1 == "c" { a = root($2); b = root($3); if (a != b) up[a] = b }
        END { for (i in x) if (++n[root(i)] > n[most]) most = root(i)
            for (i in x) if (root(i) == most && x[i] > front) front = x[i]
            print front }'
}

# with FILTER [jq's arguments]: jq with the functions of rows.jq
with() { jq -L "$P" "include \"rows\"; $1" "${@:2}"; }

# angle FILE.h5: degrees, of the surface, a mean over the last half of the frames
angle() { nsd-stat -m surface "$out/$1" | jq -s '.[length / 2 | floor:] | map(.surface.angle | fabs) | add / length'; }

picture() { nsd-view -o "$out/picture.png" "$@"; }

# The curve, by NAME.gp, from the tables in the folder
curve() { (cd "$out" && gnuplot -e "dir = '${out//\'/\'\'}'; quick = ${QUICK:+1}${QUICK:-0}" "$P/style.gp" "$P/$name.gp"); }

# results: findings come in, of row() [rows.jq]; result.json goes out. A full run has one for each row of the table.
results()
{
    jq -s -L "$P" --arg name "$name" --argjson quick "$(pick true false)" --argjson table "$(jq .rows "$P/$name.json")" '
        include "rows"; (($table | map(.key)) - map(.key)) as $lacks |
        if $quick or $lacks == [] then {name: $name, quick: $quick, rows: judged($table)}
        else error("nothing was found for " + ($lacks | join(", "))) end' >"$out/result.json"
}
