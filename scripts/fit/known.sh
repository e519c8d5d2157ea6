#!/usr/bin/env bash
# known.sh FOLDER [RUNS]: nsd-fit on drums whose frictions are known, each measured once with a packing of another seed. A row has the run,
# mu, its value and interval, mu_r, its value and interval, evaluations, CPU hours, remarks. FIRST is the number of the first run, which sets the seeds.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd) folder=$1
mkdir -p "$folder"
problem() # MU MU_R SEED MEASURES: a problem whose targets are those of a drum with these frictions; without errors, the scatter of the seeds counts
{
    jq --argjson mu "$1" --argjson r "$2" --argjson s "$((9000 + $3))" '.mu = $mu | .rolling.mu_r_ratio = $r | .seed = $s' "$here/drum.json" | "$here/measure.sh" |
        jq --arg here "$here" --argjson seed "$((1000 * $3))" --argjson names "$4" '{ scene: ($here + "/drum.json"), seed: $seed,
            parameters: { mu: { keys: "mu", range: [0.1, 0.9] }, mu_r: { keys: "rolling.mu_r_ratio", range: [0, 0.5] } },
            command: ($here + "/measure.sh"), targets: with_entries(select(.key | IN($names[])) | .value = { value: .value }) }'
}
first=${FIRST:-1} k=$((${FIRST:-1} - 1))
while read -r mu r; do
    [ $((++k - first)) -lt "${2:-10}" ] || break
    [ -e "$folder/$k.json" ] || problem "$mu" "$r" $k '["slope", "fraction", "spin"]' >"$folder/$k.json"
    nsd-fit --quiet -j "${JOBS:-1}" -n "${EVALUATIONS:-38}" "$folder/$k.json" >"$folder/$k.out" || true
    jq -r --argjson k $k --argjson mu "$mu" --argjson r "$r" '.parameters as $p | [$k, $mu, $p.mu.value, $p.mu.interval90[], $r, $p.mu_r.value, $p.mu_r.interval90[],
        .evaluations, .cpu_hours, (.remarks | join("; "))] | @tsv' "$folder/$k.fit/result.json"
done <<'EOF' | tee "$folder/known.tsv"
0.40 0.20
0.25 0.10
0.55 0.30
0.70 0.15
0.30 0.35
0.60 0.08
0.45 0.12
0.35 0.25
0.50 0.22
0.65 0.38
EOF
awk -F '\t' '{ mu += $4 <= $2 && $2 <= $5; r += $8 <= $6 && $6 <= $9 } END { printf "inside the 90 %% interval: mu %d, mu_r %d of %d\n", mu, r, NR }' "$folder/known.tsv"
# the slope alone cannot tell mu from mu_r
[ -e "$folder/slope.json" ] || problem 0.4 0.2 11 '["slope"]' >"$folder/slope.json"
nsd-fit --quiet -j "${JOBS:-1}" -n 46 "$folder/slope.json" | grep nsd-fit: || true
