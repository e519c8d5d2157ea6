#include "bodies/seam.h"

#include "bodies/gjk.h"
#include "bodies/rim.h"
#include "bodies/surface_tree.h"

#include <stdlib.h>
#include <string.h>

/* Of the radius of the body that slides: */
static const double FLUSH = 1e-5, /* the tolerance, at least; */
    AHEAD = 0.1;                  /* how far a direction is followed to see where it leads */
static const double INTO = 1e-3;  /* cosine: less leads across a surface, not into it */
static const double RISES = 0.5;  /* sine of 30 degrees */
static const double ALIKE = 1e-6; /* 1 - cosine: normals of one meeting; */
static const double LEVEL = 0.01; /* and of the radius: how much their gaps differ */

enum { PARTS = 16 }; /* triangles at a place, at most: of more the first */

/* Part of a surface at a place: its place next to that, the one next to what lies ahead, and its normal,
   whose sign tells nothing */
struct part {
    vec3 at, ahead, n;
};

/* All contacts of every body: of[first[i]] .. of[first[i+1]-1] */
struct lists {
    int64_t *first, *of;
};

/* A meeting in hand: body s with part B, a wall (< 0) or a body, as far as `away` (m) from where it is */
struct meeting {
    const struct seams *o;
    const struct contacts *all;
    const struct lists *lists;
    int64_t first, end; /* contacts of these two */
    int32_t s, B;
    vec3 from; /* m: added to places of contacts, and to those of a body B: s is then where it is */
    vec3 n;    /* towards s */
    double gap;
    const int8_t *shift;
};

static double weld_of(const struct seams *o, int32_t who)
{
    if (who >= 0) return FLUSH * o->p->radius[who];
    const struct wall *w = &o->p->wall[-1 - who];
    if (w->weld > 0) return w->weld;
    if (w->shape == BOUNDARY_MESH) return o->surface[-1 - who].weld;
    double reach = boundary_reach(w);
    return isfinite(reach) ? 2 * WELD_USUAL * reach : 0;
}

/* ---- parts of surfaces at a place ---- */

static int parts_of_mesh(const struct surface *s, vec3 c, vec3 ahead, double near,
                         struct part out[PARTS])
{
    struct surface_walk walk;
    struct surface_branch leaf;
    int n = 0;
    surface_walk_begin(&walk, s->n);
    while (surface_walk_next(&walk, s->box, c, near, &leaf))
        for (int32_t i = leaf.lo; i < leaf.hi && n < PARTS; i++) {
            int32_t e = s->order[i];
            vec3 at = surface_nearest(s, e, c);
            if (!(v3_norm(v3_sub(c, at)) <= near)) continue;
            out[n++] = (struct part){ at, surface_nearest(s, e, ahead), surface_normal(s, e) };
        }
    return n;
}

static int parts_of_shape(const struct wall *w, int dim, vec3 c, vec3 ahead, double near,
                          struct part out[PARTS])
{
    struct touch t, u;
    if (!boundary_nearest(w, dim, c, INFINITY, &t) || !(fabs(t.distance) <= near) ||
        !boundary_nearest(w, dim, ahead, INFINITY, &u))
        return 0;
    bool flat =
        w->shape == BOUNDARY_PLANE || w->shape == BOUNDARY_RECTANGLE || w->shape == BOUNDARY_DISC;
    out[0] = (struct part){ v3_axpy(c, -t.distance, t.n), v3_axpy(ahead, -u.distance, u.n),
                            flat ? w->n : t.n };
    return 1;
}

/* Those of a wall at most `near` (m) from x, in space */
static int parts_of_wall(const struct seams *o, int32_t w, vec3 x, vec3 ahead, double near,
                         struct part out[PARTS])
{
    const struct wall *wall = &o->p->wall[w];
    if (!wall_there(wall, o->t)) return 0;
    struct pose pose = wall_pose(o->p, wall, o->t);
    vec3 c = v3_sub(quat_turn_back(pose.q, v3_sub(x, pose.shift)), wall->x);
    vec3 d = v3_sub(quat_turn_back(pose.q, v3_sub(ahead, pose.shift)), wall->x);
    int n = wall->shape == BOUNDARY_MESH ? parts_of_mesh(&o->surface[w], c, d, near, out)
                                         : parts_of_shape(wall, o->p->dim, c, d, near, out);
    for (int k = 0; k < n; k++) {
        out[k].at = pose_of(&pose, v3_add(wall->x, out[k].at));
        out[k].ahead = pose_of(&pose, v3_add(wall->x, out[k].ahead));
        out[k].n = quat_turn(pose.q, out[k].n);
    }
    return n;
}

static vec3 nearest_of_hull(const struct core *c, vec3 x)
{
    const struct core point = { .n = 1, .v = &x, .centre = x };
    const struct nearest o = gjk_nearest(c, &point);
    return o.distance > 0 ? o.a : x;
}

/* That of a hull on whose side `from` is */
static int parts_of_hull(const struct core *c, int dim, vec3 x, vec3 ahead, double near, vec3 from,
                         struct part out[PARTS])
{
    vec3 at = nearest_of_hull(c, x);
    double most = -INFINITY;
    if (!(v3_norm(v3_sub(x, at)) <= near)) return 0;
    out[0] = (struct part){ at, nearest_of_hull(c, ahead), { 0, 0, 0 } };
    int32_t faces = dim == 2 ? c->n : c->hull->faces;
    for (int32_t f = 0; f < faces; f++) {
        const struct shape *s = c->hull;
        vec3 v = c->v[s->corner[dim == 2 ? f : s->first[f]]];
        double height = v3_dot(c->normal[f], v3_sub(from, v));
        if (height > most) most = height, out[0].n = c->normal[f];
    }
    return 1;
}

/* Is it a hull without rounding? */
static bool is_hull(const struct seams *o, int32_t i)
{
    const struct shape *s = packing_shape(o->p, i);
    return s && s->form == SHAPE_HULL && s->round == 0;
}

/* ---- what a meeting is dropped for ---- */

/* The place of contact i on B */
static vec3 place_of(const struct meeting *m, int64_t i)
{
    const struct contact *c = &m->all->c[i];
    vec3 x = v3_add(c->x, m->from);
    return m->B < 0 ? x : v3_axpy(x, -0.5 * c->gap, m->n);
}

/* Is contact i of this meeting: of the same two with the same normal, as far away? */
static bool is_of(const struct meeting *m, int64_t i)
{
    const struct contact *c = &m->all->c[i];
    double along = v3_dot(c->n, m->n);
    return (c->a == m->B ? along : -along) > 1 - ALIKE &&
           !memcmp(c->shift, m->shift, sizeof c->shift) &&
           fabs(c->gap - m->gap) <= LEVEL * m->o->p->radius[m->s];
}

/* Does B rise from the plane of `part` at x, towards up? Of a hull its corners that are foremost along n */
static bool rises(const struct meeting *m, vec3 x, const struct part *part, vec3 up, double ahead,
                  double near)
{
    struct part own[PARTS];
    if (m->B >= 0) {
        const struct core c = placed_core(m->o->shaped, m->B, 0);
        double most = core_top(&c, m->n) - INTO * m->o->p->radius[m->B];
        for (int32_t k = 0; k < c.n; k++)
            if (v3_dot(m->n, c.v[k]) >= most &&
                v3_dot(up, v3_sub(v3_add(c.v[k], m->from), part->at)) > near)
                return true;
        return false;
    }
    int n = parts_of_wall(m->o, -1 - m->B, x, v3_axpy(x, ahead, up), near, own), rising = 0;
    for (int k = 0; k < n; k++) {
        vec3 d = v3_sub(own[k].ahead, own[k].at);
        rising += v3_dot(d, up) > dmax(RISES * v3_norm(d), 4 * near);
    }
    return n > 0 && rising == n;
}

/* Is the place x of the meeting covered by this part, with all others of it? */
static bool covers(const struct meeting *m, vec3 x, const struct part *part, double ahead,
                   double near)
{
    vec3 d = v3_sub(part->ahead, part->at), up = part->n;
    double length = v3_norm(d);
    if (!(length > 4 * near) || !(v3_dot(d, m->n) > INTO * length)) return false;
    if (v3_dot(up, v3_sub(m->o->x[m->s], x)) < 0) up = v3_scale(-1, up);
    for (int64_t i = m->first; i < m->end; i++)
        if (is_of(m, i) && v3_dot(up, v3_sub(place_of(m, i), part->at)) > near) return false;
    return !rises(m, x, part, up, ahead, near);
}

/* E, a wall or a body, as far as `from` (m) from where it is */
static bool flush_with(const struct meeting *m, int32_t E, vec3 from)
{
    const struct seams *o = m->o;
    double near = dmax(FLUSH * o->p->radius[m->s], dmax(weld_of(o, E), weld_of(o, m->B)));
    double ahead = dmax(AHEAD * o->p->radius[m->s], 10 * near);
    struct part part[PARTS];
    for (int64_t i = m->first; i < m->end; i++) {
        if (!is_of(m, i)) continue;
        vec3 x = place_of(m, i), y = v3_sub(x, from);
        int n;
        if (E < 0) {
            n = parts_of_wall(o, -1 - E, x, v3_axpy(x, ahead, m->n), near, part);
        } else {
            const struct core c = placed_core(o->shaped, E, 0);
            n = parts_of_hull(&c, o->p->dim, y, v3_axpy(y, ahead, m->n), near,
                              v3_sub(o->x[m->s], from), part);
            part[0].at = v3_add(part[0].at, from), part[0].ahead = v3_add(part[0].ahead, from);
        }
        for (int k = 0; k < n; k++)
            if (covers(m, x, &part[k], ahead, near)) return true;
    }
    return false;
}

/* Body s is body b of contact c, or a: who the other is, and where it is for s to be in its place */
static int32_t other_of(const struct seams *o, const struct contact *c, int32_t s, vec3 *from)
{
    vec3 shift = o->edge ? cell_shift(o->edge, c->shift) : v3(0, 0, 0);
    *from = s == c->b ? v3_scale(-1, shift) : shift;
    return s == c->b ? c->a : c->b;
}

static bool at_seam(struct meeting *m)
{
    int32_t last = m->s;
    const struct lists *l = m->lists;
    for (int64_t k = l->first[m->s]; k < l->first[m->s + 1]; k++) {
        const struct contact *c = &m->all->c[l->of[k]];
        vec3 from;
        int32_t E = other_of(m->o, c, m->s, &from);
        if (E == last || (E == m->B && E >= 0) || (E >= 0 && !is_hull(m->o, E))) continue;
        bool flat = fabs(v3_dot(c->n, m->n)) < 1 - ALIKE; // else n leads into nothing
        if (!flat && E >= 0) continue;
        last = E;
        if (flush_with(m, E, from)) return true;
    }
    return false;
}

/* ---- all contacts ---- */

/* Can contact i of a wall be one with its rim? */
static bool of_rim(const struct seams *o, const struct contact *c)
{
    int32_t w = -1 - c->a;
    const struct wall *wall = &o->p->wall[w];
    if (wall->shape == BOUNDARY_RECTANGLE || wall->shape == BOUNDARY_DISC)
        return fabs(v3_dot(c->n, wall_normal(o->p, wall, o->t))) < 1 - ALIKE;
    if (wall->shape != BOUNDARY_MESH) return false;
    if (packing_shape(o->p, c->b)) return true;
    struct touch t = { .feature = c->feature };
    return boundary_ends_at(wall, o->p->dim, &o->surface[w], v3(0, 0, 0), &t);
}

static bool lists_init(struct lists *l, const struct contacts *s, int64_t bodies)
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

/* Is contact i one of body s at a seam? */
static bool slides(const struct seams *o, const struct contacts *all, const struct lists *l,
                   int64_t i, int32_t s)
{
    const struct contact *c = &all->c[i];
    struct meeting m = { o, all, l, i, i + 1, s, 0, { 0, 0, 0 }, c->n, c->gap, c->shift };
    m.B = other_of(o, c, s, &m.from);
    if (m.B >= 0 && (!is_hull(o, m.B) || o->p->mass[s] == 0)) return false;
    if (s == c->a)
        m.n = v3_scale(-1, c->n);
    else if (c->a >= 0)
        m.n = c->n;
    while (m.first > 0 && all->c[m.first - 1].a == c->a && all->c[m.first - 1].b == c->b) m.first--;
    while (m.end < all->n && all->c[m.end].a == c->a && all->c[m.end].b == c->b) m.end++;
    return at_seam(&m);
}

int seams_drop(struct contacts *s, const struct seams *o, struct why *why)
{
    struct lists lists = { 0 };
    bool *drop = NULL, any = false, good = true;
    for (int64_t i = 0; good && i < s->n; i++) {
        const struct contact *c = &s->c[i];
        if (c->a >= 0 && !o->shaped) break; // walls come first
        if (c->a < 0 ? !of_rim(o, c) : !packing_shape(o->p, c->a) && !packing_shape(o->p, c->b))
            continue;
        if (!drop)
            good = (drop = calloc((size_t)s->n, sizeof *drop)) && lists_init(&lists, s, o->p->n);
        if (good)
            drop[i] = slides(o, s, &lists, i, c->b) || (c->a >= 0 && slides(o, s, &lists, i, c->a));
        any |= good && drop[i];
    }
    int64_t n = 0;
    for (int64_t i = 0; any && i < s->n; i++)
        if (!drop[i]) s->c[n++] = s->c[i];
    if (any) s->n = n;
    free(lists.first), free(lists.of), free(drop);
    return good ? 0 : why_set(why, EX_SOFTWARE, "no memory for the contacts at seams");
}
