/* state/placement.c: bodies back into the cell, edges upright [state/placement.h]. */
#include "state/placement.h"

#include <stdlib.h>

void placed_free(struct placed *s)
{
    free(s->first), free(s->face), free(s->vertex), free(s->normal);
    *s = (struct placed){ 0 };
}

/* Normals of a hull: in the plane one for each side */
static int32_t normals_of(const struct shape *s, int dim)
{
    return !shape_has_faces(s) ? 0 : dim == 2 ? s->vertices : s->faces;
}

void placed_turn(struct placed *s, int64_t i, quat q)
{
    const struct packing *p = s->p;
    const struct shape *shape = packing_shape(p, i);
    if (!shape) return;
    vec3 *v = s->vertex + s->first[i], *n = s->normal + s->face[i];
    for (int32_t k = 0; k < shape->vertices; k++)
        v[k] = v3_axpy(s->x[i], p->radius[i], quat_turn(q, shape->vertex[k]));
    for (int32_t k = 0; k < normals_of(shape, p->dim); k++) n[k] = quat_turn(q, shape->normal[k]);
    for (int32_t k = 0; k < shape->vertices && p->dim == 2; k++) v[k].z = 0;
    for (int32_t k = 0; k < normals_of(shape, p->dim) && p->dim == 2; k++) n[k].z = 0;
}

int placed_init(struct placed *s, const struct packing *p, const struct positions *at,
                struct failure *failure)
{
    const quat *q = at->q;
    *s = (struct placed){ .p = p, .x = at->x };
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
    for (int64_t i = 0; i < p->n; i++) placed_turn(s, i, q[i]);
    return 0;
}

int32_t placed_cores(const struct placed *s, int64_t i)
{
    const struct shape *shape = packing_shape(s->p, i);
    return shape ? shape_parts(shape) : 1;
}

struct core placed_core(const struct placed *s, int64_t i, int32_t k)
{
    const struct shape *shape = packing_shape(s->p, i);
    double r = s->p->radius[i];
    const vec3 *v = s->vertex + s->first[i];
    if (!shape) return (struct core){ .n = 1, .v = &s->x[i], .round = r, .centre = s->x[i] };
    return shape_core(shape, r, s->x[i], v, s->normal + s->face[i], k);
}

static int8_t placement_clamp(int64_t s)
{
    return (int8_t)(s < INT8_MIN ? INT8_MIN : s > INT8_MAX ? INT8_MAX : s);
}

static int32_t placement_add(int32_t image, int64_t edges)
{
    int64_t sum = image + edges;
    return (int32_t)(sum < INT32_MIN ? INT32_MIN : sum > INT32_MAX ? INT32_MAX : sum);
}

/* edge[to] -= n edge[from] has happened: what counted edges counts n more of `from` for one of `to`. */
static void recount(struct packing *p, struct contacts *s, int32_t n, int to, int from)
{
    for (int64_t i = 0; i < p->n; i++)
        p->image[i][from] = placement_add(p->image[i][from], (int64_t)n * p->image[i][to]);
    for (int64_t i = 0; s && i < s->n; i++)
        s->c[i].shift[from] = placement_clamp(s->c[i].shift[from] + (int64_t)n * s->c[i].shift[to]);
    for (int64_t i = 0; i < p->bonds.n; i++) {
        int8_t *shift = p->bonds.bond[i].shift;
        shift[from] = placement_clamp(shift[from] + (int64_t)n * shift[to]);
    }
    for (int64_t i = 0; i < p->memory.n; i++) {
        int8_t *shift = p->memory.recall[i].shift;
        shift[from] = placement_clamp(shift[from] + (int64_t)n * shift[to]);
    }
}

/* The image of b that a meets, when both have been brought back into the cell */
static void placement_follow(const struct packing *p, const vec3 inverse[3], int32_t a, int32_t b,
                             int8_t shift[3])
{
    int32_t of_a[3], of_b[3];
    if (a < 0) return; // a plane is its own image
    cell_wraps(&p->cell, inverse, p->x[a], of_a), cell_wraps(&p->cell, inverse, p->x[b], of_b);
    for (int j = 0; j < 3; j++) shift[j] = placement_clamp((int64_t)shift[j] + of_b[j] - of_a[j]);
}

void packing_wrap(struct packing *p, struct contacts *s)
{
    struct cell *c = &p->cell;
    vec3 inverse[3];
    int32_t n;
    int to, from;
    if (!cell_repeats(c)) return;
    while ((n = cell_recut(c, &to, &from))) recount(p, s, n, to, from);
    cell_inverse(c->edge, inverse);
    for (int64_t i = 0; s && i < s->n; i++)
        placement_follow(p, inverse, s->c[i].a, s->c[i].b, s->c[i].shift);
    for (int64_t i = 0; i < p->bonds.n; i++) {
        struct bond *x = &p->bonds.bond[i];
        placement_follow(p, inverse, x->a, x->b, x->shift);
    }
    bonds_sort(&p->bonds);
    for (int64_t i = 0; i < p->memory.n; i++) {
        struct recall *x = &p->memory.recall[i];
        placement_follow(p, inverse, x->a, x->b, x->shift);
    }
    memory_sort(&p->memory);
    for (int64_t i = 0; i < p->n; i++) {
        int32_t w[3];
        cell_wraps(c, inverse, p->x[i], w);
        for (int k = 0; k < 3; k++) {
            if (!w[k]) continue;
            p->x[i] = v3_axpy(p->x[i], -w[k], c->edge[k]);
            p->v[i] = v3_axpy(p->v[i], -w[k], c->rate[k]);
            p->image[i][k] = placement_add(p->image[i][k], w[k]);
        }
    }
}
