#include "contact/tunnelling.h"

#include "contact/detect_shapes.h"
#include "shape/mesh.h"
#include "shape/wall_edge.h"

#include <stdlib.h>

enum { STEPS_MOST = 4096 }; /* places of a way: what is faster goes without, and is counted */

static const double CLOSING = 1e-3; /* of the thickness: less closes no gap in the step */
static const double ALIKE = 1e-6;   /* 1 - cosine: of normals that are one */

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

bool tunnelling_is(const struct packing *p, int64_t i, double most)
{
    double limit = tunnelling_thickness(p, i) / p->dt - most;
    return p->mass[i] > 0 && !(limit > 0 && v3_dot(p->v[i], p->v[i]) <= limit * limit);
}

/* m/s: how fast what it meets may be, and what gravity adds */
static double tunnelling_most_of(const struct packing *p, double speed)
{
    return speed + packing_most_fall(p);
}

double tunnelling_beside(const struct packing *p, int32_t w)
{
    return tunnelling_most_of(p, wall_top_speed(p, &p->wall[w]));
}

/* ---- a way ---- */

/* What body i goes through in a step relative to what has velocity v: n places of it are looked at, each a step on. */
struct tunnelling_way {
    int64_t i, n;
    vec3 step; /* m */
    double thick;
};

static struct tunnelling_way tunnelling_way_of(const struct packing *p, int64_t i, vec3 v)
{
    struct tunnelling_way y = { .i = i };
    if (p->mass[i] == 0) return y;
    vec3 d = v3_scale(p->dt, v3_sub(v3_add(p->v[i], packing_fall(p, i)), v));
    double length = v3_norm(d);
    if (!(length > 0)) return y;
    y.thick = tunnelling_thickness(p, i);
    double n = ceil(length / y.thick);
    if (!(n > 1 && n <= STEPS_MOST)) return y;
    y.n = (int64_t)n - 1; // the last is where the next step looks
    y.step = v3_scale(1 / n, d);
    return y;
}

/* A way towards something, with which the body has contacts where contacts are sought */
struct approach {
    const struct tunnelling_way *y;
    double sign;          /* of normals, for them to point to the body */
    struct contacts *out; /* to which new ones are added */
    int64_t first, end;   /* those that there are */
};

/* Is c, found at place k of the way, one to add? Its gap is then the one that it has now. */
static bool comes(const struct approach *o, int64_t k, struct contact *c)
{
    const struct tunnelling_way *y = o->y;
    double closing = -o->sign * v3_dot(c->n, y->step);
    if (!(closing * (double)(y->n + 1) > CLOSING * y->thick)) return false;
    for (int64_t l = o->first; l < o->end; l++)
        if (v3_dot(o->out->c[l].n, c->n) > 1 - ALIKE) return false;
    c->gap += closing * (double)k;
    return true;
}

/* Adds those of `found` at place k that come, where one of them has no gap there. Returns how many, -1: memory is
   short. */
static int64_t add_coming(const struct approach *o, int64_t k, const struct contacts *found)
{
    struct contacts *out = o->out;
    int64_t n = 0;
    bool touches = false;
    for (int64_t l = 0; l < found->n && !touches; l++) {
        struct contact c = found->c[l];
        touches = c.gap <= 0 && comes(o, k, &c);
    }
    for (int64_t l = 0; l < found->n && touches; l++) {
        struct contact c = found->c[l];
        if (!comes(o, k, &c)) continue;
        struct contact *to = contacts_add(out, c.a, c.b);
        if (!to) return -1;
        *to = c, to->feature = (c.a < 0 ? AHEAD_OF_WALL : AHEAD_OF_BODY) + (int32_t)l, n++;
        contacts_settle(out);
    }
    return n;
}

/* ---- walls ---- */

/* A way beside a wall, as the wall is described */
struct tunnelling_beside {
    const struct situation *o;
    struct approach to;
    int32_t w;
    struct pose pose;
    vec3 c, step; /* m: of the body's centre */
    bool failed;
};

/* Is the wall within `reach` of c? */
static bool tunnelling_is_near(const struct tunnelling_beside *s, vec3 c, double reach)
{
    const struct packing *p = s->o->p;
    const struct surface *surface = situation_surface(s->o, s->w);
    struct touch t;
    if (!surface)
        return wall_nearest(&p->wall[s->w], p->dim, c, INFINITY, &t) && fabs(t.distance) <= reach;
    struct surface_walk walk;
    struct surface_branch leaf;
    surface_walk_begin(&walk, surface->n);
    return surface_walk_next(&walk, surface->box, c, reach, &leaf);
}

/* A ball's contacts at place k, relative to where it is */
static bool touch_ball(struct contacts *found, const struct tunnelling_beside *s, int64_t k)
{
    const struct packing *p = s->o->p;
    const struct surface *surface = situation_surface(s->o, s->w);
    const int64_t i = s->to.y->i;
    struct touch touch[TOUCHES_MOST];
    double r = p->radius[i];
    vec3 c = v3_axpy(s->c, (double)k, s->step);
    double most = r + s->to.y->thick;
    const int32_t shape = p->wall[s->w].shape;
    const bool sheet =
        surface || shape == WALL_RECTANGLE || shape == WALL_DISC || p->wall[s->w].side == WALL_BOTH;
    int n = surface ? surface_touches(surface, c, most, touch)
                    : wall_nearest(&p->wall[s->w], p->dim, c, r, touch);
    for (int l = 0; l < n; l++) {
        if (!(touch[l].distance <= most)) continue;
        // a centre that lies on the sheet, to rounding, is met on the side that it comes from
        if (sheet && fabs(touch[l].distance) <= ALIKE * r && v3_dot(touch[l].n, s->step) > 0)
            touch[l].n = v3_scale(-1, touch[l].n);
        struct contact *to = contacts_add(found, -1 - s->w, (int32_t)i);
        if (!to) return false;
        contact_basis(to, p->dim, quat_turn(s->pose.q, touch[l].n));
        to->gap = touch[l].distance - r, to->feature = touch[l].feature;
        to->x = v3_axpy(s->o->x[i], -touch[l].distance, to->n);
        packing_set_law(p, to);
    }
    return true;
}

/* Looks at place k; returns whether the search ends there. */
static bool tunnelling_look_at(struct tunnelling_beside *s, int64_t k)
{
    const struct situation *o = s->o;
    struct contacts found = { 0 };
    vec3 ahead = v3_scale((double)k, s->to.y->step);
    bool good = o->shaped && packing_shape(o->p, s->to.y->i)
                    ? detect_shapes_wall(&found, o, s->w, s->to.y->i, s->to.y->thick, ahead)
                    : touch_ball(&found, s, k);
    int64_t n = good ? add_coming(&s->to, k, &found) : -1;
    contacts_free(&found);
    s->failed = n < 0;
    return n != 0;
}

/* The first of places lo .. hi-1 that ends the search; parts of the way far from the wall are passed over. */
static bool tunnelling_look(struct tunnelling_beside *s, int64_t lo, int64_t hi)
{
    double half = 0.5 * (double)(hi - 1 - lo);
    vec3 middle = v3_axpy(s->c, (double)lo + half, s->step);
    if (!tunnelling_is_near(s, middle, s->o->p->radius[s->to.y->i] + half * v3_norm(s->step)))
        return false;
    if (hi - lo == 1) return tunnelling_look_at(s, lo);
    return tunnelling_look(s, lo, lo + (hi - lo) / 2) || tunnelling_look(s, lo + (hi - lo) / 2, hi);
}

bool tunnelling_meets_wall(struct contacts *out, int64_t first, const struct situation *o,
                           int32_t w, int64_t i)
{
    const struct packing *p = o->p;
    const struct wall *wall = &p->wall[w];
    const struct tunnelling_way y = tunnelling_way_of(p, i, wall_velocity(p, wall, o->x[i]));
    if (y.n < 1) return true;
    struct tunnelling_beside s = { .o = o, .to = { &y, 1, out, first, out->n }, .w = w };
    s.pose = wall_pose(p, wall, o->t);
    s.c = v3_sub(quat_turn_back(s.pose.q, v3_sub(o->x[i], s.pose.shift)), wall->x);
    s.step = quat_turn_back(s.pose.q, y.step);
    tunnelling_look(&s, 1, y.n + 1);
    return !s.failed;
}

/* ---- fixed hulls ---- */

static bool is_fixed_hull(const struct packing *p, int64_t i)
{
    const struct shape *s = p->mass[i] == 0 ? packing_shape(p, i) : NULL;
    return s && shape_has_faces(s);
}

/* The first fixed hull, n: there is none; and how fast the fastest is, with gravity */
static int64_t first_fixed_hull(const struct packing *p, double *most)
{
    int64_t first = p->n;
    double speed = 0;
    for (int64_t i = p->n - 1; p->shape && i >= 0; i--)
        if (is_fixed_hull(p, i)) first = i, speed = dmax(speed, v3_norm(p->v[i]));
    *most = tunnelling_most_of(p, speed);
    return first;
}

double tunnelling_reach(const struct packing *p)
{
    double reach = 0, most;
    first_fixed_hull(p, &most);
    for (int64_t i = 0; p->shape && i < p->n; i++)
        if (tunnelling_is(p, i, most)) reach = dmax(reach, p->dt * (v3_norm(p->v[i]) + most));
    return reach;
}

/* Does the way come near the ball of radius `reach` around x? */
static bool passes_by(const struct tunnelling_way *y, vec3 from, vec3 x, double reach)
{
    vec3 d = v3_scale((double)y->n, y->step), w = v3_sub(x, from);
    double s = dmin(dmax(v3_dot(w, d) / v3_dot(d, d), 0), 1);
    return v3_norm(v3_axpy(w, -s, d)) <= reach;
}

/* The first of the contacts s[n] of these two, or where they would be */
static int64_t find_pair(const struct contact *s, int64_t n, int32_t a, int32_t b)
{
    int64_t lo = 0, hi = n;
    while (lo < hi) {
        int64_t m = lo + (hi - lo) / 2;
        if (s[m].a < a || (s[m].a == a && s[m].b < b))
            lo = m + 1;
        else
            hi = m;
    }
    return lo;
}

/* The first place of the way of body i at which it meets hull f; false when memory is short. */
static bool meet_hull(struct contacts *out, int64_t sorted, const struct situation *o,
                      const struct tunnelling_way *y, int64_t f)
{
    const int32_t a = (int32_t)(y->i < f ? y->i : f), b = (int32_t)(y->i < f ? f : y->i);
    double reach = o->p->radius[y->i] + o->p->radius[f], sign = y->i == b ? 1 : -1;
    int64_t first = find_pair(out->c, sorted, a, b), end = first, n = 0;
    while (end < sorted && out->c[end].a == a && out->c[end].b == b) end++;
    const struct approach to = { y, sign, out, first, end };
    const struct pair pair = { .a = a, .b = b };
    for (int64_t k = 1; k <= y->n && n == 0; k++) {
        vec3 ahead = v3_scale((double)k, y->step);
        struct contacts found = { 0 };
        if (v3_norm(v3_sub(v3_add(o->x[y->i], ahead), o->x[f])) > reach) continue;
        bool good = detect_shapes_pair(&found, o->shaped, &pair, v3_scale(sign, ahead), y->thick);
        for (int64_t l = 0; l < found.n && y->i == b; l++)
            found.c[l].x = v3_sub(found.c[l].x, ahead);
        n = good ? add_coming(&to, k, &found) : -1;
        contacts_free(&found);
    }
    return n >= 0;
}

static int tunnelling_by_key(const void *a, const void *b)
{
    return contact_compare(a, b);
}

bool tunnelling_meet_hulls(struct contacts *out, const struct situation *o)
{
    const struct packing *p = o->p;
    double most;
    int64_t first = first_fixed_hull(p, &most), sorted = out->n;
    for (int64_t i = 0; first < p->n && i < p->n; i++) {
        if (!tunnelling_is(p, i, most)) continue;
        for (int64_t f = first; f < p->n; f++) {
            if (!is_fixed_hull(p, f) || !packing_may_meet(p, (int32_t)f, (int32_t)i)) continue;
            const struct tunnelling_way y = tunnelling_way_of(p, i, p->v[f]);
            if (y.n < 1) continue;
            if (passes_by(&y, o->x[i], o->x[f], p->radius[i] + p->radius[f]) &&
                !meet_hull(out, sorted, o, &y, f))
                return false;
        }
    }
    if (out->n > sorted) qsort(out->c, (size_t)out->n, sizeof *out->c, tunnelling_by_key);
    return true;
}

/* ---- what has passed ---- */

/* m: how far c is outside a cylinder, cone or sphere without end, as it is described */
static double outside(const struct wall *w, vec3 c)
{
    double z = v3_dot(c, w->n), rho = v3_norm(v3_axpy(c, -z, w->n)), r = w->size[0];
    if (w->shape == WALL_SPHERE) return v3_norm(c) - r;
    if (w->shape == WALL_CONE) r += (w->size[1] - r) * z / w->size[2];
    return rho - r;
}

static bool through_round(const struct wall *w, int dim, vec3 a, vec3 b)
{
    struct touch t;
    bool out = outside(w, a) > 0;
    if (out == (outside(w, b) > 0)) return false;
    for (int k = 0; k < 60; k++) { // to where it goes through
        vec3 middle = v3_scale(0.5, v3_add(a, b));
        if ((outside(w, middle) > 0) == out)
            a = middle;
        else
            b = middle;
    }
    return wall_nearest(w, dim, a, INFINITY, &t) &&
           fabs(t.distance) <= 1e-9 * (v3_norm(a) + w->size[0]);
}

static bool through_wall(const struct packing *p, const struct surface *surface, int32_t w, vec3 a,
                         vec3 b)
{
    const struct wall *wall = &p->wall[w];
    struct pose pose = wall_pose(p, wall, p->t);
    a = v3_sub(quat_turn_back(pose.q, v3_sub(a, pose.shift)), wall->x);
    b = v3_sub(quat_turn_back(pose.q, v3_sub(b, pose.shift)), wall->x);
    bool round =
        wall->shape == WALL_CYLINDER || wall->shape == WALL_CONE || wall->shape == WALL_SPHERE;
    return round ? through_round(wall, p->dim, a, b)
                 : wall_between(wall, p->dim, wall->shape == WALL_MESH ? &surface[w] : NULL, a, b);
}

bool tunnelling_through_hull(const struct shape *s, int dim, double r, quat q, vec3 a, vec3 b)
{
    double in = 0, out = 1;
    a = quat_turn_back(q, a), b = quat_turn_back(q, b);
    for (int32_t k = 0; k < (dim == 2 ? s->corners : s->faces); k++) {
        vec3 n = s->normal[k], v = s->vertex[s->corner[dim == 2 ? k : s->first[k]]];
        double at = r * (v3_dot(n, v) + s->round), ha = v3_dot(n, a) - at, hb = v3_dot(n, b) - at;
        if (ha > 0 && hb > 0) return false;
        if (ha > 0) in = dmax(in, ha / (ha - hb));
        if (ha <= 0 && hb > 0) out = dmin(out, ha / (ha - hb));
    }
    return in > 0 && in < out && out < 1;
}

void tunnelling_note(struct passed *s, int32_t id, int32_t through)
{
    if (!s->n++ || id < s->id || (id == s->id && through > s->through))
        s->id = id, s->through = through;
}

bool tunnelling_watches(const struct packing *p)
{
    double most;
    for (int32_t w = 0; w < p->walls; w++)
        if (p->wall[w].shape != WALL_PLANE) return true;
    return first_fixed_hull(p, &most) < p->n;
}

void tunnelling_passed(struct passed *s, const struct packing *p, const bool *of,
                       const struct surface *surface, struct window window)
{
    double most, speed = 0;
    int64_t first = first_fixed_hull(p, &most);
    *s = (struct passed){ 0 };
    for (int32_t w = 0; w < p->walls; w++)
        if (p->wall[w].shape != WALL_PLANE) speed = dmax(speed, tunnelling_beside(p, w));
    if (!tunnelling_watches(p)) return;
    for (int64_t i = 0; i < p->n; i++) {
        if ((of && !of[i]) || !tunnelling_is(p, i, dmax(speed, most))) continue;
        for (int32_t w = 0; w < p->walls; w++) {
            const struct wall *wall = &p->wall[w];
            if (wall->shape == WALL_PLANE || !wall_there(wall, p->t) ||
                !packing_may_meet(p, -1 - w, (int32_t)i))
                continue;
            vec3 v = v3_sub(p->v[i], wall_velocity(p, wall, p->x[i]));
            vec3 from = v3_axpy(p->x[i], -window.back, v);
            vec3 to = v3_axpy(from, window.length, v);
            if (through_wall(p, surface, w, from, to)) tunnelling_note(s, p->id[i], -1 - w);
        }
        for (int64_t f = first; f < p->n; f++) {
            if (!is_fixed_hull(p, f) || !packing_may_meet(p, (int32_t)f, (int32_t)i)) continue;
            vec3 v = v3_sub(p->v[i], p->v[f]);
            vec3 from = v3_axpy(p->x[i], -window.back, v);
            vec3 to = v3_axpy(from, window.length, v);
            from = v3_sub(from, p->x[f]), to = v3_sub(to, p->x[f]);
            if (tunnelling_through_hull(packing_shape(p, f), p->dim, p->radius[f], p->q[f], from,
                                        to))
                tunnelling_note(s, p->id[i], p->id[f]);
        }
    }
}
