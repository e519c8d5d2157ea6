#!/usr/bin/env bash
# Columns that collapse: how far they run out, by how slender they are.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

width=$(pick 0.12 0.4)
# aspect ratios: of every seed; of the first seed only, because their cost grows as a^1.5
read -ra ratios <<<"$(pick '0.8 1.4 2.6 4' '0.7 1.2 1.8 2.5 3.6')"
read -ra slender <<<"$(pick '' '5')"

# collapse A SEED: a row of seed, a of the column at rest, run-out over the width
collapse()
{
    local gate end
    read -r gate end < <(jq -nr --argjson a "$1" --argjson w "$width" '($a * $w * 2 / 9.81 | sqrt) as $fall | [0.2 + $fall / 5, 0.35 + 3.5 * $fall] | @tsv')
    scene collapse --argjson seed "$2" --argjson w "$width" --argjson a "$1" --argjson gate "$gate" --argjson phi "$(pick 0.72 0.78)" '.seed = $seed | .dt = 7e-4 | .mu = 1 | .e_n = 0.5 |
        .walls[2] = {segment: [[$w, 0], [$w, 20]], until: $gate} |
        .bodies = [{random: {phi: $phi}, radius: .bodies[0].radius, box: {x: [0, $w], y: [0, 1.03 * $a * $w]}}]' |
        nsd-gen - | step column.h5 --until "$gate" --every 1s
    # the document has its gate, which vanishes at its next step
    nsd-step --until "$end" --every "$(jq -n "$end / 8")s" --contacts -o "$out/run-$1-$2.h5" "$out/column.h5" 2>"$out/run-$1-$2.log"
    echo "$2 $(nsd-info --last -p "$out/column.h5" | jq -s --argjson w "$width" 'map(.x[1]) | 2 * add / length / $w') $(front "run-$1-$2.h5")" |
        awk -v w="$width" '{ print $1, $2, ($3 - w) / w }'
}

for seed in "${seeds[@]}"; do
    for a in "${ratios[@]}"; do collapse "$a" "$seed"; done
done >"$out/runout.tsv"
for a in "${slender[@]}"; do collapse "$a" "${seeds[0]}"; done >>"$out/runout.tsv"
# means of the runs of one a: a, run-out and its error
with 'numbers | map([(.[1] * 3 | log * 4 | round), .[1], .[2]]) | group_by(.[0])[] | [(map(.[1]) | mean), (map(.[2]) | mean, error // 0)] | @tsv' -Rrs "$out/runout.tsv" >"$out/curve.tsv"
curve
picture -c speed --step "$(nsd-info "$out/run-${ratios[-1]}-${seeds[0]}.h5" | jq -s 'map(.step // empty) | .[length / 4 | floor]')" "$out/run-${ratios[-1]}-${seeds[0]}.h5"
with 'numbers as $all |
    # one value for each seed; the slender columns of the first seed belong to it
    [$all | group_by(.[0])[] | map(.[1:])] as $runs |
    ($runs | map(map(select(.[0] < 2.2)))) as $low | ($runs | map(map(select(.[0] > 2.2)))) as $high |
    row("low exponent"; $low | map(power.b)),
    row("low factor"; $low | map(map(.[1] / .[0]) | mean)),
    row("high exponent"; $high | map(power.b)),
    row("high factor"; $high | map(map(.[1] / (.[0] | pow(.; 0.7))) | mean))' -Rs "$out/runout.tsv" | results
