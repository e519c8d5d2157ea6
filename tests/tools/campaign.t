#!/usr/bin/env bash
# Campaigns over mu and seeds, as the tutorial has them: by make, by GNU parallel, as a Slurm array; killed ones
# go on where they were.
. tests/support/tap.sh

campaign="$tmp/the user's campaign" # a folder as users name them
cp -r scripts/campaign "$campaign"
cat >"$tmp/pile.json" <<'END'
{ "dim": 2, "dt": 2e-4, "e_n": 0.1,
  "walls": [{ "point": [0, 0], "normal": [0, 1] }, { "point": [0, 0], "normal": [1, 0] }, { "point": [0.04, 0], "normal": [-1, 0] }],
  "bodies": [{ "count": 60, "radius": { "uniform": [1.5e-3, 2e-3] }, "box": { "x": [0, 0.04], "y": [0, null] } }] }
END
export SCENE=$tmp/pile.json UNTIL=0.2 EVERY=0.01s
export MU="0.1 0.5" SEEDS="1 2"
mkdir "$tmp/make" "$tmp/killed" "$tmp/parallel" "$tmp/slurm" "$tmp/bin"
frames() { for run in "$1"/runs/*.h5; do nsd-info -p "$run"; done; }
by_make() { make -s -C "$1" -f "$campaign/campaign.mk" "${@:2}" >"$tmp/said" 2>&1; }

ok "make -j over mu and seeds" by_make "$tmp/make" -j2
is "a line for each run" "$(cut -f 1,2 "$tmp/make/campaign.tsv" | tr '\t\n' ' ;')" 'mu seed;0.1 1;0.1 2;0.5 1;0.5 2;'
# shellcheck disable=SC2016 # columns of awk
ok "rougher heaps are looser" awk 'NR > 1 { sum[$1] += $3 } END { exit !(sum["0.5"] < sum["0.1"]) }' "$tmp/make/campaign.tsv"
ok "a plot" test -s "$tmp/make/campaign.png"
touch "$tmp/stamp"
by_make "$tmp/make"
is "what is done is not done again" "$(find "$tmp/make" -newer "$tmp/stamp" -name '*.h5' | wc -l)" 0

# killed with all that it has started, once before and once after the first runs are done
for wait in 0.15 0.5; do
    setsid make -s -j2 -C "$tmp/killed" -f "$campaign/campaign.mk" UNTIL=0.2 >/dev/null 2>&1 &
    make=$!
    sleep $wait
    kill -9 -- -$make 2>/dev/null || true
    wait $make 2>/dev/null || true
done
ok "a campaign that was killed goes on" by_make "$tmp/killed" -j2
ok "to the same table" cmp "$tmp/make/campaign.tsv" "$tmp/killed/campaign.tsv"
ok "and the same frames, to the bit" cmp <(frames "$tmp/make") <(frames "$tmp/killed")
# one that is cut off in its middle, for certain
rm "$tmp/killed/runs/mu-0.5-seed-1.h5"
(cd "$tmp/killed" && jq '.mu = 0.5 | .seed = 1' "$SCENE" | nsd-gen - >runs/mu-0.5-seed-1.part.h5 &&
    nsd-step -i --until 0.1 --every "$EVERY" runs/mu-0.5-seed-1.part.h5 2>/dev/null)
touch "$tmp/stamp"
by_make "$tmp/killed"
is "only the run that was cut off is continued" "$(find "$tmp/killed" -newer "$tmp/stamp" -name '*.h5')" "$tmp/killed/runs/mu-0.5-seed-1.h5"
ok "from where it was" cmp <(frames "$tmp/make") <(frames "$tmp/killed")

if command -v parallel >/dev/null; then
    # shellcheck disable=SC2086 # words
    (cd "$tmp/parallel" && parallel --will-cite -q -j2 "$campaign/run.sh" ::: $MU ::: $SEEDS) >/dev/null 2>&1
    ok "GNU parallel makes the same runs" cmp <(frames "$tmp/make") <(frames "$tmp/parallel")
else
    skip "GNU parallel makes the same runs" "no parallel"
fi

# Slurm's part: the script copied, and run once a task
cat >"$tmp/bin/sbatch" <<'END'
#!/usr/bin/env bash
set -eu
for word in "$@"; do case $word in --array=*) array=${word#--array=} ;; esac; done
cp "${!#}" "${TMPDIR:-/tmp}/slurm-script.$$"
trap 'rm -f "${TMPDIR:-/tmp}/slurm-script.$$"' EXIT
for ((k = ${array%-*}; k <= ${array#*-}; k++)); do
    SLURM_ARRAY_TASK_ID=$k bash "${TMPDIR:-/tmp}/slurm-script.$$"
done
END
chmod +x "$tmp/bin/sbatch"
(cd "$tmp/slurm" && CAMPAIGN=$campaign PATH=$tmp/bin:$PATH sbatch --array=0-3 --export=ALL "$campaign/array.sbatch") >/dev/null 2>&1
ok "a Slurm array makes the same runs" cmp <(frames "$tmp/make") <(frames "$tmp/slurm")
status 64 "a task too many says so" env SLURM_ARRAY_TASK_ID=4 "$campaign/array.sbatch"

# the script of one run by MPI: the same as the run without it, with --order colour; a job that is requeued resumes
if command -v mpirun >/dev/null && [ -x "$(command -v nsd-step-mpi)" ]; then
    nsd-gen "$SCENE" >"$tmp/one.h5"
    cp "$tmp/one.h5" "$tmp/two.h5"
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 MPIRUN="mpirun --oversubscribe" OPTIONS="--order colour"
    job() { (cd "$tmp" && RUN=two UNTIL=$1 SLURM_NTASKS=2 "$campaign/mpi.sbatch") >/dev/null 2>&1; }
    ok "mpi.sbatch makes a run" job 0.02
    ok "and resumes it" job 0.04
    nsd-step --small-steps 0 --order colour -i --until 0.04 --every "$EVERY" "$tmp/one.h5" 2>/dev/null
    ok "and has the frames of one process" cmp <(nsd-info -p "$tmp/one.h5") <(nsd-info -p "$tmp/two.h5")
else
    skip "mpi.sbatch makes a run" "no MPI"
fi

done_testing
