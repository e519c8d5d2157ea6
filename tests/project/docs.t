#!/usr/bin/env bash
# Manuals are whole, say what --help says, and refer to what there is; versions agree.
# shellcheck source=tests/support/tap.sh disable=SC2317,SC2016 # functions called by name; text for eval
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
            if ((macro == "Xr" && (NF < 3 || $3 !~ /^[0-9]$/)) || (macro == "Fl" && NF < 2)) complain($1 " needs a name")
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
mapfile -t keyed < <(grep -l '^\.\\" keys ' man/*) # made: with the keys of scenes
ok "make: nsd-cookbook(7), and pages with keys of scenes" make -s build/man/nsd-cookbook.7 "${keyed[@]/#/build/}"
is "make demo begins without a complaint where no compiler is installed yet" \
    "$(make -n demo CC=no-such-compiler 2>&1 >/dev/null)" ""
mapfile -t pages < <(printf '%s\n' man/* build/man/nsd-cookbook.7 "${keyed[@]/#/build/}" | grep -vxFf <(printf '%s\n' "${keyed[@]}"))
for manual in "${pages[@]}"; do is "$manual: macros, lists and headings" "$(structure "$manual")" ""; done
broken() # LINE BECOMES: a manual with one fault
{
    sed "0,/$1/s//$2/" man/nsd-cat.1 >"$tmp/broken.1" && [ -n "$(structure "$tmp/broken.1")" ]
}
ok "a list that is not closed is found" broken '^\.El' '.Pp'
ok "and a misspelt macro" broken '^\.Nd' '.Nb'
ok "and a heading that is missing" broken '^\.Sh EXIT STATUS' '.Sh STATUS'

# ---- options, tools, pages ----

tools() { for t in tools/nsd-*; do basename "$t" .c; done; }
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
    grep -ohE 'Xr nsd[a-z-]* [0-9]' "${pages[@]}" README.md | sort -u | while read -r _ name section; do
        [ -e "man/$name.$section" ] || [ -e "build/man/$name.$section" ] || echo "$name($section)"
    done
}
is "every manual that is referred to exists" "$(strangers)" ""
quoted() # sections of other pages that a page names, as \(lqTITLE\(rq or .Em TITLE beside .Xr PAGE, and in lines of help, which do not exist
{
    {
        awk '{ sub(/\r$/, "") }
            /^\.Xr nsd[a-z-]* [0-9] ,$/ { page = $2 "." $3; next }
            page != "" && match($0, /^\\\(lq[^\\]*\\\(rq/) { print FILENAME "\t" page "\t" substr($0, 5, RLENGTH - 8) }
            { page = "" }' man/*.[1357]
        awk '/^\.Em / { title = substr($0, 5); next } title != "" && $0 == "in" { next }
            title != "" && /^\.Xr nsd[a-z-]* [0-9]/ { print FILENAME "\t" $2 "." $3 "\t" title } { title = "" }' man/*.[1357]
        nsd-gen --keys | grep -oE 'nsd-[a-z]+\([0-9]\), "[^"]*"' | sed 's/\(.*\)(\(.\)), "\(.*\)"/nsd-gen --keys\t\1.\2\t\3/'
    } | sort -u | while IFS=$'\t' read -r from page title; do
        grep -qxF -e ".Ss $title" -e ".Sh $title" -e ".Em $title ." "man/$page" || echo "$from: $title in $page"
    done
}
is "every section that a page names in another one exists" "$(quoted)" ""

# ---- nsd(7) and the pages of scenes are complete ----

is "nsd(7) lists every tool" "$(sed -n '/^\.Ss The tools/,/^\.Ss Conv/s/^\.It Xr \(nsd-[a-z]*\) 1$/\1/p' man/nsd.7 | sort)" "$(tools | sort)"
letters() # of --help: letter, option, tools
{
    local tool
    for tool in $(tools); do short_of_help "$tool" | sed "s/$/ ${tool#nsd-}/"; done |
        awk '{ k = $1 " " $2; at[k] = at[k] (at[k] ? ", " : "") $3 } END { for (k in at) print k, at[k] }' | LC_ALL=C sort
}
is "nsd(7) has a table of all letters, by option and tool" \
    "$(sed -n '/^\.Ss Letters/,/^\.Sh/s/^\.It Fl \(.\) Ta Fl \(-[a-z0-9-]*\) Ta /-\1 -\2 /p' man/nsd.7)" "$(letters)"
for page in "${pages[@]}"; do
    page=${page##*/}
    [ "$page" = nsd.7 ] || like "nsd(7) refers to $page" "$(grep -E '^\.(Xr|It Xr)' man/nsd.7 | tr '\n' ' ')" "Xr ${page%.*} ${page##*.} "
done
is "every page has one EXIT STATUS of one form" "$(for page in man/*.1; do
    sed -n '/^\.Sh EXIT STATUS/,/^\.Sh EXAMPLES/p' "$page" | sed -n '2p;3p;4p' | tr '\n' '|'; echo; done | sort -u)" \
    "$(printf '%s' '.Bl -tag -width Ds|.It 0|Success.|')"
quantities_of_list() # measure, quantity, unit, text
{
    nsd-stat --list | awk '/^[a-z]/ { sub(/:.*/, ""); measure = $0; next } /^  / { unit = substr($0, 23, 6); gsub(/ /, "", unit); sub(/^name$/, "", unit); print measure, $1, unit ":", substr($0, 30) }'
}
quantities_of_manual()
{
    sed -n '/^\.Sh MEASURES/,/^\.Sh FIELDS/{s/\\(aq/'"'"'/g; s/\\(ha/^/g; p}' man/nsd-stat.1 |
        awk '/^\.Ss/ { measure = $2 } /^\.It Va/ { unit = $5 $6; name = $3; getline; sub(/;$/, ""); print measure, name, unit ":", $0 }'
}
is "nsd-stat(1) has every quantity of --list, with unit and text" \
    "$(quantities_of_manual | LC_ALL=C sort)" "$(quantities_of_list | grep -vE '^wall_loads_by_name |^wall_loads_by_face ' | LC_ALL=C sort)"
# a circle has the keys of a sphere
is "nsd-scene(5), nsd-walls(5) and nsd-import(5) have the keys of every object, each once" \
    "$(sed -n 's/^\.\\" keys //p' "${keyed[@]}" | tr ' ' '\n' | sort)" "$(nsd-gen --keys | sed 1d | cut -f 1 | sort -u | grep -vx circle)"
twice() # keys that one list of a page has twice
{
    local page
    for page in "${keyed[@]}"; do
        awk -v page="$page" '/^\.Bl/ { split("", seen) } /^\.It Va / && $3 in seen { print page ": " $3 } /^\.It Va / { seen[$3] }' "build/$page"
    done
}
is "no list has a key twice" "$(twice)" ""
is "the index has every key" "$(sed -n '/^\.Sh INDEX/,/^\.Sh SEE/s/^\.It Va //p' build/man/nsd-scene.5 | sort -u)" "$(nsd-gen --keys | sed 1d | cut -f 2 | sort -u)"

# ---- the scenes of the pages' EXAMPLES, made and run for some steps ----

mkdir -p "$tmp/scenes"
examples() # PAGE: each scene into a file of its own
{
    awk -v to="$tmp/scenes/$(basename "$1")" '
        /^\.Sh / { on = $2 == "EXAMPLES" }
        on && /^\.Bd/ { getline; block = /^\{/; if (block) file = to "-" ++n ".json" }
        /^\.Ed/ { block = 0 }
        on && block { gsub(/\\e/, "\\"); gsub(/\\\(dq/, "\""); print >file }' "$1"
}
for page in "${keyed[@]}"; do examples "$page"; done
is "nsd-scene(5), nsd-walls(5) and nsd-import(5) have at least ten scenes as examples" "$(($(find "$tmp/scenes" -name "*.json" | wc -l) >= 10))" 1
(
    cd "$tmp/scenes"
    nsd-gen 100 | nsd-step -n 5 2>/dev/null >run.h5
    nsd-info -p run.h5 | jq -r '[.x[], .radius] | @tsv' | tail -n 100 | awk '{ $3 += 0.01; print }' >balls.txt
    box() { # triangles of a cube of 30, inside out: a vessel
        python3 -c '
import itertools
print("solid box")
for k, s in itertools.product(range(3), (0, 1)):
    u, v = [[0, 0, 0] for _ in range(2)]
    u[(k + 1) % 3] = v[(k + 2) % 3] = 30
    o = [0, 0, 0]; o[k] = 30 * s
    add = lambda *p: [sum(c) for c in zip(*p)]
    corners = [o, add(o, u), add(o, u, v), add(o, v)]
    if s: corners.reverse()
    for t in ((0, 1, 2), (0, 2, 3)):
        print("facet normal 0 0 0 outer loop", *("vertex %g %g %g" % tuple(corners[i]) for i in t), "endloop endfacet")
print("endsolid box")'
    }
    box >vessel.stl
)
for scene in "$tmp"/scenes/*.json; do
    ok "${scene##*/} is made and makes ten steps" eval 'nsd-gen "$scene" >"$tmp/scene.h5" && nsd-step -e -n 10 "$tmp/scene.h5" >"$tmp/steps.h5"'
done
is "nsd-tutorial(7)'s scene is the recipe's" "$(sed -n '/^{ "title"/,/^\.Ed/p' man/nsd-tutorial.7 | grep -v '^\.Ed')" "$(cat cookbook/drum/scene.json)"

# ---- links of the texts, versions ----

missing() # files that a text links to
{
    local f link
    for f in *.md tests/README.md cookbook/README.md docs/*/README.md; do
        grep -oE '\]\([^)#]+' "$f" | sed 's/](//' | grep -v '^http' | while read -r link; do
            [ -e "$(dirname "$f")/$link" ] || echo "$f: $link"
        done
    done
}
is "every file that a text links to exists" "$(missing)" ""
named() # tests that texts name
{
    git grep -ohE 'tests/[a-z]+/[a-z_]+(\.t|\.c|\.h|\.sh|\.py)\b' -- '*.md' '*.[ch]' man Makefile tests 2>/dev/null | sort -u |
        while read -r f; do [ -e "$f" ] || echo "$f"; done
}
is "every test that a text names exists" "$(named)" ""

read -ra manuals < <(make -s manuals-list | tail -n 1)
ok "the manuals are rendered" scripts/man/rendered.py "$tmp/manual" "${manuals[@]}"
is "docs/manual has them (else: make manuals-keep)" "$(diff -rq "$tmp/manual" docs/manual)" ""

version=$(sed -n 's/^VERSION := //p' Makefile)
is "the tools' version" "$(nsd-gen --version)" "nsd-gen (nsd) $version"
is "CITATION.cff's" "$(sed -n 's/^version: "\(.*\)"/\1/p' CITATION.cff)" "$version"
is "CHANGELOG.md's" "$(sed -n 's/^## //p' CHANGELOG.md | head -n 1)" "$version"
is "the package's" "$(sed -n '1s/.*(\(.*\)).*/\1/p' debian/changelog)" "$version"
done_testing
