#include "measure/reach.h"

#include <math.h>

void reach_of_planes(const struct packing *p, int axis, double *lo, double *hi)
{
    double from = -INFINITY, to = INFINITY;
    for (int32_t w = 0; w < p->walls; w++) {
        const struct wall *wall = &p->wall[w];
        const vec3 at = wall_at(p, wall, p->t), up = wall_normal(p, wall, p->t);
        if (wall->shape != BOUNDARY_PLANE || !wall_there(wall, p->t)) continue;
        const double n[3] = { up.x, up.y, up.z }, x[3] = { at.x, at.y, at.z };
        if (n[axis] > 1 - 1e-12) from = fmax(from, x[axis]);
        if (n[axis] < -1 + 1e-12) to = fmin(to, x[axis]);
    }
    if (isfinite(from)) *lo = from;
    if (isfinite(to)) *hi = to;
    if (*hi < *lo) *hi = *lo;
}
