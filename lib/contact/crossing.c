#include "contact/crossing.h"

static const double CROSSING_GRAZE = 1e-2; /* of the sum of radii: how deep a path must go into the other */

static double crossing_size_of(const struct fast *b)
{
    return b->shape ? b->thick : b->radius;
}

struct counting {
    const struct packing *p;
    struct window window;
    bool beyond;
    struct passed *passed;
};

static bool through_ball(const struct counting *o, double radii, vec3 from, vec3 way)
{
    const double w2 = v3_dot(way, way), s = -v3_dot(from, way) / w2;
    const vec3 end = v3_add(from, way), nearest = v3_axpy(from, s, way);
    const double deep = (1 - CROSSING_GRAZE) * radii;
    return s > 0 && s < 1 && v3_dot(from, from) >= radii * radii &&
           (o->beyond || v3_dot(end, end) >= radii * radii) &&
           v3_dot(nearest, nearest) < deep * deep;
}

/* Does b go through a, or a through b? */
static bool crossing_cross(const struct counting *o, const struct fast *a, const struct fast *b)
{
    const struct packing *p = o->p;
    const struct shape *ha = fast_hull(p, a), *hb = fast_hull(p, b);
    const vec3 from = v3_sub(fast_from(o->window, b), fast_from(o->window, a));
    const vec3 way = v3_scale(o->window.length, v3_sub(b->v, a->v));
    const double thick = a->thick + b->thick;
    const vec3 none = v3(0, 0, 0);
    if (!(v3_dot(way, way) > thick * thick)) return false;
    if (!ha && !hb) return through_ball(o, crossing_size_of(a) + crossing_size_of(b), from, way);
    if (ha && tunnelling_through_hull(ha, p->dim, a->radius, a->q, from, v3_add(from, way))) return true;
    return hb && tunnelling_through_hull(hb, p->dim, b->radius, b->q, v3_sub(none, from),
                                    v3_sub(none, v3_add(from, way)));
}

static void crossing_count_pair(void *arg, const struct fast *a, const struct fast *b)
{
    const struct counting *o = arg;
    if (fast_is_fixed_hull(o->p, a) || fast_is_fixed_hull(o->p, b)) return; // in swift_passed()
    if (crossing_cross(o, a, b)) tunnelling_note(o->passed, b->fast ? b->id : a->id, b->fast ? a->id : b->id);
}

int tunnelling_count(struct passed *s, const struct packing *p, const bool *of,
                   const struct fast_list *list, struct window window, bool beyond, struct failure *failure)
{
    struct counting o = { p, window, beyond, s };
    if (!(window.length > 0)) return 0;
    return fast_pairs(p, of, list, window, crossing_count_pair, &o, failure);
}
