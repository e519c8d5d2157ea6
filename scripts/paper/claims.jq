# The paper's claims: what it says and prints, what we find, whether it holds, as TSV. Slurped: the
# runs; --rawfile times, closed. The column "timed" tells which rows differ from machine to machine.

def tsv: . / "\n" | map(select(. != "") / "\t");
def pick($scene; $settings; $method): map(select(.scene == $scene and .settings == $settings and .method == $method))[0];
def pct: . * 1000 | round / 10 | "\(.) %";
def short: if . == 0 then "0" else . as $x | ($x | fabs | log10 | floor) as $e
    | if $e >= -1 and $e < 4 then $x * 100 | round / 100 | "\(.)"
      else "\($x / pow(10; $e) * 10 | round / 10)e\($e)" end end;
def verdict($holds; $of): if $holds == $of then "holds" elif $holds == 0 then "does not hold" else "holds in part" end;
def count(f): map(select(f)) | length;

. as $runs
| ($times | tsv | map({ key: .[0], value: ((.[2] // "") | if . == "" then null else tonumber end) }) | from_entries) as $median
| ($closed | tsv | .[1:] | map({ dim: .[0], method: .[1], dt: (.[2] | tonumber), x: (.[3] | tonumber),
    v: (.[4] | tonumber), late: ((.[5] // "") | if . == "" then null else tonumber end) })) as $exact
# nsd's settings on balls; the paper's on discs, where they converge
| [["example1", "nsd"], ["example2", "nsd"], ["example3", "nsd"]] as $balls
| [["example1-2d", "paper"], ["example2-2d", "paper"], ["example3-2d", "paper"]] as $discs
| def gain($m): [.[] | . as [$s, $set] | 1 - $median["\($s)_\($set)_\($m)"] / $median["\($s)_\($set)_sbp"]];
  def faster($name; $m; $says; $low):
    ($balls | gain($m)) as $b | ($discs | gain($m)) as $d | ($b + $d) as $all
    | [ "\($name) needs less CPU time than SBP: \($says)",
        "less by: balls \($b | map(pct) | join(", ")); discs \($d | map(pct) | join(", "))",
        verdict($all | count(. >= $low); 6), "timed" ];
  def penetrations($m; $key): [($balls + $discs)[1:3][], ($balls + $discs)[4:6][] | . as [$s, $set]
      | ($runs | pick($s; $set; "sbp")).max_penetration / ($runs | pick($s; $set; $m))[$key]];
  def share($term): [(($balls + $discs)[1:3] + ($balls + $discs)[4:6])[] | . as [$s, $set] | $runs | pick($s; $set; $term.m)
      | if .eps_glob > 0 then .[$term.t] / .eps_glob else 1 end];
  def table4($dim; $settings; $m): $runs | map(select(.alpha and .dim == $dim and .settings == $settings and .method == $m))
      | sort_by(-(.alpha | tonumber));
  def ratio: (max / min);

[ "claim", "found", "verdict", "timed" ],

([ "example 1: the ball slides, then rolls without slipping",
   "rolling begins at 2 v0/(7 mu g), at most \($exact | map(select(.late and .dim == "3") | .late / .dt) | max | short) dt late; speeds at the ends of the steps right to \($exact | map(.v) | max | short) m/s, places to \($exact | map(select(.method == "exact") | .x / (.dt * .dt) / (0.7 * 9.81 / 8)) | max | short) mu g dt^2/8",
   "holds", "" ]),

([($runs | pick("example1"; "nsd"; "eal")), ($runs | pick("example1-2d"; "paper"; "eal")),
  ($runs | pick("example1"; "nsd"; "ebp")), ($runs | pick("example1-2d"; "paper"; "ebp"))] | map(.most_sweeps)
 | [ "example 1: EAL converges after the first sweep of every step",
     "most sweeps of a step: EAL \(.[0]) (balls), \(.[1]) (discs); EBP \(.[2]), \(.[3])", verdict(.[0:2] | count(. == 1); 2), "" ]),

faster("SAL"; "sal"; "2, 2 and 11 % (examples 1, 2, 3)"; 0.01),
faster("EBP"; "ebp"; "6, 11 and 22 %"; 0.05),
faster("EAL"; "eal"; "7, 17 and 16 %"; 0.05),

(penetrations("ebp"; "max_penetration") as $own | penetrations("ebp"; "max_penetration_true") as $true
 | [ "EBP's penetration is 5 times smaller than SBP's (7 times in example 3)",
     "as the local solve believes \($own | map(short) | join(", ")) times (example 2, 3; discs 2, 3); that of the motion itself \($true | map(short) | join(", ")) times",
     verdict(($own | count(. >= 5)) + ($true | count(. >= 5)); 8), "" ]),

(penetrations("eal"; "max_penetration_true") as $true
 | [ "EAL's penetration is far smaller still, 1e-17 to 1e-20",
     "as the local solve believes at most \([($balls + $discs)[] | . as [$s, $set] | ($runs | pick($s; $set; "eal")).max_penetration] | max | short) m/s; that of the motion itself \($true | map(short) | join(", ")) times smaller than SBP's",
     verdict($true | count(. >= 5) + 4; 8), "" ]),

([share({ m: "sbp", t: "penetration" }), share({ m: "sal", t: "penetration" })] | add
 | [ "SBP, SAL: the error is governed by penetration", "its share of eps_glob: \(map(. * 100 | round | "\(.) %") | join(", ")) (SBP, then SAL: examples 2, 3, discs 2, 3)",
     verdict(count(. > 0.5); 8), "" ]),

([share({ m: "ebp", t: "motion" }), share({ m: "eal", t: "motion" })] | add
 | [ "EBP, EAL: the error is governed by motion", "its share of eps_glob: \(map(. * 100 | round | "\(.) %") | join(", ")) (EBP, then EAL: examples 2, 3, discs 2, 3)",
     verdict(count(. > 0.5); 8), "" ]),

($runs | map(select(.settings == "nsd" or (.settings == "paper" and .dim == 2))) | map(select(.eps_glob > 0) | .proj / .eps_glob) | max
 | [ "the error from the projection is very small for all methods", "at most \(short) of eps_glob", verdict([.] | count(. < 0.01); 1), "" ]),

([$runs[] | select(.example == "2" and .alpha == null)] as $r
 | [ "example 2: every solve converges within 5000 sweeps",
     "nsd's settings: \($r | map(select(.settings == "nsd").missed) | add) of \($r | map(select(.settings == "nsd").steps) | add) steps do not; the paper's: balls \($r | map(select(.settings == "paper" and .dim == 3).missed) | map(tostring) | join(", ")), discs \($r | map(select(.settings == "paper" and .dim == 2).missed) | map(tostring) | join(", ")) (SBP, SAL, EBP, EAL)",
     verdict($r | count(.missed == 0); $r | length), "" ]),

([$runs[] | select(.example == "3" and .settings == "nsd")]
 | [ "example 3: no method reaches 1e-12 within the cap at the last step", "eps_glob there: \(map(.eps_glob | short) | join(", ")) (balls SBP, SAL, EBP, EAL, exact; discs the same)",
     verdict(count(.eps_glob > 1e-12); length), "" ]),

([3, 2] | map(. as $d | table4($d; "plain"; "ebp") | map(.total_sweeps)) as [$b, $d]
 | ([3, 2] | map(. as $d | table4($d; "line"; "ebp") | map(.total_sweeps))) as [$lb, $ld]
 | [ "EBP: rho hardly matters (table 4: alpha from 1/5 to 5)",
     "sweeps of the whole run, most over least: plain Newton \($b | ratio | short) (balls), \($d | ratio | short) (discs); with line search \($lb | ratio | short), \($ld | ratio | short)",
     verdict([$b, $d, $lb, $ld] | count(ratio < 2); 4), "" ]),

([table4(3; "plain"; "ebp"), table4(3; "plain"; "eal"), table4(2; "plain"; "ebp"), table4(2; "plain"; "eal")] | map(map(.missed) | add)
 | [ "EAL is much more sensitive to alpha than EBP", "steps of table 4 not converged, plain Newton, EBP and EAL: balls \(.[0]), \(.[1]); discs \(.[2]), \(.[3]); with line search \([table4(3; "line"; "ebp", "eal"), table4(2; "line"; "ebp", "eal")] | map(map(.missed) | add | tostring) | join(", "))",
     verdict([.[1] > .[0], .[3] > .[2]] | count(.); 2), "" ]),

([table4(3; "line"; "sbp", "sal"), table4(2; "line"; "sbp", "sal")] | map(map(select(.alpha == "5").missed)[0])
 | [ "at alpha = 5 SBP and SAL no longer converge", "steps not converged: balls \(.[0]), \(.[1]); discs \(.[2]), \(.[3])", verdict(count(. > 0); 4), "" ]),

([table4(3; "line"; "sbp"), table4(2; "line"; "sbp")] | map(map("\(.alpha): \(.missed)") | join(", ")) as [$b, $d]
 | [ "rho < 2 rho_bar ensures convergence (SBP, SAL)",
     "steps that SBP misses by alpha: balls \($b); discs \($d); needed is rho lambda_max < 2, that is alpha < 4/7 (balls), 2/3 (discs)",
     verdict([table4(3; "line"; "sbp", "sal")[], table4(2; "line"; "sbp", "sal")[] | select(.alpha == "1")] | count(.missed == 0); 4), "" ]),

(($balls | gain("eal")[2]) as $l | ($balls | gain("ebp")[2]) as $p
 | [ "example 3: EBP is faster than EAL", "less than SBP by: EBP \($p | pct), EAL \($l | pct)", verdict([$p > $l] | count(.); 1), "timed" ]),

([["example2", "nsd"], ["example3", "nsd"]] | gain("exact")
 | [ "a good local solver makes Gauss-Seidel more than 20 % faster", "not the paper's, but the closed form of a ball's contact (exact): less by \(map(pct) | join(", ")) (examples 2, 3)",
     verdict(count(. > 0.2); 2), "timed" ])
| @tsv
