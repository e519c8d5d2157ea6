#!/usr/bin/env bash
# Haff's law: how a dilute gas of inelastic balls cools.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

read -ra restitutions <<<"$(pick '0.8 0.95' '0.7 0.8 0.9 0.95 0.98')"
count=$(pick 500 2000) dt=$(pick 0.005 0.0025)

# The rate of kinetic theory, for balls of diameter 1 and phi = 0.05: n balls a volume, g0 by Carnahan and Starling.
# A collision takes (1 - e^2) m g_n^2/4 with <g_n^2> = 4 T, and a ball has 4 sqrt(pi T) n g0 of them in a second:
# dT/dt = -(4/3) sqrt(pi) (1 - e^2) n g0 T^(3/2), so that 1/sqrt(T) grows by (2/3) sqrt(pi) (1 - e^2) n g0 in a second.
theory() { jq -n "0.05 as \$phi | (1 - \$phi / 2) / pow(1 - \$phi; 3) * \$phi * 6 / 3.141592653589793 * (3.141592653589793 | sqrt) * 2 / 3 * (1 - $1 * $1)"; }

for e in "${restitutions[@]}"; do
    rate=$(theory "$e")
    # until the temperature is 1/9 of the first one
    end=$(jq -n "2 / $rate | [., 60] | min")
    for seed in "${seeds[@]}"; do
        scene cooling --argjson e "$e" --argjson seed "$seed" --argjson n "$count" --argjson dt "$dt" '.e_n = $e | .seed = $seed | .dt = $dt |
            (.cell.lengths[0] * pow($n / .bodies[0].random.count; 1 / 3)) as $L | .cell.lengths = [$L, $L, $L] | .bodies[0].random.count = $n' |
            nsd-gen - | step "gas-$e-$seed.h5" --until "$end" --every "$(jq -n "$end / 40")s"
        # time by the rate of theory, temperature by that which a line through 1/sqrt(T) has at time 0; the measured rate over theory's
        nsd-stat -m temperature "$out/gas-$e-$seed.h5" |
            with 'map([.time, 1 / (.temperature.temperature | sqrt)]) | line as $fit |
                {e: $e, rate: ($fit.b / $rate), exponent: -(map([1 + $rate * .[0] / $fit.a, 1 / (.[1] * .[1])]) | power.b),
                 cooling: map([.[0] * $rate / $fit.a, $fit.a * $fit.a / (.[1] * .[1])])}' \
                -s --argjson e "$e" --argjson rate "$rate" >"$out/gas-$e-$seed.json"
    done
    jq -r '.cooling[] | @tsv' "$out/gas-$e-${seeds[0]}.json" >"$out/cooling-$e.tsv"
done
cat "$out"/gas-*.json | with 'map([.e, .rate]) | spread | .[] | map(. // 0) | @tsv' -rs >"$out/rates.tsv"
curve
picture -c speed "$out/gas-${restitutions[1]}-${seeds[0]}.h5"
cat "$out"/gas-*.json | with '. as $all | (map(.e) | unique | reverse[]) as $e |
    row("rate \($e)"; $all | map(select(.e == $e).rate)),
    if $e == 0.8 then row("exponent"; $all | map(select(.e == $e).exponent)) else empty end' -s | results
