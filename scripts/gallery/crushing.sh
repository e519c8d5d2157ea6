#!/usr/bin/env bash
# Grains that break under a lid whose stress rises by a decade in 0.53 s, from 100 Pa: discs in the plane, balls in space.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

# crush SEED NAME COUNT UNTIL: NAME-SEED.h5 of COUNT grains until this time (s), discs or, of another NAME, balls; rows of NAME.tsv: seed, stress on the lid (Pa), voids ratio, fraction of
# the grains that have broken, grains, fractal dimension, fraction of the mass in fragments and dust; and its grading in the last frame,
# NAME-sizes.tsv: seed, size (mm), grains that are not smaller
crush()
{
    local mass start=$out/$2-$1-start.h5
    jq -n --arg name "$2" --argjson n "$3" --argjson seed "$1" --argjson until "$4" --argjson high "$(pick 1.7 1.15)" '
        (if $name == "discs" then 2 else 3 end) as $dim | ($n / 1000 | log / $dim | exp) as $part |
        (if $dim == 2 then 0.06 else 0.02 end * $part) as $L | (if $dim == 2 then 1.14 else $high end * $L) as $H |
        def along($k; $x): [range($dim)] | map(if . == $k then $x else 0 end);
        def plate($k; $x; $n): {point: along($k; $x), normal: along($k; $n), material: "plate"};
        # a step is long against the time in which grains fall into a gap: then forces are those of equilibrium
        {dim: $dim, dt: 0.01, gravity: along(0; 0), density: 2600, seed: $seed, mu: 0.4, e_n: 0,
            materials: {sand: {breaks: {by: "shear", strength: 1000, size: 2e-3, modulus: 3, pieces: 4,
                smallest: (if $dim == 2 then 2.5e-4 else 5e-4 end)}}, plate: {}},
            pairs: [{pair: ["sand", "plate"], mu: 0}],
            bodies: [{random: {count: $n}, radius: {uniform: [0.9e-3, 1.1e-3]}, material: "sand",
                box: ({x: [0, $L], y: [0, $L], z: [0, $H]} | if $dim == 2 then .y = .z | del(.z) else . end)}],
            walls: ([range($dim - 1) | plate(.; 0; 1), plate(.; $L; -1)] + [plate($dim - 1; 0; 1), plate($dim - 1; $H + 1e-4; -1) + {name: "lid",
                load: {along: along($dim - 1; -1), mass: (if $dim == 2 then 0.05 else 2.4e-5 end * pow($part; $dim - 1)),
                    force: {table: [range(100 * $until + 20) | [. / 100, 100 * pow($L; $dim - 1) * pow(10; . / 53)]]}}}])}' >"$out/$2-$1.json"
    nsd-gen "$out/$2-$1.json" >"$start"
    mass=$(nsd-info -p "$start" | jq -s 'map(.mass // 0) | add')
    step "$2-$1.h5" --until "$4" --every 0.05s "$start"
    { nsd-info -w --only lid "$out/$2-$1.h5" && nsd-stat -m breakage "$out/$2-$1.h5"; } |
        jq -rs --argjson seed "$1" --argjson mass "$mass" --slurpfile scene "$out/$2-$1.json" 'map(select(.wall)) as $lid | map(select(.breakage)) as $grains |
            $scene[0].bodies[0].box.x[1] as $L | pow($L; $scene[0].dim - 1) as $A | range($lid | length) | $lid[.] as $l | $grains[.].breakage as $b |
            [$seed, $l.load.force / $A, $A * $l.point[$scene[0].dim - 1] / (($mass - $b.dust) / 2600) - 1, $b.broken, $b.bodies, $b.dimension, $b.fragments] |
            map(. * 1e4 | round / 1e4) | @tsv' >>"$out/$2.tsv"
    nsd-stat -m grading "$out/$2-$1.h5" | tail -n 1 |
        jq -r --argjson seed "$1" '.grading | range(.size | length) as $i | [$seed, 1e3 * .size[$i], .larger[$i]] | @tsv' >>"$out/$2-sizes.tsv"
}

for seed in "${seeds[@]}"; do
    ! part discs || crush "$seed" discs "$(pick 100 1000)" 0.45
    ! part few || crush "$seed" few "$(pick 60 125)" "$(pick 0.1 0.4)"
done
# from there on a step takes minutes
! part balls || [ -n "${QUICK:-}" ] || crush "${seeds[0]}" balls 1000 0.35
touch "$out"/{discs,few,balls}{,-sizes}.tsv
for kind in balls few; do
    [ ! -f "$out/$kind-${seeds[0]}.h5" ] || { picture -c generation --bare "$out/$kind-${seeds[0]}.h5" && break; }
done
[ -n "${PART:-}" ] || curve
# the slope of the voids ratio is that from 250 Pa on, where grains break
with 'def last($k): map(last[$k]); def found($rows; $name): ($rows | numbers | group_by(.[0])) as $runs | if $runs == [] then empty else
        row($name + " broken"; $runs | last(3)), row($name + " dimension"; $runs | last(5)),
        ($runs | map(map(select(.[1] > 250)) | select(length > 1) | map([.[1], .[2]] | .[0] |= log10) | -line.b) |
            if . == [] then empty else row($name + " slope"; .) end) end;
    found($discs; "discs"), found($few; "few"), found($balls; "balls")' -n --rawfile discs "$out/discs.tsv" --rawfile few "$out/few.tsv" --rawfile balls "$out/balls.tsv" | results
