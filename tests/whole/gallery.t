#!/usr/bin/env bash
# make gallery QUICK=1: every experiment is made, has its pictures and its table, and what holds of so few grains holds.
# shellcheck source=tests/support/tap.sh
. tests/support/tap.sh

out=$tmp/gallery
ok "the gallery is made" make -f scripts/gallery.mk -j2 QUICK=1 OUT="$out"
ok "and by the independent code" make -f scripts/gallery.mk -j2 QUICK=1 OUT="$out" reference
cp -r docs/gallery "$tmp/kept"
ok "results are put beside those of other runs" make -f scripts/gallery.mk OUT="$out" KEEP="$tmp/kept" keep

# of each experiment: its table, its pictures, and the values of a small run within what other seeds gave
for file in scripts/gallery/*.json; do
    e=$(basename "$file" .json)
    like "$e: values were found" "$(jq '(.rows | length > 0) and all(.rows[]; .found != null)' "$out/$e/result.json")" true
    if jq -e '.reference | type == "object"' "$file" >/dev/null; then
        like "$e: by the independent code too" "$(jq '(.rows | length > 0) and all(.rows[]; .found != null)' "$out/reference/$e/result.json")" true
    fi
    for png in picture curve; do
        like "$e: $png.png is a picture" "$(head -c 8 "$out/$e/$png.png" | od -An -c | tr -d ' ')" '^211PNG'
    done
    like "$e is on the page" "$(cat "$tmp/kept/README.md")" "\($e/curve\.png\)"
    ok "$e: some row is judged at small size" jq -e 'any(.rows[]; .small)' "$file"
    while IFS=$'\t' read -r key low high; do
        like "$e: $key is within $low to $high" \
            "$(jq --arg key "$key" ".rows[] | select(.key == \$key) | .found >= $low and .found <= $high" "$out/$e/result.json")" true
    done < <(jq -r '.rows[] | select(.small) | [.key, .small[]] | @tsv' "$file")
done

# the page is that of what is kept
cp -r docs/gallery "$tmp/page"
ok "the page is made without a run" make -f scripts/gallery.mk KEEP="$tmp/page" page
ok "and is the one in docs/gallery (else: make gallery-page)" diff -r docs/gallery "$tmp/page"
done_testing
