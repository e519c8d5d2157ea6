#include "contact/tunnelling.h"

double tunnelling_thickness(const struct packing *p, int64_t i)
{
    const struct shape *s = packing_shape(p, i);
    double least = INFINITY;
    if (!s) return p->radius[i];
    for (int32_t k = 0; k < shape_parts(s) && !shape_has_faces(s); k++)
        least = dmin(least, shape_part(s, k).round);
    if (shape_has_faces(s))
        for (int32_t f = 0; f < (p->dim == 2 ? s->corners : s->faces); f++) {
            vec3 v = s->vertex[s->corner[p->dim == 2 ? f : s->first[f]]];
            least = dmin(least, v3_dot(s->normal[f], v) + s->round);
        }
    return p->radius[i] * least;
}

bool tunnelling_watches(const struct packing *p)
{
    bool walls = false;
    for (int32_t w = 0; w < p->walls; w++) walls = walls || p->wall[w].shape != WALL_PLANE;
    return p->n > 1 || (p->n > 0 && walls);
}

/* m/s: no wall is faster; planes have no other side */
static double fastest_wall(const struct packing *p)
{
    double most = 0;
    for (int32_t w = 0; w < p->walls; w++)
        if (p->wall[w].shape != WALL_PLANE) most = dmax(most, wall_top_speed(p, &p->wall[w]));
    return most;
}

int64_t tunnelling_count(const struct packing *p, const bool *of, int32_t *id)
{
    const double wall = fastest_wall(p);
    int64_t n = 0;
    *id = 0;
    for (int64_t i = 0; i < p->n; i++) {
        if ((of && !of[i]) || !(p->mass[i] > 0)) continue;
        const double way = p->dt * (v3_norm(p->v[i]) + wall);
        if (!(way > tunnelling_thickness(p, i))) continue;
        if (!n++ || p->id[i] < *id) *id = p->id[i];
    }
    return n;
}
