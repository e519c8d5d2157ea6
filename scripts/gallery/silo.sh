#!/usr/bin/env bash
# A silo: its flow against the orifice, against the height of the fill and the hopper; the floor's pressure.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

radius=$(pick 0.009 0.016) count=$(pick 450 4000)
read -ra widths <<<"$(pick '0.008 0.010' '0.008 0.009 0.010 0.012 0.014')"
side=$(jq -n "$radius * 0.7")

# W in kg/s between a tenth and 45 % of what there was, and of both halves of it; opened at 0.4 s
flow()
{
    nsd-info --events "$out/$1" | with 'map(select(.event == "removed") | [.time, .mass]) as $e |
        ($e | map(.[1]) | add) as $gone | [foreach $e[] as $x ([0, 0]; [$x[0], .[1] + $x[1]])] |
        def slope($a; $b): map(select(.[1] > $a * $mass and .[1] < $b * $mass)) | line.b;
        [$width, slope(0.1; 0.45), slope(0.1; 0.27), slope(0.27; 0.45), $gone / $mass] | @tsv' -rs --argjson width "$2" \
        --argjson mass "$(nsd-info --last -p "$out/fill.h5" | jq -s 'map(.mass) | add')"
}

# filled once, with the gate shut; then each orifice
scene silo-flat --argjson r "$radius" --argjson s "$side" --argjson n "$count" '.walls[0].cylinder.radius = $r | .walls[1].disc.radius = $r |
    .bodies[0] |= (.count = $n | .box.x = [-$s, $s] | .box.y = [-$s, $s])' | nsd-gen - | step fill.h5 --until 0.399 --every 0.2s --contacts
echo "width flow early late gone" >"$out/flow.tsv"
open() # WIDTH NAME FILTER
{
    on fill.h5 --argjson w "$1" '.walls[1].disc.hole = $w / 2 | .walls[2].disc.radius = $w / 2 | '"$3" |
        step "$2.h5" --until "$(pick 1.2 2.5)" --every 0.05s
}
for width in "${widths[@]}"; do
    open "$width" "open-$width" .
    flow "open-$width.h5" "$width" >>"$out/flow.tsv"
done
# a hopper of 30 degrees to the vertical, which is filled, and opened, apart
middle=${widths[$((${#widths[@]} / 2))]}
scene silo-flat --argjson r "$radius" --argjson s "$side" --argjson n "$count" --argjson w "$middle" '
    (($r - $w / 2) * 1.7320508) as $h | .walls[0].cylinder |= (.radius = $r | .point[2] = $h) |
    .walls[1] = {cone: {point: [0, 0, 0], axis: [0, 0, 1], radii: [$w / 2, $r], length: $h}} | .walls[2].disc.radius = $w / 2 |
    .bodies[0] |= (.count = $n | .box = {x: [-$s, $s], y: [-$s, $s], z: [$h, null]})' |
    nsd-gen - | step hopper.h5 --until "$(pick 1.2 2.5)" --every 0.05s
flow hopper.h5 "$middle" >"$out/hopper.tsv"

# the vertical stress by depth in a fill that is slender: at rest its walls may bear anything that their friction allows,
# so the floor sinks by a diameter first [nsd(7), Forces in a pile at rest]
still=$(pick 0.4 1.2)
scene silo-flat --argjson n "$(pick 240 2400)" --argjson r "$(pick 0.006 0.01)" --argjson t "$still" '.walls[0].cylinder |= (.radius = $r | .point[2] -= 0.01 | .length += 0.01) |
    .walls[1].disc |= (.radius = $r | .hole = 0.001) | .walls[2] |= (.disc.radius = 0.001 | .until = 10) |
    .walls[1:3][].drives = [{along: [0, 0, -1], speed: 0.005, from: $t, until: ($t + 0.4)}] |
    .bodies[0] |= (.count = $n | .box.x = [-0.7 * $r, 0.7 * $r] | .box.y = .box.x)' |
    nsd-gen - | step slender.h5 --until "$(jq -n "$still + 0.4")" --every 0.05s --contacts
top=$(nsd-info --last -p "$out/slender.h5" | jq -s 'map(.x[2]) | max')
# of the last frames: layers of 2 diameters, their stress and density, from the top on
nsd-stat -m profile,boundaries --layers z:20 --point 0,0,0 "$out/slender.h5" | jq -cs '.[-4:]' >"$out/slender.json"
with 'map(.profile) | (.[0].at | length) as $n | [range($n) as $k | [$top - .[0].at[$k], (map(.stress[$k][2][2]) | mean), (map(.fraction[$k]) | mean)]] |
    reverse | .[] | select(.[0] > 0 and .[1] != null) | @tsv' -r --argjson top "$top" "$out/slender.json" >"$out/stress.tsv"
curve
picture -c speed --cut 0,1,0,0 --step "$(nsd-info "$out/open-$middle.h5" | jq -s 'map(.step // empty) | .[length / 4 | floor]')" "$out/open-$middle.h5"
with 'def numbers: split("\n") | map(select(test("^[-0-9]")) | split("[ \t]"; null) | map(tonumber));
    ($flow | numbers) as $w | ($hopper | numbers)[0] as $hop | 0.002 as $d |
    ($w | map([.[0], (.[1] | pow(.; 0.4))]) | line) as $l |
    ($stress | numbers | map(select(.[2] > 0.3))) as $s | ($s | map(.[2]) | add / length * 2500 * 9.81) as $weight |
    # Janssen: weight lambda (1 - exp(-z/lambda)), the lambda of least squares
    ([range(2; 120) | . / 1000 | . as $lambda | [($s | map((.[1] - $weight * $lambda * (1 - (-.[0] / $lambda | exp))) | . * .) | add), .]] | min[1]) as $lambda |
    row("linear"; $l.r2),
    row("k"; -$l.a / $l.b / $d),
    row("C"; ($l.b | pow(.; 2.5)) / (2500 * 0.59 * (9.81 | sqrt))),
    row("height"; ($w[($w | length) / 2 | floor] | .[2] / .[3])),
    row("hopper"; $hop[1] / $w[($w | length) / 2 | floor][1]),
    row("Janssen"; $radius / (2 * $lambda)),
    row("deepest"; ($s[-2] | .[1] / ($weight * .[0])))' \
    -n --rawfile flow "$out/flow.tsv" --rawfile hopper "$out/hopper.tsv" --rawfile stress "$out/stress.tsv" --argjson radius "$(pick 0.006 0.01)" | results
