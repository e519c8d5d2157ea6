#include "convert/import_file.h"

#include "base/bounded.h"
#include "convert/imported.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const struct import_format *const formats[] = { &import_lammps_dump, &import_yade_text,
                                                       &import_lammps_data };

enum {
    FORMATS = sizeof formats / sizeof formats[0],
    TYPES_MOST = 4096 /* materials, as of a document */
};

static const int64_t BYTES_MOST = (int64_t)1 << 33;

/* ---- what the other process does ---- */

static int read_bytes(struct imported *to, const char *name, const char *bytes, int64_t n,
                      int64_t frame, struct failure *failure)
{
    static const unsigned char hdf5 = 0x89; // its first byte, and that of documents
    struct soup place = { .name = name, .failure = failure };
    struct words w = words_of(&place, bytes, n);
    for (int k = 0; k < FORMATS; k++)
        if (formats[k]->looks(w.at, w.end - w.at)) return formats[k]->read(to, &w, frame);
    if (n && (unsigned char)bytes[0] == hdf5)
        return failure_set(failure, EX_DATAERR,
                           "%s: an HDF5 file: python3 -m nsd.ondem read FILE makes a document of "
                           "ON-DEM's format, and \"document\" reads one",
                           name);
    return failure_set(failure, EX_DATAERR,
                       "%s: neither a LAMMPS dump or data file, nor a table of Yade (#format)",
                       name);
}

struct import_file_work {
    const char *path;
    int fd;
    int64_t size, frame;
};

static int import_file_read_open(void *with, struct bounded *to, struct failure *failure)
{
    const struct import_file_work *f = with;
    struct imported it = { 0 };
    int64_t n = 0;
    char *bytes = malloc((size_t)f->size + 1);
    if (!bytes) return failure_set(failure, EX_DATAERR, "%s: no memory for so many bytes", f->path);
    while (n < f->size) {
        ssize_t more = read(f->fd, bytes + n, (size_t)(f->size - n));
        if (more < 0 && errno == EINTR) continue;
        if (more < 0)
            failure_set(failure, EX_NOINPUT, "%s: cannot be read: %s", f->path, strerror(errno));
        if (more <= 0) break;
        n += more;
    }
    bytes[n] = 0;
    if (!failure->status && !read_bytes(&it, f->path, bytes, n, f->frame, failure) &&
        !bounded_put(to, &it.head, sizeof it.head, failure))
        bounded_put(to, it.ball, (size_t)it.head.n * sizeof *it.ball, failure);
    imported_free(&it);
    free(bytes);
    return failure->status;
}

/* ---- what comes of it ---- */

static int import_file_by_number(const void *one, const void *other)
{
    const int32_t a = *(const int32_t *)one, b = *(const int32_t *)other;
    return (a > b) - (a < b);
}

/* The types that there are, sorted; to be freed */
static int32_t *import_file_list_types(const struct imported_ball *ball, int64_t n, int32_t *types,
                                       const char *name, struct failure *failure)
{
    int32_t *type = malloc((TYPES_MOST + 1) * sizeof *type), last = -1;
    if (!type) return failure_set(failure, EX_SOFTWARE, "no memory for the materials"), NULL;
    *types = 0;
    for (int64_t i = 0; i < n; i++) {
        if (ball[i].type == last || (*types && bsearch(&ball[i].type, type, (size_t)*types,
                                                       sizeof *type, import_file_by_number)))
            continue;
        if (*types == TYPES_MOST) {
            failure_set(failure, EX_DATAERR, "%s: more than %d types", name, TYPES_MOST);
            break;
        }
        type[(*types)++] = last = ball[i].type;
        qsort(type, (size_t)*types, sizeof *type, import_file_by_number);
    }
    return type;
}

static int set_materials(struct packing *p, const int32_t *type, int32_t types,
                         struct failure *failure)
{
    if (packing_alloc_materials(p, types ? types : 1, failure)) return failure->status;
    for (int32_t k = 0; k < types; k++) {
        char text[16];
        snprintf(text, sizeof text, "%d", type[k]);
        free(p->material_name[k]);
        if (!(p->material_name[k] = strdup(text)))
            return failure_set(failure, EX_SOFTWARE, "no memory for the materials");
    }
    return 0;
}

static int import_file_set_body(struct packing *p, int64_t i, const struct imported_ball *b,
                                const char *name, struct failure *failure)
{
    const bool flat = p->dim == 2;
    // the plane has another density than a file of balls
    const bool known = b->mass > 0 || (b->density > 0 && !flat);
    const struct new_body body = { .x = v3(b->x.x, b->x.y, flat ? 0 : b->x.z),
                                   .v = b->v,
                                   .w = b->w,
                                   .q = flat ? (quat){ 1, 0, 0, 0 } : b->q,
                                   .radius = b->radius,
                                   .density = b->density > 0 ? b->density : 1,
                                   .mass = b->mass,
                                   .weighed = b->mass > 0,
                                   .fixed = !known };
    if (flat && (b->v.z != 0 || b->w.x != 0 || b->w.y != 0))
        return failure_set(failure, EX_DATAERR,
                           "%s: ball %lld moves out of the plane: \"dim\": 3 takes it", name,
                           (long long)i);
    packing_set_body(p, i, &body);
    p->id[i] = b->id;
    return 0;
}

/* The box, where it is periodic; the plane has none across it. */
static int import_file_set_cell(struct packing *p, const struct imported_head *h,
                                const struct import_wish *wish, const char *name,
                                struct failure *failure)
{
    struct cell *c = &p->cell;
    bool any = false;
    for (int k = 0; k < 3; k++) {
        bool repeats = wish->has_repeats ? wish->repeats[k] : h->says && h->repeats[k];
        c->repeats[k] = repeats && k < p->dim;
        any |= c->repeats[k];
    }
    if (!any) return 0;
    if (!h->boxed)
        return failure_set(failure, EX_DATAERR, "%s: has no box for a periodic cell", name);
    c->origin = h->origin;
    for (int k = 0; k < 3; k++) c->edge[k] = h->edge[k];
    if (p->dim == 2) c->edge[2] = v3(0, 0, 1), c->origin.z = 0;
    return packing_alloc_images(p, failure);
}

static int make_packing(struct packing *p, const struct imported_head *h,
                        const struct imported_ball *ball, const struct import_wish *wish,
                        const char *name, struct failure *failure)
{
    int32_t types = 0, *type = import_file_list_types(ball, h->n, &types, name, failure);
    if (!failure->status && !packing_init(p, wish->dim, h->n, failure)) {
        p->dt = 1; // the scene has one
        if (!set_materials(p, type, types, failure) &&
            !import_file_set_cell(p, h, wish, name, failure))
            for (int64_t i = 0; i < h->n && !failure->status; i++) {
                if (import_file_set_body(p, i, &ball[i], name, failure)) break;
                const int32_t *k = bsearch(&ball[i].type, type, (size_t)types, sizeof *type,
                                           import_file_by_number);
                p->material[i] = k ? (int32_t)(k - type) : 0;
            }
        struct failure trouble = { 0 };
        if (!failure->status && packing_check(p, &trouble))
            failure_set(failure, trouble.status, "%.200s: %.180s", name, trouble.text);
        if (failure->status) packing_free(p);
    }
    free(type);
    return failure->status;
}

int import_bytes(struct packing *p, const char *name, const char *bytes, int64_t n,
                 const struct import_wish *wish, struct failure *failure)
{
    struct imported it = { 0 };
    if (!read_bytes(&it, name, bytes, n, wish->frame, failure))
        make_packing(p, &it.head, it.ball, wish, name, failure);
    imported_free(&it);
    return failure->status;
}

static int import_file_open_plain(const char *path, int64_t *size, struct failure *failure)
{
    struct stat st;
    int fd = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC); // of a FIFO it would wait
    if (fd < 0 || fstat(fd, &st))
        failure_set(failure, EX_NOINPUT, "%s: cannot be read: %s", path, strerror(errno));
    else if (!S_ISREG(st.st_mode))
        failure_set(failure, EX_NOINPUT, "%s: no plain file: a packing is not imported from a %s",
                    path, S_ISDIR(st.st_mode) ? "directory" : "pipe or device");
    else if (st.st_size > BYTES_MOST)
        failure_set(failure, EX_DATAERR, "%s: more than %lld GB", path,
                    (long long)(BYTES_MOST >> 30));
    else
        return *size = st.st_size, fd;
    if (fd >= 0) close(fd);
    return -1;
}

int import_file(struct packing *p, const char *path, const struct import_wish *wish,
                struct failure *failure)
{
    struct import_file_work f = { .path = path, .frame = wish->frame };
    void *answer = NULL;
    size_t n = 0;
    if ((f.fd = import_file_open_plain(path, &f.size, failure)) < 0) return failure->status;
    const struct bounded_task task = { import_file_read_open, &f, path, (uint64_t)f.size };
    bounded_run(&task, &answer, &n, failure);
    close(f.fd);
    if (failure->status) return failure->status;
    const struct imported_head *h = answer;
    const size_t head = sizeof *h, row = sizeof(struct imported_ball);
    if (n < head || h->n < 0 || h->n > IMPORTED_MOST || n != head + (size_t)h->n * row)
        failure_set(failure, EX_DATAERR, "%s: an answer of another size", path);
    else
        make_packing(p, h, (const struct imported_ball *)((const char *)answer + head), wish, path,
                     failure);
    bounded_free(answer, n);
    return failure->status;
}
