#!/usr/bin/env bash
# Each recipe of cookbook/ runs as nsd-cookbook(7) prints it, in bounded time, and its check holds.
# shellcheck source=tests/support/tap.sh disable=SC2317 # functions called by name
. tests/support/tap.sh

export PYTHON=/usr/bin/python3 PYTHONPATH=$PWD/python NSD_LIBRARY=${NSD_LIBRARY-$PWD/build/libnsd.so.2}
processor=60 bound=900 # s: of the processor, for each program of a recipe; of the clock, other tests run meanwhile

described() # DIR: a title, and two to eight lines about it
{
    awk 'NR == 1 && (!length($0) || /[.]$/) { bad = 1 } /^[ \t]*$/ || length($0) > 200 { bad = 1 } END { exit bad || NR < 3 || NR > 9 }' "$1/about"
}
runs() # NAME: in a copy, to the end, within the bound; it leaves a table or a picture
{
    cp -r "cookbook/$1" "$tmp/$1"
    (cd "$tmp/$1" && ulimit -t "$processor" && nice -n 5 timeout "$bound" bash run.sh >stdout 2>stderr) || return
    [ -s "$tmp/$1/stdout" ] || find "$tmp/$1" -name '*.png' -size +2k | grep -q .
}
whole() # NAME: its pictures are pictures, and its tables have numbers
{
    local f
    for f in "$tmp/$1"/*.png; do
        [ ! -e "$f" ] || [ "$(head -c 8 "$f" | od -An -tx1 | tr -d ' \n')" = 89504e470d0a1a0a ] || return
    done
    for f in "$tmp/$1"/*.tsv; do
        [ ! -e "$f" ] || { [ -s "$f" ] && ! grep -qiE '(^|[[:space:]])(nan|inf|null)([[:space:]]|$)' "$f"; } || return
    done
}
holds() { (cd "$tmp/$1" && bash check.sh >check.out 2>&1); }

for d in cookbook/*/; do
    [ -n "$(ls "$d")" ] || continue # left by git where a branch had more
    name=$(basename "$d")
    ok "$name: about has a title and some lines" described "$d"
    needs=$(grep -oE '\b(gnuplot|ffmpeg)\b' "$d/run.sh" | sort -u | head -n 1 || true)
    if [ -n "$needs" ] && ! command -v "$needs" >/dev/null; then
        skip "$name" "no $needs"
        continue
    fi
    if grep -q PYTHON "$d/run.sh" && ! have_h5py; then
        skip "$name" "no h5py"
        continue
    fi
    ok "$name: runs and leaves a table or a picture" runs "$name" || diag "$(tail -n 4 "$tmp/$name/stderr")" "$(tail -n 4 "$tmp/$name/stdout")"
    ok "$name: pictures and tables are whole" whole "$name"
    [ ! -e "$d/check.sh" ] || ok "$name: what it shows is right" holds "$name" || diag "$(cat "$tmp/$name/check.out")"
    rm -rf "${tmp:?}/$name"
done

# a result that is wrong is found
cp -r cookbook/mesh "$tmp/wrong"
is "a check fails where the result is another" "$(cd "$tmp/wrong" && printf '0.1\t0\n0.2\t7\n' >below.tsv && bash check.sh >/dev/null 2>&1 || echo found)" found
done_testing
