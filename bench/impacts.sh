#!/bin/bash
# impacts.sh: a heavy ball that falls on a light one on a floor, and rows of five equal balls that touch or have gaps: what leaves
# by how fast, by nsd and by soft spheres (reference/dem.c) with dashpots and with plastic loss. The table of nsd-methods(7),
# "Simultaneous impacts", on standard output; seconds.
set -euo pipefail
cd "$(dirname "$0")/.."
source bench/common.sh
cc -O2 -o "$work/dem" bench/reference/dem.c -lm

heavy() # GAP: of a ball of 15.9 mm with 2 m/s above one of 1 mm
{
    jq -n --argjson gap "$1" '{dt: 1e-6, density: 2500, mu: 0, e_n: 0.4, gravity: [0, 0, 0], walls: [{point: [0, 0, 0], normal: [0, 0, 1]}],
        bodies: [{x: [0, 0, 0.001], radius: 0.001}, {x: [0, 0, (0.0179 + $gap)], radius: 0.0159, v: [0, 0, -2]}]}' | nsd-gen -
}
row() # E GAP ORDER: of five balls of 1 mm along x, in this order in the document; the first moves with 1 m/s
{
    jq -n --argjson e "$1" --argjson gap "$2" --argjson order "$3" '{dt: 1e-5, density: 2500, mu: 0, e_n: $e, gravity: [0, 0, 0],
        bodies: [$order[] as $i | {x: [$i * (0.002 + $gap), 0, 0], radius: 0.001, v: [(if $i == 0 then 1 else 0 end), 0, 0]}]}' | nsd-gen -
}
last() { nsd-info --last -b | jq -s "max_by(.position[$1]) | .velocity[$1] * 1000 | round / 1000"; }
by_nsd() { nsd-step --until 4e-3 --every 4e-3s "$@" 2> /dev/null; }
by_dem() { bench/reference/run.py --dem "$work/dem" -o "$work/soft.h5" --until 4e-3 --every 4e-3s --set kn=1e6 "$@" 2> /dev/null && cat "$work/soft.h5"; }

line() # NAME GAP COMMAND...: the heavy ball; rows with e = 1 and 0.9, in two orders
{
    local gap=$2
    printf '%s' "$1"
    printf '\t%s' "$(heavy "$gap" | "${@:3}" | last 2)"
    for e in 1 0.9; do printf '\t%s %s' "$(row $e "$gap" '[0, 1, 2, 3, 4]' | "${@:3}" | last 0)" "$(row $e "$gap" '[2, 0, 4, 1, 3]' | "${@:3}" | last 0)"; done
    echo
}
printf 'code\theavy ball\trow e=1, in two orders\trow e=0.9\n'
line "nsd, small steps" 0 by_nsd
line "nsd, one solve per step" 0 by_nsd --small-steps 0
line "nsd, --stiffness auto" 0 by_nsd --stiffness auto
line "nsd, small steps, 1e6 N/m" 0 by_nsd --stiffness 1e6
line "soft spheres, plastic loss" 0 by_dem --set hyst=1
line "soft spheres, dashpots" 0 by_dem
line "nsd, small steps, gaps" 1e-6 by_nsd
line "nsd, one solve per step, gaps" 1e-6 by_nsd --small-steps 0
# a stiffness that resolves the wave more or less
for dt in 3.2e-6 1e-6 3.2e-7 2.3e-7 1e-7 1e-8; do
    printf 'nsd, 1e6 N/m, k h^2/m = %.2g\t\t%s\n' "$(jq -n "1e6 * $dt * $dt / 1.0472e-5")" \
        "$(row 1 0 '[0, 1, 2, 3, 4]' >"$work/row.h5" && nsd-info --scene "$work/row.h5" | jq ".dt = $dt" | nsd-gen - | nsd-step --small-steps 0 --stiffness 1e6 --until 1e-3 --every 1e-3s 2> /dev/null | last 0)"
done
