#!/usr/bin/env bash
# Columns that collapse: how far they run out, by how slender they are.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

# a:width, of every seed; of the first seed only, because their cost grows as a^1.5. Columns lower than wide are 80 discs wide
low=$(pick '0.8:0.12 1.4:0.12' '0.5:0.8 0.7:0.8 0.9:0.8')
high=$(pick '2.6:0.12 4:0.12' '1.2:0.4 1.8:0.4 2.5:0.4 3.6:0.4')
slender=$(pick '' '5:0.4')
d=0.01 # m

# collapse A:WIDTH SEED: a row of seed, a of the column at rest, run-out over the width
collapse()
{
    local gate end width=${1#*:}
    set -- "${1%:*}" "$2"
    read -r gate end < <(jq -nr --argjson a "$1" --argjson w "$width" '($a * $w * 2 / 9.81 | sqrt) as $fall | [0.2 + $fall / 5, 0.35 + 3.5 * $fall] | @tsv')
    scene collapse --argjson seed "$2" --argjson w "$width" --argjson a "$1" --argjson gate "$gate" --argjson phi "$(pick 0.72 0.78)" '.seed = $seed | .dt = 7e-4 | .mu = 1 | .e_n = 0.5 |
        .walls[2] = {segment: [[$w, 0], [$w, 20]], until: $gate} |
        .bodies = [{random: {phi: $phi}, radius: .bodies[0].radius, box: {x: [0, $w], y: [0, 1.03 * $a * $w]}}]' |
        nsd-gen - | start column.h5 --until "$gate" --every 1s
    # the document has its gate, which vanishes at its next step
    step "run-$1-$2.h5" --until "$end" --every "$(jq -n "$end / 8")s" <"$out/column.h5"
    echo "$2 $(nsd-info --last -b "$out/column.h5" | jq -s --argjson w "$width" 'map(.position[1]) | 2 * add / length / $w') $(front "run-$1-$2.h5" "$d")" |
        awk -v w="$width" '{ print $1, $2, ($3 - w) / w }'
}

for seed in "${seeds[@]}"; do
    ! part low || for a in $low; do collapse "$a" "$seed"; done
    ! part high || for a in $high; do collapse "$a" "$seed"; done
done >"$out/runout.tsv"
! part high || for a in $slender; do collapse "$a" "${seeds[0]}"; done >>"$out/runout.tsv"
# means of the runs of one a: a, run-out and its error
with 'numbers | map([(.[1] * 3 | log * 4 | round), .[1], .[2]]) | group_by(.[0])[] | [(map(.[1]) | mean), (map(.[2]) | mean, error // 0)] | @tsv' -Rrs "$out/runout.tsv" >"$out/curve.tsv"
if [ -z "${PART:-}" ]; then
    curve
    last=${high##* }
    last=run-${last%:*}-${seeds[0]}.h5
    picture -c speed --step "$(nsd-info "$out/$last" | jq -s 'map(.step // empty) | .[length / 4 | floor]')" "$out/$last"
fi
with 'numbers as $all |
    # one value for each seed; the slender columns of the first seed belong to it
    [$all | group_by(.[0])[] | map(.[1:])] as $runs |
    def exponent: if length > 1 then power.b else null end;
    ($runs | map(map(select(.[0] < $middle)))) as $low | ($runs | map(map(select(.[0] > 2.2)))) as $high |
    (if $low | any(. != []) then
        row("low exponent"; $low | map(exponent)),
        row("low factor"; $low | map(map(.[1] / .[0]) | mean)) else empty end),
    (if $high | any(. != []) then
        row("high exponent"; $high | map(exponent)),
        row("high factor"; $high | map(map(.[1] / (.[0] | pow(.; 0.7))) | mean)) else empty end)' -Rs --argjson middle "$(pick 2.2 1)" "$out/runout.tsv" | results
