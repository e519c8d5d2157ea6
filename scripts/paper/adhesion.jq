# The chapter "with adhesion". Slurped: the runs of settings "bond" (summary.jq, with how many bonds are whole, damaged and
# broken at the end). --slurpfile same: one problem, every method; --slurpfile times: 500 sweeps of one problem, round by
# round. --arg table: rows, same or claims; as TSV.
include "stats";

def names: { "1": "example1", "2": "example2", "3": "example3" };
def order: { sbp: 0, sal: 1, ebp: 2, eal: 3, exact: 4 }[.method];
def of($example; $method): map(select(.example == $example and .method == $method)) | sort_by(.seed);
# what x of a method is over that of sbp, run by run
def over($example; $method; f): . as $all | [of($example; $method), ($all | of($example; "sbp"))] | transpose
    | map((.[0] | f) as $a | (.[1] | f) as $b | if $b > 0 then $a / $b else empty end) | stat;
def share(f): map(if .eps_glob > 0 then f / .eps_glob else empty end) | stat;
def percent: "\(.mid * 100 | digits(2)) %";
def verdict($all; $some): if $all then "carries over" elif $some then "carries over in part" else "does not carry over" end;
def one($scene; $method): $same | map(select(.scene == $scene and .method == $method)) | sort_by(.pile);
# SBP's x over the method's, problem by problem; less than the rounding of such velocities counts as that
def less($scene; $method; f): [one($scene; "sbp"), one($scene; $method)] | transpose
    | map(([(.[0] | f), 1e-17] | max) / ([(.[1] | f), 1e-17] | max)) | stat;
def seconds($method): $times | map(select(.method == $method)) | sort_by(.round) | map(.seconds);
def sweeps_over($method): [seconds($method), seconds("sbp")] | transpose | map(.[0] / .[1]) | stat;

def rows:
  [ "scene", "method", "contacts", "whole", "damaged", "broken", "sweeps", "eps_glob", "motion", "bipotential", "penetration",
    "of the motion", "missed", "all sweeps", "over SBP", "seconds", "over SBP" ],
  ( . as $all | ["1", "2", "3"][] as $e | ["sbp", "sal", "ebp", "eal", "exact"][] as $m
    | ($all | of($e; $m)) as $r
    | def s(f): $r | map(f) | stat | spread;
      [ names[$e], $m, s(.contacts), s(.whole), s(.damaged), s(.broken), s(.sweeps), s(.eps_glob), s(.motion), s(.bipotential),
        s(.max_penetration), s(.max_penetration_true), s(.missed) + " of \($r[0].asked)", s(.total_sweeps),
        ($all | over($e; $m; .total_sweeps) | spread), s(.seconds), ($all | over($e; $m; .seconds) | spread) ] );

def same_rows:
  [ "scene", "method", "problems", "contacts", "sweeps", "eps_glob", "penetration", "of the motion", "SBP's over this" ],
  ( ["example2", "example3"][] as $s | ["sbp", "sal", "ebp", "eal", "exact"][] as $m | one($s; $m) as $r
    | def s(f): $r | map(f) | stat | spread;
      [ $s, $m, ($r | length), s(.contacts), s(.sweeps), s(.eps_glob), s(.max_penetration), s(.max_penetration_true),
        (less($s; $m; .max_penetration_true) | spread) ] );

def claims:
  . as $all
  | def total($e; $m): $all | over($e; $m; .total_sweeps);
    def time($e; $m): $all | over($e; $m; .seconds);
    def part($m; f): $all | of("3"; $m) | share(f);
  [ "claim", "found", "verdict" ],
  ( ($all | map(select(.example == "1" and (.method == "ebp" or .method == "eal")) | .sweeps)) as $one
    | [ "EBP and EAL need one sweep in example 1", "at the last step \($one | map("\(.)") | join(", ")) (EBP, EAL); the bond to the floor has broken by then",
        verdict($one | all(. == 1); $one | any(. == 1)) ] ),
  ( total("2"; "sal") as $x
    | [ "SBP and SAL give very similar results in example 2", "SAL\u0027s sweeps over SBP\u0027s \($x | spread)",
        verdict($x.mid > 0.8 and $x.mid < 1.25; $x.mid > 0.5 and $x.mid < 2) ] ),
  ( [total("2"; "ebp"), total("2"; "eal"), total("3"; "ebp"), total("3"; "eal")] as $x
    | [ "the enhanced methods need fewer sweeps than the simple ones", "sweeps of the whole run over SBP\u0027s: EBP \($x[0] | spread) and \($x[2] | spread), EAL \($x[1] | spread) and \($x[3] | spread) (examples 2 and 3)",
        verdict($x | all(.mid < 0.95); $x | any(.mid < 0.95)) ] ),
  ( [time("2"; "ebp"), time("2"; "eal"), time("3"; "ebp"), time("3"; "eal"), sweeps_over("ebp"), sweeps_over("eal"), sweeps_over("exact")] as $x
    | [ "Newton improves the time by more than 20 %", "time over SBP\u0027s: EBP \($x[0] | spread) and \($x[2] | spread), EAL \($x[1] | spread) and \($x[3] | spread) (examples 2 and 3); 500 sweeps of one problem of example 3: EBP \($x[4] | spread), EAL \($x[5] | spread), exact \($x[6] | spread)",
        verdict($x[0:4] | all(.mid < 0.8); $x[0:4] | any(.mid < 0.8)) + " (a matter of time, on one machine)" ] ),
  ( [less("example2"; "ebp"; .max_penetration), less("example3"; "ebp"; .max_penetration), less("example2"; "ebp"; .max_penetration_true), less("example3"; "ebp"; .max_penetration_true)] as $x
    | [ "EBP\u0027s penetration is far smaller than SBP\u0027s", "the same problems given to both, SBP\u0027s over EBP\u0027s: in the local solve \($x[0] | spread) and \($x[1] | spread), of the motion \($x[2] | spread) and \($x[3] | spread) (examples 2 and 3)",
        verdict($x | all(.mid > 5); $x | any(.mid > 5)) ] ),
  ( [part("sbp"; .penetration), part("sal"; .penetration)] as $x
    | [ "SBP, SAL: the error is governed by penetration", "its share of eps_glob in example 3: SBP \($x[0] | percent), SAL \($x[1] | percent); the motion has \([part("sbp"; .motion), part("sal"; .motion)] | map(percent) | join(" and "))",
        verdict($x | all(.mid > 0.5); $x | any(.mid > 0.5)) ] ),
  ( [part("ebp"; .motion), part("eal"; .motion)] as $x
    | [ "EBP, EAL: the error is governed by motion", "its share of eps_glob in example 3: EBP \($x[0] | percent), EAL \($x[1] | percent)",
        verdict($x | all(.mid > 0.5); $x | any(.mid > 0.5)) ] ),
  ( ($all | map(select(.eps_glob > 0) | .proj / .eps_glob) | max) as $x
    | [ "the error from the projection is very small for all methods", "at most \($x | digits(2)) of eps_glob", verdict($x < 0.01; $x < 0.1) ] ),
  ( ($all | map(select(.example == "3")) | sort_by(order)) as $x
    | [ "no method reaches 1e-12 within the cap at the last step of example 3", "eps_glob there: \($x | map(.eps_glob | digits(2)) | join(", ")) (SBP, SAL, EBP, EAL, exact)",
        verdict($x | all(.eps_glob > 1e-12); $x | any(.eps_glob > 1e-12)) ] );

(if $table == "rows" then rows elif $table == "same" then same_rows else claims end) | map(. // "") | @tsv
