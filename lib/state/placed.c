#include "state/placed.h"

#include <stdlib.h>

void placed_free(struct placed *s)
{
    free(s->first), free(s->face), free(s->vertex), free(s->normal);
    *s = (struct placed){ 0 };
}

/* Normals of a hull: in the plane one for each side */
static int32_t normals_of(const struct shape *s, int dim)
{
    return s->form != SHAPE_HULL ? 0 : dim == 2 ? s->vertices : s->faces;
}

int placed_init(struct placed *s, const struct packing *p, const struct positions *at,
                struct failure *failure)
{
    const vec3 *x = at->x;
    const quat *q = at->q;
    *s = (struct placed){ .p = p, .x = x };
    s->first = calloc((size_t)p->n + 1, sizeof *s->first);
    s->face = calloc((size_t)p->n + 1, sizeof *s->face);
    for (int64_t i = 0; s->first && s->face && i < p->n; i++) {
        const struct shape *shape = packing_shape(p, i);
        s->first[i + 1] = s->first[i] + (shape ? shape->vertices : 0);
        s->face[i + 1] = s->face[i] + (shape ? normals_of(shape, p->dim) : 0);
    }
    bool good = s->first && s->face;
    s->vertex = good ? malloc(((size_t)s->first[p->n] + 1) * sizeof *s->vertex) : NULL;
    s->normal = good ? malloc(((size_t)s->face[p->n] + 1) * sizeof *s->normal) : NULL;
    if (!s->vertex || !s->normal) {
        placed_free(s);
        return failure_set(failure, EX_SOFTWARE, "no memory for the corners of the bodies");
    }
    for (int64_t i = 0; i < p->n; i++) {
        const struct shape *shape = packing_shape(p, i);
        if (!shape) continue;
        vec3 *v = s->vertex + s->first[i], *n = s->normal + s->face[i];
        for (int32_t k = 0; k < shape->vertices; k++)
            v[k] = v3_axpy(x[i], p->radius[i], quat_turn(q[i], shape->vertex[k]));
        for (int32_t k = 0; k < normals_of(shape, p->dim); k++)
            n[k] = quat_turn(q[i], shape->normal[k]);
        for (int32_t k = 0; k < shape->vertices && p->dim == 2; k++) v[k].z = 0;
        for (int32_t k = 0; k < normals_of(shape, p->dim) && p->dim == 2; k++) n[k].z = 0;
    }
    return 0;
}

int32_t placed_cores(const struct placed *s, int64_t i)
{
    const struct shape *shape = packing_shape(s->p, i);
    return shape && shape->form == SHAPE_CLUMP ? shape->vertices : 1;
}

struct core placed_core(const struct placed *s, int64_t i, int32_t k)
{
    const struct shape *shape = packing_shape(s->p, i);
    double r = s->p->radius[i];
    const vec3 *v = s->vertex + s->first[i];
    if (!shape) return (struct core){ .n = 1, .v = &s->x[i], .round = r, .centre = s->x[i] };
    if (shape->form == SHAPE_CLUMP)
        return (struct core){ .n = 1, .v = v + k, .round = r * shape->ball[k], .centre = v[k] };
    return (struct core){ .n = shape->vertices,
                          .v = v,
                          .normal = s->normal + s->face[i],
                          .hull = shape->form == SHAPE_HULL ? shape : NULL,
                          .round = r * shape->round,
                          .centre = s->x[i] };
}
