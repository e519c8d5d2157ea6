#!/usr/bin/env bash
# Piles from a narrow source and of rain: the pressure under them.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

half=$(pick 0.12 0.22) # m, of the slab
read -ra seeds <<<"${SEEDS:-$(pick '1 2 3' '1 2 3 4 5 6 7 8')}"

# pile NAME SEED FILTER GRAINS: is poured, as many grains as GRAINS times the half width squared, and comes to rest
pile()
{
    local n
    n=$(jq -n "$half * $half * $4 | round")
    scene sandpile --argjson seed "$2" --argjson h "$half" --argjson n "$n" '.seed = $seed | .walls[0].segment = [[-$h, 0], [$h, 0]] | .pour[0] |= (.count = $n | .opening.box.y = [0.75 * $h, 0.75 * $h + 0.12]) | '"$3" |
        nsd-gen - | step "poured.h5" --until "$(jq -n "$n / 600 + 1.5")" --every 100s
    nsd-step --tolerance 0.01 -n 20 --every 20 --forces -o "$out/$1-$2.h5" "$out/poured.h5" 2>"$out/$1-$2.log"
}

# under FILE.h5: {floor: [[x, force]], weight, height, fabric}, x in half widths of the slab, forces in N
under()
{
    nsd-info --last -c "$out/$1" | jq -c 'select(.r[0] > 0) | [.wall, .point[0], .r[0], .n[0], .n[1]]' >"$out/contacts.json"
    nsd-info --last -b "$out/$1" | jq -c '[.position[0], .position[1], .mass]' >"$out/grains.json"
    jq -nc --slurpfile c "$out/contacts.json" --slurpfile g "$out/grains.json" --argjson h "$half" --argjson dt 5e-4 --arg kind "$2" --argjson seed "$3" '
        ($g | map(.[1]) | sort | .[-3]) as $top | ($c | map(select(.[0] == null))) as $inner |
        {kind: $kind, seed: $seed, floor: ($c | map(select(.[0] != null) | [.[1] / $h, .[2] / $dt])), weight: ($g | map(.[2] * 9.81) | add), height: $top, grains: ($g | length),
         # of the normals, the left side mirrored: the mean of sin 2a, where a is their angle to the horizontal, outwards
         fabric: ($inner | map((if .[1] < 0 then -1 else 1 end) * 2 * .[3] * .[4]) | add / length),
         deviator: ($inner | map(.[3] * .[3] - .[4] * .[4]) | add / length)}'
}

for seed in "${seeds[@]}"; do
    pile point "$seed" . 9500
    under "point-$seed.h5" point "$seed"
    pile rain "$seed" '.pour[0].opening.box.x = [-$h, $h]' 15000
    under "rain-$seed.h5" rain "$seed"
done >"$out/piles.json"
# pressure by distance from the centre in tenths of the half width, over that of a column as high as the pile, 0.82 of it solid
with 'group_by(.kind)[] | "# \(.[0].kind)", (map(. as $p | range(10) as $k |
        [($k + 0.5) / 10, ($p.floor | map(select((.[0] | fabs) >= $k / 10 and (.[0] | fabs) < ($k + 1) / 10) | .[1]) | add // 0) / (0.2 * $half * 2500 * 0.82 * 9.81 * $p.height)]) |
    spread[] | map(. // 0) | @tsv), "", ""' -rs --argjson half "$half" "$out/piles.json" >"$out/pressure.tsv"
curve
picture -c force "$out/point-${seeds[0]}.h5"
with 'def near($a; $b): .floor | map(select((.[0] | fabs) >= $a and (.[0] | fabs) < $b) | .[1]) | add // 0 | . / ($b - $a);
    def of($kind): map(select(.kind == $kind));
    # a ratio of means over the piles, for its error as values without one pile each (jackknife)
    def ratio(top; below): . as $all | length as $n | (map(top) | add) as $t | (map(below) | add) as $b |
        if $n < 2 then [$t / $b] else map($n * $t / $b - ($n - 1) * ($t - top) / ($b - below)) end;
    row("point"; of("point") | ratio(near(0; 0.1); near(0.2; 0.4))),
    row("rain"; of("rain") | ratio(near(0; 0.1); near(0.2; 0.4))),
    row("fabric"; [of("point"), of("rain")] | transpose | ratio(.[0].fabric; .[1].fabric)),
    row("balance"; map((.floor | map(.[1]) | add) / .weight))' -s "$out/piles.json" | results
