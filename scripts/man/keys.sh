#!/usr/bin/env bash
# keys.sh <PAGE: a manual page with the tables of keys that nsd-gen --keys prints. In place of a line
#
#   .\" keys TABLE ...
#
# come the keys of these tables [lib/scene/keys.h]: in columns, and each with its line of help.
set -euo pipefail
export LC_ALL=C

page=$(mktemp)
trap 'rm -f "$page"' EXIT
cat >"$page"
nsd-gen --keys | awk -F '\t' '
    # what roff would take for a request, an escape or a macro
    function plain(s)
    {
        gsub(/\\/, "\\e", s); gsub(/"/, "\\(dq", s); gsub(/\^/, "\\(ha", s); gsub(/~/, "\\(ti", s); gsub(/\x27/, "\\(aq", s)
        return s
    }
    function cell(s) { s = plain(s); return s ~ /^[A-Z][a-z]$/ ? "\\&" s : s }
    function full(line) { if (line != "") print (line ~ /^[.]/ ? "\\&" : "") plain(line) }
    # a request for a reference, with the punctuation that follows
    function request(macro, what, after) { print "." macro " " what (after == "" ? "" : " " after) }
    function sentence(s,    word, rest, after, at, title)
    {
        if (match(s, /nsd-[a-z]+\([1-9]\)/)) {
            word = substr(s, RSTART, RLENGTH); rest = substr(s, RSTART + RLENGTH); s = substr(s, 1, RSTART - 1)
            after = ""
            if (match(rest, /^[,.;)]+/)) { after = substr(rest, 1, RLENGTH); rest = substr(rest, RLENGTH + 1) }
            if (s ~ /\($/) { s = substr(s, 1, length(s) - 1); sub(/ +$/, "", s); full(s); sub(/\)$/, "", after)
                print ".Pq Xr " substr(word, 1, index(word, "(") - 1) " " substr(word, length(word) - 1, 1) after }
            else { sub(/ +$/, "", s); full(s); request("Xr", substr(word, 1, index(word, "(") - 1) " " substr(word, length(word) - 1, 1), after) }
            sub(/^ +/, "", rest); sentence(rest)
            return
        }
        for (title in titles)
            if ((at = index(s, "see " title)) && substr(s, at + 4 + length(title), 1) ~ /[.,;]/) {
                rest = substr(s, at + 4 + length(title)); full(substr(s, 1, at + 2))
                request("Sx", title, substr(rest, 1, 1)); rest = substr(rest, 2); sub(/^ +/, "", rest); sentence(rest)
                return
            }
        full(s)
    }
    function sentences(s,    rest)
    {
        while (match(s, /[.?!] +[A-Z0-9"{]/)) { rest = substr(s, RSTART + RLENGTH - 1); sentence(substr(s, 1, RSTART)); s = rest }
        sentence(s)
    }
    function block(names,    n, name, i, k, t, wide, row, width, most)
    {
        n = split(names, name, " "); split("key\ttype\tunit\tdefault\texample", wide, "\t"); most = 0
        for (k = 1; k <= 5; k++) width[k] = length(wide[k])
        for (t = 1; t <= n; t++) {
            if (!rows[name[t]]) { print "no table " name[t] >"/dev/stderr"; exit failed = 1 }
            for (i = 1; i <= rows[name[t]]; i++)
                for (k = 1; k <= 5; k++) if (length(field[name[t], i, k]) > width[k]) width[k] = length(field[name[t], i, k])
        }
        row = ".Bl -column"
        for (k = 1; k <= 5; k++) row = row " \"" substr("mmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmmm", 1, width[k]) "\""
        print row; print ".It Em key Ta Em type Ta Em unit Ta Em default Ta Em example"
        for (t = 1; t <= n; t++)
            for (i = 1; i <= rows[name[t]]; i++) {
                row = ".It Va " cell(field[name[t], i, 1])
                for (k = 2; k <= 5; k++) row = row " Ta " cell(field[name[t], i, k])
                print row
            }
        print ".El"; print ".Bl -tag -width \"" substr("mmmmmmmmmmmmmmmmmmmm", 1, width[1] + 1) "\""
        for (t = 1; t <= n; t++)
            for (i = 1; i <= rows[name[t]]; i++) { print ".It Va " field[name[t], i, 1]; sentences(field[name[t], i, 6]) }
        print ".El"
    }
    FILENAME == "-" && FNR > 1 { n = ++rows[$1]; for (k = 2; k <= 7; k++) field[$1, n, k - 1] = $k; next }
    FILENAME == "-" { next }
    { if ($0 ~ /^\.S[sh] /) titles[substr($0, 5)]; line[++lines] = $0 }
    END {
        if (failed) exit 1
        for (l = 1; l <= lines; l++)
            if (line[l] ~ /^\.\\" keys /) block(substr(line[l], 10)); else print line[l]
    }' - "$page"
