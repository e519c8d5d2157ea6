#!/usr/bin/env bash
# run.sh SECONDS TARGET ...: each fuzz target for so long, from its kept corpus; a line of figures each
# in build/fuzz/figures. A crash or a hang is left in build/fuzz/TARGET-*, and is the exit status.
set -euo pipefail

seconds=$1
shift
found=0
export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1:handle_segv=0:quarantine_size_mb=8:${ASAN_OPTIONS-}
for target in "$@"; do
    corpus=build/fuzz/corpus/$target
    mkdir -p "$corpus"
    log=build/fuzz/$target.log
    "build/fuzz/fuzz_$target" -max_total_time="$seconds" -timeout=30 -rss_limit_mb=3000 -use_value_profile=1 \
        -print_final_stats=1 -artifact_prefix="build/fuzz/$target-" -dict="tests/hostile/fuzz/$target.dict" \
        "$corpus" "tests/hostile/fuzz/corpus/$target" >"$log" 2>&1 || found=1
    ran=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
    [ -n "$ran" ] || { echo "$target: did not run to its end, see $log" >&2; found=1; }
    echo "$target: ${ran:-unknown} executions, $(find build/fuzz -name "$target-crash-*" | wc -l) crashes," \
        "$(find build/fuzz -name "$target-timeout-*" | wc -l) hangs, $seconds s asked for" | tee -a build/fuzz/figures
done
exit $found
