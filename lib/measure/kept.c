#include "measure/kept.h"

#include "measure/period.h"

#include <math.h>
#include <stdlib.h>

static int snapshot_by_id(const void *a, const void *b)
{
    const struct frame_memory_body *one = a, *other = b;
    return one->id < other->id ? -1 : one->id > other->id;
}

int frame_memory_set(struct frame_memory *k, const struct packing *p, struct failure *failure)
{
    struct frame_memory_body *body = realloc(k->body, ((size_t)p->n + 1) * sizeof *body);
    if (!body) return failure_set(failure, EX_SOFTWARE, "no memory to remember a frame");
    deformed_follow(&k->form, p);
    k->body = body, k->n = p->n, k->step = p->step, k->t = p->t;
    bool sorted = true;
    for (int64_t i = 0; i < p->n; i++) {
        body[i] = (struct frame_memory_body){ p->id[i], p->mass[i], frame_memory_place(p, i), NAN, false, false };
        sorted = sorted && (!i || body[i - 1].id < body[i].id);
    }
    sums_free(&k->sums);
    if (sums_copy(&k->sums, &p->sums, failure)) return failure->status;
    if (!sorted) qsort(body, (size_t)p->n, sizeof *body, snapshot_by_id);
    return 0;
}

void frame_memory_free(struct frame_memory *k)
{
    free(k->body), free(k->pair);
    sums_free(&k->sums);
    *k = (struct frame_memory){ 0 };
}

const struct frame_memory_body *frame_memory_find(const struct frame_memory *k, int32_t id)
{
    const struct frame_memory_body wanted = { .id = id };
    return bsearch(&wanted, k->body, (size_t)k->n, sizeof wanted, snapshot_by_id);
}

int frame_memory_pair_order(const void *a, const void *b)
{
    const struct frame_memory_pair *x = a, *y = b;
    if (x->a != y->a) return x->a < y->a ? -1 : 1;
    return x->b < y->b ? -1 : x->b > y->b;
}

const struct frame_memory_pair *frame_memory_pair_find(const struct frame_memory *k, const struct frame_memory_pair *pair)
{
    if (!k || !k->pair) return NULL;
    return bsearch(pair, k->pair, (size_t)k->pairs, sizeof *pair, frame_memory_pair_order);
}

vec3 frame_memory_place(const struct packing *p, int64_t i)
{
    vec3 x = p->x[i];
    for (int k = 0; p->image && k < 3; k++) x = v3_axpy(x, p->image[i][k], p->cell.edge[k]);
    return x;
}

vec3 frame_memory_way(const struct packing *p, vec3 from, vec3 to)
{
    struct period period;
    return period_shortest(period_of(&period, &p->cell), v3_sub(to, from));
}
