#!/usr/bin/env bash
# Biaxial and triaxial compression at a constant pressure beside, from a dense and a loose start.
# shellcheck source=scripts/gallery/common.sh
. "$(dirname "$0")/common.sh"

# compress NAME DIM COUNT MU RATE STRAIN: dense is pressed together without friction, loose with it
compress()
{
    for start in dense loose; do
        scene isotropic --argjson mu "$([ $start = dense ] && echo 0 || echo "$4")" --argjson n "$3" --argjson dim "$2" '.dim = $dim | .mu = $mu |
            (if $dim == 2 then .density = 1.257 | .gravity = [0, 0] else . end) |
            (if $dim == 2 then $n * 1.45 | sqrt else $n * 1.46 | log / 3 | exp end) as $L |
            .cell.lengths = ([range($dim)] | map($L)) |
            .bodies[0] |= (.random.count = $n | .box = ({x: [0, $L], y: [0, $L]} + if $dim == 3 then {z: [0, $L]} else {} end))' |
            nsd-gen - | step "$1-$start-begin.h5" --overlap gap --until "$(pick 30 50)" --every 10s
        # the last axis becomes shorter at a constant rate, the others yield to the pressure
        on "$1-$start-begin.h5" --argjson mu "$4" --argjson rate "$5" '.mu = $mu | .time = 0 | .dim as $dim |
            .bodies[0].at_rest = true |
            .cell = {gradient: [range($dim) | . as $i | [range($dim) | if . == $i and . == $dim - 1 then -$rate else 0 end]],
                stress: {target: [range($dim) | . as $i | [range($dim) | if . == $i and . < $dim - 1 then 1 else null end]], mass: 10}}' |
            step "$1-$start.h5" --overlap gap --until "$(jq -n "$6 / $5")" --every "$(jq -n "$6 / $5 / 80")s" --contacts
        { echo "strain sin phi z"
            nsd-stat -m stress,fraction,coordination "$out/$1-$start.h5" | jq -r --argjson rate "$5" --argjson k $(($2 - 1)) \
                'select(.stress) | .stress.tensor as $s | [.time * $rate, ($s[$k][$k] - $s[0][0]) / ($s[$k][$k] + $s[0][0]),
                .fraction.fraction, .coordination.z_mechanical] | @tsv'
        } >"$out/$1-$start.tsv"
    done
}

compress discs 2 "$(pick 100 600)" 0.5 "$(pick 0.004 0.002)" "$(pick 0.3 0.4)"
tables=(--rawfile dense "$out/discs-dense.tsv" --rawfile loose "$out/discs-loose.tsv")
if [ -z "${QUICK:-}" ]; then
    compress balls 3 600 0.3 0.004 0.5
    tables+=(--rawfile dense3 "$out/balls-dense.tsv" --rawfile loose3 "$out/balls-loose.tsv")
fi
curve
picture --network "$out/discs-loose.h5"
with 'def curve: split("\n")[1:] | map(select(. != "") | split("\t") | map(tonumber));
    def late($k): curve | map(.[$k]) | .[length / 2 | floor:] | mean;
    def peak: curve | map(.[1]) | [range(2; length - 2) as $i | .[$i - 2:$i + 3] | mean] | .[:length / 2 | floor] | max;
    def compare($dense; $loose; $name):
        row($name + " critical"; $dense | late(1)),
        row($name + " critical, loose"; $loose | late(1)),
        row($name + " peak"; ($dense | peak) / ($dense | late(1))),
        row($name + " dilation"; ($dense | curve)[0][2] - ($dense | late(2))),
        row($name + " phi, dense less loose"; ($dense | late(2)) - ($loose | late(2))),
        row($name + " Z, dense less loose"; ($dense | late(3)) - ($loose | late(3)));
    compare($dense; $loose; "discs"),
    if $ARGS.named.dense3 then compare($ARGS.named.dense3; $ARGS.named.loose3; "balls") else empty end' \
    -n "${tables[@]}" | results
