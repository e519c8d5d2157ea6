# tap.sh: TAP for the shell tests: `. tests/support/tap.sh` first, `done_testing` last. They are run from the top of
# the tree, with build/ in PATH or not.
#
#   ok "what is true" COMMAND ...        is "what is true" GOT WANT        like "what is true" TEXT REGEX
#   status N "what is true" COMMAND ...  ends with N; its stdout is left in $tmp/out, stderr in $tmp/err
#   refuses N "what is true" COMMAND ... the same, says why in one line `tool: thing: trouble` (64: and a
#                                        usage line) and writes nothing to stdout
#
# COMMAND may be a shell function; inside, set -e does not count, so its steps are joined by &&.
# $tmp is a directory of the test's own. NSD_THIN=1, $thin: long loops make fewer rounds (sanitizers).
# shellcheck shell=bash

set -euo pipefail
export LC_ALL=C

command -v nsd-gen >/dev/null || PATH=$PWD/build:$PATH

tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
# A command that ends the file before its plan is named.
trap 'diag "$0: line $LINENO ended with $?: $BASH_COMMAND"' ERR

# A sanitizer's verdict must not look like one of our exit statuses. H5LTopen_file_image itself leaks.
echo leak:H5LTopen_file_image >"$tmp/lsan"
export ASAN_OPTIONS=abort_on_error=1:allocator_may_return_null=1:${ASAN_OPTIONS-}
export UBSAN_OPTIONS=abort_on_error=1:${UBSAN_OPTIONS-}
export LSAN_OPTIONS=suppressions=$tmp/lsan:print_suppressions=0:${LSAN_OPTIONS-}

# shellcheck disable=SC2034 # the tests use them
thin=${NSD_THIN-} problems=$PWD/../shared/problems
tap_count=0 tap_failed=0

tap_result() # good? name
{
    tap_count=$((tap_count + 1))
    if [ "$1" = 0 ]; then
        echo "ok $tap_count - $2"
    else
        tap_failed=$((tap_failed + 1))
        echo "not ok $tap_count - $2"
    fi
}

# to stderr, which prove does not hide
diag() { printf '%s\n' "$@" | sed 's/^/# /' >&2; }

skip() # name reason
{
    tap_count=$((tap_count + 1))
    echo "ok $tap_count - $1 # SKIP $2"
}

ok()
{
    local name=$1 s=0
    shift
    "$@" >"$tmp/tap.out" 2>&1 || s=$?
    tap_result "$s" "$name"
    [ "$s" = 0 ] || diag "$* gave $s" "$(head -n 8 "$tmp/tap.out")"
}

is()
{
    local s=0
    [ "$2" = "$3" ] || s=1
    tap_result "$s" "$1"
    [ "$s" = 0 ] || diag "got    '$2'" "wanted '$3'"
}

like()
{
    local s=0
    [[ $2 =~ $3 ]] || s=1
    tap_result "$s" "$1"
    [ "$s" = 0 ] || diag "got    '$2'" "wanted /$3/"
}

status()
{
    local want=$1 name=$2 s=0
    shift 2
    "$@" >"$tmp/out" 2>"$tmp/err" || s=$?
    tap_result $((s != want)) "$name"
    [ "$s" = "$want" ] || diag "$* ended with $s, not $want" "$(head -n 8 "$tmp/err")"
}

# Is a failure's stderr as it should be? One line that the tool begins; a usage error may have two.
one_line() # status file
{
    local line
    mapfile -t line <"$2"
    [[ ${#line[@]} -ge 1 && ${line[0]} =~ ^nsd-[a-z]+:\ .+ ]] || return 1
    [ "${#line[@]}" = 1 ] && return
    [[ $1 = 64 && ${#line[@]} = 2 && ${line[1]} =~ ^usage:\  ]]
}

refuses()
{
    local want=$1 name=$2 s=0 good=1
    shift 2
    "$@" >"$tmp/out" 2>"$tmp/err" || s=$?
    [ "$s" = "$want" ] && [ ! -s "$tmp/out" ] && one_line "$s" "$tmp/err" && good=0
    tap_result "$good" "$name"
    [ "$good" = 0 ] || diag "$* ended with $s ($want), stdout $(wc -c <"$tmp/out") bytes, stderr:" \
        "$(head -n 8 "$tmp/err")"
}

# each FUNCTION N: FUNCTION 0 .. FUNCTION N-1, on all cores; what they print is what is wrong.
each()
{
    local worker workers i
    workers=$(nproc)
    for ((worker = 0; worker < workers; worker++)); do
        (for ((i = worker; i < $2; i += workers)); do "$1" "$i"; done) >"$tmp/each.$worker" 2>&1 &
    done
    wait
    cat "$tmp"/each.*
    rm "$tmp"/each.*
}

# ok_each "what is true" FUNCTION N
ok_each()
{
    each "$2" "$3" >"$tmp/tap.each"
    tap_result "$([ ! -s "$tmp/tap.each" ])$?" "$1"
    [ ! -s "$tmp/tap.each" ] || diag "$(wc -l <"$tmp/tap.each") complaints" "$(head -n 8 "$tmp/tap.each")"
}

# ---- documents ----

# /particles, or another group, as text, bits and shapes and attributes, of a document's only frame
dump() { h5dump -m %.17g -g "${2-/particles}" "$1" | tail -n +2; }

same_particles() { cmp <(dump "$1") <(dump "$2"); }

# poke FILE OFFSET BYTE ...: bytes written over, each a number
poke()
{
    local file=$1 at=$2 text
    shift 2
    printf -v text '\\x%02x' "$@"
    printf '%b' "$text" | dd of="$file" bs=1 seek="$at" conv=notrunc status=none
}

# header FILE VERSION FLAGS LENGTH: the document's header anew, with checksums that are right
header()
{
    local file=$1 k crc
    # gzip ends with the checksum that we want, and a length
    mapfile -t crc < <(tail -c +513 "$file" | gzip -c | tail -c 8 | head -c 4 | od -An -v -tu1 -w1)
    poke "$file" 24 "${crc[@]}"
    for k in 0 8 16 24; do
        poke "$file" $((8 + k / 8)) $(($2 >> k & 255))
        poke "$file" $((12 + k / 8)) $(($3 >> k & 255))
        poke "$file" $((16 + k / 8)) $(($4 >> k & 255))
        poke "$file" $((20 + k / 8)) 0
    done
    mapfile -t crc < <(head -c 28 "$file" | gzip -c | tail -c 8 | head -c 4 | od -An -v -tu1 -w1)
    poke "$file" 28 "${crc[@]}"
}

# foreign DOCUMENT FILE: the HDF5 file in it, without our header
foreign() { tail -c +513 "$1" >"$2"; }

# stock NAME: a packing or a problem of tests/support/stock.mk, on standard output
stock()
{
    [ -x build/nsd-step ] && PATH=$PWD/build:$PATH env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL \
        make -s -f tests/support/stock.mk "build/stock/$1.h5" >&2 && cat "build/stock/$1.h5"
}

# py ARGUMENT ...: python3, which has imported h5py and numpy already. In the background, or where they may be
# missing: /usr/bin/python3
repository=$PWD
py() { NSD_TEST=$$ /usr/bin/python3 -I -S "$repository/tests/support/python.py" "$tmp/python" "$@"; }

# terminal COMMAND ...: at a terminal of its own. script(1) has the same, with a shell and its signals in between.
terminal() { /usr/bin/python3 -I -S "$repository/tests/support/terminal.py" "$@"; }

# has MODULE: does Python have it? It is looked for, not imported.
declare -A python_has
has()
{
    [ -n "${python_has[$1]-}" ] || python_has[$1]=$(/usr/bin/python3 -c 'import importlib.util, sys
print(bool(importlib.util.find_spec(sys.argv[1])))' "$1" 2>/dev/null || echo False)
    [ "${python_has[$1]}" = True ]
}

have_h5py() { has h5py; }

done_testing()
{
    echo "1..$tap_count"
    [ "$tap_failed" = 0 ]
}

# Can nsd-step run in several processes here?
have_ranks() { command -v mpirun >/dev/null && [ -x "$(dirname "$(command -v nsd-step)")/nsd-step-mpi" ]; }
# ranks N COMMAND ...: in N processes. A sanitizer does not look at the memory that MPI itself leaves behind.
ranks() {
    local n=$1
    shift
    ASAN_OPTIONS=detect_leaks=0:${ASAN_OPTIONS-} OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 \
        mpirun --oversubscribe --bind-to none -n "$n" "$@"
}
