#!/usr/bin/env bash
# One solve per step: bodies that go farther in a step than they are thick may pass through others unseen. They are counted, said
# and fail a run under -e. What small steps lack something for is solved in parts in which nothing is too fast.
# shellcheck source=tests/support/tap.sh disable=SC2154 # tap.sh sets tmp
. tests/support/tap.sh

scene() # BODIES [MORE]: the start of them, with steps of 1 ms
{
    jq -n "{ dt: 1e-3, gravity: [0, 0, 0], shapes: { thin: { box: [0.01, 2, 2] } }, bodies: ($1) } + (${2:-{\}})" | nsd-gen - >"$tmp/in.h5"
}
fast() # BODIES [MORE]: how many are too fast in a step, and who is the first
{
    scene "$@"
    nsd-step --solver auto -n 2 -o "$tmp/out.h5" "$tmp/in.h5" 2>"$tmp/err" || true
    nsd-info --last "$tmp/out.h5" | jq -r 'select(.account).account.fast.value'
    sed -n 's/.*worst: .* \([0-9]*\) too fast \(([^)]*)\).*/\2/p' "$tmp/err"
}
sheet='{ walls: [{ rectangle: { center: [5, 0, 0], normal: [1, 0, 0], sides: [2, 2] } }] }'
floor='{ walls: [{ point: [0, 0, -1], normal: [0, 0, 1] }] }'
at_rest='{ x: [15, 0.1, 0.2], radius: 0.1 }'
is "a ball, of two" "$(fast "[$at_rest, { x: [0, 0, 0], radius: 0.01, v: [0, 11, 0] }]")" $'1\n(step 1, body 1)'
is "two of three" "$(fast "[{ x: [1, 0, 0], radius: 0.01, v: [0, 11, 0] }, $at_rest, { x: [0, 0, 0], radius: 0.02, v: [21, 0, 0] }]")" $'2\n(step 1, body 0)'
is "a ball that goes less far than its radius is none" "$(fast "[$at_rest, { x: [0, 0, 0], radius: 0.01, v: [0, 9, 0] }]")" 0
is "a ball alone with a sheet" "$(fast '[{ x: [0, 0, 0], radius: 0.01, v: [0, 11, 0] }]' "$sheet")" $'1\n(step 1, body 0)'
is "alone with a plane it has nothing to pass" "$(fast '[{ x: [0, 0, 0], radius: 0.01, v: [0, 11, 0] }]' "$floor")" 0
is "a thin box, by its thickness" "$(fast "[$at_rest, { x: [0, 0, 0], shape: \"thin\", size: 1, v: [6, 0, 0] }]")" $'1\n(step 1, body 1)'
is "which slower is none" "$(fast "[$at_rest, { x: [0, 0, 0], shape: \"thin\", size: 1, v: [4, 0, 0] }]")" 0
is "relative to a wall that moves" "$(fast "[{ x: [0, 0, 0], radius: 0.01 }, $at_rest]" \
    '{ walls: [{ rectangle: { center: [5, 0, 0], normal: [1, 0, 0], sides: [2, 2] }, velocity: [0, 11, 0] }] }')" $'1\n(step 1, body 0)'
is "a fixed body is none" "$(fast "[{ x: [0, 0, 0], radius: 0.01, fixed: true }, $at_rest]")" 0
scene "[$at_rest, { x: [0, 0, 0], radius: 0.01, v: [2000, 0, 0] }]" '{ dt: 2e-4 }'
ok "the log counts them" eval "nsd-step --solver auto -n 1 --log '$tmp/log' '$tmp/in.h5' >/dev/null 2>&1; jq -e '.fast == 1' '$tmp/log' >/dev/null"
nsd-step --solver auto -e -n 1 "$tmp/in.h5" >/dev/null 2>"$tmp/err" && s=0 || s=$?
is "-e fails" "$s" 1
like "with the cure" "$(cat "$tmp/err")" 'leave out --dt, for small steps'
ok "small steps make the same step" nsd-step -e -n 1 -o "$tmp/out.h5" "$tmp/in.h5"
refuses 64 "--substeps says what to do" nsd-step --substeps 5 "$tmp/in.h5"

# ---- what small steps lack something for, here contacts that are too stiff: parts of a step, in which nothing is too fast ----

soft() # SPEED STEPS: the ball's place in the end, where nothing was too fast
{
    jq -n "{ dt: 1e-3, gravity: [0, 0, 0], stiffness: 1e12, walls: [{ rectangle: { center: [1, 0, 0], normal: [1, 0, 0], sides: [2, 2] } }],
        bodies: [{ x: [0, 0.1, 0.2], radius: 0.01, v: [$1, 0, 0] }] }" | nsd-gen - >"$tmp/in.h5"
    nsd-step --small-steps 0.01 -e -n "$2" -o "$tmp/out.h5" "$tmp/in.h5" 2>"$tmp/err" && nsd-info -p --last "$tmp/out.h5" | jq -s 'map(select(.id == 0))[0].x[0]'
}
for v in 15 35; do
    ok "a ball of $v radii in 10 steps does not pass a sheet" jq -n -e "$(soft "$v" 100) < 1"
done
soft 200000 5 >/dev/null && s=0 || s=$?
is "what would need more parts is too fast, and fails" "$s" 1
nsd-step --small-steps 0.01 -n 3 --contacts -o "$tmp/one.h5" "$tmp/in.h5" 2>/dev/null
nsd-step --small-steps 0.01 -n 3 -j 4 --contacts -o "$tmp/four.h5" "$tmp/in.h5" 2>/dev/null
ok "4 threads write the bytes of one" cmp "$tmp/one.h5" "$tmp/four.h5"

scene "[range(40) | { x: [(. * 0.03), 0, 0], radius: 0.01, v: [0, (if . < 7 then 50 else 0 end), (. * 0.1)] }]"
nsd-step --solver auto -n 2 --contacts -o "$tmp/one.h5" "$tmp/in.h5" 2>/dev/null
if have_ranks; then
    ranks 3 nsd-step --solver auto -n 2 --contacts -o "$tmp/ranks.h5" "$tmp/in.h5" 2>/dev/null || true
    ok "3 processes write the bytes of one" cmp "$tmp/ranks.h5" "$tmp/one.h5"
    ranks 3 nsd-step --order block -n 2 -o "$tmp/blocks.h5" "$tmp/in.h5" 2>/dev/null || true
    is "and in blocks count as many" "$(nsd-info --last "$tmp/blocks.h5" | jq 'select(.account).account.fast.value')" 7
else
    skip "3 processes write the bytes of one" "no MPI"
    skip "and in blocks count as many" "no MPI"
fi

done_testing
