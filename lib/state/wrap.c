/* state/wrap.c: bodies back into the cell, edges upright [state/wrap.h]. */
#include "state/wrap.h"

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
    for (int64_t i = 0; s && i < s->n; i++) placement_follow(p, inverse, s->c[i].a, s->c[i].b, s->c[i].shift);
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
