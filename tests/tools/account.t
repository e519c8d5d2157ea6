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
row='(.overlap | [(.value * 1e9 | round) / 1e9, .step, .bodies, .fails]), .wedged.value, .unconverged.value'
pair 0.05
status 0 "5 % of a radius are no failure" nsd-step -e --overlap keep -n 3 "$tmp/pair.h5"
is "a line says them at once" "$(head -n 1 "$tmp/err")" \
    "nsd-step: overlap 0.05 of a radius (step 1, bodies 1 and 2): a smaller dt leaves less: --dt, or --dt auto:0.01"
is "and the last line" "$(tail -n 1 "$tmp/err")" \
    "nsd-step: worst: overlap 0.05 of a radius (step 1, bodies 1 and 2), approach 0 m/s, 0 wedged, 0 went through a wall or another body, 0 steps not converged"
is "the document has them, in the smaller radius" "$(account "$tmp/out" "$row" | paste -sd ' ')" '[0.05,1,[1,2],false] 0 0'
pair 0.12
status 0 "12 % are one, but not without -e" nsd-step --overlap keep "$tmp/pair.h5"
status 1 "with -e they are" nsd-step -e --overlap keep --log "$tmp/log" -n 3 "$tmp/pair.h5"
is "which the document says" "$(account "$tmp/out" "$row" | paste -sd ' ')" '[0.12,1,[1,2],true] 0 0'
is "and the last line of the log, and no other" "$(jq -s -c 'map(.account.overlap.bodies)' "$tmp/log")" '[null,null,[1,2]]'
ok "the same" [ "$(tail -n 1 "$tmp/log" | jq -c .account)" = "$(account "$tmp/out" .)" ]
pair 0
status 0 "bodies that touch" nsd-step -e "$tmp/pair.h5"
is "have no account but its last line" "$(grep -c . "$tmp/err"), $(tail -n 1 "$tmp/err")" \
    "2, nsd-step: worst: overlap 0 of a radius, approach 0 m/s, 0 wedged, 0 went through a wall or another body, 0 steps not converged"

# A ball between walls that are 0.22 of its radius too near; beside it one that only leans on one of them.
jq -n '{ dt: 1e-3, gravity: [0, 0, 0], overlap: true, bodies: [{ x: [5, 0, 0.85], radius: 1 }, { x: [0, 0, 0.89], radius: 1 }, { x: [9, 0, 0.5], radius: 0.55 }],
    walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }, { rectangle: { center: [0, 0, 1.78], normal: [0, 0, -1], along: [1, 0, 0], sides: [2, 2] } }] }' |
    nsd-gen - >"$tmp/wedge.h5"
nsd-step --overlap keep "$tmp/wedge.h5" 2>"$tmp/err" >"$tmp/wedged.h5"
is "a ball between walls is wedged, others are not" "$(account "$tmp/wedged.h5" '.wedged | [.value, .step, .bodies, .fails]')" '[1,1,[1],true]'
is "the deepest is in the floor" "$(account "$tmp/wedged.h5" .overlap.bodies)" '[-1,0]'
like "which has its name" "$(tail -n 1 "$tmp/err")" 'bodies wall 0 and 0\), approach [^,]*, 1 wedged \(step 1, body 1\)'

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
    mpi -n 1 --order block --overlap keep -o "$tmp/blocks.h5" "$tmp/wedge.h5"
    is "and in blocks" "$(account "$tmp/blocks.h5" .)" "$(account "$tmp/wedged.h5" .)"
fi

done_testing
