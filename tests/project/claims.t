#!/usr/bin/env bash
# What the pages claim holds: tests/project/claims has for each claim the words of the page, a command, and what it prints. The
# questions there are answered in two steps from README.md. make claims also runs the slow ones; NSD_CLAIMS=words runs none.
# shellcheck source=tests/support/tap.sh disable=SC2317,SC2016 # functions called by name; text for eval
. tests/support/tap.sh

export repository=$PWD problems
export scenes=$repository/scenes
mapfile -t keyed < <(grep -l '^\.\\" keys ' man/*)
make -s "${keyed[@]/#/build/}" >/dev/null

# ---- the files that commands name ----

cp cookbook/drum/scene.json "$tmp/drum.json"
(
    cd "$tmp" && exec 2>/dev/null
    nsd-gen drum.json | nsd-step -n 100 --every 10 --contacts -o run.h5
    nsd-gen 500 >pile.h5
    nsd-step --solver auto -n 700 --every 700 pile.h5 | nsd-cat --last >packing.h5
    nsd-detect packing.h5 >contacts.h5
    nsd-gen 100 | nsd-step --solver auto -n 600 --every 600 | nsd-cat --last >small.h5
)
scene_of() # MANUAL WORDS: the scene below these words of its EXAMPLES
{
    awk -v words="$2" '/^\.Sh EXAMPLES/ { on = 1 } on && index($0, words) { found = 1 } found && /^\.Ed/ { exit }
        found && block { gsub(/\\e/, "\\"); gsub(/\\\(dq/, "\""); print } found && /^\.Bd/ { block = 1 }' "$repository/man/$1"
}
worst() { nsd-step "$@" 2>&1 >worst.h5 | sed -n 's/.*worst: overlap \([^ ]*\).*/\1/p'; } # overlap of a run, radii
export -f scene_of worst

# ---- pages: their words without macros ----

words_of() # PAGE
{
    local page=$1
    [ -e "build/$page" ] && page=build/$page
    case $page in
    *man/*) sed -E 's/^\.\\".*//; s/^\.[A-Z%][A-Za-z0-9]* ?//; s/ (Ns|Pc|Po|Ta|No)( |$)/ /g; s/^Fl /-/; s/ Ta / /g; s/ Fl / -/g; s/\\\(aq/'"'"'/g; s/\\\(ha/^/g; s/\\\(dq/"/g; s/\\&//g; s/\\e/\\/g' "$page" ;;
    *) cat "$page" ;;
    esac | tr -s '[:space:]' ' ' | sed -E 's/ ([,.;:)])/\1/g; s/\( /(/g'
}
has() { words_of "$1" | grep -F -- "$2" >/dev/null; } # PAGE WORDS

# ---- the table ----

claim() # NAME PAGES COMMAND PRINTS, PAGES: PAGE: WORDS, one per line
{
    local page words first='' got
    while IFS= read -r words; do
        page=${words%%: *} words=${words#*: }
        ok "$page has: $words" has "$page" "$words"
        # the second step of a question: the row of README.md leads to this page
        [ -z "$first" ] || ok "README.md: $first: leads to $page" eval 'grep -F -- "$first" README.md | grep -qF "](${page/#man\/*/docs\/manual\/${page#man\/}.md})"'
        [ "$page" = README.md ] && [[ $1 == question* ]] && first=$words
    done <<<"$2"
    [ "${NSD_CLAIMS-}" != words ] || return 0
    case $1 in
    slow*) [ "${NSD_CLAIMS-}" = all ] || { skip "$3" "slow: make claims"; return; } ;;
    esac
    case $3 in
    *problems*) [ -d "$problems" ] || { skip "$3" "no FCLIB problems"; return; } ;;
    *mpirun*) [ -x "$repository/build/nsd-step-mpi" ] || { skip "$3" "no MPI"; return; } ;;
    esac
    got=$(cd "$tmp" && timeout 900 bash -o pipefail -c "$3" 2>&1 | paste -sd' ') || true
    like "$1: ${3:0:180}" "$got" "$4"
}
table() # FILE: claims, separated by empty lines
{
    local line name='' pages='' command='' prints=''
    while IFS= read -r line; do
        case $line in
        '#'*) ;;
        '* '*) name=${line#* } ;;
        '$ '*) command+=${command:+$'\n'}${line#* } ;;
        '> '*) prints=${line#* } ;;
        '') [ -z "$pages" ] || claim "$name" "$pages" "$command" "$prints"; name='' pages='' command='' prints='' ;;
        *) pages+=${pages:+$'\n'}$line ;;
        esac
    done < <(cat "$1" && echo)
}
if [ $# -gt 0 ]; then # claims.t PAGE: only its claims
    awk -v RS= -v ORS='\n\n' -v page="$1: " 'index("\n" $0, "\n" page)' tests/project/claims >"$tmp/claims"
else
    cp tests/project/claims "$tmp/claims"
fi
table "$tmp/claims"
printf '* false\nREADME.md: no such words anywhere\n$ echo 3\n> ^4$\n' >"$tmp/false"
ok "a claim that is not on its page, and one that does not hold, are found" eval '[ "$(NSD_CLAIMS='' table "$tmp/false" 2>/dev/null | grep -c "^not ok")" = 2 ]'
done_testing
