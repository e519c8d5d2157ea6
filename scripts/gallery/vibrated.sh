#!/usr/bin/env bash
# A vibrated bed: when it leaves the floor, and for how long, against a ball that does not bounce.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

read -ra gammas <<<"$(pick '0.9 1.8' '0.9 1.2 1.6 2 2.4 2.8')"
count=$(pick 36 60) periods=$(pick 8 16)

# the fall of the bed, then its periods; the last half of them is measured, each of the 400 steps a period
echo "gamma flight closed force" >"$out/flight.tsv"
for seed in "${seeds[@]}"; do
    for gamma in "${gammas[@]}"; do
        scene vibrated --argjson seed "$seed" --argjson gamma "$gamma" --argjson n "$count" '.seed = $seed | .bodies[0].count = $n |
            .walls[0].drives[0].amplitude = $gamma * 9.81 / (40 * 3.141592653589793 | . * .)' |
            nsd-gen - | step fall.h5 --until "$(jq -n "0.3 + $periods / 40")" --every 1s
        nsd-step --until "$(jq -n "0.3 + $periods / 20")" --contacts -o "$out/bed.h5" "$out/fall.h5" 2>"$out/bed.log"
        mass=$(nsd-info -b --last "$out/bed.h5" | jq -s 'map(.mass) | add')
        nsd-stat -m walls "$out/bed.h5" |
            with '
            # of a ball that does not bounce: the phase from its leaving to its landing, over 2 pi
            def closed($g): if $g <= 1 then 0 else (1 / $g | asin) as $at |
                def above($x): ($at | sin) + $x * ($at | cos) - $x * $x / (2 * $g) - ($at + $x | sin);
                (first(range(1; 6000) | . / 1000 | select(. > 0.05 and above(.) < 0))) as $land | $land / (2 * 3.141592653589793) end;
            # a flight is as long as eight steps: a bed that is nearly weightless pushes the floor at one step and not at the next
            map(.walls.normal | add // 0) | mean as $force | length as $all |
            (reduce .[] as $f ({run: 0, free: 0};
                if $f == 0 then .run += 1 else (if .run >= 8 then .free += .run else . end) | .run = 0 end) |
                .free + (if .run >= 8 then .run else 0 end)) as $free |
            [$gamma, $free / $all, closed($gamma), $force / $mass / 9.81] | @tsv' -rs --argjson gamma "$gamma" --argjson mass "$mass" >>"$out/flight.tsv"
    done
done
with 'numbers as $all | $all | map(.[:2]) | spread[] as $f | [$f[0], $f[1], $f[2] // 0, ($all | map(select(.[0] == $f[0]))[0][2])] | @tsv' -Rrs "$out/flight.tsv" >"$out/curve.tsv"
curve
picture -c force --walls lines "$out/bed.h5"
with 'numbers as $all | ($all | length / $seeds) as $n | [range($seeds) as $k | $all[$k * $n : ($k + 1) * $n]] as $runs |
    row("rest"; $runs | map(map(select(.[0] < 1) | .[1]) | max)),
    row("low flight"; $runs | map(map(select(.[0] > 1 and .[0] <= 2) | .[1] - .[2] | fabs) | max)),
    # of a full run
    ($runs | map(map(select(.[0] > 2) | .[1] - .[2] | fabs) | max) | if .[0] then row("high flight"; .) else empty end),
    row("force"; $runs | map(map(.[3]) | mean))' -Rs --argjson seeds "${#seeds[@]}" "$out/flight.tsv" | results
