#!/usr/bin/env bash
# The experiments of docs/breakage: breakage.sh FOLDER puts their tables there, NAME.tsv, and pictures of them. FULL=1: the mill
# turns for 20 s, not 2. EXPERIMENTS='plates weibull mill oedometer': some of them; pictures are drawn of all.
set -euo pipefail
folder=$1 full=${FULL-}
here=$(cd "$(dirname "$0")" && pwd)
step() { nsd-step "$@" 2>/dev/null; }

# One grain of 4 mm between plates, the upper one pressed by a force that rises by 320 N/s; its strength is 1 MPa, 16 N.
# The force when it breaks, N, for four seeds, without scatter and with a modulus of 3, and the strength of that seed
plates() {
    local modulus seed
    for modulus in '' ', "modulus": 3'; do
        for seed in 1 2 3 4; do
            jq -n --argjson seed $seed '{ dt: 1e-4, gravity: [0, 0, 0], density: 2600, seed: $seed, mu: 0.4,
                materials: { grain: { breaks: { by: "force", strength: 1e6, smallest: 3e-3 '"$modulus"' } } },
                bodies: [{ x: [0, 0, 2e-3], radius: 2e-3, material: "grain" }],
                walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }, { point: [0, 0, 4e-3], normal: [0, 0, -1],
                          load: { along: [0, 0, -1], mass: 1e-4, force: { table: [[0, 0], [0.2, 64]] } } }] }' |
                nsd-gen - | step --small-steps 0 -n 2000 --every 1 | nsd-stat -m breakage |
                jq -r 'select(.breakage.broken > 0).time * 320' | head -n 1
        done | tr '\n' '\t' || true
        echo
    done
}

# 1000 grains of 2 mm, each pressed to the floor by a force that rises: the fraction that has broken over the force, N, and the
# Weibull distribution put in: strength 1 MPa, 4 N, modulus 3
weibull() {
    jq -n '{ dt: 1e-3, gravity: [0, 0, 0], density: 2600, seed: 8,
        materials: { grain: { breaks: { by: "force", strength: 1e6, size: 2e-3, modulus: 3, smallest: 1e-3, into: "balls", dust: 1 } } },
        bodies: [{ count: 1000, radius: 1e-3, material: "grain", jitter: 0, box: { x: [0, 0.1], y: [0, 0.1], z: [0, 2.1e-3] } }],
        forces: [{ bodies: [range(1000)], along: [0, 0, -1], force: { table: [[0, 0], [1, 8]] } }],
        walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }] }' | nsd-gen - |
        step --small-steps 0 --until 0.9 --every 0.02s | nsd-stat -m breakage |
        jq -r '[(.time - 1e-3) * 8, .breakage.broken // 1] | @tsv' |
        awk '{ F = $1 > 0 ? 1 - exp(-($1 / 4) ^ 3) : 0; d = $2 - F; d = d < 0 ? -d : d; D = d > D ? d : D
               printf "%.3f\t%.3f\t%.3f\n", $1, $2, F } END { printf "# Kolmogorov, Smirnov: %.4f, 0.0515 at 1 %%\n", D }'
}

# cookbook/ball-mill: time (s), d10, d50, d90 (mm), fraction of the grains that have broken, grains, dust (g)
mill() {
    local until=2
    [ -z "$full" ] || until=20
    nsd-gen "$here/../../cookbook/ball-mill/scene.json" | step --small-steps 0 --until $until --every 0.1s |
        nsd-stat --only ore -m breakage | jq -r '.breakage as $b | [.time, 1e3 * $b.d10, 1e3 * $b.d50, 1e3 * $b.d90, $b.broken, $b.bodies,
            1e3 * $b.dust] | map(. * 1e3 | round / 1e3) | @tsv'
}

# 1000 discs between frictionless plates, of which the upper one is pressed by a stress that rises from 100 Pa by a decade in
# 0.53 s: their strength is 1 kPa by shear, Weibull modulus 3, and falls with size. Two packings; a row has the seed, the stress (Pa), the voids
# ratio, the fraction of the discs that have broken, grains, d10, d50 (mm), the fractal dimension. The grading at the end:
# oedometer-grading.tsv, the seed, size (mm), grains that are not smaller.
oedometer() {
    local seed mass start document
    start=$(mktemp) document=$(mktemp)
    : >"$folder/oedometer-grading.tsv"
    for seed in 1 2; do
        jq --argjson seed $seed '.seed = $seed' "$here/oedometer.json" | nsd-gen - >"$start"
        mass=$(nsd-info -b "$start" | jq -s 'map(.mass // 0) | add')
        step --small-steps 0.02 --until 0.45 --every 0.05s "$start" >"$document"
        { nsd-info -w --only lid "$document" && nsd-stat -m breakage "$document"; } |
            jq -rs --argjson seed $seed --argjson mass "$mass" 'map(select(.wall)) as $lid | map(select(.breakage)) as $grains |
                range($lid | length) | $lid[.] as $l | $grains[.] as $g | $g.breakage as $b |
                [$seed, $l.load.force / 0.06, 0.06 * $l.point[1] / (($mass - $b.dust) / 2600) - 1, $b.broken, $b.bodies,
                    1e3 * $b.d10, 1e3 * $b.d50, $b.dimension] | map(. * 1e3 | round / 1e3) | @tsv'
        [ $seed != 1 ] || nsd-view -c generation --bare --size 480x500 -o "$folder/oedometer-packing.png" "$document" 2>/dev/null
        nsd-stat -m grading "$document" | tail -n 1 |
            jq -r --argjson seed $seed '.grading | range(.size | length) as $i | [$seed, 1e3 * .size[$i], .larger[$i]] | @tsv' \
                >>"$folder/oedometer-grading.tsv"
    done
    rm "$start" "$document"
}

for experiment in ${EXPERIMENTS-plates weibull mill oedometer}; do
    $experiment >"$folder/$experiment.tsv"
done
gnuplot -e "folder = '$folder'" "$here/breakage.gp"
