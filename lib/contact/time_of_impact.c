#include "contact/time_of_impact.h"

#include "shape/gjk.h"

#include <math.h>
#include <stdlib.h>

static const double CROSSING_GRAZE =
    1e-2; /* of the sum of radii: how deep a path must go into the other */

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
    if (ha && tunnelling_through_hull(ha, p->dim, a->radius, a->q, from, v3_add(from, way)))
        return true;
    return hb && tunnelling_through_hull(hb, p->dim, b->radius, b->q, v3_sub(none, from),
                                         v3_sub(none, v3_add(from, way)));
}

static void crossing_count_pair(void *arg, const struct fast *a, const struct fast *b)
{
    const struct counting *o = arg;
    if (fast_is_fixed_hull(o->p, a) || fast_is_fixed_hull(o->p, b)) return; // in swift_passed()
    if (crossing_cross(o, a, b))
        tunnelling_note(o->passed, b->fast ? b->id : a->id, b->fast ? a->id : b->id);
}

int tunnelling_count(struct passed *s, const struct packing *p, const bool *of,
                     const struct fast_list *list, struct window window, bool beyond,
                     struct failure *failure)
{
    struct counting o = { p, window, beyond, s };
    if (!(window.length > 0)) return 0;
    return fast_pairs(p, of, list, window, crossing_count_pair, &o, failure);
}

/* Of the thinner body's thickness: the path of a substep in which two meet. At most as nsd-gen --check has it of a step;
   less makes meetings exact that nearly coincide, as long as QUARTER of the substeps left suffice for all of the path.
   At least several times the gap at which an impact is one already [state/packing.h]. */
static const double CALM_LEAST = 0.01, CALM_MOST = 0.05, QUARTER = 0.25;
static const double IMPACT_GRAZE =
    1e-6;                          /* of the sum of radii: bodies that overlap by less go past */
static const double DEEPER = 1e-5; /* of the thickness: what overlaps already meets by more */
static const double TOUCH = 1e-4;  /* of the thickness: cores with this gap meet */
static const double SLIVER = 1e-3; /* of a substep in which bodies meet: no substep is shorter */
static const double UNSEEN =
    1e-9; /* of the thickness: where the law sees no gaps bodies overlap to be met */

enum { ADVANCES_MOST = 200 }; /* of conservative advancement; then they are said to meet */

/* ---- two cores ---- */

/* Paths of b relative to a */
struct path {
    vec3 w;             /* m/s */
    double speed, thin; /* m/s, m */
    double rest;        /* s */
    double calm;        /* s: of a substep in which they meet */
};

/* s: when balls with centres `d` apart and radii of this sum meet; INFINITY: they do not */
static double meet_balls(const struct path *o, vec3 d, double radii)
{
    const double d2 = v3_dot(d, d), w2 = v3_dot(o->w, o->w), b = v3_dot(d, o->w);
    if (!(b < 0)) return INFINITY;
    if (d2 < radii * radii) {
        const double s = dmin(-b / w2, o->rest);
        const double come = sqrt(d2) - v3_norm(v3_axpy(d, s, o->w));
        return come > DEEPER * o->thin ? 0 : INFINITY;
    }
    const double deep = (1 - IMPACT_GRAZE) * radii, root2 = b * b - w2 * (d2 - radii * radii);
    if (!(d2 - b * b / w2 < deep * deep)) return INFINITY;
    return (d2 - radii * radii) / (sqrt(root2) - b);
}

/* m: between core a and core b, which is moved by `away` (m); moved: room for its vertices */
static double gap_of(const struct core *a, const struct core *b, vec3 away, vec3 *moved)
{
    struct core to = *b;
    for (int32_t k = 0; k < b->n; k++) moved[k] = v3_add(b->v[k], away);
    to.v = moved, to.centre = v3_add(b->centre, away);
    return gjk_nearest(a, &to).distance - a->round - b->round;
}

static double meet_cores_at(const struct path *o, const struct core *a, const struct core *b,
                            vec3 *moved)
{
    const double touch = TOUCH * o->thin, soon = o->calm;
    double t = 0, gap = gap_of(a, b, v3(0, 0, 0), moved);
    if (gap <= touch) {
        if (v3_dot(v3_sub(b->centre, a->centre), o->w) >= 0) return INFINITY;
        t = soon;
        const double then = gap_of(a, b, v3_scale(t, o->w), moved);
        if (then <= gap) return 0;
        gap = then;
    }
    for (int k = 0; k < ADVANCES_MOST && t <= o->rest; k++) {
        if (gap <= touch && t > soon) return t;
        t += dmax(gap, touch) / o->speed;
        gap = gap_of(a, b, v3_scale(t, o->w), moved);
        if (gap <= touch) return t;
    }
    return t <= o->rest ? t : INFINITY;
}

/* ---- two bodies ---- */

/* The vertices of two bodies, and of one of them elsewhere */
struct corners {
    vec3 *a, *b, *moved; /* [of the shape that has most] m */
};

static int32_t time_of_impact_cores_of(const struct packing *p, const struct fast *b)
{
    const struct shape *s = b->shape ? &p->shapes.s[b->shape] : NULL;
    return s ? shape_parts(s) : 1;
}

/* The body's vertices in space, with its centre at x */
static void time_of_impact_place(const struct packing *p, const struct fast *b, vec3 x, vec3 *v)
{
    const struct shape *s = b->shape ? &p->shapes.s[b->shape] : NULL;
    if (!s) v[0] = x;
    for (int32_t k = 0; s && k < s->vertices; k++) {
        v[k] = v3_axpy(x, b->radius, quat_turn(b->q, s->vertex[k]));
        if (p->dim == 2) v[k].z = 0;
    }
}

static struct core time_of_impact_core_of(const struct packing *p, const struct fast *b, vec3 x,
                                          const vec3 *v, int32_t k)
{
    const struct shape *s = b->shape ? &p->shapes.s[b->shape] : NULL;
    if (!s) return (struct core){ .n = 1, .v = v, .round = b->radius, .centre = x };
    struct core c = shape_core(s, b->radius, x, v, NULL, k);
    c.hull = NULL; // its vertices are enough
    return c;
}

/* s: when two bodies meet of which one at least has a shape */
static double meet_shapes(const struct packing *p, const struct corners *room, const struct path *o,
                          const struct fast *a, const struct fast *b)
{
    const vec3 none = v3(0, 0, 0), d = v3_sub(b->x, a->x);
    double first = INFINITY;
    time_of_impact_place(p, a, none, room->a), time_of_impact_place(p, b, d, room->b);
    for (int32_t k = 0; k < time_of_impact_cores_of(p, a); k++)
        for (int32_t l = 0; l < time_of_impact_cores_of(p, b); l++) {
            const struct core ca = time_of_impact_core_of(p, a, none, room->a, k),
                              cb = time_of_impact_core_of(p, b, d, room->b, l);
            const bool points = ca.n == 1 && cb.n == 1;
            first =
                dmin(first, points ? meet_balls(o, v3_sub(cb.v[0], ca.v[0]), ca.round + cb.round)
                                   : meet_cores_at(o, &ca, &cb, room->moved));
        }
    return first;
}

/* Do the balls around two bodies come together? */
static bool come_near(const struct path *o, vec3 d, double radii)
{
    const double s = dmin(dmax(-v3_dot(d, o->w) / (o->speed * o->speed), 0), o->rest);
    return v3_norm(v3_axpy(d, s, o->w)) <= radii;
}

/* ---- all ---- */

struct time_of_impact_meeting {
    const struct packing *p;
    double rest, part; /* s */
    double least;      /* s: for which the substeps suffice */
    double sought;     /* s: contacts are sought then where the rest is one substep */
    struct corners room;
};

/* s: the substep that a meeting after t leaves. In a step of theta contacts act after ahead of it. */
static double part_of(const struct packing *p, const struct path *o, double t)
{
    const double calm = o->calm, ahead = 1 - p->theta, lead = ahead * calm;
    if (!overlap_sees_gaps(p->overlap)) t += UNSEEN * o->thin / o->speed;
    if (t > 2 * lead + SLIVER * calm) return t - lead;
    return ahead > 0 ? dmin(dmax(t / ahead, 0.5 * calm), 3 * calm) : calm;
}

static void time_of_impact_look(void *arg, const struct fast *a, const struct fast *b)
{
    struct time_of_impact_meeting *s = arg;
    const struct packing *p = s->p;
    struct path o = { .w = v3_sub(b->v, a->v), .thin = dmin(a->thick, b->thick), .rest = s->rest };
    const vec3 d = v3_sub(b->x, a->x);
    o.speed = v3_norm(o.w);
    if (!(p->dt * o.speed > o.thin)) return;
    const double thin = o.thin / o.speed;
    o.calm = dmin(dmax(s->least, CALM_LEAST * thin), CALM_MOST * thin);
    if (!come_near(&o, d, a->radius + b->radius)) return;
    const double t = a->shape || b->shape ? meet_shapes(p, &s->room, &o, a, b)
                                          : meet_balls(&o, d, a->radius + b->radius);
    const bool hull = fast_is_fixed_hull(p, a) || fast_is_fixed_hull(p, b);
    if (hull && t > s->sought) return; // it is met ahead
    if (t < s->rest) s->part = dmin(s->part, part_of(p, &o, t));
}

/* s: by then no two bodies have come nearer by more than a quarter of the cell, so that images one edge away are all
   that may be met */
static double cell_limit(const struct packing *p, const struct fast_list *list)
{
    vec3 lo = v3(0, 0, 0), hi = lo; // other bodies are slow
    double height[3], least = INFINITY, speed;
    if (!cell_repeats(&p->cell)) return INFINITY;
    cell_heights(&p->cell, height);
    for (int64_t i = 0; i < list->n; i++)
        lo = v3_min(lo, list->of[i].v), hi = v3_max(hi, list->of[i].v);
    speed = v3_norm(v3_sub(hi, lo));
    for (int k = 0; k < 3; k++)
        if (p->cell.repeats[k]) least = dmin(least, height[k]), speed += v3_norm(p->cell.rate[k]);
    return 0.25 * least / speed;
}

static int room_for(struct corners *room, const struct packing *p, struct failure *failure)
{
    int32_t most = 1;
    for (int32_t k = 0; p->shape && k < p->shapes.n; k++)
        if (p->shapes.s[k].vertices > most) most = p->shapes.s[k].vertices;
    const size_t size = (size_t)most * sizeof *room->a;
    room->a = malloc(size), room->b = malloc(size), room->moved = malloc(size);
    if (room->a && room->b && room->moved) return 0;
    return failure_set(failure, EX_SOFTWARE, "no memory for fast bodies");
}

/* s: in which the fastest of the list goes as far as they are thick in the mean */
static double horizon_of(const struct fast_list *list)
{
    double thick = 0, v2 = 0;
    for (int64_t i = 0; i < list->n; i++)
        thick += list->of[i].thick, v2 = dmax(v2, v3_dot(list->of[i].v, list->of[i].v));
    return thick / (double)list->n / sqrt(v2);
}

int time_of_impact_part(double *part, const struct packing *p, const bool *of,
                        const struct fast_list *list, double rest, int64_t left,
                        struct failure *failure)
{
    struct time_of_impact_meeting s = { .p = p, .least = rest / (QUARTER * (double)left) };
    s.sought = (1 - p->theta) * rest;
    *part = rest;
    if (!list->n) return 0;
    const double most = dmin(rest, cell_limit(p, list)), horizon = horizon_of(list);
    if (!(most > 0 && horizon > 0))
        return 0; // squares of velocities overflow: the whole step diverges
    bool good = !room_for(&s.room, p, failure), ends = false;
    // paths are looked at as far as it takes: a meeting after the time t leaves a substep of more than t/2
    for (double time = horizon; good && !ends; time *= 4) {
        s.rest = s.part = dmin(time, most);
        good = !fast_pairs(p, of, list, (struct window){ 0, s.rest }, time_of_impact_look, &s,
                           failure);
        ends = s.part <= 0.5 * s.rest || s.rest >= most;
    }
    free(s.room.a), free(s.room.b), free(s.room.moved);
    if (s.part < rest * (1 - 1e-12)) *part = s.part;
    return failure->status;
}
