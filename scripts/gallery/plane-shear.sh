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
    row("mu at I = 0, of mu = a + b I"; $mu.a; 0.2; 0.35; "0.25"; "da Cruz et al. 2005, fig. 10"),
    row("its slope b"; $mu.b; 0.7; 1.5; "1.1"; "the same"),
    row("phi at I = 0, of phi = a - b I"; $phi.a; 0.79; 0.83; "0.81"; "the same, fig. 6"),
    row("its slope b"; -$phi.b; 0.15; 0.45; "0.3"; "the same"),
    row("pressure over that of the load"; (map(.[3]) | mean); 0.95; 1.05; "1"; "momentum")' \
    -nR <(tail -n +2 "$out/shear.tsv") | results
