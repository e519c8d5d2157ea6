#!/usr/bin/env bash
# Triaxial and simple shear tests in periodic cells: what is known of rigid grains, whatever the path and the masses of edges.
# shellcheck source=tests/support/tap.sh disable=SC2016,SC2094 # jq programs; names of tests with what is read
. tests/support/tap.sh

holds() { jq -e "$@" >/dev/null; }
n=150
# Balls of mean diameter 1 m and mass 1 kg under 1 Pa; dense: pressed together without friction
jq -n --argjson n $n '($n * 0.5236 / 0.5 | log / 3 | exp) as $L |
    { dim: 3, dt: 0.02, gravity: [0, 0, 0], density: 1.88, seed: 3, mu: 0, cell: { lengths: [$L, $L, $L], stress: { pressure: 1, factor: [[0, 0], [4, 1]] } },
      bodies: [{ random: { count: $n }, radius: { uniform: [0.4, 0.6] } }] }' | nsd-gen - |
    nsd-step --overlap-rule gap --until 25 --every 25s -o "$tmp/start.h5" 2>/dev/null

# path NAME MU STEPS CELL: strained at 0.01 per s, whose inertial number is that; [q/p, fraction, p, volumetric strain] of the second half
path()
{
    nsd-info --scene "$tmp/start.h5" | jq --argjson mu "$2" --argjson cell "$4" '.mu = $mu | .bodies[0].at_rest = true | .cell = $cell' | nsd-gen - >"$tmp/$1-start.h5"
    nsd-step --overlap-rule gap -n "$3" --every 10 --contacts -o "$tmp/$1.h5" "$tmp/$1-start.h5" 2>/dev/null
    nsd-stat -m strain,stress,fraction "$tmp/$1-start.h5" "$tmp/$1.h5" | jq -s -c 'def mean: add / length; map(select(.stress.p)) | .[length / 2 | floor:] | [(map(.stress.q) | mean) / (map(.stress.p) | mean), (map(.fraction.fraction) | mean), (map(.stress.p) | mean),
        (map(.strain.volumetric) | mean), (map(.stress.tensor | .[2][2] - (.[0][0] + .[1][1]) / 2) | mean) / (map(.stress.p) | mean)]' >"$tmp/$1.json"
    cat "$tmp/$1.json"
}
down='[[0.005, 0, 0], [0, 0.005, 0], [0, 0, -0.01]]'
mean=$(path mean 0.5 2600 "{\"gradient\": $down, \"stress\": {\"mean\": 1}}")
heavy=$(path heavy 0.5 2600 "{\"gradient\": $down, \"stress\": {\"mean\": 1, \"mass\": 60}}")
side=$(path side 0.5 1600 '{"gradient": [[0, 0, 0], [0, 0, 0], [0, 0, -0.01]], "stress": {"target": [[1, null, null], [null, 1, null], [null, null, null]]}}')
smooth=$(path smooth 0 800 "{\"gradient\": $down, \"stress\": {\"mean\": 1}}")
diag "mean $mean" "heavy $heavy" "side $side" "smooth $smooth"

# Critical state of balls with mu = 0.5: q/p 0.6 to 0.75 and a fraction of 0.58 to 0.60, slowly sheared [Thornton 2000; Huang, Hanley,
# O'Sullivan and Kwok 2014]; at an inertial number of 0.01 and of 150 balls some more
ok "constant mean stress: it is 1, to 3 %" holds '.[2] - 1 | fabs < 0.03' <<<"$mean"
for name in mean heavy side; do
    ok "$name: q/p of 0.55 to 0.95, and 0.57 to 0.625 of the volume solid" holds '.[0] > 0.55 and .[0] < 0.95 and .[1] > 0.57 and .[1] < 0.625' <"$tmp/$name.json"
    ok "$name: dense grains dilate" holds '.[3] < -0.01' <"$tmp/$name.json"
done
ok "nothing depends on the mass of the edges: q/p to 0.12, the fraction to 0.012" \
    holds -n "$mean as \$a | $heavy as \$b | (\$a[0] - \$b[0] | fabs) < 0.12 and (\$a[1] - \$b[1] | fabs) < 0.012"
ok "nor, in the critical state, on the path" \
    holds -n "$mean as \$a | $side as \$b | (\$a[0] - \$b[0] | fabs) < 0.15 and (\$a[1] - \$b[1] | fabs) < 0.015"
# Frictionless balls have tan phi = 0.1 in the limit of slow shear, M = 6 sin phi / (3 - sin phi) = 0.21 [Peyneau and Roux 2008], and
# more as a power 0.4 of the inertial number, some 0.4 at 0.01. Axial less lateral stress, whose mean has no bias by fluctuations.
ok "without friction axial less lateral stress over p is 0.2 to 0.55, and far below that with friction" \
    holds -n "$smooth as \$s | $mean as \$m | \$s[4] > 0.2 and \$s[4] < 0.55 and \$s[4] < \$m[4] - 0.25"
# Mohr's circle of the path with constant sides: the stress there is the one that was asked for
ok "the sides of a triaxial test carry their stress, to 4 %" \
    holds -s 'map(select(.stress.p)) | .[length / 2 | floor:] | (map((.stress.tensor[0][0] + .stress.tensor[1][1]) / 2) | add / length) - 1 | fabs < 0.04' \
    < <(nsd-stat -m stress "$tmp/side.h5")
# Rankine: passive and active limits are reciprocal; in two dimensions sin phi = (s1 - s3)/(s1 + s3) is the same whether the
# axis is compressed or extended
biaxial() # SIGN: sin of the mobilised friction of discs, from the same start
{
    jq --argjson sign "$1" '.cell = {gradient: [[0, 0], [0, (-0.01 * $sign)]], stress: {target: [[1, null], [null, null]]}}' "$tmp/discs.json" | nsd-gen - |
        nsd-step --overlap-rule gap -n 2500 --every 10 --contacts 2>/dev/null | nsd-stat -m stress | jq -s 'def mean: add / length; map(select(.stress.p)) |
        .[length / 3 | floor:] | (map(.stress.tensor[1][1]) | mean) as $y | (map(.stress.tensor[0][0]) | mean) as $x | ($y - $x) / ($y + $x)'
}
jq -n '{ dim: 2, dt: 0.02, gravity: [0, 0], density: 1.257, seed: 5, mu: 0.5, cell: { lengths: [14.5, 14.5], stress: { pressure: 1, factor: [[0, 0], [4, 1]] } },
    bodies: [{ random: { count: 200 }, radius: { uniform: [0.4, 0.6] } }] }' | nsd-gen - | nsd-step --overlap-rule gap --until 25 --every 25s -o "$tmp/discs.h5" 2>/dev/null
nsd-info --scene "$tmp/discs.h5" | jq '.bodies[0].at_rest = true' >"$tmp/discs.json"
squeezed=$(biaxial 1) stretched=$(biaxial -1)
diag "sin phi $squeezed compressed, $stretched extended"
ok "biaxial: sin phi of discs, 0.23 to 0.42 [Estrada et al. 2008: 0.28 to 0.3], compressed" holds '. > 0.23 and . < 0.42' <<<"$squeezed"
ok "and extended, with the other sign: Rankine's active limit" holds '. < -0.23 and . > -0.42' <<<"$stretched"
done_testing
