/* draw/walls.c: the region of a packing, and its walls cut by the region and by each other. */
#include "draw/walls.h"

#include "draw/outline.h"

static double *walls_component(vec3 *a, int axis)
{
    return axis == 0 ? &a->x : axis == 1 ? &a->y : &a->z;
}

static vec3 walls_unit(int axis, double sign)
{
    return v3(axis == 0 ? sign : 0, axis == 1 ? sign : 0, axis == 2 ? sign : 0);
}

static vec3 wall_now(const struct packing *p, int i)
{
    return wall_at(p, &p->wall[i], p->t);
}

static vec3 normal_now(const struct packing *p, int i)
{
    return wall_normal(p, &p->wall[i], p->t);
}

/* A plane that is there; all else is draw/outline.h's */
static bool is_plane(const struct packing *p, int i)
{
    return p->wall[i].shape == WALL_PLANE && wall_there(&p->wall[i], p->t);
}

static bool is_drawn(vec3 x)
{
    return fabs(x.x) < WALLS_FAR && fabs(x.y) < WALLS_FAR && fabs(x.z) < WALLS_FAR;
}

static int walls_of(const struct packing *p)
{
    return p->walls < WALLS_PANELS ? p->walls : WALLS_PANELS;
}

/* ---- the region ---- */

/* m: the innermost wall across the axis, below (sign 1) or above (-1) the bodies; NAN: none */
static double walls_limit(const struct packing *p, int axis, double sign)
{
    double found = NAN;
    for (int i = 0; i < walls_of(p); i++) {
        vec3 x = wall_now(p, i);
        if (!is_plane(p, i) || !is_drawn(x) ||
            v3_dot(normal_now(p, i), walls_unit(axis, sign)) < 0.999)
            continue;
        double c = *walls_component(&x, axis);
        if (isnan(found) || sign * c > sign * found) found = c;
    }
    return found;
}

/* The space between the walls; along an axis that they leave open, as wide as the widest other. */
static bool region_of_walls(struct extent *r, const struct packing *p)
{
    double lo[3], hi[3], size = 0;
    bool any = false;
    for (int k = 0; k < 3; k++) {
        lo[k] = walls_limit(p, k, 1), hi[k] = walls_limit(p, k, -1);
        if (hi[k] > lo[k]) size = fmax(size, hi[k] - lo[k]);
        any |= !isnan(lo[k]) || !isnan(hi[k]);
    }
    if (!(size > 0)) size = 1;
    for (int k = 0; k < 3; k++) {
        if (isnan(lo[k]) && isnan(hi[k])) lo[k] = -0.5 * size;
        if (isnan(lo[k])) lo[k] = hi[k] - size;
        if (!(hi[k] > lo[k])) hi[k] = lo[k] + size;
        *walls_component(&r->lo, k) = lo[k], *walls_component(&r->hi, k) = hi[k];
    }
    if (p->dim == 2) r->lo.z = r->hi.z = 0;
    return any;
}

static bool walls_is_finite(const struct packing *p, int32_t i)
{
    const struct wall *w = &p->wall[i];
    return wall_there(w, p->t) && (w->shape == WALL_MESH || isfinite(wall_reach(w)));
}

static bool any_finite(const struct packing *p)
{
    for (int32_t i = 0; i < p->walls; i++)
        if (walls_is_finite(p, i)) return true;
    return false;
}

vec3 walls_up(const struct packing *p)
{
    double g = v3_norm(p->g);
    if (g > 0) return v3_scale(-1 / g, p->g);
    return p->dim == 2 ? v3(0, 1, 0) : v3(0, 0, 1);
}

bool extent_clip(const struct extent *r, vec3 *a, vec3 *b)
{
    vec3 from = *a, way = v3_sub(*b, *a), lo = r->lo, hi = r->hi;
    double first = 0, last = 1, near = 1e-6 * v3_norm(v3_sub(hi, lo));
    for (int k = 0; k < 3; k++) {
        double x = *walls_component(&from, k), d = *walls_component(&way, k);
        double l = *walls_component(&lo, k) - near, h = *walls_component(&hi, k) + near;
        if (d == 0 && (x < l || x > h)) return false;
        if (d == 0) continue;
        first = fmax(first, d > 0 ? (l - x) / d : (h - x) / d);
        last = fmin(last, d > 0 ? (h - x) / d : (l - x) / d);
    }
    if (!(first <= last)) return false;
    if (first > 0) *a = v3_axpy(from, first, way);
    if (last < 1) *b = v3_axpy(from, last, way);
    return true;
}

/* How far beyond the bodies finite walls count: in sizes of all of them, or diameters of the largest */
static const double NEAR_ALL = 4, NEAR_ONE = 40;

/* Around the bodies, whose region is r; without any, all space */
static struct extent near_bodies(const struct extent *r, const struct packing *p)
{
    double size = NEAR_ALL * fmax(r->hi.x - r->lo.x, fmax(r->hi.y - r->lo.y, r->hi.z - r->lo.z));
    for (int64_t i = 0; i < p->n; i++)
        if (p->radius[i] < WALLS_FAR) size = fmax(size, NEAR_ONE * 2 * p->radius[i]);
    if (r->lo.x > r->hi.x) size = 4 * WALLS_FAR;
    const vec3 d = v3(size, size, size);
    return r->lo.x > r->hi.x ? (struct extent){ v3_scale(-1, d), d }
                             : (struct extent){ v3_sub(r->lo, d), v3_add(r->hi, d) };
}

/* Walls that end somewhere are shown as far as they lie in a box; NULL: whole; without memory for that they are
   not. */
static void add_finite(struct extent *r, const struct packing *p, const struct extent *in)
{
    struct outline o;
    struct failure failure = { 0 };
    if (!any_finite(p) || outline_init(&o, p, 0, &failure)) return;
    for (int64_t i = 0; i < o.lines; i++) {
        vec3 *end = o.line[i].end;
        if (in && is_drawn(end[0]) && is_drawn(end[1]) && !extent_clip(in, &end[0], &end[1]))
            continue;
        for (int k = 0; k < 2; k++) {
            vec3 x = end[k];
            if (!walls_is_finite(p, o.line[i].wall) || !is_drawn(x)) continue;
            r->lo = v3(fmin(r->lo.x, x.x), fmin(r->lo.y, x.y), fmin(r->lo.z, x.z));
            r->hi = v3(fmax(r->hi.x, x.x), fmax(r->hi.y, x.y), fmax(r->hi.z, x.z));
        }
    }
    outline_free(&o);
}

static bool find_region(struct extent *r, const struct packing *p, bool near)
{
    const double far = 2 * WALLS_FAR;
    r->lo = v3(far, far, far), r->hi = v3(-far, -far, -far);
    for (int64_t i = 0; i < p->n; i++)
        for (int k = 0; is_drawn(p->x[i]) && p->radius[i] < WALLS_FAR && k < 3; k++) {
            double c = *walls_component(&p->x[i], k), b = k < p->dim ? p->radius[i] : 0;
            *walls_component(&r->lo, k) = fmin(*walls_component(&r->lo, k), c - b);
            *walls_component(&r->hi, k) = fmax(*walls_component(&r->hi, k), c + b);
        }
    if (r->lo.x > r->hi.x && !any_finite(p)) return region_of_walls(r, p);
    const struct extent around = near_bodies(r, p);
    add_finite(r, p, near ? &around : NULL);
    double size = fmax(r->hi.x - r->lo.x, fmax(r->hi.y - r->lo.y, r->hi.z - r->lo.z));
    const vec3 up = walls_up(p);
    int upright = p->dim - 1; // the axis that is nearest to gravity
    for (int k = 0; k < p->dim; k++)
        if (fabs(v3_dot(up, walls_unit(k, 1))) > fabs(v3_dot(up, walls_unit(upright, 1))))
            upright = k;
    for (int k = 0; k < p->dim; k++) {
        // wide beside the bodies, where the floor is seen; narrow above them
        double margin = size * (k == upright ? 0.04 : 0.25);
        double *lo = walls_component(&r->lo, k), *hi = walls_component(&r->hi, k);
        double below = walls_limit(p, k, 1), above = walls_limit(p, k, -1);
        *lo = *lo - below <= size ? fmin(*lo, below) : *lo - margin;
        *hi = above - *hi <= size ? fmax(*hi, above) : *hi + margin;
    }
    return true;
}

bool region_of(struct extent *r, const struct packing *p)
{
    return find_region(r, p, false);
}

bool region_near(struct extent *r, const struct packing *p)
{
    return find_region(r, p, true);
}

struct extent region_join(struct extent a, struct extent b)
{
    return (struct extent){
        { fmin(a.lo.x, b.lo.x), fmin(a.lo.y, b.lo.y), fmin(a.lo.z, b.lo.z) },
        { fmax(a.hi.x, b.hi.x), fmax(a.hi.y, b.hi.y), fmax(a.hi.z, b.hi.z) },
    };
}

/* ---- walls in it ---- */

/* A convex polygon; cut[k]: the wall that cut its side from corner k to the next, -1: the region */
struct walls_polygon {
    int count;
    vec3 p[WALLS_CORNERS];
    int cut[WALLS_CORNERS];
};

/* Keeps the part with n . x >= c [Sutherland and Hodgman]; who cuts: a wall or -1. */
static void walls_clip(struct walls_polygon *g, vec3 n, double c, int who)
{
    struct walls_polygon out = { .count = 0 };
    for (int k = 0; k < g->count; k++) {
        vec3 a = g->p[k], b = g->p[(k + 1) % g->count];
        double da = v3_dot(n, a) - c, db = v3_dot(n, b) - c;
        if (da >= 0) out.p[out.count] = a, out.cut[out.count++] = g->cut[k];
        if ((da >= 0) == (db >= 0) || out.count + 2 > WALLS_CORNERS) continue;
        out.p[out.count] = v3_axpy(a, da / (da - db), v3_sub(b, a));
        out.cut[out.count++] = da >= 0 ? who : g->cut[k];
    }
    *g = out;
}

/* With a tolerance, because walls often lie exactly in the sides of the region */
static void clip_region(struct walls_polygon *g, const struct extent *r, vec3 middle, double size,
                        int dim)
{
    double tolerance = 1e-6 * size;
    vec3 lo = v3_sub(r->lo, middle), hi = v3_sub(r->hi, middle);
    for (int k = 0; k < dim; k++) {
        walls_clip(g, walls_unit(k, 1), *walls_component(&lo, k) - tolerance, -1);
        walls_clip(g, walls_unit(k, -1), -*walls_component(&hi, k) - tolerance, -1);
    }
}

/* A square, or in the plane a line, of wall i that extends beyond the region; m from its middle */
static struct walls_polygon wall_uncut(const struct packing *p, int i, vec3 middle, double size)
{
    vec3 n = normal_now(p, i), x = v3_sub(wall_now(p, i), middle);
    vec3 foot = v3_scale(v3_dot(n, x), n);
    vec3 s = p->dim == 2       ? v3(0, 0, 1)
             : fabs(n.x) < 0.7 ? v3_cross(n, v3(1, 0, 0))
                               : v3_cross(n, v3(0, 1, 0));
    s = v3_scale(size / v3_norm(s), s);
    vec3 t = v3_cross(n, s);
    if (p->dim == 2)
        return (struct walls_polygon){ 2, { v3_sub(foot, t), v3_add(foot, t) }, { -1, -1 } };
    struct walls_polygon g = { .count = 4, .cut = { -1, -1, -1, -1 } };
    g.p[0] = v3_sub(v3_sub(foot, s), t), g.p[1] = v3_sub(v3_add(foot, s), t);
    g.p[2] = v3_add(v3_add(foot, s), t), g.p[3] = v3_add(v3_sub(foot, s), t);
    return g;
}

static void keep_polygon(struct walls *b, const struct packing *p, int i,
                         const struct walls_polygon *g, vec3 middle)
{
    bool stroke = p->dim == 2;
    for (int k = 0; k < (stroke ? 1 : g->count); k++) {
        // an edge between two walls is a side of both polygons: that of the second is left out
        if ((!stroke && g->cut[k] < i) || b->edges == WALLS_EDGES) continue;
        b->edge[b->edges++] =
            (struct edge){ v3_add(g->p[k], middle), v3_add(g->p[(k + 1) % g->count], middle) };
    }
    if (stroke || g->count < 3 || v3_dot(normal_now(p, i), walls_up(p)) < WALLS_FLAT) return;
    struct panel *f = &b->panel[b->panels++];
    *f = (struct panel){ .n = normal_now(p, i), .origin = wall_now(p, i), .corners = g->count };
    for (int k = 0; k < g->count; k++) f->corner[k] = v3_add(g->p[k], middle);
}

/* Wall i cut by the region and by all other walls; corners from the middle */
static struct walls_polygon wall_cut(const struct packing *p, int i, const struct extent *r,
                                     vec3 middle)
{
    double size = v3_norm(v3_sub(r->hi, r->lo));
    if (!is_plane(p, i) || !is_drawn(wall_now(p, i))) return (struct walls_polygon){ .count = 0 };
    struct walls_polygon g = wall_uncut(p, i, middle, size);
    clip_region(&g, r, middle, size, p->dim);
    for (int j = 0; j < walls_of(p) && g.count; j++) {
        vec3 n = normal_now(p, j), x = wall_now(p, j);
        if (j == i || !is_plane(p, j) || !is_drawn(x)) continue;
        walls_clip(&g, n, v3_dot(n, v3_sub(x, middle)) - 1e-9 * size, j);
    }
    return g;
}

/* Lines of the other shapes; without memory for them there are none. */
static void walls_add_outlines(struct walls *b, const struct packing *p, const struct extent *r)
{
    struct outline o;
    struct failure failure = { 0 };
    if (outline_init(&o, p, v3_norm(v3_sub(r->hi, r->lo)), &failure)) return;
    for (int64_t i = 0; i < o.lines && b->edges < WALLS_EDGES; i++)
        if (is_drawn(o.line[i].end[0]) && is_drawn(o.line[i].end[1]))
            b->edge[b->edges++] = (struct edge){ o.line[i].end[0], o.line[i].end[1] };
    outline_free(&o);
}

void walls_build(struct walls *b, const struct packing *p, const struct extent *r)
{
    b->panels = b->edges = 0;
    vec3 middle = v3_scale(0.5, v3_add(r->lo, r->hi));
    for (int i = 0; i < walls_of(p); i++) {
        struct walls_polygon g = wall_cut(p, i, r, middle);
        if (g.count > 1) keep_polygon(b, p, i, &g, middle);
    }
    walls_add_outlines(b, p, r);
}

bool walls_floor(const struct packing *p, int i, vec3 toward)
{
    vec3 n = normal_now(p, i);
    return v3_dot(n, walls_up(p)) >= WALLS_FLAT && v3_dot(n, toward) > WALLS_FACING;
}

int walls_polygon(const struct packing *p, int i, const struct extent *r, vec3 *corner)
{
    vec3 middle = v3_scale(0.5, v3_add(r->lo, r->hi));
    struct walls_polygon g = wall_cut(p, i, r, middle);
    for (int k = 0; k < g.count; k++) corner[k] = v3_add(g.p[k], middle);
    return g.count;
}
