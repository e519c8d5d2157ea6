#!/usr/bin/env bash
# The kept page, docs/paper, is not older than what made it: some of its runs, one of each method with either settings,
# are made again, and their lines in runs.json are the kept ones. Where they are not, `make paper` makes the page anew.
# shellcheck source=tests/support/tap.sh
. tests/support/tap.sh

out=$tmp/paper
runs=(example2_paper_{sbp,sal,ebp,eal}_1 example2_nsd_{sbp,exact}_1 example1_paper_sbp example2-2d_paper_sal_1)
for run in "${runs[@]}"; do
    kept=$(jq -c --arg run "$run" 'select(.run == $run)' docs/paper/runs.json)
    ok "$run is made again" make -f scripts/paper.mk OUT="$out" "$out/runs/$run.json"
    is "and is what the page has: make paper" "$(jq -c . "$out/runs/$run.json")" "$kept"
done
done_testing
