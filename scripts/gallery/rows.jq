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

# of places where discs of 1 cm end, the last before a gap of more than a disc: what touches on is part of the heap
def front: sort | first(range(1; length) as $i | select(.[$i] - .[$i - 1] > 0.013) | .[$i - 1]) // .[-1];

# a table with a line of names, separated by tabs, as nsd-stat --tsv writes it
def table: split("\n") | map(select(. != "") | split("\t")) | .[0] as $names | .[1:] |
  map([., $names] | transpose | map({(.[1]): (.[0] | tonumber? // null)}) | add);

# A row: what is compared, what was found, between what it should be, and what says so
def row($what; $found; $low; $high; $published; $source):
  { what: $what, found: ($found | if type == "number" then digits(3) else . end),
    holds: ($found != null and $found >= $low and $found <= $high),
    low: $low, high: $high, published: $published, source: $source };
