/* solve/coupling.c: the Jacobians of the freedoms [solve/coupling.h]. */
#include "solve/coupling.h"

#include "base/array.h"

#include <stdlib.h>

void couplings_free(struct couplings *c)
{
    freedoms_free(&c->freedoms);
    free(c->first), free(c->of);
    *c = (struct couplings){ 0 };
}

static bool coupling_add(struct couplings *c, int64_t *room, const struct coupling *one)
{
    if (!array_grow(&c->of, room, c->n + 1, sizeof *c->of)) return false;
    c->of[c->n++] = *one;
    return true;
}

/* Appends those of contact i; false when memory is short. */
static bool coupling_add_contact(struct couplings *c, int64_t *room, const struct packing *p,
                                 const vec3 half[3], const struct contact *t, int64_t i)
{
    const double ahead = step_ahead(p);
    for (int32_t k = 0; k < c->freedoms.n; k++) {
        vec3 g = freedom_direction(&c->freedoms.f[k], p, t, ahead, half);
        if (v3_dot(g, g) == 0) continue;
        const struct coupling one = {
            k, (int32_t)i, { v3_dot(t->n, g), v3_dot(t->t1, g), v3_dot(contact_t2(t), g) }
        };
        if (!coupling_add(c, room, &one)) return false;
    }
    return true;
}

int couplings_init(struct couplings *c, const struct packing *p, const struct contacts *s,
                   struct failure *failure)
{
    int64_t room = 0;
    *c = (struct couplings){ 0 };
    vec3 half[3];
    cell_predict(&p->cell, step_ahead(p), half);
    if (freedoms_init(&c->freedoms, p, half, false, failure)) return failure->status;
    c->first = calloc((size_t)s->n + 1, sizeof *c->first);
    bool good = c->first != NULL;
    for (int64_t i = 0; good && i < s->n; i++) {
        good = coupling_add_contact(c, &room, p, half, &s->c[i], i);
        c->first[i + 1] = c->n;
    }
    if (good) return 0;
    couplings_free(c);
    return failure_set(failure, EX_SOFTWARE, "no memory for the contacts of the loads");
}

double couplings_pairs(const struct couplings *c)
{
    double pairs = 0;
    for (int32_t k = 0; k < c->freedoms.n; k++) {
        double contacts = 0;
        if (freedom_common(&c->freedoms.f[k])) continue;
        for (int64_t i = 0; i < c->n; i++) contacts += c->of[i].freedom == k;
        pairs += contacts * contacts;
    }
    return pairs;
}
