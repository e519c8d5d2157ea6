#!/usr/bin/env bash
# What is made of other files, and kept, is current; versions agree.
# shellcheck source=tests/tap.sh disable=SC2317 # functions called by name
. tests/tap.sh

if [ -n "$quick" ]; then
    echo "1..0 # SKIP the plain run looks at the documents"
    exit 0
fi
unset MAKEFLAGS MFLAGS MAKELEVEL

if command -v mandoc >/dev/null; then
    mkdir -p "$tmp/copy/scripts" "$tmp/copy/docs/man"
    cp -a man Makefile "$tmp/copy"
    cp -a scripts/man-index.sh "$tmp/copy/scripts"
    cp docs/man/style.css "$tmp/copy/docs/man"
    ok "make docs" make -s -C "$tmp/copy" docs
    is "docs/man is what it makes" "$(diff -rq docs/man "$tmp/copy/docs/man")" ""
    dead() # links to pages or places that are not there
    {
        local f page
        for f in docs/man/*.html; do
            grep -o 'href="[^"]*"' "$f" | sed 's/href="\(.*\)"/\1/' | sort -u | while read -r page; do
                case $page in
                http*) ;;
                \#*) grep -qF "id=\"${page#\#}\"" "$f" || echo "$f: $page" ;;
                *) [ -e "docs/man/${page%%#*}" ] || echo "$f: $page" ;;
                esac
            done
        done
    }
    is "no link leads nowhere" "$(dead)" ""
else
    skip "docs/man" "no mandoc"
fi

version=$(sed -n 's/^VERSION := //p' Makefile)
is "the tools' version" "$(nsd-gen --version)" "nsd-gen (nsd) $version"
is "CITATION.cff's" "$(sed -n 's/^version: "\(.*\)"/\1/p' CITATION.cff)" "$version"
is "CHANGELOG.md's" "$(sed -n 's/^## //p' CHANGELOG.md | head -n 1)" "$version"
is "the package's" "$(sed -n '1s/.*(\(.*\)).*/\1/p' debian/changelog)" "$version"
done_testing
