#include "file/reader.h"

#include "file/frame_read.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
    WHOLE_FROM =
        1 << 20 /* bytes of a document that may go on as it is: decoding a smaller one takes a ms */
};

struct reader {
    struct source *source;
    struct frame_read doc;
    struct unknown *unknown;         /* of the open document, where it is wanted */
    bool copies;                     /* it is */
    struct distributed *distributed; /* who may take bodies */
    int64_t next;                    /* the frame that reader_take reads next */
    bool whole;                      /* the open document may go on as it is */
};

int reader_open(struct reader **out, int files, char *const *file, struct failure *failure)
{
    struct reader *r = *out = calloc(1, sizeof *r);
    if (!r) return failure_set(failure, EX_SOFTWARE, "no memory");
    return source_open(&r->source, files, file, failure);
}

void reader_unpack(double bytes)
{
    source_limit(bytes < 1e18 ? (uint64_t)bytes : UINT64_MAX / 2);
}

void reader_copies(struct reader *r)
{
    r->copies = true;
}

void reader_hands_over(struct reader *r, struct distributed *to)
{
    r->distributed = to;
}

const char *reader_loses(const struct reader *r)
{
    return r->doc.frames > 1 ? unknown_timed(r->source) : NULL;
}

void reader_close(struct reader *r)
{
    if (!r) return;
    frame_read_close(&r->doc);
    unknown_free(r->unknown);
    source_close(r->source);
    free(r);
}

const char *reader_where(const struct reader *r)
{
    return source_where(r->source);
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

/* Puts the document's name in front of the reason, unless it is there. */
static int name_document(const struct reader *r, struct failure *failure)
{
    char text[sizeof failure->text];
    const char *where = reader_where(r);
    size_t n = strlen(where);
    if (n > 120) n = 120;
    if (!strncmp(failure->text, where, n)) return failure->status;
    memcpy(text, failure->text, sizeof text);
    snprintf(failure->text, sizeof failure->text, "%.120s: %.270s", where, text);
    return failure->status;
}

/* Has this nsd written it? Then it would write the same bytes again. */
static int by_nsd(struct reader *r, struct failure *failure)
{
    char *name = source_text(r->source, "/h5md/creator", "name", failure), *version = NULL;
    if (!failure->status) version = source_text(r->source, "/h5md/creator", "version", failure);
    r->whole = name && version && !strcmp(name, "nsd") && !strcmp(version, NSD_VERSION);
    free(name), free(version);
    return failure->status;
}

int reader_document(struct reader *r, int64_t *frames, struct failure *failure)
{
    struct source_document d;
    bool more;
    frame_read_close(&r->doc);
    unknown_free(r->unknown);
    r->unknown = NULL, r->next = 0, r->whole = false, *frames = -1;
    if (source_next(r->source, &d, &more, failure)) return failure->status;
    if (!more) return 0;
    if (frame_read_open(&r->doc, r->source, failure)) return name_document(r, failure);
    r->doc.distributed = r->distributed;
    if (r->copies && unknown_read(&r->unknown, r->source, r->doc.frames <= 1, failure))
        return name_document(r, failure);
    *frames = r->doc.frames;
    r->whole = r->copies && !r->unknown && !d.foreign && !d.unfinished && d.plain &&
               d.size >= WHOLE_FROM && r->doc.frames == 1 &&
               source_has(r->source, "/particles/all");
    return r->whole ? by_nsd(r, failure) : 0;
}

int reader_frame(struct reader *r, int64_t k, struct frame *f, struct failure *failure)
{
    frame_free(f);
    if (frame_read_moment(&r->doc, k, f, failure)) return name_document(r, failure);
    f->unknown = unknown_share(r->unknown);
    return f->packed ? source_unload(r->source, failure) : 0;
}

/* Gives a document back once its only frame has been read: the memory may be needed. */
static int release(struct reader *r, const struct frame *f, struct failure *failure)
{
    if (r->doc.frames != 1 || !f->packed) return 0;
    frame_read_close(&r->doc);
    return source_release(r->source, failure);
}

bool reader_has(const struct reader *r, int64_t k, const struct range *steps)
{
    return !r->doc.step || range_has(steps, r->doc.step[k]);
}

int reader_find(struct reader *r, const struct range *steps, bool *more, struct failure *failure)
{
    for (;;) {
        while (steps && r->next < r->doc.frames && !reader_has(r, r->next, steps)) r->next++;
        *more = r->next < r->doc.frames;
        if (*more) break;
        int64_t frames;
        if (reader_document(r, &frames, failure)) return failure->status;
        if (frames < 0) return 0;
    }
    return 0;
}

int reader_take(struct reader *r, struct frame *f, struct failure *failure)
{
    return reader_frame(r, r->next++, f, failure) ? failure->status : release(r, f, failure);
}

bool reader_whole(const struct reader *r)
{
    return r->whole && !r->next;
}

int reader_pour(struct reader *r, source_sink pour, void *to, struct failure *failure)
{
    r->next++;
    if (source_pour(r->source, pour, to, failure)) return failure->status;
    frame_read_close(&r->doc);
    return source_release(r->source, failure);
}

int reader_next(struct reader *r, const struct range *steps, struct frame *f, bool *more,
                struct failure *failure)
{
    if (reader_find(r, steps, more, failure)) return failure->status;
    if (*more) return reader_take(r, f, failure);
    frame_free(f);
    return 0;
}

int reader_last(struct reader *r, struct frame *f, bool *more, struct failure *failure)
{
    *more = false;
    for (;;) {
        int64_t frames;
        if (reader_document(r, &frames, failure)) return failure->status;
        if (frames < 0) return 0;
        if (!frames) continue;
        if (reader_frame(r, frames - 1, f, failure) || release(r, f, failure))
            return failure->status;
        *more = true;
    }
}
