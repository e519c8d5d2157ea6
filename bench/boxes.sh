#!/bin/bash
# boxes.sh [STEPS]: the same heap of 1000 bricks by nsd and by Bullet (Debian's libbullet-dev; without it that half
# is left out), one thread each, STEPS [4000] of 1 ms. A table on standard output and in bench/results/MACHINE:
#
#   ms a step   of CPU, in the last tenth of the steps, when the heap is at rest
#   overlap     mm, the largest and the mean of the contacts that overlap, by nsd-detect for either
#   energy      kinetic, of m g d of a brick; height: of the heap's centre, mm, what has sunk is lower
#   residual    max |r - proj(r - m u^, K)| / (m g dt) over the contacts of the last step, from the engine's own reactions
#               and the velocities that it leaves; m the mean mass, u^ = u + mu |u_t| n, K Coulomb's cone
set -euo pipefail
cd "$(dirname "$0")/.."
source bench/common.sh
steps=${1:-4000} dt=1e-3 mu=0.5 density=2500
late=$((steps / 10))

jq -n --argjson dt $dt --argjson mu $mu --argjson density $density '{ dt: $dt, mu: $mu, density: $density,
    shapes: { brick: { box: [0.08, 0.06, 0.04] } },
    walls: [{ box: { x: [0, 1], y: [0, 1], z: [0, null] } }],
    bodies: [{ count: 1000, shape: "brick", orientation: "random" }] }' > "$work/scene.json"
nsd-gen "$work/scene.json" > "$work/start.h5"

# what nsd sees of a heap, from the document in $1: overlaps (mm), energy and height
judge()
{
    nsd-detect "$1" > "$work/seen.h5"
    nsd-info --last -c "$work/seen.h5" |
        jq -rs 'map(.gap) | map(select(. < 0)) | [-(min // 0) * 1e3, -((add // 0) / (length | if . == 0 then 1 else . end)) * 1e3] | map(. * 1e4 | round / 1e4) | @tsv'
}
row() { printf '%s\t%s\t%s\t%s\t%s\t%s\n' "$@"; } # name ms overlaps energy height residual
mgd=$(nsd-info -b "$work/start.h5" | jq -s 'map(.mass * 9.81 * 2 * .radius) | add / length')
height() { jq -s 'map(.position[2]) | add / length * 1e3' <(nsd-info --last -b "$1"); }

nsd_half() # EPS
{
    nsd-step -j 1 -n $((steps - late)) --every "$steps" --criterion natural --warm --tolerance "$1" "$work/start.h5" 2> /dev/null | nsd-cat --last > "$work/rests.h5"
    TIMEFORMAT='%U'
    local seconds natural
    { time nsd-step -j 1 -n "$late" --every "$late" --contacts --criterion natural --warm --tolerance "$1" "$work/rests.h5" 2> /dev/null > "$work/end.h5"; } 2> "$work/time"
    seconds=$(cat "$work/time")
    nsd-info --last -b "$work/end.h5" | jq -s 'map({x: .position, v: .velocity, w: .angular_velocity})' > "$work/moving"
    natural=$(nsd-info --last -c "$work/end.h5" | jq -s --argjson dt $dt --slurpfile bodies "$work/moving" \
        --argjson m "$(nsd-info -b "$work/start.h5" | jq -s 'map(.mass) | add / length')" '
        def norm: map(. * .) | add | sqrt;
        def dot($a; $b): [$a, $b] | transpose | map(.[0] * .[1]) | add;
        def at($i; $x): if $i < 0 then [0, 0, 0] else $bodies[0][$i] as $b | [range(3) | $x[.] - $b.x[.]] as $d | $b.w as $w |
            [$b.v[0] + $w[1] * $d[2] - $w[2] * $d[1], $b.v[1] + $w[2] * $d[0] - $w[0] * $d[2], $b.v[2] + $w[0] * $d[1] - $w[1] * $d[0]] end;
        map(.mu as $mu | .r as $r | at(.body[0]; .point) as $va | at(.body[1]; .point) as $vb | [range(3) | $vb[.] - $va[.]] as $v |
            [dot(.n; $v), dot(.t1; $v), dot(.t2; $v)] as $u | ($u[1:] | norm) as $ut |
            [$r[0] - $m * ($u[0] + $mu * $ut), $r[1] - $m * $u[1], $r[2] - $m * $u[2]] as $tau | ($tau[1:] | norm) as $t |
            (if $mu * $t <= -$tau[0] then [0, 0, 0] elif $t <= $mu * $tau[0] then $tau
             else (($tau[0] + $mu * $t) / (1 + $mu * $mu)) as $p | [$p, $mu * $p * $tau[1] / $t, $mu * $p * $tau[2] / $t] end) as $p |
            [$r[0] - $p[0], $r[1] - $p[1], $r[2] - $p[2]] | norm) | max / ($m * 9.81 * $dt)')
    row "nsd, natural map to $1" "$(jq -n "$seconds / $late * 1e3")" "$(judge "$work/end.h5")" \
        "$(nsd-info --last "$work/end.h5" | jq ".kinetic_energy / $mgd")" "$(height "$work/end.h5")" "$natural"
}

bullet_half() # ITERATIONS
{
    {
        echo "0.04 0.03 0.02 $density"
        nsd-info -b "$work/start.h5" | jq -r '[.position[], .orientation[], 1] | @tsv'
    } | "$work/boxes" "$steps" $dt $mu "$1" > "$work/bullet"
    # its bricks as a scene, for the same eyes
    awk 'NR > 1 { s = sqrt($5 ^ 2 + $6 ^ 2 + $7 ^ 2); a = s > 0 ? 2 * atan2(s, $4) / s : 0
            printf("%s{\"shape\": \"brick\", \"x\": [%s, %s, %s], \"orientation\": [%.17g, %.17g, %.17g]}", NR == 2 ? "[" : ", ", $1, $2, $3, a * $5, a * $6, a * $7) }
        END { print "]" }' "$work/bullet" > "$work/bodies"
    jq --slurpfile b "$work/bodies" '.bodies = $b[0] | .allow_overlap = true' "$work/scene.json" | nsd-gen - > "$work/bullet.h5"
    read -r seconds energy residual < "$work/bullet"
    row "Bullet, $1 iterations" "$(jq -n "$seconds * 1e3")" "$(judge "$work/bullet.h5")" \
        "$(jq -n "$energy / $mgd")" "$(height "$work/bullet.h5")" "$residual"
}

bullet=
read -ra compile <<< "$(pkg-config --cflags bullet-float64 2> /dev/null || true)"
read -ra link <<< "$(pkg-config --libs bullet-float64 2> /dev/null || true)"
if [ ${#link[@]} -gt 0 ] && "${CXX:-g++}" -O2 "${compile[@]}" bench/boxes.cpp -o "$work/boxes" "${link[@]}"; then
    bullet=yes
else
    echo "boxes.sh: no libbullet-dev, its half is left out" >&2
fi
{
    echo "# $(machine)"
    printf 'engine\tms a step\tlargest overlap, mm\tmean, mm\tenergy / m g d\theight, mm\tresidual\n'
    for eps in ${EPS:-1e-4 1e-8}; do nsd_half "$eps"; done
    if [ "$bullet" ]; then for n in ${ITERATIONS:-10 100 1000}; do bullet_half "$n"; done; fi
} > "$work/table"
mkdir -p "$results"
awk -F'\t' -v OFS='\t' '/^#/ || !n++ { print; next } { for (k = 2; k <= NF; k++) $k = sprintf("%.3g", $k); print }' \
    "$work/table" > "$results/boxes.tsv"
{
    head -n 1 "$results/boxes.tsv" | sed 's/^# //'
    echo
    markdown < "$results/boxes.tsv"
} | tee "$results/boxes.md"
