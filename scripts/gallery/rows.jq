# rows.jq: small sums, and the rows of an experiment's table.

def mean: if length == 0 then null else add / length end;
def median: sort | if length == 0 then null else (.[(length - 1) / 2 | floor] + .[length / 2 | floor]) / 2 end;
# to so many digits
def digits($n):
  if . == null or . == 0 then . else pow(10; $n - 1 - (fabs | log10 | floor)) as $k | (. * $k | round) / $k end;

# [[x, y], ...]: the least squares' line y = a + b x, and how much of the variance it explains
def line:
  (map(.[0]) | mean) as $x | (map(.[1]) | mean) as $y |
  (map((.[0] - $x) * (.[0] - $x)) | add) as $xx | (map((.[0] - $x) * (.[1] - $y)) | add) as $xy |
  (map((.[1] - $y) * (.[1] - $y)) | add) as $yy |
  { a: ($y - $xy / $xx * $x), b: ($xy / $xx), r2: (if $yy > 0 then $xy * $xy / ($xx * $yy) else 1 end) };
# the same of their logarithms: y = a x^b
def power: map(map(log)) | line | .a |= exp;

# the rows of numbers of a table, separated by blanks or tabs
def numbers: split("\n") | map(select(test("^[-0-9]")) | split("[ \t]"; null) | map(tonumber));

# a table with a line of names, separated by tabs, as nsd-stat --tsv writes it
def table: split("\n") | map(select(. != "") | split("\t")) | .[0] as $names | .[1:] |
  map([., $names] | transpose | map({(.[1]): (.[0] | tonumber? // null)}) | add);

# the standard error of the mean of independent values; null of one
def error: length as $n | if $n < 2 then null else mean as $m | (map((. - $m) * (. - $m)) | add / ($n * ($n - 1)) | sqrt) end;
# [[x, y], ...] of several seeds: [[x, mean of y, its standard error, number of values], ...] by x
def spread: group_by(.[0]) | map([.[0][0], (map(.[1]) | mean), (map(.[1]) | error), length]);

# A finding, for the row KEY of the experiment's table: one number, or one for each seed
def row($key; $found):
  ($found | if type == "array" then . else [.] end | map(select(. != null))) as $v |
  { key: $key, found: ($v | mean | digits(4)), error: ($v | error | digits(2)), seeds: ($v | length) };

# Findings of a run, and those that were kept: a run of a part replaces its rows only
def merged($kept): . as $new | ($new.runs[0].part) as $part |
  if $kept == null or $part == null then . else .runs = ($kept.runs | map(select(.part != $part))) + $new.runs |
    .rows = ($kept.rows | map(select(.key as $k | all($new.rows[]; .key != $k)))) + $new.rows end;

# what a row says. A row judges nothing ("remark") whose range is from a source that was not read, that is an identity, or
# that has one bound or none. A value differs from a range beyond two of its standard errors only.
def kind: if .source == "momentum" then "identity" elif .low == null and .high == null then "no range" elif .read | not then "not read"
  elif .low == null or .high == null then "one bound" else "judged" end;
def beyond($v; $low; $high): if $low != null and $v < $low then $low - $v elif $high != null and $v > $high then $v - $high else 0 end;
def verdict($found; $low; $high):
  if $found == null or $found.found == null or $found.previous then "not yet run"
  else beyond($found.found; $low; $high) as $off | if $off == 0 then "agrees" elif $off <= 2 * ($found.error // 0) then "within two errors" else "differs" end end;
# of two codes
def compared($a; $b):
  if $a.found == null or $b.found == null or $a.previous then null
  else ($a.found - $b.found | fabs) as $off | (pow($a.error // 0; 2) + pow($b.error // 0; 2) | sqrt) as $error |
    if $off <= 2 * $error or $off <= 1e-9 then "same" elif $a.error == null or $b.error == null then "unknown" else "differ" end end;
