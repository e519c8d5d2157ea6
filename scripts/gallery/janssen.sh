#!/usr/bin/env bash
# Janssen's law: the load of the layers in a tube whose floor has been lowered, for several frictions of the wall.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

radius=$(pick 0.005 0.012) fill=$(pick 0.107 0.218) # m; the loose fill is 1.5 times as high as at rest, 4.3 widths
read -ra frictions <<<"$(pick '0.1 0.3 0.4' '0.1 0.2 0.3 0.4 0.5')"
still=0.4 sink=0.2 # s: rest, then the floor sinks by a diameter

# tube SEED: the fill at rest, with 0.4 at the wall
tube()
{
    scene silo-flat --argjson seed "$1" --argjson r "$radius" --argjson h "$fill" '.seed = $seed | del(.remove, .walls) |
        .bodies[0] |= (.count = (4 * $r * $r * $h / 1.33e-8 | round) | .spacing = 1 | .box.x = [-$r, $r] | .box.y = .box.x)' | nsd-gen - | inside "$radius" >"$out/balls.txt"
    scene silo-flat --argjson seed "$1" --argjson r "$radius" --arg balls "$out/balls.txt" '.seed = $seed | del(.remove) |
        .walls = [{cylinder: {point: [0, 0, -0.01], axis: [0, 0, 1], radius: $r, length: 0.25}}, {disc: {center: [0, 0, 0], normal: [0, 0, 1], radius: $r}}] |
        .bodies = [{file: $balls}]' | nsd-gen - | step "fill-$1.h5" --until "$still" --every "${still}s"
}

# layers FILE.h5 FRICTION: rows of depth, load, load by Janssen's law, and the findings of the run. The load F of a layer is
# the weight W above it less the force S of the wall above it. Janssen: S = integral of F / lambda, lambda = R / (2 mu K).
layers()
{
    if by reference; then
        jq -c --argjson from "$(jq -n "($still + $sink - 0.0481) / 4e-4")" 'select(.[0] > $from)' "$out/$1.wall"
    else
        nsd-info -c --only 0,1 "$out/$1" | jq -c '[.step, .wall, .point[2], .r[0], (.r[0] * .n[2] + .r[1] * .t1[2] + .r[2] * .t2[2])]'
    fi >"$out/wall.json"
    nsd-info --last -b "$out/$1" | jq -c '[.position[2], .mass * 9.81]' >"$out/grains.json"
    with '4e-4 as $dt | ($wall | map(.[0]) | unique | length * $dt) as $time |
        ($grains | map(.[0]) | max) as $top | ($grains | map(.[0]) | min) as $floor | ($top - $floor) as $height | ($grains | map(.[1]) | add) as $weight |
        def share($k; $n): ($top - .[$k]) / $height * $n | floor;
        # what lies in each of 40 layers, from the top
        40 as $n | ([range($n)] | map(0)) as $none |
        (reduce $grains[] as $g ($none; .[$g | [0, ([share(0; $n), $n - 1] | min)] | max] += $g[1])) as $w |
        ($wall | map(select(.[1] == 0))) as $sides | ($wall | map(select(.[1] == 1) | .[4]) | add / $time) as $load |
        (reduce $sides[] as $c ($none; .[[0, ($c | [share(2; $n), $n - 1] | min)] | max] += $c[4] / $time)) as $s |
        # at the lower face of each layer: W, S, F and the integral of F
        [foreach range($n) as $k ({W: 0, S: 0, F: 0, I: 0}; (.F as $above | .W += $w[$k] | .S += $s[$k] | .F = .W - .S | .I += ($above + .F) / 2 * $height / $n | .z = ($k + 1) * $height / $n))] as $l |
        def lambda: (map(.I * .I) | add) / (map(.I * .S) | add);
        def janssen($lambda): $weight / $height * $lambda * (1 - (-.z / $lambda | exp));
        ($l | lambda) as $lambda | ($l[:$n / 2] | lambda) as $upper |
        {friction: $friction, height: ($height / $radius / 2), K: ($radius / 2 / $friction / $lambda),
         predicted: ($load / ($l[-1] | janssen($upper))), share: ($load / $weight),
         mobilised: (($sides | map(.[4]) | add) / $friction / ($sides | map(.[3]) | add)),
         balance: (($load + ($s | add)) / $weight),
         layers: ($l | map([.z / $radius / 2, .F / $weight * $height / $radius / 2, janssen($lambda) / $weight * $height / $radius / 2]))}' -nc \
        --slurpfile wall "$out/wall.json" --slurpfile grains "$out/grains.json" --argjson friction "$2" --argjson radius "$radius"
}

for seed in "${seeds[@]}"; do
    tube "$seed"
    for mu in "${frictions[@]}"; do
        # the independent code forgets its tangential springs between runs, and sinks the floor in one
        on "fill-$seed.h5" --argjson mu "$mu" --argjson t "$still" --argjson d "$sink" '.dt = 4e-4 | .walls[0].cylinder.length = 0.125 | .pairs = [{pair: ["ball", "wall"], mu: $mu}] |
            .walls[1].drives = [{along: [0, 0, -1], speed: 0.01, from: $t, until: ($t + $d + 1)}]' |
            if by reference; then
                step "sunk-$mu-$seed.h5" --until "$(jq -n "$still + $sink - 0.0032")" --every 0.0048s
            else
                step sunk.h5 --until "$(jq -n "$still + $sink - 0.05")" --every 1s
                nsd-step -n 120 --every 12 --forces -o "$out/sunk-$mu-$seed.h5" "$out/sunk.h5" 2>"$out/sunk-$mu-$seed.log"
            fi
        layers "sunk-$mu-$seed.h5" "$mu"
    done
done >"$out/runs.json"

with 'group_by(.friction)[] | "# \(.[0].friction)", (map([.layers[range(3; 40; 3)]]) | transpose[] | [(map(.[0]) | mean), (map(.[1]) | mean, error // 0), (map(.[2]) | mean)] | @tsv), "", ""' \
    -rs "$out/runs.json" >"$out/load.tsv"
with 'map([.friction, .K]) | spread[] | map(. // 0) | @tsv' -rs "$out/runs.json" >"$out/k.tsv"
curve
picture --clip 0,1,0,0 -c force --step "$(nsd-info "$out/sunk-0.4-${seeds[0]}.h5" | jq -s 'map(.step // empty) | max')" "$out/sunk-0.4-${seeds[0]}.h5"
with 'def of($low; $high): map(select(.friction >= $low and .friction <= $high));
    # one value for each seed: the mean of its runs
    def each(values): [range(0; length; $count) as $k | .[$k : $k + $count] | values | mean];
    row("K"; each(of(0.1; 0.3) | map(.K))),
    row("mu K"; each(of(0.4; 0.4) | map(.K * .friction))),
    row("predicted"; each(of(0.3; 0.3) | map(.predicted))),
    row("mobilised"; each(of(0.1; 0.3) | map(.mobilised))),
    row("balance"; each(map(.balance)))' -s --argjson count "${#frictions[@]}" "$out/runs.json" | results
