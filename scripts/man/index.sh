#!/usr/bin/env bash
# man-index.sh MANUAL ...: the page that leads to the manuals' HTML, by sections
set -euo pipefail

echo '<!DOCTYPE html>
<html>
<head>
  <meta charset="utf-8"/>
  <meta name="viewport" content="width=device-width, initial-scale=1.0"/>
  <link rel="stylesheet" href="style.css" type="text/css" media="all"/>
  <title>nsd: manuals</title>
</head>
<body>
<h1 class="Sh">The manuals of nsd</h1>
<p>Begin with <a href="nsd.7.html">nsd(7)</a>.</p>
<table>'
for section in 7 5 1; do
    for manual in "$@"; do
        [ "${manual##*.}" = $section ] || continue
        page=$(basename "$manual")
        what=$(sed -n 's/^\.Nd //p' "$manual")
        echo "<tr><td><a href=\"$page.html\">${page%.*}($section)</a></td><td>$what</td></tr>"
    done
done
echo '</table>
</body>
</html>'
