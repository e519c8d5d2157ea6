#include "convert/scene_file.h"

#include "convert/import_file.h"
#include "file/reader.h"
#include "scene/mesh_file.h"
#include "scene/surface_parts.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum {
    MOST_PIPED = 1 << 26
}; /* bytes of a scene that is no file, whose size says how long it is */

char *scene_file_slurp(FILE *f, const char *name, size_t *n, struct failure *failure)
{
    struct stat st;
    bool file = !fstat(fileno(f), &st) && S_ISREG(st.st_mode);
    size_t room = 1 << 16;
    char *text = malloc(room);
    for (*n = 0; text;) {
        *n += fread(text + *n, 1, room - *n, f);
        if (*n < room) break;
        if (!file && *n >= MOST_PIPED) {
            free(text);
            failure_set(failure, EX_DATAERR,
                        "%s: more than %d MB for a scene (endless?): put it into a file", name,
                        MOST_PIPED >> 20);
            return NULL;
        }
        room *= 2;
        char *more = realloc(text, room);
        if (!more) free(text);
        text = more;
    }
    if (!text) return failure_set(failure, EX_SOFTWARE, "%s: no memory", name), NULL;
    if (!ferror(f)) return text;
    free(text);
    failure_set(failure, EX_NOINPUT, "%s: %s", name, strerror(errno));
    return NULL;
}

/* How many frames there are in all documents of a file; -1: trouble */
static int64_t scene_file_count_frames(char *path, struct failure *failure)
{
    struct reader *in;
    int64_t frames = 0, all = 0;
    if (!reader_open(&in, 1, &path, failure))
        while (!reader_document(in, &frames, failure) && frames >= 0) all += frames;
    reader_close(in);
    return failure->status ? -1 : all;
}

/* Frame k of the file, from 0, or from the end: -1 is the last */
static int scene_file_read_frame(struct frame *f, char *path, int64_t k, struct failure *failure)
{
    struct reader *in;
    bool more = true;
    int64_t wanted = k < -1 ? scene_file_count_frames(path, failure) + k : k;
    if (failure->status) return failure->status;
    if (!reader_open(&in, 1, &path, failure)) {
        if (k == -1) reader_last(in, f, &more, failure);
        for (int64_t i = 0; k != -1 && i <= wanted && more && !failure->status; i++)
            reader_next(in, NULL, f, &more, failure);
    }
    reader_close(in);
    if (failure->status) return failure->status;
    if (!more || (k < -1 && wanted < 0))
        return failure_set(failure, EX_DATAERR, "%s: no frame %lld", path, (long long)k);
    return f->packed ? 0
                     : failure_set(failure, EX_DATAERR, "%s: an FCLIB problem has no bodies", path);
}

/* The balls of another program's file, as the scene's group asks for them */
static int scene_file_read_foreign(struct scene_bodies *b, int dim, const char *path,
                                   struct failure *failure)
{
    struct import_wish wish = { .dim = dim, .frame = b->frame, .has_repeats = b->has_repeats };
    for (int k = 0; k < 3; k++) wish.repeats[k] = b->repeats[k];
    return import_file(b->document, path, &wish, failure);
}

static int scene_file_read_document(struct scene_bodies *b, int dim, const char *dir,
                                    struct failure *failure)
{
    struct frame f = { 0 };
    char *path = scene_path(dir, b->file);
    if (path && access(path, F_OK) && !access(b->file, F_OK)) // as nsd-info --scene has it
        strcpy(path, b->file);
    b->document = calloc(1, sizeof *b->document);
    if (!path || !b->document)
        failure_set(failure, EX_SOFTWARE, "no memory for a document");
    else if (b->foreign)
        scene_file_read_foreign(b, dim, path, failure);
    else if (!scene_file_read_frame(&f, path, b->frame, failure))
        *b->document = f.packing, f.packing = (struct packing){ 0 };
    if (failure->status) free(b->document), b->document = NULL;
    frame_free(&f);
    free(path);
    return failure->status;
}

int scene_file_parse(struct scene *s, const char *text, size_t n, const char *name, const char *dir,
                     struct failure *failure)
{
    struct scene_files files = { .read_mesh = mesh_file_read, .dir = dir };
    struct failure trouble = { 0 };
    if (scene_parse(s, text, n, &files, &trouble))
        return name ? failure_set(failure, trouble.status, "%s:%s", name, trouble.text)
                    : failure_set(failure, trouble.status, "%s", trouble.text);
    for (int64_t g = 0; g < s->groups && !failure->status; g++)
        if (s->bodies[g].from == SCENE_DOCUMENT)
            scene_file_read_document(&s->bodies[g], s->dim, dir, failure);
    if (!failure->status) mesh_files_read(s, &files, failure);
    if (!failure->status) scene_parts_split(s, failure);
    if (failure->status) scene_free(s);
    return failure->status;
}
