#!/usr/bin/env bash
# Plane shear without gravity: friction and solid fraction against the inertial number.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

width=$(pick 12 20)
read -ra rates <<<"$(pick '0.03 0.3' '0.01 0.03 0.06 0.1 0.2 0.3')"

# I, mu, phi, and the pressure across the shear
echo "rate mu phi pressure" >"$out/shear.tsv"
for rate in "${rates[@]}"; do
    # it comes together within a strain of 2 or 40 s, and is then measured over 2.5 or 40 s
    read -r begin end every < <(jq -nr --argjson I "$rate" '[([40, 2 / $I] | max), ([40, 2 / $I] | max) + ([40, 2.5 / $I] | max), 0.03 / $I] | @tsv')
    scene plane-shear --argjson I "$rate" --argjson L "$width" \
        '.cell.gradient[0][1] = $I | .cell.lengths = [$L, 1.8 * $L] | .bodies[0].count = ($L * $L | round) |
        .cell.stress.mass = $L * $L / 10' |
        nsd-gen - | step "shear-$rate.h5" --until "$end" --every "${every}s" --contacts
    nsd-stat -m stress,fraction "$out/shear-$rate.h5" |
        with 'map(select(.time > $begin)) | [$I, (map(.stress.tensor[0][1]) | mean | fabs) / (map(.stress.tensor[1][1]) | mean),
            (map(.fraction.fraction) | mean), (map(.stress.tensor[1][1]) | mean)] | @tsv' \
            -rs --argjson begin "$begin" --argjson I "$rate" >>"$out/shear.tsv"
done
curve
picture --network "$out/shear-${rates[-1]}.h5"
with '[inputs | split("\t") | map(tonumber)] |
    (map([.[0], .[1]]) | line) as $mu | (map([.[0], .[2]]) | line) as $phi |
    row("mu"; $mu.a),
    row("mu slope"; $mu.b),
    row("phi"; $phi.a),
    row("phi slope"; -$phi.b),
    row("pressure"; (map(.[3]) | mean))' \
    -nR <(tail -n +2 "$out/shear.tsv") | results
