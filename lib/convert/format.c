#include "convert/format.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

const char *const part_name[PART_COUNT] = { "grains", "contacts", "walls", "cell", "surfaces" };

/* m: the least and the greatest of (direction . x) -+ radius over the grains; 0 and 1 without any */
static void format_reach(const struct packing *p, vec3 direction, double *lo, double *hi)
{
    *lo = INFINITY, *hi = -INFINITY;
    for (int64_t i = 0; i < p->n; i++) {
        double at = v3_dot(direction, p->x[i]);
        *lo = fmin(*lo, at - p->radius[i]), *hi = fmax(*hi, at + p->radius[i]);
    }
    if (!p->n) *lo = 0, *hi = 1;
}

void export_frame_box(struct box *b, const struct packing *p)
{
    const struct cell *c = &p->cell;
    const vec3 axis[3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
    *b = (struct box){ .origin = v3(0, 0, 0) };
    for (int k = 0; k < 3; k++) {
        double lo = -0.5, hi = 0.5;
        b->repeats[k] = c->repeats[k];
        if (c->repeats[k]) {
            b->edge[k] = c->edge[k];
            b->origin = v3_add(b->origin, v3_scale(v3_dot(axis[k], c->origin), axis[k]));
            continue;
        }
        if (k < p->dim) format_reach(p, axis[k], &lo, &hi);
        b->edge[k] = v3_scale(hi - lo, axis[k]);
        b->origin = v3_add(b->origin, v3_scale(lo, axis[k]));
    }
}

void export_put_image(FILE *out, const struct packing *p, int64_t i)
{
    for (int k = 0; p->image && k < 3; k++) fprintf(out, " %" PRId32, p->image[i][k]);
}

/* NULL ends it; the first is that of a directory. */
static const struct format *const formats[] = {
    &format_vtp, &format_vtu, &format_xyz, &format_lammps,      &format_csv,
    &format_tsv, &format_stl, &format_gsd, &format_lammps_data, NULL,
};

const struct format *format_at(int k)
{
    return formats[k];
}

const struct format *format_of_name(const char *name)
{
    size_t n = strlen(name);
    for (int k = 0; format_at(k); k++) {
        size_t m = strlen(format_at(k)->ending);
        if (n > m && name[n - m - 1] == '.' && !strcmp(name + n - m, format_at(k)->ending))
            return format_at(k);
    }
    return NULL;
}

int some_bodies_init(struct some_bodies *s, const struct packing *p, const struct selection *c,
                     struct failure *failure)
{
    int64_t n = 0;
    for (int64_t i = 0; i < p->n; i++) n += selection_body(c, p, i);
    if (packing_init(&s->bodies, p->dim, n, failure)) return failure->status;
    if (packing_alloc_optional(&s->bodies, packing_optional(p), failure)) {
        packing_free(&s->bodies);
        return failure->status;
    }
    n = 0;
    for (int64_t i = 0; i < p->n; i++)
        if (selection_body(c, p, i)) packing_copy_body(&s->bodies, n++, p, i);
    s->packing = packing_with_bodies(p, &s->bodies, 0, n);
    return 0;
}

void some_bodies_free(struct some_bodies *s)
{
    packing_free(&s->bodies);
}
