#!/usr/bin/env bash
# The house stands as lib/README.md draws it: every file is in a room, is named there, and includes only
# files of its own floor or of floors below, without a circle.
# shellcheck source=tests/support/tap.sh
. tests/support/tap.sh

# "## 5 problem" opens a floor; "- `sweep.h .c`" or "- `sweep.h`" names a module of it.
mapfile -t rooms < <(awk '/^## [0-9]+ / { print $3 }' lib/README.md)
modules() { find lib -name '*.[ch]' | sed 's/\.[ch]$//' | sort -u; }
no_room() { find lib -name '*.[ch]' | awk -F/ -v rooms=" ${rooms[*]} " 'NF != 3 || !index(rooms, " " $2 " ")'; }
unnamed() # modules that the README does not name in their room
{
    awk '/^## [0-9]+ / { room = $3 } /^- `/ { n = split($0, w, "`"); for (i = 2; i < n; i += 2) { split(w[i], name, "."); print "lib/" room "/" name[1] } }' lib/README.md | sort -u |
        comm -3 - <(modules)
}
# "FILE ROOM/NAME.h": every include of ours, found once
awk 'match($0, /^ *# *include "[^"]*"$/) { sub(/^[^"]*"/, ""); sub(/"$/, ""); print FILENAME, $0 }' lib/*/*.[ch] >"$tmp/includes"

foreign() # includes of ours that are no file of a room
{
    local f i
    while read -r f i; do [ -f "lib/$i" ] || echo "$f: $i"; done <"$tmp/includes"
}
upwards()
{
    awk 'FNR == NR { if (/^## [0-9]+ /) floor[$3] = $2; next }
        { split($1, at, "/"); split($2, of, "/"); if (!(of[1] in floor) || floor[of[1]] > floor[at[2]]) print $1 ": " $2 }' \
        lib/README.md "$tmp/includes"
}
circles() # in room $1, by modules: x.h and x.c are one
{
    awk -v room="$1" '{ split($1, at, "/"); split($2, of, "/"); sub(/[.][ch]$/, "", $1); sub(/[.]h$/, "", $2) }
        at[2] == room && of[1] == room && $1 != "lib/" $2 { print $1, "lib/" $2 }' "$tmp/includes" | { tsort >/dev/null; } 2>&1
}

nothing() # COMMAND ...: prints nothing
{
    "$@" >"$tmp/said" 2>&1 || true
    [ ! -s "$tmp/said" ] || { cat "$tmp/said"; return 1; }
}

ok "there are floors" [ "${#rooms[@]}" -ge 9 ]
ok "every file is in a room" nothing no_room
ok "lib/README.md names every module, and no other" nothing unnamed
ok "every include of ours names a file by its room" nothing foreign
ok "no include looks up" nothing upwards
for room in "${rooms[@]}"; do
    ok "no circle in $room/" nothing circles "$room"
done
done_testing
