#!/usr/bin/env bash
# No thread is where another writes: the tools are built again with clang's ThreadSanitizer.
# shellcheck source=tests/support/tap.sh
. tests/support/tap.sh

if ! command -v clang >/dev/null; then
    echo "1..0 # SKIP no clang"
    exit 0
fi

built=build/tsan flags=(-O1 -g1 -fsanitize=thread -DNSD_STEADY) tools=(nsd-solve nsd-step nsd-view libnsd.so.2)
ok "the tools build" make -j2 SAN= B=$built CC=clang CFLAGS="${flags[*]}" LDFLAGS="-fsanitize=thread -Wl,-z,undefs" \
    "IDLE=4 8" "${tools[@]/#/$built/}"

export NSD_LANES=2 # the sanitizer sees no access of more than 16 bytes
export TSAN_OPTIONS=ignore_noninstrumented_modules=1:abort_on_error=1

# ---- is anyone watching? ----

cat >"$tmp/race.c" <<'EOF'
#include "base/team.h"
#include <stdio.h>

static int64_t n;

static void count(void *lock, int me, int threads)
{
    (void)me, (void)threads;
    for (int k = 0; k < 1000; k++) {
#ifdef ORDERED
        team_meet();
        if (me == k % threads)
#endif
            n++;
    }
}

int main(void)
{
    for (int k = 0; k < 10; k++) team_do(2, count, NULL);
    return !n;
}
EOF
clang -Ilib "${flags[@]}" -o "$tmp/race" "$tmp/race.c" lib/base/team.c
clang -Ilib "${flags[@]}" -DORDERED -o "$tmp/ordered" "$tmp/race.c" lib/base/team.c
status 134 "a race is seen" "$tmp/race"
status 0 "and none where there is none" "$tmp/ordered"

# ---- a lattice with contacts enough for halves, its W alone, with groups worth a second thread, and a heap ----

jq -n '{ dt: 1e-3, gravity: [0.3, 0.2, -9.81], walls: [{ point: [0, 0, 0], normal: [0, 0, 1] }],
         bodies: [range(5120) | { radius: 0.5, x: [. % 16, (. / 16 | floor) % 16, 0.5 + (. / 256 | floor)] }] }' |
    nsd-gen - | nsd-detect --gap 1e-6 >"$tmp/halves.h5"
nsd-detect --gap 1e-6 --fclib=local "$tmp/halves.h5" >"$tmp/lattice.h5"
foreign "$tmp/lattice.h5" "$tmp/lattice.hdf5"
h5copy -i "$tmp/lattice.hdf5" -o "$tmp/given.h5" -s /fclib_local -d /fclib_local
nsd-gen 200 | nsd-step -n 900 --every 900 --tolerance 1e-6 2>/dev/null | nsd-cat --last >"$tmp/heap.h5"
nsd-detect "$tmp/heap.h5" >"$tmp/contacts.h5"

solve() # DOCUMENT ARGUMENT ...
{
    local document=$1 j
    shift
    for j in 2 4; do
        status 0 "$document, $*: $j threads" $built/nsd-solve "$@" -j $j "$tmp/$document.h5"
    done
}
for method in exact sbp sal ebp eal; do
    for document in lattice given; do
        solve $document -m $method --order colour --max-sweeps 8
    done
    solve halves -m $method --order colour --max-sweeps 8
done
for document in lattice contacts given; do
    solve $document --solver anderson --max-sweeps 30
    solve $document --max-sweeps 100
done
status 0 "whole steps in halves" $built/nsd-step -m exact --gap 1e-6 --order colour --relax 1.5 --warm --max-sweeps 8 -j 2 -n 3 "$tmp/halves.h5"
status 0 "whole steps by auto" $built/nsd-step -j 4 -n 20 "$tmp/heap.h5"
# ---- a program with runs in several threads, which forks ----

cat >"$tmp/runs.c" <<'EOF'
#include <nsd.h>
#include <pthread.h>
#include <stdint.h>
#include <sys/wait.h>
#include <unistd.h>

static const char scene[] =
    "{\"dt\":1e-3,\"mu\":0.3,\"walls\":[{\"point\":[0,0,0],\"normal\":[0,0,1],\"name\":\"floor\"}],\"bodies\":"
    "[{\"random\":{\"count\":200},\"radius\":0.1,\"box\":{\"x\":[-1,1],\"y\":[-1,1],\"z\":[0.1,6]}}]}";

static void *work(void *path)
{
    struct nsd_run *r;
    struct nsd_document *d = NULL;
    struct nsd_array a = { .size = sizeof a };
    const char *json;
    int more = 0;
    intptr_t bad = nsd_from_scene(&r, scene, NULL) || nsd_set(r, "threads", "2") || nsd_set(r, "contacts", "true");
    for (int k = 0; !bad && k < 5; k++)
        bad = nsd_step(r, 4) || nsd_read(r, "contact_force", &a) || nsd_measure(r, "energy", &json) || nsd_names(r, &json) ||
              nsd_append(r, path);
    if (!bad) bad = nsd_finish(r) || nsd_open(&d, path) || nsd_next(d, &more) || nsd_objects(d, &json) ||
                    nsd_rows(d, "/particles/all/position/value", 4, 1, &a);
    nsd_close(&r), nsd_shut(&d);
    return (void *)bad;
}

int main(int n, char **path)
{
    pthread_t thread[9];
    void *bad;
    int sum = 0, status;
    for (int k = 1; k < n; k++) pthread_create(&thread[k], NULL, work, path[k]);
    for (int k = 0; k < 3; k++) { // children that end at once, while all of that goes on
        pid_t child = fork();
        if (!child) _exit(0);
        waitpid(child, &status, 0), sum += status;
    }
    for (int k = 1; k < n; k++) pthread_join(thread[k], &bad), sum += bad != NULL;
    return sum;
}
EOF
clang -Ilib/run "${flags[@]}" -o "$tmp/runs" "$tmp/runs.c" $built/libnsd.so.2 -Wl,-rpath,"$PWD/$built"
status 0 "runs and documents in three threads, and children of fork()" "$tmp/runs" "$tmp/1.h5" "$tmp/2.h5" "$tmp/3.h5"
ok "with the same result" cmp "$tmp/1.h5" "$tmp/2.h5"
status 0 "a picture" $built/nsd-view -j 4 "$tmp/heap.h5"
done_testing
