#!/bin/bash
# solvers.sh: every solver over every FCLIB problem, to 1e-4, 1e-8 and 1e-12 of the scale-free natural map:
# nsd's, and Siconos' where it is installed (solvers.py); performance profiles of Dolan and Moré. The errors
# are nsd-err's, from the problem and r alone. Leaves bench/results/MACHINE/solvers.{tsv,md,svg}.
#
#   PROBLEMS=DIR            another folder of problems; leaves solvers-DIR.{tsv,md,svg}
#   ONLY=nsd|siconos        that half; the other as the results have it
#   ONLY=draw               no run: the tables and the .svg again, from the .tsv in the folder RESULTS, of the SOLVERS alone
#   SOLVERS="auto nlgs"     nsd's: of --solver, or sbp, sal, ebp, eal for Gauss-Seidel with that local method
#   LIMIT=10                seconds of a solve
#   FLOOR=1e-4              seconds: what is faster counts as this
#
# What is done is under build/solvers, and not done again but where nsd-solve is newer (Siconos': never).
set -euo pipefail
cd "$(dirname "$0")/.."
problems=${PROBLEMS:-../shared/problems}
problems=${problems%/}
name=solvers${PROBLEMS:+-$(basename "$problems")}
solvers=${SOLVERS:-auto nlgs anderson sbp}
limit=${LIMIT:-10}
if [ ! -d "$problems" ] && [ "${ONLY:-}" != draw ]; then
    echo "solvers.sh: no $problems, skipped"
    exit 0
fi
source bench/common.sh
tools=${NSD_BUILD:-build}
tolerances=(1e-4 1e-8 1e-12)
floor=${FLOOR:-1e-4}
store=build/solvers/$name.$limit
if [ "${ONLY:-}" = draw ]; then results=${RESULTS:-$results}; else mkdir -p "$store/nsd" "$store/siconos" "$results"; fi

# A problem's file: its name; global/X and X may differ
title() { basename "$1" .hdf5; }

# r in a document to the natural map
natural() { nsd-err "$1" | jq -r '.natural // 1e999'; }

# solver tolerance file...: solves in one process, their log into $work/log
solve()
{
    local way=(--solver "$1")
    case $1 in sbp | sal | ebp | eal) way=(-m "$1") ;; esac
    rm -f "$work/log"
    nsd-solve "${way[@]}" --criterion natural --tolerance "$2" --max-seconds "$limit" --max-sweeps 1000000000 \
        --log "$work/log" "${@:3}" > "$work/r.h5" 2> /dev/null
}

# file solver: a row a tolerance; the next tolerance only where this one was reached
nsd()
{
    local eps seconds error sweeps newton contacts good=1
    for eps in "${tolerances[@]}"; do
        if [ "$good" = 1 ] && solve "$2" "$eps" "$1"; then
            error=$(natural "$work/r.h5")
            IFS=$'\t' read -r seconds sweeps newton contacts \
                < <(jq -r '[.seconds, .sweeps, .newton // 0, .contacts] | @tsv' "$work/log")
            if awk "BEGIN { exit !($seconds < 0.1) }" && solve "$2" "$eps" "$1" "$1" "$1"; then
                seconds=$(jq .seconds "$work/log" | median | cut -f 1)
            fi
            good=$(awk "BEGIN { print $error <= 1.01 * $eps && $seconds <= $limit ? 1 : 0 }")
        else
            seconds=nan error=nan sweeps=0 newton=0 good=0
        fi
        printf '%s\t%s\t%s\t%s\t%.3g\t%.2e\t%s\t%s\t%s\t\n' "$2" "$(title "$1")" "${contacts:-}" "$eps" \
            "$seconds" "$error" "$good" "$sweeps" "$newton"
    done
}

# file: what Siconos left, its errors computed again, once
siconos()
{
    local rows stem solver eps good seconds error steps how contacts=
    for rows in "$store/siconos/$(title "$1")".*.tsv; do
        [ -f "$rows" ] || continue
        stem=${rows%.tsv}
        solver=${stem##*.}
        if [ ! "$stem.row" -nt "$rows" ]; then
            contacts=${contacts:-$(nsd-info "$1" | jq -rs '[.[].contacts // empty][0]')}
            while IFS=$'\t' read -r eps good seconds error steps how; do
                if [ "$good" = 1 ]; then
                    nsd-solve -w --solver nlgs --max-sweeps 0 "$stem.$eps.h5" > "$work/r.h5" 2> /dev/null
                    error=$(natural "$work/r.h5")
                    good=$(awk "BEGIN { print $error <= 1.01 * $eps ? 1 : 0 }")
                fi
                printf 'siconos-%s\t%s\t%s\t%s\t%.3g\t%.2e\t%s\t%s\t\t%s\n' "$solver" "$(title "$1")" \
                    "$contacts" "$eps" "$seconds" "$error" "$good" "$steps" "$how"
            done < "$rows" > "$work/row"
            mv "$work/row" "$stem.row"
        fi
        cat "$stem.row"
    done
}

files=()
for file in "$problems"/*.hdf5 "$problems"/global/*.hdf5; do
    if [ -f "$file" ]; then files+=("$file"); fi
done

if [ "${ONLY:-nsd}" = nsd ]; then
    for file in "${files[@]}"; do
        echo "solvers.sh: $(title "$file")" >&2
        for solver in $solvers; do
            rows=$store/nsd/$(title "$file").$solver.tsv
            if [ ! "$rows" -nt "$tools/nsd-solve" ]; then
                nsd "$file" "$solver" > "$work/rows"
                mv "$work/rows" "$rows"
            fi
            cat "$rows" >> "$work/nsd"
        done
    done
else
    grep -v '^siconos-\|^solver\|^#' "$results/$name.tsv" > "$work/nsd" || true
fi
if [ "${ONLY:-siconos}" = siconos ]; then
    for file in "${files[@]}"; do
        echo "solvers.sh: $(title "$file"), Siconos" >&2
        if /usr/bin/python3 bench/solvers.py "$limit" "$store/siconos" "$file"; then
            siconos "$file" >> "$work/siconos"
        else
            [ $? = 69 ] || exit 1
            echo "solvers.sh: no python3-siconos, its half left out" >&2
            break
        fi
    done
else
    grep '^siconos-' "$results/$name.tsv" > "$work/siconos" || true
fi
touch "$work/nsd" "$work/siconos"

{
    if [ "${ONLY:-}" = draw ]; then head -n 1 "$results/$name.tsv"; else echo "# $(machine); limit $limit s"; fi
    printf 'solver\tproblem\tcontacts\ttolerance\tseconds\terror\tsolved\tsteps\tnewton\thow\n'
    awk -F'\t' -v solvers=" $solvers " 'index(solvers, " " $1 " ")' "$work/nsd"
    cat "$work/siconos"
} > "$work/rows"
mv "$work/rows" "$results/$name.tsv"

# ---- what it comes to ----

# solver, tolerance: solved, fastest, seconds, tried; and the solver's rank
awk -F'\t' -v OFS='\t' -v floor="$floor" '
    /^#/ || $1 == "solver" { next }
    !seen[$1]++ { name[++n] = $1 }
    { tried[$1, $4]++ }
    $7 { t = $5 < floor ? floor : $5; at = $2 FS $4; time[$1, at] = t; spent[$1, $4] += $5; solved[$1, $4]++
         if (!(at in best) || t < best[at]) best[at] = t }
    END { for (key in time) { split(key, k, SUBSEP); split(k[2], p, FS)
              fastest[k[1], p[2]] += time[key] == best[k[2]] }
          for (i = 1; i <= n; i++) {
              row = name[i]
              for (e = 4; e <= 12; e += 4) { s = name[i] SUBSEP "1e-" e
                  row = row OFS solved[s] + 0 " of " tried[s] OFS fastest[s] + 0 OFS sprintf("%.3g", spent[s]) }
              print row } }' "$results/$name.tsv" > "$work/table"

# the fastest of some solvers (a pattern) on each problem and tolerance
best()
{
    awk -F'\t' -v OFS='\t' -v pattern="$1" '
        /^#/ || $1 == "solver" || $1 !~ pattern { next }
        { at = $2 OFS $3 OFS $4; if (!(at in seen)) { seen[at]; order[++n] = at } }
        $7 && (!(at in s) || $5 < s[at]) { s[at] = $5; who[at] = $1; sub(/^siconos-/, "", who[at]) }
        END { for (i = 1; i <= n; i++) print order[i], at_(order[i]) }
        function at_(at) { return at in s ? s[at] OFS who[at] : "-" OFS "-" }' "$results/$name.tsv"
}
best '^auto$' > "$work/auto"
best '^[^-]*$' > "$work/ours"
best '^siconos-' > "$work/theirs"

# a row a problem: nsd auto, the best of nsd, the best of Siconos, at the three tolerances
awk -F'\t' -v OFS='\t' -v floor="$floor" '
    FNR == 1 { file++ }
    { s[file, $1, $3] = $4; who[file, $1, $3] = $5
      if (!($1 in contacts)) { order[++n] = $1; contacts[$1] = $2 } }
    function cell(file, e,    t) {
        t = s[file, p, "1e-" e]
        return t == "" || t == "-" ? "-" : t (file > 1 ? " " who[file, p, "1e-" e] : "") }
    function ratio(e,    a, b) {
        a = s[1, p, "1e-" e]; b = s[3, p, "1e-" e]
        if (a + 0 == 0 || b + 0 == 0) return a + 0 ? "only nsd" : b + 0 ? "only Siconos" : "-"
        return sprintf("%.2g", (b < floor ? floor : b) / (a < floor ? floor : a)) }
    END { print "problem", "contacts", "auto 1e-4", "Siconos", "ratio", "auto 1e-8", "nsd", "Siconos", "ratio",
                "auto 1e-12", "nsd", "Siconos", "ratio"
          for (i = 1; i <= n; i++) { p = order[i]
              print p, contacts[p], cell(1, 4), cell(3, 4), ratio(4), cell(1, 8), cell(2, 8), cell(3, 8), ratio(8),
                    cell(1, 12), cell(2, 12), cell(3, 12), ratio(12) } }' \
    "$work/auto" "$work/ours" "$work/theirs" > "$work/problems"

# profiles: tolerance, solver, tau, the fraction of all problems solved within tau of the fastest; "theirs"
# is the best of Siconos' on each
{
    cat "$results/$name.tsv"
    awk -F'\t' -v OFS='\t' '$4 != "-" { print "theirs", $1, $2, $3, $4, "", 1 }' "$work/theirs"
} |
    awk -F'\t' -v OFS='\t' -v floor="$floor" '
        /^#/ || $1 == "solver" { next }
        { solver[$1]; eps[$4]; if (!(($2, $4) in asked)) { asked[$2, $4]; problems[$4]++ } }
        $7 { t = $5 < floor ? floor : $5; time[$1, $4, $2] = t
             if (!(($4, $2) in best) || t < best[$4, $2]) best[$4, $2] = t }
        END { for (key in time) { split(key, k, SUBSEP); print k[2], k[1], time[key] / best[k[2], k[3]], problems[k[2]] } }' |
    LC_ALL=C sort -t$'\t' -k1,1 -k2,2 -k3,3g |
    awk -F'\t' -v OFS='\t' '
        function done_() { if (last != "") print last, 1e9, k / of }
        $1 OFS $2 != last { done_(); k = 0; last = $1 OFS $2; of = $4; print last, 0.9, 0 }
        { print last, $3, ++k / of }
        END { done_() }' > "$work/profile"

# Drawn of Siconos: those that solve most to 1e-12, then to 1e-8; not those in 2D only
drawn=$(awk -F'\t' '/^siconos-/ && !/^siconos-2d/ { print $8 + 0 "\t" $5 + 0 "\t" $1 }' "$work/table" |
    sort -k1,1nr -k2,2nr | head -n 7 | cut -f 3 | paste -sd' ')
gnuplot -e "data='${work//\'/\'\'}/profile'; out='$results/$name.svg'; ours='$solvers'; theirs='$drawn'" bench/solvers.gp

# the head of the page
about()
{
    echo "# Solvers over ${#files[@]} FCLIB problems"
    echo
    echo "On $(machine)."
    echo "To 1e-4, 1e-8 and 1e-12 of the scale-free natural map |r - P(r - rho_a u^)| / |r| as nsd-err"
    echo "computes it again from r. Seconds of CPU of the solve, one thread, without reading; below 0.1 s the median"
    echo "of 3 in one process; at most $limit s. In ratios and in \"fastest\" what is faster than $floor s counts as that, so that"
    echo "several may be the fastest. A solver that failed at a tolerance counts as failed at the tighter ones."
    echo "Siconos' solvers stop by errors of their own: each is asked for what leads to the tolerance at the"
    echo "least cost, of the problem as it stands and of the problem scaled; the better counts (bench/solvers.py)."
    echo "2D problems have a second tangent that nothing moves for its 3D solvers. Of global problems Siconos gets"
    echo "W = H' M^-1 H, whose making does not count. Five problems are here twice, global and as their W (-local)."
    echo "Of global GFC3D_TwoRods1 the W of scipy and of nsd differ by rounding that r shows at 5e-12."
    echo
    echo "![profiles](${name}.svg)"
    echo
}
if [ "${ONLY:-}" = draw ]; then sed '/^| solver/,$d' "$results/$name.md" > "$work/about"; else about > "$work/about"; fi
{
    cat "$work/about"
    {
        printf 'solver\tsolved to 1e-4\tfastest\tseconds\tto 1e-8\tfastest\tseconds\tto 1e-12\tfastest\tseconds\n'
        cat "$work/table"
    } | markdown
    echo
    echo "Seconds are those of the problems solved, together."
    echo
    echo "## By problem"
    echo
    echo "Seconds of nsd's auto, of the fastest of nsd's, of the fastest of Siconos', and how many times faster auto"
    echo "is than that."
    echo
    markdown < "$work/problems"
} > "$results/$name.md"
cat "$work/table"
