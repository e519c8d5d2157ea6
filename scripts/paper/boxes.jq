# Example 2, balls, nsd's settings, in boxes of several widths, as TSV: the steps that SBP and EBP miss, and
# SBP's sweeps over EBP's with the same seed. Slurped: the runs.
include "stats";

[ "box", "sbp_missed", "ebp_missed", "ratio", "ratio_last" ],
( map(select(.scene == "example2" and .settings == "nsd")) | map(.box //= 1.6) | group_by(.box)[]
  | (map(select(.method == "sbp")) | sort_by(.seed)) as $sbp
  | (map(select(.method == "ebp")) | sort_by(.seed)) as $ebp
  | [ .[0].box, ([$sbp[].missed] | stat | counts), ([$ebp[].missed] | stat | counts),
      ([range($sbp | length) | $sbp[.].total_sweeps / $ebp[.].total_sweeps] | stat | spread),
      ([range($sbp | length) | $sbp[.].sweeps / $ebp[.].sweeps] | stat | spread) ] )
| @tsv
