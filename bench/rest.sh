#!/usr/bin/env bash
# rest.sh [STEPS]: what each way against overlap (--overlap-rule) does, as nsd-methods(7) has it: the overlap of a
# column of ten balls over 100 x STEPS steps and of the paper's 500 balls over STEPS [10000], how far these sink,
# the energy gained, the heights of bounces, the seconds. A table on standard output.
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/common.sh

steps=${1:-10000}
jq -n '{ dt: 1e-4, mu: 0.5, bodies: [range(10) | { x: [0, 0, 0.005 * (2 * . + 1)], radius: 0.005 }],
    walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }] }' | nsd-gen - > "$work/column.h5"
nsd-gen 500 > "$work/start.h5"

run() { nsd-step --criterion natural "$@" 2> /dev/null; }
moments() { nsd-info "$1" | jq -c 'select(.step != null)'; }

column() # MODE: the largest overlap of the column, over r, after a hundredth, a tenth and all of the steps
{
    run --overlap-rule "$1" -n $((100 * steps)) --every "$steps" "$work/column.h5" > "$work/a.h5"
    moments "$work/a.h5" |
        jq -r --argjson n "$steps" 'select(.step == ($n, 10 * $n, 100 * $n)) | .max_overlap / 0.005' |
        xargs printf '%.1e\t%.1e\t%.1e'
}

pile() # MODE: that of the pile, over the largest radius, and by how much of its height it sinks in the second half
{
    run --overlap-rule "$1" -w -n "$steps" --every $((steps / 2)) "$work/start.h5" > "$work/a.h5"
    moments "$work/a.h5" | jq -r -s '[.[-1].max_overlap / 5e-4, 1 - .[-1].potential_energy / .[-2].potential_energy] | @tsv' |
        xargs printf '%.1e\t%.1e'
}

rises() # MODE: the steps' gains of energy while the pile falls, added up, over its energy at the start
{
    run --overlap-rule "$1" -w -n 3000 "$work/start.h5" > "$work/a.h5"
    moments "$work/a.h5" | jq -n '[inputs | .kinetic_energy + .potential_energy] as $e |
        [range(1; $e | length) | $e[.] - $e[. - 1] | select(. > 0)] | add / $e[0]' | xargs printf '%.1e'
}

bounces() # MODE E: the third top of a ball that fell 1 m, less what it should be, in per cent of that
{
    jq -n --argjson e "$2" '{ dt: 1e-4, e_n: $e, bodies: [{ x: [0, 0, 1.005], radius: 0.005 }],
        walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }] }' | nsd-gen - |
        run --overlap-rule "$1" -n 24000 --every 5 > "$work/a.h5"
    nsd-info -b "$work/a.h5" | jq 'select(.position) | .position[2] - 0.005' |
        awk -v e="$2" 'NR > 2 && b > a && b >= $1 && ++n == 3 { printf "%+.2f", 100 * (b / e ^ 6 - 1) } { a = b; b = $1 }'
}

seconds() # MODE OPTION: CPU milliseconds of a step of the settled pile, in all
{
    local TIMEFORMAT=%U
    { time run --overlap-rule "$1" "$2" -n 1000 --every 1000 "$work/settled.h5" > "$work/a.h5"; } 2>&1
}

echo "# $(machine)"
echo "# column: 10, r = 5 mm, dt 1e-4 s, cold; pile: example 3, warm, $steps steps; e = 0.5, 0.9: % of the third top; ms a step"
printf 'overlap\tcolumn %d\t%d\t%d\tpile\tsinks\tgains\te 0.5\te 0.9\tms cold\twarm\n' "$steps" $((10 * steps)) $((100 * steps))
for mode in keep gap push project gap-project; do
    printf '%s\t%s\t%s\t' "$mode" "$(column "$mode")" "$(pile "$mode")"
    run --overlap-rule "$mode" -w -n 3000 --every 3000 "$work/start.h5" > "$work/settled.h5"
    printf '%s\t%s\t%s\t' "$(rises "$mode")" "$(bounces "$mode" 0.5)" "$(bounces "$mode" 0.9)"
    printf '%s\t%s\n' "$(seconds "$mode" --cold)" "$(seconds "$mode" --warm)"
done
