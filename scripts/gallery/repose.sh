#!/usr/bin/env bash
# Heaps on a slab, what is too much falls off its edges: their slope by rolling friction, and by cohesion.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

half=$(pick 0.05 0.06) until=$(pick 0.8 1.2)
read -ra rolls <<<"$(pick '0 0.1' '0 0.02 0.05 0.1 0.3')"
read -ra bonds <<<"$(pick '0 30' '0 1 4 16 30')"
weight=$(jq -n '2500 * 3.141592653589793 * 4e-6 * 9.81')

# heap FILE FILTER: discs of 4 mm, a block as wide as the slab, which the filter changes; it comes to rest
heap()
{
    scene heap --argjson h "$half" '.remove[0].outside.x = [-$h, $h] | .bodies[0] |= (.box = { x: [-$h, $h], y: [0, 1.1 * $h] } |
        .random.count = ($h * $h * 1.4 * 0.8 / 1.257e-5 | round)) | '"$2" | nsd-gen - |
        step "$1" --until "$until" --every "${until}s" --overlap project
}
# degrees: of lines through the tops of strips a disc wide on both flanks, from a fifth of the heap's height up to where,
# coming from outside, four fifths are first reached; the mean of both sides
slope()
{
    nsd-info --last -p "$out/$1" | with 'map([.x[0], .x[1] + .radius]) | (map(.[1]) | max) as $top |
        group_by(.[0] / 0.004 | floor) | map([(map(.[0]) | add / length), (map(.[1]) | max)]) | . as $strips |
        [1, -1] | map(. as $side | $strips | map([.[0] * $side, .[1]]) | sort_by(-.[0]) | map(.[1]) as $h |
            ([range(0; $h | length) | select($h[.] >= 0.8 * $top)][0]) as $up | .[:$up + 1] | map(select(.[1] > 0.2 * $top)) |
            if (map(.[0]) | unique | length > 1) then -line.b | atan else 1.5707963267948966 end) |
        add / 2 * 180 / 3.141592653589793' -s
}

# of the heap's top over that of the block, which was as high as the random start's box
top() { nsd-info --last -p "$out/$1" | jq -s --argjson h "$half" 'map(.x[1] + .radius) | max / (1.1 * $h)'; }

echo "mu_r slope" >"$out/rolling.tsv"
for r in "${rolls[@]}"; do
    heap "roll-$r.h5" "if $r > 0 then .rolling = { mu_r: ($r * 0.002) } else . end"
    echo "$r $(slope "roll-$r.h5")" >>"$out/rolling.tsv"
done
echo "bond slope top" >"$out/cohesion.tsv"
for b in "${bonds[@]}"; do
    heap "bond-$b.h5" "if $b > 0 then .cohesion = { force: ($b * $weight), range: 2e-5 } else . end"
    echo "$b $(slope "bond-$b.h5") $(top "bond-$b.h5")" >>"$out/cohesion.tsv"
done
curve
picture -c speed "$out/roll-${rolls[-1]}.h5"
with 'def falls: [range(1; length) as $i | select(.[$i][1] < .[$i - 1][1] - 3)] | length;
    ($rolling | numbers) as $r | ($cohesion | numbers) as $c |
    row("dry"; $r[0][1]),
    row("rolling"; $r[-1][1] - $r[0][1]),
    row("steps that fall"; ($r | falls)),
    (if ($r | length) > 4 then row("regimes"; ($r[-1][1] - $r[-3][1]) / ($r[-3][1] - $r[0][1])) else empty end),
    row("cohesive"; ($c[1:] | map(.[1]) | max) - $c[0][1]),
    (if ($c | length) > 3 then row("bond 1"; $c[1][1] - $c[0][1]) else empty end),
    row("block"; $c[-1][2])' \
    -n --rawfile rolling "$out/rolling.tsv" --rawfile cohesion "$out/cohesion.tsv" | results
