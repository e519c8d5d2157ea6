#!/usr/bin/env bash
# pictures.sh [RECIPE ...]: runs these recipes of cookbook/, or all, and keeps the pictures that they leave in docs/cookbook/RECIPE,
# with 96 colours, which is a third of their size (package pngquant); the cookbook of the site shows them.
set -euo pipefail
cd "$(dirname "$0")/../.."
export PATH=$PWD/build:$PATH PYTHON=/usr/bin/python3 PYTHONPATH=$PWD/python NSD_LIBRARY=${NSD_LIBRARY-$PWD/build/libnsd.so.2}

tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
if [ $# = 0 ]; then mapfile -t names < <(cd cookbook && printf "%s\n" */about | sed "s|/about||"); set -- "${names[@]}"; fi
for name in "$@"; do
    cp -r "cookbook/$name" "$tmp/$name"
    (cd "$tmp/$name" && bash run.sh >run.out 2>run.err) || { echo "pictures.sh: $name: $(tail -n 1 "$tmp/$name/run.err")" >&2; exit 70; }
    rm -rf "docs/cookbook/$name"
    rm -f "$tmp/$name"/silhouette-*.png # of powder-drum, which drums.png has
    for f in "$tmp/$name"/*.png; do [ ! -e "$f" ] || pngquant --force --strip --ext .png 96 -- "$f"; done
    for f in "$tmp/$name"/*.png; do [ ! -e "$f" ] || install -D -m 644 -t "docs/cookbook/$name" "$f"; done
    rm -r "${tmp:?}/$name"
done
