# page.jq: the gallery's README.md from table.json; $about, $results, $references as for table.jq

include "rows";

def value: if . == null or .found == null then "–" else "\(.found)" + (if .error then " ± \(.error)" else "" end) end;
def range_of: if .kind == "no range" then "" elif .low == .high then "\(.low)" elif .high == null then "at least \(.low)" elif .low == null then "at most \(.high)" else "\(.low) to \(.high)" end;
def published: if .kind == "no range" then "none" elif .kind == "identity" then "\(range_of): momentum"
  else range_of as $range | (if .published | startswith($range) then .published else $range + " (\(.published))" end) + ": \(.source)" + (if .read then "" else ", not read" end) end;
def say: if .kind == "identity" then "identity" elif .verdict == "not yet run" then "not yet run"
  elif .kind == "not read" or .kind == "no range" then "remark" elif .kind == "one bound" then "\(.verdict), one bound"
  elif .verdict == "differs" then "**differs**" else .verdict end;
def codes: if .codes == "differ" then " (the codes differ)" else "" end;
def count(f): map(select(f)) | length;
def judged: .kind == "judged" and .verdict != "not yet run";
def hours($all): [$all[].runs[]?.cpu // empty] | add // 0 | . / 3600 | digits(2);

. as $table |
"# The gallery", "",
"Experiments of granular physics, each a script of nsd\u0027s tools, jq and gnuplot. Each row below compares a value of nsd with a published one and, where it can be run, with" +
" an independent code: `bench/reference/dem.c`, soft discs and balls with springs, dashpots and tangential memory, explicit in time, with overlaps of 1e-4 to 1e-2 diameters," +
" from the same starts and by the same measures; balls in tubes by LIGGGHTS with Hertz\u0027s contacts. Values are means over the seeds with their standard errors.", "",
"- A value **differs** where it lies outside the published range by more than two of its own standard errors. The codes differ where their values are apart by more than two standard errors of the difference.",
"- A range from a source whose text was not read is a *remark*: it judges nothing. Identities of momentum and rows with one bound judge nothing either.",
"- *Not yet run*: the set-up has changed since the last run; the value in brackets is that of the set-up before.", "",
"\(length) rows. \(count(judged)) are judged: \(count(judged and .verdict != "differs")) agree with what is published, \(count(judged and .verdict == "differs")) differ." +
" \(count(.kind == "not read")) have a range whose source was not read, \(count(.kind == "identity")) are identities, \(count(.kind == "one bound")) have one bound, \(count(.kind == "no range")) none; \(count(.kind == "judged" and .verdict == "not yet run")) would be judged and are not yet run (\(count(.verdict == "not yet run")) of all rows)." +
" The independent code has a value in \(count(.independent and .kind != "identity")) rows that are no identities: in \(count(.codes == "same")) both codes agree, in \(count(.codes == "differ")) they differ" +
(if any(.[]; .codes == "unknown") then ", in \(count(.codes == "unknown")) a run has one seed only and no error" else "" end) + (count(.independent and .codes == null and .kind != "identity") as $n | if $n > 0 then "; in \($n) nsd\u0027s own value is not yet run" else "" end) + "." +
(count(judged and .verdict == "differs" and .codes == "same") as $n | if $n > 0 then " The independent code has nsd\u0027s value in \($n) of the rows that differ." else "" end), "",
"`make gallery` makes all experiments again by nsd, `make gallery-reference` by the independent code, both at full size (`QUICK=1`: small, in minutes);" +
" `make gallery-keep` puts the results here, and `make gallery-page` writes this page from them. The runs below whose cost was recorded took \(hours($results)) (nsd) and \(hours($references)) (independent code) CPU hours.", "",
"Single forces of a pile by both codes, their distribution and their chains side by side: [docs/forces](../forces/README.md). Impacts of several balls at once by both codes: nsd-methods(7), Impact.", "",
"| experiment | quantity | nsd | independent code | published | verdict | cause |", "|---|---|---|---|---|---|---|",
(.[] | "| [\(.title)](#\(.title | ascii_downcase | gsub("[^a-z0-9 -]"; "") | gsub(" "; "-"))) | \(.what) | \(if .previous then "(\(value))" else value end) | \(if .independent then .independent | value else "–" end)\(codes) | \(published) | \(say) | \(.cause // "") |"), "",
"Where the independent code has no value:", "",
($table | map(select(.why)) | group_by(.why)[] | (map(.title) | unique) as $titles | "- \(.[0].why): \($titles | join(", "))" + " (\(length) row\(if length > 1 then "s" else "" end))"), "",
($about | to_entries | sort_by(.value.order)[] | .key as $e | .value as $a | $results[$e] as $r | $references[$e] as $i |
    "## \($a.title)", "", $a.text, "",
    "    " + $a.pipeline, "",
    (if $r.quick then "*A small run, as with `QUICK=1`.*", "" else empty end),
    (if any($r.rows[]; .previous) or (($r.runs | length) > 1 and any($r.runs[]; .part == null)) then "*The pictures are those of an earlier run, before the set-up changed.*", "" else empty end),
    "![\($a.title)](\($e)/picture.png)", "", "![its curve](\($e)/curve.png)", "",
    ([($r.runs[]? | (if .part then "Part *\(.part)*: " else "" end) + (if .options == "--small-steps 0" then "One solve per step" elif .options == "" then "Small steps, the default" else .options end) +
        (if .account then ". Deepest overlap \(.account.overlap) radii; \(.account.unconverged) of \(.account.steps) steps did not converge" else "" end) + (if .cpu then "; \(.cpu / 3600 | digits(2)) CPU hours." else "." end)),
      ($i.runs[]? | "Independent code\(if .part then ", part *\(.part)*" else "" end): `\(.options)`" + (if .account then ", deepest overlap \(.account.overlap) radii" else "" end) + (if .cpu then "; \(.cpu / 3600 | digits(2)) CPU hours." else "." end))] | join(" ")),
    (if $a.remark then "", $a.remark else empty end), "")
