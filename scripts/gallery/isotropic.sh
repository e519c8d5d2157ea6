#!/usr/bin/env bash
# Isotropic compression: the number of contacts that a packing stands on, with and without friction.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

read -ra mus <<<"$(pick '0 0.3' '0 0.01 0.1 0.3 1')"
count=$(pick 80 400) end=$(pick 30 40)

compress() # NAME DIM MU SEED: NAME.h5
{
    # where grains hardly slide rest takes longer
    local until=$end
    [ "$3" != 1 ] || until=$((2 * end))
    scene isotropic --argjson mu "$3" --argjson n "$count" --argjson dim "$2" --argjson seed "$4" '.dim = $dim | .mu = $mu | .seed = $seed |
        (if $dim == 2 then .density = 1.257 | .gravity = [0, 0] else .bodies[0].radius = 0.5 end) |
        (if $dim == 2 then $n * 1.45 | sqrt else $n * 1.46 | log / 3 | exp end) as $L |
        # with friction the solid fraction falls with the time step: a quarter of that without
        .cell.lengths = ([range($dim)] | map($L)) | (if $mu > 0 then .dt /= 4 else . end) |
        .bodies[0].random.count = $n | del(.bodies[0].box)' |
        nsd-gen - | step "$1.h5" --overlap-rule gap --until "$until" --every "${until}s" --contacts
}
# Without friction: slow rearrangements go on for a while. Then the last oscillations are solved to 1e-6 from the last reactions,
# until the pressure has been that of the load within 1e-6 for 5 s; overlaps are projected out, because a contact with an overlap
# may push where an exact packing has a gap.
settle() # NAME: NAME-settled.h5
{
    local k rest=$((end + 120)) from=$1-rest
    step "$from.h5" --overlap-rule gap --dt 0.05 --until "$rest" --every "${rest}s" --contacts "$out/$1.h5"
    for k in {1..8}; do
        step "$1-rest-$k.h5" --warm --tolerance 1e-6 --overlap-rule project --dt 0.05 --until $((rest + 10 * k)) --every 1s --contacts "$out/$from.h5"
        from=$1-rest-$k
        nsd-stat -m stress "$out/$from.h5" | jq -es '.[-5:] | all(.[]; (.stress.p - 1 | fabs) < 1e-6)' >/dev/null && break
    done
    mv "$out/$from.h5" "$out/$1-settled.h5"
}
measure() # NAME DIM MU: mu, Z, phi, the pressure, contacts - d N over N. N: grains that bear
{
    if by reference; then
        # the contacts of the last frame are found by nsd-detect; forces and their mean by the code itself
        nsd-cat --last "$out/$1.h5" | nsd-detect | nsd-stat -m fraction,coordination | jq -c --slurpfile rows "$out/$1.h5.rows" '.stress = $rows[-1].stress'
    else
        nsd-stat -l -m fraction,coordination,stress "$out/$1.h5"
    fi |
        jq -r --argjson mu "$3" --argjson dim "$2" '(.coordination.bodies - .coordination.rattlers) as $n |
            [$mu, .coordination.z_without_rattlers, .fraction.fraction, .stress.p,
            (.coordination.z_without_rattlers * $n / 2 | round) / $n - $dim] | @tsv'
}

touch "$out/discs.tsv" "$out/balls.tsv"
for seed in "${seeds[@]}"; do
    if part rigid && by nsd; then
        compress "discs-$seed" 2 0 "$seed"
        settle "discs-$seed"
        measure "discs-$seed-settled" 2 0 >>"$out/discs.tsv"
    fi
    for mu in "${mus[@]}"; do
        part "$([ "$mu" = 0 ] && echo rigid || echo friction)" || continue
        # what is isostatic is a theorem; the independent code has springs, and its contacts are more
        [ "$mu" != 0 ] || by nsd || continue
        compress "balls-$mu-$seed" 3 "$mu" "$seed"
        if [ "$mu" = 0 ]; then
            settle "balls-0-$seed"
            measure "balls-0-$seed-settled" 3 0
        else
            measure "balls-$mu-$seed" 3 "$mu"
        fi >>"$out/balls.tsv"
    done
done
# mu, Z, its error, phi, its error
with 'numbers | (map([.[0], .[1]]) | spread) as $z | (map([.[0], .[2]]) | spread) as $phi |
    range($z | length) as $i | [$z[$i][0], $z[$i][1], $z[$i][2] // 0, $phi[$i][1], $phi[$i][2] // 0] | @tsv' -rRs "$out/balls.tsv" >"$out/means.tsv"
if [ -z "${PART:-}" ]; then
    curve
    by reference || picture --network "$out/discs-${seeds[0]}-settled.h5"
fi
with '($discs | numbers) as $discs | ($balls | numbers) as $balls | def at($mu; $k): map(select(.[0] == $mu)[$k]);
    def found($key; values): values as $v | if $v == [] then empty else row($key; $v) end;
    found("discs surplus"; $discs | map(.[4])),
    found("balls surplus"; $balls | at(0; 4)),
    found("discs phi"; $discs | map(.[2])),
    found("balls phi"; $balls | at(0; 2)),
    found("phi 0.3"; $balls | at(0.3; 2)),
    found("Z 0.3"; $balls | at(0.3; 1)),
    found("phi 1"; $balls | at(1; 2)),
    found("Z 1"; $balls | at(1; 1)),
    row("pressure"; ($discs + $balls) | map(.[3]) | mean)' \
    -n --rawfile discs "$out/discs.tsv" --rawfile balls "$out/balls.tsv" | results
