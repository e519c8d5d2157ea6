#!/usr/bin/env bash
# Manuals, README.md, the pages of the repository and --help use the terms of the field: none has a wording that the
# project's guide to English rejects.
# shellcheck source=tests/support/tap.sh disable=SC2317,SC2016 # functions called by name; text for eval
. tests/support/tap.sh

mapfile -t keyed < <(grep -l '^\.\\" keys ' man/*)
make -s build/man/nsd-cookbook.7 "${keyed[@]/#/build/}" >/dev/null
# name<TAB>what is wrong<TAB>what to write
cat >"$tmp/rejected" <<'EOT'
\b(cells?|edges?|walls?) that repeats?\b	periodic
\b(boundar(y|ies)|walls?|edges?|cells?) (that|which) yields?\b|\byields? to (a|the) (load|stress|force)	load-controlled, stress-controlled
\b(boundar(y|ies)|walls?|drums?|gates?) that (turns?|swings?|vanish(es)?)\b	rotating, oscillating, removable
\bcomes? and go(es)?\b|\bcome (and|or) gone\b|\btaken away\b	inlet, outlet, added, removed
\bgoes on\b|\bgo on\b	resume, continue
\btell each other\b	communicate, exchange
\ban? (line|file|run|frame|picture|thread|row|document|body|task|contact) an? (step|frame|run|task|file|body|ball|contact|sweep|pair|grain|line|page|second|lane)\b	one ... per ...
\b(sweeps?|seconds?|bytes?|steps?|figures?) an? (sweep|step|second|contact|ball|body|corner)\b	per
\b(and )?not [0-9][0-9.e-]*( s| ms|%| sweeps)?[;.,]	instead of
\bbeside\b	compared with, next to, in addition to
\b(says|said|saying|tells|told)\b	report, print, write, state
\busual(ly)?\b	default
\bmend(s|ed|ing)?\b	correct, repair
\b(is|are|was|were) there\b	exists, is available
\banew\b	again
\b(turns?|revolutions?) an? minute\b	rpm
\b(CPU|minutes?|hours?) an? (evaluation|run|drum)\b	per
\bsome [0-9]	about
\b(believes?|believed|patience|riddle|knows?|wants?)\b	needs, expects; programs do not believe, know or want
\bfor ever\b|\bgo(es)? round\b	without end, cycle
(^|[^o]) that there (is|are)\b	that exists
\bis no (ball|plane|disc|mesh|array|JSON)\b|\bare no (balls|planes|discs)\b	is not a ball
\bas (a|the) paper (says|has it)\b	as in the paper
EOT
text() # FILE: without what is typed, examples and requests
{
    awk '
        /^\.\\"/ { next }
        /^\.Bd -literal/ { off = 1 } /^\.Ed/ { off = 0; print ""; next } off { print ""; next }
        /^```/ { fence = !fence; print ""; next } fence || /^    / { print ""; next }
        /^\.(D1|Dl|Xr|Pa|Va|Ev|Fl|Cm|%)/ { print ""; next }
        { gsub(/`[^`]*`/, "x"); print }' "$1"
}
found() # LABEL FILE: FILE:LINE: WORDING: what to write
{
    local wrong right
    while IFS=$'\t' read -r wrong right; do
        text "$2" | grep -niE "$wrong" | sed "s|^|$1:|; s|\$|   -> $right|"
    done <"$tmp/rejected"
}
riddles() # FILE: sentences that begin with What, Which or Of and do not ask
{
    text "$1" | grep -v '^#' | grep -E '(^|[.;:!?] |^[-*] |\| )(What|Which|Of) [^?]*$'
}
pages=(man/* "${keyed[@]/#/build/}" README.md INSTALL.md LIMITATIONS.md CONTRIBUTING.md SECURITY.md CHANGELOG.md paper.md
    bench/README.md lib/README.md tests/README.md cookbook/README.md cookbook/*/about docs/*/README.md)
for page in "${pages[@]}"; do is "$page" "$(found "$page" "$page")$(riddles "$page")" ""; done
for tool in tools/*.c; do
    tool=$(basename "$tool" .c)
    "$tool" --help | sed '/^  nsd-/,$d; s/^      */ /' >"$tmp/help"
    is "$tool --help" "$(found "$tool --help" "$tmp/help")" ""
    is "$tool --help: option texts start with a verb" \
        "$("$tool" --help | grep -E '^ +(-., )?--[a-z-]+ ?[^ ]*  +' | sed -E 's/^ +(-., )?(--[a-z-]+)( [^ ]+)*  +/\2: /' | grep -E ': (of|what|how|a|an|the|and|or|with|without|only|instead|its|their|these|also) ' | grep -vE ': also (keep|write|plot) |: with N' || true)" ""
done
items() # of OPTIONS, that begin with no verb
{
    sed -n '/^\.Sh OPTIONS/,/^\.Sh /p' "$1" | awk '/^\.It Fl/ { item = $0; getline; if (/^(of|what|how|a|an|the|only|instead|its|their|these|without) /) print item ": " $0 }'
}
for page in man/*.1; do is "$page: an option begins with a verb" "$(items "$page")" ""; done

# ---- messages: literals of the library, the tools and the Python module ----
messages() # with a wording that programs do not have
{
    git ls-files 'lib/*.c' 'tools/*.c' |
        xargs perl -ne 'while (/"((?:\\.|[^"\\])*)"/g) { print "$ARGV: $1\n" if $1 =~ /\b(wants?|knows?|believes?|yields|anew|beside)\b/ }'
}
is "no message wants, knows or yields" "$(messages)" ""

printf 'A boundary that turns goes on, beside a cell that repeats.\n' >"$tmp/bad"
is "the wordings are found" "$(found bad "$tmp/bad" | wc -l)" 4
printf 'What springs push lasts.\nWhat is a spring?\nOf ten, one. It lasts. Which of them is open.\n# What to know\n' >"$tmp/bad"
is "and sentences that begin with What, Which or Of" "$(riddles "$tmp/bad" | wc -l)" 2
printf '.Sh OPTIONS\n.It Fl d\nof the N balls\n.Sh X\n' >"$tmp/bad"
is "and options without a verb" "$(items "$tmp/bad" | wc -l)" 1
done_testing
