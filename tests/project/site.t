#!/usr/bin/env bash
# make site: no link, anchor or picture leads nowhere; in a browser as wide as a telephone no page is wider than the screen
# or has an error, and the search finds.
# shellcheck source=tests/support/tap.sh disable=SC2317 # functions called by name
. tests/support/tap.sh

unset MAKEFLAGS MFLAGS MAKELEVEL
for tool in mandoc cmark-gfm; do
    command -v "$tool" >/dev/null || { echo "1..0 # SKIP no $tool"; exit 0; }
done
read -ra manuals < <(make -s manuals-list | tail -n 1)
site() { scripts/site/site.py "$tmp/site" "${manuals[@]}"; }
ok "the site is made" site
faults() { /usr/bin/python3 tests/support/links.py "$tmp/site"; }
is "no link leads nowhere, and every page can be reached" "$(faults)" ""
is "it has every manual, with a list of its contents" \
    "$(for m in "${manuals[@]}"; do grep -q '<details class="contents"' "$tmp/site/man/${m##*/}.html" || echo "$m"; done)" ""
is "every recipe" "$(for r in cookbook/*/about; do [ -s "$tmp/site/${r%/about}.html" ] || echo "$r"; done)" ""
is "whose tasks name recipes" "$(cut -d : -f 2 cookbook/tasks | tr ' ' '\n' | grep . | while read -r r; do [ -e "cookbook/$r/about" ] || echo "$r"; done)" ""
is "and every drawing is on a page" \
    "$(for d in docs/drawings/*.svg; do grep -rqF "${d##*/}" "$tmp/site" --include=*.html || echo "$d"; done)" ""

# ---- the drawings ----

ok "the drawings are made" scripts/drawings/make.py "$tmp/drawings"
ok "docs/drawings has them (else: make drawings)" diff -r --exclude=README.md "$tmp/drawings" docs/drawings
shown() { cat "$tmp/drawings"/*.svg | sed 's/<[^>]*>//g' | grep -ohE -e "$1" | sort -u; } # what is written on them
nsd-gen --keys | cut -f 2 | sort -u >"$tmp/keys"
is "keys of scenes on them exist" "$(shown '"[a-z_]+"' | tr -d '"' | comm -23 - "$tmp/keys")" ""
for tool in step solve gen; do "nsd-$tool" --help; done | grep -oE -e '--[a-z-]+' | sort -u >"$tmp/options"
is "and options" "$(shown '--[a-z]+[a-z-]*' | comm -23 - "$tmp/options")" ""
is "and tools" "$(for t in $(shown 'nsd-[a-z]+'); do [ -e "man/$t.1" ] || echo "$t"; done)" ""
is "and parts of a document" "$(sed -n '/Mono/s/<[^>]*>//gp' "$tmp/drawings/document.svg" | tr -d ' .' | tr ',' '\n' | grep '[a-z]' |
    while read -r part; do grep -qE "/$part(/|\$| )" man/nsd-format.5 || echo "$part"; done)" ""

# ---- links ----

# a fault of each kind is found
cp -r "$tmp/site" "$tmp/kept"
sed -i 's|</main>|<a href="gone.html">x</a><a href="INSTALL.html#gone">x</a><img src="gone.png" alt=""></main>|' "$tmp/site/index.html"
is "links that lead nowhere are found" "$(faults | sed 's/.*: no/no/' | paste -sd,)" "no such file,no such place,no such file"
rm -r "$tmp/site" && mv "$tmp/kept" "$tmp/site"
is "a folder that is not a site stays" "$(mkdir "$tmp/mine" && touch "$tmp/mine/file" && scripts/site/site.py "$tmp/mine" "${manuals[@]}" 2>&1 | grep -c 'is not a site'; ls "$tmp/mine")" "1
file"
mkdir "$tmp/bare" && for f in env python3; do ln -s "/usr/bin/$f" "$tmp/bare"; done
status 69 "without a tool it ends with 69" env PATH="$tmp/bare" scripts/site/site.py "$tmp/other" man/nsd.7
like "and names the package" "$(cat "$tmp/err")" "apt-get install cmark-gfm"

# ---- in a browser ----

browse() # PAGE ...: what tests/support/site.html finds; errors of the console
{
    printf '"file://%s",\n' "$@" | sed '1s/^/var pages = [/; $s/,$/];/' >"$tmp/pages.js"
    cp tests/support/site.html "$tmp/browse.html"
    timeout 300 chromium --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --allow-file-access-from-files --user-data-dir="$tmp/profile" \
        --virtual-time-budget=600000 --enable-logging=stderr --dump-dom "file://$tmp/browse.html" 2>"$tmp/console" | sed -n '/<pre id="found">/,/<\/pre>/p' | sed 's/<[^>]*>//g; /^$/d'
    grep -o 'CONSOLE.*' "$tmp/console" || true
}
if command -v chromium >/dev/null; then
    mapfile -t pages < <(find "$tmp/site" -name '*.html' | sort)
    like "in a browser: no page is wider than a telephone, no picture is missing, no error; the search finds" "$(browse "${pages[@]}" | paste -sd';')" \
        "^search max-sweeps: man/nsd-[a-z]+[.]1[.]html#max-sweeps;search drum angle: [a-z]+/[^;]*drum[^;]*;search no-such-word-anywhere: ;all pages: ${#pages[@]}$"
    sed 's|</main>|<img src="gone.png" alt=""><p style="width: 900px">wide</p><script>noSuchFunction()</script></main>|' "$tmp/site/index.html" >"$tmp/site/bad.html"
    is "and faults are found" "$(browse "$tmp/site/bad.html" | grep -oE 'no picture|wider than a telephone|noSuchFunction is not defined' | sort -u | paste -sd,)" \
        "no picture,noSuchFunction is not defined,wider than a telephone"
else
    skip "in a browser" "no chromium"
fi
done_testing
