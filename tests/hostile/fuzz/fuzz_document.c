/*
 * Documents: bytes as a reader gets them, the header made right so that what is behind it is reached.
 * Every frame is read, and written again with what nsd does not know. libhdf5 runs in the reading
 * process and may break down there: that is an answer. The first byte of the input says whether it
 * is a finished document, an unfinished or a foreign one.
 */
#define _GNU_SOURCE
#include "file/reader.h"
#include "file/stream.h"
#include "file/writer.h"
#include "fuzz.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

static void read_all(char *path)
{
    struct reader *r = NULL;
    struct writer *w = NULL;
    struct frame f = { 0 };
    struct failure failure = { 0 };
    bool more;
    if (reader_open(&r, 1, &path, &failure)) abort();
    reader_copies(r);
    while (!reader_next(r, NULL, &f, &more, &failure) && more) {
        struct failure other = { 0 };
        if (!w && writer_open(&w, "/dev/null", WRITER_STREAM, &other)) abort();
        if (writer_frame(w, &f, &other) && !other.text[0]) abort();
    }
    if (failure.status && (!failure.text[0] || strchr(failure.text, '\n'))) abort();
    if (w) writer_close(w, &(struct failure){ 0 });
    frame_free(&f);
    reader_close(r);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < 2 || size > 1 << 20) return -1;
    unsigned char header[DOCUMENT_USERBLOCK];
    int kind = data[0] % 3;
    data++, size--;
    document_header(header, kind == 0 ? size + sizeof header : 0, document_crc(0, data, size));
    int fd = memfd_create("document", 0);
    char path[40];
    if (fd < 0) abort();
    if (kind < 2 && write(fd, header, sizeof header) != sizeof header) abort();
    if (write(fd, data, size) != (ssize_t)size) abort();
    snprintf(path, sizeof path, "/proc/self/fd/%d", fd);
    // the reader's child opens it by its own descriptor of the same number
    read_all(path);
    close(fd);
    return 0;
}
