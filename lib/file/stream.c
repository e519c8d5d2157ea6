#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier): mremap, F_SETPIPE_SZ
#include "file/stream.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static const unsigned char MAGIC[8] = "\x89NSD\r\n\x1a\n", HDF5[8] = "\x89HDF\r\n\x1a\n";

/* Where the fields of the header begin, in bytes */
enum { AT_VERSION = 8, AT_FLAGS = 12, AT_LENGTH = 16, AT_CRC = 24, AT_HEADER_CRC = 28 };

enum {
    LARGE = 1 << 26,  /* bytes: a document from here on outweighs the tool, and is not kept */
    GROWTH = 1 << 26, /* bytes by which an unfinished document may grow while it is read */
    PIPE = 1 << 20,   /* bytes that a pipe shall hold, the most that is anybody's: fewer waits */
    SPENT =
        1
        << 20, /* bytes of a file whose documents have been read: worth a call that gives them back */
    PIECE = 1 << 19 /* bytes whose checksum is taken while they are in a core's second cache */
};

static void stream_store(unsigned char *p, uint64_t x, int bytes)
{
    for (int k = 0; k < bytes; k++) p[k] = (unsigned char)(x >> (8 * k));
}

static uint64_t stream_load(const unsigned char *p, int bytes)
{
    uint64_t x = 0;
    for (int k = 0; k < bytes; k++) x |= (uint64_t)p[k] << (8 * k);
    return x;
}

void document_header(unsigned char u[DOCUMENT_USERBLOCK], uint64_t length, uint32_t crc)
{
    memset(u, 0, DOCUMENT_USERBLOCK);
    memcpy(u, MAGIC, sizeof MAGIC);
    stream_store(u + AT_VERSION, DOCUMENT_VERSION, 4);
    stream_store(u + AT_FLAGS, length ? 0 : DOCUMENT_UNFINISHED, 4);
    stream_store(u + AT_LENGTH, length, 8);
    stream_store(u + AT_CRC, crc, 4);
    stream_store(u + AT_HEADER_CRC, document_crc(0, u, AT_HEADER_CRC), 4);
}

struct stream {
    int files, next; /* next: the file to open after the current one */
    char *const *file;
    const char *name;
    int fd;                  /* -1: none open */
    int64_t in_file;         /* documents found in it so far */
    struct timespec written; /* when it was last, as it was opened */
    unsigned char *map;      /* a whole regular file; NULL: a pipe */
    size_t size, at;         /* of that file when it was opened, and how much of it is read */
    size_t spent;            /* bytes of the map that have been given back */
    size_t mapped;           /* bytes of the map, and of addresses behind it for what will grow */
    unsigned char *buffer, *spare; /* a pipe's document, and the one before it */
    size_t room, spare_room;
    unsigned char *old; /* the map of the file before */
    size_t old_mapped;
};

int stream_open(struct stream **out, int files, char *const *file, struct failure *failure)
{
    struct stream *s = *out = calloc(1, sizeof *s);
    if (!s) return failure_set(failure, EX_SOFTWARE, "no memory");
    static char *const standard[] = { "-" };
    s->files = files ? files : 1;
    s->file = files ? file : standard;
    s->fd = -1;
    return 0;
}

static void file_close(struct stream *s)
{
    if (s->old && s->map) munmap(s->old, s->old_mapped);
    if (s->map) s->old = s->map, s->old_mapped = s->mapped;
    if (s->fd > 0) close(s->fd);
    s->map = NULL, s->size = s->mapped = s->spent = s->at = 0, s->fd = -1;
}

static void buffer_free(struct stream *s)
{
    if (s->buffer) munmap(s->buffer, s->room);
    s->buffer = NULL, s->room = 0;
}

/* The last document keeps its buffer; the next one goes into the other. */
static void swap_buffers(struct stream *s)
{
    unsigned char *b = s->buffer;
    size_t room = s->room;
    s->buffer = s->spare, s->room = s->spare_room;
    s->spare = b, s->spare_room = room;
}

/*
 * Room for more of a document, that which has arrived kept. Pages are the system's only once they are
 * written; large ones, for half the time that a document takes in small ones is spent on getting them.
 */
static bool buffer_grow(struct stream *s, size_t room)
{
    void *b = s->buffer ? mremap(s->buffer, s->room, room, MREMAP_MAYMOVE)
                        : mmap(NULL, room, PROT_READ | PROT_WRITE,
                               MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (b == MAP_FAILED) return false;
    s->buffer = b, s->room = room;
    madvise(b, room, MADV_HUGEPAGE);
    return true;
}

void stream_unload(const struct stream *s)
{
    if (s->map && s->size > LARGE) madvise(s->map, s->size, MADV_DONTNEED); // the pages are clean
}

/* The pages of documents that have been read: a stream of any length in a file takes the memory of a document. */
static void unload_spent(struct stream *s)
{
    const size_t end = s->at - s->at % (size_t)sysconf(_SC_PAGESIZE);
    if (!s->map || end < s->spent + SPENT) return;
    madvise(s->map + s->spent, end - s->spent, MADV_DONTNEED);
    s->spent = end;
}

void stream_release(struct stream *s)
{
    stream_unload(s);
    if (s->room > LARGE) buffer_free(s); // else kept for the next document
}

static int file_open(struct stream *s, struct failure *failure)
{
    const char *path = s->file[s->next++];
    bool standard = !strcmp(path, "-");
    s->name = standard ? "standard input" : path;
    s->fd = standard ? STDIN_FILENO : open(path, O_RDONLY | O_CLOEXEC);
    s->in_file = 0;
    struct stat st;
    if (s->fd < 0 || fstat(s->fd, &st))
        return failure_set(failure, EX_NOINPUT, "%s: %s", s->name, strerror(errno));
    if (isatty(s->fd))
        return failure_set(failure, EX_USAGE,
                           "%s is a terminal: give a FILE, or a pipe (see --help)", s->name);
    if (S_ISDIR(st.st_mode)) return failure_set(failure, EX_NOINPUT, "%s: is a directory", s->name);
    if (S_ISFIFO(st.st_mode)) fcntl(s->fd, F_SETPIPE_SZ, PIPE); // or it stays as it is
    off_t at = S_ISREG(st.st_mode) ? lseek(s->fd, 0, SEEK_CUR) : -1;
    if (at < 0 || st.st_size <= at) return 0; // a pipe, or an empty file
    s->size = (size_t)st.st_size, s->at = (size_t)at, s->written = st.st_mtim;
    s->mapped = s->size;
    s->map = mmap(NULL, s->size, PROT_READ | PROT_WRITE, MAP_PRIVATE, s->fd, 0);
    if (s->map != MAP_FAILED) return 0;
    s->map = NULL;
    return failure_set(failure, EX_NOINPUT, "%s: %s", s->name, strerror(errno));
}

/* Reads from a pipe until the buffer holds `want` bytes; where it ends early, *have < want. */
static int stream_fill(struct stream *s, size_t *have, size_t want, struct failure *failure)
{
    while (*have < want) {
        if (*have == s->room) { // grows with what arrives: the header's length is not trusted
            if (!buffer_grow(s, s->room ? 2 * s->room : 1 << 16))
                return failure_set(failure, EX_SOFTWARE, "%s: no memory for the document", s->name);
        }
        size_t most = (want < s->room ? want : s->room) - *have;
        ssize_t n = read(s->fd, s->buffer + *have, most);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return failure_set(failure, EX_NOINPUT, "%s: %s", s->name, strerror(errno));
        if (n == 0) return 0;
        *have += (size_t)n;
    }
    return 0;
}

/* The current document's first bytes: *have of the `want` that are asked for, at *bytes. */
static int peek(struct stream *s, unsigned char **bytes, size_t *have, size_t want,
                struct failure *failure)
{
    if (s->map) {
        *bytes = s->map + s->at;
        *have = s->size - s->at < want ? s->size - s->at : want;
        return 0;
    }
    int status = stream_fill(s, have, want, failure);
    *bytes = s->buffer;
    return status;
}

static int refuse(const struct stream *s, struct failure *failure, const char *trouble)
{
    if (s->in_file)
        return failure_set(failure, EX_DATAERR, "%s: document %lld: %s", s->name,
                           (long long)s->in_file + 1, trouble);
    return failure_set(failure, EX_DATAERR, "%s: %s", s->name, trouble);
}

/*
 * All of a document of `want` bytes, or as many as there are, in *have; the checksum of those after the
 * user block in *crc. In pieces: of a pipe's, while they are at hand; of a large file's, so that its pages do not
 * all stay.
 */
static int read_all(struct stream *s, struct image *im, size_t *have, size_t want, uint32_t *crc,
                    struct failure *failure)
{
    size_t at = DOCUMENT_USERBLOCK, unloaded = 0;
    for (*crc = 0; at < want && at <= *have; at = *have) {
        size_t next = want - at < PIECE ? want : at + PIECE;
        if (peek(s, &im->bytes, have, next, failure)) return failure->status;
        *crc = document_crc(*crc, im->bytes + at, *have - at);
        if (*have - unloaded >= LARGE) stream_unload(s), unloaded = *have;
        if (*have < next) break;
    }
    return 0;
}

/* Addresses for what a writer adds to the file while we read it; without them: as it was when it was opened */
static void let_grow(struct stream *s, struct image *im)
{
    void *more = s->map ? mremap(s->map, s->mapped, s->size + GROWTH, MREMAP_MAYMOVE) : MAP_FAILED;
    if (more == MAP_FAILED) return;
    s->map = more, s->mapped = s->size + GROWTH;
    im->bytes = s->map + s->at, im->room = im->size + GROWTH;
}

/* A document with our header: checks that and finds its size. */
static int read_own(struct stream *s, struct image *im, size_t have, struct failure *failure)
{
    const unsigned char *h = im->bytes;
    if (have < DOCUMENT_USERBLOCK) return refuse(s, failure, "truncated in its header");
    if (stream_load(h + AT_HEADER_CRC, 4) != document_crc(0, h, AT_HEADER_CRC))
        return refuse(s, failure, "damaged header (its checksum is wrong)");
    uint64_t version = stream_load(h + AT_VERSION, 4), length = stream_load(h + AT_LENGTH, 8);
    uint32_t crc = (uint32_t)stream_load(h + AT_CRC, 4);
    if (version > DOCUMENT_VERSION)
        return failure_set(failure, EX_DATAERR, "%s: document format %llu, this nsd reads up to %d",
                           s->name, (unsigned long long)version, DOCUMENT_VERSION);
    im->unfinished = stream_load(h + AT_FLAGS, 4) & DOCUMENT_UNFINISHED;
    if (!im->unfinished && length <= DOCUMENT_USERBLOCK)
        return refuse(s, failure, "damaged header");
    size_t want = im->unfinished ? SIZE_MAX : length;
    uint32_t is = 0;
    if (im->unfinished ? peek(s, &im->bytes, &have, want, failure)
                       : read_all(s, im, &have, want, &is, failure))
        return failure->status;
    im->size = im->room = have;
    if (im->unfinished) return let_grow(s, im), 0;
    if (have < want)
        return failure_set(failure, EX_DATAERR,
                           "%s: document %lld: %zu bytes, where its header says %zu: truncated, or "
                           "rewritten (h5repack?): then tail -c +513 makes it readable, see "
                           "nsd-format(5)",
                           s->name, (long long)s->in_file + 1, have, want);
    if (is != crc)
        return refuse(s, failure,
                      "damaged: its checksum is wrong (changed on purpose? see nsd-format(5))");
    return 0;
}

/* A foreign HDF5 file: all that the file or pipe still holds. */
static int stream_read_foreign(struct stream *s, struct image *im, size_t have,
                               struct failure *failure)
{
    im->foreign = true;
    if (peek(s, &im->bytes, &have, SIZE_MAX, failure)) return failure->status;
    im->size = im->room = have;
    return 0;
}

static bool is_hdf5(const unsigned char *b, size_t have)
{
    for (size_t at = 0; at + sizeof HDF5 <= have; at = at ? 2 * at : 512)
        if (!memcmp(b + at, HDF5, sizeof HDF5)) return true;
    return false;
}

int stream_next(struct stream *s, struct image *im, struct failure *failure)
{
    *im = (struct image){ 0 };
    swap_buffers(s);
    unload_spent(s);
    for (;;) {
        if (s->fd < 0) {
            im->bytes = NULL;
            if (s->next == s->files) return 0;
            if (file_open(s, failure)) return failure->status;
        }
        size_t have = 0;
        if (peek(s, &im->bytes, &have, DOCUMENT_USERBLOCK, failure)) return failure->status;
        if (!have && !s->in_file) return refuse(s, failure, "empty, not an nsd document");
        if (have) {
            im->name = s->name;
            int status;
            if (have >= sizeof MAGIC && !memcmp(im->bytes, MAGIC, sizeof MAGIC))
                status = read_own(s, im, have, failure);
            else if (!s->in_file && is_hdf5(im->bytes, have))
                status = stream_read_foreign(s, im, have, failure);
            else
                status = refuse(s, failure, "neither an nsd document nor an HDF5 file");
            s->at += im->size;
            s->in_file++;
            im->number = s->in_file;
            return status;
        }
        file_close(s);
    }
}

size_t stream_grown(const struct stream *s, const struct image *im)
{
    struct stat st;
    size_t at = s->at - im->size; // where the document begins
    if (im->room == im->size || fstat(s->fd, &st) || (size_t)st.st_size < at) return im->size;
    size_t now = (size_t)st.st_size - at;
    return now < im->room ? now : im->room;
}

bool stream_changed(const struct stream *s)
{
    struct stat st;
    return s->map && !fstat(s->fd, &st) &&
           ((size_t)st.st_size != s->size || st.st_mtim.tv_sec != s->written.tv_sec ||
            st.st_mtim.tv_nsec != s->written.tv_nsec);
}
