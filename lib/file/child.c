#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier): close_range
#include "file/child.h"

#include "base/array.h"
#include "base/bounded.h"
#include "base/output.h"
#include "file/h5.h"
#include "file/server.h"

#include <errno.h>
#include <limits.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

struct child {
    pid_t pid; /* 0: none; -1: it has ended */
    int line;  /* a socket to it; -1: it is gone */
    struct server_memory *shared;
    struct child *next; /* of those that are running */
};

static struct child *running;
static pid_t owner;                                      /* the process whose they are */
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER; /* of that list */

/* Waits for its end; false where that has been seen before. */
static bool wait_for(const struct child *c, int *status)
{
    pid_t got = -1;
    while (c->pid > 0 && (got = waitpid(c->pid, status, 0)) < 0 && errno == EINTR) continue;
    return got > 0;
}

/* Ends the process, and takes its status off the system's list. */
static void bury(struct child *c)
{
    if (c->line >= 0) close(c->line);
#ifndef NSD_COVERAGE
    if (c->pid > 0) kill(c->pid, SIGKILL); // it may be waiting for a pipe
#endif
    wait_for(c, NULL);
    c->pid = 0, c->line = -1;
}

/* A tool that dies by exit() closes nothing. */
static void bury_all(void)
{
    for (struct child *c = running; c && owner == getpid(); c = c->next) bury(c);
}

static void child_enlist(struct child *c)
{
    static bool registered;
    c->next = running, running = c, owner = getpid();
    if (!registered) registered = !atexit(bury_all);
}

void child_forget_all(void)
{
    for (struct child *c = running, *next; c; c = next) {
        next = c->next;
        if (c->line >= 0) close(c->line);
        c->line = c->pid = -1, c->next = NULL;
    }
    running = NULL;
}

static int no_child(struct failure *failure, const char *trouble)
{
    return failure_set(failure, EX_SOFTWARE, "no process to read with: %s", trouble);
}

/* What the new process is to do */
struct child_start {
    struct child *child;
    int line[2];
    int files;
    char *const *file;
    uint64_t limit;
    pid_t parent;
    int trouble; /* errno of fork */
};

/* The files that the program has open, and may have locked, are its own: all but those that are to be read. */
static void leave_files(const struct child_start *s)
{
    int keep[2] = { s->line[1], -1 };
    if (s->files) sscanf(s->file[0], "/proc/self/fd/%d", &keep[1]);
    for (int first = STDERR_FILENO + 1;;) { // up to the next one that is kept
        int next = INT_MAX;
        for (int k = 0; k < 2; k++)
            if (keep[k] >= first && keep[k] < next) next = keep[k];
        if (next > first)
            close_range((unsigned)first, next == INT_MAX ? UINT_MAX : (unsigned)next - 1, 0);
        if (next == INT_MAX) return;
        first = next + 1;
    }
}

/* Called as libhdf5 calls back, so that it does not matter with what */
static herr_t child_start_reader(hid_t plist, const char *name, void *data)
{
    struct child_start *s = data;
    struct child *c = s->child;
    (void)plist, (void)name;
    c->pid = fork();
    s->trouble = errno;
    if (c->pid) return 1; // enough
    child_forget_all();   // they hang up when the tool does
    if (embedded_is()) leave_files(s);
    close(s->line[0]);
    server_run(s->line[1], c->shared, s->files, s->file, s->limit, s->parent);
}

/*
 * Another thread of a program may be in libhdf5, which it locks for itself: the lock would stay locked in the new process
 * for ever. In what libhdf5 calls back the lock is this thread's, here and there.
 */
static void start_beside_threads(struct child_start *s)
{
    int from = 0;
    if (!embedded_is() || H5Piterate(H5P_FILE_ACCESS_DEFAULT, &from, child_start_reader, s) != 1)
        child_start_reader(H5P_DEFAULT, "", s);
}

int child_start(struct child **out, int files, char *const *file, uint64_t limit,
                struct failure *failure)
{
    struct child *c = *out = calloc(1, sizeof *c);
    struct child_start s = {
        .child = c, .files = files, .file = file, .limit = limit, .parent = getpid()
    };
    int *line = s.line;
    if (!c) return failure_set(failure, EX_SOFTWARE, "no memory");
    c->line = -1;
    c->shared =
        mmap(NULL, sizeof *c->shared, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (c->shared == MAP_FAILED) {
        c->shared = NULL;
        return no_child(failure, strerror(errno));
    }
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, line))
        return no_child(failure, strerror(errno));
    pthread_mutex_lock(&lock);
    start_beside_threads(&s);
    close(line[1]);
    if (c->pid < 0)
        close(line[0]);
    else
        c->line = line[0], child_enlist(c);
    pthread_mutex_unlock(&lock);
    return c->pid < 0 ? (c->pid = 0, no_child(failure, strerror(s.trouble))) : 0;
}

void child_close(struct child *c)
{
    if (!c) return;
    bury(c);
    pthread_mutex_lock(&lock);
    for (struct child **k = &running; *k; k = &(*k)->next)
        if (*k == c) {
            *k = c->next;
            break;
        }
    pthread_mutex_unlock(&lock);
    if (c->shared) munmap(c->shared, sizeof *c->shared);
    free(c);
}

bool child_lost(const struct child *c)
{
    return c->line < 0;
}

/* The child is gone: why. */
static int child_gone(struct child *c, struct failure *failure)
{
    int status = 0;
    close(c->line); // should it live it ends now
    bool known = wait_for(c, &status);
    int signal = known && WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    c->line = -1, c->pid = -1;
    c->shared->where[sizeof c->shared->where - 1] = 0;
    const char *where = c->shared->where[0] ? c->shared->where : "input";
    if (signal == SIGBUS)
        return failure_set(failure, EX_DATAERR, "%.250s: has become shorter while it was read",
                           where);
    if (limits_reason(signal, where, failure)) return failure->status;
    return failure_set(failure, EX_DATAERR,
                       "%.250s: libhdf5 breaks down over it (%s): damaged, or made to", where,
                       signal ? strsignal(signal) : "it ended");
}

/* All pieces of an answer, out of shared memory */
static int child_take(struct child *c, struct taker *t, struct failure *failure)
{
    struct reply r;
    bool begun = false;
    for (uint64_t pieces = 0;; pieces++) {
        if (line_receive(c->line, &r, sizeof r) != sizeof r) return child_gone(c, failure);
        r.text[sizeof r.text - 1] = 0;
        if (r.status) return failure_set(failure, r.status, "%s", r.text);
        if (!begun && t->sink.begin(&t->sink, &r)) return failure->status;
        begun = true;
        if (r.here > REQUEST_PIECE || r.here > t->size - t->done || (!r.here && t->done < t->size))
            return failure_set(failure, EX_DATAERR, "%.250s: an answer of another size",
                               c->shared->where);
        const unsigned char *piece = c->shared->piece[pieces % 2];
        if (t->pour ? t->pour(t->out, piece, (size_t)r.here, failure) : 0) return failure->status;
        if (r.here && t->out && !t->pour) memcpy((char *)t->out + t->done, piece, (size_t)r.here);
        t->done += r.here;
        if (t->done == t->size) return 0;
        if (!line_send(c->line, "", 1)) return child_gone(c, failure);
    }
}

int child_ask(struct child *c, const struct request *q, struct taker *t, struct failure *failure)
{
    if (!line_send(c->line, q, sizeof *q)) return child_gone(c, failure);
    return child_take(c, t, failure);
}

static int child_by_path(const void *one, const void *other, void *objects)
{
    const struct listed *l = objects, *a = &l[*(const int64_t *)one],
                        *b = &l[*(const int64_t *)other];
    int order = (int)a->object.attribute - (int)b->object.attribute;
    if (!order) order = strcmp(a->path, b->path);
    return order ? order : (a > b) - (a < b);
}

static int sort(struct list *s, struct failure *failure)
{
    if (!(s->sorted = malloc(((size_t)s->count + 1) * sizeof *s->sorted)))
        return failure_set(failure, EX_SOFTWARE, "no memory for a list of objects");
    for (int64_t k = 0; k < s->count; k++) s->sorted[k] = k;
    qsort_r(s->sorted, (size_t)s->count, sizeof *s->sorted, child_by_path, s->object);
    return 0;
}

int list_open(struct list *s, unsigned char *bytes, uint64_t size, struct failure *failure)
{
    int64_t room = 0;
    struct listed l;
    *s = (struct list){ .bytes = bytes };
    for (uint64_t at = 0; at < size; s->count++) {
        if (!array_grow(&s->object, &room, s->count + 1, sizeof *s->object))
            return failure_set(failure, EX_SOFTWARE, "no memory for a list of objects");
        if (!object_unpack(bytes, size, &at, &l))
            return failure_set(failure, EX_DATAERR, "no list of objects");
        s->object[s->count] = l;
    }
    return sort(s, failure);
}

void list_free(struct list *s)
{
    free(s->bytes), free(s->object), free(s->sorted);
    *s = (struct list){ 0 };
}

/* The one of this path, PATH@NAME of an attribute */
static const struct listed *child_find(const struct list *s, const char *path, bool attribute)
{
    for (int64_t lo = 0, hi = s->count; lo < hi;) {
        int64_t k = lo + (hi - lo) / 2;
        const struct listed *l = &s->object[s->sorted[k]];
        int order = attribute - (int)l->object.attribute;
        if (!order) order = strcmp(path, l->path);
        if (!order) return l;
        *(order > 0 ? &lo : &hi) = order > 0 ? k + 1 : k;
    }
    return NULL;
}

const struct listed *list_find(const struct list *s, const char *path)
{
    return child_find(s, path, false);
}

const struct listed *list_attribute(const struct list *s, const char *path, const char *name)
{
    char whole[OBJECT_PATH + OBJECT_NAME];
    snprintf(whole, sizeof whole, "%s@%s", path, name);
    const struct listed *l = child_find(s, whole, true);
    return l && l->object.data ? l : NULL;
}

/* Number k of what came with the list, as an integer and as a real. */
static void plain_number(const struct listed *l, uint64_t k, int64_t *i, double *x)
{
    const char *at = (const char *)l->data + k * l->object.size;
    bool minus = l->object.class == 'i' && (at[l->object.size - 1] & 0x80);
    *i = minus ? -1 : 0;
    if (l->object.class == 'f') {
        float f;
        memcpy(l->object.size == 4 ? (void *)&f : (void *)x, at, l->object.size);
        if (l->object.size == 4) *x = (double)f;
        return;
    }
    memcpy(i, at, l->object.size); // little-endian, as column_native is in the file
    *x = l->object.class == 'u' ? (double)(uint64_t)*i : (double)*i;
}

bool listed_numbers(const struct listed *l, uint64_t first, uint64_t n, enum column_type type,
                    void *out)
{
    const struct object *o = &l->object;
    if (o->kind != OBJECT_NUMBERS || (o->class == 'f' && type != COLUMN_F64)) return false;
    if (n > UINT64_MAX / 32 || first > UINT64_MAX / 32 || (first + n) * o->size > o->data)
        return false;
    if ((o->class == 'f' && o->size == 8) ||
        (o->class == 'i' && type != COLUMN_F64 && field_size(type) == o->size)) {
        memcpy(out, (const char *)l->data + first * o->size, n * o->size);
        return true;
    }
    for (uint64_t k = 0; k < n; k++) {
        int64_t i;
        double x;
        plain_number(l, first + k, &i, &x);
        if (type == COLUMN_F64) ((double *)out)[k] = x;
        if (type == COLUMN_F64) continue;
        bool fits = !(o->class == 'u' && i < 0);
        if (type == COLUMN_I32) fits = fits && i >= INT32_MIN && i <= INT32_MAX;
        if (type == COLUMN_I8) fits = fits && i >= INT8_MIN && i <= INT8_MAX;
        if (!fits) return false;
        memcpy((char *)out + k * field_size(type), &i, field_size(type));
    }
    return true;
}
