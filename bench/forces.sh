#!/bin/bash
# forces.sh [BALLS [FOLDER]]: the forces of a pile at rest, contact by contact, by nsd with a stiffness and by a code of soft
# spheres with the same springs (reference/dem.c), from the same start, at two stiffnesses. Tables on standard output,
# those of docs/forces, and pictures in FOLDER, those of the softer contacts. Two to four minutes for the default of 500 balls.
set -euo pipefail
cd "$(dirname "$0")/.."
source bench/common.sh
n=${1:-500} folder=${2:-}
mu=0.3
T=0.03 # s: to rest
half=$(awk "BEGIN { printf \"%.17g\", 0.003564814875007254 * ($n / 500) ^ (1 / 3) }")
cc -O2 -o "$work/dem" bench/reference/dem.c -lm

# a settled pile, made larger until nothing touches: it falls by the overlaps that it has had
jq -n --argjson n "$n" --argjson a "$half" --argjson mu $mu '{ dt: 1e-4, density: 2500, mu: $mu, seed: 3, stiffness: 9561,
    bodies: [{ count: $n, radius: { uniform: [4.4e-4, 5e-4] }, v: [0, 0, -0.1], box: { x: [-$a, $a], y: [-$a, $a], z: [0, null] } }],
    walls: [{ box: { x: [-$a, $a], y: [-$a, $a], z: [0, null] } }] }' | nsd-gen - |
    nsd-step -n 3000 --every 3000 2> /dev/null | nsd-cat --last > "$work/settled.h5"
larger=$(nsd-detect "$work/settled.h5" | nsd-info -c | jq -s '1 + 1.05 * ([.[] | -.gap] | max) / 4.4e-4')
echo "larger by $(jq -n "($larger - 1) * 100 * 1e4 | round / 1e4") %" >&2
half=$(jq -n "$half * $larger")
nsd-info -b "$work/settled.h5" | jq -c --argjson s "$larger" '{ x: (.position | map(. * $s)), radius }' | jq -s . > "$work/bodies.json"

# k dt NAME ARGUMENT ...: by nsd
by_nsd()
{
    local steps
    steps=$(jq -n "$T / $2 | round")
    jq -n --slurpfile b "$work/bodies.json" --argjson a "$half" --argjson k "$1" --argjson dt "$2" --argjson mu $mu '{ dt: $dt,
        density: 2500, mu: $mu, stiffness: $k, bodies: $b[0], walls: [{ box: { x: [-$a, $a], y: [-$a, $a], z: [0, null] } }] }' |
        nsd-gen - > "$work/start.h5"
    nsd-step -n "$steps" --every "$steps" --criterion natural --tolerance 1e-8 --contacts "${@:4}" "$work/start.h5" 2> "$work/said" |
        nsd-cat --last | nsd-info -c > "$work/$3,_dt_$2.json"
}
# k e: by soft spheres with this restitution
by_dem()
{
    "$work/dem" "$work/start.txt" kn="$1" kt="$(jq -n "$1 * 2 / 7")" e="$2" ew="$2" mu=$mu gamt=0.5 gz=-9.81 T=$T every=$T \
        contacts="$work/soft_spheres,_e=$2.txt" wall="-$half,0,0,1,0,0" wall="$half,0,0,-1,0,0" \
        wall="0,-$half,0,0,1,0" wall="0,$half,0,0,-1,0" wall=0,0,0,0,0,1 > /dev/null 2>&1
}

for k in 2e3 2e4; do
    by_nsd $k 1e-4 nsd,_rigid --stiffness rigid --tolerance 1e-4 --max-sweeps 500
    for dt in 1e-4 1e-5 2e-6; do by_nsd $k $dt nsd; done
    nsd-info -b "$work/start.h5" | jq -r '[.position[], .radius, .mass, 0, 0, 0, 0, 0, 0, 0] | @tsv' > "$work/start.txt"
    for e in 0.1 0.5; do by_dem $k $e; done
    echo
    echo "k_n = $k N/m, k_t = 2/7 k_n, compared with soft spheres with e = 0.1:"
    echo
    echo "| | contacts | in both | correlation of F_n | of F_t | explained of F_n | of F_t | rms of F_n, means |"
    echo "| --- | --- | --- | --- | --- | --- | --- | --- |"
    /usr/bin/python3 bench/forces.py "$work/soft_spheres,_e=0.1.txt" "$work"/soft_spheres,_e=0.5.txt \
        "$work"/nsd,_rigid,_dt_1e-4.json "$work"/nsd,_dt_1e-4.json "$work"/nsd,_dt_1e-5.json "$work"/nsd,_dt_2e-6.json
    [ -z "$folder" ] || [ $k != 2e3 ] || /usr/bin/python3 bench/forces.py --draw "$folder" "$work/bodies.json" "$work/soft_spheres,_e=0.1.txt" \
        "$work/soft_spheres,_e=0.5.txt" "$work/nsd,_rigid,_dt_1e-4.json" "$work/nsd,_dt_1e-5.json"
done
