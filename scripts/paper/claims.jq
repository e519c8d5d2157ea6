# The paper's claims: a name, what it says and prints, what we find, whether it holds, as TSV. Slurped: the
# runs; --rawfile times, closed; --slurpfile same. The column "timed" tells which rows differ from machine
# to machine. A claim is tested by its own words in every case that we have: it holds in all of them, in
# part in some, and does not hold in none.
include "stats";

def pick($scene; $settings; $method): map(select(.scene == $scene and .settings == $settings and .method == $method and .box == null));
def verdict($holds; $of): if $holds == $of then "holds" elif $holds == 0 then "does not hold" else "holds in part" end;
def verdict(f): verdict(map(select(f)) | length; length);
def list: join(", ");
def percents: "\(min * 100 | round) to \(max * 100 | round) %";

. as $runs
| ($times | rows | group_by([.what, .run])
   | map({ key: "\(.[0].what) \(.[0].run)", value: (sort_by(.round | tonumber) | map(.seconds | tonumber)) }) | from_entries) as $cpu
| ($closed | rows | map({ method, dt: (.dt | tonumber), x: (.error_x | tonumber), v: (.error_v | tonumber),
    late: ((.late // "") | if . == "" then null else tonumber end) })) as $exact
# nsd's settings on balls; the paper's on discs, where they converge
| [["example1", "nsd"], ["example2", "nsd"], ["example3", "nsd"]] as $balls
| [["example1-2d", "paper"], ["example2-2d", "paper"], ["example3-2d", "paper"]] as $discs
| ($balls + $discs) as $all
| ($balls[1:] + $discs[1:]) as $piles # examples 2 and 3
| def runs_of($case; $m): $runs | pick($case[0]; $case[1]; $m)
      | map(select($case[0][7:8] == "2" or .seed == null)) | sort_by(.seed);
  # A method's time over another's: round by round, of example 2 also seed by seed
  def over($what; $case; $m; $base): [runs_of($case; $m)[].run | $cpu["\($what) \(.)"] as $own
      | $cpu["\($what) \(sub("_\($m)"; "_\($base)"))"] as $other
      | range([$own, $other] | map(length) | min) | $own[.] / $other[.]] | stat;
  def whole($case; $m): over("whole"; $case; $m; "sbp");
  def faster($name; $m; $says; $paper):
    [ "\($name) faster than SBP", "\($name) needs less CPU time than SBP, by \($says) % (\($paper) of its time in examples 1, 2, 3)",
      "its time over SBP's: balls \($balls | map(whole(.; $m) | spread(2)) | list); discs \($discs | map(whole(.; $m) | spread(2)) | list). 500 sweeps of one problem of example 3: balls \(over("sweeps"; $balls[2]; $m; "sbp") | spread(2)), discs \(over("sweeps"; $discs[2]; $m; "sbp") | spread(2))",
      ($all | map(whole(.; $m).mid) | verdict(. < 1)), "timed" ];
  # One and the same problem for both: the first's penetration over the second's, what is below the rounding of
  # these velocities (m/s) raised to it
  def rounding: 1e-17;
  def same($scene; $m): $same | map(select(.scene == $scene and .method == $m)) | sort_by(.pile);
  def ratio($scene; $key; $a; $b): [same($scene; $a), same($scene; $b)] | transpose
      | map((.[0][$key] | if . < rounding then rounding else . end) / (.[1][$key] | if . < rounding then rounding else . end)) | stat;
  def four: "example2", "example3", "example2-2d", "example3-2d";
  def believed($a; $b): [four | ratio(.; "max_penetration"; $a; $b)];
  def moved($a; $b): [four | ratio(.; "max_penetration_true"; $a; $b)];
  def share($m; $term): [$piles[] as $case | runs_of($case; $m) | map(if .eps_glob > 0 then .[$term] / .eps_glob else 1 end) | stat];
  def shares($m; $term): share($m; $term) | map("\(.mid * 100 | round) %\(if .n > 1 then " (\(.low * 100 | round) to \(.high * 100 | round))" else "" end)") | list;
  def table4($dim; $settings; $m): $runs | map(select(.alpha and .dim == $dim and .settings == $settings and .method == $m))
      | sort_by(-(.alpha | tonumber));
  def at($alpha): map(select(.alpha == $alpha))[0];
  def most_over_least: (max / min);

[ "name", "claim", "found", "verdict", "timed" ],

([ ($exact | map(select(.late) | .late / .dt) | max), ($exact | map(.v) | max),
   ($exact | map(select(.method == "exact") | .x / (.dt * .dt) / (0.7 * 9.81 / 8)) | max)]
 | [ "sliding, then rolling", "example 1: the ball slides, then rolls without slipping",
     "rolling begins at 2 v0/(7 mu g), at most \(.[0] | digits(2)) dt late; speeds at the ends of the steps right to \(.[1] | digits(2)) m/s, places to \(.[2] | digits(2)) mu g dt^2/8",
     verdict([.[0] <= 1, .[1] < 1e-9, .[2] <= 1.01] | map(select(.)) | length; 3), "" ]),

([$balls[0], $discs[0] | (runs_of(.; "eal"), runs_of(.; "ebp"))[0].most_sweeps]
 | [ "EAL's single sweep in example 1", "example 1: EAL converges after the first sweep of every step",
     "most sweeps of a step: EAL \(.[0]) (balls), \(.[2]) (discs); EBP \(.[1]), \(.[3])", ([.[0], .[2]] | verdict(. == 1)), "" ]),

faster("SAL"; "sal"; "2, 2 and 11"; "0.98, 0.98 and 0.89"),
faster("EBP"; "ebp"; "6, 11 and 22"; "0.94, 0.89 and 0.78"),
faster("EAL"; "eal"; "7, 17 and 16"; "0.93, 0.83 and 0.84"),

([$balls[:2][], $discs[:2][] | [over("whole"; .; "eal"; "sbp", "sal", "ebp")] | max_by(.mid)]
 | [ "EAL the fastest in examples 1 and 2", "EAL is the fastest in examples 1 and 2",
     "its time over that of the fastest of the other three: \(map(spread(2)) | list) (examples 1, 2, discs 1, 2); up to 1.03 counts, which is what medians repeat to",
     verdict(.mid <= 1.03), "timed" ]),

([$balls[1], $discs[1] | . as $case | [runs_of($case; "sal"), runs_of($case; "sbp")] | transpose | map(.[0].total_sweeps / .[1].total_sweeps) | stat]
 | [ "SBP and SAL alike in example 2", "example 2: SBP and SAL give very similar results",
     "SAL's sweeps over SBP's, whole runs of ten seeds: balls \(.[0] | spread(2)), discs \(.[1] | spread(2))",
     verdict(.mid > 0.8 and .mid < 1.25), "" ]),

([believed("sbp"; "ebp"), moved("sbp"; "ebp")] as [$own, $true]
 | [ "EBP's penetration 5 times smaller than SBP's", "EBP's penetration is 5 times smaller than SBP's (in example 3's table 7 times)",
     "the same problems given to both: in the local solve \($own | map(spread) | list) times (examples 2, 3, discs 2, 3); of the motion \($true | map(spread) | list) times",
     ($own + $true | verdict(.mid >= 5)), "" ]),

([believed("ebp"; "eal"), moved("ebp"; "eal")] as [$own, $true]
 | [ "EAL's penetration far smaller than EBP's", "EAL's penetration is far smaller than EBP's (2e-20 instead of 6e-13 in example 2, 4e-18 instead of 3e-7 in example 3)",
     "the same problems given to both, EBP's over EAL's: in the local solve \($own | map(spread) | list) times (examples 2, 3, discs 2, 3; less than 1e-17 m/s counts as that, the rounding of such velocities); of the motion \($true | map(spread) | list) times. Far smaller: at least 1000 times",
     ($own + $true | verdict(.mid >= 1000)), "" ]),

([four | same(.; "eal")] as $eal
 | [ "EAL's penetration very small", "EAL's penetration is very small (2e-20, 4e-18)",
     "in the local solve at most \($eal | map(map(.max_penetration) | max | digits(1)) | list) m/s; of the motion up to \($eal | map(map(.max_penetration_true) | max | digits(1)) | list) m/s (examples 2, 3, discs 2, 3)",
     (($eal | map(map(.max_penetration) | max)) + ($eal | map(map(.max_penetration_true) | max)) | verdict(. < 1e-15)), "" ]),

[ "SBP, SAL: penetration governs the error", "SBP, SAL: the error is governed by penetration",
  "its share of eps_glob: SBP \(shares("sbp"; "penetration")); SAL \(shares("sal"; "penetration")) (examples 2, 3, discs 2, 3)",
  (share("sbp"; "penetration") + share("sal"; "penetration") | verdict(.mid > 0.5)), "" ],

[ "EBP, EAL: motion governs the error", "EBP, EAL: the error is governed by motion",
  "its share of eps_glob: EBP \(shares("ebp"; "motion")); EAL \(shares("eal"; "motion")) (examples 2, 3, discs 2, 3)",
  (share("ebp"; "motion") + share("eal"; "motion") | verdict(.mid > 0.5)), "" ],

([$all[] as $case | "sbp", "sal", "ebp", "eal" | runs_of($case; .)[] | select(.eps_glob > 0) | .proj / .eps_glob]
 | [ "the projection's error very small", "the error from the projection is very small for all methods",
     "at most \(max | digits(2)) of eps_glob", verdict(. < 0.01), "" ]),

([["example2", "nsd"], ["example2-2d", "nsd"], ["example2", "paper"], ["example2-2d", "paper"]]
 | map([. as $case | "sbp", "sal", "ebp", "eal" | runs_of($case; .) | map(.missed)])
 | [ "every solve of example 2 converges", "example 2: every solve converges within 5000 sweeps",
     "steps missed of 1000, ten seeds, SBP, SAL, EBP, EAL: nsd's settings, balls \(.[0] | map(stat | counts) | list); discs \(.[1] | map(stat | counts) | list); the paper's, balls \(.[2] | map(stat | counts) | list); discs \(.[3] | map(stat | counts) | list)",
     verdict(flatten | max == 0), "" ]),

([(["example3", "nsd"], ["example3-2d", "nsd"]) as $case | "sbp", "sal", "ebp", "eal", "exact" | runs_of($case; .)[0].eps_glob]
 | [ "no method reaches 1e-12 in example 3", "example 3: no method reaches 1e-12 within the cap at the last step",
     "eps_glob there: \(map(digits(2)) | list) (balls SBP, SAL, EBP, EAL, exact; discs the same)",
     verdict(. > 1e-12), "" ]),

([table4(3, 2; "plain"; "ebp"), table4(3, 2; "line"; "ebp")] | map(map(.total_sweeps) | most_over_least)
 | [ "rho hardly matters to EBP", "EBP: rho hardly matters (table 4: alpha from 1/5 to 5)",
     "sweeps of the whole run, most over least: plain Newton \(.[0] | digits(2)) (balls), \(.[1] | digits(2)) (discs); with line search \(.[2] | digits(2)), \(.[3] | digits(2))",
     verdict(. < 2), "" ]),

([table4(3, 2; "plain"; "ebp")] | map([at("0.5"), at("0.2")])
 | [ "EBP slow where alpha is small", "EBP: with alpha small it converges, but slowly",
     "alpha 1/5: steps not converged \(map(.[1].missed) | map(tostring) | list); sweeps over those of alpha 1/2: \(map(.[1].total_sweeps / .[0].total_sweeps | digits(2)) | list) (balls, discs)",
     ((map(.[1].missed == 0) + map(.[1].total_sweeps > 1.2 * .[0].total_sweeps)) | verdict(.)), "" ]),

([3, 2] | map(table4(.; "line"; "sbp", "sal"))
 | [ "SBP and SAL very sensitive to rho", "SBP and SAL: very sensitive to rho",
     "steps not converged at alpha 1/2: \(map(at("0.5").missed | tostring) | list), at 1: \(map(at("1").missed | tostring) | list); sweeps at 1/5 over those at 1/2: \(map(at("0.2").total_sweeps / at("0.5").total_sweeps | digits(2)) | list) (SBP, SAL, discs SBP, SAL)",
     verdict(at("1").missed > at("0.5").missed), "" ]),

([3, 2] | map([table4(.; "plain"; "ebp", "eal") | map(.missed) | add])
 | [ "EAL much more sensitive to alpha than EBP", "EAL is much more sensitive to alpha than EBP",
     "steps of table 4 not converged, plain Newton, EBP and EAL: balls \(.[0] | map(tostring) | list); discs \(.[1] | map(tostring) | list); with line search \([table4(3, 2; "line"; "ebp", "eal") | map(.missed) | add | tostring] | list)",
     verdict(.[1] > 2 * .[0]), "" ]),

([3, 2] | map(table4(.; "line"; "sbp", "sal") | at("5"))
 | [ "SBP and SAL diverge at alpha = 5", "at alpha = 5 SBP and SAL no longer converge",
     "steps not converged of \(.[0].steps): balls \(.[0].missed), \(.[1].missed); discs \(.[2].missed), \(.[3].missed) (SBP, SAL); the first steps have no contact",
     verdict(.missed > 0.8 * .steps), "" ]),

([3, 2] | map(table4(.; "line"; "sbp", "sal"))
 | [ "rho < 2 rho_bar is enough", "rho < 2 rho_bar ensures convergence (SBP, SAL)",
     "steps that SBP misses by alpha: balls \(.[0] | map("\(.alpha): \(.missed)") | list); discs \(.[2] | map("\(.alpha): \(.missed)") | list); needed is rho lambda_max < 2, that is alpha < 4/7 (balls), 2/3 (discs)",
     verdict(at("1").missed == 0), "" ]),

([$balls[2], $discs[2] | over("whole"; .; "ebp"; "eal")]
 | [ "EBP faster than EAL in example 3", "example 3: EBP is faster than EAL (0.93 of its time)",
     "its time over EAL's: balls \(.[0] | spread(2)), discs \(.[1] | spread(2)). 500 sweeps of one problem: \([$balls[2], $discs[2] | over("sweeps"; .; "ebp"; "eal") | spread(2)] | list)", verdict(.mid < 1), "timed" ]),

([$piles[] | [whole(.; "ebp", "eal")] | min_by(.mid)]
 | [ "Newton gains more than 20 %", "Newton improves the time by more than 20 %",
     "time of the better of EBP and EAL over SBP's: \(map(spread(2)) | list) (examples 2, 3, discs 2, 3); the closed form of a ball's contact, which is not the paper's (exact, balls): \($balls[1:] | map(whole(.; "exact") | spread(2)) | list)",
     verdict(.mid < 0.8), "timed" ])
| @tsv
