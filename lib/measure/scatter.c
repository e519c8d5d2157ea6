#include "measure/scatter.h"

#include <math.h>
#include <stdlib.h>

bool scatter_add(struct scatter *a, vec3 x, int64_t of)
{
    if (a->n == a->room) {
        int64_t room = 2 * a->room + 1;
        vec3 *more = realloc(a->x, (size_t)room * sizeof *more);
        if (more) a->x = more;
        int64_t *bodies = more ? realloc(a->of, (size_t)room * sizeof *bodies) : NULL;
        if (!bodies) return false;
        a->of = bodies, a->room = room;
    }
    a->x[a->n] = x, a->of[a->n++] = of;
    return true;
}

void scatter_free(struct scatter *a)
{
    free(a->x), free(a->of);
    a->x = NULL, a->of = NULL, a->n = a->room = 0;
}

/* Is x within `reach` of the cell? */
static bool near_is_near(const struct period *m, vec3 x, double reach)
{
    for (int k = 0; k < 3; k++) {
        double at = v3_dot(m->inverse[k], v3_sub(x, m->cell->origin));
        double margin = reach * v3_norm(m->inverse[k]);
        if (m->cell->repeats[k] && !(at > -margin && at < 1 + margin)) return false;
    }
    return true;
}

bool scatter_images(struct scatter *a, const struct period *m, double reach)
{
    int most[3] = { 0, 0, 0 };
    for (int64_t i = 0; i < a->seekers; i++) {
        vec3 d = v3_sub(a->x[i], m->cell->origin);
        for (int k = 0; k < 3; k++)
            if (m->cell->repeats[k])
                a->x[i] = v3_axpy(a->x[i], -floor(v3_dot(m->inverse[k], d)), m->edge[k]);
    }
    for (int k = 0; k < 3; k++)
        if (m->cell->repeats[k]) most[k] = (int)ceil(reach * v3_norm(m->inverse[k]));
    for (int64_t i = 0; i < a->seekers; i++)
        for (int u = -most[0]; u <= most[0]; u++)
            for (int v = -most[1]; v <= most[1]; v++)
                for (int w = -most[2]; w <= most[2]; w++) {
                    if (!u && !v && !w) continue;
                    vec3 x = v3_axpy(a->x[i], u, m->edge[0]);
                    x = v3_axpy(v3_axpy(x, v, m->edge[1]), w, m->edge[2]);
                    if (near_is_near(m, x, reach) && !scatter_add(a, x, a->of[i])) return false;
                }
    return true;
}
