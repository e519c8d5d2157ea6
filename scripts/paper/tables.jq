# The paper's table N, ours beside the paper's, as TSV. Slurped: the runs. --arg table N;
# --rawfile times; --slurpfile paper. Of example 2, medians over the seeds, lowest and highest beside them.
# The times come last, since they alone differ from run to run: medians, lowest and highest, over the
# rounds and seeds; "over_sbp" is taken round by round, seed by seed.
include "stats";

($times | rows | map(select(.what == "whole")) | group_by(.run)
 | map({ key: .[0].run, value: (sort_by(.round | tonumber) | map(.seconds | tonumber)) }) | from_entries) as $cpu
| def rank: { nsd: 0, paper: 1, plain: 1, line: 0 }[.settings] * 100 - (.alpha // "0" | tonumber)
      + { sbp: 10, sal: 20, ebp: 30, eal: 40, exact: 50 }[.method];
  # Of example 2, in how many of the seeds
  def state: length as $n
    | map(select(.diverged)) as $gone | map(select(.blew_up and (.diverged | not))) as $hot
    | [ ($gone | if length == 0 then empty elif $n > 1 then "diverged \(length) of \($n) times" else "diverged at step \(.[0].steps)" end),
        ($hot | if length == 0 then empty elif $n > 1 then "blew up \(length) of \($n) times" else "blew up" end) ]
    | join(", ");
  def outcome: state as $bad | if $bad != "" then $bad elif any(.missed > 0) then "at the cap" else "converged" end;
  def ends($all): if $table == "2" then $all.low, $all.high else empty end;
  def names: "contacts", "sweeps", "eps_glob", "penetration", "penetration_true", "missed", "total_sweeps";
  def of_name($name): { penetration: "max_penetration", penetration_true: "max_penetration_true" }[$name] // $name;

  map(select(if $table == "4" then .alpha else .example == $table and .alpha == null and .box == null
             and (.seed == null or .example == "2") end))
| group_by([-.dim, rank]) as $rows
| [ "dim", "settings", "alpha", "method", "contacts", "sweeps", "sweeps_paper", "eps_glob", "eps_glob_paper",
    "penetration", "penetration_paper", "penetration_true", "missed", "steps", "total_sweeps", "gave_up",
    "state", (if $table == "2" then names | "\(.)_low", "\(.)_high" else empty end),
    "seconds", "seconds_low", "seconds_high", "seconds_paper", "over_sbp", "over_sbp_low", "over_sbp_high",
    "over_sbp_paper", "runs_timed" ],
  ($rows[]
   | sort_by(.seed) as $all
   | length as $n | .[0] as $r
   | (if $table == "4" and $r.method != "ebp" then {} else $paper[0][$table][$r.alpha // $r.method] end) as $p
   | def of($name): $all | map(.[of_name($name)]) | stat;
     ([$all[] | $cpu[.run][]] | stat) as $seconds
   | (if $r.alpha then {} else
       [$all[] | $cpu[.run] as $own | $cpu[.run | sub("_\($r.method)"; "_sbp")] as $sbp
        | range([$own, $sbp] | map(length) | min) | $own[.] / $sbp[.]] | stat end) as $over
   | [ $r.dim, $r.settings, $r.alpha, $r.method, of("contacts").mid, of("sweeps").mid, $p.sweeps, of("eps_glob").mid,
       $p.eps_glob, of("penetration").mid, $p.penetration, of("penetration_true").mid, of("missed").mid, ($all | map(if $n > 1 then .asked else .steps end) | max),
       of("total_sweeps").mid, of("gave_up").mid, ($all | outcome), ends(of(names)),
       $seconds.mid, $seconds.low, $seconds.high, $p.seconds, $over.mid, $over.low, $over.high,
       (if $r.alpha or $p.seconds == null then null else $p.seconds / $paper[0][$table].sbp.seconds end), $seconds.n ])
| map(. // "") | @tsv
