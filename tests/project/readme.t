#!/usr/bin/env bash
# README.md has the figures of the results that are kept, and what its commands print.
# shellcheck source=tests/support/tap.sh disable=SC2317,SC2016 # functions called by name; text for eval
. tests/support/tap.sh

ok "figures are taken from the kept results" eval 'scripts/readme/figures.sh >"$tmp/figures"'
ok "and each has a value" eval '[ "$(wc -l <"$tmp/figures")" -gt 25 ] && ! grep -P "\t$" "$tmp/figures"'
ok "README.md is made" eval 'scripts/readme/readme.sh >"$tmp/README.md"'
ok "README.md has them (else: scripts/readme/readme.sh >README.md)" cmp "$tmp/README.md" README.md
ok "every figure of the template is used by name" eval '! grep -q "@" README.md'
ok "it is about a screen long" eval '[ "$(wc -l <README.md)" -le 120 ]'

# ---- a result that changes is noticed ----

mkdir -p "$tmp/other"
for f in bench/results docs/peers docs/gallery docs/paper/tables docs/readme Makefile; do
    mkdir -p "$tmp/other/$(dirname "$f")" && cp -r "$f" "$tmp/other/$f"
done
changed() # NAME: differs in the changed copy
{
    ! cmp -s <(grep "^$1	" "$tmp/figures") <(scripts/readme/figures.sh "$tmp/other" | grep "^$1	")
}
sed -i 's/^\(auto\tFC3D_Example1\t.*\t1e-12\t[^\t]*\t[^\t]*\t\)1/\10/' "$tmp/other/bench/results/amd-epyc-avx2/solvers.tsv"
ok "a problem that is no longer solved" changed fclib_auto
jq '(first(.[] | select(.kind == "judged" and .verdict == "agrees")) | .verdict) = "differs"' docs/gallery/table.json >"$tmp/other/docs/gallery/table.json"
ok "a comparison with another verdict" changed gallery_within
peers=$(find docs/peers -name '*.json' | head -n 1)
jq '.jobs |= with_entries(.value.variants.nsd.runs[0].cpu *= 3)' "$peers" >"$tmp/other/$peers"
ok "a job that takes three times as long" changed peers_most

# ---- what the commands print ----

ok "docs/peers/README.md is made of its kept results (else: bench/peers/page.py docs/peers/*.json)" \
    cmp docs/peers/README.md <(python3 bench/peers/page.py docs/peers/*.json)
ok "README.md's run ends with status 0 under -e" eval 'nsd-gen cookbook/drum/scene.json | nsd-step -e --until 1.2 --every 0.2s >"$tmp/drum.h5"'

ok "the drum's angles are what it prints" cmp docs/readme/drum.txt <(scripts/readme/readme.sh drum)
if command -v gnuplot >/dev/null; then
    ok "make demo ends as README.md shows" cmp docs/readme/demo.txt <(scripts/readme/readme.sh demo)
else
    skip "make demo" "no gnuplot"
fi
done_testing
