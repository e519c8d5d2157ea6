#!/usr/bin/env bash
# The system fails: whichever call to read, write, sync, rename, close, resize or reserve fails, is interrupted or
# does half of what it should, no tool loses anything silently, dies of a signal, or leaves an output that
# is none.
# shellcheck source=tests/support/tap.sh disable=SC2154,SC2317,SC2016 # tap.sh sets tmp; functions called by name; evaluated later
. tests/support/tap.sh

cc -O1 -shared -fPIC -o "$tmp/failures.so" tests/support/preload/failing_system_calls.c
f="env NSD_FAIL_CALL=write LD_PRELOAD=$tmp/failures.so"
if grep -q __asan_init "$(command -v nsd-gen)" || ! $f nsd-gen 1 >/dev/null 2>&1; then
    skip "calls that fail" "a sanitizer is in the way, or a kernel without seccomp"
    done_testing
    exit
fi

heap=$tmp/heap.h5 solved=$tmp/solved.h5
stock heap4 >"$heap"
stock solved4 >"$solved"
nsd-step -m sbp -n 3 -o "$tmp/run.h5" "$heap" 2>/dev/null

# What is run: $f is the preload, $o the output. Those into a document, first, are read again.
documents=('$f nsd-gen 20 >$o'
    '$f nsd-step -m sbp -n 3 --contacts -o $o $heap'
    '$f nsd-step -m sbp -n 3 $heap >$o'
    '$f nsd-step -m sbp -n 3 $heap | cat >$o'
    '$f nsd-step -m sbp -n 3 >$o <$heap'
    '$f nsd-detect $heap >$o'
    'cat $heap $heap | $f nsd-detect | cat >$o'
    '$f nsd-detect --fclib=local $heap >$o'
    '$f nsd-solve -m sbp --max-sweeps 3 $solved >$o'
    '$f nsd-move $solved >$o'
    '$f nsd-cat -o $o $tmp/run.h5'
    '$f nsd-cat --stream $tmp/run.h5 >$o')
others=('$f nsd-err $solved >$o'
    '$f nsd-info $tmp/run.h5 >$o'
    'cat $tmp/run.h5 | $f nsd-info | cat >$o'
    '$f nsd-view --size 32x32 $heap >$o'
    '$f nsd-view --size 32x32 -o $o $heap'
    '$f nsd-web $tmp/run.h5 >$o'
    '$f nsd-web -o $o $tmp/run.h5')
calls=("read EIO" "read EINTR" "read short" "write EIO" "write ENOSPC" "write EINTR" "write short"
    "sync EIO" "rename EIO" "rename ENOSPC" "close EIO" "close EINTR" "resize EIO" "resize EINTR" "reserve EIO"
    "reserve ENOSPC" "reserve EINTR" "message EINTR" "process EIO" "socket EIO")
runs=12 # of a command and a way to fail, spread over its calls
[ -z "$thin" ] || runs=4
runs=${NSD_RUNS-$runs} # make coverage needs more

# The output of a failed run: no file, an empty one that the shell made, or what reads as what it is.
output_holds()
{
    [ -e "$o" ] || return 0
    [ -s "$o" ] || [[ $command != *">\$o"* ]] || return 0
    case $command in
    *nsd-view*-o* | *nsd-web*-o*) return 1 ;;
    *nsd-view* | *nsd-web* | *nsd-info* | *nsd-err*) cmp -s -n "$(wc -c <"$o")" "$o" "$tmp/want" ;; # it ends early
    *"| cat"*) ! nsd-info "$o" >/dev/null 2>&1 || cmp -s -n "$(wc -c <"$o")" "$o" "$tmp/want" ;; # nobody can cut it back
    *) nsd-info "$o" >/dev/null 2>&1 ;;
    esac
}

failing() # index of the run
{
    local at=$((1 + $1 * total / n)) s=0 o=$tmp/out.$BASHPID err=$tmp/err.$BASHPID f tool line
    f="timeout 20 env NSD_FAIL_CALL=$call NSD_FAIL_WITH=$with NSD_FAIL_AT=$at LD_PRELOAD=$tmp/failures.so"
    tool=$(grep -o 'nsd-[a-z]*' <<<"$command")
    rm -f "$o"
    { eval "$command" 2>"$err"; } 2>/dev/null || s=$?
    line=$(tail -n 1 "$err")
    if [ $s = 0 ]; then
        cmp -s "$o" "$tmp/want" || echo "$call $at of $total: status 0, and another output"
        return
    fi
    if [[ ! $s =~ ^(65|66|70|74)$ ]] || ! grep -q "^$tool: " "$err"; then echo "$call $at: status $s, $line"; fi
    [ "$with" != short ] && [ "$call" != message ] || echo "$call $at: half, or a signal, is no failure: $s, $line"
    output_holds || echo "$call $at: status $s, and leaves an output that is none ($line)"
}

failed=0
for command in "${documents[@]}" "${others[@]}"; do
    o=$tmp/want f=
    eval "$command" 2>/dev/null
    for each in "${calls[@]}"; do
        read -r call with <<<"$each"
        o=$tmp/counted f="env NSD_FAIL_CALL=$call NSD_COUNT=$tmp/count LD_PRELOAD=$tmp/failures.so"
        eval "$command" 2>/dev/null
        rm -f "$tmp/counted"
        total=$(cat "$tmp/count") n=$(($(cat "$tmp/count") < runs ? $(cat "$tmp/count") : runs))
        [ "$total" -gt 0 ] || continue
        failed=$((failed + n))
        ok_each "${command//\$/}: $each at $n of $total calls" failing "$n"
    done
done
echo "# $failed runs in which a call failed"
done_testing
