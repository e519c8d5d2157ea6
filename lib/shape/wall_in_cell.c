#include "shape/wall_in_cell.h"

#include <math.h>

/* Is the wall the same after a shift by this edge? */
static bool repeats_along(const struct wall *w, const struct drives *drives, vec3 edge)
{
    double tiny = 1e-9 * v3_norm(edge);
    for (int32_t k = w->first_drive; k < w->first_drive + w->drives; k++)
        if (drives->drive[k].turns && w->shape == WALL_PLANE) return false;
    if (w->shape == WALL_PLANE) return fabs(v3_dot(edge, w->n)) <= tiny;
    if (w->shape != WALL_CYLINDER || w->size[2] > 0) return false;
    return v3_norm(v3_cross(edge, w->n)) <= tiny;
}

/* Does nothing that is prescribed or yields move it along e? What turns does. */
static bool keeps_place(const struct wall *w, const struct drives *drives, vec3 e)
{
    const double tiny = 1e-9;
    for (int32_t k = w->first_drive; k < w->first_drive + w->drives; k++) {
        const struct drive *d = &drives->drive[k];
        if (d->turns || fabs(v3_dot(d->axis, e)) > tiny) return false;
    }
    if (fabs(v3_dot(w->v, e)) > tiny * v3_norm(w->v)) return false;
    if (w->load.way == LOAD_NONE) return true;
    return w->load.way == LOAD_GLIDES && fabs(v3_dot(w->load.axis, e)) <= tiny;
}

/* m: where the wall begins and ends along the unit vector e, from its point of reference, or farther out */
static void span_along(const struct wall *w, const struct wall_parts *of, vec3 e, double *lo,
                       double *hi)
{
    double reach = wall_reach(w), c = v3_dot(w->n, e);
    if (w->shape == WALL_RECTANGLE)
        reach = 0.5 * (w->size[0] * fabs(v3_dot(w->along, e)) +
                       (of->dim == 2 ? 0 : w->size[1] * fabs(v3_dot(v3_cross(w->n, w->along), e))));
    if (w->shape == WALL_DISC) reach = w->size[1] * sqrt(fmax(1 - c * c, 0));
    *lo = -reach, *hi = reach;
    if (w->shape != WALL_MESH) return;
    *lo = INFINITY, *hi = -INFINITY;
    for (int32_t i = w->first_element; i < w->first_element + w->elements; i++)
        for (int j = 0; j < 3; j++) {
            double x = v3_dot(of->mesh->vertex[of->mesh->element[i][j]], e);
            *lo = fmin(*lo, x), *hi = fmax(*hi, x);
        }
}

bool wall_fits_edge(const struct wall *w, const struct wall_parts *of, const struct cell *c, int k,
                    double thick)
{
    if (repeats_along(w, of->drives, c->edge[k])) return true;
    vec3 inverse[3];
    cell_inverse(c->edge, inverse);
    double height = 1 / v3_norm(inverse[k]), lo, hi;
    vec3 e = v3_scale(height, inverse[k]);
    if (!keeps_place(w, of->drives, e)) return false;
    span_along(w, of, e, &lo, &hi);
    double x = v3_dot(v3_sub(w->x, c->origin), e);
    return x + lo >= thick && x + hi <= height - thick;
}
