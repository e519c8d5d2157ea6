# page.jq: the gallery's README.md from all result.json (-s) and about.json

include "rows";

def cell: if . == null then "none" elif type == "number" then tostring else . end;
def range_of: if .low == .high then "\(.low)" else "\(.low) to \(.high)" end;

($about | map({(.name): .}) | add) as $of |
"# The gallery", "",
"Experiments that granular physicists do, each a script of nsd\u0027s tools, jq and gnuplot: `make gallery` runs them all" +
" (`QUICK=1`: small, in minutes). Each result is compared with published values. The range is our acceptance interval, wider than the published one to allow for small systems;" +
" rows outside it are marked **differs**. Sections marked as a small run were run at reduced size.", "",
"\(map(.rows[]) | length) comparisons, \(map(.rows[] | select(.holds)) | length) within their range.", "",
(sort_by(.name) | sort_by($of[.name].order) | .[] | $of[.name] as $a |
    "## \($a.title)", "", $a.text, "",
    "    " + $a.pipeline, "",
    (if .quick then "*A small run, as with `QUICK=1`.*", "" else empty end),
    "![\($a.title)](\(.name)/picture.png)", "", "![its curve](\(.name)/curve.png)", "",
    "| what | found | range | | published | source |", "|---|---|---|---|---|---|",
    (.rows[] | "| \(.what) | \(.found | cell) | \(range_of) | \(if .holds then "holds" else "**differs**" end) | \(.published) | \(.source) |"),
    (if $a.remark then "", $a.remark else empty end), "")
