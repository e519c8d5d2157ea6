#!/usr/bin/env bash
# The same bytes from gcc at -O3, gcc at -O1 and clang at -O3: the tools are built again for each, and
# have to make the same steps.
# shellcheck source=tests/tap.sh
. tests/tap.sh

if [ -n "$quick" ]; then
    echo "1..0 # SKIP the plain run compares compilers"
    exit 0
fi

steps() # directory of the tools
{
    local method order
    for method in sbp sal ebp eal exact; do
        for order in natural colour; do
            "$1/nsd-gen" 60 |
                "$1/nsd-step" -m "$method" --order "$order" -n 500 --every 50 --contacts \
                    --max-sweeps 20 --relax 1.2 --warm 2>/dev/null |
                sha256sum
        done
    done
}

builds() # directory compiler level
{
    make -j2 SAN= "B=$1" "CC=$2" "CFLAGS=$3" "$1/nsd-gen" "$1/nsd-step"
}

# The tools under test are gcc's at -O3, as a rule.
steps "$(dirname "$(command -v nsd-step)")" >"$tmp/tested"
for name in "gcc -O1" "clang -O3"; do
    read -r compiler level <<<"$name"
    if ! command -v "$compiler" >/dev/null; then
        skip "$name" "there is no $compiler"
        continue
    fi
    ok "$name builds the tools" builds "build/$compiler$level" "$compiler" "$level"
    steps "build/$compiler$level" >"$tmp/steps"
    ok "$name: the same bytes as the tools under test" cmp "$tmp/tested" "$tmp/steps"
done
done_testing
