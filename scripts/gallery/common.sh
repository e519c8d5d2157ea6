#!/usr/bin/env bash
# What the experiments of the gallery share: . common.sh, in one whose only operand is the folder that it makes
# [scripts/gallery.mk]. In the environment:
#   QUICK=1          in seconds, with fewer grains
#   CODE=reference   the experiment by the independent code, bench/reference, from the same starts, with the same measures
#   PART=NAME        only this part of an experiment that has parts; the rows of the others keep their values
#   SEEDS="1 2 3"    other random numbers
set -euo pipefail

P=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
name=$(basename "$0" .sh)
CODE=${CODE:-nsd}
mkdir -p "$1"
out=$(cd "$1" && pwd)

# pick QUICK FULL: one of them
pick() { if [ -n "${QUICK:-}" ]; then echo "$1"; else echo "$2"; fi; }
# part NAME: whether this part is run
part() { [ -z "${PART:-}" ] || [ "$PART" = "$1" ]; }
# by NAME: whether this code runs
by() { [ "$CODE" = "$1" ]; }
# of NAME: a value of the experiment's table, of reference if the independent code runs
of() { jq -r "if \"$CODE\" == \"reference\" then .reference.$1? else .$1 end // empty" "$P/$name.json"; }

# seeds of the random numbers, one run for each
# shellcheck disable=SC2034 # of the experiments
read -ra seeds <<<"${SEEDS:-$(pick 1 "$(of seeds | grep . || echo '1 2 3')")}"

# scene NAME [jq's arguments]: scenes/NAME.json as a filter changes it. Relative names start at the folder.
scene()
{
    local file=$P/../../scenes/$1.json
    shift
    jq "$@" "$file"
}

# Options of nsd-step that the table has, and -e -k, which account for each step
read -ra options <<<"$(jq -r '.options // ""' "$P/$name.json")"
# Status 1: a step failed. The frames that there are are used, and account.tsv has what failed; an experiment that
# needs a later frame fails in its measure.
nsd-step() { command nsd-step -e -k "${options[@]}" "$@" || [ $? = 1 ]; }

# start FILE.h5 [arguments of nsd-step]: what comes in makes steps of nsd, whichever code the experiment is run by, and the
# trajectory is in the folder. What it says goes to FILE.log, and is shown where it fails.
start()
{
    local file=$out/$1
    shift
    nsd-step "$@" -o "$file" 2>"${file%.h5}.log" || { cat "${file%.h5}.log" >&2; return 1; }
}

# soft: dem or liggghts, the entry of the table that has the parameters of the independent code: dem.c, or LIGGGHTS for tubes.
# An experiment that has both chooses for a part of it.
soft=$(jq -r 'if .reference.dem? or (.reference.liggghts? | not) then "dem" else "liggghts" end' "$P/$name.json")
# settings PREFIX: these parameters, PREFIX before each
settings() { jq -r --arg before "$1" --arg soft "$soft" '.reference[$soft] | to_entries | map("\($before)\(.key)=\(.value)") | join(" ")' "$P/$name.json"; }

# step FILE.h5 [arguments of nsd-step]: the same by the code of the experiment, and account.tsv gets a row: the deepest overlap
# in radii, steps that did not converge, steps
step()
{
    local file=$out/$1 log=$out/${1%.h5}.log arguments
    if by nsd; then
        start "$@"
        sed -n 's/.*: \([0-9]*\) steps, .*/steps \1/p; s/.*worst: overlap \([^ ]*\) .* \([0-9]*\) steps not converged.*/\1 \2/p' "$log" |
            awk '/^steps/ { n = $2; next } { print $1, $2, n }' >>"$out/account.tsv"
        return
    fi
    shift
    read -ra arguments <<<"$(settings '--set ')"
    "$P/../../bench/reference/$(if [ "$soft" = dem ]; then echo run.py; else echo run_liggghts.py; fi)" -o "$file" "${arguments[@]}" "$@" 2>"$log" || { cat "$log" >&2; return 1; }
    sed -n 's/.*ov\/r //p; s/^steps \([0-9]*\).*/steps \1/p' "$log" | awk '/^steps/ { n = $2; next } $1 > max { max = $1 } END { print max + 0, 0, n }' >>"$out/account.tsv"
}

# stresses FILE.h5: rows of nsd-stat -m stress,fraction,coordination; of the independent code those that it has made itself
stresses()
{
    if by reference; then cat "$out/$1.rows"; else nsd-stat -m stress,fraction,coordination "$out/$1"; fi
}

# events FILE.h5: the lines of nsd-info --events; of LIGGGHTS those that run_liggghts.py has made
events() { if by reference; then cat "$out/$1.events"; else nsd-info --events "$out/$1"; fi; }

# on FILE.json FILE.h5 [jq's arguments]: a scene that goes on from the trajectory, as a filter changes it
on() { nsd-info --scene "$out/$1" | jq "${@:2}" >"$out/on.json"; nsd-gen "$out/on.json"; }

# inside RADIUS: a table of the balls of what comes in that lie inside a cylinder about the z axis
inside()
{
    nsd-info -b | jq -r --argjson r "$1" 'select((.position[0] * .position[0] + .position[1] * .position[1] | sqrt) + .radius < $r) | [.position[], .radius] | map(tostring) | join(" ")'
}

# front FILE.h5 D: the right-most point of the largest group of discs between which no gap is wider than 0.05 D
front()
{
    nsd-info --last -b "$out/$1" | jq -r '"\(.position[0]) \(.position[1]) \(.radius)"' | awk -v d="$2" '
        function root(i) { while (up[i] != i) i = up[i] = up[up[i]]; return i }
        { x[NR] = $1; y[NR] = $2; r[NR] = $3; up[NR] = NR; c = int($1 / d / 1.3) " " int($2 / d / 1.3); cell[c] = cell[c] " " NR }
        END {
            for (i = 1; i <= NR; i++)
                for (p = -1; p <= 1; p++) for (q = -1; q <= 1; q++) {
                    n = split(cell[(int(x[i] / d / 1.3) + p) " " (int(y[i] / d / 1.3) + q)], near, " ")
                    for (k = 1; k <= n; k++) {
                        j = near[k]
                        if (j > i && sqrt((x[i] - x[j]) ^ 2 + (y[i] - y[j]) ^ 2) < r[i] + r[j] + 0.05 * d) up[root(i)] = root(j)
                    }
                }
            for (i = 1; i <= NR; i++) if (++n_of[root(i)] > n_of[most]) most = root(i)
            for (i = 1; i <= NR; i++) if (root(i) == most && x[i] + r[i] > front) front = x[i] + r[i]
            print front }'
}

# with FILTER [jq's arguments]: jq with the functions of rows.jq
with() { jq -L "$P" "include \"rows\"; $1" "${@:2}"; }

# angle FILE.h5: degrees, of the surface, a mean over the last half of the frames
angle() { nsd-stat -m surface "$out/$1" | jq -s '.[length / 2 | floor:] | map(.surface.angle | fabs) | add / length'; }

# The picture of nsd's run
picture() { by reference || nsd-view -o "$out/picture.png" "$@"; }

# The curve, by NAME.gp, from the tables in the folder. Of the independent code tables are kept as reference-*.tsv, and drawn, too
curve()
{
    by reference || (cd "$out" && gnuplot -e "dir = '${out//\'/\'\'}'; quick = ${QUICK:+1}${QUICK:-0}" "$P/style.gp" "$P/$name.gp")
}

# results: findings come in, of row() [rows.jq]; result.json goes out, with the seconds of CPU and the account of the steps.
# A full run has one for each row of the table.
results()
{
    local cpu
    cpu=$(awk '{ print ($14 + $15 + $16 + $17) / 100 }' "/proc/$$/stat")
    [ -f "$out/account.tsv" ] || : >"$out/account.tsv"
    jq -s -L "$P" --arg name "$name" --arg code "$CODE" --arg part "${PART:-}" --argjson quick "$(pick true false)" --argjson cpu "$cpu" --arg options "$(if by nsd; then echo "${options[*]}"; else echo "$(settings '')$([ "$soft" = dem ] || echo ", LIGGGHTS")"; fi)" \
        --argjson table "$(jq .rows "$P/$name.json")" --rawfile account "$out/account.tsv" '
        include "rows"; (($table | map(.key)) - map(.key)) as $lacks | ((map(.key)) - ($table | map(.key))) as $more |
        if $more != [] then error("no row of the table: " + ($more | join(", ")))
        elif $quick or $part != "" or $code != "nsd" or $lacks == [] then {name: $name, code: $code, quick: $quick,
            runs: [{part: (if $part == "" then null else $part end), options: $options, cpu: ($cpu | digits(3)), account: ($account | numbers |
                if . == [] then null else {overlap: (map(.[0]) | max | digits(2)), unconverged: (map(.[1]) | add), steps: (map(.[2]) | add)} end)}], rows: .}
        else error("nothing was found for " + ($lacks | join(", "))) end' >"$out/result.json"
}
