#!/usr/bin/env bash
# A ball that goes 1000 of its diameters in a step does not cross what lies on its way: a sheet, a disc, a mesh, a thin
# fixed body; also where a place that is looked at has its centre on the sheet. What passes another body where steps
# are not divided is counted. Bodies that meet within a step: tests/whole/fast_bodies.t.
# shellcheck source=tests/support/tap.sh disable=SC2154,SC2317 # tap.sh sets tmp; functions called by name
. tests/support/tap.sh

stops() # WALLS BODIES PLACE: the ball, from x = 0 with 20 000 m/s and steps of 1 ms, is in front of the place after 5 steps
{
    jq -n "{ dt: 1e-3, gravity: [0, 0, 0], shapes: { thin: { box: [0.01, 2, 2] } }, walls: ($1),
        bodies: ([{ x: [0, 0.1, 0.2], radius: 0.01, v: [20000, 0, 0] }] + ($2)) }" >"$tmp/fast.json"
    nsd-gen "$tmp/fast.json" | nsd-step --solver auto -n 5 2>/dev/null | nsd-info --last -p | jq -se --argjson x "$3" '.[0].x[0] < $x and .[0].x[0] > $x - 0.03'
}
for x in 15 15.003 17.2501; do
    printf 'v %s -1 -1\nv %s 1 -1\nv %s 1 1\nv %s -1 1\nf 1 2 3\nf 1 3 4\n' $x $x $x $x >"$tmp/sheet.obj"
    ok "a sheet at $x m" stops "[{ rectangle: { center: [$x, 0, 0], normal: [1, 0, 0], sides: [2, 2] } }]" '[]' $x
    ok "with its normal the other way" stops "[{ rectangle: { center: [$x, 0, 0], normal: [-1, 0, 0], sides: [2, 2] } }]" '[]' $x
    ok "a disc" stops "[{ disc: { center: [$x, 0, 0], normal: [1, 0, 0], radius: 1 } }]" '[]' $x
    ok "a mesh" stops '[{ mesh: { file: "sheet.obj" } }]' '[]' $x
    ok "a thin fixed body" stops '[]' "[{ x: [$x, 0, 0], shape: \"thin\", size: 1, fixed: true }]" $x
done

# ---- bodies that both move, in steps that are not divided: what passes is counted, not silent ----

scene() # BODIES [MORE]: the start of them, with steps of 1 ms
{
    jq -n "{ dt: 1e-3, gravity: [0, 0, 0], shapes: { thin: { box: [0.01, 2, 2] } }, bodies: ($1) } + (${2:-{\}})" | nsd-gen - >"$tmp/pass.h5"
}
passed() # BODIES [MORE]: how many passed in three steps, and who of them through what
{
    scene "$@"
    nsd-step --substeps 1 -n 3 --contacts -o "$tmp/passed.h5" "$tmp/pass.h5" 2>"$tmp/err" || true
    nsd-info --last "$tmp/passed.h5" | jq -r 'select(.account).account.tunnelled.value'
    sed -n 's/.*worst: .* \([0-9]*\) tunnelled through a wall or another body \((\(first \)\?step [^)]*)\).*/\2/p' "$tmp/err"
}
ball='{ x: [0, 0.1, 0.2], radius: 0.01, v: [20000, 0, 0] }'
is "a ball through a ball at rest" "$(passed "[$ball, { x: [15, 0.1, 0.2], radius: 0.1 }]")" $'1\n(step 1, bodies 0 and 1)'
is "through one that is fixed" "$(passed "[{ x: [15, 0.1, 0.2], radius: 0.1, fixed: true }, $ball]")" $'1\n(step 1, bodies 1 and 0)'
is "two that go through one another are one" "$(passed "[$ball, { x: [40, 0.1, 0.21], radius: 0.1, v: [-20000, 0, 0] }]")" $'1\n(step 1, bodies 0 and 1)'
is "through a thin body that is free" "$(passed "[$ball, { x: [15, 0, 0], shape: \"thin\", size: 1 }]")" $'1\n(step 1, bodies 0 and 1)'
is "a thin body through a ball at rest" "$(passed '[{ x: [0, 0, 0], shape: "thin", size: 0.1, v: [20000, 0, 0] }, { x: [15, 0.01, 0.02], radius: 0.01 }]')" $'1\n(step 1, bodies 0 and 1)'
is "two of them, in two steps" "$(passed "[$ball, { x: [15, 0.1, 0.2], radius: 0.1 }, { x: [35, 0.1, 0.2], radius: 0.1 }]")" $'2\n(first step 1, bodies 0 and 1)'
is "across the border of a cell, again a round later" "$(passed '[{ x: [9, 0.1, 0.2], radius: 0.01, v: [5000, 0, 0] }, { x: [2.5, 0.1, 0.2], radius: 0.1 }]' '{ cell: { lengths: [10, 1, 1] } }')" $'2\n(first step 1, bodies 0 and 1)'
is "over the border at its side, again a round later" "$(passed '[{ x: [0.3, 0.01, 0.2], radius: 0.01, v: [5000, 0, 0] }, { x: [5, 0.95, 0.2], radius: 0.1 }]' '{ cell: { lengths: [10, 1, 1] } }')" $'2\n(first step 1, bodies 0 and 1)'
is "one that goes past is none" "$(passed "[$ball, { x: [15, 0.1, 0.32], radius: 0.1 }, { x: [15, 0, 1.5], shape: \"thin\", size: 0.5 }]")" 0
is "one that ends where it meets, and is a contact there, is none" "$(passed "[$ball, { x: [30, 0.1, 0.2], radius: 0.1 }]")" 0
is "two that go side by side are none" "$(passed "[$ball, { x: [0, 0.1, 0.25], radius: 0.01, v: [20000, 0, 0] }]")" 0
is "nor is a ball that is slower than it is thick" "$(passed '[{ x: [0, 0, 0], radius: 0.01, v: [9, 0, 0] }, { x: [0.021, 0, 0], radius: 0.01 }]')" 0
ok "which the log names" eval "scene '[$ball, { x: [15, 0.1, 0.2], radius: 0.1 }]' && nsd-step --substeps 1 -n 1 --log '$tmp/log' '$tmp/pass.h5' >/dev/null 2>&1; jq -e '.tunnelled == 1' '$tmp/log' >/dev/null"

is "and -e fails" "$(nsd-step --substeps 1 -e -n 1 "$tmp/pass.h5" >/dev/null 2>&1 && echo 0 || echo $?)" 1

# What lies before the place where contacts are sought first, 10 m ahead
sheet='{ walls: [{ rectangle: { center: [5, 0, 0], normal: [1, 0, 0], sides: [2, 2] } }] }'
is "a sheet within the first half step is passed, and counted once" "$(passed "[$ball]" "$sheet")" $'1\n(step 1, body 0 and wall 0)'
is "a thin fixed body there" "$(passed "[$ball, { x: [5, 0, 0], shape: \"thin\", size: 1, fixed: true }]")" $'1\n(step 1, bodies 0 and 1)'
is "a ball there" "$(passed "[$ball, { x: [5, 0.1, 0.2], radius: 0.1 }]")" $'1\n(step 1, bodies 0 and 1)'
is "a sheet there that the ball goes past" "$(passed "[{ x: [0, 1.5, 0.2], radius: 0.01, v: [20000, 0, 0] }]" "$sheet")" 0
scene "[$ball]" "$sheet"
nsd-step --substeps 1 -n 1 -o "$tmp/one.h5" "$tmp/pass.h5" 2>/dev/null || true
is "a run that resumes does not count it again" "$(nsd-step --substeps 1 -n 2 "$tmp/one.h5" 2>&1 >/dev/null | grep -o '[0-9]* tunnelled through a wall or another body' | sort -u)" '0 tunnelled through a wall or another body'

# Many, in a cell that is sheared: the count by all pairs and images is the one that is found
awk 'BEGIN { srand(7); for (i = 0; i < 300; i++) print rand(), rand(), rand(), 0.008 + 0.008 * rand(), i % 3 ? 0 : 800 * (rand() - 0.5), 800 * (rand() - 0.5), 800 * (rand() - 0.5) }' |
    jq -s -R '{ dt: 1e-3, gravity: [0, 0, 0], overlap: true, cell: { lengths: [1, 1, 1], gradient: [[0, 20, 0], [0, 0, 0], [0, 0, 0]], affine: false },
        bodies: [split("\n")[] | select(length > 0) | split(" ") | map(tonumber) | { x: .[0:3], radius: .[3], v: .[4:7] }] }' | nsd-gen - >"$tmp/many.h5"
nsd-step --substeps 1 -n 1 --contacts -o "$tmp/many_run.h5" "$tmp/many.h5" 2>/dev/null || true
nsd-info -p --last "$tmp/many_run.h5" | jq -r 'select(.id != null) | [.id, .radius, .x[], .v[]] | @tsv' >"$tmp/many.tsv"
found=$(nsd-info --last "$tmp/many_run.h5" | jq 'select(.account).account.tunnelled.value')
pairs() # FILE BACK LENGTH TILT: of id, radius, x, v; from x - v BACK by v LENGTH, with the second edge tilted by TILT
{
    awk -v back="$2" -v len="$3" -v tilt="$4" '{ r[NR] = $2; for (k = 0; k < 3; k++) { x[NR, k] = $(3 + k); v[NR, k] = $(6 + k) } }
        END { for (i = 1; i <= NR; i++) for (j = i + 1; j <= NR; j++) for (a = -1; a <= 1; a++) for (b = -1; b <= 1; b++) for (c = -1; c <= 1; c++) {
            s[0] = a + tilt * b; s[1] = b; s[2] = c; u[0] = 20 * b; u[1] = u[2] = 0; dd = ww = dw = ee = 0; R = r[i] + r[j]
            for (k = 0; k < 3; k++) { V = v[j, k] + u[k] - v[i, k]; d = x[j, k] + s[k] - x[i, k] - back * V; w = len * V; dd += d * d; ww += w * w; dw += d * w; ee += (d + w) ^ 2 }
            t = ww > 0 ? -dw / ww : 0
            if (ww > R * R && t > 0 && t < 1 && dd >= R * R && ee >= R * R && dd - dw * dw / ww < (0.99 * R) ^ 2) n++ }
            print n + 0 }' "$1"
}
nsd-info -p "$tmp/many.h5" | jq -r 'select(.id != null) | [.id, .radius, .x[], .v[]] | @tsv' >"$tmp/many0.tsv"
expected=$(($(pairs "$tmp/many0.tsv" 0 5e-4 0) + $(pairs "$tmp/many.tsv" 5e-4 1e-3 0.02)))
ok "of 300 bodies in a sheared cell $found pass, by all pairs and images $expected" test "$found" -gt 10 -a "$found" = "$expected"
nsd-step --substeps 1 -n 3 --contacts -o "$tmp/many_three.h5" "$tmp/many.h5" 2>/dev/null || true
nsd-step --substeps 1 -j 4 -n 3 --contacts -o "$tmp/many_j4.h5" "$tmp/many.h5" 2>/dev/null || true
ok "4 threads write the bytes of one" cmp "$tmp/many_j4.h5" "$tmp/many_three.h5"
if have_ranks; then
    ranks 3 nsd-step --substeps 1 -n 3 --contacts -o "$tmp/many_ranks.h5" "$tmp/many.h5" 2>/dev/null || true
    ok "3 processes write the bytes of one" cmp "$tmp/many_ranks.h5" "$tmp/many_three.h5"
    ranks 3 nsd-step --substeps 1 --order block -n 1 -o "$tmp/many_blocks.h5" "$tmp/many.h5" 2>/dev/null || true
    is "and in blocks count as many" "$(nsd-info --last "$tmp/many_blocks.h5" | jq 'select(.account).account.tunnelled.value')" "$found"
else
    skip "3 processes write the bytes of one" "no MPI"
fi

done_testing
