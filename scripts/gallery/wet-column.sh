#!/usr/bin/env bash
# Columns of discs that hold together: how far they run out, by their cohesion.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

width=$(pick 0.08 0.15) ratio=1.5
read -ra bonds <<<"$(pick '0 10 200' '0 3 10 30 100 300')"
weight=$(jq -n '2500 * 3.141592653589793 * 25e-6 * 9.81')

echo "bond runout height" >"$out/runout.tsv"
for b in "${bonds[@]}"; do
    scene collapse --argjson w "$width" --argjson a "$ratio" --argjson f "$(jq -n "$b * $weight")" '
        .walls[2] = {segment: [[$w, 0], [$w, 20]], until: 0.5} | .pairs = [{pair: ["ball", "wall"], cohesion: {force: 0}}] |
        (if $f > 0 then .cohesion = {force: $f, range: 5e-5} else . end) |
        .bodies[0] |= (.count = ($w * $w * $a * 0.83 / 7.96e-5 | round) | .box.x = [0, $w])' |
        nsd-gen - | step "column-$b.h5" --until 0.5 --every 1s
    nsd-step --until 1.5 --every 0.05s --overlap project -o "$out/run-$b.h5" "$out/column-$b.h5" 2>"$out/run.log"
    # as of dry columns: what touches on is part of the heap
    { nsd-info --last -p "$out/column-$b.h5"; nsd-info --last -p "$out/run-$b.h5"; } |
        with 'map([.step, .x[0], .x[1], .radius]) | group_by(.[0]) |
            (map(map(.[2] + .[3]) | max)) as $top |
            (.[1] | map(.[1] + .[3]) | front) as $front |
            [($front - $w) / $w, $top[1] / $top[0]] | "\($b) \(.[0]) \(.[1])"' -rs --argjson w "$width" --arg b "$b" >>"$out/runout.tsv"
done
curve
picture "$out/run-${bonds[$((${#bonds[@]} / 2))]}.h5"
with '($runs | numbers) as $r |
    row("dry"; $r[0][1]),
    row("run-out"; $r[-1][1] / $r[0][1]),
    row("steps that rise"; ([range(1; $r | length) | select($r[.][1] > $r[. - 1][1] + 0.1 * $r[0][1])] | length)),
    row("height"; $r[-1][2]),
    row("dry height"; $r[0][2])' -n --rawfile runs "$out/runout.tsv" | results
