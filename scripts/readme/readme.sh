#!/usr/bin/env bash
# readme.sh: README.md, scripts/readme/README.in with the figures of figures.sh, the scene of a recipe, and what
# make demo ended with when docs/readme was kept. readme.sh keep: docs/readme anew, by running both.
set -euo pipefail
cd "$(dirname "$0")/../.."

demo() # DIR: the end of make demo
{
    scripts/demo.sh "$1/demo" 2>/dev/null | sed -n '/^the last steps/,$p' | sed "s|$1/||g"
}
drum() { nsd-gen cookbook/drum/scene.json | nsd-step -e --until 1.2 --every 0.2s 2>/dev/null | nsd-stat -m surface | jq -c '[.time, .surface.angle]'; }

case ${1-} in
demo | drum)
    tmp=$(mktemp -d)
    trap 'rm -rf "$tmp"' EXIT
    "$1" "$tmp"
    ;;
keep)
    for part in demo drum; do "$0" "$part" >"docs/readme/$part.txt"; done
    "$0" >README.md
    ;;
*)
    awk -F'\t' '
        FILENAME == ARGV[1] { value[$1] = $2; next }
        $0 == "@demo@" { while ((getline line <"docs/readme/demo.txt") > 0) print line; next }
        $0 == "@scene@" { while ((getline line <"cookbook/drum/scene.json") > 0) print line; next }
        {
            while (match($0, /@[a-z0-9_]+@/)) {
                name = substr($0, RSTART + 1, RLENGTH - 2)
                if (!(name in value)) { print "readme.sh: no figure " name >"/dev/stderr"; exit 65 }
                $0 = substr($0, 1, RSTART - 1) value[name] substr($0, RSTART + RLENGTH)
            }
            print
        }' <(scripts/readme/figures.sh) scripts/readme/README.in
    ;;
esac
