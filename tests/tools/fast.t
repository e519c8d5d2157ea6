#!/usr/bin/env bash
# A ball that goes 1000 of its diameters in a step does not cross what lies on its way: a sheet, a disc, a mesh, a thin
# fixed body; also where a place that is looked at has its centre on the sheet.
# shellcheck source=tests/support/tap.sh disable=SC2154,SC2317 # tap.sh sets tmp; functions called by name
. tests/support/tap.sh

stops() # WALLS BODIES PLACE: the ball, from x = 0 with 20 000 m/s and steps of 1 ms, is in front of the place after 5 steps
{
    jq -n "{ dt: 1e-3, gravity: [0, 0, 0], shapes: { thin: { box: [0.01, 2, 2] } }, walls: ($1),
        bodies: ([{ x: [0, 0.1, 0.2], radius: 0.01, v: [20000, 0, 0] }] + ($2)) }" >"$tmp/fast.json"
    nsd-gen "$tmp/fast.json" | nsd-step -n 5 2>/dev/null | nsd-info --last -p | jq -se --argjson x "$3" '.[0].x[0] < $x and .[0].x[0] > $x - 0.03'
}
for x in 15 15.003 17.2501; do
    printf 'v %s -1 -1\nv %s 1 -1\nv %s 1 1\nv %s -1 1\nf 1 2 3\nf 1 3 4\n' $x $x $x $x >"$tmp/sheet.obj"
    ok "a sheet at $x m" stops "[{ rectangle: { center: [$x, 0, 0], normal: [1, 0, 0], sides: [2, 2] } }]" '[]' $x
    ok "with its normal the other way" stops "[{ rectangle: { center: [$x, 0, 0], normal: [-1, 0, 0], sides: [2, 2] } }]" '[]' $x
    ok "a disc" stops "[{ disc: { center: [$x, 0, 0], normal: [1, 0, 0], radius: 1 } }]" '[]' $x
    ok "a mesh" stops '[{ mesh: { file: "sheet.obj" } }]' '[]' $x
    ok "a thin fixed body" stops '[]' "[{ x: [$x, 0, 0], shape: \"thin\", size: 1, fixed: true }]" $x
done

done_testing
