#!/usr/bin/env bash
# Simple shear of frictionless balls: macroscopic friction and solid fraction against the inertial number.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

# from fast to slow: every run goes on from the end of the one before
read -ra rates <<<"$(pick '0.1 0.03' '0.1 0.05 0.02 0.01 0.005')"
count=$(pick 100 300)

for seed in "${seeds[@]}"; do
    before=
    for rate in "${rates[@]}"; do
        # a strain of 0.3 to settle (3 at first), one of 1 (3) is measured
        read -r begin end < <(jq -nr --argjson I "$rate" --argjson first "$([ -z "$before" ] && echo true || echo false)" \
            '(if $first then [3, 6] else [0.3, 1.3] end) | map(. / $I) | @tsv')
        if [ -z "$before" ]; then
            scene frictionless --argjson I "$rate" --argjson n "$count" --argjson seed "$seed" '.seed = $seed | .cell.gradient[0][1] = $I |
                (.cell.lengths[0] * pow($n / .bodies[0].random.count; 1 / 3)) as $L | .cell.lengths = [$L, $L, $L] | .bodies[0].random.count = $n'
        else
            nsd-info --scene "$out/$before" | jq --argjson I "$rate" '.time = 0 | .cell.gradient[0][1] = $I'
        fi >"$out/scene.json"
        before=shear-$rate-$seed.h5
        nsd-gen "$out/scene.json" | step "$before" --overlap-rule gap --until "$end" --every "$(jq -n "$end / 300")s" --contacts
        # I, mu, phi, the pressure across the shear, seed
        stresses "$before" |
            jq -rs --argjson begin "$begin" --argjson I "$rate" --argjson seed "$seed" 'def mean: add / length; map(select(.time > $begin)) |
                (map(.stress.tensor[1][1]) | mean) as $p |
                [$I, (map(-.stress.tensor[0][1]) | mean) / $p, (map(.fraction.fraction) | mean), $p, $seed] | @tsv' >>"$out/runs.tsv"
    done
done
with 'numbers | . as $all | (map([.[0], .[1]]) | spread) as $mu | (map([.[0], .[2]]) | spread) as $phi |
    range($mu | length) as $i | [$mu[$i][0], $mu[$i][1], $mu[$i][2] // 0, $phi[$i][1], $phi[$i][2] // 0] | @tsv' \
    -rR -s "$out/runs.tsv" >"$out/shear.tsv"
# the quasistatic limits, of mu = mu_c + a I^0.38 and phi = phi_c - b I^0.38 of each seed
with 'numbers | group_by(.[4]) | map({mu: (map([pow(.[0]; 0.38), .[1]]) | line), phi: (map([pow(.[0]; 0.38), .[2]]) | line), p: (map(.[3]) | mean)})' \
    -R -s "$out/runs.tsv" >"$out/limits.json"
jq -r 'def mean: add / length; [(map(.mu.a) | mean), (map(.mu.b) | mean), (map(.phi.a) | mean), (map(.phi.b) | mean)] | "fit_mu(x) = \(.[0]) + \(.[1]) * x**0.38; fit_phi(x) = \(.[2]) + \(.[3]) * x**0.38"' \
    "$out/limits.json" >"$out/fit.gp"
curve
picture --network -c speed "$out/shear-${rates[1]}-${seeds[0]}.h5"
jq '.' "$out/limits.json" | with 'row("mu"; map(.mu.a)), row("phi"; map(.phi.a)), row("pressure"; map(.p))' | results
