#!/usr/bin/env bash
# figures.sh [ROOT]: the figures of README.md, NAME<TAB>VALUE, from the results that are kept: bench/results, docs/peers,
# docs/gallery, docs/paper/tables, docs/readme
set -euo pipefail
export LC_ALL=C
cd "${1:-.}"

solvers() # MACHINE PREFIX
{
    awk -F'\t' -v p="$2" '
        NR < 3 { next }
        { contacts[$2] = $3; t = $4; ok = $7; s = $5 < 1e-4 ? 1e-4 : $5
          if (!ok) next
          solved[$1, t]++; if ($1 ~ /^siconos/) { if (!((t, $2) in best) || s < best[t, $2]) best[t, $2] = s }
          if ($1 == "auto") { auto[t, $2] = s; total[t] += $5 }
          solver[$1] }
        END {
            for (k in contacts) { n++; if (contacts[k] <= 11) small++; base = k; if (sub(/-local$/, "", base) && base in contacts) twice++ }
            for (s in solver) if (s ~ /^siconos/ && solved[s, "1e-12"] > most) most = solved[s, "1e-12"]
            for (k in contacts) {
                any += ("1e-12", k) in best
                a = ("1e-8", k) in auto ? auto["1e-8", k] : 1e9; b = ("1e-8", k) in best ? best["1e-8", k] : 1e9
                if (a < b * 0.995) faster++; else if (a > b * 1.005) slower++; else same++
            }
            print p "problems\t" n; print p "distinct\t" n - twice; print p "small\t" small
            print p "auto\t" solved["auto", "1e-12"]; printf "%sseconds\t%.1f\n", p, total["1e-12"]
            print p "single\t" most; print p "any\t" any
            print p "faster\t" faster; print p "slower\t" slower; print p "same\t" same
        }' "bench/results/$1/solvers.tsv"
}
solvers amd-epyc-avx2 fclib_
solvers intel-xeon-processor-avx512 xeon_

# CPU of nsd over that of LIGGGHTS with soft contacts, the same start
for f in docs/peers/*.json; do
    jq -r '[.jobs | to_entries[] | .value.variants as $v | select($v.nsd and $v["liggghts-soft"]) |
        ($v.nsd.runs[0].cpu / $v.nsd.runs[0].span) / ($v["liggghts-soft"].runs[0].cpu / $v["liggghts-soft"].runs[0].span)] |
        "peers_jobs\t\(length)", "peers_least\t\(min * 100 | round / 100)",
        "peers_most\t\(max * 10 | round / 10)", "peers_median\t\(sort | (.[length / 2 | floor] + .[(length - 1) / 2 | floor]) / 2 * 100 | round / 100)"' "$f"
    jq -r '[.jobs[].variants | map_values(.runs[0])] |
        def cost: .cpu / .span;
        def over(a; b): map(select(a and b and (a.steps >= 10)) | (a | cost) / (b | cost));
        def hundredth: . * 100 | round / 100;
        def thousandth: . * 1000 | round / 1000;
        over(.nsd; ."liggghts-stiff") as $stiff | over(."nsd-one"; ."liggghts-soft") as $one |
        "peers_deepest\t\(map(.nsd.overlap // empty) | max | thousandth)", "peers_pairs\t\(map(.nsd.pairs // empty) | max | thousandth)",
        "peers_soft\t\(map(."liggghts-soft".pairs // empty) | [min, max] | map(thousandth) | "\(.[0]) to \(.[1])")",
        "peers_stiff\t\(map(."liggghts-stiff".pairs // empty) | [min, max] | map(thousandth) | "\(.[0]) to \(.[1])")",
        "peers_stiff_least\t\($stiff | min | hundredth)", "peers_stiff_most\t\($stiff | max | hundredth)",
        "peers_one\t\($one | [min, max] | map(hundredth) | "\(.[0]) to \(.[1])")", "peers_one_deepest\t\(map(."nsd-one".overlap // empty) | max * 10 | round / 10)"' "$f"
done | sort -u

jq -r 'def count(f): map(select(f)) | length; def judged: .kind == "judged" and .verdict != "not yet run";
    "gallery_rows\t\(length)", "gallery_judged\t\(count(judged))", "gallery_within\t\(count(judged and .verdict != "differs"))",
    "gallery_differ\t\(count(judged and .verdict == "differs"))", "gallery_unread\t\(count(.kind == "not read"))",
    "gallery_identities\t\(count(.kind == "identity"))", "gallery_one_sided\t\(count(.kind == "one bound"))",
    "gallery_not_yet\t\(count(.verdict == "not yet run"))", "gallery_independent\t\(count(.codes))",
    "gallery_same\t\(count(.codes == "same"))", "gallery_codes_differ\t\(count(.codes == "differ"))",
    "gallery_both\t\(count(judged and .verdict == "differs" and .codes == "same"))"' docs/gallery/table.json
printf 'gallery_small\t%s\n' "$(jq -rs 'map(select(.quick) | .name) | if length > 0 then join(", ") else "none" end' docs/gallery/*/result.json)"
printf 'gallery_experiments\t%s\n' "$(find docs/gallery -name result.json | wc -l)"

# the ball or disc that slides, then rolls
awk -F'\t' 'NR > 1 { n++; if ($5 < 1e-10) good++ } END { print "closed_runs\t" n; print "closed_good\t" good }' docs/paper/tables/closed.tsv

# one update of a contact, and memory
figure() { awk -F'\t' -v w="$2" '$1 == w { printf "%.3g\n", $4 }' "bench/results/$1/figures.tsv"; }
for m in amd-epyc-avx2 amd-epyc-avx512; do
    for k in exact ebp; do
        printf '%s_%s\t%s\n' "ns_$k" "${m#amd-epyc-}" "$(figure $m "a sweep with its share of the criterion, $k, 200 steps of the settled pile")"
    done
done
printf 'angle\t%s\n' "$(tail -n 1 docs/readme/drum.txt | jq '.[1] * 10 | round / 10')"
printf 'version\t%s\n' "$(sed -n 's/^VERSION := //p' Makefile)"
