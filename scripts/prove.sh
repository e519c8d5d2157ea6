#!/usr/bin/env bash
# prove.sh TEST ...: runs the tests, two at a time, in the order given; then names the ten that took longest, and what
# was skipped, with the reason. Its status is prove's. What the tests print is kept in build/tap.
set -euo pipefail

tap=$PWD/build/tap
rm -rf "$tap"
mkdir -p "$tap"
status=0
PERL_TEST_HARNESS_DUMP_TAP=$tap prove -j2 --timer --exec tests/support/bounded "$@" | tee "$tap/log" || status=$?

echo
echo "The ten slowest, in seconds:"
sed -nE 's/^\[[0-9:]+\] ([^ ]+) \.+ .* ([0-9]+) ms .*/\2 \1/p' "$tap/log" |
    sort -rn |
    head -n 10 |
    awk '{ printf "%7.1f  %s\n", $1 / 1000, $2 }'

# "ok 7 - name # SKIP reason" of a test, "1..0 # SKIP reason" of a whole file
(cd "$tap" && { grep -r -E '^(ok .*|1\.\.0) # SKIP ' . || true; }) |
    sed -E 's,^\./,,; s/:(ok [0-9]+ - |1\.\.0 )/: /; s/ # SKIP /: /; s/:  *: /: /' |
    sort >"$tap/skipped"
echo
if [ -s "$tap/skipped" ]; then
    echo "Skipped, $(wc -l <"$tap/skipped"):"
    sed 's/^/  /' "$tap/skipped"
else
    echo "Nothing was skipped."
fi
exit "$status"
