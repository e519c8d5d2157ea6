#!/usr/bin/env bash
# A silo with a flat floor: its flow by the width of the orifice.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

radius=$(pick 0.014 0.03) fill=$(pick 0.05 0.078) # m; the loose fill is 1.5 times as high as at rest
read -ra widths <<<"$(pick '0.010 0.012 0.014' '0.012 0.015 0.018 0.021 0.024')"
still=0.3               # s: the fill has come to rest, and the orifice opens
begin=0.08              # s after that: the flow is steady
until=$(pick 0.2 0.22)  # s after that: the end of the window

# density FILE.h5: kg/m^3, by the centres of balls more than 3 diameters from floor, wall and surface
density()
{
    nsd-info --last -b "$out/$1" | jq -s --argjson r "$radius" '(map(.position[2]) | sort | .[length * 0.99 | floor]) as $top | ($r - 0.007) as $in |
        map(select(.position[2] > 0.007 and .position[2] < $top - 0.006 and (.position[0] * .position[0] + .position[1] * .position[1] | sqrt) < $in) | .mass) | add / (3.141592653589793 * $in * $in * ($top - 0.013))'
}
# flow FILE.h5 WIDTH SEED: kg/s in the window, and in both halves of it
flow()
{
    events "$1" | jq -rs --argjson width "$2" --argjson rho "$(density "fill-$3.h5")" --argjson t0 "$still" --argjson t1 "$begin" --argjson t2 "$until" '
        map(select(.event == "removed") | [.time - $t0, .mass]) |
        def rate($a; $b): map(select(.[0] > $a and .[0] <= $b) | .[1]) | add / ($b - $a);
        [$width, $rho, rate($t1; $t2), rate($t1; ($t1 + $t2) / 2), rate(($t1 + $t2) / 2; $t2)] | @tsv'
}

# filled once for each seed, then each orifice opens; a ball that has passed it is taken away 3 mm below
for seed in "${seeds[@]}"; do
    scene silo-flat --argjson seed "$seed" --argjson r "$radius" --argjson h "$fill" '.seed = $seed | del(.remove, .walls) |
        .bodies[0] |= (.count = (4 * $r * $r * $h / 1.33e-8 | round) | .spacing = 1 | .box.x = [-$r, $r] | .box.y = .box.x)' | nsd-gen - | inside "$radius" >"$out/balls.txt"
    scene silo-flat --argjson seed "$seed" --argjson r "$radius" --arg balls "$out/balls.txt" '.seed = $seed | .dt = 3e-4 | .remove[0].below.point[2] = -0.003 |
        .walls[0].cylinder |= (.radius = $r | .length = 0.065) | .walls[1].disc |= (.radius = $r | .hole = 0.001) | .walls[2] |= (.disc.radius = 0.001 | .until = 10) |
        .bodies = [{file: $balls}]' | nsd-gen - | step "fill-$seed.h5" --until "$still" --every 1s
    for width in "${widths[@]}"; do
        on "fill-$seed.h5" --argjson w "$width" '.dt = 4e-4 | .walls[1].disc.hole = $w / 2 | .walls = .walls[:2]' |
            step "open-$width-$seed.h5" --until "$(jq -n "$still + $until")" --every 0.1s
        flow "open-$width-$seed.h5" "$width" "$seed"
    done
done >"$out/flow.tsv"
with 'numbers | map([.[0], (.[2] | pow(.; 0.4))]) | (spread[] | map(. // 0) | @tsv), "", "", (line | "\(.a) \(.b)")' -Rrs "$out/flow.tsv" >"$out/curve.tsv"
curve
last="open-${widths[-1]}-${seeds[0]}.h5"
picture -c speed --clip 0,1,0,0 --walls lines --step "$(nsd-info "$out/$last" | jq -s 'map(.step // empty) | max')" "$out/$last"
with '0.002 as $d | (numbers | map(select(length == 5))) as $all | ($all | length / $seeds) as $n |
    # one fit for each seed, with the density of its fill
    [range($seeds) as $k | $all[$k * $n : ($k + 1) * $n] | (map([.[0], (.[2] | pow(.; 0.4))]) | line) as $l |
        {k: (-$l.a / $l.b / $d), C: (($l.b | pow(.; 2.5)) / (.[0][1] * (9.81 | sqrt))), height: (map(.[4] / .[3]) | mean)}] as $fits |
    ($all | map([.[0], .[2]]) | spread) as $flows | ($flows | map([.[0], (.[1] | pow(.; 0.4))]) | line) as $l |
    row("C"; $fits | map(.C)),
    row("k"; $fits | map(.k)),
    row("law"; $flows | map(.[1] / (($l.a + $l.b * .[0]) | pow(.; 2.5)) - 1 | fabs) | max),
    row("height"; $fits | map(.height))' -Rs --argjson seeds "${#seeds[@]}" "$out/flow.tsv" | results
