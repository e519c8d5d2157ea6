#!/usr/bin/env bash
# Pentagons and discs in simple shear, without friction against the inertial number, and with friction.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

# from fast to slow: every run goes on from the end of the one before; the last one is repeated with friction
read -ra rates <<<"$(pick '0.1 0.02' '0.1 0.05 0.02 0.01 0.005 0.002')"
slow=$(pick 0.1 0.01) count=$(pick 60 200)

# shear SHAPE SEED MU RATE BEFORE: SHAPE-MU-RATE-SEED.h5, from BEFORE.h5 if that is not empty
shear()
{
    local name=$1-$3-$4-$2 begin end
    # a strain of 0.3 to settle (3 at first, 0.5 after friction is switched on), one of 1 (3) is measured
    read -r begin end < <(jq -nr --argjson I "$4" --argjson mu "$3" --arg before "$5" \
        '(if $before == "" then [3, 6] elif $mu > 0 then [0.5, 1.5] else [0.3, 1.3] end) | map(. / $I) | @tsv')
    if [ -z "$5" ]; then
        scene polygons --arg shape "$1" --argjson I "$4" --argjson n "$count" --argjson seed "$2" '.seed = $seed | .cell.gradient[0][1] = $I |
            (.cell.lengths[0] * ($n / .bodies[0].random.count | sqrt)) as $L | .cell.lengths = [$L, $L] | .bodies[0].random.count = $n |
            if $shape == "discs" then .density = 1.2565 | del(.shapes) | .bodies[0] |= del(.shape, .orientation) else . end'
    else
        nsd-info --scene "$out/$5.h5" | jq --argjson I "$4" --argjson mu "$3" '.time = 0 | .mu = $mu | .cell.gradient[0][1] = $I'
    fi >"$out/scene.json"
    nsd-gen "$out/scene.json" | step "$name.h5" --until "$end" --every "$(jq -n "$end / 200")s" --contacts
    # I, shear stress over pressure, phi, the pressure, seed
    stresses "$name.h5" |
        jq -rs --argjson begin "$begin" --argjson I "$4" --argjson seed "$2" 'def mean: add / length; map(select(.time > $begin)) |
            (map(.stress.tensor[1][1]) | mean) as $p | [$I, (map(-.stress.tensor[0][1]) | mean) / $p,
            (map(.fraction.fraction) | mean), $p, $seed] | @tsv' >>"$out/$1-$3.tsv"
}

for seed in "${seeds[@]}"; do
    for shape in pentagons discs; do
        before=
        for rate in "${rates[@]}"; do
            shear "$shape" "$seed" 0 "$rate" "$before"
            before=$shape-0-$rate-$seed
        done
        shear "$shape" "$seed" 0.4 "$slow" "$shape-0-$slow-$seed"
    done
    # pentagons that are only pressed together: their random close packing
    scene polygons --argjson n "$count" --argjson seed "$seed" '.seed = $seed | .cell.stress = {pressure: 1, mass: 10} | del(.cell.gradient) |
        (.cell.lengths[0] * ($n / .bodies[0].random.count | sqrt)) as $L | .cell.lengths = [$L, $L] | .bodies[0].random.count = $n' |
        nsd-gen - | step "pressed-$seed.h5" --until 60 --every 60s --contacts
    nsd-stat -l -m fraction "$out/pressed-$seed.h5" | jq .fraction.fraction >>"$out/pressed.json"
done
for shape in pentagons discs; do
    with 'numbers | (map([.[0], .[1]]) | spread) as $mu | (map([.[0], .[2]]) | spread) as $phi |
        range($mu | length) as $i | [$mu[$i][0], $mu[$i][1], $mu[$i][2] // 0, $phi[$i][1], $phi[$i][2] // 0] | @tsv' \
        -rRs "$out/$shape-0.tsv" >"$out/$shape.tsv"
    # the quasistatic limits, of mu = mu_c + a I^0.38 and phi = phi_c - b I^0.38 of each seed
    with 'numbers | group_by(.[4]) | map({mu: (map([pow(.[0]; 0.38), .[1]]) | line), phi: (map([pow(.[0]; 0.38), .[2]]) | line), p: (map(.[3]) | mean)})' \
        -Rs "$out/$shape-0.tsv" >"$out/$shape.json"
    jq -r --arg shape "$shape" 'def mean: add / length; [(map(.mu.a) | mean), (map(.mu.b) | mean), (map(.phi.a) | mean), (map(.phi.b) | mean)] |
        "mu_\($shape)(x) = \(.[0]) + \(.[1]) * x**0.38; phi_\($shape)(x) = \(.[2]) + \(.[3]) * x**0.38"' "$out/$shape.json" >>"$out/fit.gp"
done
jq -s 'add / length' "$out/pressed.json" | sed 's/^/pressed = /' >>"$out/fit.gp"
curve
picture --network "$out/pentagons-0.4-$slow-${seeds[0]}.h5"
with '($discs04 | numbers) as $d | ($pentagons04 | numbers) as $p |
    # at the slowest rate: a limit would depend on the exponent of its line
    ($pentagons0 | numbers | group_by(.[4]) | map(min_by(.[0]))) as $slow |
    row("mu"; $slow | map(.[1])),
    row("dilatancy"; [$slow, $pressed] | transpose | map(.[0][2] - .[1])),
    row("strength"; [$p, $d] | transpose | map(.[0][1] / .[1][1])),
    row("pressure"; $pentagons[0] | map(.p))' \
    -n --slurpfile pentagons "$out/pentagons.json" --slurpfile pressed "$out/pressed.json" \
    --rawfile pentagons0 "$out/pentagons-0.tsv" --rawfile pentagons04 "$out/pentagons-0.4.tsv" --rawfile discs04 "$out/discs-0.4.tsv" | results
