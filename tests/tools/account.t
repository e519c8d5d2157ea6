#!/usr/bin/env bash
# The account of a run: what nsd-step says in its last line, in the log and in documents is what the scene
# makes it, and decides the exit status under -e.
# shellcheck source=tests/support/tap.sh disable=SC2317 # functions called by name
. tests/support/tap.sh

account() { nsd-info --last "$1" | jq -c "select(.account).account | $2"; }

# Balls of radius 1 and 2 at rest whose surfaces are DEPTH in one another; a third far away
pair()
{
    jq -n --argjson depth "$1" '{ dt: 1e-3, gravity: [0, 0, 0], overlap: true, bodies: [{ x: [9, 0, 0], radius: 1 },
        { x: [0, 0, 0], radius: 1 }, { x: [3 - $depth, 0, 0], radius: 2 }] }' | nsd-gen - >"$tmp/pair.h5"
}
row='(.overlap | [(.value * 1e9 | round) / 1e9, .step, .bodies, .fails]), .pinched.value, .unconverged.value'
pair 0.05
status 0 "5 % of a radius are no failure" nsd-step -e --overlap-rule keep -n 3 "$tmp/pair.h5"
is "a line says them at once" "$(head -n 1 "$tmp/err")" \
    "nsd-step: overlap 0.05 of a radius (step 1, bodies 1 and 2): a smaller dt leaves less, and so do small steps"
is "and the last line" "$(tail -n 1 "$tmp/err")" \
    "nsd-step: worst: overlap 0.05 of a radius (step 1, bodies 1 and 2), approach 0 m/s, 0 pinched, 0 too fast, 0 steps not converged"
is "the document has them, in the smaller radius" "$(account "$tmp/out" "$row" | paste -sd ' ')" '[0.05,1,[1,2],false] 0 0'
pair 0.12
status 0 "12 % are one, but not without -e" nsd-step --overlap-rule keep "$tmp/pair.h5"
is "which is said at once" "$(head -n 1 "$tmp/err")" \
    "nsd-step: overlap 0.12 of a radius (step 1, bodies 1 and 2): a smaller dt leaves less, and so do small steps: the step fails, and the run continues"
status 1 "with -e they are" nsd-step -e --keep-going --overlap-rule keep --log "$tmp/log" -n 3 "$tmp/pair.h5"
is "which the document says" "$(account "$tmp/out" "$row" | paste -sd ' ')" '[0.12,1,[1,2],true] 0 0'
is "and the last line of the log, and no other" "$(jq -s -c 'map(.account.overlap.bodies)' "$tmp/log")" '[null,null,[1,2]]'
cp "$tmp/out" "$tmp/on.h5"
ok "the same" [ "$(tail -n 1 "$tmp/log" | jq -c .account)" = "$(account "$tmp/out" .)" ]
status 1 "without --keep-going the run ends with that step" nsd-step -e --overlap-rule keep --log "$tmp/log" -n 3 --every 3 "$tmp/pair.h5"
is "which is kept, and no other" "$(nsd-info "$tmp/out" | jq -s -c '[.[1:][].step], .[-1].account.overlap.fails, .[-1].balance.kinetic' | paste -sd ' ')" '[1] true 0'
is "the log has its account" "$(jq -s -c 'map(.account.overlap.bodies)' "$tmp/log")" '[[1,2]]'
like "it is said at once" "$(head -n 1 "$tmp/err")" 'bodies 1 and 2\): .*: the step fails, and the run ends with it$'
is "and in the last line" "$(tail -n 1 "$tmp/err")" "nsd-step: step 1, which is kept, fails and ends the run: --keep-going makes all steps"
refuses 64 "--keep-going alone" nsd-step --keep-going "$tmp/pair.h5"
pair 0
status 0 "bodies that touch" nsd-step --solver auto -e "$tmp/pair.h5"
is "have no account but its last line" "$(grep -c . "$tmp/err"), $(tail -n 1 "$tmp/err")" \
    "2, nsd-step: worst: overlap 0 of a radius, approach 0 m/s, 0 pinched, 0 too fast, 0 steps not converged"

# A ball between walls that are 0.22 of its radius too near; beside it one that only leans on one of them.
jq -n '{ dt: 1e-3, gravity: [0, 0, 0], overlap: true, bodies: [{ x: [5, 0, 0.85], radius: 1 }, { x: [0, 0, 0.89], radius: 1 }, { x: [9, 0, 0.5], radius: 0.55 }],
    walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }, { rectangle: { center: [0, 0, 1.78], normal: [0, 0, -1], along: [1, 0, 0], sides: [2, 2] } }] }' |
    nsd-gen - >"$tmp/wedge.h5"
nsd-step --overlap-rule keep "$tmp/wedge.h5" 2>"$tmp/err" >"$tmp/wedged.h5"
is "a ball between walls is pinched, others are not" "$(account "$tmp/wedged.h5" '.pinched | [.value, .step, .bodies, .fails]')" '[1,1,[1],true]'
is "the deepest is in the floor" "$(account "$tmp/wedged.h5" .overlap.bodies)" '["wall 0",0]'
like "which has its number" "$(tail -n 1 "$tmp/err")" 'step 1, wall 0 and body 0\), approach [^,]*, 1 pinched \(step 1, body 1\)'

# A plate presses a ball onto the floor: no step has a solution.
jq -n '{ dt: 1e-3, mu: 1, bodies: [{ x: [0, 0, 0], radius: 0.1, mass: 1 }], walls: [{ point: [0, 0, -0.1], normal: [0, 0, 1], name: "floor" },
    { point: [0, 0, 0.1], normal: [0, 0, -1], velocity: [0, 0, -0.1] }] }' | nsd-gen - >"$tmp/press.h5"
status 1 "a run without a solution ends with 1 without -e" nsd-step --solver auto --contacts -n 5 "$tmp/press.h5"
cp "$tmp/out" "$tmp/pressed.h5"
like "says at once which step, and who" "$(head -n 2 "$tmp/err")" \
    '1 step not converged \(step 1, wall (0 \(floor\)|1) and body 0\): no solution, .*: the step fails, and the run continues'
like "and in the last line" "$(tail -n 1 "$tmp/err")" '5 steps not converged \(first step 1, wall .* and body 0\), 5 without a solution$'
most=$(nsd-info -c "$tmp/pressed.h5" | jq -s -r 'map(select(.step == 1 and .status == "jammed")) | max_by(.r[0]) | .name // "wall \(.wall)"')
is "whose contact has the largest reaction" "$(account "$tmp/pressed.h5" '.unconverged.bodies')" "[\"$most\",0]"
stop() # what command ...
{
    status 1 "$1: with -e it ends with its first step" "${@:2}" nsd-step --solver auto -e -n 5 --every 5 -o "$tmp/stop.h5" "$tmp/press.h5"
    is "$1: which is kept" "$(nsd-info "$tmp/stop.h5" | jq -s -c '[.[1:][] | [.step, .account.unconverged.value]]')" '[[1,1]]'
}
stop "one process" env
status 1 "--until" nsd-step --solver auto -e --until 5e-3 -j 2 "$tmp/press.h5"
is "--until, two threads: the same" "$(nsd-info "$tmp/out" | jq -s -c 'map(.step // empty)')" '[1]'
status 1 "--with" nsd-step --solver auto -e -n 5 --with "jq -c --unbuffered '{}'" -o "$tmp/with.h5" "$tmp/press.h5"
status 1 "--replay" nsd-step --solver auto -e -n 5 --replay "$tmp/with.h5" "$tmp/press.h5"
is "--with and --replay: the same" "$(for f in with.h5 out; do nsd-info "$tmp/$f" | jq -s -c 'map(.step // empty)'; done | paste -sd ' ')" '[1] [1]'
nsd-stat -m boundaries "$tmp/pressed.h5" 2>"$tmp/err" | jq -s -c 'map(.unconverged)' >"$tmp/out"
is "nsd-stat has the number of such steps in each line" "$(cat "$tmp/out")" '[1,1,1,1,1]'
is "and says so" "$(cat "$tmp/err")" \
    "nsd-stat: 5 steps NOT CONVERGED, the first is step 1: their forces, and the motion by them, are no solution; of 5 frames 5 have such forces (key unconverged)"
nsd-step --solver auto -n 4 --every 4 --wall-loads "$tmp/press.h5" 2>/dev/null >"$tmp/sums.h5" || true
is "of sums, those of their span" "$(nsd-stat -m sums "$tmp/sums.h5" 2>/dev/null | jq .unconverged)" 4

# A bed that falls too fast for its dt, and solves that are ended early
jq -n '{ dt: 2e-3, mu: 0.3, e_n: 0.5, seed: 1, bodies: [{ count: 60, radius: 5e-3, spacing: 1.3, v: [0, 0, -2], box: { x: [0, 0.05], y: [0, 0.05], z: [0, null] } }],
    walls: [{ box: { x: [0, 0.05], y: [0, 0.05], z: [0, null] } }] }' | nsd-gen - >"$tmp/bed.h5"
run() { nsd-step -n 40 --max-sweeps 2 "$@" 2>"$tmp/err"; }
run "$tmp/bed.h5" >"$tmp/whole.h5"
ok "a bed that falls too fast fails, and says when" \
    test "$(account "$tmp/whole.h5" '.steps == 40 and .overlap.fails and .unconverged.fails and .approach.value > 0')" = true
is "its largest overlap is that of its steps" "$(account "$tmp/whole.h5" '.overlap.value * 0.005 * 1e9 | round')" \
    "$(nsd-info "$tmp/whole.h5" | jq -s 'map(.max_overlap // empty) | max * 1e9 | round')"
is "its largest approach, and the step" "$(account "$tmp/whole.h5" '.approach | [.value, .step]')" \
    "$(nsd-info "$tmp/whole.h5" | jq -s -c 'map(select(.max_penetration_true)) | max_by(.max_penetration_true) | [.max_penetration_true, .step]')"
is "steps that did not converge are counted" "$(account "$tmp/whole.h5" '.unconverged | [.value, .step]')" \
    "$(nsd-info "$tmp/whole.h5" | jq -s -c 'map(select(.converged == false)) | [length, .[0].step]')"
nsd-step -n 15 --max-sweeps 2 -o "$tmp/parts.h5" "$tmp/bed.h5" 2>/dev/null
nsd-step -n 25 --max-sweeps 2 -i "$tmp/parts.h5" 2>/dev/null
is "a run that is resumed ends with the account of one that was not" "$(account "$tmp/parts.h5" .)" "$(account "$tmp/whole.h5" .)"
run -j 2 "$tmp/bed.h5" >"$tmp/threads.h5"
ok "two threads give the same bytes" cmp "$tmp/whole.h5" "$tmp/threads.h5"
if have_ranks; then
    mpi() { ranks 2 nsd-step "$@" 2>"$tmp/err"; }
    mpi -n 40 --max-sweeps 2 -o "$tmp/ranks.h5" "$tmp/bed.h5"
    is "two processes give the same account" "$(account "$tmp/ranks.h5" .)" "$(account "$tmp/whole.h5" .)"
    stop "two processes" ranks 2
    status 1 "in blocks, too" ranks 2 nsd-step -e -n 5 --every 5 --order block -o "$tmp/stop.h5" "$tmp/press.h5"
    is "in blocks the step is kept, without its report" "$(nsd-info -p --last "$tmp/stop.h5" | jq -c '.step')" 1
    mpi -n 1 --order block --overlap-rule keep -o "$tmp/blocks.h5" "$tmp/wedge.h5"
    is "and in blocks" "$(account "$tmp/blocks.h5" .)" "$(account "$tmp/wedged.h5" .)"
fi

done_testing
