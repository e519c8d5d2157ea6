#!/bin/bash
# problems.sh: every FCLIB problem of ../shared/problems by Gauss-Seidel with the exact local method,
# to 1e-4, 1e-8 and 1e-12 of the scale-free natural map. The errors are nsd-err's, from the problem
# and r alone; the solver's word is not taken. Leaves bench/results/MACHINE/problems-exact.{tsv,md}.
set -euo pipefail
cd "$(dirname "$0")/.."
problems=../shared/problems
if [ ! -d "$problems" ]; then
    echo "problems.sh: no $problems, skipped"
    exit 0
fi
source bench/common.sh

# One problem: a line of the TSV
one() {
    local file=$1 name form line eps
    name=$(basename "$file" .hdf5)
    for eps in 1e-4 1e-8 1e-12; do
        nsd-solve -m exact --max-sweeps 20000 --tolerance "$eps" --criterion natural \
            --log "$work/$$.log" "$file" > "$work/$$.h5" 2> /dev/null
        nsd-err "$work/$$.h5" > "$work/$$.err"
        if [ "$eps" = 1e-4 ]; then
            form=$(nsd-info "$work/$$.h5" |
                jq -r 'select(.form) | [.form, .dim, .contacts, .blocks] | @tsv')
            line=$name$'\t'$form
        fi
        line+=$'\t'$(jq -rn --slurpfile log "$work/$$.log" --slurpfile err "$work/$$.err" \
            '[$log[0].sweeps, $err[0].natural, $err[0].natural_siconos, $log[0].seconds] | @tsv' |
            awk -F'\t' '{ printf "%d\t%.2e\t%.2e\t%.2g", $1, $2, $3, $4 }')
    done
    printf '%s\t%d\n' "$line" "$(jq .gave_up "$work/$$.log")"
}
export -f one

# How many of the rows reached each tolerance
totals() {
    awk -F'\t' '{ for (k = 0; k < 3; k++) good[k] += $(7 + 4 * k) <= 10 ^ -(4 + 4 * k) }
        END { for (k = 0; k < 3; k++) printf "reached 1e-%d: %d of %d\n", 4 + 4 * k, good[k], NR }' "$1"
}

# For people: sweeps, or what was reached instead
readable() {
    awk -F'\t' -v OFS='\t' '
        BEGIN { print "problem", "form", "dim", "contacts", "sweeps to 1e-4", "to 1e-8", "to 1e-12",
                      "natural error", "Siconos'\'' error", "seconds" }
        { for (k = 0; k < 3; k++)
              s[k] = $(7 + 4 * k) <= 10 ^ -(4 + 4 * k) ? $(6 + 4 * k) : "not in " $(6 + 4 * k)
          print $1, $2, $3, $4, s[0], s[1], s[2], $15, $16, $17 }' "$1" |
        markdown
}

# shellcheck disable=SC2016 # "$1" is the inner bash's
printf '%s\n' "$problems"/*.hdf5 "$problems"/global/*.hdf5 |
    xargs -P 2 -I{} bash -c 'one "$1"' one {} |
    LC_ALL=C sort > "$work/rows"

mkdir -p "$results"
{
    echo "# $(machine)"
    totals "$work/rows" | sed 's/^/# /'
    printf 'problem\tform\tdim\tcontacts\tblocks'
    for eps in 1e-4 1e-8 1e-12; do
        printf '\tsweeps_%s\tnatural_%s\tsiconos_%s\tseconds_%s' "$eps" "$eps" "$eps" "$eps"
    done
    printf '\tgave_up\n'
    cat "$work/rows"
} > "$results/problems-exact.tsv"
{
    echo "# FCLIB problems by Gauss-Seidel, exact local method"
    echo
    echo "nsd-solve -m exact --max-sweeps 20000 --criterion natural, a run a tolerance, one thread, two"
    echo "runs at a time, on $(machine)."
    echo "Errors as nsd-err recomputes them, of the run to 1e-12: |r - P(r - rho_a u^)| / |r| with"
    echo "rho_a = 1/lambda_max(W_aa), and Siconos' |r - P(r - u^)| / |q|. Seconds of CPU, of that run."
    echo
    totals "$work/rows" | sed 's/^/- /'
    echo
    readable "$work/rows"
} > "$results/problems-exact.md"
totals "$work/rows"
