#!/usr/bin/env bash
# Every message of nsd-diagnostics(7) is what its command prints: an ellipsis stands for any text.
# shellcheck source=tests/support/tap.sh disable=SC2317 # functions called by name
. tests/support/tap.sh

ln -s "$PWD/scenes" "$tmp/scenes"
cp cookbook/drum/scene.json "$tmp/drum.json"
nsd-gen 50 >"$tmp/a.h5"
nsd-step -n 20 "$tmp/a.h5" >"$tmp/out.h5" 2>"$tmp/err"

entries() # message<TAB>command
{
    sed -n 's/\\(aq/'"'"'/g; s/\\(dq/"/g; s/^\.It Ql //p; s/^\.Dl \$ /\t/p' man/nsd-diagnostics.7 | awk '/^\t/ { print message $0; next } { message = $0 }'
}
printed() # MESSAGE: whether standard error or output has it
{
    local part pattern=''
    while [ -n "$1" ]; do
        part=${1%%...*}
        pattern+="$(sed 's/[][\.*^$/]/\\&/g' <<<"$part").*"
        case $1 in *...*) set -- "${1#*...}" ;; *) set -- '' ;; esac
    done
    tr '\n' ' ' <"$tmp/stderr" | grep -q -- "$pattern" || tr '\n' ' ' <"$tmp/stdout" | grep -q -- "$pattern"
}
count=0
while IFS=$'\t' read -r message command <&3; do
    count=$((count + 1))
    if [[ $command = mpirun* ]] && ! { command -v mpirun && command -v nsd-step-mpi; } >/dev/null; then
        skip "$message" "no MPI"
        continue
    fi
    (cd "$tmp" && timeout 60 bash -c "$command" >stdout 2>stderr </dev/null) || true
    ok "$command: $message" printed "$message"
done 3< <(entries)
is "nsd-diagnostics(7) has twenty messages or more, each with a command" "$((count >= 20)) $(grep -c '^\.It Ql' man/nsd-diagnostics.7)" "1 $count"
done_testing
