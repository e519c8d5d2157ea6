#!/usr/bin/env bash
# Heaps on a slab, what is too much falls off its edges: their slope by rolling friction, and by cohesion.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

half=$(pick 0.05 0.07) until=$(pick 0.8 2)
read -ra rolls <<<"$(pick '0 0.1' '0 0.02 0.05 0.1 0.3')"
read -ra bonds <<<"$(pick '0 30' '0 1 2 4 8 16 30')"
weight=$(jq -n '2500 * 3.141592653589793 * 4e-6 * 9.81')

# dem.c has no rolling friction
! by reference || rolls=(0)

# heap FILE SEED FILTER: discs of 4 mm, a block as wide as the slab, which the filter changes; it comes to rest. The slab is a
# row of fixed discs: on a smooth one discs roll away
heap()
{
    scene heap --argjson h "$half" --argjson seed "$2" '.seed = $seed | .remove[0].outside.x = [-$h, $h] |
        .bodies = [
            { count: ($h / 0.002 | round), radius: 0.002, fixed: true, jitter: 0, spacing: 1, box: { x: [-$h, $h], y: [-0.002, 0.002] } },
            { count: ($h * $h * 1.4 * 0.8 / 1.257e-5 | round), radius: .bodies[0].radius, box: { x: [-$h, $h], y: [0.002, null] } }] | '"$3" |
        nsd-gen - | step "$1" --until "$until" --every "${until}s"
}
# degrees: of lines through the tops of strips a disc wide on both flanks, from a fifth of the heap's height up to where,
# coming from outside, four fifths are first reached; the mean of both sides. slope FILE COHESIVE: where discs hold together
# (true) a lump has none: where a flank is five strips or less it is a wall, and where its tops are more than 1.5 discs from
# the line (root mean square) it is none
slope()
{
    nsd-info --last -b "$out/$1" | with 'map(select(.mass > 0) | [.position[0], .position[1] + .radius]) | (map(.[1]) | max) as $top |
        group_by(.[0] / 0.004 | floor) | map([(map(.[0]) | add / length), (map(.[1]) | max)]) | . as $strips |
        [1, -1] | map(. as $side | $strips | map([.[0] * $side, .[1]]) | sort_by(-.[0]) | map(.[1]) as $h |
            ([range(0; $h | length) | select($h[.] >= 0.8 * $top)][0]) as $up | .[:$up + 1] | map(select(.[1] > 0.2 * $top)) |
            if $cohesive and length <= 5 then null
            else line as $l | if $cohesive and (map(.[1] - $l.a - $l.b * .[0] | . * .) | mean | sqrt) > 0.006 then null else -$l.b | atan * 180 / 3.141592653589793 end end) |
        if any(. == null) then "none" else mean end' -rs --argjson cohesive "$2"
}

echo "mu_r slope seed" >"$out/rolling.tsv"
echo "bond slope seed" >"$out/cohesion.tsv"
for s in "${seeds[@]}"; do
    for r in "${rolls[@]}"; do
        part rolling || [ "$r" = 0 ] || continue
        heap "roll-$r.h5" "$s" "if $r > 0 then .rolling = { mu_r: ($r * 0.002) } else . end"
        echo "$r $(slope "roll-$r.h5" false) $s" >>"$out/rolling.tsv"
    done
    cp "$out/roll-0.h5" "$out/bond-0.h5"
    for b in "${bonds[@]}"; do
        part cohesion || continue
        [ "$b" = 0 ] || heap "bond-$b.h5" "$s" "if $b > 0 then .cohesion = { force: ($b * $weight), range: 2e-5 } else . end"
        echo "$b $(slope "bond-$b.h5" "$([ "$b" = 0 ] && echo false || echo true)") $s" >>"$out/cohesion.tsv"
    done
done

# The curves: of values at which no heap is a lump. x, mean, error; and how many of the heaps are lumps
slopes='def slopes: split("\n")[1:] | map(select(. != "") | split(" ") | map(tonumber? // null) | .[:2]);'
for t in rolling cohesion; do
    with "$slopes"' slopes | group_by(.[0])[] | (map(select(.[1] == null)) | length) as $lumps |
        if $lumps == 0 then spread[] | "\(.[0]) \(.[1]) \(.[2] // 0)" else "# \(.[0][0]) \($lumps / length)" end' -Rsr "$out/$t.tsv" >"$out/$t-mean.tsv"
done
sed -n 's/^# //p' "$out/cohesion-mean.tsv" >"$out/lumps.tsv"
if [ -z "${PART:-}" ]; then
    curve
    picture -c speed "$out/roll-${rolls[-1]}.h5"
fi
with "$slopes"'
    def curve: map(select(.[1] != null)) | spread;
    def falls: [range(1; length) as $i | select(.[$i][1] < .[$i - 1][1] - 2 * (pow(.[$i][2] // 0; 2) + pow(.[$i - 1][2] // 0; 2) | sqrt))] | length;
    def at($x): map(select(.[0] == $x) | .[1]);
    ($rolling | slopes) as $r | ($cohesion | slopes) as $c | ($r | curve) as $rc |
    # a Bond number counts where no heap is a lump
    ($c | group_by(.[0]) | map(select(all(.[1] != null))) | add // []) as $heaps | ($heaps | curve) as $cc |
    row("dry"; $r | at(0)),
    (if ($rc | length) > 1 then row("steps that fall"; $rc | falls) else empty end),
    (if ($rc | length) > 4 then row("regimes"; ($rc[-1][1] - $rc[-3][1]) / ($rc[-3][1] - $rc[0][1])) else empty end),
    (if $c | length > 0 then row("bond steps that fall"; $cc | falls) else empty end),
    (if ($c | at(1)) != [] then row("bond 1"; [$c | at(1), at(0)] | transpose | map(if all(. != null) then .[0] - .[1] else null end)) else empty end),
    (if $c | length > 0 then row("lump"; ($c | map(.[0]) | max) as $most | $c | map(select(.[0] == $most) | if .[1] == null then 1 else 0 end) | mean) else empty end)' \
    -n --rawfile rolling "$out/rolling.tsv" --rawfile cohesion "$out/cohesion.tsv" | results
