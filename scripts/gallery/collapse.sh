#!/usr/bin/env bash
# Columns that collapse: how far they run out, by how slender they are.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

width=$(pick 0.08 0.15)
read -ra ratios <<<"$(pick '0.6 1.6 2.6 5' '0.5 0.9 1.5 2.3 3.5 5.5 8')"

echo "a runout front" >"$out/runout.tsv"
for a in "${ratios[@]}"; do
    # the gate goes when the column has come to rest, and the run ends when a fall from its top has long ended
    read -r gate end < <(jq -nr --argjson a "$a" --argjson w "$width" '($a * $w * 2 / 9.81 | sqrt) as $fall | [0.3 + 2 * $fall, 0.8 + 7 * $fall] | @tsv')
    scene collapse --argjson w "$width" --argjson a "$a" --argjson gate "$gate" '
        .walls[2] = {segment: [[$w, 0], [$w, 20]], until: $gate} |
        .bodies[0] |= (.count = ($w * $w * $a * 0.83 / 7.96e-5 | round) | .box.x = [0, $w])' |
        nsd-gen - | step "column-$a.h5" --until "$gate" --every 1s
    # the document has its gate, which vanishes at its next step
    nsd-step --until "$end" --every 0.05s --overlap project -o "$out/run-$a.h5" "$out/column-$a.h5" 2>"$out/run.log"
    # what touches on is part of the heap: discs that have rolled ahead are not; a column's mean height is half its own
    { nsd-info --last -p "$out/column-$a.h5"; nsd-info --last -p "$out/run-$a.h5"; } |
        with 'map([.step, .x[0], .x[1], .radius]) | group_by(.[0]) |
            (.[0] | 2 * (map(.[2]) | mean)) as $height |
            (.[1] | map(.[1] + .[3]) | front) as $front |
            [$height / $w, ($front - $w) / $w, $front] | @tsv' -rs --argjson w "$width" >>"$out/runout.tsv"
done
curve
picture -c speed --step "$(nsd-info "$out/run-${ratios[-1]}.h5" | jq -s 'map(.step // empty) | .[length / 4 | floor]')" "$out/run-${ratios[-1]}.h5"
with '[inputs | split("\t") | map(tonumber)] |
    (map(select(.[0] < 2.3)) | power) as $low | (map(select(.[0] > 2.3)) | power) as $high |
    row("low exponent"; $low.b),
    row("high exponent"; $high.b),
    row("low factor"; $low.a),
    row("high factor"; $high.a)' \
    -nR <(tail -n +2 "$out/runout.tsv") | results
