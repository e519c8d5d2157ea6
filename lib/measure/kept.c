#include "measure/kept.h"

#include "measure/period.h"

#include <math.h>
#include <stdlib.h>

static int snapshot_by_id(const void *a, const void *b)
{
    const struct kept_body *one = a, *other = b;
    return one->id < other->id ? -1 : one->id > other->id;
}

int kept_set(struct kept *k, const struct packing *p, struct why *why)
{
    struct kept_body *body = realloc(k->body, ((size_t)p->n + 1) * sizeof *body);
    if (!body) return why_set(why, EX_SOFTWARE, "no memory to remember a frame");
    deformed_follow(&k->form, p);
    k->body = body, k->n = p->n, k->step = p->step, k->t = p->t;
    bool sorted = true;
    for (int64_t i = 0; i < p->n; i++) {
        body[i] = (struct kept_body){ p->id[i], p->mass[i], kept_place(p, i), NAN, false, false };
        sorted = sorted && (!i || body[i - 1].id < body[i].id);
    }
    sums_free(&k->sums);
    if (sums_copy(&k->sums, &p->sums, why)) return why->status;
    if (!sorted) qsort(body, (size_t)p->n, sizeof *body, snapshot_by_id);
    return 0;
}

void kept_free(struct kept *k)
{
    free(k->body), free(k->pair);
    sums_free(&k->sums);
    *k = (struct kept){ 0 };
}

const struct kept_body *kept_find(const struct kept *k, int32_t id)
{
    const struct kept_body wanted = { .id = id };
    return bsearch(&wanted, k->body, (size_t)k->n, sizeof wanted, snapshot_by_id);
}

int kept_pair_order(const void *a, const void *b)
{
    const struct kept_pair *x = a, *y = b;
    if (x->a != y->a) return x->a < y->a ? -1 : 1;
    return x->b < y->b ? -1 : x->b > y->b;
}

const struct kept_pair *kept_pair_find(const struct kept *k, const struct kept_pair *pair)
{
    if (!k || !k->pair) return NULL;
    return bsearch(pair, k->pair, (size_t)k->pairs, sizeof *pair, kept_pair_order);
}

vec3 kept_place(const struct packing *p, int64_t i)
{
    vec3 x = p->x[i];
    for (int k = 0; p->image && k < 3; k++) x = v3_axpy(x, p->image[i][k], p->cell.edge[k]);
    return x;
}

vec3 kept_way(const struct packing *p, vec3 from, vec3 to)
{
    struct period period;
    return period_shortest(period_of(&period, &p->cell), v3_sub(to, from));
}
