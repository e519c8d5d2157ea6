#!/usr/bin/env bash
# A rotating drum: the angle of its surface by speed, and the velocity of the layer that flows.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

scale=$(pick 0.45 1) end=$(pick 1.5 3)
read -ra speeds <<<"$(pick '1.5 4' '0.7 1.5 2.5 4')"
radius=$(jq -n "0.105 * $scale")

# layer FILE ANGLE UP: in the middle of the drum, depth below the surface and velocity down it, a mean over the last half
# of the frames; in m and m/s. UP: the axis that points up
layer()
{
    nsd-info -p "$1" | with '($angle * 3.141592653589793 / 180) as $a |
        (map(.step) | max / 2) as $half | 0.003 as $d |
        # the drum turns counterclockwise, and the surface falls to the left
        map(select(.step > $half) | [.step, .x[0] * ($a | cos) + .x[$up] * ($a | sin), -.x[0] * ($a | sin) + .x[$up] * ($a | cos),
            -(.v[0] * ($a | cos) + .v[$up] * ($a | sin))] | select(.[1] > -0.2 * $r and .[1] < 0.2 * $r)) |
        # the surface: above it are a few of a frame. Rows along the wall hold twice as many as those inside
        group_by(.[2] / ($d / 2) | floor) | map({y: (map(.[2]) | add / length), v: (map(.[3]) | add / length), n: length}) |
        (map(.n) | median) as $usual | map(select(.n > 0.6 * $usual)) | (map(.y) | max) as $top |
        .[] | [$top - .y, .v] | @tsv' -rs --argjson angle "$2" --argjson up "$3" --argjson r "$radius"
}

echo "froude angle" >"$out/angle.tsv"
for speed in "${speeds[@]}"; do
    scene drum --argjson w "$speed" --argjson s "$scale" '.walls[0].circle.radius *= $s | .walls[0].drives[0].speed = $w |
        .bodies = [{random: {count: (2000 * $s * $s | floor)}, radius: .bodies[0].radius,
            box: {x: [-0.071 * $s, 0.071 * $s], y: [-0.07 * $s, 0.07 * $s]}}]' |
        nsd-gen - | step "drum-$speed.h5" --until "$end" --every 0.05s
    a=$(angle "drum-$speed.h5")
    echo "$(jq -n "$speed * $speed * $radius / 9.81") $a" >>"$out/angle.tsv"
    layer "$out/drum-$speed.h5" "$a" 1 >"$out/layer-$speed.tsv"
done
fast=${speeds[-1]}
if [ -z "${QUICK:-}" ]; then
    # a slice five balls wide of a drum of 20, about y
    jq -n '{title: "A slice of a drum of balls", dt: 5e-4, density: 2500, mu: 0.4, e_n: 0.3, seed: 7,
        cell: {lengths: [1, 0.015, 1], repeats: [false, true, false]},
        pairs: [{pair: ["ball", "wall"], mu: 0.95}],
        walls: [{cylinder: {point: [0, 0, 0], axis: [0, 1, 0], radius: 0.03}, drives: [{about: [0, 0, 0], axis: [0, -1, 0], speed: 3}]}],
        bodies: [{random: {count: 800}, radius: {uniform: [1.4e-3, 1.6e-3]}, box: {x: [-0.0205, 0.0205], y: [0, 0.015], z: [-0.0205, 0.0205]}}]}' |
        nsd-gen - | step balls.h5 --until "$end" --every 0.05s
    angle balls.h5 >"$out/balls.tsv"
fi
curve
picture -c speed --boundaries lines "$out/drum-${speeds[1]}.h5"
with '($angle | numbers) as $a | ($layer | numbers) as $l | ($l | map(.[1]) | max) as $fastest |
    # the layer: from its fastest row down to where a seventh of that is left
    ($l | map(select(.[1] > $fastest / 7 and .[1] < 0.95 * $fastest)) | line) as $fit | (9.81 / 0.003 | sqrt) as $rate |
    row("linear"; $fit.r2),
    row("shear rate"; -$fit.b / $rate),
    row("slow angle"; $a[0][1]),
    row("rise of the angle"; $a[-1][1] - $a[0][1]),
    if $ARGS.named.balls then row("balls"; $ARGS.named.balls) else empty end' \
    -n --rawfile angle "$out/angle.tsv" --rawfile layer "$out/layer-$fast.tsv" \
    $([ -e "$out/balls.tsv" ] && echo --argjson balls "$(cat "$out/balls.tsv")") | results
