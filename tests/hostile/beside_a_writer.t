#!/usr/bin/env bash
# Readers beside a fast writer: each finds the frames that are finished, and none is told that the file is damaged.
# Before, of 300 tries of each 8 to 26 ended with 65.
# shellcheck source=tests/support/tap.sh disable=SC2154,SC2317 # tap.sh sets tmp; functions called by name
. tests/support/tap.sh

# what libhdf5 does in the reading process is not ours, and there a sanitizer would say more than a line
export ASAN_OPTIONS=$ASAN_OPTIONS:detect_leaks=0:handle_segv=0:handle_sigbus=0
cd "$tmp"
tries=40
[ -z "$thin" ] || tries=15

beside() # BODIES COMMAND ...: while nsd-step writes each step
{
    local writer k failed=0
    nsd-gen "$1" >in.h5
    rm -f f.h5
    timeout 120 nsd-step -n 1000000 -o f.h5 in.h5 2>/dev/null &
    writer=$!
    for ((k = 0; k < 500; k++)); do if [ -s f.h5 ]; then break; fi; sleep 0.02; done
    for ((k = 0; k < tries; k++)); do
        "${@:2}" f.h5 >"out.$1" 2>"err.$1" || { failed=$((failed + 1)); cat "err.$1"; }
    done
    kill -0 $writer || echo "the writer has ended"
    kill $writer && wait $writer
    [ $failed = 0 ] || { echo "$failed of $tries"; return 1; }
}
for bodies in 4 500; do
    ok "$bodies bodies: nsd-info --last" beside $bodies nsd-info --last
    is "the frame has all that belongs to it" "$(jq -s '.[0] | .step > 0 and has("sweeps") and has("account")' out.$bodies)" true
    ok "$bodies bodies: nsd-cat --last" beside $bodies nsd-cat --last
    is "it can be gone on from" "$(nsd-step -n 2 out.$bodies 2>/dev/null | nsd-info --last | jq -s '.[0] | has("sweeps")')" true
done

# ---- what is said to be there, and is not ----

cp f.h5 cut.h5
truncate -s 60000 cut.h5
refuses 65 "an unfinished document that has been cut off" nsd-info cut.h5
if have_h5py; then
    beyond() # a chunk's address, beyond the end of the file, and the end of the document in front of it
    {
        py - <<'PYTHON'
import h5py
data = bytearray(open('f.h5', 'rb').read())
with h5py.File('f.h5', 'r') as f: at = f['/particles/all/position/value'].id.get_chunk_info(0).byte_offset
old, new = at.to_bytes(8, 'little'), (len(data) + (1 << 24)).to_bytes(8, 'little')
base = (at - 512).to_bytes(8, 'little')
for word in old, base:
    k = data.find(word)
    while k >= 0:
        data[k:k + 8] = new
        k = data.find(word, k + 1)
open('beyond.h5', 'wb').write(data)
PYTHON
    }
    ok "made" beyond
    refuses 65 "a place beyond the end of the file" nsd-info beyond.h5
fi

done_testing
