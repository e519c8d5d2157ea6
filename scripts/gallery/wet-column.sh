#!/usr/bin/env bash
# Columns of discs that attract each other: how far they run out, by their cohesion.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

width=$(pick 0.08 0.2) ratio=1.5 gate=0.3
read -ra bonds <<<"$(pick '0 10 200' '0 3 10 30 100')"
weight=$(jq -n '2500 * 3.141592653589793 * 25e-6 * 9.81')

# a row for each run: the Bond number, run-out and height left, over the width and the height of the column at rest
for seed in "${seeds[@]}"; do
    for b in "${bonds[@]}"; do
        scene collapse --argjson seed "$seed" --argjson w "$width" --argjson a "$ratio" --argjson gate "$gate" --argjson phi "$(pick 0.72 0.77)" --argjson f "$(jq -n "$b * $weight")" '
            .seed = $seed | .mu = 1 | .e_n = 0.5 | .walls[2] = {segment: [[$w, 0], [$w, 20]], until: $gate} | .pairs = [{pair: ["ball", "wall"], cohesion: {force: 0}}] |
            (if $f > 0 then .cohesion = {force: $f, range: 5e-5} else . end) |
            .bodies = [{random: {phi: $phi}, radius: .bodies[0].radius, box: {x: [0, $w], y: [0, 1.03 * $a * $w]}}]' |
            nsd-gen - | start column.h5 --until "$gate" --every 1s
        # the document has its gate, which vanishes at its next step
        step "run-$b-$seed.h5" --until 1.8 --every 0.5s <"$out/column.h5"
        { nsd-info --last -b "$out/column.h5"; nsd-info --last -b "$out/run-$b-$seed.h5"; } |
            jq -rs --argjson w "$width" --arg b "$b" --argjson front "$(front "run-$b-$seed.h5" 0.01)" 'group_by(.step) | map(map(.position[1] + .radius) | max) as $top |
                "\($b) \(($front - $w) / $w) \($top[1] / $top[0])"'
    done
done >"$out/runout.tsv"
with 'numbers | group_by(.[0])[] | [.[0][0], (map(.[1]) | mean, error // 0), (map(.[2]) | mean, error // 0)] | @tsv' -Rrs "$out/runout.tsv" >"$out/curve.tsv"
curve
picture "$out/run-${bonds[$((${#bonds[@]} / 2))]}-${seeds[0]}.h5"
with 'numbers as $all | ($all | length / $seeds) as $n | [range($seeds) as $k | $all[$k * $n : ($k + 1) * $n]] as $runs |
    [range($n) as $i | $runs | map(.[$i][1]) | [mean, error // 0]] as $means |
    row("dry"; $runs | map(.[0][1])),
    row("steps that rise"; [range(1; $n) | select($means[.][0] > $means[. - 1][0] + $means[.][1])] | length),
    # between the numbers that the runs have, by their logarithms; 1 stands for 0
    row("Bond"; $runs | map([range(1; $n) as $i | select(.[$i][2] >= 0.9 and .[$i - 1][2] < 0.9) |
        ((0.9 - .[$i - 1][2]) / (.[$i][2] - .[$i - 1][2])) as $part | (([.[$i - 1][0], 1] | max | log) * (1 - $part) + (.[$i][0] | log) * $part | exp)][0])),
    row("stands"; $runs | map(.[-1][1]))' -Rs --argjson seeds "${#seeds[@]}" "$out/runout.tsv" | results
