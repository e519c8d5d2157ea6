#!/usr/bin/env bash
# keep.sh FROM TO NAME: the result.json of FROM, if there is one, as TO/NAME.json, and its pictures. The run of a part replaces its rows.
set -euo pipefail
P=$(dirname "$0") from=$1 to=$2 name=$3
[ -f "$from/result.json" ] || exit 0
mkdir -p "$to"
[ -f "$to/$name.json" ] || echo null >"$to/$name.json"
jq -L "$P" --slurpfile kept "$to/$name.json" 'include "rows"; merged($kept[0])' "$from/result.json" >"$to/$name.json.new"
mv "$to/$name.json.new" "$to/$name.json"
if [ "$name" = result ]; then
    for f in picture.png curve.png; do [ ! -f "$from/$f" ] || install -m 644 "$from/$f" "$to/$f"; done
fi
