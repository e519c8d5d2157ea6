#!/usr/bin/env bash
# Forces of contacts with a stiffness are unique: each way to solve a packing finds each force to 1e-5 of the mean one.
# shellcheck source=tests/support/tap.sh
. tests/support/tap.sh

export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_mpi_yield_when_idle=1
export ASAN_OPTIONS=detect_leaks=0:$ASAN_OPTIONS # MPI's own
most=200000 # sweeps
[ -z "$thin" ] || most=20000

forces() { nsd-info -c "$1" | jq -c 'select(.r) | .r'; }
# FILE: the largest difference of a component from $tmp/forces, over the mean normal force
off()
{
    forces "$1" >"$tmp/other"
    jq -n --slurpfile a "$tmp/forces" --slurpfile b "$tmp/other" 'if ($a | length) != ($b | length) then 1 else
        ([$a, $b] | transpose | map(transpose | map(.[0] - .[1] | fabs) | max) | max) / ($a | map(.[0]) | add / length) end'
}
near() { awk "BEGIN { exit !($(off "$1") < 1e-5) }" || { echo "off by $(off "$1")"; return 1; }; }
# A copy of a solved document whose reactions are random, within their cones
shaken() # FROM TO
{
    tail -c +513 "$1" >"$tmp/bare.h5"
    py - "$tmp/bare.h5" "$2" <<'PYTHON'
import h5py, numpy, shutil, sys
shutil.copyfile(sys.argv[1], sys.argv[2])
with h5py.File(sys.argv[2], 'r+') as f:
    n, random = f['/contacts/reaction'].shape[0], numpy.random.default_rng(5)
    push = random.exponential(2 * f['/contacts/reaction'][:, 0].mean(), n)
    across = random.normal(size=(n, 2))
    across *= 0.3 * push[:, None] / numpy.linalg.norm(across, axis=1)[:, None]
    f['/contacts/reaction'][...] = numpy.column_stack([push, across])
PYTHON
}

# unique NAME STEPS KEYS: a packing of these keys after so many steps
unique()
{
    local name=$1 way file
    jq -n "{ dt: 1e-4, density: 2500, seed: 3, stiffness: \"auto\" } + $3" | nsd-gen - >"$tmp/start.h5"
    nsd-step -n "$2" --every "$2" "$tmp/start.h5" 2>/dev/null | nsd-cat --last >"$tmp/packing.h5"
    nsd-detect "$tmp/packing.h5" >"$tmp/found.h5"
    status 0 "$name: is solved cold" nsd-solve -e --cold --criterion natural --tolerance 3e-11 --max-sweeps $most "$tmp/found.h5"
    mv "$tmp/out" "$tmp/solved.h5"
    ok "$name: has more than 150 contacts" [ "$(forces "$tmp/solved.h5" | tee "$tmp/forces" | wc -l)" -gt 150 ]
    while read -r start way; do
        file=$tmp/found.h5
        [ "$start" != warm ] || file=$tmp/solved.h5
        if [ "$start" = random ]; then
            if ! have_h5py; then
                skip "$name: from random reactions" "no h5py"
                continue
            fi
            file=$tmp/random.h5
            [ -f "$file" ] || shaken "$tmp/solved.h5" "$file"
        fi
        # shellcheck disable=SC2086 # a way is several words
        nsd-solve $way --criterion natural --tolerance 3e-11 --max-sweeps $most "$file" >"$tmp/way.h5" 2>/dev/null
        ok "$name: $start${way:+, $way}" near "$tmp/way.h5"
    done <<'END'
warm -w --order natural
random -w
random -w -m exact --order random
cold --cold -m eal --order natural
cold --cold -m sbp --order colour
END
    rm -f "$tmp/random.h5"
}
ranks() # NAME K ...: of the last packing, in the order of blocks
{
    local name=$1 k
    shift
    for k in "$@"; do
        if [ "$k" != 1 ] && { ! command -v mpirun >/dev/null || ! command -v nsd-step-mpi >/dev/null; }; then
            skip "$name: $k processes" "there is no MPI"
            continue
        fi
        rm -f "$tmp/ranks.h5"
        local run=(timeout 300 mpirun --oversubscribe --bind-to none -n "$k")
        [ "$k" != 1 ] || run=()
        "${run[@]}" nsd-step --cold --order block -n 1 --contacts --criterion natural --tolerance 3e-11 --max-sweeps $most \
            -o "$tmp/ranks.h5" "$tmp/packing.h5" </dev/null 2>/dev/null
        ok "$name: by $k processes in the order of blocks" near "$tmp/ranks.h5"
    done
}

box='walls: [{ box: { x: [-3e-3, 3e-3], y: [-3e-3, 3e-3], z: [0, null] } }]'
place='x: [-3e-3, 3e-3], y: [-3e-3, 3e-3]'
# with mu = 1 a contact of this packing has two values with a compliance of 1e-2 of W: nsd-methods(7)
for mu in 0.3 1; do
    unique "200 balls, mu = $mu" 1500 "{ mu: $mu, stiffness: { compliance: (if $mu < 1 then 1e-2 else 3e-2 end) }, $box, bodies: [{ count: 200, radius: { uniform: [4.4e-4, 5e-4] }, box: { $place, z: [0, null] } }] }"
    ranks "200 balls, mu = $mu" 1 2 4
done
# with mu = 1 some forces of such a packing have several values: nsd-methods(7)
unique "radii of 1 and 0.1 mm, mu = 0.3" 2500 "{ mu: 0.3, stiffness: 200, $box, bodies: [{ count: 6, radius: 1e-3, box: { $place, z: [0, null] } },
    { count: 300, radius: 1e-4, box: { $place, z: [0.01, null] } }] }"
for mu in 0.3 1; do
    unique "60 stones, mu = $mu" 1500 "{ mu: $mu, walls: [{ box: { x: [-2e-3, 2e-3], y: [-2e-3, 2e-3], z: [0, null] } }],
        shapes: { stone: { points: [[0.9, 0.1, 0.2], [-0.8, 0.3, 0.1], [0.1, 1, -0.2], [-0.2, -0.9, 0.3], [0.3, -0.1, 0.8],
            [-0.1, 0.2, -0.7], [0.6, 0.7, 0.4], [-0.6, -0.5, -0.4], [0.5, -0.6, -0.5], [-0.4, 0.6, 0.5]] } },
        bodies: [{ count: 60, shape: \"stone\", orientation: \"random\", size: 5e-4, box: { x: [-2e-3, 2e-3], y: [-2e-3, 2e-3], z: [0, null] } }] }"
done
unique "a cell under stress, mu = 0.3" 600 '{ dt: 0.02, density: 1.88, mu: 0.3, gravity: [0, 0, 0],
    cell: { lengths: [6.6, 6.6, 6.6], stress: { pressure: 1, mass: 10 } },
    bodies: [{ random: { count: 150 }, radius: { uniform: [0.4, 0.6] }, box: { x: [0, 6.6], y: [0, 6.6], z: [0, 6.6] } }] }'

# ---- springs that a scene hands on ----

jq -n '{ dt: 1e-4, gravity: [0, 0, -9.81], density: 2500, mu: 0.5, stiffness: { young: 1e7 }, walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }],
    bodies: [{ x: [0, 0, 0.01], radius: 0.01 }, { x: [1e-4, 0, 0.03], radius: 0.01 }] }' | nsd-gen - | nsd-step -n 30 --every 30 -o "$tmp/springs.h5" 2>/dev/null
next() { nsd-step -n 1 --contacts 2>/dev/null | nsd-info -c | jq -c .r; }
is "springs of a stiffness by Young's modulus go on in a scene made of a document" "$(nsd-info --scene "$tmp/springs.h5" | nsd-gen - | next)" "$(next <"$tmp/springs.h5")"
done_testing
