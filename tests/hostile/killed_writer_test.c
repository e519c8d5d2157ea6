/*
 * A trajectory whose writer is killed: after each of its writes to the disk, and in the midst of one
 * that crosses two pages of the file, a reader finds every frame that the sink had finished before,
 * whole, and no other.
 */
#include "file/reader.h"
#include "file/writer.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

enum { BODIES = 4, FRAMES = 260, ROOM = 1 << 16, PAGE = 4096 };

static struct {
    off_t at;
    size_t size;
    void *bytes;
    off_t length;   // of the file, then
    int64_t frames; // finished before
} made[ROOM];
static int writes;
static int64_t finished;

/* H5LTopen_file_image itself leaks (tap.sh); the name is LeakSanitizer's. */
const char *__lsan_default_suppressions(void); // NOLINT(bugprone-reserved-identifier)
const char *__lsan_default_suppressions(void)  // NOLINT(bugprone-reserved-identifier)
{
    return "leak:H5LTopen_file_image";
}

/* HDF5's writes, and the sink's, come here first. */
ssize_t pwrite(int fd, const void *bytes, size_t size, off_t at)
{
    ssize_t n = syscall(SYS_pwrite64, fd, bytes, size, at);
    struct stat st;
    if (n != (ssize_t)size || writes == ROOM || fstat(fd, &st)) return n;
    if (!(made[writes].bytes = malloc(size))) return n;
    memcpy(made[writes].bytes, bytes, size);
    made[writes].at = at, made[writes].size = size;
    made[writes].length = st.st_size, made[writes++].frames = finished;
    return n;
}

/* Frame k: every number that is looked at tells it. */
static int change(struct frame *f, int64_t k, struct failure *failure)
{
    struct packing *p = &f->packing;
    p->step = f->report.step = k;
    p->t = f->report.t = (double)k * p->dt;
    for (int i = 0; i < BODIES; i++) p->x[i] = (vec3){ (double)k, i, 1 };
    contacts_free(&f->contacts);
    for (int i = 0; i < 2 + k % 3; i++) {
        struct contact *c = contacts_add(&f->contacts, -1, i);
        if (!c) return failure_set(failure, EX_SOFTWARE, "no memory");
        c->gap = -(double)k;
        contact_basis(c, 3, (vec3){ 0, 0, 1 });
    }
    return 0;
}

static int write_all(const char *path, struct failure *failure)
{
    struct writer *s;
    struct frame f = { .packed = true, .detected = true, .reported = true };
    snprintf(f.report.method, sizeof f.report.method, "exact");
    if (packing_init(&f.packing, 3, BODIES, failure) || packing_alloc_walls(&f.packing, 1, failure))
        return failure->status;
    f.packing.dt = 0.001;
    f.packing.wall[0].n = (vec3){ 0, 0, 1 };
    for (int i = 0; i < BODIES; i++)
        f.packing.radius[i] = f.packing.mass[i] = f.packing.inertia[i] = 1;
    if (writer_open(&s, path, WRITER_TRAJECTORY, failure)) return failure->status;
    for (int64_t k = 1; k <= FRAMES && !failure->status; k++)
        if (!change(&f, k, failure) && !writer_frame(s, &f, failure)) finished = k;
    frame_free(&f);
    if (!failure->status) writer_close(s, failure);
    finished = FRAMES;
    return failure->status;
}

/* Is the reader's frame k (from 0) the writer's? */
static bool is_whole(struct reader *r, int64_t k, struct frame *f, struct failure *failure)
{
    if (reader_frame(r, k, f, failure)) return false;
    bool good = f->packing.step == k + 1 && f->packing.t == (double)(k + 1) * f->packing.dt &&
                f->reported && f->report.step == k + 1 && f->detected &&
                f->contacts.n == 2 + (k + 1) % 3;
    for (int i = 0; i < BODIES; i++) good &= f->packing.x[i].x == (double)(k + 1);
    for (int i = 0; i < f->contacts.n; i++) good &= f->contacts.c[i].gap == -(double)(k + 1);
    return good;
}

/* Does the file at `path`, which holds the first writes, have at least those frames? */
static bool holds(char *path, int64_t frames, struct failure *failure)
{
    struct reader *r;
    struct frame f = { 0 };
    int64_t n = 0;
    bool good = !reader_open(&r, 1, &path, failure) && !reader_document(r, &n, failure) &&
                n >= frames && is_whole(r, n - 1, &f, failure) &&
                is_whole(r, frames - 1, &f, failure);
    frame_free(&f);
    reader_close(r);
    return good;
}

static char path[] = "/tmp/kill_test.XXXXXX";
static int fd, bad;

static bool put(int k, size_t size)
{
    return syscall(SYS_pwrite64, fd, made[k].bytes, size, made[k].at) == (ssize_t)size;
}

/* Write k is on the disk, up to `size`. */
static void look(int k, size_t size)
{
    struct failure failure = { 0 };
    if (holds(path, made[k].frames, &failure) || bad++ >= 8) return;
    diag("write %d, %zu of %zu bytes at %lld, after frame %lld: %s", k + 1, size, made[k].size,
         (long long)made[k].at, (long long)made[k].frames, failure.text);
}

int main(void)
{
    struct failure failure = { 0 };
    fd = mkstemp(path);
    bool written = fd >= 0 && !write_all(path, &failure);
    ok(written && writes > 20 * FRAMES && writes < ROOM, "%d frames are written in %d writes",
       FRAMES, writes);
    if (ftruncate(fd, 0)) return 1;
    int seen = 0, torn = 0, crossing = 0, every = getenv("NSD_THIN") ? 5 : 1;
    for (int k = 0; k < writes; k++) {
        size_t part = (size_t)(PAGE - made[k].at % PAGE);
        // blocks of an index longer than 512 bytes do cross pages: nsd-format(5)
        if (made[k].frames && part < made[k].size && made[k].size <= 512 &&
            crossing++ % every == 0) {
            if (!put(k, part)) return 1;
            torn++, look(k, part);
        }
        if (!put(k, made[k].size) || ftruncate(fd, made[k].length)) return 1;
        // indices of chunks grow at multiples of 16
        if (made[k].frames && (made[k].frames + 1) % 16 <= 1 && k % every == 0)
            seen++, look(k, made[k].size);
        free(made[k].bytes);
    }
    ok(!bad && seen > writes / 10 / every && torn > 8 / every,
       "after any of %d, and in the midst of %d, the frames before it are there and whole", seen,
       torn);
    close(fd);
    unlink(path);
    return tap_done();
}
