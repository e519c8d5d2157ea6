#!/usr/bin/env bash
# keys.sh PAGE: a manual page with the keys that nsd-gen --keys prints. In place of a line
#
#   .\" keys TABLE ...     come the keys of these tables [lib/scene/keys.h], each with its type, unit, help, default and example
#   .\" index              comes an index of all keys, with the section and the page that have them
#
# The other pages with such lines lie in the same folder; "see TITLE" in a line of help refers to a section of one of them.
set -euo pipefail
export LC_ALL=C

page=$1
mapfile -t pages < <(grep -l '^\.\\" keys ' "$(dirname "$page")"/*)
nsd-gen --keys | awk -F '\t' -v page="$page" '
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
    function manual(file) { sub(/.*\//, "", file); sub(/\./, " ", file); return file } # as .Xr has it
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
        for (title in home)
            if ((at = index(s, "see " title)) && substr(s, at + 4 + length(title), 1) ~ /[.,;]/) {
                rest = substr(s, at + 4 + length(title))
                if (home[title] == page) { full(substr(s, 1, at + 2)); request("Sx", title, substr(rest, 1, 1)) }
                else { full(substr(s, 1, at + 3) "\"" title "\" in"); request("Xr", manual(home[title]), substr(rest, 1, 1)) }
                rest = substr(rest, 2); sub(/^ +/, "", rest); sentence(rest)
                return
            }
        full(s)
    }
    function sentences(s,    rest)
    {
        while (match(s, /[.?!] +[A-Z0-9"{]/)) { rest = substr(s, RSTART + RLENGTH - 1); sentence(substr(s, 1, RSTART)); s = rest }
        sentence(s)
    }
    function block(names,    n, name, i, t)
    {
        n = split(names, name, " "); print ".Bl -tag -width Ds"
        for (t = 1; t <= n; t++) {
            if (!rows[name[t]]) { print "no table " name[t] >"/dev/stderr"; exit failed = 1 }
            for (i = 1; i <= rows[name[t]]; i++) {
                print ".It Va " field[name[t], i, 1] " Pq " cell(field[name[t], i, 2]) (field[name[t], i, 3] == "-" ? "" : ", " cell(field[name[t], i, 3]))
                sentences(field[name[t], i, 6])
                if (field[name[t], i, 4] !~ /^(-|none)$/) print "[" plain(field[name[t], i, 4]) "]"
                if (field[name[t], i, 5] !~ /^(-|see below)$/) print "Example:\n.Ql " cell(field[name[t], i, 5])
            }
        }
        print ".El"
    }
    function print_index(    t, k, i, j, s, last, part, seen, entry, entries, pending) # by key, section
    {
        for (t in section) for (k = 1; k <= rows[t]; k++) {
            s = field[t, k, 1] "\t" section[t]
            if (!(s in seen)) { seen[s]; for (j = entries++; j && entry[j] > s; j--) entry[j + 1] = entry[j]; entry[j + 1] = s }
        }
        print ".Bl -tag -width \"allow_overlap\" -compact"
        for (i = 1; i <= entries; i++) {
            split(entry[i], part, "\t")
            if (part[1] != last) print ".It Va " (last = part[1])
            pending = i < entries && index(entry[i + 1], last "\t") == 1 ? "," : ""
            if (part[3] == page) request("Sx", part[2], pending)
            else { print part[2] " in"; request("Xr", manual(part[3]), pending) }
        }
        print ".El"
    }
    FILENAME == "-" && FNR > 1 { n = ++rows[$1]; for (k = 2; k <= 7; k++) field[$1, n, k - 1] = $k; next }
    FILENAME == "-" { next }
    FNR == 1 { title = "" }
    /^\.S[sh] / { title = substr($0, 5); home[title] = FILENAME }
    /^\.\\" keys / { n = split(substr($0, 10), name, " "); for (k = 1; k <= n; k++) section[name[k]] = title "\t" FILENAME }
    FILENAME == page { line[++lines] = $0 }
    END {
        if (failed) exit 1
        for (l = 1; l <= lines; l++)
            if (line[l] ~ /^\.\\" keys /) block(substr(line[l], 10))
            else if (line[l] == ".\\\" index") print_index()
            else print line[l]
    }' - "${pages[@]}"
