#include "file/server.h"

#include "base/bounded.h"
#include "base/output.h"
#include "file/serve.h"
#include "file/stream.h"

#include <fcntl.h>
#include <hdf5_hl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <unistd.h>

/* What a child may take for a document. */
enum {
    SPARE_MEMORY = 1 << 28, /* bytes: libhdf5, its caches, and a packed chunk */
    MEMORY_RATIO = 4,       /* and so many times the document */
    SPARE_SECONDS = 4,      /* of the processor, for an answer: a good one takes milliseconds, */
    RATE = 10000000         /* and bytes a second: a tenth of what gzip unpacks */
};

enum {
    TRIES = 3,     /* more at a document that is being written, */
    PAUSE = 20000, /* us before each */
    AT_END = 40 /* where HDF5's superblock, its version 0, says in 8 bytes how long the file is */
};

/* ---- bounds ---- */

static void bound_memory(uint64_t size, uint64_t limit)
{
    limits_memory(SPARE_MEMORY + MEMORY_RATIO * size + limit);
}

static void bound_time(uint64_t size, uint64_t limit)
{
    limits_processor(SPARE_SECONDS + (size + limit) / RATE);
}

/* ---- answers, as messages and pieces ---- */

struct server {
    struct sink sink;
    int line;
    struct server_memory *shared;
    struct reply reply;
    uint64_t sent, pieces, acknowledged;
    uint64_t limit; /* as of served_open */
    struct stream *stream;
    struct image image; /* the document in hand; without bytes: none */
    struct served served;
};

static bool send_reply(struct server *s)
{
    return line_send(s->line, &s->reply, sizeof s->reply);
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
        if (line_receive(s->line, &word, 1) == 1)
            s->acknowledged++;
        else
            _exit(EX_OSERR);
    *most = REQUEST_PIECE;
    return s->shared->piece[s->pieces % 2];
}

static int server_put(struct sink *sink, size_t size)
{
    struct server *s = (struct server *)sink;
    s->reply.here = size;
    s->sent += size, s->pieces++;
    return s->sent <= s->reply.size && send_reply(s) ? 0 : -1;
}

/* ---- requests ---- */

/*
 * A document that is being written [file/writer.c]: libhdf5 learns once, now, where it ends, and then comes upon what
 * has been added since and lies beyond. Its end is therefore said to be that of all that may be looked at, in our
 * copy of a page of it. Returns how many bytes there are; where what is said to be there is not: as it is.
 */
static size_t look_ahead(const struct server *s, const struct image *im, unsigned char **end)
{
    static const unsigned char version_0[9] = "\x89HDF\r\n\x1a\n";
    unsigned char *superblock = im->bytes + DOCUMENT_USERBLOCK;
    uint64_t said = 0;
    if (im->room == im->size || im->size < DOCUMENT_USERBLOCK + AT_END + 8 ||
        memcmp(superblock, version_0, sizeof version_0) != 0)
        return im->size;
    for (int k = 0; k < 8; k++) said |= (uint64_t)superblock[AT_END + k] << 8 * k;
    if (said > stream_grown(s->stream, im)) return im->size;
    *end = superblock + AT_END;
    for (int k = 0; k < 8; k++) (*end)[k] = (unsigned char)((uint64_t)im->room >> 8 * k);
    return im->room;
}

/* The page is the file's again. */
static void look_back(unsigned char *end)
{
    const uintptr_t page = (uintptr_t)sysconf(_SC_PAGESIZE), skip = (uintptr_t)end % page;
    if (end) madvise(end - skip, page, MADV_DONTNEED);
}

static int open_image(struct server *s, const struct image *im, struct failure *failure)
{
    unsigned char *end = NULL;
    size_t size = look_ahead(s, im, &end);
    hid_t file = H5LTopen_file_image(im->bytes, size,
                                     H5LT_FILE_IMAGE_DONT_COPY | H5LT_FILE_IMAGE_DONT_RELEASE);
    look_back(end);
    if (file < 0)
        return failure_set(failure, EX_DATAERR, "not a readable HDF5 file (truncated or damaged)");
    // a writer shows a frame's step after all else: what is looked at later is there for each step that is
    hid_t step = im->unfinished ? H5Dopen2(file, "/particles/all/position/step", H5P_DEFAULT) : -1;
    int status = served_open(&s->served, file, im->size, s->limit, failure);
    if (step >= 0) H5Dclose(step);
    return status;
}

/* A block that was read while it was being written contradicts its checksum: a moment later it does not. */
static bool is_torn(const struct server *s, const struct image *im, const struct failure *failure)
{
    if (failure->status != EX_DATAERR || !im->unfinished || !stream_changed(s->stream))
        return false;
    usleep(PAUSE);
    return true;
}

/* The next document, and all that is in it */
static int answer_next(struct server *s, struct failure *failure)
{
    struct image im;
    struct reply reply = { 0 };
    served_close(&s->served);
    s->image.bytes = NULL;
    limits_lift();
    if (stream_next(s->stream, &im, failure)) return failure->status;
    if (!im.bytes) return s->sink.begin(&s->sink, &reply);
    snprintf(s->shared->where, sizeof s->shared->where,
             im.number > 1 ? "%.250s: document %lld" : "%.250s", im.name, (long long)im.number);
    bound_memory(im.size, s->limit), bound_time(im.size, s->limit);
    size_t size = 0;
    void *objects = open_image(s, &im, failure) ? NULL : serve_objects(&s->served, &size, failure);
    for (int try = 0; !objects && try < TRIES && is_torn(s, &im, failure); try++) {
        served_close(&s->served), *failure = (struct failure){ 0 };
        objects = open_image(s, &im, failure) ? NULL : serve_objects(&s->served, &size, failure);
    }
    if (!objects) {
        char text[sizeof failure->text];
        memcpy(text, failure->text, sizeof text);
        snprintf(failure->text, sizeof failure->text, "%.120s: %.270s", s->shared->where, text);
        return failure->status;
    }
    reply.foreign = im.foreign, reply.unfinished = im.unfinished, reply.number = im.number;
    reply.document = im.size, reply.plain = !s->served.chunked;
    s->image = im;
    snprintf(reply.text, sizeof reply.text, "%s", im.name);
    int e = sink_bytes(&s->sink, &reply, objects, size);
    free(objects);
    return e ? failure_set(failure, EX_SOFTWARE, "not sent") : 0;
}

static int answer_image(struct server *s, struct failure *failure)
{
    struct reply reply = { 0 };
    if (!s->image.bytes) return failure_set(failure, EX_SOFTWARE, "no document");
    return sink_bytes(&s->sink, &reply, s->image.bytes, s->image.size)
               ? failure_set(failure, EX_SOFTWARE, "not sent")
               : 0;
}

static int server_answer(struct server *s, const struct request *q, struct failure *failure)
{
    struct reply done = { .there = true };
    if (q->op == REQUEST_IMAGE) return answer_image(s, failure);
    if (q->op == REQUEST_NEXT) return answer_next(s, failure);
    bound_time(s->served.size, s->limit);
    if (q->op != REQUEST_UNLOAD && q->op != REQUEST_RELEASE)
        return serve_answer(&s->served, q, &s->sink, failure);
    if (q->op == REQUEST_RELEASE)
        served_close(&s->served), s->image.bytes = NULL, stream_release(s->stream);
    if (q->op == REQUEST_UNLOAD) stream_unload(s->stream);
    return s->sink.begin(&s->sink, &done);
}

/* Requests and answers until the parent hangs up */
static void serve(struct server *s)
{
    struct request q;
    ssize_t n;
    while ((n = line_receive(s->line, &q, sizeof q)) > 0) {
        struct failure failure = { 0 };
        if (n == 1) continue; // the last pieces are not waited for
        if (n != sizeof q) break;
        if (!server_answer(s, &q, &failure)) continue;
        s->reply = (struct reply){ .status = failure.status ? failure.status : EX_SOFTWARE };
        snprintf(s->reply.text, sizeof s->reply.text, "%s", failure.text);
        if (!send_reply(s)) break;
    }
}

#ifdef NSD_COVERAGE
#include <malloc.h>
void __gcov_dump(void);
#endif

void server_run(int line, struct server_memory *shared, int files, char *const *file,
                uint64_t limit, pid_t parent)
{
    struct server s = { .sink = { server_begin, server_room, server_put },
                        .line = line,
                        .shared = shared,
                        .limit = limit,
                        .served.file = -1 };
    struct failure failure = { 0 };
#ifndef NSD_COVERAGE
    // standard input is not kept open when the tool is gone; a program's threads may end before it does
    if (!embedded_is()) prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(0);
#else
    (void)parent;
#endif
    limits_no_core();
    int null = open("/dev/null", O_WRONLY | O_CLOEXEC);
    dup2(null, STDOUT_FILENO); // who reads our output shall not wait for this process
    if (!SANITIZED) dup2(null, STDERR_FILENO);
    served_start();
    if (!stream_open(&s.stream, files, file, &failure)) serve(&s);
#ifdef NSD_COVERAGE
    // tells tests/support/preload/failing_allocations.c that what follows is not ours
    malloc_trim(0);
    __gcov_dump();
#endif
    _exit(0);
}
