#!/usr/bin/env bash
# The experiments of docs/breakage: breakage.sh FOLDER puts their tables there, NAME.tsv, and pictures of them. FULL=1: the mill
# turns for 20 s, not 2. EXPERIMENTS='plates grain weibull mill': some of them; pictures are drawn of all.
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

# Pictures of such a grain before, 1 ms and 30 ms after it breaks: a plate of 20 g, of which the force ends then
grain() {
    local document step
    document=$(mktemp)
    jq -n '{ dt: 1e-4, gravity: [0, 0, -9.81], density: 2600, seed: 1, mu: 0.4,
        materials: { grain: { breaks: { by: "force", strength: 1e6, smallest: 3.5e-3 } } },
        bodies: [{ x: [0, 0, 2e-3], radius: 2e-3, material: "grain" }],
        walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }, { point: [0, 0, 4e-3], normal: [0, 0, -1],
            load: { along: [0, 0, -1], mass: 0.02, force: { table: [[0, 0], [0.05, 16.02], [0.0502, 0.2], [1, 0.2]] } } }] }' |
        nsd-gen - | step -n 800 --every 10 >"$document"
    for step in 500 510 800; do
        nsd-view -s $step -c generation --bare --camera 30,10 --size 480x360 -o "$folder/grain-$step.png" "$document" 2>/dev/null
    done
    rm "$document"
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

for experiment in ${EXPERIMENTS-plates grain weibull mill}; do
    $experiment >"$folder/$experiment.tsv"
done
gnuplot -e "folder = '$folder'" "$here/breakage.gp"
rm -f "$folder"/grain{.tsv,-500.png,-510.png,-800.png}
