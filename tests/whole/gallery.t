#!/usr/bin/env bash
# make gallery QUICK=1: every experiment is made, has its pictures and its table, and what holds of so few grains holds.
# shellcheck source=tests/support/tap.sh
. tests/support/tap.sh

out=$tmp/gallery
ok "the gallery is made" make -f scripts/gallery.mk -j2 QUICK=1 OUT="$out"

found() { jq -r --arg what "$2" '.rows[] | select(.what | startswith($what)) | .found' "$out/$1/result.json"; }
# E, the beginning of a row, and the range of what has been seen with other seeds
within()
{
    like "$1: $2 is within $3 to $4" "$(jq --argjson x "$(found "$1" "$2")" -n "\$x >= $3 and \$x <= $4")" true
}

for e in drum silo plane-shear triaxial collapse incline vibrated isotropic repose wet-column wet-drum; do
    like "$e: all that its table compares was found" "$(jq '(.rows | length > 2) and all(.rows[]; .found != null)' "$out/$e/result.json")" true
    for png in picture curve; do
        like "$e: $png.png is a picture" "$(head -c 8 "$out/$e/$png.png" | od -An -c | tr -d ' ')" '^211PNG'
    done
    like "$e is on the page" "$(cat "$out/README.md")" "\($e/curve\.png\)"
done
within drum "velocity in the layer" 0.9 1
within drum "angle at the lowest speed" 18 30
within silo "flow of a hopper" 1 2
within plane-shear "mu at I = 0" 0.2 0.35
within plane-shear "phi at I = 0" 0.79 0.83
within plane-shear "pressure over that of the load" 0.95 1.05
within triaxial "discs, mu 0.5: sin" 0.2 0.38
within triaxial "its peak" 1.05 3
within triaxial "critical solid fraction" -0.02 0.02
within collapse "run-out at a = 1" 1 3.2
within incline "thicker layers" 0 0
within vibrated "part of the time off the floor" 0 0
within vibrated "part of a period in flight" 0 0.06
within vibrated "mean force" 0.98 1.02
within isotropic "Z of discs" 3.8 4.1
within isotropic "Z of balls" 5.4 6.1
within isotropic "Z at the largest friction" 3.6 5.4
within repose "slope at the largest rolling friction" 4 60
within repose "height at the largest Bond number" 0.6 1.1
within wet-column "run-out of the most cohesive" -0.1 0.35
within wet-column "height left of the most cohesive" 0.9 1.02
within wet-drum "largest angle less that" 2 45
within wet-drum "roughness of the surface" 1.15 30
done_testing
