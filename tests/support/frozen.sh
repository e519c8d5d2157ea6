#!/usr/bin/env bash
# frozen.sh: what 60 commands write, as checksums: "NAME SUM" per line. The redesign of lib/ is judged by them: it must
# not change a byte of documents, logs, exports and messages. Run from the top of the tree, with build/ in PATH.
#
#   tests/support/frozen.sh >tests/support/frozen.sums     keep what is written now
set -euo pipefail
export LC_ALL=C OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_mpi_yield_when_idle=1
top=$PWD
command -v nsd-gen >/dev/null || export PATH=$PWD/build:$PATH
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/scenes"
for s in scenes/*.json; do cp "$s" "$work/scenes/"; done
for c in cookbook/*/; do
    mkdir -p "$work/cookbook/$(basename "$c")"
    find "$c" -maxdepth 1 '(' -name '*.json' -o -name '*.obj' -o -name '*.data' -o -name '*.stl' ')' -exec cp -t "$work/cookbook/$(basename "$c")" {} +
done

jobs=()
frozen() # NAME COMMAND: the checksum of what COMMAND, run by bash in $work, writes to stdout and stderr
{
    jobs+=("$1"$'\t'"$2")
}

# Each scene: its packing, some steps with contacts and sums, its log without seconds, and what is said of it
for s in "$top"/scenes/*.json; do
    n=$(basename "$s" .json)
    frozen "scene-$n" "nsd-gen scenes/$n.json >$n.h5; cat $n.h5; nsd-step -n 6 --every 2 --contacts \$(sums scenes/$n.json) --log $n.log $n.h5 -o $n-out.h5;
        cat $n-out.h5; jq -c 'del(.detection, .elapsed, .seconds)' $n.log; nsd-info $n-out.h5; nsd-stat $n-out.h5"
done
# Each recipe of the cookbook that is one scene
for c in "$top"/cookbook/*/scene.json; do
    ! grep -q blade.stl "$c" || continue # which run.sh writes
    n=$(basename "$(dirname "$c")")
    frozen "recipe-$n" "cd cookbook/$n; nsd-gen scene.json >in.h5; cat in.h5; nsd-step -n 4 --contacts \$(sums scene.json) in.h5 -o out.h5; cat out.h5; nsd-info -p -l out.h5; nsd-info --scene out.h5"
done
# A heap of 300 balls that has fallen, by what steps and solves
heap='nsd-gen 300 | nsd-step -n 700 --every 700 2>heap.said >heap.h5; cat heap.said'
for way in '' '-j 2' '--cold' '-m sbp' '-m sal' '-m ebp' '-m eal -j 2' '-m exact --order random' \
    '--global anderson -j 2' '--paper -m ebp' '--overlap gap' '--overlap push' '--overlap keep' '--dt auto:0.01' '--order block'; do
    frozen "heap${way// /}" "$heap; cp heap.h5 h.h5; nsd-step -n 5 --contacts $way -o out.h5 h.h5; cat out.h5; nsd-info out.h5"
done
for lanes in 2 4 8; do
    frozen "heap-lanes$lanes" "$heap; export NSD_LANES=$lanes; nsd-step -n 5 --contacts -m exact -o out.h5 heap.h5; cat out.h5"
done
if command -v mpirun >/dev/null && command -v nsd-step-mpi >/dev/null; then
    for way in '' '--order block -m exact'; do
        frozen "heap-ranks3${way// /}" "$heap; mpirun --oversubscribe --bind-to none -n 3 nsd-step -n 5 --contacts $way -o out.h5 heap.h5 </dev/null; cat out.h5"
    done
    frozen "silo-ranks3" "nsd-gen scenes/silo.json >in.h5; mpirun --oversubscribe --bind-to none -n 3 nsd-step -n 8 --sums --contacts -o out.h5 in.h5 2>said </dev/null; cat out.h5"
fi
frozen heap-pipe "$heap; nsd-step -n 3 heap.h5 2>step.said | nsd-detect | nsd-solve -m eal 2>solve.said | nsd-err; cat step.said solve.said; nsd-detect heap.h5 | nsd-solve 2>solve.said | nsd-move | nsd-info; cat solve.said"
frozen heap-fclib "$heap; for form in local global; do nsd-detect --fclib=\$form heap.h5 | nsd-solve >s.h5; nsd-err s.h5; done"
frozen heap-stat "$heap; nsd-step -n 3 --contacts --sums heap.h5 -o out.h5; nsd-stat -m all out.h5 || nsd-stat out.h5; nsd-stat -l -f fields.h5 out.h5; cat fields.h5"
for to in vtk xyz lammps csv gsd stl lammps-data; do
    frozen "export-$to" "$heap; nsd-step -n 2 --contacts heap.h5 -o out.h5; nsd-export -l -t $to out.h5 -o x.$to; find . -name 'x*' -newer heap.h5 -type f | sort | xargs cat"
done
frozen view "$heap; nsd-view -l heap.h5 >p.png; cat p.png; nsd-gen scenes/drum.json | nsd-view >q.png; cat q.png; nsd-web heap.h5 >w.html; cat w.html"
frozen resume "nsd-gen scenes/pour.json | nsd-step -n 40 --every 20 -o a.h5; cp a.h5 b.h5; nsd-step -n 40 --every 20 -i b.h5; cat b.h5; nsd-step -n 40 --every 20 -o c.h5 a.h5; cat c.h5; nsd-cat -o d.h5 a.h5 c.h5; cat d.h5"
frozen loop "nsd-gen scenes/pour.json | nsd-step -n 12 --with 'jq -c --unbuffered \"{gravity: [1, 0, -9]}\"' --with-boundaries all --with-measures stress -o a.h5; cat a.h5; nsd-gen scenes/pour.json | nsd-step -n 12 --replay <(nsd-info --answers a.h5 2>/dev/null) 2>/dev/null || true"
frozen check "for s in scenes/*.json; do nsd-gen --check \$s; done"
frozen help "for t in gen detect solve err step move info stat export view web cat; do nsd-\$t --help; done"
frozen wrong "for s in '{}' '{\"dt\": -1}' '{\"dt\": 1e-3, \"walls\": [{\"pint\": 1}]}' '{\"dt\": 1e-3, \"bodies\": [{\"x\": [0, 0], \"radius\": nan}]}' '[' '{\"dt\": 1e-3, \"bodies\": [{\"x\": [0, 0, 0]}]}'; do echo \"\$s\" | nsd-gen - || echo \$?; done; nsd-step nothing.h5 || echo \$?; nsd-step --eps x || echo \$?"

sums() { jq -r 'if .walls // .drum then "--sums" else "" end' "$1"; } # where there are walls
one() # NAME<TAB>COMMAND
{
    local name=${1%%$'\t'*} dir
    dir=$(mktemp -d "$work/run.XXXXXX")
    ln -s "$work/scenes" "$dir/scenes"
    cp -r "$work/cookbook" "$dir/cookbook"
    (cd "$dir" && timeout 300 bash -c "${1#*$'\t'}" >all 2>&1 </dev/null || echo "status $?" >>all
        sed -E -i '/nsd-(solve|step): /s/[0-9.e+-]+ (s|MB)\>/# \1/g' all)
    if [ -n "${FROZEN_KEEP-}" ]; then cp "$dir/all" "$FROZEN_KEEP/$name"; fi
    printf '%s %s\n' "$name" "$(sha256sum <"$dir/all" | cut -c1-16)"
    rm -rf "$dir"
}
export -f one sums
export work
# shellcheck disable=SC2016 # $1 is that of the inner bash
printf '%s\0' "${jobs[@]}" | xargs -0 -P 2 -I{} bash -c 'one "$1"' _ {} | sort
