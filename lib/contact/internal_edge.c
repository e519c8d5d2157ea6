#include "contact/internal_edge.h"

#include "contact/detect_shapes.h"
#include "shape/gjk.h"
#include "shape/mesh.h"
#include "shape/wall_edge.h"

#include <stdlib.h>
#include <string.h>

/* Of the radius of the body that slides: */
static const double FLUSH = 1e-5, /* the tolerance, at least; */
    AHEAD = 0.1,                  /* how far a surface is followed to see whether it rises; */
    LEVEL = 0.01;                 /* how much gaps of one meeting differ */
static const double ALONG = 1e-6; /* 1 - cosine: of normals that are one */
static const double RISES = 0.5;  /* sine of 30 degrees */

/* All contacts of every body: of[first[i]] .. of[first[i+1]-1] */
struct internal_edge_lists {
    int64_t *first, *of;
};

/* A contact as body s has it, where s is in its place: the other is a wall (< 0), or a body moved by `away` */
struct internal_edge_side {
    int32_t s, other;
    vec3 away, n, x; /* m; the normal towards s; the place on the other */
};

static struct internal_edge_side side_of(const struct situation *o, const struct contact *c,
                                         int32_t s)
{
    vec3 shift = o->edge ? cell_shift(o->edge, c->shift) : v3(0, 0, 0);
    struct internal_edge_side f = { s, c->b, shift, v3_scale(-1, c->n), c->x };
    if (s == c->b)
        f = (struct internal_edge_side){ s, c->a, v3_scale(-1, shift), c->n, v3_sub(c->x, shift) };
    if (f.other >= 0) f.x = v3_axpy(f.x, -0.5 * c->gap, f.n);
    return f;
}

/* Is it a body that moves by contacts? */
static bool internal_edge_moves(const struct situation *o, int32_t who)
{
    return who >= 0 && o->p->mass[who] > 0;
}

static double weld_of(const struct situation *o, int32_t who)
{
    if (who >= 0) return FLUSH * o->p->radius[who];
    const struct wall *w = &o->p->wall[-1 - who];
    if (w->weld > 0) return w->weld;
    if (w->shape == WALL_MESH) return o->surface[-1 - who].weld;
    double reach = wall_reach(w);
    return isfinite(reach) ? 2 * WELD_USUAL * reach : 0;
}

/* Core k of body i, which may be a ball among balls */
static struct core internal_edge_core_of(const struct situation *o, int32_t i, int32_t k)
{
    if (o->shaped) return placed_core(o->shaped, i, k);
    return (struct core){ .n = 1, .v = &o->x[i], .round = o->p->radius[i], .centre = o->x[i] };
}

static int32_t internal_edge_cores_of(const struct situation *o, int32_t i)
{
    return o->shaped ? placed_cores(o->shaped, i) : 1;
}

/* m: the height of the lowest point of body s along m */
static double bottom_of(const struct situation *o, int32_t s, vec3 m)
{
    double least = INFINITY;
    for (int32_t k = 0; k < internal_edge_cores_of(o, s); k++) {
        const struct core c = internal_edge_core_of(o, s, k);
        least = dmin(least, core_bottom(&c, m) - c.round);
    }
    return least;
}

/* ---- does it rise? ---- */

/* Height above which a surface is to rise, in the frame in which it is looked at */
struct height {
    vec3 m;       /* unit vector up */
    double level; /* m, along it */
};

/* Does the way from one place of a surface to another lead up by more than 30 degrees, to above the level? */
static bool leads_up(vec3 from, vec3 to, const struct height *h)
{
    vec3 way = v3_sub(to, from);
    return v3_dot(to, h->m) > h->level && v3_dot(way, h->m) > RISES * v3_norm(way);
}

/* Of a body, at the place of f: towards d, which lies above the level. */
static bool body_rises(const struct situation *o, const struct internal_edge_side *f, vec3 d,
                       const struct height *h)
{
    vec3 x = v3_sub(d, f->away);
    const struct core point = { .n = 1, .v = &x, .centre = x };
    for (int32_t k = 0; k < internal_edge_cores_of(o, f->other); k++) {
        const struct core c = internal_edge_core_of(o, f->other, k);
        const struct nearest near = gjk_nearest(&c, &point);
        vec3 to = d;
        if (near.distance > c.round)
            to = v3_axpy(v3_add(near.a, f->away), c.round / near.distance, v3_sub(x, near.a));
        if (leads_up(f->x, to, h)) return true;
    }
    return false;
}

/* A place of a mesh, as it is described */
struct internal_edge_spot {
    vec3 c, n;          /* m; the normal of the contact there */
    vec3 d;             /* m: the place above c that lies above the level */
    double near, depth; /* m: tolerance; how far c lies below the level */
};

/* Of a mesh: an element at the spot across n or, where there is none, all elements there. */
static bool mesh_rises(const struct surface *s, const struct internal_edge_spot *x,
                       const struct height *h)
{
    const double near = x->near, depth = x->depth;
    struct surface_walk walk;
    struct surface_branch leaf;
    bool any = false, all = true;
    surface_walk_begin(&walk, s->n);
    while (surface_walk_next(&walk, s->box, x->c, near + depth, &leaf))
        for (int32_t i = leaf.lo; i < leaf.hi; i++) {
            int32_t e = s->order[i];
            vec3 at = surface_nearest(s, e, x->c);
            double away = v3_norm(v3_sub(x->c, at));
            if (!(away <= near + depth)) continue;
            bool up = leads_up(at, surface_nearest(s, e, x->d), h);
            if (up && fabs(v3_dot(x->n, surface_normal(s, e))) > 1 - ALONG) return true;
            if (away <= near) any = true, all &= up;
        }
    return any && all;
}

/* The place of wall w next to c, as it is described; false: none */
static bool nearest_place(const struct situation *o, const struct wall *w, vec3 c, vec3 *at)
{
    struct touch t;
    if (!wall_nearest(w, o->p->dim, c, INFINITY, &t)) return false;
    *at = v3_axpy(c, -t.distance, t.n);
    return true;
}

/* Where x is for wall w as it is described */
static vec3 internal_edge_described(const struct wall *w, const struct pose *pose, vec3 x)
{
    return v3_sub(quat_turn_back(pose->q, v3_sub(x, pose->shift)), w->x);
}

/* Does what s meets rise there above the height `level` (m) along m? */
static bool rises(const struct situation *o, const struct internal_edge_side *f, vec3 m,
                  double level, double near)
{
    double depth = level - v3_dot(m, f->x), ahead = dmax(AHEAD * o->p->radius[f->s], 10 * near);
    const struct height here = { m, level + 3 * near };
    if (f->other >= 0) return body_rises(o, f, v3_axpy(f->x, depth + ahead, m), &here);
    const struct wall *w = &o->p->wall[-1 - f->other];
    struct pose pose = wall_pose(o->p, w, o->t);
    vec3 c = internal_edge_described(w, &pose, f->x), n = quat_turn_back(pose.q, m), at, to;
    vec3 d = v3_axpy(c, depth + ahead, n);
    const struct height above = { n, v3_dot(n, c) + depth + 3 * near };
    const struct internal_edge_spot spot = { c, quat_turn_back(pose.q, f->n), d, near,
                                             dmax(depth, 0) };
    if (w->shape == WALL_MESH) return mesh_rises(&o->surface[-1 - f->other], &spot, &above);
    return nearest_place(o, w, c, &at) && nearest_place(o, w, d, &to) && leads_up(at, to, &above);
}

/* Does wall w lie at x, to `near`, across n? */
static bool wall_is_at(const struct situation *o, int32_t w, vec3 x, vec3 n, double near)
{
    const struct wall *wall = &o->p->wall[w];
    struct pose pose = wall_pose(o->p, wall, o->t);
    vec3 c = internal_edge_described(wall, &pose, x), at;
    n = quat_turn_back(pose.q, n);
    if (wall->shape == WALL_MESH) return surface_is_at(&o->surface[w], c, &n, near);
    bool flat =
        wall->shape == WALL_PLANE || wall->shape == WALL_RECTANGLE || wall->shape == WALL_DISC;
    return flat && fabs(v3_dot(n, wall->n)) > 1 - ALONG && nearest_place(o, wall, c, &at) &&
           v3_norm(v3_sub(c, at)) <= near;
}

/* ---- one contact ---- */

/* A contact and the others of the same two bodies: first .. end-1 */
struct internal_edge_meeting {
    const struct situation *o;
    const struct contacts *all;
    int64_t i, first, end;
};

/* No place of the meeting, of body s and with the normal of contact i, is above `level` along m. */
static bool is_below(const struct internal_edge_meeting *w, const struct internal_edge_side *f,
                     vec3 m, double level)
{
    const struct contact *c = &w->all->c[w->i];
    for (int64_t k = w->first; k < w->end; k++) {
        const struct contact *d = &w->all->c[k];
        bool same = !memcmp(c->shift, d->shift, sizeof c->shift) &&
                    v3_dot(c->n, d->n) > 1 - ALONG &&
                    fabs(c->gap - d->gap) <= LEVEL * w->o->p->radius[f->s];
        if (same && v3_dot(m, side_of(w->o, d, f->s).x) > level) return false;
    }
    return true;
}

/* Would ranks that have B or s have E, too? Two bodies must be near each other for that. */
static bool are_near(const struct situation *o, const struct internal_edge_side *f,
                     const struct internal_edge_side *e)
{
    if (f->other < 0 || e->other < 0) return true;
    vec3 d = v3_sub(v3_add(o->x[f->other], f->away), v3_add(o->x[e->other], e->away));
    return v3_norm(d) <= o->p->radius[f->other] + o->p->radius[e->other];
}

/* Contacts c and e of body s with two walls have one normal: is c with a rim where the other wall goes on flat, or
   where e is, which comes first? */
static bool goes_without(const struct internal_edge_meeting *w, const struct internal_edge_side *f,
                         const struct contact *e, const struct internal_edge_side *g, double near)
{
    const struct contact *c = &w->all->c[w->i];
    double height = v3_dot(g->n, v3_sub(f->x, g->x));
    bool again = e < c && v3_norm(v3_sub(f->x, g->x)) <= near;
    if (again && e->mu == c->mu && e->en == c->en && e->et == c->et) return true;
    return c->feature >= RIM_END && fabs(height) <= near &&
           wall_is_at(w->o, -1 - f->other, f->x, f->n, near) &&
           wall_is_at(w->o, -1 - g->other, f->x, f->n, near);
}

/* Does the plane of contact e keep s above the meeting, or is that inside a flat surface? */
static bool passes_above(const struct internal_edge_meeting *w, const struct internal_edge_side *f,
                         const struct contact *e)
{
    const struct situation *o = w->o;
    const struct internal_edge_side g = side_of(o, e, f->s);
    if (internal_edge_moves(o, f->other) || internal_edge_moves(o, g.other))
        return false; // they are parts of no surface
    bool parallel = v3_dot(f->n, g.n) > 1 - ALONG;
    bool walls = f->other < 0 && g.other < 0 && f->other != g.other;
    if ((parallel && !walls) || !are_near(o, f, &g)) return false;
    double near = dmax(FLUSH * o->p->radius[f->s], dmax(weld_of(o, f->other), weld_of(o, g.other)));
    double plane = v3_dot(g.n, g.x), level = plane + near;
    if (!is_below(w, f, g.n, level)) return false;
    if (parallel) return goes_without(w, f, e, &g, near);
    if (bottom_of(o, f->s, g.n) < plane + dmin(e->gap, 0) - near) return false;
    return !rises(o, f, g.n, level, near);
}

/* Is contact i of body s at a seam? l: NULL where all contacts are those of s */
static bool at_seam(const struct internal_edge_meeting *w, const struct internal_edge_lists *l,
                    int32_t s)
{
    const int64_t first = l ? l->first[s] : 0, end = l ? l->first[s + 1] : w->all->n;
    const struct internal_edge_side f = side_of(w->o, &w->all->c[w->i], s);
    if (!internal_edge_moves(w->o, s)) return false;
    for (int64_t k = first; k < end; k++)
        if (passes_above(w, &f, &w->all->c[l ? l->of[k] : k])) return true;
    return false;
}

/* ---- all contacts ---- */

/* Can it be one with the rim of a wall, or of a body? */
static bool internal_edge_may_be(const struct situation *o, const struct contact *c)
{
    if (c->a >= 0) return !internal_edge_moves(o, c->a) || !internal_edge_moves(o, c->b);
    int32_t w = -1 - c->a;
    const struct wall *wall = &o->p->wall[w];
    if (packing_shape(o->p, c->b)) return wall->shape != WALL_PLANE;
    if (wall->shape == WALL_RECTANGLE || wall->shape == WALL_DISC)
        return fabs(v3_dot(c->n, wall_normal(o->p, wall, o->t))) < 1 - ALONG;
    if (wall->shape != WALL_MESH) return false;
    struct touch t = { .feature = c->feature };
    return wall_ends_at(wall, o->p->dim, &o->surface[w], v3(0, 0, 0), &t);
}

static bool internal_edge_lists_init(struct internal_edge_lists *l, const struct contacts *s,
                                     int64_t bodies)
{
    l->first = calloc((size_t)bodies + 2, sizeof *l->first);
    l->of = malloc((2 * (size_t)s->n + 1) * sizeof *l->of);
    if (!l->first || !l->of) return false;
    for (int64_t i = 0; i < s->n; i++) {
        l->first[s->c[i].b + 2]++;
        if (s->c[i].a >= 0) l->first[s->c[i].a + 2]++;
    }
    for (int64_t i = 0; i < bodies; i++) l->first[i + 2] += l->first[i + 1];
    for (int64_t i = 0; i < s->n; i++) { // first[i+1] moves from where i begins to where it ends
        l->of[l->first[s->c[i].b + 1]++] = i;
        if (s->c[i].a >= 0) l->of[l->first[s->c[i].a + 1]++] = i;
    }
    return true;
}

static struct internal_edge_meeting internal_edge_meeting_of(const struct situation *o,
                                                             const struct contacts *all, int64_t i)
{
    const struct contact *c = &all->c[i];
    struct internal_edge_meeting w = { o, all, i, i, i + 1 };
    while (w.first > 0 && all->c[w.first - 1].a == c->a && all->c[w.first - 1].b == c->b) w.first--;
    while (w.end < all->n && all->c[w.end].a == c->a && all->c[w.end].b == c->b) w.end++;
    return w;
}

static bool is_dropped(const struct situation *o, const struct contacts *all,
                       const struct internal_edge_lists *l, int64_t i)
{
    const struct contact *c = &all->c[i];
    const struct internal_edge_meeting w = internal_edge_meeting_of(o, all, i);
    return at_seam(&w, l, c->b) || (c->a >= 0 && at_seam(&w, l, c->a));
}

int seams_drop(struct contacts *s, const struct situation *o, struct failure *failure)
{
    struct internal_edge_lists lists = { 0 };
    bool *drop = NULL, good = true;
    int64_t n = 0;
    for (int64_t i = 0; good && i < s->n; i++) {
        if (s->c[i].a >= 0 && !o->shaped) break; // walls come first
        if (!internal_edge_may_be(o, &s->c[i])) continue;
        if (!drop)
            good = (drop = calloc((size_t)s->n, sizeof *drop)) &&
                   internal_edge_lists_init(&lists, s, o->p->n);
        if (good) drop[i] = is_dropped(o, s, &lists, i);
    }
    for (int64_t i = 0; good && drop && i < s->n; i++)
        if (!drop[i]) s->c[n++] = s->c[i];
    if (good && drop) s->n = n;
    free(lists.first), free(lists.of), free(drop);
    return good ? 0 : failure_set(failure, EX_SOFTWARE, "no memory for the contacts at seams");
}

bool seams_may(const struct situation *o, const struct contact *c)
{
    return internal_edge_may_be(o, c);
}

bool seams_has(const struct contacts *s, const struct situation *o, int32_t body, int64_t i)
{
    const struct internal_edge_meeting w = internal_edge_meeting_of(o, s, i);
    return at_seam(&w, NULL, body);
}
