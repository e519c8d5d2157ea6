#!/usr/bin/env bash
# run.sh MU SEED: one run of a campaign, runs/mu-MU-seed-SEED.h5, of the scene $SCENE until $UNTIL (s) with a
# frame every $EVERY of the motion's time. A run that is done is left alone, one that was killed goes on.
set -euo pipefail

mu=$1 seed=$2
scene=${SCENE:?the scene} until=${UNTIL:?until when, s} every=${EVERY:-0.01s}
run=runs/mu-$mu-seed-$seed
mkdir -p runs
if [ -e "$run.h5" ]; then exit 0; fi

# Files get their names when they are whole: what a kill leaves is never taken for a result.
if [ ! -e "$run.part.h5" ]; then
    jq --argjson mu "$mu" --argjson seed "$seed" '.mu = $mu | .seed = $seed' "$scene" | nsd-gen - > "$run.new.h5"
    mv "$run.new.h5" "$run.part.h5"
fi
nsd-step --in-place --until "$until" --every "$every" "$run.part.h5" 2>> "$run.log"
mv "$run.part.h5" "$run.h5"
