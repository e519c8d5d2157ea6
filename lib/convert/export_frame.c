#include "convert/export_frame.h"

#include <inttypes.h>
#include <math.h>

const char *const part_name[PART_COUNT] = { "grains", "contacts", "boundary", "cell", "surfaces" };

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
