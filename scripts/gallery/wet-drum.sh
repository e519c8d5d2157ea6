#!/usr/bin/env bash
# A drum of discs that hold together: how steep and how rough the surface is, by their cohesion. The wall does not attract:
# to one that does discs stick from a Bond number of 3 on, and it carries them over the top.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

scale=$(pick 0.5 1) end=$(pick 0.9 1.6)
read -ra bonds <<<"$(pick '0 3' '0 1 3 6 12')"
weight=$(jq -n '2500 * 3.141592653589793 * 1.5e-3 * 1.5e-3 * 9.81')
radius=$(jq -n "0.07 * $scale")

echo "bond angle rough seed" >"$out/angle.tsv"
for s in "${seeds[@]}"; do
    for b in "${bonds[@]}"; do
        scene cohesive --argjson s "$scale" --argjson seed "$s" --argjson f "$(jq -n "$b * $weight")" '.seed = $seed |
            .walls[0].circle.radius *= $s | (if $f > 0 then .cohesion.force = $f | .pairs[0].cohesion = {force: 0} else del(.cohesion) end) |
            .bodies = [{random: {count: (800 * $s * $s | floor)}, radius: .bodies[0].radius,
                box: {x: [-0.047 * $s, 0.047 * $s], y: [-0.047 * $s, 0.047 * $s]}}]' |
            nsd-gen - | step "drum-$b.h5" --until "$end" --every 0.05s
        # Degrees: the mean over the frames of the last half that have a surface. One lump has none: what is uppermost
        # is 0.15 R and more from a plane (root mean square; dry discs: 0.1 R). Null where most frames have none
        a=$(nsd-stat -m surface "$out/drum-$b.h5" | jq -s --argjson r "$radius" '.[length / 2 | floor:] | map(.surface) | length as $n |
            map(select(.spread < 0.15 * $r) | .angle | fabs) | if length > $n / 2 then add / length else null end')
        # the surface: the highest disc of each strip two discs wide, turned by the mean angle; how far it is from its
        # line, in diameters, as a mean over the last half of the frames
        rough=$(nsd-info -b "$out/drum-$b.h5" | with '(($a // 0) * 3.141592653589793 / 180) as $a |
            (map(.step) | max / 2) as $half | map(select(.step > $half) | [.step, .position[0] * ($a | cos) + .position[1] * ($a | sin), -.position[0] * ($a | sin) + .position[1] * ($a | cos)]) |
            map(select(.[1] > -0.6 * $r and .[1] < 0.6 * $r)) | group_by(.[0]) |
            map(group_by(.[1] / 0.006 | floor) | map([(map(.[1]) | mean), (map(.[2]) | max)]) |
                line as $l | (map(.[1] - $l.a - $l.b * .[0] | . * .) | mean | sqrt) / 0.003) | mean' -s --argjson a "$a" --argjson r "$radius")
        [ "$a" != null ] || rough=null
        echo "$b $a $rough $s" >>"$out/angle.tsv"
    done
    [ "$s" != "${seeds[0]}" ] || cp "$out/drum-${bonds[-1]}.h5" "$out/drawn.h5"
done

# The curve: a Bond number has an angle where no drum is one lump. Bond number, angle, error, roughness, error
curve='def drums: split("\n")[1:] | map(select(. != "") | split(" ") | map(tonumber? // null));
    def curve: group_by(.[0]) | map(select(all(.[1] != null)) | [.[0][0], (map(.[1]) | mean, error), (map(.[2]) | mean, error)]);'
with "$curve"' drums | curve[] | map(. // 0) | join(" ")' -Rsr "$out/angle.tsv" >"$out/mean.tsv"
with "$curve"' drums | group_by(.[0])[] | select(any(.[1] == null)) | .[0][0]' -Rsr "$out/angle.tsv" >"$out/lumps.tsv"
curve
picture -c speed --walls lines "$out/drawn.h5"
with "$curve"' def falls($k): [range(1; length) as $i | select(.[$i][$k] < .[$i - 1][$k])] | length;
    ($angles | drums) as $d | ($d | curve) as $c | ($c | map(.[0]) | max) as $last |
    def at($x; $k): $d | map(select(.[0] == $x) | .[$k]);
    row("dry"; at(0; 1)),
    row("rise"; [at($last; 1), at(0; 1)] | transpose | map(.[0] - .[1])),
    row("steps that fall"; $c | falls(1)),
    row("roughness"; [at($last; 2), at(0; 2)] | transpose | map(.[0] / .[1]))' \
    -n --rawfile angles "$out/angle.tsv" | results
