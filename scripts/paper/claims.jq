# The paper's claims: what it says and prints, what we find, whether it holds, as TSV. Slurped: the
# runs; --rawfile times, closed. The column "timed" tells which rows differ from machine to machine.

def tsv: . / "\n" | map(select(. != "") / "\t");
def pick($scene; $settings; $method): map(select(.scene == $scene and .settings == $settings and .method == $method))[0];
def pct: . * 1000 | round / 10 | "\(.) %";
def short: if . == 0 then "0" else . as $x | ($x * 1.005 | fabs | log10 | floor) as $e  # 9.96 is 10
    | if $e >= -1 and $e < 4 then $x * 100 | round / 100 | "\(.)"
      else "\($x / pow(10; $e) * 10 | round / 10)e\($e)" end end;
def verdict($holds; $of): if $holds == $of then "holds" elif $holds == 0 then "does not hold" else "holds in part" end;
def count(f): map(select(f)) | length;

. as $runs
| ($times | tsv | map({ key: .[0], value: ((.[2] // "") | if . == "" then null else tonumber end) }) | from_entries) as $least
| ($closed | tsv | .[1:] | map({ dim: .[0], method: .[1], dt: (.[2] | tonumber), x: (.[3] | tonumber),
    v: (.[4] | tonumber), late: ((.[5] // "") | if . == "" then null else tonumber end) })) as $exact
# nsd's settings on balls; the paper's on discs, where they converge
| [["example1", "nsd"], ["example2", "nsd"], ["example3", "nsd"]] as $balls
| [["example1-2d", "paper"], ["example2-2d", "paper"], ["example3-2d", "paper"]] as $discs
| def gain($m): [.[] | . as [$s, $set] | 1 - $least["\($s)_\($set)_\($m)"] / $least["\($s)_\($set)_sbp"]];
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

([ ($exact | map(select(.late) | .late / .dt) | max), ($exact | map(.v) | max),
   ($exact | map(select(.method == "exact") | .x / (.dt * .dt) / (0.7 * 9.81 / 8)) | max)]
 | [ "example 1: the ball slides, then rolls without slipping",
     "rolling begins at 2 v0/(7 mu g), at most \(.[0] | short) dt late; speeds at the ends of the steps right to \(.[1] | short) m/s, places to \(.[2] | short) mu g dt^2/8",
     verdict([.[0] <= 1, .[1] < 1e-9, .[2] <= 1.01] | count(.); 3), "" ]),

([($runs | pick("example1"; "nsd"; "eal")), ($runs | pick("example1-2d"; "paper"; "eal")),
  ($runs | pick("example1"; "nsd"; "ebp")), ($runs | pick("example1-2d"; "paper"; "ebp"))] | map(.most_sweeps)
 | [ "example 1: EAL converges after the first sweep of every step",
     "most sweeps of a step: EAL \(.[0]) (balls), \(.[1]) (discs); EBP \(.[2]), \(.[3])", verdict(.[0:2] | count(. == 1); 2), "" ]),

faster("SAL"; "sal"; "2, 2 and 11 % (examples 1, 2, 3)"; 0.01),
faster("EBP"; "ebp"; "6, 11 and 22 %"; 0.05),
faster("EAL"; "eal"; "7, 17 and 16 %"; 0.05),

([($balls + $discs)[:2][], ($balls + $discs)[3:5][] | . as [$s, $set]
   | [$least["\($s)_\($set)_\("sbp", "sal", "ebp", "eal")"]] | .[3] / min]
 | [ "EAL is the fastest in examples 1 and 2", "its time over the least of the four: \(map(short) | join(", ")) (examples 1, 2, discs 1, 2)",
     verdict(count(. < 1.03); 4), "timed" ]),

([["example2", "nsd"], ["example2-2d", "paper"] | . as [$s, $set] | ($runs | pick($s; $set; "sal")).total_sweeps / ($runs | pick($s; $set; "sbp")).total_sweeps]
 | [ "example 2: SBP and SAL give very similar results", "SAL's sweeps over SBP's, whole runs: \(map(short) | join(", ")) (balls, discs)",
     verdict(count(. > 0.8 and . < 1.25); 2), "" ]),

(penetrations("ebp"; "max_penetration") as $own | penetrations("ebp"; "max_penetration_true") as $true
 | [ "EBP's penetration is 5 times smaller than SBP's (7 times in example 3)",
     "as the local solve believes \($own | map(short) | join(", ")) times (example 2, 3; discs 2, 3); that of the motion itself \($true | map(short) | join(", ")) times",
     verdict(($own | count(. >= 5)) + ($true | count(. >= 5)); 8), "" ]),

([($balls + $discs)[] | . as [$s, $set] | ($runs | pick($s; $set; "eal")).max_penetration] as $own
 | penetrations("eal"; "max_penetration_true") as $true
 | [ "EAL's penetration is far smaller still, 1e-17 to 1e-20",
     "as the local solve believes at most \($own | max | short) m/s; that of the motion itself \($true | map(short) | join(", ")) times smaller than SBP's",
     verdict(($own | count(. < 1e-15)) + ($true | count(. >= 5)); 10), "" ]),

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

([table4(3; "plain"; "ebp"), table4(2; "plain"; "ebp") | map(select(.alpha == "0.2" or .alpha == "0.5"))]
 | [ "EBP: with alpha small it converges, but slowly", "alpha 1/5: steps not converged \(map(.[1].missed | tostring) | join(", ")); sweeps over those of alpha 1/2: \(map(.[1].total_sweeps / .[0].total_sweeps | short) | join(", ")) (balls, discs)",
     verdict((map(.[1]) | count(.missed == 0)) + count(.[1].total_sweeps > 1.2 * .[0].total_sweeps); 4), "" ]),

([table4(3; "line"; "sbp", "sal"), table4(2; "line"; "sbp", "sal")]
 | [ "SBP and SAL: very sensitive to rho", "sweeps at alpha 1/5 over those at 1/2: \(map((map(select(.alpha == "0.2"))[0].total_sweeps) / (map(select(.alpha == "0.5"))[0].total_sweeps) | short) | join(", ")) (balls, discs); steps not converged at alpha 1: \(map(map(select(.alpha == "1"))[0].missed | tostring) | join(", "))",
     verdict(count(map(select(.alpha == "1"))[0].missed > 0); 4), "" ]),

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

([(($balls + $discs)[1:3] + ($balls + $discs)[4:6])[] | [.] | [gain("ebp")[0], gain("eal")[0]] | max]
 | [ "Newton improves the time by more than 20 %",
     "the better of EBP and EAL, less than SBP by: \(map(pct) | join(", ")) (examples 2, 3, discs 2, 3); the closed form of a ball's contact, which is not the paper's (exact, balls): \($balls[1:] | gain("exact") | map(pct) | join(", "))",
     verdict(count(. > 0.2); 4), "timed" ])
| @tsv
