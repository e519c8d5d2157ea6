/*
 * tests/support/failing_library_calls.h: whichever allocation fails, and whichever call of libhdf5, one after another, the
 * library says so, or gets the same bytes another way. The linker hands these calls to __wrap_NAME here
 * (Makefile), also those of the reading process, which count too.
 */
#ifndef NSD_FAILING_H
#define NSD_FAILING_H

#include "file/stream.h"
#include "scene/scene_build.h"
#include "tap.h"

#include <hdf5_hl.h>
#include <limits.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

/* ---- calls that fail ---- */

enum kind { MEMORY, LIBHDF5, KINDS };
static const char *const kind_name[KINDS] = { "allocations", "calls of libhdf5" };

/* Shared with the reading process */
static struct {
    atomic_long calls;
    long fail_at; /* 0: none */
} * asked;
static bool armed;
static enum kind failing;

static bool fails(enum kind kind)
{
    if (!armed || kind != failing) return false;
    return atomic_fetch_add(&asked->calls, 1) + 1 == asked->fail_at;
}

// NOLINTBEGIN(bugprone-reserved-identifier): the linker's names
#define MEMORY_CALL(type, name, parameters, arguments)                                             \
    type __real_##name parameters;                                                                 \
    type __wrap_##name parameters;                                                                 \
    type __wrap_##name parameters                                                                  \
    {                                                                                              \
        return fails(MEMORY) ? NULL : __real_##name arguments;                                     \
    }

#define HDF5_CALL(type, name, parameters, arguments)                                               \
    type __real_##name parameters;                                                                 \
    type __wrap_##name parameters;                                                                 \
    type __wrap_##name parameters                                                                  \
    {                                                                                              \
        return fails(LIBHDF5) ? -1 : __real_##name arguments;                                      \
    }

/* What is closed is closed, whatever is said of it. */
#define HDF5_CLOSE(name)                                                                           \
    herr_t __real_##name(hid_t id);                                                                \
    herr_t __wrap_##name(hid_t id);                                                                \
    herr_t __wrap_##name(hid_t id)                                                                 \
    {                                                                                              \
        herr_t e = __real_##name(id);                                                              \
        return fails(LIBHDF5) ? -1 : e;                                                            \
    }

MEMORY_CALL(void *, malloc, (size_t size), (size))
MEMORY_CALL(void *, calloc, (size_t n, size_t size), (n, size))
MEMORY_CALL(void *, realloc, (void *old, size_t size), (old, size))
MEMORY_CALL(char *, strdup, (const char *s), (s))
MEMORY_CALL(char *, strndup, (const char *s, size_t n), (s, n))

HDF5_CALL(hid_t, H5Fcreate, (const char *name, unsigned flags, hid_t create, hid_t access),
          (name, flags, create, access))
HDF5_CALL(herr_t, H5Fflush, (hid_t id, H5F_scope_t scope), (id, scope))
HDF5_CALL(herr_t, H5Fget_filesize, (hid_t id, hsize_t *size), (id, size))
HDF5_CALL(ssize_t, H5Fget_file_image, (hid_t id, void *image, size_t size), (id, image, size))
HDF5_CALL(herr_t, H5Fget_vfd_handle, (hid_t id, hid_t access, void **handle), (id, access, handle))
HDF5_CALL(herr_t, H5Fset_libver_bounds, (hid_t id, H5F_libver_t low, H5F_libver_t high),
          (id, low, high))
HDF5_CALL(hid_t, H5LTopen_file_image, (void *image, size_t size, unsigned flags),
          (image, size, flags))
HDF5_CALL(hid_t, H5Gcreate2, (hid_t at, const char *name, hid_t link, hid_t create, hid_t access),
          (at, name, link, create, access))
HDF5_CALL(herr_t, H5Lcreate_hard,
          (hid_t from, const char *old, hid_t to, const char *new, hid_t create, hid_t access),
          (from, old, to, new, create, access))
HDF5_CALL(hid_t, H5Oopen, (hid_t at, const char *name, hid_t access), (at, name, access))
HDF5_CALL(hid_t, H5Dcreate2,
          (hid_t at, const char *name, hid_t type, hid_t space, hid_t link, hid_t create,
           hid_t access),
          (at, name, type, space, link, create, access))
HDF5_CALL(hid_t, H5Dopen2, (hid_t at, const char *name, hid_t access), (at, name, access))
HDF5_CALL(herr_t, H5Dwrite,
          (hid_t id, hid_t type, hid_t memory, hid_t disk, hid_t transfer, const void *data),
          (id, type, memory, disk, transfer, data))
HDF5_CALL(herr_t, H5Dread,
          (hid_t id, hid_t type, hid_t memory, hid_t disk, hid_t transfer, void *data),
          (id, type, memory, disk, transfer, data))
HDF5_CALL(herr_t, H5Dset_extent, (hid_t id, const hsize_t *size), (id, size))
HDF5_CALL(hid_t, H5Dget_space, (hid_t id), (id))
HDF5_CALL(hid_t, H5Dget_type, (hid_t id), (id))
HDF5_CALL(hid_t, H5Dget_create_plist, (hid_t id), (id))
HDF5_CALL(hid_t, H5Acreate_by_name,
          (hid_t at, const char *path, const char *name, hid_t type, hid_t space, hid_t create,
           hid_t access, hid_t link),
          (at, path, name, type, space, create, access, link))
HDF5_CALL(herr_t, H5Awrite, (hid_t id, hid_t type, const void *data), (id, type, data))
HDF5_CALL(herr_t, H5Aread, (hid_t id, hid_t type, void *data), (id, type, data))
HDF5_CALL(hid_t, H5Aopen, (hid_t id, const char *name, hid_t access), (id, name, access))
HDF5_CALL(hid_t, H5Aopen_by_name,
          (hid_t at, const char *path, const char *name, hid_t access, hid_t link),
          (at, path, name, access, link))
HDF5_CALL(herr_t, H5Aiterate2,
          (hid_t id, H5_index_t by, H5_iter_order_t order, hsize_t *at, H5A_operator2_t op,
           void *data),
          (id, by, order, at, op, data))
HDF5_CALL(hid_t, H5Aget_space, (hid_t id), (id))
HDF5_CALL(hid_t, H5Aget_type, (hid_t id), (id))
HDF5_CALL(hid_t, H5Tcopy, (hid_t type), (type))
HDF5_CALL(hid_t, H5Screate, (H5S_class_t class), (class))
HDF5_CALL(hid_t, H5Screate_simple, (int rank, const hsize_t *size, const hsize_t *most),
          (rank, size, most))
HDF5_CLOSE(H5Fclose)
HDF5_CLOSE(H5Gclose)
HDF5_CLOSE(H5Dclose)
HDF5_CLOSE(H5Aclose)

/* The reading process has ended but for the counts of the compiler's. */
int __wrap_malloc_trim(size_t pad);
int __wrap_malloc_trim(size_t pad)
{
    (void)pad;
    armed = false;
    return 0;
}

/* libhdf5 leaves behind what a call that is said to have failed has made; LeakSanitizer need not know. */
const char *__asan_default_options(void);
const char *__asan_default_options(void)
{
    return "detect_leaks=0:allocator_may_return_null=1";
}
// NOLINTEND(bugprone-reserved-identifier)

/* ---- files ---- */

static char folder[40] = "/dev/shm/nsd_failing.XXXXXX"; /* in memory, where there is such a place */

/* A file of this test's, never the same twice: names stay, for the library keeps them. */
static const char *fresh(const char *ending)
{
    static int k;
    char *path = NULL;
    if (asprintf(&path, "%s/%d%s", folder, k++, ending) < 0) exit(1);
    return path;
}

/* The checksum of a file, which is then removed; 0: it is not there */
__attribute__((unused)) static uint32_t crc_of(const char *path)
{
    static unsigned char bytes[1 << 24];
    FILE *f = fopen(path, "r");
    size_t n = f ? fread(bytes, 1, sizeof bytes, f) : 0;
    if (f) fclose(f);
    unlink(path);
    return document_crc(0, bytes, n);
}

static void must(int failed, const struct failure *failure)
{
    if (!failed) return;
    printf("Bail out! %s\n", failure->text);
    exit(1);
}

static const char *const scene_text[] = {
    "{\"dt\": 1e-3, \"kinds\": {\"steel\": {\"density\": 7800}}, \"mu\": 0.3, \"pairs\":"
    "[{\"pair\": [\"ball\", \"steel\"], \"mu\": 0.1}], \"overlap\": true,"
    "\"walls\": [{\"point\": [0, 0, -1], \"normal\": [0, 0, 1], \"load\": {\"along\": [0, 0, 1],"
    "  \"mass\": 2, \"force\": 9}, \"drives\": [{\"along\": [0, 0, 1], \"speed\": 0.1}]},"
    " {\"cylinder\": {\"point\": [0, 0, 0], \"axis\": [0, 0, 1], \"radius\": 9, \"length\": 9},"
    "  \"load\": {\"about\": [0, 0, 0], \"axis\": [0, 0, 1], \"mass\": 2, \"torque\": 1},"
    "  \"drives\": [{\"about\": [0, 0, 0], \"axis\": [0, 0, 1], \"table\": [[0, 0], [1, 2]]}],"
    "  \"until\": 9}, {\"disc\": {\"center\": [0, 0, -4], \"normal\": [0, 0, 1], \"radius\": 2}}],"
    "\"bodies\": [{\"x\": [0, 0, 0], \"radius\": 1}, {\"x\": [1.99, 0, 0], \"radius\": 1,"
    "  \"kind\": \"steel\"}, {\"file\": \"balls\"}, {\"x\": [0, 1.99, 0], \"radius\": 1,"
    "  \"fixed\": true}, {\"x\": [8.01, 0, 3], \"radius\": 1}, {\"count\": 3, \"cells\": \"own\","
    "  \"radius\": {\"uniform\": [0.2, 0.3]}, \"box\": {\"x\": [-3, 3], \"y\": [-3, 3],"
    "  \"z\": [3, null]}}, {\"random\": {\"count\": 3}, \"radius\": {\"sieve\": [[0.1, 0],"
    "  [0.3, 1]]}, \"box\": {\"x\": [-3, 3], \"y\": [-3, 3], \"z\": [6, 7]}}],"
    "\"pour\": [{\"rate\": 1000, \"radius\": 0.1, \"opening\": {\"disc\": {\"center\": [0, 0, 8],"
    "  \"normal\": [0, 0, 1], \"radius\": 3}}, \"count\": 9}],"
    "\"remove\": [{\"below\": {\"point\": [0, 0, -5], \"normal\": [0, 0, 1]}}]}",

    "{\"dim\": 2, \"dt\": 1e-3, \"gravity\": [0, 0], \"e_n\": 0.2, \"overlap\": true, \"cell\": {"
    "  \"lengths\": [4, 4], \"gradient\": [{\"t\": 0, \"L\": [[0, 0.1], [0, 0]]}, {\"t\": 1,"
    "  \"L\": [[0, 0], [0, 0]]}], \"stress\": {\"pressure\": 3, \"mass\": 1}},"
    "\"bodies\": [{\"x\": [0.5, 1], \"radius\": 1}, {\"x\": [2.45, 1], \"radius\": 1},"
    "  {\"x\": [1.5, 2.8], \"radius\": 1}]}",

    "{\"dim\": 2, \"dt\": 1e-3, \"overlap\": true, \"walls\": [{\"polygon\": {\"points\":"
    "  [[-5, 0], [5, 0], [0, 5]]}, \"drives\": [{\"along\": [1, 0], \"amplitude\": 0.1,"
    "  \"frequency\": 2}]}, {\"segment\": [[-5, -1], [5, -1]]}],"
    "\"bodies\": [{\"x\": [0, 0.99], \"radius\": 1, \"v\": [0, -1]}, {\"count\": 4, \"radius\": "
    "0.1,"
    "  \"box\": {\"x\": [-1, 1], \"y\": [6, null]}}]}",
};
enum { SCENES = sizeof scene_text / sizeof *scene_text };

static int now; /* which of them a run is about */

__attribute__((unused)) static int build(struct packing *p, int k, struct failure *failure)
{
    struct scene s;
    if (scene_parse(&s, scene_text[k], strlen(scene_text[k]), NULL, failure))
        return failure->status;
    scene_build(p, &s, folder, failure);
    scene_free(&s);
    return failure->status;
}

/* ---- each call in turn ---- */

/* How it ends where call number `at` fails, 0: none; and whether that is as it should be */
static bool run_failing(int (*run)(uint32_t *crc, struct failure *failure), long at, uint32_t *crc,
                        struct failure *failure)
{
    uint32_t got = 0;
    *failure = (struct failure){ 0 };
    asked->calls = 0;
    asked->fail_at = at;
    armed = true;
    int e = run(&got, failure);
    armed = false;
    if (!at) *crc = got;
    if (!e) return got == *crc;
    return e == failure->status && failure->text[0] && !strchr(failure->text, '\n') &&
           (e == EX_SOFTWARE || e == EX_IOERR || e == EX_DATAERR);
}

static long most_failures = LONG_MAX; /* of a run that takes long */

/* Calls that a run makes fail, one at a time: so many, spread over all of them; make coverage needs all. */
__attribute__((unused)) static void each_fails(const char *name,
                                               int (*run)(uint32_t *crc, struct failure *failure))
{
    long most = getenv("NSD_RUNS") ? LONG_MAX : getenv("NSD_THIN") ? 6 : 16;
    for (failing = 0; failing < KINDS; failing++) {
        uint32_t crc;
        struct failure failure;
        long wrong = 0, told = 0;
        if (!run_failing(run, 0, &crc, &failure) || failure.status) {
            ok(false, "%s %d: %s", name, now, failure.text);
            return;
        }
        long total = asked->calls;
        if (most > most_failures) most = most_failures;
        if (now && most > 250) most = 250; // all of them in the first scene
        long n = total < most ? total : most;
        for (long i = 0; i < n; i++) {
            long k = 1 + i * total / n;
            bool good = run_failing(run, k, &crc, &failure);
            told += failure.status != 0;
            if (good || wrong++ > 3) continue;
            diag("%ld: status %d, %s", k, failure.status,
                 failure.status ? failure.text : "other bytes");
        }
        if (total)
            ok(!wrong,
               "%s %d: one of %ld %s fails: %ld of %ld times it says so, else all is as it was",
               name, now, total, kind_name[failing], told, n);
    }
}

static void put_file(const char *name, const char *text)
{
    char path[100];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, "w");
    if (!f || fputs(text, f) < 0 || fclose(f)) exit(1);
}

static void failing_begin(void)
{
    asked = mmap(NULL, sizeof *asked, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (access("/dev/shm", W_OK)) strcpy(folder, "/tmp/nsd_failing.XXXXXX");
    if (asked == MAP_FAILED || !mkdtemp(folder)) exit(1);
    setvbuf(stdout, NULL, _IOLBF, 0); // children have nothing of it to write
    put_file("balls", "# x y z r kind\n5 0 0 1 ball\n-5 0 0 1 steel\n");
}

static int failing_done(void)
{
    char command[100];
    snprintf(command, sizeof command, "rm -r %s", folder);
    return tap_done() | (system(command) != 0);
}

#endif
