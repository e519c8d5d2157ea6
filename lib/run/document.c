#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier): memfd_create
/* run/document.c: documents in memory, by files that have no name. */
#include "run/document.h"

#include "file/reader.h"
#include "file/writer.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

/* All bytes into a file in memory; its descriptor, or -1 */
static int to_file(const void *bytes, size_t size)
{
    int fd = memfd_create("document", MFD_CLOEXEC);
    const char *at = bytes;
    while (fd >= 0 && size > 0) {
        ssize_t n = write(fd, at, size);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return close(fd), -1;
        at += n, size -= (size_t)n;
    }
    return fd;
}

/* In messages it is no file. */
static void name_memory(struct failure *failure, const char *path)
{
    char text[sizeof failure->text];
    size_t n = strlen(path);
    char *at = strstr(failure->text, path);
    if (!at) return;
    snprintf(text, sizeof text, "%.*sthe document%s", (int)(at - failure->text), failure->text,
             at + n);
    snprintf(failure->text, sizeof failure->text, "%s", text);
}

static int read_last(struct frame *f, char *path, struct failure *failure)
{
    struct reader *in;
    bool more = false;
    if (!reader_open(&in, 1, &path, failure)) {
        reader_copies(in);
        if (!reader_last(in, f, &more, failure) && !more)
            failure_set(failure, EX_DATAERR, "%.200s: no frame to start from", path);
        if (!failure->status && !f->packed)
            failure_set(failure, EX_DATAERR, "%.200s: an FCLIB problem has no bodies", path);
    }
    reader_close(in);
    return failure->status;
}

int document_read_file(struct frame *f, const char *path, struct failure *failure)
{
    char *copy = strdup(path);
    if (!copy) return failure_set(failure, EX_SOFTWARE, "no memory for a path");
    read_last(f, copy, failure);
    free(copy);
    return failure->status;
}

int document_read(struct frame *f, const void *bytes, size_t size, struct failure *failure)
{
    char path[40];
    int fd = to_file(bytes, size);
    if (fd < 0) return failure_set(failure, EX_SOFTWARE, "no memory for a document");
    snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
    if (read_last(f, path, failure)) name_memory(failure, path);
    close(fd);
    return failure->status;
}

/* All of a file, to be freed */
static char *bytes_of(int fd, size_t *size)
{
    struct stat st = { 0 };
    if (fstat(fd, &st)) return NULL;
    char *bytes = malloc((size_t)st.st_size + 1);
    *size = (size_t)st.st_size;
    for (size_t at = 0; bytes && at < *size;) {
        ssize_t n = pread(fd, bytes + at, *size - at, (off_t)at);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return free(bytes), NULL;
        at += (size_t)n;
    }
    return bytes;
}

char *document_write(const struct frame *f, size_t *size, struct failure *failure)
{
    struct writer *out = NULL;
    char path[40], *bytes = NULL;
    int fd = memfd_create("document", MFD_CLOEXEC);
    if (fd < 0) return failure_set(failure, EX_SOFTWARE, "no memory for a document"), NULL;
    snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
    if (writer_open(&out, path, WRITER_STREAM, failure) || writer_frame(out, f, failure))
        writer_drop(out);
    else if (!writer_close(out, failure) && !(bytes = bytes_of(fd, size)))
        failure_set(failure, EX_SOFTWARE, "no memory for a document");
    close(fd);
    return bytes;
}
