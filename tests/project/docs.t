#!/usr/bin/env bash
# Manuals are whole, say what --help says, and refer to what there is; versions agree.
# shellcheck source=tests/support/tap.sh disable=SC2317 # functions called by name
. tests/support/tap.sh

unset MAKEFLAGS MFLAGS MAKELEVEL

# ---- the text of a manual, without a program that renders it ----

# Macros that manuals use; the last two columns: what opens, and what closes it
structure() # FILE: what is wrong with it
{
    awk '
        BEGIN {
            split("Dd Dt Os Sh Ss Nm Nd Op Fl Ar Cm Pp Dl Bd Ed Bl It El Xr Pa Ql Sq Dq Em Sy Va Ev Li Ns D1 Pq Bq Aq Ic No Ta Lk Mt An Rs Re %A %B %T %J %V %N %P %D %I %U %O Eq Po Pc Oo Oc Bo Bc Fo Fc Ft Fa Fn In Vt Sm Ad Ex Rv St Tn Ux Brq Ao Ac So Sc Do Dc Qq Ap Bk Ek Bf Ef Fd Dv Er Ms Cd Sx", w, " ")
            for (i in w) known[w[i]] = 1
        }
        function complain(what) { print FILENAME ":" FNR ": " what }
        /^\.\\"/ { next }
        /^\.[ \t]*$/ { next }
        /^[.]/ {
            macro = $1; sub(/^\./, "", macro)
            if (!(macro in known)) complain("no such macro: " $1)
            if (macro == "Bl" || macro == "Bd") { stack[++depth] = macro; if ($2 !~ /^-/) complain($1 " without its kind") }
            if (macro == "El" || macro == "Ed") {
                want = macro == "El" ? "Bl" : "Bd"
                if (!depth || stack[depth] != want) complain($1 " closes nothing"); else depth--
            }
            if (macro == "It" && stack[depth] != "Bl") complain(".It outside a list")
            if (macro == "Sh" || macro == "Ss") { if (depth) complain($0 " within a list or a display"); depth = 0 }
            if (macro == "Sh") { sub(/^\.Sh /, ""); heads = heads $0 ";" }
            if ((macro == "Xr" && (NF < 3 || $3 !~ /^[0-9]$/)) || (macro == "Fl" && NF < 2)) complain($1 " wants a name")
            next
        }
        /^\.?[ \t]*$/ && stack[depth] != "Bd" && !table { complain("an empty line") }
        /[ \t]$/ { complain("a space at the end") }
        { n = split($0, parts, /\\/) } # \e, \(aq, \&, \fB, \- ...
        END {
            if (depth) complain("." stack[depth] " is not closed")
            if (heads !~ /^NAME;/ || heads !~ /;DESCRIPTION;/ || heads !~ /SEE ALSO;/) complain("headings: " heads)
            if (FILENAME ~ /1$/ && heads !~ /^NAME;SYNOPSIS;DESCRIPTION;.*EXIT STATUS;.*EXAMPLES;/) complain("headings: " heads)
        }' "$1"
}
for manual in man/*; do is "$manual: macros, lists and headings" "$(structure "$manual")" ""; done
broken() # LINE BECOMES: a manual with one fault
{
    sed "0,/$1/s//$2/" man/nsd-cat.1 >"$tmp/broken.1" && [ -n "$(structure "$tmp/broken.1")" ]
}
ok "a list that is not closed is found" broken '^\.El' '.Pp'
ok "and a misspelt macro" broken '^\.Nd' '.Nb'
ok "and a heading that is missing" broken '^\.Sh EXIT STATUS' '.Sh STATUS'

# ---- options, tools, pages ----

tools() { for t in tools/*.c; do basename "$t" .c; done; }
of_help() { "$1" --help | sed -n '/^Examples/q; s/^ *\(-., \)\{0,1\}\(--[a-z0-9-]*\).*/\2/p' | sort -u; }
of_manual() { sed -n '/^\.Sh OPTIONS/,/^\.Sh EXIT/s/^\.It //p' "$1" | grep '^Fl' | grep -oE ' -[a-z0-9][a-z0-9-]+' | sed 's/^ /-/' | sort -u; }
of_synopsis() { sed -n '/^\.Sh SYNOPSIS/,/^\.Sh DESCRIPTION/p' "$1" | grep -oE 'Fl -[a-z0-9][a-z0-9-]+' | sed 's/^Fl /-/' | sort -u; }
short_of_help() { "$1" --help | sed -n '/^Examples/q; s/^ *\(-.\), \(--[a-z0-9-]*\).*/\1 \2/p' | sort -u; }
short_of_manual() { sed -n '/^\.Sh OPTIONS/,/^\.Sh EXIT/s/^\.It Fl \(.\) , -\([a-z0-9-]*\).*/-\1 --\2/p' "$1" | sort -u; }
for tool in $(tools); do
    is "$tool(1) has the options of --help, and no other" "$(of_manual "man/$tool.1")" "$(of_help "$tool")"
    is "and no other in its synopsis" "$(comm -23 <(of_synopsis "man/$tool.1") <(of_help "$tool"))" ""
    is "and their letters" "$(short_of_manual "man/$tool.1")" "$(short_of_help "$tool")"
done
strangers() # references to pages of ours that do not exist
{
    local name section
    grep -ohE 'Xr nsd[a-z-]* [0-9]' man/* README.md | sort -u | while read -r _ name section; do
        [ -e "man/$name.$section" ] || echo "$name($section)"
    done
}
is "every manual that is referred to exists" "$(strangers)" ""

if command -v mandoc >/dev/null; then
    ok "make docs" make -s docs
    dead() # links to pages or places that are not there
    {
        local f page
        for f in build/man/*.html; do
            grep -o 'href="[^"]*"' "$f" | sed 's/href="\(.*\)"/\1/' | sort -u | while read -r page; do
                case $page in
                http*) ;;
                \#*) grep -qF "id=\"${page#\#}\"" "$f" || echo "$f: $page" ;;
                *) [ -e "build/man/${page%%#*}" ] || echo "$f: $page" ;;
                esac
            done
        done
    }
    is "no link of the HTML leads nowhere" "$(dead)" ""
else
    skip "the manuals as HTML" "no mandoc"
fi

# ---- links of the texts, versions ----

missing() # files that a text links to
{
    local f link
    for f in README.md CONTRIBUTING.md SECURITY.md tests/README.md docs/*/README.md; do
        grep -oE '\]\([^)#]+' "$f" | sed 's/](//' | grep -v '^http' | while read -r link; do
            [ -e "$(dirname "$f")/$link" ] || echo "$f: $link"
        done
    done
}
is "every file that a text links to exists" "$(missing)" ""
named() # tests that texts name
{
    git grep -ohE 'tests/[a-z]+/[a-z_]+(\.t|\.c|\.h|\.sh|\.py)' -- '*.md' '*.[ch]' man Makefile tests 2>/dev/null | sort -u |
        while read -r f; do [ -e "$f" ] || echo "$f"; done
}
is "every test that a text names exists" "$(named)" ""

version=$(sed -n 's/^VERSION := //p' Makefile)
is "the tools' version" "$(nsd-gen --version)" "nsd-gen (nsd) $version"
is "CITATION.cff's" "$(sed -n 's/^version: "\(.*\)"/\1/p' CITATION.cff)" "$version"
is "CHANGELOG.md's" "$(sed -n 's/^## //p' CHANGELOG.md | head -n 1)" "$version"
is "the package's" "$(sed -n '1s/.*(\(.*\)).*/\1/p' debian/changelog)" "$version"
done_testing
