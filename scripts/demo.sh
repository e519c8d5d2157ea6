#!/usr/bin/env bash
# demo.sh [DIR]: the paper's third example, from one shell line to a picture.
set -euo pipefail

dir=${1:-demo}
mkdir -p "$dir"
steps=1000

echo "500 balls, $steps steps of 5e-5 s (nsd-gen 500 | nsd-step ...)"
nsd-gen 500 > "$dir/start.h5"
nsd-step -n "$steps" -o "$dir/out.h5" "$dir/start.h5"

view=(nsd-view --bare --size 560x1300 '--box=-0.0032,0.0032,-0.0032,0.0032,0,0.0155')
"${view[@]}" "$dir/start.h5" > "$dir/start.png"
"${view[@]}" "$dir/out.h5" > "$dir/end.png"
nsd-info "$dir/out.h5" |
    jq -r 'select(.step != null)
           | [.step, .contacts, .sweeps, .max_overlap / 2.5e-4, .balance.missing_impulse_mean] | @tsv' > "$dir/steps.tsv"
gnuplot -e "dir='${dir//\'/\'\'}'" scripts/demo.gp

nsd-web --title "500 balls fall into a box" --every 5 -o "$dir/out.html" "$dir/out.h5"

echo
echo "the last steps:"
printf '%-6s%-10s%-8s%-25s%s\n' step contacts sweeps 'overlap, smallest radii' 'missing impulse, of the load'
tail -n 5 "$dir/steps.tsv" | awk -F '\t' '{ printf "%-6s%-10s%-8s%-25.4f%.3f\n", $1, $2, $3, $4, $5 }'
echo
echo "look at    $dir/demo.png, and in a browser $dir/out.html, which plays it"
echo "ask        build/nsd-info $dir/out.h5 | jq -c 'select(.step == 1000)'"
echo "open       h5ls -r $dir/out.h5"
