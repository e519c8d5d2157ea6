# table.jq: all rows of all experiments, nsd's value, that of the independent code, what is published, and what it says. $about:
# the experiments' .json by name; $results, $references: the result.json and reference.json of experiments, by name

include "rows";

[$about | to_entries | sort_by(.value.order)[] | .key as $e | .value as $a | $a.rows[] |
    .key as $key | ($results[$e].rows // [] | map(select(.key == $key))[0]) as $found |
    ($references[$e].rows // [] | map(select(.key == $key))[0]) as $other |
    . as $row |
    { experiment: $e, title: $a.title, key, what, found: $found.found, error: $found.error, seeds: $found.seeds, previous: ($found.previous // false),
      independent: (if $other.found == null then null else $other | {found, error, seeds} end),
      why: (if $other.found != null or ($row | kind) == "identity" then null elif $a.reference | type == "string" then $a.reference
        elif $row.alone then $row.alone else "not yet run" end),
      codes: (if ($row | kind) == "identity" then null else compared($found; $other) end), low, high, published, source, read, kind: kind,
      verdict: verdict($found; .low; .high), cause: (.cause // null) }]
