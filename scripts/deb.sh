#!/usr/bin/env bash
# deb.sh: Debian packages of the sources as they are here (git's, with what is not committed), in build/deb
set -euo pipefail
cd "$(dirname "$0")/.."

version=$(sed -n 's/^VERSION := //p' Makefile)
out=build/deb source=build/deb/nsd-tools-$version
for needed in dpkg-buildpackage dh; do
    command -v $needed >/dev/null || { echo "deb: no $needed: apt-get install build-essential debhelper" >&2; exit 69; }
done

rm -rf "$out"
mkdir -p "$source"
git ls-files -z --cached --others --exclude-standard | xargs -0 cp --parents -t "$source" 2>/dev/null || {
    # no git: a released tree
    find . -path ./build -prune -o -path ./demo -prune -o -type f -print0 | xargs -0 cp --parents -t "$source"
}
(cd "$source" && DEB_BUILD_OPTIONS="nocheck noautodbgsym parallel=$(nproc) ${DEB_BUILD_OPTIONS-}" dpkg-buildpackage -b -us -uc) >"$out/log" 2>&1 || {
    tail -n 20 "$out/log" >&2
    exit 1
}
rm -rf "$source"
ls "$out"/*.deb
