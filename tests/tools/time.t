#!/usr/bin/env bash
# Time is a function of the step: t = t0 + (step - step0) dt, whatever was interrupted.
. tests/support/tap.sh

step() { nsd-step "$@" 2>/dev/null; }
now() { nsd-info --last "$1" | jq -c '[.step, .time]'; }
scene() { echo '{"dt": 1e-3, "gravity": [0, 0, 0], "bodies": [{"x": [0, 0, 0], "v": [1, 0, 0], "radius": 0.1}]}' | jq -c "$1" | nsd-gen -; }
cd "$tmp"

# ---- where a run ends ----

scene . >one.h5
step -n 29990 --every 30000 -o part.h5 one.h5
step --until 30 --every 30000 -o rest.h5 part.h5
step --until 30 --every 30000 -o whole.h5 one.h5
is "--until 30 is step 30000" "$(now whole.h5)" '[30000,30]'
is "and for a run that goes on" "$(now rest.h5)" '[30000,30]'
step --until 30 --every 30000 -o none.h5 whole.h5
is "which makes no step when it is there" "$(now none.h5)" '[30000,30]'

scene '.time = 7.3' >late.h5
step -n 1234 --every 1234 late.h5 >late.out.h5
is "a scene's time is counted from" "$(now late.out.h5)" "[1234,$(python3 -c 'print(7.3 + 1234 * 1e-3)' 2>/dev/null || echo 8.534)]"
step -n 100 late.h5 | step -n 1000 | step -n 134 --every 134 >pieces.h5
ok "in pieces, too, to the bit" cmp <(nsd-info -p --last late.out.h5) <(nsd-info -p --last pieces.h5)
is "and the same time" "$(now pieces.h5)" "$(now late.out.h5)"

# ---- which steps are kept ----

step -n 30000 --every 0.01s -o every.h5 one.h5
is "--every 0.01s keeps each tenth step" "$(nsd-info every.h5 | jq -r 'select(.step) | .step % 10' | sort | uniq -c | tr -s ' ')" " 3000 0"
scene '.dt = 0.003' | step -n 3000 --every 0.01s -o third.h5
first() { jq -n '[range(1; 901) | (. * 10 / 3) | ceil]' -c; } # the first at or after each multiple: ceil(10 k / 3)
is "and of dt 0.003 the first at or after each" "$(nsd-info third.h5 | jq -c -s '[.[] | select(.step).step][:900]')" "$(first)"
step -n 1777 -o 1.h5 one.h5
step -n 3223 --every 0.007s 1.h5 | nsd-info | jq 'select(.step).step' >kept
is "wherever the run began" "$(sort -n kept | jq -c -s '[.[] | . % 7] | unique')" "[0,2]" # 5000 = 7 * 714 + 2, the last

# ---- the end of a double ----

refuses 65 "a dt that does not change the time is refused" scene '.time = 1e9 | .dt = 1e-8'
refuses 65 "also one that changes it in some steps only" scene '.time = 1e9 | .dt = 1e-7'
scene '.time = 1e9 | .dt = 1e-6' | step -n 1000 --every 1000 >far.h5
ok "with dt = 1e-6 it goes on, and is not off" eval 'nsd-info --last far.h5 | jq -e "((.time - 1e9 - 1e-3) | fabs) < 2e-7"'

if have_h5py; then
    foreign one.h5 set.h5
    change() { cp "$1" set.h5 && py -c "import h5py, numpy as np
f = h5py.File('set.h5', 'r+'); p = f['particles/all/position']
$2"; }
    foreign one.h5 plain.h5
    change plain.h5 'p["time"][0] = 1e9; f["nsd"].attrs["dt"] = 1e-8'
    refuses 65 "and in a document that comes with it" nsd-step set.h5
    like "says what helps" "$(cat "$tmp/err")" "earlier time, or with a longer dt"
    for far in 2**63-1 2**53+1 -2**63; do
        change plain.h5 "p['step'][0] = $far"
        for tool in nsd-info nsd-step nsd-cat; do refuses 65 "$tool: step $far is refused" "$tool" set.h5; done
    done
    foreign late.h5 from.h5
    ok "what is counted from stands in the document" py -c "import h5py
assert list(h5py.File('from.h5')['nsd'].attrs['time_origin']) == [7.3, 0]"
    change from.h5 'p["time"][0] = 5; p["step"][0] = 10'
    step -n 10 set.h5 >moved.h5
    is "and is not believed where it contradicts the time" "$(now moved.h5)" "[20,5.01]"
    change from.h5 'f["nsd"].attrs["time_origin"] = [float("nan"), 1e300]'
    step -n 10 set.h5 >moved.h5
    is "nor where it is none" "$(now moved.h5)" "[10,7.31]"
else
    skip "times that others have written" "no h5py"
fi

# ---- a drive's own time ----

drive() { scene ".time = 0.3 | .walls = [{point: [0, 0, -1], normal: [0, 0, 1], drives: [{along: [0, 0, 1], from: 0.3} + $1]}]"; }
height() { nsd-info --walls "$1" | jq 'select(.wall == 0).point[2]' | tail -n 1; }
drive '{amplitude: 0.1, frequency: 0.9, since_from: true}' >sine.h5
is "a sine since_from begins where the wall is" "$(height sine.h5)" -1
drive '{amplitude: 0.1, frequency: 0.9}' >sine.h5
ok "without, where the scene's time has brought it" eval "jq -n -e '($(height sine.h5) + 1 - 0.1 * (2 * 3.14159265358979 * 0.27 | sin)) | fabs < 1e-12'"
drive '{amplitude: 0.1, frequency: 0.9, since_from: true}' | step -n 200 --every 200 >sine.h5
ok "and goes on from there" eval "jq -n -e '($(height sine.h5) + 1 - 0.1 * (2 * 3.14159265358979 * 0.18 | sin)) | fabs < 1e-12'"
drive '{table: [[0, 0], [0.1, 0.2]], since_from: true}' | step -n 50 >table.h5
ok "a table, too" eval "jq -n -e '($(height table.h5) + 0.9) | fabs < 1e-12'"
drive '{amplitude: 0.1, frequency: 0.9, since_from: true, until: 0.4}' | step -n 200 --every 200 >until.h5
ok "until is of the scene's time" eval "jq -n -e '($(height until.h5) + 1 - 0.1 * (2 * 3.14159265358979 * 0.09 | sin)) | fabs < 1e-12'"
refuses 65 "since_from needs a from" eval \
    'echo "{\"dt\": 1, \"walls\": [{\"point\": [0, 0, 0], \"normal\": [0, 0, 1], \"drives\": [{\"along\": [0, 0, 1], \"amplitude\": 1, \"frequency\": 1, \"since_from\": true}]}]}" | nsd-gen -'

done_testing
