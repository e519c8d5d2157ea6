#include "io/source.h"

#include "io/stream.h"

#include <errno.h>
#include <fcntl.h>
#include <hdf5_hl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#ifdef __SANITIZE_ADDRESS__
enum { SANITIZED = 1 };
#else
enum { SANITIZED = 0 };
#endif

/* What a child may take for a document. */
enum {
    SPARE_MEMORY = 1 << 28, /* bytes: libhdf5, its caches, and a packed chunk */
    MEMORY_RATIO = 4,       /* and so many times the document */
    SPARE_SECONDS = 10,     /* of the processor, for an answer: a good one takes milliseconds, */
    LARGE = 1 << 26,        /* bytes of a document worth giving back early, as in io/stream.c */
    RATE = 10000000,        /* and bytes a second: a tenth of what gzip unpacks */
    SLOWER = SANITIZED ? 10 : 1
};

/* What parent and child share. */
struct shared {
    char where[300]; /* the document in hand, for messages when the child is gone */
    unsigned char piece[2][SERVE_PIECE];
};

struct source {
    pid_t child; /* 0: none, the file is our own */
    int line;    /* a socket to the child; -1: it is gone */
    struct shared *shared;
    struct served own;
    char where[300], name[300];
    unsigned char *catalogue; /* the document's objects, as the child has sent them */
    struct listed {
        struct object object;
        const char *path;
        const uint64_t *shape;
        const void *data; /* object.data bytes, where the child has sent them along */
    } * object;
    int64_t objects;
    bool large; /* the document takes memory that is worth giving back */
};

static uint64_t limit;

void source_limit(uint64_t bytes)
{
    limit = bytes;
}

/* ---- the child ---- */

struct server {
    struct sink sink;
    int line;
    struct shared *shared;
    struct reply reply;
    uint64_t sent, pieces, acknowledged;
    struct stream *stream;
    struct served served;
};

static bool send_reply(struct server *s)
{
    return send(s->line, &s->reply, sizeof s->reply, MSG_NOSIGNAL) == sizeof s->reply;
}

static int server_begin(struct sink *sink, const struct reply *reply)
{
    struct server *s = (struct server *)sink;
    s->reply = *reply;
    s->sent = s->pieces = s->acknowledged = 0;
    return reply->size || send_reply(s) ? 0 : -1;
}

/* A piece may be filled while the parent takes the one before. */
static void *server_room(struct sink *sink, size_t *most)
{
    struct server *s = (struct server *)sink;
    char word;
    while (s->pieces >= s->acknowledged + 2)
        if (recv(s->line, &word, 1, 0) == 1)
            s->acknowledged++;
        else
            _exit(EX_OSERR);
    *most = SERVE_PIECE;
    return s->shared->piece[s->pieces % 2];
}

static int server_put(struct sink *sink, size_t size)
{
    struct server *s = (struct server *)sink;
    s->reply.here = size;
    s->sent += size, s->pieces++;
    return s->sent <= s->reply.size && send_reply(s) ? 0 : -1;
}

/* The address space that the process takes now, in bytes */
static rlim_t taken(void)
{
    unsigned long long pages = 0;
    FILE *f = fopen("/proc/self/statm", "r");
    if (!f || fscanf(f, "%llu", &pages) != 1) pages = 0;
    if (f) fclose(f);
    return (rlim_t)pages * (rlim_t)sysconf(_SC_PAGESIZE);
}

static void set_limit(int which, rlim_t most)
{
    struct rlimit r;
    if (getrlimit(which, &r)) return;
    r.rlim_cur = most < r.rlim_max ? most : r.rlim_max;
    setrlimit(which, &r);
}

static void bound_memory(uint64_t size)
{
    if (SANITIZED) return; // which wants terabytes of addresses
    set_limit(RLIMIT_AS, taken() + SPARE_MEMORY + MEMORY_RATIO * (rlim_t)size + (rlim_t)limit);
}

static void bound_time(uint64_t size)
{
    struct rusage used;
    if (getrusage(RUSAGE_SELF, &used)) return;
    rlim_t now = (rlim_t)(used.ru_utime.tv_sec + used.ru_stime.tv_sec);
    set_limit(RLIMIT_CPU, now + SLOWER * (SPARE_SECONDS + (size + limit) / RATE));
}

static int open_image(struct server *s, const struct image *im, struct why *why)
{
    hid_t file = H5LTopen_file_image(im->bytes, im->size,
                                     H5LT_FILE_IMAGE_DONT_COPY | H5LT_FILE_IMAGE_DONT_RELEASE);
    if (file < 0)
        return why_set(why, EX_DATAERR, "not a readable HDF5 file (truncated or damaged)");
    return serve_open(&s->served, file, im->size, limit, why);
}

/* The next document, and all that is in it */
static int answer_next(struct server *s, struct why *why)
{
    struct image im;
    struct reply reply = { 0 };
    serve_close(&s->served);
    set_limit(RLIMIT_AS, RLIM_INFINITY), set_limit(RLIMIT_CPU, RLIM_INFINITY);
    if (stream_next(s->stream, &im, why)) return why->status;
    if (!im.bytes) return s->sink.begin(&s->sink, &reply);
    snprintf(s->shared->where, sizeof s->shared->where,
             im.number > 1 ? "%.250s: document %lld" : "%.250s", im.name, (long long)im.number);
    bound_memory(im.size), bound_time(im.size);
    size_t size = 0;
    void *objects = open_image(s, &im, why) ? NULL : serve_objects(&s->served, &size, why);
    if (!objects) {
        char text[sizeof why->text];
        memcpy(text, why->text, sizeof text);
        snprintf(why->text, sizeof why->text, "%.120s: %.270s", s->shared->where, text);
        return why->status;
    }
    reply.foreign = im.foreign, reply.unfinished = im.unfinished, reply.number = im.number;
    reply.document = im.size;
    snprintf(reply.text, sizeof reply.text, "%s", im.name);
    int e = serve_bytes(&s->sink, &reply, objects, size);
    free(objects);
    return e ? why_set(why, EX_SOFTWARE, "not sent") : 0;
}

static int answer(struct server *s, const struct request *q, struct why *why)
{
    struct reply done = { .there = true };
    if (q->op == REQUEST_NEXT) return answer_next(s, why);
    bound_time(s->served.size);
    if (q->op != REQUEST_UNLOAD && q->op != REQUEST_RELEASE)
        return serve_answer(&s->served, q, &s->sink, why);
    if (q->op == REQUEST_RELEASE) serve_close(&s->served), stream_release(s->stream);
    if (q->op == REQUEST_UNLOAD) stream_unload(s->stream);
    return s->sink.begin(&s->sink, &done);
}

/* Requests and answers until the parent hangs up */
static void serve(struct server *s)
{
    struct request q;
    ssize_t n;
    while ((n = recv(s->line, &q, sizeof q, 0)) > 0) {
        struct why why = { 0 };
        if (n == 1) continue; // the last pieces are not waited for
        if (n != sizeof q) break;
        if (!answer(s, &q, &why)) continue;
        s->reply = (struct reply){ .status = why.status ? why.status : EX_SOFTWARE };
        snprintf(s->reply.text, sizeof s->reply.text, "%s", why.text);
        if (!send_reply(s)) break;
    }
}

#ifdef NSD_COVERAGE
void __gcov_dump(void);
#endif

static void child_main(int line, struct shared *shared, int files, char *const *file, pid_t parent)
{
    struct server s = { .sink = { server_begin, server_room, server_put },
                        .line = line,
                        .shared = shared,
                        .served.file = -1 };
    struct why why = { 0 };
#ifndef NSD_COVERAGE
    prctl(PR_SET_PDEATHSIG, SIGKILL); // standard input is not kept open when the parent is gone
    if (getppid() != parent) _exit(0);
#else
    (void)parent;
#endif
    set_limit(RLIMIT_CORE, 0);
    int null = open("/dev/null", O_WRONLY | O_CLOEXEC);
    dup2(null, STDOUT_FILENO); // who reads our output shall not wait for this process
    if (!SANITIZED) dup2(null, STDERR_FILENO);
    serve_start();
    if (!stream_open(&s.stream, files, file, &why)) serve(&s);
#ifdef NSD_COVERAGE
    __gcov_dump();
#endif
    _exit(0);
}

/* ---- the parent ---- */

static int no_child(struct source *s, struct why *why, const char *trouble)
{
    return s->child = 0, why_set(why, EX_SOFTWARE, "no process to read with: %s", trouble);
}

int source_open(struct source **out, int files, char *const *file, struct why *why)
{
    struct source *s = *out = calloc(1, sizeof *s);
    int line[2];
    if (!s) return why_set(why, EX_SOFTWARE, "no memory");
    s->line = -1, s->own.file = -1;
    s->shared =
        mmap(NULL, sizeof *s->shared, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (s->shared == MAP_FAILED) {
        s->shared = NULL;
        return no_child(s, why, strerror(errno));
    }
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, line))
        return no_child(s, why, strerror(errno));
    pid_t parent = getpid();
    s->child = fork();
    if (s->child == 0) {
        close(line[0]);
        child_main(line[1], s->shared, files, file, parent);
    }
    close(line[1]);
    if (s->child < 0) {
        close(line[0]);
        return no_child(s, why, strerror(errno));
    }
    s->line = line[0];
    return 0;
}

static void forget_objects(struct source *s)
{
    free(s->catalogue), free(s->object);
    s->catalogue = NULL, s->object = NULL, s->objects = 0;
}

void source_close(struct source *s)
{
    if (!s) return;
    if (s->line >= 0) close(s->line);
#ifndef NSD_COVERAGE
    if (s->child > 0) kill(s->child, SIGKILL); // it may be waiting for a pipe
#endif
    if (s->child > 0) waitpid(s->child, NULL, 0);
    if (s->shared) munmap(s->shared, sizeof *s->shared);
    if (!s->child && s->own.count) s->own.file = -1, serve_close(&s->own);
    forget_objects(s);
    free(s);
}

const char *source_where(const struct source *s)
{
    return s->where;
}

/* The child is gone: why. */
static int child_gone(struct source *s, struct why *why)
{
    int status = 0;
    bool known = s->child > 0 && waitpid(s->child, &status, 0) == s->child;
    int signal = known && WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    close(s->line);
    s->line = -1, s->child = -1;
    s->shared->where[sizeof s->shared->where - 1] = 0;
    const char *where = s->shared->where[0] ? s->shared->where : "input";
    if (signal == SIGBUS)
        return why_set(why, EX_DATAERR, "%.250s: has become shorter while it was read", where);
    if (signal == SIGXCPU)
        return why_set(why, EX_DATAERR, "%.250s: takes too long to read: damaged, or made to",
                       where);
    if (signal == SIGKILL)
        return why_set(why, EX_SOFTWARE, "%.250s: reading it was killed (no memory?)", where);
    return why_set(why, EX_DATAERR, "%.250s: libhdf5 breaks down over it (%s): damaged, or made to",
                   where, signal ? strsignal(signal) : "it ended");
}

/* Where the data of an answer go: `size` bytes at out or, where out is NULL, fresh memory. */
struct taker {
    struct sink sink;
    void *out;
    uint64_t size, done;
    struct reply reply;
    struct why *why;
};

static int taker_begin(struct sink *sink, const struct reply *reply)
{
    struct taker *t = (struct taker *)sink;
    t->reply = *reply;
    t->reply.text[sizeof t->reply.text - 1] = 0;
    if (!t->out) {
        t->size = reply->size;
        if (reply->size > SIZE_MAX / 2 || !(t->out = malloc((size_t)reply->size + 8)))
            return why_set(t->why, EX_SOFTWARE, "no memory for %llu bytes of a document",
                           (unsigned long long)reply->size);
        memset((char *)t->out + reply->size, 0, 8);
    }
    return reply->size == t->size ? 0 : why_set(t->why, EX_DATAERR, "an answer of another size");
}

static void *taker_room(struct sink *sink, size_t *most)
{
    struct taker *t = (struct taker *)sink;
    *most = (size_t)(t->size - t->done);
    return (char *)t->out + t->done;
}

static int taker_put(struct sink *sink, size_t size)
{
    ((struct taker *)sink)->done += size;
    return 0;
}

/* All pieces of an answer, out of shared memory */
static int take(struct source *s, struct taker *t, struct why *why)
{
    struct reply r;
    bool begun = false;
    for (uint64_t pieces = 0;; pieces++) {
        if (recv(s->line, &r, sizeof r, 0) != sizeof r) return child_gone(s, why);
        r.text[sizeof r.text - 1] = 0;
        if (r.status) return why_set(why, r.status, "%s", r.text);
        if (!begun && taker_begin(&t->sink, &r)) return why->status;
        begun = true;
        if (r.here > SERVE_PIECE || r.here > t->size - t->done || (!r.here && t->done < t->size))
            return why_set(why, EX_DATAERR, "%.250s: an answer of another size", s->shared->where);
        if (r.here && t->out)
            memcpy((char *)t->out + t->done, s->shared->piece[pieces % 2], (size_t)r.here);
        t->done += r.here;
        if (t->done == t->size) return 0;
        if (send(s->line, "", 1, MSG_NOSIGNAL) != 1) return child_gone(s, why);
    }
}

static int ask(struct source *s, const struct request *q, struct taker *t, struct why *why)
{
    t->sink = (struct sink){ taker_begin, taker_room, taker_put };
    t->why = why;
    void *given = t->out;
    int e;
    if (!s->child)
        e = serve_answer(&s->own, q, &t->sink, why);
    else if (s->line < 0 || send(s->line, q, sizeof *q, MSG_NOSIGNAL) != sizeof *q)
        e = s->line < 0 ? why_set(why, EX_DATAERR, "%s: no longer read", s->where)
                        : child_gone(s, why);
    else
        e = take(s, t, why);
    if (e || why->status) {
        if (!given) free(t->out), t->out = NULL;
        return why->status ? why->status : why_set(why, EX_SOFTWARE, "no answer");
    }
    return 0;
}

static struct request request(int op, const char *path)
{
    struct request q;
    memset(&q, 0, sizeof q);
    q.op = op;
    snprintf(q.path, sizeof q.path, "%s", path);
    return q;
}

/* ---- the list of objects ---- */

static uint64_t padded(uint64_t size)
{
    return (size + 7) / 8 * 8;
}

bool source_unpack(const unsigned char *bytes, uint64_t size, uint64_t *at, struct object *o,
                   const uint64_t **shape, const char **name, const void **data)
{
    if (size - *at < padded(sizeof *o)) return false;
    memcpy(o, bytes + *at, sizeof *o);
    uint64_t left = size - *at - padded(sizeof *o), rank = o->rank > SERVE_RANK ? 0 : o->rank;
    uint64_t shapes = rank * sizeof **shape;
    if (shapes > left || padded(o->name) > left - shapes || !o->name || o->data > left ||
        padded(o->data) > left - shapes - padded(o->name))
        return false;
    const unsigned char *p = bytes + *at + padded(sizeof *o);
    *shape = (const uint64_t *)(const void *)p; // all is padded to 8 bytes
    *name = (const char *)p + shapes;
    *data = p + shapes + padded(o->name);
    *at += padded(sizeof *o) + shapes + padded(o->name) + padded(o->data);
    return (*name)[o->name - 1] == 0;
}

static int list_objects(struct source *s, uint64_t size, struct why *why)
{
    int64_t room = 0;
    struct listed l;
    for (uint64_t at = 0; at < size; s->objects++) {
        if (s->objects == room) {
            room = room ? 2 * room : 128;
            struct listed *more = realloc(s->object, (size_t)room * sizeof *more);
            if (!more) return why_set(why, EX_SOFTWARE, "no memory for a list of objects");
            s->object = more;
        }
        if (!source_unpack(s->catalogue, size, &at, &l.object, &l.shape, &l.path, &l.data))
            return why_set(why, EX_DATAERR, "%.250s: no list of objects", s->where);
        s->object[s->objects] = l;
    }
    return 0;
}

int source_of_own(struct source **out, hid_t file, struct why *why)
{
    struct source *s = *out = calloc(1, sizeof *s);
    size_t size = 0;
    hsize_t length = 0;
    if (!s) return why_set(why, EX_SOFTWARE, "no memory");
    s->line = -1, s->own.file = -1;
    if (file < 0) return why_set(why, EX_DATAERR, "not a readable HDF5 file");
    H5Fget_filesize(file, &length);
    if (serve_open(&s->own, file, length, limit, why)) return why->status;
    s->catalogue = serve_objects(&s->own, &size, why);
    return s->catalogue ? list_objects(s, size, why) : why->status;
}

int source_next(struct source *s, struct source_document *d, bool *more, struct why *why)
{
    struct request q = request(REQUEST_NEXT, "");
    struct taker t = { 0 };
    forget_objects(s);
    *more = false;
    if (ask(s, &q, &t, why)) return why->status;
    s->catalogue = t.out;
    if (!t.reply.there) return 0;
    snprintf(s->name, sizeof s->name, "%.290s", t.reply.text);
    snprintf(s->where, sizeof s->where, t.reply.number > 1 ? "%.250s: document %lld" : "%.250s",
             s->name, (long long)t.reply.number);
    *d = (struct source_document){ s->name, t.reply.number, t.reply.foreign, t.reply.unfinished };
    *more = true;
    s->large = t.reply.document > LARGE;
    return list_objects(s, t.size, why);
}

static const struct listed *find(const struct source *s, const char *path)
{
    for (int64_t k = 0; k < s->objects; k++)
        if (!s->object[k].object.attribute && !strcmp(s->object[k].path, path))
            return &s->object[k];
    return NULL;
}

/* An attribute that came with the list; NULL: it has to be asked for. */
static const struct listed *find_attribute(const struct source *s, const char *path,
                                           const char *name)
{
    size_t n = strlen(path);
    for (int64_t k = 0; k < s->objects; k++) {
        const struct listed *l = &s->object[k];
        if (l->object.attribute && l->object.data && !strncmp(l->path, path, n) &&
            l->path[n] == '@' && !strcmp(l->path + n + 1, name))
            return l;
    }
    return NULL;
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

/* Numbers first .. first+n-1 of it, converted; false where they do not fit, which has to be told. */
static bool convert(const struct listed *l, uint64_t first, uint64_t n, enum column_type type,
                    void *out)
{
    const struct object *o = &l->object;
    if (o->kind != OBJECT_NUMBERS || (o->class == 'f' && type != COLUMN_F64)) return false;
    if (n > UINT64_MAX / 16 || first > UINT64_MAX / 16 || (first + n) * o->size > o->data)
        return false;
    if ((o->class == 'f' && o->size == 8) ||
        (o->class == 'i' && type != COLUMN_F64 && column_size(type) == o->size)) {
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
        memcpy((char *)out + k * column_size(type), &i, column_size(type));
    }
    return true;
}

bool source_has(const struct source *s, const char *path)
{
    return find(s, path);
}

int source_shape(const struct source *s, const char *path, uint64_t shape[4])
{
    const struct listed *l = find(s, path);
    if (!l || l->object.kind == OBJECT_GROUP || l->object.rank > 4) return -1;
    for (uint32_t k = 0; k < l->object.rank; k++) shape[k] = l->shape[k];
    return (int)l->object.rank;
}

const struct object *source_object(const struct source *s, int64_t k, const char **path,
                                   const uint64_t **shape)
{
    if (k >= s->objects) return NULL;
    *path = s->object[k].path, *shape = s->object[k].shape;
    return &s->object[k].object;
}

/* ---- requests ---- */

int source_unload(struct source *s, struct why *why)
{
    struct request q = request(REQUEST_UNLOAD, "");
    struct taker t = { .out = &q };
    return s->child && s->large ? ask(s, &q, &t, why) : 0;
}

int source_release(struct source *s, struct why *why)
{
    struct request q = request(REQUEST_RELEASE, "");
    struct taker t = { .out = &q };
    forget_objects(s);
    return s->child && s->large ? ask(s, &q, &t, why) : 0;
}

int source_rows(struct source *s, const char *path, enum column_type type, int64_t start, int64_t n,
                int64_t width, void *out, struct why *why)
{
    struct request q = request(REQUEST_ROWS, path);
    struct taker t = { .out = out, .size = (uint64_t)(n * width) * column_size(type) };
    if (!t.size) t.out = &q; // nothing is written there
    const struct listed *l = find(s, path);
    if (l && l->object.data && l->object.rank && start >= 0 && n >= 0 && width > 0) {
        uint64_t row = 1;
        for (uint32_t k = 1; k < l->object.rank; k++) row *= l->shape[k];
        if (row == (uint64_t)width && (uint64_t)start + (uint64_t)n <= l->shape[0] &&
            convert(l, (uint64_t)(start * width), (uint64_t)(n * width), type, out))
            return 0;
    }
    q.type = type, q.start = start, q.n = n, q.width = width;
    return ask(s, &q, &t, why);
}

void *source_read_all(struct source *s, const char *path, enum column_type type, uint64_t *count,
                      struct why *why)
{
    struct request q = request(REQUEST_ROWS, path);
    struct taker t = { 0 };
    q.type = type, q.n = -1;
    *count = 0;
    const struct listed *l = find(s, path);
    if (l && l->object.data && l->object.size) {
        uint64_t n = l->object.data / l->object.size;
        void *out = calloc(n + 1, 8);
        if (!out) return why_set(why, EX_SOFTWARE, "%s: no memory", path), NULL;
        *count = n;
        if (convert(l, 0, n, type, out)) return out;
        free(out);
        *count = 0;
    }
    if (ask(s, &q, &t, why)) return NULL;
    *count = t.size / column_size(type);
    return t.out;
}

int source_read(struct source *s, const char *path, enum column_type type, uint64_t count,
                void *out, struct why *why)
{
    uint64_t found;
    void *data = source_read_all(s, path, type, &found, why);
    if (!data) return why->status;
    if (found == count)
        memcpy(out, data, (size_t)count * column_size(type));
    else
        why_set(why, EX_DATAERR, "%s: %llu values, %llu are wanted", path,
                (unsigned long long)found, (unsigned long long)count);
    free(data);
    return why->status;
}

char *source_text(struct source *s, const char *path, const char *name, struct why *why)
{
    struct request q = request(REQUEST_TEXT, path);
    struct taker t = { 0 };
    const struct listed *l = name ? find_attribute(s, path, name) : find(s, path);
    if (!name && !l) return NULL;
    if (l && l->object.kind == OBJECT_TEXT && !l->object.rank && l->object.data) {
        char *text = strndup(l->data, l->object.data);
        if (!text) why_set(why, EX_SOFTWARE, "%s: no memory", path);
        return text;
    }
    if (name) snprintf(q.name, sizeof q.name, "%s", name);
    if (ask(s, &q, &t, why)) return NULL;
    if (!t.reply.there) free(t.out), t.out = NULL;
    return t.out;
}

int source_attribute(struct source *s, const char *path, const char *name, enum column_type type,
                     int count, void *out, struct why *why)
{
    struct request q = request(REQUEST_ATTRIBUTE, path);
    struct taker t = { .out = out, .size = (count < 0 ? 1 : (uint64_t)count) * column_size(type) };
    q.type = type, q.n = count;
    const struct listed *l = find_attribute(s, path, name);
    uint64_t n = count < 0 ? 1 : (uint64_t)count;
    if (l && l->object.size && l->object.data / l->object.size == n && convert(l, 0, n, type, out))
        return 0;
    snprintf(q.name, sizeof q.name, "%s", name);
    return ask(s, &q, &t, why);
}

/* Cut into strings; false where it is something else. */
static bool cut_texts(const struct object *o, const uint64_t *shape, const char *data, int count,
                      char out[][16])
{
    if (o->kind != OBJECT_TEXT || o->rank != 1 || shape[0] != (uint64_t)count || !o->size ||
        o->data != shape[0] * o->size)
        return false;
    for (int k = 0; k < count; k++)
        snprintf(out[k], sizeof out[k], "%.*s", (int)(o->size < 15 ? o->size : 15),
                 data + (size_t)k * o->size);
    return true;
}

int source_texts(struct source *s, const char *path, const char *name, int count, char out[][16],
                 bool *there, struct why *why)
{
    const struct listed *l = find_attribute(s, path, name);
    *there = l && cut_texts(&l->object, l->shape, l->data, count, out);
    if (l || !find(s, path)) return 0;
    uint64_t size = 0, at = 0;
    struct object o;
    const uint64_t *shape;
    const char *is;
    const void *data;
    unsigned char *bytes = source_attributes(s, path, &size, why); // the list was too long for it
    while (bytes && source_unpack(bytes, size, &at, &o, &shape, &is, &data))
        if (!strcmp(is, name)) *there = cut_texts(&o, shape, data, count, out);
    free(bytes);
    return why->status;
}

void *source_raw(struct source *s, const char *path, uint64_t *size, struct why *why)
{
    struct request q = request(REQUEST_RAW, path);
    struct taker t = { 0 };
    if (ask(s, &q, &t, why)) return NULL;
    *size = t.size;
    return t.out;
}

void *source_attributes(struct source *s, const char *path, uint64_t *size, struct why *why)
{
    struct request q = request(REQUEST_ATTRIBUTES, path);
    struct taker t = { 0 };
    if (ask(s, &q, &t, why)) return NULL;
    *size = t.size;
    return t.out;
}
