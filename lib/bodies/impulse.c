/* bodies/impulse.c: the reactions' impulses and moments [bodies/impulse.h]. */
#include "bodies/impulse.h"

#include <stdlib.h>

static void add(struct impulses *sum, const struct contact *c, const struct push *o)
{
    sum->force[c->b] = v3_add(sum->force[c->b], o->f);
    sum->moment[c->b] =
        o->shaped ? v3_add(sum->moment[c->b], o->mb) : v3_axpy(sum->moment[c->b], o->lb, o->m);
    for (int32_t k = 0; k < sum->freedoms.n; k++)
        sum->yield[k] += v3_dot(freedom_direction(&sum->freedoms.f[k], c), o->f);
    if (c->a < 0) return;
    sum->force[c->a] = v3_sub(sum->force[c->a], o->f);
    sum->moment[c->a] =
        o->shaped ? v3_add(sum->moment[c->a], o->ma) : v3_axpy(sum->moment[c->a], o->la, o->m);
}

static void add_moment(struct impulses *sum, const struct contact *c, const double moment[3])
{
    vec3 m = contact_in_space(c, moment);
    sum->moment[c->b] = v3_add(sum->moment[c->b], m);
    if (c->a >= 0) sum->moment[c->a] = v3_sub(sum->moment[c->a], m);
}

int impulses_init(struct impulses *sum, const struct packing *p, const struct contacts *s,
                  bool ended, struct why *why)
{
    size_t n = (size_t)p->n + 1;
    *sum = (struct impulses){ .ahead = ended ? -p->theta * p->dt : (1 - p->theta) * p->dt };
    cell_predict(&p->cell, sum->ahead, sum->edge);
    if (!ended) cell_next_rate(&p->cell, p->t, p->dt, p->theta, sum->next);
    if (!ended) sum->flow = packing_flow(p);
    if (freedoms_init(&sum->freedoms, p, sum->edge, why)) return why->status;
    sum->force = calloc(n, sizeof *sum->force), sum->moment = calloc(n, sizeof *sum->moment);
    sum->yield = calloc((size_t)sum->freedoms.n + 1, sizeof *sum->yield);
    if (!sum->force || !sum->moment || !sum->yield)
        return why_set(why, EX_SOFTWARE, "no memory to move the bodies");
    for (int64_t i = 0; i < s->n; i++) {
        struct push o = push_of(p, sum->ahead, sum->edge, &s->c[i], s->found[i].r);
        add(sum, &s->c[i], &o);
        if (s->moment) add_moment(sum, &s->c[i], s->moment[i]);
    }
    return 0;
}

void impulses_free(struct impulses *sum)
{
    free(sum->force), free(sum->moment), free(sum->yield);
    freedoms_free(&sum->freedoms);
    *sum = (struct impulses){ 0 };
}
