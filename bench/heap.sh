# shellcheck shell=bash
# heap.sh: piles of any size to measure on. Sourced after common.sh, which sets work.

# The settled pile of the paper's example 3 into $work/pile.h5: 500 balls, 1000 steps.
: "${work:?}"

settle()
{
    [ -f "$work/pile.h5" ] && return
    nsd-gen 500 |
        nsd-step --protocol paper -m exact -n 1000 --every 1000 --tolerance 1e-8 2> /dev/null |
        nsd-cat --last > "$work/pile.h5"
}

# heap TILES: that pile side by side on one floor, 500 balls a tile, as a packing on standard output.
heap()
{
    settle
    nsd-info --last -b "$work/pile.h5" | jq -r '[.position[], .radius] | @tsv' |
        awk -v tiles="$1" '
            { x[NR] = $1; y[NR] = $2; z[NR] = $3; r[NR] = $4 }
            END {
                side = int(sqrt(tiles - 1)) + 1
                for (k = 0; k < tiles; k++)
                    for (i = 1; i <= NR; i++)
                        printf "%.17g %.17g %.17g %.17g\n", x[i] + k % side * 0.0063, y[i] + int(k / side) * 0.0063, z[i], r[i]
            }' > "$work/heap.txt"
    jq --arg file "$work/heap.txt" '.allow_overlap = true | .bodies = [{ file: $file }]
        | .walls = [{ point: [0, 0, 0], normal: [0, 0, 1] }]' scenes/paper/example3.json | nsd-gen -
}
