#!/usr/bin/env bash
# Isotropic compression: how many contacts a packing stands on, with and without friction.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

read -ra mus <<<"$(pick '0 0.5' '0 0.01 0.1 0.3 1')"
count=$(pick 80 400) end=$(pick 30 80)

compress() # FILE DIM MU
{
    scene isotropic --argjson mu "$3" --argjson n "$count" --argjson dim "$2" '.dim = $dim | .mu = $mu |
        (if $dim == 2 then .density = 1.257 | .gravity = [0, 0] else . end) |
        (if $dim == 2 then $n * 1.45 | sqrt else $n * 1.46 | log / 3 | exp end) as $L |
        .cell.lengths = ([range($dim)] | map($L)) |
        .bodies[0] |= (.random.count = $n | .box = ({x: [0, $L], y: [0, $L]} + if $dim == 3 then {z: [0, $L]} else {} end))' |
        nsd-gen - | step "$1" --overlap gap --until "$end" --every 10s --contacts
}
measure() # FILE MU: mu, Z, phi, the pressure, the part of rattlers
{
    nsd-stat -l -m fraction,coordination,stress "$out/$1" |
        jq -r --argjson mu "$2" '[$mu, .coordination.z_without_rattlers, .fraction.fraction, .stress.p,
            .coordination.rattlers / .coordination.bodies] | @tsv'
}

compress discs.h5 2 0
echo "mu z phi pressure rattlers" >"$out/discs.tsv"
measure discs.h5 0 >>"$out/discs.tsv"
echo "mu z phi pressure rattlers" >"$out/balls.tsv"
for mu in "${mus[@]}"; do
    compress "balls-$mu.h5" 3 "$mu"
    measure "balls-$mu.h5" "$mu" >>"$out/balls.tsv"
done
curve
picture --network "$out/discs.h5"
with 'def rows_of: split("\n")[1:] | map(select(. != "") | split("\t") | map(tonumber));
    ($discs | rows_of)[0] as $discs | ($balls | rows_of) as $balls |
    row("discs Z"; $discs[1]),
    row("discs phi"; $discs[2]),
    row("balls Z"; $balls[0][1]),
    row("balls phi"; $balls[0][2]),
    row("rough Z"; $balls[-1][1]),
    row("rough phi"; $balls[-1][2]),
    row("steps that rise"; ([range(1; $balls | length) | select($balls[.][1] > $balls[. - 1][1] + 0.05)] | length))' \
    -n --rawfile discs "$out/discs.tsv" --rawfile balls "$out/balls.tsv" | results
