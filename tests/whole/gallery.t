#!/usr/bin/env bash
# make gallery QUICK=1: every experiment is made, has its pictures and its table, and what holds of so few grains holds.
# shellcheck source=tests/support/tap.sh
. tests/support/tap.sh

out=$tmp/gallery
ok "the gallery is made" make -f scripts/gallery.mk -j2 QUICK=1 OUT="$out"

# of each experiment: its table, its pictures, and the values of a small run within what other seeds gave
for file in scripts/gallery/*.json; do
    e=$(basename "$file" .json)
    like "$e: all that its table compares was found" "$(jq '(.rows | length > 2) and all(.rows[]; .found != null)' "$out/$e/result.json")" true
    for png in picture curve; do
        like "$e: $png.png is a picture" "$(head -c 8 "$out/$e/$png.png" | od -An -c | tr -d ' ')" '^211PNG'
    done
    like "$e is on the page" "$(cat "$out/README.md")" "\($e/curve\.png\)"
    ok "$e: some row is judged at small size" jq -e 'any(.rows[]; .small)' "$file"
    while IFS=$'\t' read -r what low high; do
        like "$e: $what is within $low to $high" \
            "$(jq --arg what "$what" ".rows[] | select(.what == \$what) | .found >= $low and .found <= $high" "$out/$e/result.json")" true
    done < <(jq -r '.rows[] | select(.small) | [.what, .small[]] | @tsv' "$file")
done
done_testing
