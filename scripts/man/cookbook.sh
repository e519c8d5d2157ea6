#!/usr/bin/env bash
# cookbook.sh DIR ...: nsd-cookbook(7), made of the directories of recipes (cookbook/README.md); one without about is none
set -euo pipefail
export LC_ALL=C

# Text of a paragraph, a line per sentence, without what roff would take for a request or an escape
text() { sed -E 's/([.?!]) +([A-Z])/\1\n\2/g' | sed -e 's/\\/\\e/g' -e "s/^[.']/\\\\\&&/" -e 's/[[:space:]]*$//' -e '/^$/d'; }
literal() { sed -e 's/\\/\\e/g' -e "s/'/\\\\(aq/g" -e 's/\^/\\(ha/g' -e 's/~/\\(ti/g' -e 's/`/\\(ga/g' -e 's/^\./\\\&./' -e 's/[[:space:]]*$//'; }
# A heading: a word like the name of a macro is none
heading() { sed -E 's/(^| )([A-Z][a-z]{1,2})( |$)/\1\\\&\2\3/g'; }
shown() # FILE: as a display
{
    echo ".Bd -literal -offset indent"
    literal <"$1"
    echo ".Ed"
}

cat <<'EOT'
.Dd November 27, 2026
.Dt NSD-COOKBOOK 7
.Os nsd
.Sh NAME
.Nm nsd-cookbook
.Nd recipes: a scene and a pipeline for each task
.Sh DESCRIPTION
Each recipe is a directory of
.Pa cookbook
.Pq installed in share/nsd/cookbook ,
with the scene and the script that are printed here.
Copy the directory and run the script there:
.Bd -literal -offset indent
cp -r cookbook/drum /tmp; cd /tmp/drum; bash run.sh
.Ed
.Pp
Every recipe runs within seconds at the size that is printed, and a test of nsd runs it.
.Xr nsd-tutorial 7
explains the steps of one recipe in detail.
EOT
# the index by task: cookbook/tasks, and what it does not name
row() { echo ".It Pa $1 Ta $(head -n 1 "cookbook/$1/about" | text)"; }
unnamed() { for d in "$@"; do d=$(basename "$d"); grep -qE "[ :]$d( |\$)" cookbook/tasks || printf ' %s' "$d"; done; }
while IFS=: read -r task names; do
    [ -n "$names" ] || continue
    echo ".Ss $task"
    echo '.Bl -column "restart-other-parameters" "title"'
    for name in $names; do [ ! -e "cookbook/$name/about" ] || row "$name"; done
    echo ".El"
done < <(cat cookbook/tasks && echo "Other recipes:$(unnamed "$@")")
echo ".Sh RECIPES"
for d in "$@"; do
    [ -e "$d/about" ] || continue
    echo ".Ss $(head -n 1 "$d/about" | heading)"
    tail -n +2 "$d/about" | text
    for f in "$d"/scene.json "$d"/*; do
        name=${f##*/}
        [ -f "$f" ] || continue
        case $name in
        about | run.sh | check.sh | README*) continue ;;
        scene.json) [ -z "${seen-}" ] || continue; seen=1 ;;
        esac
        echo ".Pp"
        if [ "$(wc -l <"$f")" -gt 45 ] || [ "$(wc -L <"$f")" -gt 200 ]; then
            echo ".Pa cookbook/$(basename "$d")/$name : $(wc -l <"$f") lines."
        else
            echo ".Pa $name :"
            shown "$f"
        fi
    done
    unset seen
    echo ".Pp"
    echo ".Pa run.sh :"
    sed -e '/^#!/d' -e '/^# shellcheck/d' -e '/^set -euo pipefail$/d' "$d/run.sh" >"${TMPDIR:-/tmp}/cookbook.$$"
    shown "${TMPDIR:-/tmp}/cookbook.$$"
    rm "${TMPDIR:-/tmp}/cookbook.$$"
done
cat <<'EOT'
.Sh SEE ALSO
.Xr nsd-gen 1 ,
.Xr nsd-step 1 ,
.Xr nsd-scene 5 ,
.Xr nsd 7 ,
.Xr nsd-tutorial 7
EOT
