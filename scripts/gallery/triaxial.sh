#!/usr/bin/env bash
# Biaxial and triaxial compression at a constant pressure beside, from a dense and a loose start.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

# compress NAME DIM COUNT MU RATE STRAIN SEEDS: dense is pressed together without friction, loose with it
compress()
{
    local seed begin file
    for begin in dense loose; do
        for seed in $7; do
            file=$1-$begin-$seed
            scene isotropic --argjson mu "$([ $begin = dense ] && echo 0 || echo "$4")" --argjson n "$3" --argjson dim "$2" --argjson seed "$seed" '
                .seed = $seed | .dim = $dim | .mu = $mu | (if $dim == 2 then .density = 1.257 | .gravity = [0, 0] else . end) |
                (if $dim == 2 then $n * 1.45 | sqrt else $n * 1.46 | log / 3 | exp end) as $L |
                .cell.lengths = ([range($dim)] | map($L)) | .bodies[0].random.count = $n | del(.bodies[0].box)' |
                nsd-gen - | start "$file-begin.h5" --overlap-rule gap --until 30 --every 30s
            # the last axis becomes shorter at a constant rate, the others yield to the pressure
            on "$file-begin.h5" --argjson mu "$4" --argjson rate "$5" '.mu = $mu | .time = 0 | .dim as $dim |
                .bodies[0].at_rest = true |
                .cell = {gradient: [range($dim) | . as $i | [range($dim) | if . == $i and . == $dim - 1 then -$rate else 0 end]],
                    stress: {target: [range($dim) | . as $i | [range($dim) | if . == $i and . < $dim - 1 then 1 else null end]], mass: 10}}' |
                step "$file.h5" --overlap-rule gap --until "$(jq -n "$6 / $5")" --every "$(jq -n "$6 / $5 / 60")s" --contacts
            # strain, stress along the compression and beside it, solid fraction, Z, seed, of the frames in turn
            stresses "$file.h5" | jq -r --argjson rate "$5" --argjson k $(($2 - 1)) --argjson seed "$seed" \
                'select(.stress) | .stress.tensor as $s | [.time * $rate, $s[$k][$k], ([range($k) | $s[.][.]] | add / length),
                .fraction.fraction, .coordination.z_mechanical, $seed] | @tsv' >"$out/$file.tsv"
        done
        # means over the seeds: strain, sin phi, its error, solid fraction, its error
        cat "$out/$1-$begin"-[0-9]*.tsv | with 'numbers | map(.[0] |= (. * 1e3 | round / 1e3)) | (map([.[0], (.[1] - .[2]) / (.[1] + .[2])]) | spread) as $sin |
            (map([.[0], .[3]]) | spread) as $phi |
            range($sin | length) as $i | [$sin[$i][0], $sin[$i][1], $sin[$i][2] // 0, $phi[$i][1], $phi[$i][2] // 0] | @tsv' -rRs >"$out/$1-$begin.tsv"
    done
}
# findings NAME SEEDS: rows from the tables of all seeds. A friction is the ratio of mean stresses
findings()
{
    for seed in $2; do
        jq -nc --rawfile dense "$out/$1-dense-$seed.tsv" --rawfile loose "$out/$1-loose-$seed.tsv" '{dense: $dense, loose: $loose}'
    done | with '
        def late($k): map(.[$k]) | .[length / 2 | floor:] | mean;
        def sin($a; $b): ($a - $b) / ($a + $b);
        def critical: sin(late(1); late(2));
        def peak: [range(2; length - 2) as $i | .[$i - 2:$i + 3] | sin(map(.[1]) | mean; map(.[2]) | mean)] | .[:length / 2 | floor] | max;
        map(map_values(numbers)) |
        row($name + " critical"; map(.dense | critical)),
        row($name + " critical, loose"; map(.loose | critical)),
        row($name + " peak"; map((.dense | peak) / (.dense | critical))),
        row($name + " dilation"; map(.dense[0][3] - (.dense | late(3)))),
        row($name + " phi, dense less loose"; map((.dense | late(3)) - (.loose | late(3)))),
        row($name + " Z, dense less loose"; map((.dense | late(4)) - (.loose | late(4))))' -s --arg name "$1"
}

# ten seeds of discs, whose scatter is 0.03, and the first five of balls
few=("${seeds[@]:0:5}")
shapes=()
if part discs; then
    compress discs 2 "$(pick 80 200)" 0.5 "$(pick 0.006 0.002)" 0.3 "${seeds[*]}"
    shapes+=(discs)
fi
if [ -z "${QUICK:-}" ] && part balls; then
    compress balls 3 200 0.3 0.004 0.4 "${few[*]}"
    shapes+=(balls)
fi
if [ -z "${PART:-}" ]; then
    curve
    picture --network "$out/discs-loose-${seeds[0]}.h5"
fi
for shape in "${shapes[@]}"; do findings "$shape" "$([ "$shape" = discs ] && echo "${seeds[*]}" || echo "${few[*]}")"; done | results
