#include "measure/period.h"

#include <math.h>

const struct period *period_of(struct period *m, const struct cell *cell)
{
    const vec3 unit[3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
    *m = (struct period){ .cell = cell, .any = cell_repeats(cell), .volume = 1 };
    if (!m->any) return m;
    for (int k = 0; k < 3; k++) m->edge[k] = cell->repeats[k] ? cell->edge[k] : unit[k];
    m->volume = fabs(v3_dot(m->edge[0], v3_cross(m->edge[1], m->edge[2])));
    cell_inverse(m->edge, m->inverse);
    return m;
}

vec3 period_shortest(const struct period *m, vec3 way)
{
    for (int k = 2; m->any && k >= 0; k--)
        if (m->cell->repeats[k]) way = v3_axpy(way, -rint(v3_dot(m->inverse[k], way)), m->edge[k]);
    return way;
}

vec3 period_flow(const struct period *m, vec3 x)
{
    vec3 v = v3(0, 0, 0);
    for (int k = 0; m->any && k < 3; k++)
        if (m->cell->repeats[k])
            v = v3_axpy(v, v3_dot(m->inverse[k], v3_sub(x, m->cell->origin)), m->cell->rate[k]);
    return v;
}
