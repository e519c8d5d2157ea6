#include "contact/friction.h"

#include "state/kinematics.h"

void friction_choose(struct contacts *s, const struct packing *p)
{
    vec3 edge[3];
    const double ahead = step_ahead(p);
    if (!packing_sticks(p)) return;
    cell_predict(&p->cell, ahead, edge);
    for (int64_t i = 0; i < s->n; i++) {
        struct contact *c = &s->c[i];
        const int32_t k = packing_pair(p, c->a, c->b);
        if (p->mu_s[k] > c->mu && sliding_of(p, c, ahead, edge) <= p->v_s[k]) c->mu = p->mu_s[k];
    }
}
