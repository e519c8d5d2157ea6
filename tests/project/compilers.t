#!/usr/bin/env bash
# The same bytes from gcc at -O3, gcc at -O1 and clang at -O3: each one's tools have to make the same steps.
# shellcheck source=tests/support/tap.sh
. tests/support/tap.sh

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

# Of the widths the widest that the machine has runs: the others are for the linker.
idle=(4 8)
! grep -qw avx2 /proc/cpuinfo || idle=(2 8)
! grep -qw avx512dq /proc/cpuinfo || idle=(2 4)

same() # name directory
{
    steps "$2" >"$tmp/steps"
    ok "$1: the same bytes as the tools under test" cmp "$tmp/tested" "$tmp/steps"
}

# The tools under test are gcc's at -O3, as a rule; those with sanitizers, which make check has, at -O1.
steps "$(dirname "$(command -v nsd-step)")" >"$tmp/tested"
ok "gcc -O1 builds the tools" make -j2 SAN=1 build/san/nsd-gen build/san/nsd-step
same "gcc -O1" build/san
if command -v clang >/dev/null; then
    built=build/clang-O3
    ok "clang -O3 builds the tools" make -j2 SAN= "B=$built" CC=clang CFLAGS=-O3 "WITHOUT=draw/%" \
        "IDLE=${idle[*]}" $built/nsd-gen $built/nsd-step
    same "clang -O3" $built
else
    skip "clang -O3" "there is no clang"
fi
done_testing
