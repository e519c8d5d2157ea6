/* step/small_near.c: see step/small_near.h. */
#include "step/small_near.h"

#include "step/small_wall.h"

#include <math.h>

/* Of the speed along the surfaces: a way of d turns the normal by d over the distance of the centres, and opens a gap of the second
   order in d alone */
#define ALONG 0.2

/* m/s: of two bodies, or a body and a wall, that move by u against each other where n points from one to the other */
static double closing_speed(vec3 u, vec3 n)
{
    const double un = v3_dot(u, n);
    return fmax(-un, ALONG * v3_norm(v3_axpy(u, -un, n)));
}

double small_near_speed(struct small_run *r)
{
    const struct packing *p = r->p;
    struct small_list *l = r->l;
    double most = 0;
    for (int64_t i = 0; i < l->pairs.n; i++) {
        const struct pair *pair = &l->pairs.pair[i];
        vec3 d = v3_sub(l->listed[pair->b], l->listed[pair->a]);
        if (l->s.shift) d = v3_add(d, cell_shift(r->cell.edge, pair->shift));
        const vec3 u = v3_sub(l->drift[pair->b], l->drift[pair->a]);
        most = fmax(most, closing_speed(u, small_normal(d)));
    }
    for (int64_t i = 0; i < l->touches; i++) {
        struct small_touch *t = &l->touch[i];
        if (!small_look_at_touch(r, t, INFINITY)) continue;
        most = fmax(most, closing_speed(v3_sub(p->v[t->body], t->v), t->n));
    }
    return most;
}
