#!/usr/bin/env bash
# nsd-stat -m strain against closed forms: cells that are sheared, compressed and recut, boxes of walls.
# shellcheck source=tests/support/tap.sh disable=SC2016 # jq programs
. tests/support/tap.sh

strain() { nsd-stat -m strain "$@" 2>/dev/null; }
holds() { jq -e "$1" >/dev/null; }
step() { nsd-step "$@" 2>/dev/null; }

# cell DIM GRADIENT STEPS EVERY: bodies that follow the flow and do not meet; 1 ms a step
cell()
{
    jq -n --argjson dim "$1" --argjson L "$2" '{ dim: $dim, dt: 1e-3, gravity: [range($dim) | 0],
        cell: { lengths: [range($dim) | 1], gradient: $L },
        bodies: [{ x: [range($dim) | 0.3], radius: 1e-4 }, { x: [range($dim) | 0.7], radius: 1e-4 }] }' |
        nsd-gen - >"$tmp/start.h5"
    step -n "$3" --every "$4" -o "$tmp/cell.h5" "$tmp/start.h5"
}

# gamma of simple shear: F = [[1, gamma], [0, 1]], whose principal strains are +-asinh(gamma/2)
for every in 100 1000 1700; do
    cell 2 '[[0, 2], [0, 0]]' 5100 $every
    ok "simple shear by 10.2 through ten cuts of the cell, frames $every steps apart: F, and asinh of half of it" \
        holds '.strain | (.gradient[0][1] - 10.2 | fabs) < 1e-9 and (.gradient[0][0] - 1 | fabs) < 1e-9 and (.gradient[1][0] | fabs) < 1e-9 and
            (.volumetric | fabs) < 1e-9 and (.shear - 2 * (5.1 | asinh) | fabs) < 1e-8' < <(strain "$tmp/start.h5" "$tmp/cell.h5" | tail -n 1)
done
like "the first frame has none" "$(strain "$tmp/start.h5" "$tmp/cell.h5" | head -n 1 | jq -c '.strain | [.since, .volumetric, .shear]')" '^\[0\.?0?,-?0\.?0?,-?0\.?0?\]$'

# d edge/dt = L edge by the theta method: a factor (1 + L dt/2)/(1 - L dt/2) in each step
cell 3 '[[0.1, 0, 0], [0, 0.1, 0], [0, 0, -0.5]]' 1000 250
ok "triaxial strain of an imposed gradient, axial, volumetric and deviatoric" \
    holds 'def hencky($L): -1000 * ((1 + $L * 5e-4) / (1 - $L * 5e-4) | log);
        hencky(0.1) as $side | hencky(-0.5) as $axial | .strain |
        (.tensor[2][2] - $axial | fabs) < 1e-12 and (.tensor[0][0] - $side | fabs) < 1e-12 and
        (.volumetric - $axial - 2 * $side | fabs) < 1e-12 and (.shear - 2 / 3 * ($axial - $side) | fabs) < 1e-12 and
        (.principal[0] - $axial | fabs) < 1e-12' < <(strain "$tmp/start.h5" "$tmp/cell.h5" | tail -n 1)

# a piston of scenes/piston.json: 0.1 m/s, 5e-5 s a step, from 20 mm
nsd-gen scenes/piston.json >"$tmp/start.h5"
step -n 200 --every 50 -o "$tmp/piston.h5" "$tmp/start.h5"
ok "a wall that is driven into a box: ln(20/19)" \
    holds '.strain | (.tensor[0][0] - (20 / 19 | log) | fabs) < 1e-12 and (.tensor[1][1] | fabs) < 1e-12' < <(strain "$tmp/start.h5" "$tmp/piston.h5" | tail -n 1)
nsd-stat --tsv -m strain "$tmp/start.h5" "$tmp/piston.h5" >"$tmp/table"
like "--tsv has it" "$(head -n 1 "$tmp/table")" 'volumetric.*shear'
ok "the first frame that is read is the reference: ln(19.5/19)" \
    holds '.strain | (.tensor[0][0] - (19.5 / 19 | log) | fabs) < 1e-12' < <(strain --frames 100:200:50 "$tmp/piston.h5" | tail -n 1)

done_testing
