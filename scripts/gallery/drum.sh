#!/usr/bin/env bash
# A rotating drum: the angle of its surface by speed, and the velocity of the layer that flows.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

scale=$(pick 0.45 1) end=$(pick 1.5 2)
read -ra speeds <<<"$(pick '1.5 4' '0.7 1.5 2.5 3.5 5')"
read -ra slow <<<"$(pick '' '1')"
part discs || speeds=()
part balls || slow=()
read -ra rough <<<"$(pick '' "$(by reference || echo 0.7)")"
part ring || rough=()
radius=$(jq -n "0.105 * $scale")

# layer FILE ANGLE: in the middle of the drum, depth below the surface in diameters and velocity down it in sqrt(g d), a mean
# over the last half of the frames
layer()
{
    nsd-info -b "$1" | with '($angle * 3.141592653589793 / 180) as $a |
        (map(.step) | max / 2) as $half | 0.003 as $d | (9.81 * $d | sqrt) as $c |
        # the drum turns counterclockwise, and the surface falls to the left
        map(select(.step > $half) | [.step, .position[0] * ($a | cos) + .position[1] * ($a | sin), -.position[0] * ($a | sin) + .position[1] * ($a | cos),
            -(.velocity[0] * ($a | cos) + .velocity[1] * ($a | sin))] | select(.[1] > -0.2 * $r and .[1] < 0.2 * $r)) |
        # the surface: above it are a few of a frame. Rows along the wall hold twice as many as those inside
        group_by(.[2] / ($d / 2) | floor) | map({y: (map(.[2]) | add / length), v: (map(.[3]) | add / length), n: length}) |
        (map(.n) | median) as $usual | map(select(.n > 0.6 * $usual)) | (map(.y) | max) as $top |
        .[] | [($top - .y) / $d, .v / $c] | @tsv' -rs --argjson angle "$2" --argjson r "$radius"
}
# slip FILE SPEED RADIUS: how much slower than the wall the discs at it are, over its speed; a mean over the last half of the frames
slip()
{
    nsd-info -b "$1" | with '(map(.step) | max / 2) as $half | map(select(.step > $half and .material == "ball") | .position as [$x, $y] | ($x * $x + $y * $y | sqrt) as $d |
        select($d + 1.1 * .radius > $r) | (.velocity[1] * $x - .velocity[0] * $y) / $d / ($w * $r)) | 1 - mean' -s --argjson r "$3" --argjson w "$2"
}
# discs SEED RADIUS: a table of discs without overlaps, half as much as the circle holds: the lowest ones of a block that lie in it
discs()
{
    scene drum --argjson seed "$1" --argjson r "$2" '.seed = $seed | del(.walls) |
        .bodies = [.bodies[0] | .count = (4 * $r * $r / 1.1e-5 | floor) | .box = {x: [-$r, $r], y: [-$r, null]}]' | nsd-gen - | nsd-info -b |
        jq -rs --argjson r "$2" --argjson n "$(jq -n "2000 * ($2 / 0.105) * ($2 / 0.105) | floor")" 'map(select((.position[0] * .position[0] + .position[1] * .position[1] | sqrt) + .radius < $r)) |
            sort_by(.position[1])[:$n][] | [.position[0], .position[1], .radius] | map(tostring) | join(" ")' >"$out/discs.txt"
}
# angle_inside FILE.h5: as angle, of the discs alone without the ring around them, from a table of each frame
angle_inside()
{
    nsd-info -b "$out/$1" | jq -cs '(map(.step) | max / 2) as $half | map(select(.step > $half and .material == "ball")) | group_by(.step)[] |
        {dim: 2, dt: 1, allow_overlap: true, bodies: map({x: .position[:2], radius})}' | while read -r frame; do nsd-gen - <<<"$frame" | nsd-stat -m surface; done |
        jq -s 'map(.surface.angle | fabs) | add / length'
}
# froude SPEED RADIUS
froude() { jq -n "$1 * $1 * $2 / 9.81"; }

echo "froude angle seed" >"$out/angle.tsv"
echo "froude angle seed" >"$out/balls.tsv"
: >"$out/slip.tsv"
: >"$out/ring.tsv"
for s in "${seeds[@]}"; do
    soft=dem
    for speed in "${speeds[@]}"; do
        discs "$s" "$radius"
        scene drum --argjson w "$speed" --argjson s "$scale" --argjson seed "$s" --arg discs "$out/discs.txt" '.seed = $seed | .walls[0].circle.radius *= $s |
            .walls[0].drives[0].speed = $w | .bodies = [{file: $discs}]' |
            nsd-gen - | step "drum-$speed.h5" --until "$end" --every 0.05s
        a=$(angle "drum-$speed.h5")
        echo "$(froude "$speed" "$radius") $a $s" >>"$out/angle.tsv"
        [ "$speed" != "${speeds[0]}" ] || echo "$s $(slip "$out/drum-$speed.h5" "$speed" "$radius")" >>"$out/slip.tsv"
        layer "$out/drum-$speed.h5" "$a" >"$out/layer-$speed-$s.tsv"
        # the line where the layer flows at a quarter to 95 % of its fastest row
        with '(map(.[1]) | max) as $fastest | map(select(.[1] > $fastest / 4 and .[1] < 0.95 * $fastest)) |
            line + {s: $s, points: length}' -c --argjson s "$s" < <(with 'numbers' -Rs "$out/layer-$speed-$s.tsv")
        [ "$s$speed" != "${seeds[0]}${speeds[1]}" ] || cp "$out/drum-$speed.h5" "$out/drawn.h5"
    done
    for speed in "${rough[@]}"; do
        # 216 discs of 3 mm along the wall, glued to each other, rotate in its place; the scale of their coordinates is the radius
        discs "$s" "$(jq -n "$radius - 0.0031")"
        scene drum --argjson w "$speed" --argjson seed "$s" --argjson r "$radius" --arg discs "$out/discs.txt" '.seed = $seed | del(.walls, .pairs) | (0.0015 / $r) as $d |
            .shapes.ring.balls = [range(216) | (. * 3.141592653589793 / 108) as $a | [($a | cos) * (1 - $d), ($a | sin) * (1 - $d), $d]] | .materials.ring = {} |
            .bodies = [{x: [0, 0], shape: "ring", size: $r, w: $w, fixed: true, material: "ring"}, {file: $discs}]' |
            nsd-gen - | step "ring-$s.h5" --until "$end" --every 0.05s
        echo "$(angle_inside "ring-$s.h5") $(slip "$out/ring-$s.h5" "$speed" "$(jq -n "$radius - 0.003")")" >>"$out/ring.tsv"
    done
    soft=liggghts # dem.c has no cylinder
    for speed in "${slow[@]}"; do
        # a slice five balls wide of a drum of 20, about y
        jq -n --argjson w "$speed" --argjson seed "$s" '{title: "A slice of a drum of balls", dt: 5e-4, density: 2500, mu: 0.4, e_n: 0.3, seed: $seed,
            cell: {lengths: [1, 0.015, 1], repeats: [false, true, false]},
            pairs: [{pair: ["ball", "wall"], mu: 0.95}],
            walls: [{cylinder: {point: [0, 0, 0], axis: [0, 1, 0], radius: 0.03}, drives: [{about: [0, 0, 0], axis: [0, -1, 0], speed: $w}]}],
            bodies: [{random: {count: 800}, radius: {uniform: [1.4e-3, 1.6e-3]}, box: {x: [-0.0205, 0.0205], y: [0, 0.015], z: [-0.0205, 0.0205]}}]}' |
            nsd-gen - | step balls.h5 --until "$end" --every 0.05s
        echo "$(froude "$speed" 0.03) $(angle balls.h5) $s" >>"$out/balls.tsv"
    done
done >"$out/lines.json"
! part discs || soft=dem # of which the account is
for t in angle balls; do
    with 'numbers | map([.[0], .[1]]) | spread[] | "\(.[0]) \(.[1]) \(.[2] // 0)"' -Rsr "$out/$t.tsv" >"$out/$t-mean.tsv"
done
if part discs; then
    curve
    picture -c speed --walls lines "$out/drawn.h5"
fi
with '. as $lines | ($angle | numbers) as $a | ($balls | numbers) as $b | ($a | map(.[0]) | min) as $slowest |
    def by_seed(f): $lines | group_by(.s) | map(map(f) | mean);
    if $a == [] then empty else ($a | map([.[0], .[1]]) | spread) as $curve |
    row("linear"; by_seed(.r2)),
    row("shear rate"; by_seed(-.b)),
    row("slow angle"; $a | map(select(.[0] == $slowest) | .[1])),
    row("slip"; $slip | numbers | map(.[1])),
    row("steps that fall"; $a | group_by(.[2]) | map(sort_by(.[0]) | map(.[1]) as $v | [range(1; $v | length) | select($v[.] < $v[. - 1])] | length)) end,
    if $b == [] then empty else ($b | map(.[0]) | min) as $slowest | row("balls"; $b | map(select(.[0] == $slowest) | .[1])) end,
    if ($ring | numbers) == [] then empty else row("ring angle"; $ring | numbers | map(.[0])), row("ring slip"; $ring | numbers | map(.[1])) end' \
    -s --rawfile angle "$out/angle.tsv" --rawfile balls "$out/balls.tsv" --rawfile slip "$out/slip.tsv" --rawfile ring "$out/ring.tsv" "$out/lines.json" | results
