/* step/small_near.c: see step/small_near.h. */
#include "step/small_near.h"

#include "step/small_wall.h"

#include <math.h>

double small_near_speed(struct small_run *r)
{
    struct small_list *l = r->l;
    double most = 0;
    for (int64_t i = 0; i < l->pairs.n; i++) {
        const struct pair *pair = &l->pairs.pair[i];
        most = fmax(most, v3_norm(v3_sub(l->drift[pair->b], l->drift[pair->a])));
    }
    for (int64_t i = 0; i < l->touches; i++) {
        struct small_touch *t = &l->touch[i];
        if (!small_look_at_touch(r, t, INFINITY)) continue;
        const double more = r->wall[t->wall].top - v3_norm(t->v); // it may begin to move
        most = fmax(most, v3_norm(v3_sub(r->p->v[t->body], t->v)) + fmax(0, more));
    }
    return most;
}
