#include "io/reader.h"

#include "io/copy.h"
#include "io/frame_read.h"
#include "io/h5.h"
#include "io/stream.h"

#include <hdf5_hl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct reader {
    struct stream *stream;
    int files;
    char *const *file;
    struct frame_read doc;
    bool unchecked; /* no checksum vouches for the open document */
    int64_t next;   /* the frame that reader_next reads next */
    char where[300];
};

int reader_open(struct reader **out, int files, char *const *file, struct why *why)
{
    struct reader *r = *out = calloc(1, sizeof *r);
    if (!r) return why_set(why, EX_SOFTWARE, "no memory");
    h5_start();
    r->files = files, r->file = file, r->doc.tables.file = -1;
    return stream_open(&r->stream, files, file, why);
}

void reader_close(struct reader *r)
{
    if (!r) return;
    frame_read_close(&r->doc);
    stream_close(r->stream);
    free(r);
}

const char *reader_where(const struct reader *r)
{
    return r->where;
}

bool reader_reads(int files, char *const *file, const char *path)
{
    struct stat out, in;
    if (stat(path, &out)) return false;
    for (int i = 0; i < (files ? files : 1); i++) {
        bool standard = !files || !strcmp(file[i], "-");
        int failed = standard ? fstat(STDIN_FILENO, &in) : stat(file[i], &in);
        if (!failed && in.st_dev == out.st_dev && in.st_ino == out.st_ino) return true;
    }
    return false;
}

/* Puts the document's name in front of the reason. */
static int name_document(const struct reader *r, struct why *why)
{
    char text[sizeof why->text];
    memcpy(text, why->text, sizeof text);
    snprintf(why->text, sizeof why->text, "%.120s: %.270s", r->where, text);
    return why->status;
}

int reader_document(struct reader *r, int64_t *frames, struct why *why)
{
    struct image im;
    frame_read_close(&r->doc);
    r->next = 0, *frames = -1;
    if (stream_next(r->stream, &im, why)) return why->status;
    if (!im.bytes) return 0;
    snprintf(r->where, sizeof r->where, im.number > 1 ? "%s: document %lld" : "%s", im.name,
             (long long)im.number);
    hid_t file = H5LTopen_file_image(im.bytes, im.size,
                                     H5LT_FILE_IMAGE_DONT_COPY | H5LT_FILE_IMAGE_DONT_RELEASE);
    r->unchecked = im.foreign || im.unfinished;
    if (file < 0)
        why_set(why, EX_DATAERR, "not a readable HDF5 file (truncated or damaged)");
    else
        frame_read_open(&r->doc, file, why);
    if (why->status) return name_document(r, why);
    *frames = r->doc.frames;
    return 0;
}

int reader_frame(struct reader *r, int64_t k, struct frame *f, struct why *why)
{
    frame_free(f);
    f->unchecked = r->unchecked;
    if (frame_read_moment(&r->doc, k, f, why)) return name_document(r, why);
    if (f->packed) stream_unload(r->stream);
    return 0;
}

/* Closes a document once its only frame has been read: the memory may be needed. */
static void release(struct reader *r, struct frame *f)
{
    if (r->doc.frames != 1 || !f->packed || copy_wanted(f)) return;
    f->origin = 0;
    frame_read_close(&r->doc);
    stream_release(r->stream);
}

bool reader_has(const struct reader *r, int64_t k, const struct range *steps)
{
    return !r->doc.step || range_has(steps, r->doc.step[k]);
}

int reader_next(struct reader *r, const struct range *steps, struct frame *f, bool *more,
                struct why *why)
{
    for (;;) {
        while (steps && r->next < r->doc.frames && !reader_has(r, r->next, steps)) r->next++;
        *more = r->next < r->doc.frames;
        if (*more) break;
        int64_t frames;
        if (reader_document(r, &frames, why)) return why->status;
        if (frames >= 0) continue;
        frame_free(f);
        return 0;
    }
    if (reader_frame(r, r->next++, f, why)) return why->status;
    release(r, f);
    return 0;
}

int reader_last(struct reader *r, struct frame *f, bool *more, struct why *why)
{
    int64_t frames;
    struct frame_read held = { .tables.file = -1 }; // the document of *f, for its unknown objects
    *more = false;
    for (;;) {
        if (*more) held = r->doc, r->doc = (struct frame_read){ .tables.file = -1 };
        int e = reader_document(r, &frames, why);
        if (!e && frames < 0) {
            r->doc = held;
            return 0;
        }
        frame_read_close(&held);
        if (!e && frames > 0) e = reader_frame(r, frames - 1, f, why);
        if (e) return e;
        if (frames > 0) *more = true, release(r, f);
    }
}
