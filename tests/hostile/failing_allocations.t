#!/usr/bin/env bash
# No memory: whichever allocation fails, in a tool or in its libraries, nothing is lost silently.
# shellcheck source=tests/support/tap.sh disable=SC2154,SC2317 # tap.sh sets tmp; functions called by name
. tests/support/tap.sh

if grep -q __asan_init "$(command -v nsd-gen)"; then
    skip "allocations that fail" "a sanitizer has its own"
    done_testing
    exit
fi
cc -O1 -shared -fPIC -o "$tmp/nomemory.so" tests/support/preload/failing_allocations.c

stock solved4 >"$tmp/solved.h5"
nsd-detect --fclib=local "$tmp/solved.h5" >"$tmp/local.h5"
nsd-detect --fclib=global "$tmp/solved.h5" >"$tmp/global.h5"
nsd-step -m sbp -n 3 --contacts "$tmp/solved.h5" >"$tmp/run.h5" 2>/dev/null
tail -c +513 "$tmp/run.h5" >"$tmp/foreign.h5"
echo '1 2 3 0.5' >"$tmp/table"
cat >"$tmp/scene.json" <<'EOF'
{ "dt": 1e-4, "title": "a scene", "mu": 0.3, "materials": { "heavy": { "density": 7800 } },
  "pairs": [{ "pair": ["ball", "heavy"], "mu": 0.1, "e_n": 0.5 }],
  "bodies": [{ "file": "table" }, { "radius": 0.1, "x": [5, 5, 5], "material": "heavy", "fixed": true },
             { "count": 20, "radius": { "uniform": [0.1, 0.2] }, "thermal": 0.1, "box": { "x": [-1, 1], "y": [-1, 1], "z": [6, null] } }],
  "walls": [{ "point": [0, 0, -2], "normal": [0, 0, 1] }, { "box": { "x": [-20, 20], "y": [-20, 20], "z": [-1, null] } }] }
EOF
nsd-gen -d 2 5 >"$tmp/discs.h5"
jq -n '{ dim: 2, dt: 1e-4, mu: 0.5, density: 2500, gravity: [0, -9.81], walls: [{ box: { x: [0, 0.02], y: [0, null] } }],
    bodies: [{ count: 60, radius: 0.001, box: { x: [0, 0.02], y: [0, null] } }] }' | nsd-gen - | nsd-step --small-steps 0 -n 3000 --every 3000 2>/dev/null |
    nsd-cat --last | nsd-detect >"$tmp/pile.h5"
is "a pile whose solution takes Newton's steps" "$(nsd-solve --cold --criterion natural --tolerance 1e-12 "$tmp/pile.h5" | nsd-info -l | jq '.newton > 0')" true
printf 'v %s\n' '0 0 0' '1 0 0' '0 1 0' '0 0 1' >"$tmp/stone.obj"
printf 'f %s\n' '1 3 2' '1 2 4' '2 3 4' '3 1 4' >>"$tmp/stone.obj"
echo '{ "dt": 1e-3, "shapes": { "stone": { "mesh": { "file": "stone.obj" } } }, "bodies": [{ "x": [0, 0, 0], "shape": "stone" }] }' >"$tmp/stone.json"
jq '.shapes.stone.clump = {balls: 10}' "$tmp/stone.json" >"$tmp/clump.json"
nsd-export --to data -o "$tmp/four.data" "$tmp/solved.h5"
commands=("nsd-gen 20" "nsd-gen $tmp/scene.json" "nsd-gen $tmp/stone.json" "nsd-gen $tmp/clump.json" "nsd-gen --from $tmp/four.data"
    "nsd-export --to gsd $tmp/solved.h5" "nsd-cat --vtk all $tmp/run.h5" "nsd-info $tmp/solved.h5" "nsd-info $tmp/foreign.h5" "nsd-cat $tmp/solved.h5"
    "nsd-cat --frames 402:403 $tmp/run.h5" "nsd-err $tmp/solved.h5" "nsd-move $tmp/solved.h5" "nsd-detect --fclib=local $tmp/solved.h5"
    "nsd-detect --fclib=global $tmp/solved.h5" "nsd-view --size 32x32 $tmp/solved.h5" "nsd-view --network --size 300x300 $tmp/solved.h5"
    "nsd-view --svg $tmp/discs.h5" "nsd-web $tmp/run.h5" "nsd-solve -m sbp --max-sweeps 3 $tmp/solved.h5"
    "nsd-solve -m exact --max-sweeps 3 $tmp/local.h5" "nsd-solve -m eal --max-sweeps 3 $tmp/global.h5"
    "nsd-solve --cold --criterion natural --tolerance 1e-12 $tmp/pile.h5"
    "nsd-step -m sbp -n 2 $tmp/solved.h5" # the default goes on without Anderson where that finds no memory: other bytes
    "nsd-step -m sbp -n 2 --order colour --contacts $tmp/solved.h5" "nsd-step -n 2 --contacts --missing-impulse 0.1 $tmp/solved.h5" "nsd-gen --schema")
runs=14 # a command, spread over its allocations
[ -z "$thin" ] || runs=4
runs=${NSD_RUNS-$runs} # make coverage needs them all

# In the tool ("tool") or its libraries one allocation fails; of theirs, libhdf5 may die.
failing() # index of the run
{
    local at=$((1 + $1 * total / n)) s=0 out=$tmp/out.$BASHPID err=$tmp/err.$BASHPID
    # shellcheck disable=SC2086 # words
    { timeout 20 env NSD_FAIL_IN=$where NSD_FAIL_AT=$at LD_PRELOAD="$tmp/nomemory.so" $command >"$out" 2>"$err"; } 2>/dev/null || s=$?
    if [ $s = 0 ]; then
        cmp -s "$out" "$tmp/want" || echo "allocation $at: status 0, and another output"
    elif [ "$where" = tool ]; then
        { [ $s = 70 ] || [ $s = 65 ]; } && grep -q "^${command%% *}: " "$err" || echo "allocation $at: status $s, $(tail -n 1 "$err")"
    fi
}
for command in "${commands[@]}"; do
    # shellcheck disable=SC2086 # words
    $command >"$tmp/want" 2>/dev/null
    for where in tool library; do
        # what cairo and pixman have no memory for, they leave out or draw otherwise, and tell nobody
        [[ $where != library || ! $command =~ --network|--svg ]] || continue
        # the libraries' archives lie behind the tool's own code, libhdf5's first
        NSD_TOOL_END=$(nm "$(command -v "${command%% *}")" | awk '$2 ~ /[Tt]/ && $3 ~ /^H5[A-Z]/ && $3 !~ /[.]cold/ { print $1 }' | sort | sed -n 1p)
        export NSD_TOOL_END
        # shellcheck disable=SC2086 # words
        NSD_FAIL_IN=$where NSD_COUNT=$tmp/count LD_PRELOAD="$tmp/nomemory.so" $command >/dev/null 2>&1
        total=$(cat "$tmp/count")
        n=$((total < runs ? total : runs))
        ok_each "${command//$tmp\//}: of $total allocations in the $where one fails: an error, or the same bytes" failing $n
    done
done
done_testing
