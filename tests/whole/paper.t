#!/usr/bin/env bash
# make paper QUICK=1: everything is made, the tables are the golden ones, and what is there is kept.
# shellcheck source=tests/support/tap.sh disable=SC2016,SC2317 # awk's $1; functions called by name
. tests/support/tap.sh

out=$tmp/paper
paper() { make -f scripts/paper.mk -j2 QUICK=1 OUT="$out"; }
ok "every table and figure is made" paper

# Within what the arithmetic of another libm may do to a chaotic pile: contacts 10 %, sweeps and
# missed steps 10 % or 3, errors a factor of 10 where they are above rounding. The rest is the same.
close_to() # golden ours
{
    paste "$1" "$2" | awk -F'\t' '
        function abs(x) { return x < 0 ? -x : x }
        function near(a, b, part, least) { d = abs(a - b); return d <= least || d <= part * abs(a) }
        function order(a, b) { return a == b || (a < 1e-13 && b < 1e-13) || (a > 0 && b > 0 && a / b < 10 && b / a < 10) }
        NR == 1 { n = NF / 2; for (i = 1; i <= n; i++) name[i] = $i }
        NR > 1 {
            for (i = 1; i <= n; i++) {
                a = $i; b = $(n + i); c = name[i]; sub(/_(low|high)$/, "", c)
                fine = c == "contacts" ? near(a, b, 0.1, 1) : \
                       c ~ /^(sweeps|missed|total_sweeps|gave_up)$/ ? near(a, b, 0.1, 3) : \
                       c ~ /^(eps_glob|penetration|penetration_true)$/ ? order(a, b) : a == b
                if (!fine) { print $1, $2, $3, $4 ": " c " is " b ", was " a; bad = 1 }
            }
        }
        END { exit bad || NR < 2 }'
}
for n in 1 2 3 4; do
    # all but the times, which come last
    cut -f "1-$(($(head -n 1 "$out/tables/table$n.tsv" | tr '\t' '\n' | grep -nx seconds | cut -d : -f 1) - 1))" \
        "$out/tables/table$n.tsv" >"$tmp/table$n.tsv"
    is "table $n has the golden rows" "$(wc -l <"$tmp/table$n.tsv")" "$(wc -l <"tests/support/golden/paper/table$n.tsv")"
    ok "table $n agrees with the golden one" close_to "tests/support/golden/paper/table$n.tsv" "$tmp/table$n.tsv"
done
differs() # a golden table with one count wrong
{
    sed 's/\t24\t/\t99\t/' tests/support/golden/paper/table1.tsv >"$tmp/wrong.tsv" &&
        ! close_to tests/support/golden/paper/table1.tsv "$tmp/wrong.tsv"
}
ok "and would not if a count were another" differs

verdicts() { awk -F'\t' '$5 == "" { print $1 ": " $4 }' "$1"; }
is "the verdicts that are no matter of time" "$(verdicts "$out/tables/claims.tsv")" "$(cat tests/support/golden/paper/verdicts)"

is "the summary counts every claim" \
    "$(grep -Eo '^- \*\*(Holds|Holds in part|Does not hold)\*\* \([0-9]+\)' "$out/README.md" | tr -dc '0-9\n' | awk '{ n += $1 } END { print n }')" \
    "$(($(wc -l <"$out/tables/claims.tsv") - 1))"
ok "no number is missing in a claim" bash -c "! grep -Ew 'none|null|nan' '$out'/tables/*claims.tsv"

# ---- example 2, ten seeds; one problem for every method ----

medians() # of the steps missed, from the runs themselves
{
    awk -F'\t' 'NR > 1 { print $1, $2, $3, $10 }' "$out/tables/seeds.tsv" | sort -k1,3 -k4n |
        awk '{ k = $1 " " $2 " " $3; v[k, ++n[k]] = $4 }
             END { for (k in n) print k, (v[k, 5] + v[k, 6]) / 2, v[k, 1], v[k, 10], n[k] }' | sort
}
shown()
{
    awk -F'\t' 'NR == 1 { for (i = 1; i <= NF; i++) c[$i] = i }
                NR > 1 { print $1, $2, $4, $c["missed"], $c["missed_low"], $c["missed_high"], 10 }' "$out/tables/table2.tsv" | sort
}
is "table 2 has the medians and ranges of ten seeds" "$(shown)" "$(medians)"
ok "every method was given the same problems" \
    jq -s -e 'group_by([.scene, .pile]) | all(length == 5 and (map(.contacts) | unique | length == 1))' "$out/same.json"

# ---- with adhesion ----

is "each example with bonds was run with every method" "$(cut -f 1,2 "$out/tables/adhesion-rows.tsv" | tail -n +2 | sort -u | wc -l)" 15
ok "some bonds are whole at the end of example 3, some are damaged, and some have broken" \
    awk -F'\t' '$1 == "example3" && !($4 > 100 && $5 > 100 && $6 > 0) { bad = 1 } $1 == "example3" { n++ } END { exit bad || n != 5 }' "$out/tables/adhesion-rows.tsv"
ok "every method was given the same bonded problems" \
    jq -s -e 'group_by([.scene, .pile]) | all(length == 5 and (map(.contacts) | unique | length == 1))' "$out/adhesion-same.json"
for claim in "EBP and EAL need one sweep" "SBP and SAL give very similar" "the enhanced methods need fewer sweeps" \
    "SBP, SAL: the error is governed" "EBP, EAL: the error is governed" "the error from the projection"; do
    like "$claim ... carries over" "$(grep -F "$claim" "$out/tables/adhesion-claims.tsv" | cut -f 3)" "^carries over$"
done
ok "the page has the chapter" grep -q "^## With adhesion" "$out/README.md"

# The closed solution of example 1, for every method, dt and dimension.
ok "places are right to mu g dt^2/8, speeds to 1e-10 m/s, rolling begins less than dt late" \
    awk -F'\t' 'NR > 1 && ($4 > 0.7 * 9.81 / 8 * $3 * $3 * 1.001 || $5 > 1e-10 || ($6 != "" && ($6 < 0 || $6 > $3))) { print; bad = 1 }
                END { exit bad || NR != 41 }' "$out/tables/closed.tsv"

# ---- the page ----

for f in signorini coulomb coulombcone strobe closed conv-example{1,2,3}; do
    ok "$f.svg is a drawing with curves" \
        bash -c "python3 -c 'import sys, xml.dom.minidom as x; x.parse(sys.argv[1])' '$out/figures/$f.svg' &&
                 grep -Eq '<(path|use|circle)' '$out/figures/$f.svg'"
    ok "the page shows it" grep -q "figures/$f.svg" "$out/README.md"
done
for s in example{1,2,3}{,-2d}; do
    ok "pictures of $s: the balls have moved" \
        bash -c "file='$out/figures/$s'; [ -s \$file-start.png ] && [ -s \$file-end.png ] && ! cmp -s \$file-start.png \$file-end.png"
done
for s in example3 example3-2d; do
    ok "and $s at rest is another picture" bash -c "! cmp -s '$out/figures/$s-end.png' '$out/figures/$s-rest.png'"
done
ok "the page says how fast they still are" bash -c "[ \$(wc -l <'$out/tables/motion.tsv') = 5 ] && grep -q 'balls, as the paper stops' '$out/README.md'"
ok "the plots of convergence say what their axis is" \
    bash -c "[ \$(grep -l 'means over the contacts' '$out'/figures/conv-*.svg | wc -l) = 3 ]"
is "every picture of the page exists" "$(grep -o '](figures/[^)]*' "$out/README.md" | sed 's/](//' | while read -r f; do [ -s "$out/$f" ] || echo "$f"; done)" ""
ok "no include was left in the page" bash -c "! grep -q '^@' '$out/README.md'"
ok "the quick page says so" grep -q 'quick page' "$out/README.md"

# ---- what is there is kept; what is lost comes back the same ----

touch "$tmp/mark"
sleep 1.1
ok "made again" paper
is "nothing is made anew" "$(find "$out" -type f -newer "$tmp/mark")" ""
run=$out/runs/example3_nsd_exact
cp "$run.h5" "$tmp/was.h5"
cp "$run.json" "$tmp/was.json"
rm "$run.h5" "$run.log" "$run.json"
ok "a run that was lost is made again" make -f scripts/paper.mk QUICK=1 OUT="$out" "$run.json"
ok "with the same bytes" cmp "$run.h5" "$tmp/was.h5"
ok "and the same figures" cmp "$run.json" "$tmp/was.json"

done_testing
