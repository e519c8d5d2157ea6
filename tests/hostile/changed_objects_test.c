/*
 * Documents in which one thing is changed: each dataset and each attribute gone, of another type or shape,
 * or of other numbers. What is read then is as good as any frame, all else is refused in one line.
 */
#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier): asprintf
#include "frames.h"

#include "file/frame_read.h"

#include <math.h>

/* What becomes of a dataset or an attribute */
enum change { GONE, TEXT, SEVEN, SQUARE, NUMBERS };
static const double number[] = { NAN, INFINITY, -1, 0, 0.5, 1, 7, 1e300, 2147483647 };
enum {
    CHANGES = NUMBERS + 2 * sizeof number / sizeof *number
}; /* all of its numbers, or the first */

struct spot {
    char path[200], name[80]; /* of the object, of its attribute, or "" */
};
static struct spot places[1000];
static int count;

static herr_t add_attribute(hid_t at, const char *name, const H5A_info_t *info, void *path)
{
    (void)at, (void)info;
    if (!strcmp(name, "units")) return 0; // for people
    struct spot *p = &places[count++];
    snprintf(p->path, sizeof p->path, "%s", (const char *)path);
    snprintf(p->name, sizeof p->name, "%s", name);
    return count == 1000;
}

static herr_t add_object(hid_t root, const char *name, const H5O_info_t *info, void *data)
{
    char path[200];
    (void)data;
    snprintf(path, sizeof path, "/%s", strcmp(name, ".") ? name : "");
    H5Aiterate_by_name(root, path, H5_INDEX_NAME, H5_ITER_INC, NULL, add_attribute, path,
                       H5P_DEFAULT);
    if (info->type != H5O_TYPE_DATASET || count == 1000) return count == 1000;
    snprintf(places[count++].path, sizeof places->path, "%s", path);
    return 0;
}

/* Its numbers, all or only the first, become x, as near as its type comes to that. */
static void set_numbers(hid_t file, const struct spot *p, double x, bool all)
{
    hid_t set = *p->name ? H5Aopen_by_name(file, p->path, p->name, H5P_DEFAULT, H5P_DEFAULT)
                         : H5Dopen2(file, p->path, H5P_DEFAULT);
    hid_t space = *p->name ? H5Aget_space(set) : H5Dget_space(set);
    hssize_t n = H5Sget_simple_extent_npoints(space);
    double *value = calloc((size_t)n + 1, sizeof *value);
    if (!value) exit(1);
    if (*p->name)
        H5Aread(set, H5T_NATIVE_DOUBLE, value);
    else
        H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value);
    for (hssize_t k = 0; k < (all ? n : n > 0); k++) value[k] = x;
    if (*p->name)
        H5Awrite(set, H5T_NATIVE_DOUBLE, value), H5Aclose(set);
    else
        H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value), H5Dclose(set);
    free(value);
    H5Sclose(space);
}

/* Something else in its place */
static void replace(hid_t file, const struct spot *p, enum change change)
{
    static const double nine[9] = { 1, 2, 3, 4, 5, 6, 7, 8, 9 };
    const hsize_t seven = 7, square[2] = { 3, 3 };
    struct failure failure = { 0 };
    if (*p->name)
        H5Adelete_by_name(file, p->path, p->name, H5P_DEFAULT);
    else
        H5Ldelete(file, p->path, H5P_DEFAULT);
    hid_t real = H5T_NATIVE_DOUBLE;
    const hsize_t *shape = change == SEVEN ? &seven : square;
    int rank = change == SEVEN ? 1 : 2;
    if (*p->name && change == TEXT) h5_attr_text(file, p->path, p->name, "words\n", &failure);
    if (*p->name && change > TEXT)
        h5_attr(file, p->path, p->name, h5_array(real, rank, shape, nine), &failure);
    if (!*p->name && change == TEXT) h5_write_text(file, p->path, "words\n", &failure);
    if (!*p->name && change > TEXT)
        h5_write(file, p->path, h5_array(real, rank, shape, nine), NULL, &failure);
}

/* What a reader makes of it; and whether that is an answer */
static bool answers(hid_t file, struct failure *failure)
{
    struct source *s = NULL;
    struct frame_read doc = { 0 };
    struct frame f = { 0 };
    struct unknown *unknown = NULL;
    if (!source_of_own(&s, file, failure) && !frame_read_open(&doc, s, failure) && doc.frames > 0 &&
        !frame_read_moment(&doc, 0, &f, failure))
        unknown_read(&unknown, s, true, failure);
    bool good = !failure->status ||
                (failure->status == EX_DATAERR && *failure->text && !strchr(failure->text, '\n'));
    struct failure other = { 0 };
    struct writer *w = NULL;
    if (!failure->status && f.packed) good = !packing_check(&f.packing, &other);
    if (!failure->status && f.detected && good)
        good = !contacts_check(&f.contacts, f.packing.n, f.packing.walls, &other);
    if (!failure->status && good && (f.packed || f.foreign)) // a writer takes it, too
        good = !writer_open(&w, "/dev/null", WRITER_STREAM, &other) && !writer_frame(w, &f, &other);
    if (w) writer_close(w, &other);
    if (!good && !failure->status) *failure = other;
    unknown_free(unknown), frame_free(&f);
    frame_read_close(&doc), source_close(s);
    return good;
}

/* What the frame needs not, for nobody computes with it */
static bool is_spare(const struct spot *p)
{
    static const char *const spare[] = {
        "/mine",
        "/h5md",
        "/nsd/solver",
        "/nsd/history",
        "/nsd/scene",
        "/contacts/force",
        "/fclib",
        "/solution",
        // where walls are follows from their motion
        "/particles/boundary/position",
        "/particles/boundary/orientation",
        "/particles/boundary/velocity",
        "/particles/boundary/angular_velocity",
        // words are looked at when they are replayed
        "/nsd/outside/answer/text",
    };
    for (size_t k = 0; k < sizeof spare / sizeof *spare; k++)
        if (!strncmp(p->path, spare[k], strlen(spare[k]))) return true;
    const char *last = strrchr(p->path, '/'); // clocks are links to that of the particles
    if (!strncmp(p->path, "/particles/all/position/", 24)) return *p->name;
    return *p->name || !strcmp(last, "/step") || !strcmp(last, "/time");
}

static void test_document(int k)
{
    // so many at a time are passed over; primes, so that every change comes to every sort of place
    long stride = getenv("NSD_RUNS") ? 3 : getenv("NSD_THIN") ? 101 : 31;
    long taken = 0, tried = 0, odd = 0;
    hid_t file = open_copy(document[k]);
    struct failure whole = { 0 };
    count = 0;
    H5Ovisit(file, H5_INDEX_NAME, H5_ITER_INC, add_object, NULL);
    ok(answers(file, &whole) && !whole.status, "document %d is read %s", k, whole.text);
    H5Fclose(file);
    for (long i = 0; i < (long)count * CHANGES; i += stride) {
        const struct spot *p = &places[i / CHANGES];
        int change = (int)(i % CHANGES), at = change - NUMBERS;
        struct failure failure = { 0 };
        file = open_copy(document[k]);
        if (change < NUMBERS)
            replace(file, p, (enum change)change);
        else
            set_numbers(file, p, number[at / 2], at % 2);
        bool good = answers(file, &failure),
             wrong = change == TEXT && !is_spare(p) && !failure.status;
        H5Fclose(file);
        tried++, taken += !failure.status;
        if (good && !wrong) continue;
        if (odd++ < 5)
            diag("%s %s, change %d: %d %s", p->path, p->name, change, failure.status, failure.text);
    }
    ok(!odd && taken > 0 && taken < tried,
       "document %d: of %ld with a change %ld are read, the others refused", k, tried, taken);
}

int main(void)
{
    failing_begin();
    h5_start();
    make_frames();
    for (int k = 0; k <= SCENES; k++) test_document(k);
    return failing_done();
}
