#!/usr/bin/env bash
# The redesign of lib/ changes no byte of what tools write: tests/support/frozen.sh against its kept checksums. The file is
# deleted when the redesign has ended.
# shellcheck source=tests/support/tap.sh
. tests/support/tap.sh

tests/support/frozen.sh >"$tmp/now"
ok "there are at least 60 checksums" [ "$(wc -l <tests/support/frozen.sums)" -ge 60 ]
while read -r name sum; do
    now=$(awk -v n="$name" '$1 == n { print $2 }' "$tmp/now")
    if [ -z "$now" ]; then skip "$name" "there is no MPI"; else is "$name" "$now" "$sum"; fi
done <tests/support/frozen.sums
done_testing
