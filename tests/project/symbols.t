#!/usr/bin/env bash
# What the library defines for others: the functions that nsd.h declares, and nothing else; and what it keeps between calls.
# shellcheck source=tests/support/tap.sh disable=SC2154,SC2317 # tap.sh sets tmp; functions called by name
. tests/support/tap.sh

build=$(dirname "$(command -v nsd-gen)")
declared() { grep -oE '\bnsd_[a-z_]+\(' lib/run/nsd.h | grep -v '^nsd_error()' | tr -d '(' | sort -u; }
cat >"$tmp/list" <<'EOT'
nsd_add
nsd_append
nsd_array_name
nsd_attributes
nsd_close
nsd_error
nsd_failure
nsd_finish
nsd_force
nsd_friction
nsd_from_arrays
nsd_from_document
nsd_from_memory
nsd_from_scene
nsd_from_scene_file
nsd_gravity
nsd_measure
nsd_names
nsd_next
nsd_note
nsd_number
nsd_objects
nsd_open
nsd_read
nsd_remove
nsd_report
nsd_resizes
nsd_rows
nsd_save
nsd_set
nsd_shut
nsd_step
nsd_text
nsd_until
nsd_velocity
nsd_version
nsd_wall_force
nsd_wall_velocity
EOT
is "nsd.h declares these functions: one that is gone or changed is another libnsd.so" "$(declared | grep -v '^nsd_$')" "$(<"$tmp/list")"
if nm "$build/libnsd.a" 2>/dev/null | grep __asan >/dev/null; then
    skip "symbols" "a sanitizer has its own"
else
    is "libnsd.so.2 exports them, and nothing else" "$(nm -D --defined-only "$build/libnsd.so.2" | awk '{ print $3 }' | sort)" "$(<"$tmp/list")"
    is "libnsd.a defines them, and nothing else" "$(nm -g --defined-only "$build/libnsd.a" | awk 'NF == 3 { print $3 }' | sort)" "$(<"$tmp/list")"
fi
undocumented() { while read -r name; do grep -q "Fn $name\\b" man/nsd.3 || echo "$name"; done <"$tmp/list"; }
is "nsd(3) has all of them" "$(undocumented)" "nsd_version"
in_python() { while read -r name; do grep -q "\"*$name\\b" python/nsd/_library.py || echo "$name"; done <"$tmp/list"; }
is "and the Python module knows them" "$(in_python)" ""

# ---- what runs share: each has its reason ----

# team, busy, judgement: the team of the process, which one thread has at a time. list, owner, running and their locks: files and
# readers, locked. hdf5, printer, printer_data: libhdf5, locked. embedded, chosen, once: set once. limit, options: the tools' own, which
# the library only reads. opencl_calls, opencl_open: the loader of OpenCL, locked. plist, registered: of the process that reads. of_thread, size, together, held, old, quantity: a thread's own. watched: set once.
# writers: those that write, with the lock of libhdf5.
cat >"$tmp/known" <<'EOT'
busy
embedded
hdf5
held
judgement
limit
list
list_lock
lock
of_thread
old
once
opencl_calls
opencl_open
options
owner
plist
printer
printer_data
quantity
registered
running
size
team
text
together
chosen
watched
writers
EOT
shared() { nm "$build/nsd.o" | awk '$2 ~ /^[bBdDC]$/ && $3 !~ /[.]local|^[.]/ { sub(/[.][0-9]+$/, "", $3); print $3 }' | sort -u; }
constant() # of them what is in .data.rel.ro or is never written: tables
{
    nm -f sysv "$build/nsd.o" | awk -F'|' '$7 ~ /[.]data[.]rel[.]ro|[.]rodata/ { gsub(/ /, "", $1); sub(/[.][0-9]+$/, "", $1); print $1 }' | sort -u
}
if nm "$build/libnsd.a" 2>/dev/null | grep __asan >/dev/null; then
    skip "state that runs share" "a sanitizer has its own"
else
    is "runs share no other state than what is said here" "$(comm -23 <(shared) <(constant) | comm -23 - <(sort "$tmp/known"))" ""
fi
done_testing
