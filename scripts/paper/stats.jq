# stats.jq: medians, ranges, and how many digits of them are worth printing.

def median: sort | if length == 0 then null
    elif length % 2 == 1 then .[length / 2 | floor]
    else (.[length / 2 - 1] + .[length / 2]) / 2 end;

def stat: map(select(. != null)) | { mid: median, low: min, high: max, n: length };

def round_to($x; $digits): if $x == 0 then 0
    else ($x | fabs | log10 | floor) as $e
    | pow(10; $digits - 1 - $e) as $scale
    | if $scale >= 1 then ($x * $scale | round) / $scale
      else ($x * $scale | round) * (pow(10; $e + 1 - $digits) | round) end end;

# $digits significant digits, as text: 0.85, 490, 2.4e-7
def digits($n): if . == null then "none" elif . == 0 then "0" else . as $x
    | ($x | fabs | log10 | floor) as $e
    | if $e >= -3 and $e < 5 then round_to($x; $n) | "\(.)"
      else ($x / pow(10; $e)) as $m | round_to($m; $n) | if fabs >= 10 then "1e\($e + 1)" else "\(.)e\($e)" end end end;

# One digit where the lowest and the highest are more than ten times apart, else two, and three
# where they are within 10 %
def carries: if .low == null or .low <= 0 then 1 elif .high > 10 * .low then 1 elif .high < 1.1 * .low then 3 else 2 end;

# "490 (30 to 2000)"; the range is left out where it has no width in these digits
def spread($d): (.mid | digits($d)) as $mid | (.low | digits($d)) as $low | (.high | digits($d)) as $high
    | if $low == $high then $mid else "\($mid) (\($low) to \($high))" end;
def spread: spread(if .n > 1 then carries else 2 end);

# Counts are whole
def counts: if .n > 1 and .low != .high then "\(.mid | round) (\(.low) to \(.high))" else "\(.mid)" end;

def rows: . / "\n" | map(select(. != "") / "\t") | .[0] as $name
    | .[1:] | map([$name, .] | transpose | map({ key: .[0], value: .[1] }) | from_entries);
