#!/usr/bin/env bash
# Plane shear without gravity: friction and solid fraction against the inertial number.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

width=$(pick 10 16)
# from fast to slow: every run goes on from the end of the one before
read -ra rates <<<"$(pick '0.2 0.05' '0.2 0.15 0.1 0.05 0.02 0.01 0.005')"

for seed in "${seeds[@]}"; do
    before=
    for rate in "${rates[@]}"; do
        # a strain of 0.5 to settle (3 at first), one of 2 (3) is measured
        read -r begin end < <(jq -nr --argjson I "$rate" --arg before "$before" '(if $before == "" then [3, 6] else [0.5, 2.5] end) | map(. / $I) | @tsv')
        if [ -z "$before" ]; then
            scene plane-shear --argjson I "$rate" --argjson L "$width" --argjson seed "$seed" '.seed = $seed |
                .cell.gradient[0][1] = $I | .cell.lengths = [$L, 1.8 * $L] | .bodies[0].count = ($L * $L | round) | .cell.stress.mass = $L * $L / 10'
        else
            nsd-info --scene "$out/$before" | jq --argjson I "$rate" '.time = 0 | .cell.gradient[0][1] = $I'
        fi >"$out/scene.json"
        before=shear-$rate-$seed.h5
        nsd-gen "$out/scene.json" | step "$before" --until "$end" --every "$(jq -n "$end / 250")s" --contacts
        # I, mu, phi, the pressure across the shear, seed
        stresses "$before" |
            with 'map(select(.time > $begin)) | (map(.stress.tensor[1][1]) | mean) as $p | [$I, (map(.stress.tensor[0][1]) | mean | fabs) / $p,
                (map(.fraction.fraction) | mean), $p, $seed] | @tsv' -rs --argjson begin "$begin" --argjson I "$rate" --argjson seed "$seed" >>"$out/runs.tsv"
    done
done
with 'numbers | (map([.[0], .[1]]) | spread) as $mu | (map([.[0], .[2]]) | spread) as $phi |
    range($mu | length) as $i | [$mu[$i][0], $mu[$i][1], $mu[$i][2] // 0, $phi[$i][1], $phi[$i][2] // 0] | @tsv' -rRs "$out/runs.tsv" >"$out/shear.tsv"
curve
picture --network "$out/shear-${rates[1]}-${seeds[0]}.h5"
# the lines of each seed; mu(I) is concave, and its line that of I up to 0.05
with 'numbers | group_by(.[4]) | map({mu: (map(select($quick or .[0] <= 0.05) | [.[0], .[1]]) | line), phi: (map([.[0], .[2]]) | line), p: (map(.[3]) | mean)}) |
    row("mu"; map(.mu.a)),
    row("mu slope"; map(.mu.b)),
    row("phi"; map(.phi.a)),
    row("phi slope"; map(-.phi.b)),
    row("pressure"; map(.p))' -Rs --argjson quick "$(pick true false)" "$out/runs.tsv" | results
