#!/usr/bin/env bash
# A drum of discs that hold together: how steep and how rough the surface is, by their cohesion.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

scale=$(pick 0.5 1) end=$(pick 0.9 2)
read -ra bonds <<<"$(pick '0 20' '0 5 20 40')"
weight=$(jq -n '2500 * 3.141592653589793 * 1.5e-3 * 1.5e-3 * 9.81')

echo "bond angle rough" >"$out/angle.tsv"
for b in "${bonds[@]}"; do
    scene cohesive --argjson s "$scale" --argjson f "$(jq -n "$b * $weight")" '.walls[0].circle.radius *= $s |
        (if $f > 0 then .cohesion.force = $f else del(.cohesion) end) |
        .bodies = [{random: {count: (800 * $s * $s | floor)}, radius: .bodies[0].radius,
            box: {x: [-0.047 * $s, 0.047 * $s], y: [-0.047 * $s, 0.047 * $s]}}]' |
        nsd-gen - | step "drum-$b.h5" --until "$end" --every 0.05s
    # the surface: the highest disc of each strip two discs wide, turned by the mean angle; how far it is from its
    # line, in diameters, as a mean over the last half of the frames
    a=$(angle "drum-$b.h5")
    rough=$(nsd-info -p "$out/drum-$b.h5" | with '($a * 3.141592653589793 / 180) as $a |
        (map(.step) | max / 2) as $half | map(select(.step > $half) | [.step, .x[0] * ($a | cos) + .x[1] * ($a | sin), -.x[0] * ($a | sin) + .x[1] * ($a | cos)]) |
        map(select(.[1] > -0.6 * $r and .[1] < 0.6 * $r)) | group_by(.[0]) |
        map(group_by(.[1] / 0.006 | floor) | map([(map(.[1]) | mean), (map(.[2]) | max)]) |
            line as $l | (map(.[1] - $l.a - $l.b * .[0] | . * .) | mean | sqrt) / 0.003) | mean' -s --argjson a "$a" --argjson r "$(jq -n "0.07 * $scale")")
    echo "$b $a $rough" >>"$out/angle.tsv"
done
curve
picture -c speed --boundaries lines "$out/drum-${bonds[-1]}.h5"
with '($angles | numbers) as $a |
    row("dry"; $a[0][1]),
    row("angle"; ($a[1:] | map(.[1]) | max) - $a[0][1]),
    row("last angle"; $a[-1][1] - $a[0][1]),
    row("roughness"; ($a[1:] | map(.[2]) | min) / $a[0][2])' \
    -n --rawfile angles "$out/angle.tsv" | results
