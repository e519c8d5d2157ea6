#!/usr/bin/env bash
# A layer on a bumpy slope: where it stops, by its height, and how fast it flows.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

layer() # FILE WIDTH HEIGHT DEGREES arguments of nsd-step
{
    scene incline --argjson w "$2" --argjson h "$3" --argjson angle "$4" '($angle * 3.141592653589793 / 180) as $a |
        .gravity = [($a | sin), -($a | cos)] | .cell.lengths[0] = $w | .bodies[0] |= (.count = $w | .box.x = [0, $w]) |
        .bodies[1] |= (.count = ($w * $h | round) | .box.x = [0, $w])' | nsd-gen - | step "$1" "${@:5}"
}
# m/s: the mean along the slope of what is not fixed, as a mean over the frames of the second half
speed() { nsd-info -p "$out/$1" | jq -s 'map(select(.mass > 0) | [.step, .v[0]]) | (map(.[0]) | max / 2) as $half | map(select(.[0] > $half) | .[1]) | add / length'; }

# from a flow at 26 degrees the slope is lowered until nothing moves. Narrow layers jam by chance: those 3
# discs high and 10 wide stopped at 14 to 22 degrees, by the seed; 30 wide, five of five stopped above those 7 high
read -ra heights <<<"$(pick '3 7' '3 5 8 12')"
width=$(pick 30 20) hold=$(pick 60 80) less=$(pick 2 0.5)
echo "height angle" >"$out/stop.tsv"
for h in "${heights[@]}"; do
    layer lower.h5 "$width" "$h" 26 --until "$hold" --every "${hold}s"
    angle=26 moves=true
    while [ $moves = true ] && [ "$(jq -n "$angle > 10")" = true ]; do
        angle=$(jq -n "$angle - $less")
        on lower.h5 --argjson angle "$angle" '($angle * 3.141592653589793 / 180) as $a | .gravity = [($a | sin), -($a | cos)] | .time = 0' |
            step next.h5 --until "$hold" --every "${hold}s"
        mv "$out/next.h5" "$out/lower.h5"
        moves=$(nsd-info --last -p "$out/lower.h5" | jq -s 'map(select(.mass > 0) | .v[0] | fabs) | add / length > 2e-3')
    done
    echo "$h $angle" >>"$out/stop.tsv"
done

read -ra flows <<<"$(pick '5 8' '6 9 13 18')"
width=$(pick 10 20) until=$(pick 100 250)
echo "height speed" >"$out/flow.tsv"
for h in "${flows[@]}"; do
    layer "flow-$h.h5" "$width" "$h" 24 --until "$until" --every "$(jq -n "$until / 40")s"
    echo "$h $(speed "flow-$h.h5")" >>"$out/flow.tsv"
done
# of the thickest: mean speed by depth, over its last half
nsd-info -p "$out/flow-${flows[-1]}.h5" | jq -rs 'map(select(.mass > 0) | [.step, .x[1], .v[0]]) | (map(.[0]) | max / 2) as $half |
    map(select(.[0] > $half)) | group_by(.[1] | floor) | map([(map(.[1]) | add / length), (map(.[2]) | add / length), length]) |
    (map(.[2]) | max) as $most | .[] | select(.[2] > $most / 2) | @tsv' >"$out/profile.tsv"
curve
picture -c speed "$out/flow-${flows[-1]}.h5"
with 'def numbers: split("\n") | map(select(test("^[0-9]")) | split("[ \t]"; null) | map(tonumber));
    ($stop | numbers) as $s | ($flow | numbers | power) as $v | ($profile | numbers) as $p | ($flow | numbers)[-1][1] as $mean |
    row("stop angle"; $s[-1][1]),
    row("steps that rise"; ([range(1; $s | length) | select($s[.][1] > $s[. - 1][1])] | length)),
    row("thin less thick"; $s[0][1] - $s[-1][1]),
    row("exponent"; $v.b),
    row("fastest layer"; ($p | map(.[1]) | max) / $mean)' \
    -n --rawfile stop "$out/stop.tsv" --rawfile flow "$out/flow.tsv" --rawfile profile "$out/profile.tsv" | results
