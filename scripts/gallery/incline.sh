#!/usr/bin/env bash
# A layer on a bumpy slope: where it stops, by its height, and how fast it flows.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

# layer FILE WIDTH HEIGHT DEGREES SEED arguments of nsd-step: the bed has gaps of half a disc, so that the first layer
# sticks to it. On a bed of discs that touch it slips, by an eighth of the mean speed of a layer 10 discs high
layer()
{
    scene incline --argjson w "$2" --argjson h "$3" --argjson angle "$4" --argjson seed "$5" '($angle * 3.141592653589793 / 180) as $a |
        .seed = $seed | .gravity = [($a | sin), -($a | cos)] | .cell.lengths[0] = $w |
        .bodies[0] |= (.count = ($w / 1.5 | round) | .spacing = 1.5 | .box = {x: [0, $w], y: [-0.25, 1.25]}) |
        .bodies[1] |= (.count = ($w * $h | round) | .box.x = [0, $w])' | nsd-gen - | step "$1" "${@:6}"
}
# of the last third of the frames: height of the layer above the tops of the bed, from that of its centre of mass, and mean speed
flows() { nsd-info -b "$out/$1" | jq -s 'map(select(.mass > 0)) | (map(.step) | max * 2 / 3) as $from | map(select(.step > $from)) |
    "\(2 * ((map(.position[1]) | add / length) - 1)) \(map(.velocity[0]) | add / length)"' -r; }
moves() { nsd-info --last -b "$out/$1" | jq -s 'map(select(.mass > 0) | .velocity[0] | fabs) | add / length > 2e-3'; }

# A layer that flows is lowered by half a degree at a time until nothing moves: height, degrees to start from, width
stops=$(pick '3:26:24 7:22:15' '4:27:30 6:25:24 9:23:18 13:21:18 18:20:18 35:18:18')
hold=$(pick 40 60) less=$(pick 1 0.5)
echo "height angle seed" >"$out/stop.tsv"
# two heights only: those that are compared with the independent code, and with what is published
[ "${PART:-}" != thick ] && by nsd || stops=$(pick "$stops" '18:20:18 35:18:18')
if by reference || [ "${PART:-}" = thick ]; then PART=stop; fi
! part stop || for s in "${seeds[@]}"; do
    for h in $stops; do
        IFS=: read -r h angle width <<<"$h"
        layer lower.h5 "$width" "$h" "$angle" "$s" --until "$hold" --every "${hold}s"
        while [ "$(moves lower.h5)" = true ] && [ "$(jq -n "$angle > 10")" = true ]; do
            angle=$(jq -n "$angle - $less")
            on lower.h5 --argjson angle "$angle" '($angle * 3.141592653589793 / 180) as $a | .gravity = [($a | sin), -($a | cos)] | .time = 0' |
                step next.h5 --until "$hold" --every "${hold}s"
            mv "$out/next.h5" "$out/lower.h5"
        done
        echo "$h $angle $s" >>"$out/stop.tsv"
    done
done

# Layers that flow at 25 degrees until they are steady: height and time
runs=$(pick '8:100 14:150' '16:250 20:250 25:300 32:350 40:450')
width=$(pick 12 20)
echo "height speed seed" >"$out/flow.tsv"
! part flow || for s in "${seeds[@]}"; do
    for h in $runs; do
        IFS=: read -r h until <<<"$h"
        layer "flow-$h-$s.h5" "$width" "$h" 25 "$s" --until "$until" --every "$(jq -n "$until / 60")s"
        echo "$(flows "flow-$h-$s.h5") $s" >>"$out/flow.tsv"
    done
    # of the thickest: mean speed by height, where the layer is as dense as inside
    nsd-info -b "$out/flow-$h-$s.h5" | jq -rs 'map(select(.mass > 0) | [.step, .position[1], .velocity[0]]) | (map(.[0]) | max * 2 / 3) as $from |
        map(select(.[0] > $from)) | group_by(.[1] | floor) | map([(map(.[1]) | add / length) - 1, (map(.[2]) | add / length), length]) |
        (map(.[2]) | max) as $most | .[] | select(.[2] > $most / 2) | @tsv' >"$out/profile-$s.tsv"
done

if [ "${PART:-}" = stop ]; then
    with '($stop | numbers) as $s | ($s | map(.[0]) | max) as $thick |
        row("stop angle"; $s | map(select(.[0] == $thick) | .[1])),
        (if any($s[]; .[0] == 18) then row("stop angle 18"; $s | map(select(.[0] == 18) | .[1])) else empty end)' -n --rawfile stop "$out/stop.tsv" | results
    exit
fi

# What is drawn: means over the seeds, Pouliquen's curve through the angles of rest, Bagnold's profile
with '($stop | numbers | map([.[0], .[1]]) | spread) as $m |
    ($m | map([.[0], (.[1] * 3.141592653589793 / 180 | sin / cos)])) as $points |
    # tan(theta) = a + b exp(-h / L): L by trial, a and b by least squares
    [range(1; 15; 0.1) as $L | $points | map([(-.[0] / $L | exp), .[1]]) | line + {L: $L}] | max_by(.r2) |
    "a = \(.a); b = \(.b); L = \(.L); r2 = \(.r2)", ($m[] | "# \(.[0]) \(.[1]) \(.[2] // 0)")' \
    -nr --rawfile stop "$out/stop.tsv" >"$out/fit.gp"
sed -n 's/^# //p' "$out/fit.gp" >"$out/rest.tsv"
for s in "${seeds[@]}"; do
    # n of u = u_s - b (h - z)^n, by trial; the height of the layer is where the density ends
    with '($p | numbers) as $p | ($flow | numbers | map(select(.[2] == $s)) | .[-1]) as $f |
        ([range(0.6; 2.4; 0.01) as $n | $p | map([([$f[0] - .[0], 0] | max | if . > 0 then pow(.; $n) else 0 end), .[1]]) | line + {n: $n}] | max_by(.r2)) as $best |
        ($flow | numbers | map(select(.[2] == $s)) | power) as $v |
        {s: $s, n: $best.n, ratio: (($p | map(.[1]) | max) / $f[1]), exponent: $v.b, h: $f[0], surface: ($p | map(.[1]) | max)}' \
        -nc --argjson s "$s" --rawfile p "$out/profile-$s.tsv" --rawfile flow "$out/flow.tsv"
done >"$out/bagnold.json"
jq -rs '.[0] | "h = \(.h); us = \(.surface)"' "$out/bagnold.json" >>"$out/fit.gp"
curve
picture -c speed "$out/flow-${h}-${seeds[0]}.h5"
with '($stop | numbers) as $s | ($s | map(.[0]) | max) as $thick |
    row("stop angle"; $s | map(select(.[0] == $thick) | .[1])),
    (if any($s[]; .[0] == 18) then row("stop angle 18"; $s | map(select(.[0] == 18) | .[1])) else empty end),
    row("steps that rise"; $s | group_by(.[2]) | map(sort_by(.[0]) | map(.[1]) as $a | [range(1; $a | length) | select($a[.] > $a[. - 1])] | length)),
    row("form"; $r2),
    row("exponent"; map(.exponent)),
    row("profile"; map(.n)),
    row("fastest layer"; map(.ratio))' \
    -s --rawfile stop "$out/stop.tsv" --argjson r2 "$(sed -n 's/.*r2 = //p' "$out/fit.gp")" "$out/bagnold.json" | results
