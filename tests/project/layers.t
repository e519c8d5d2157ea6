#!/usr/bin/env bash
# The folders of lib/ depend on each other as the table of lib/README.md says: a file includes files of its own folder and of
# those that the table allows, without a circle; each header begins with its own name and what it is for.
# shellcheck source=tests/support/tap.sh
. tests/support/tap.sh

# "| base | what lives there | shape contact |" is a row; what an allowed folder may include is allowed, too.
table() { awk -F'|' '/^\| [a-z]+ \|.*\|/ && !/folder/ { gsub(/ /, "", $2); print $2, $4 }' lib/README.md; }
mapfile -t folders < <(table | awk '{ print $1 }')
modules() { find lib -name '*.[ch]' | sed 's/\.[ch]$//' | sort -u; }
includes() { sed -n 's/^ *# *include "\(.*\)"$/\1/p' "$@"; } # of files, "folder/name.h" per line

no_folder() { find lib -name '*.[ch]' | awk -F/ -v folders=" ${folders[*]} " 'NF != 3 || !index(folders, " " $2 " ")'; }
nameless() # headers that do not begin with their name
{
    local f
    for f in lib/*/*.h; do
        head -n 2 "$f" | grep -q -e "${f#lib/}: " -e "^ \* $(basename "$f"): " || echo "$f"
    done
}
foreign() # includes of ours that are no file of a folder
{
    local f i
    for f in lib/*/*.[ch]; do
        for i in $(includes "$f"); do [ -f "lib/$i" ] || echo "$f: $i"; done
    done
}
forbidden() # includes that the table does not allow
{
    local f
    for f in lib/*/*.[ch]; do
        includes "$f" | sed "s,^,$f ,"
    done | awk '
        function allow(a, b, n, w, i) { if ((a, b) in may) return; may[a, b] = 1; n = split(row[b], w, " "); for (i = 1; i <= n; i++) allow(a, w[i]) }
        NR == FNR { a = $1; $1 = ""; row[a] = $0; next }
        FNR == 1 { for (a in row) allow(a, a) }
        { split($1, f, "/"); split($2, i, "/"); if (!((f[2], i[1]) in may)) print $1 ": " $2 }' <(table) -
}
circles() # in folder $1, by modules: x.h and x.c are one
{
    local m i
    for m in $(modules | grep "^lib/$1/"); do
        for i in $(includes "$m".[ch] | grep "^$1/"); do
            [ "lib/${i%.h}" = "$m" ] || echo "$m lib/${i%.h}"
        done
    done | { tsort >/dev/null; } 2>&1
}

nothing() # COMMAND ...: prints nothing
{
    "$@" >"$tmp/said" 2>&1 || true
    [ ! -s "$tmp/said" ] || { cat "$tmp/said"; return 1; }
}

is "the table has thirteen folders" "${#folders[@]}" 13
ok "every file is in one of them" nothing no_folder
ok "every header begins with its name and what it is for" nothing nameless
ok "every include of ours names a file by its folder" nothing foreign
ok "no include is one that the table does not allow" nothing forbidden
for folder in "${folders[@]}"; do
    ok "no circle in $folder/" nothing circles "$folder"
done
done_testing
