#!/usr/bin/env bash
# Biaxial and triaxial compression at a constant pressure beside, from a dense and a loose start.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

# compress NAME DIM COUNT MU RATE STRAIN: dense is pressed together without friction, loose with it
compress()
{
    local seed start file
    for start in dense loose; do
        for seed in "${seeds[@]}"; do
            file=$1-$start-$seed
            scene isotropic --argjson mu "$([ $start = dense ] && echo 0 || echo "$4")" --argjson n "$3" --argjson dim "$2" --argjson seed "$seed" '
                .seed = $seed | .dim = $dim | .mu = $mu | (if $dim == 2 then .density = 1.257 | .gravity = [0, 0] else . end) |
                (if $dim == 2 then $n * 1.45 | sqrt else $n * 1.46 | log / 3 | exp end) as $L |
                .cell.lengths = ([range($dim)] | map($L)) | .bodies[0].random.count = $n | del(.bodies[0].box)' |
                nsd-gen - | step "$file-begin.h5" --overlap-rule gap --until 30 --every 30s
            # the last axis becomes shorter at a constant rate, the others yield to the pressure
            on "$file-begin.h5" --argjson mu "$4" --argjson rate "$5" '.mu = $mu | .time = 0 | .dim as $dim |
                .bodies[0].at_rest = true |
                .cell = {gradient: [range($dim) | . as $i | [range($dim) | if . == $i and . == $dim - 1 then -$rate else 0 end]],
                    stress: {target: [range($dim) | . as $i | [range($dim) | if . == $i and . < $dim - 1 then 1 else null end]], mass: 10}}' |
                step "$file.h5" --overlap-rule gap --until "$(jq -n "$6 / $5")" --every "$(jq -n "$6 / $5 / 60")s" --contacts
            # strain, sin phi, solid fraction, Z, of the frames in turn
            nsd-stat -m stress,fraction,coordination "$out/$file.h5" | jq -r --argjson rate "$5" --argjson k $(($2 - 1)) \
                'select(.stress) | .stress.tensor as $s | [.time * $rate, ($s[$k][$k] - $s[0][0]) / ($s[$k][$k] + $s[0][0]),
                .fraction.fraction, .coordination.z_mechanical] | @tsv' >"$out/$file.tsv"
        done
        # means over the seeds: strain, sin phi, its error, solid fraction, its error
        cat "$out/$1-$start"-[0-9]*.tsv | with 'numbers | map(.[0] |= (. * 1e6 | round / 1e6)) | (map([.[0], .[1]]) | spread) as $sin | (map([.[0], .[2]]) | spread) as $phi |
            range($sin | length) as $i | [$sin[$i][0], $sin[$i][1], $sin[$i][2] // 0, $phi[$i][1], $phi[$i][2] // 0] | @tsv' -rRs >"$out/$1-$start.tsv"
    done
}
# findings NAME: rows from the tables of all seeds
findings()
{
    jq -nc --rawfile text <(for seed in "${seeds[@]}"; do
        jq -nc --rawfile dense "$out/$1-dense-$seed.tsv" --rawfile loose "$out/$1-loose-$seed.tsv" '{dense: $dense, loose: $loose}'
    done) '$text | split("\n") | map(select(. != "") | fromjson)' | with '
        def late($k): map(.[$k]) | .[length / 2 | floor:] | mean;
        def peak: map(.[1]) | [range(2; length - 2) as $i | .[$i - 2:$i + 3] | mean] | .[:length / 2 | floor] | max;
        map(map_values(numbers)) |
        row($name + " critical"; map(.dense | late(1))),
        row($name + " critical, loose"; map(.loose | late(1))),
        row($name + " peak"; map((.dense | peak) / (.dense | late(1)))),
        row($name + " dilation"; map(.dense[0][2] - (.dense | late(2)))),
        row($name + " phi, dense less loose"; map((.dense | late(2)) - (.loose | late(2)))),
        row($name + " Z, dense less loose"; map((.dense | late(3)) - (.loose | late(3))))' --arg name "$1"
}

compress discs 2 "$(pick 80 200)" 0.5 "$(pick 0.006 0.002)" 0.3
shapes=(discs)
if [ -z "${QUICK:-}" ]; then
    compress balls 3 200 0.3 0.004 0.4
    shapes+=(balls)
fi
curve
picture --network "$out/discs-loose-${seeds[0]}.h5"
for shape in "${shapes[@]}"; do findings "$shape"; done | results
