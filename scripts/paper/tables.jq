# The paper's table N, ours beside the paper's, as TSV. Slurped: the runs. --arg table N;
# --rawfile times; --slurpfile paper. The times come last, since they alone differ from run to run.

($times / "\n" | map(select(. != "") / "\t" | { key: .[0], value: { once: .[1], least: .[2] } }) | from_entries) as $cpu
| def seconds: $cpu[.run] | if $table == "1" or $table == "2" then .least else .once end | tonumber;
  def rank: { nsd: 0, paper: 1, plain: 1, line: 0 }[.settings] * 100 - (.alpha // "0" | tonumber)
      + { sbp: 10, sal: 20, ebp: 30, eal: 40, exact: 50 }[.method];
  def state: if .diverged then "diverged at step \(.steps)" elif .blew_up then "blew up"
      elif .missed > 0 then "at the cap" else "converged" end;

  map(select(if $table == "4" then .alpha else .example == $table and .alpha == null end)) as $rows
| ($rows | map({ key: "\(.dim) \(.settings) \(.alpha) \(.method)", value: seconds }) | from_entries) as $took
| [ "dim", "settings", "alpha", "method", "contacts", "sweeps", "sweeps_paper", "eps_glob", "eps_glob_paper",
    "penetration", "penetration_paper", "penetration_true", "missed", "steps", "total_sweeps", "gave_up",
    "state", "seconds", "seconds_paper", "to_sbp", "to_sbp_paper" ],
  ($rows | sort_by([-.dim, rank])[]
   | . as $r
   | (if $table == "4" and .method != "ebp" then {} else $paper[0][$table][.alpha // .method] end) as $p
   | (if .alpha then 1 else $took["\(.dim) \(.settings) null sbp"] end) as $base
   | [ .dim, .settings, .alpha, .method, .contacts, .sweeps, $p.sweeps, .eps_glob, $p.eps_glob,
       .max_penetration, $p.penetration, .max_penetration_true, .missed, .steps, .total_sweeps, .gave_up,
       state, seconds, $p.seconds,
       (if .alpha then null else seconds / $base - 1 end),
       (if .alpha or $p.seconds == null then null else $p.seconds / $paper[0][$table].sbp.seconds - 1 end) ])
| map(. // "") | @tsv
