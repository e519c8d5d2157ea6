# page.jq: the gallery's README.md from all result.json (-s); $about: the experiments' .json, by name

include "rows";

def cell: if . == null then "none" else tostring end;
def range_of: if .low == .high then "\(.low)" elif .high == null then "at least \(.low)" elif .low == null then "at most \(.high)" else "\(.low) to \(.high)" end;
def found: (.found | cell) + if .error then " ± \(.error)" else "" end;
def source: .source + if .read then "" else " \\*" end;

"# The gallery", "",
"Experiments of granular physics, each a script of nsd\u0027s tools, jq and gnuplot. `make gallery` runs them all" +
" (`QUICK=1`: small, in minutes). A value is the mean over the seeds, with its standard error. It **differs** where the mean lies outside the accepted range," +
" which is that of the published values and their error bars, written down before the runs. \\* marks a source that was not read for this page: its value is quoted from memory or from another text.", "",
"\(map(.rows[]) | length) comparisons: \(map(.rows[] | select(.holds)) | length) lie in the range, \(map(.rows[] | select(.holds | not)) | length) differ.", "",
(sort_by($about[.name].order) | .[] | $about[.name] as $a |
    "## \($a.title)", "", $a.text, "",
    "    " + $a.pipeline, "",
    (if .quick then "*A small run, as with `QUICK=1`.*", "" else empty end),
    "![\($a.title)](\(.name)/picture.png)", "", "![its curve](\(.name)/curve.png)", "",
    "| quantity | found | accepted | | published | source |", "|---|---|---|---|---|---|",
    (.rows[] | "| \(.what) | \(found) | \(range_of) | \(if .holds then "holds" else "**differs**" end) | \(.published) | \(source) |"),
    (if $a.remark then "", $a.remark else empty end), "")
