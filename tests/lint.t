#!/usr/bin/env bash
# The house's style holds: the parts of `make lint`.
# shellcheck source=tests/tap.sh
. tests/tap.sh

if [ -n "$quick" ]; then
    echo "1..0 # SKIP the plain run lints"
    exit 0
fi
for part in format manuals scripts cppcheck tidy; do
    ok "make lint-$part finds nothing" make --no-print-directory -s "lint-$part"
done
done_testing
