#!/usr/bin/env bash
# Cubes that come together in a periodic cell: solid fraction and order by friction.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

read -ra mus <<<"$(pick '0 1' '0 0.1 0.2 0.5 1')"
count=$(pick 40 200) end=$(pick 15 20)

# order FILE.h5: the cubatic order of its last frame, sum of P4(a . n) over the axes a of all cubes, at its largest over n along
# one of these axes; 1 if all cubes are turned alike, 0 on the whole if they are turned at random
order()
{
    nsd-info -l -b "$1" | jq -s 'map(.orientation as [$w, $x, $y, $z] |
            [1 - 2 * ($y * $y + $z * $z), 2 * ($x * $y + $w * $z), 2 * ($x * $z - $w * $y)],
            [2 * ($x * $y - $w * $z), 1 - 2 * ($x * $x + $z * $z), 2 * ($y * $z + $w * $x)],
            [2 * ($x * $z + $w * $y), 2 * ($y * $z - $w * $x), 1 - 2 * ($x * $x + $y * $y)]) as $axes |
        [$axes[] as $n | [$axes[] | (.[0] * $n[0] + .[1] * $n[1] + .[2] * $n[2]) as $c | $c * $c | (35 * . * . - 30 * . + 3) / 8] | add / length / (7 / 12)] | max'
}

for seed in "${seeds[@]}"; do
    for mu in "${mus[@]}"; do
        scene cubes --argjson mu "$mu" --argjson seed "$seed" --argjson n "$count" '.mu = $mu | .seed = $seed |
            (.cell.lengths[0] * pow($n / .bodies[0].random.count; 1 / 3)) as $L | .cell.lengths = [$L, $L, $L] | .bodies[0].random.count = $n' >"$out/scene.json"
        nsd-gen "$out/scene.json" >"$out/start.h5"
        step "cubes-$mu-$seed.h5" --until "$end" --every "${end}s" --contacts "$out/start.h5"
        # mu, phi, the order less that of the start, the pressure
        nsd-stat -l -m fraction,stress "$out/cubes-$mu-$seed.h5" | jq -r --argjson mu "$mu" \
            --argjson order "$(order "$out/cubes-$mu-$seed.h5")" --argjson start "$(order "$out/start.h5")" \
            '[$mu, .fraction.fraction, $order - $start, .stress.p] | @tsv' >>"$out/runs.tsv"
    done
done
with 'numbers | (map([.[0], .[1]]) | spread) as $phi | (map([.[0], .[2]]) | spread) as $order |
    range($phi | length) as $i | [$phi[$i][0], $phi[$i][1], $phi[$i][2] // 0, $order[$i][1], $order[$i][2] // 0] | @tsv' -rRs "$out/runs.tsv" >"$out/cubes.tsv"
curve
picture "$out/cubes-0-${seeds[0]}.h5"
with 'numbers | . as $all | def at($mu; $k): $all | map(select(.[0] == $mu)[$k]);
    row("dense"; at(0; 1)),
    row("loose"; at(1; 1)),
    row("order"; at(0; 2)),
    row("pressure"; $all | map(.[3]) | mean)' -Rs "$out/runs.tsv" | results
