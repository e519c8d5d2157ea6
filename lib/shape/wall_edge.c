#include "shape/wall_edge.h"

#include "shape/mesh.h"

/* Of the sum of two unit vectors: surfaces are in one plane. A finely tessellated drum is bent by more. */
static const double FLAT = 2e-3;

static vec3 wall_edge_unit(vec3 a)
{
    double length = v3_norm(a);
    return length > 0 ? v3_scale(1 / length, a) : a;
}

/* Is it next to c, and do its surfaces bend? */
static bool counts(const struct rim *r, vec3 c, double reach)
{
    vec3 d = v3_sub(r->v[r->n - 1], r->v[0]), w = v3_sub(c, r->v[0]);
    double length2 = v3_dot(d, d), t = length2 > 0 ? v3_dot(w, d) / length2 : 0;
    vec3 away = v3_axpy(w, t < 0 ? 0 : t > 1 ? -1 : -t, d);
    if (v3_dot(away, away) > reach * reach) return false;
    return r->sides != 2 || v3_norm(v3_add(r->into[0], r->into[1])) > FLAT;
}

static void of_rectangle(struct rims *out, const struct wall *w, int dim, vec3 c, double reach)
{
    vec3 across = v3_cross(w->n, w->along), corner[4];
    double a = w->size[0] / 2, b = dim == 2 ? 0 : w->size[1] / 2;
    for (int k = 0; k < 4; k++)
        corner[k] = v3_axpy(v3_scale(k == 1 || k == 2 ? a : -a, w->along), k > 1 ? b : -b, across);
    for (int k = 0; k < (dim == 2 ? 2 : 4); k++) {
        struct rim r = { .n = dim - 1, .sides = 1, .key = k, .corner = { k, (k + 1) % 4 } };
        r.v[0] = corner[k], r.v[1] = corner[(k + 1) % 4];
        vec3 into = dim == 2 ? corner[k] : v3_add(r.v[0], r.v[1]); // of it, the middle is 0
        r.into[0] = wall_edge_unit(v3_scale(-1, into));
        if (counts(&r, c, reach)) out->rim[out->n++] = r;
    }
}

/* From the line or point of r into element e */
static vec3 into_element(const struct surface *s, int32_t e, const struct rim *r)
{
    vec3 inside = v3(0, 0, 0), d = v3_sub(r->v[r->n - 1], r->v[0]);
    for (int k = 0; k < 3; k++) inside = v3_axpy(inside, 1.0 / 3, s->at[e][k]);
    vec3 way = v3_sub(inside, r->v[0]);
    if (r->n == 2) way = v3_axpy(way, -v3_dot(way, d) / v3_dot(d, d), d);
    return wall_edge_unit(way);
}

static bool has_corner(const struct surface *s, int32_t e, int32_t v)
{
    return s->corner[3 * e] == v || s->corner[3 * e + 1] == v || s->corner[3 * e + 2] == v;
}

/* r = side k of element e, in the plane its corner k. False where an element before e has it, too: a side
   that several share is given once, by the first. */
static bool of_element(const struct surface *s, int dim, int32_t e, int k, struct rim *r)
{
    int next = dim == 2 ? k : (k + 1) % 3;
    int32_t v = s->corner[3 * e + k], w = s->corner[3 * e + next];
    *r = (struct rim){ .n = dim - 1, .key = 3 * e + k, .corner = { v, w } };
    r->v[0] = s->at[e][k], r->v[1] = s->at[e][next];
    for (int32_t i = s->star[v]; i < s->star[v + 1] && r->sides < RIM_SIDES_MOST; i++) {
        int32_t other = s->member[i];
        bool again = i > s->star[v] && s->member[i - 1] == other; // a segment has a corner twice
        if (again || !has_corner(s, other, w)) continue;
        if (other < e) return false;
        r->into[r->sides++] = into_element(s, other, r);
    }
    return true;
}

static void of_surface(struct rims *out, const struct surface *s, int dim, vec3 c, double reach)
{
    struct surface_walk walk;
    struct surface_branch leaf;
    struct rim r;
    surface_walk_begin(&walk, s->n);
    while (surface_walk_next(&walk, s->box, c, reach, &leaf))
        for (int32_t i = leaf.lo; i < leaf.hi; i++)
            for (int k = 0; k < dim; k++)
                if (out->n < RIMS_MOST && of_element(s, dim, s->order[i], k, &r) &&
                    counts(&r, c, reach))
                    out->rim[out->n++] = r;
}

void rims_near(struct rims *out, const struct wall *w, int dim, const struct surface *surface,
               vec3 c, double reach)
{
    out->n = 0;
    if (surface)
        of_surface(out, surface, dim, c, reach);
    else if (w->shape == WALL_RECTANGLE)
        of_rectangle(out, w, dim, c, reach);
}

/* ---- is it the end? ---- */

/* How many elements have both corners */
static int32_t elements_at(const struct surface *s, int32_t v, int32_t w)
{
    int32_t n = 0;
    for (int32_t i = s->star[v]; i < s->star[v + 1]; i++)
        n +=
            (i == s->star[v] || s->member[i] != s->member[i - 1]) && has_corner(s, s->member[i], w);
    return n;
}

/* Is one of the sides that begin at a corner that of one element alone? */
static bool ends_at_corner(const struct surface *s, int dim, int32_t v)
{
    if (dim == 2) return elements_at(s, v, v) == 1;
    for (int32_t i = s->star[v]; i < s->star[v + 1]; i++)
        for (int k = 0; k < 3; k++) {
            int32_t w = s->corner[3 * s->member[i] + k];
            if (w != v && elements_at(s, v, w) == 1) return true;
        }
    return false;
}

static bool surface_ends(const struct surface *s, int dim, int32_t feature)
{
    int32_t e = feature / SURFACE_FEATURES, part = feature % SURFACE_FEATURES;
    if (part == 6) return false;
    if (part >= 3) return ends_at_corner(s, dim, s->corner[3 * e + part - 3]);
    return elements_at(s, s->corner[3 * e + part], s->corner[3 * e + (part + 1) % 3]) == 1;
}

/* The corners v and w of a feature that is no inside; w = v at a corner, and in the plane */
static void ends_of(const struct surface *s, int dim, int32_t feature, int32_t *v, int32_t *w)
{
    int32_t e = feature / SURFACE_FEATURES, part = feature % SURFACE_FEATURES;
    *v = s->corner[3 * e + (part < 3 ? part : part - 3)];
    *w = part < 3 && dim == 3 ? s->corner[3 * e + (part + 1) % 3] : *v;
}

bool surface_bends(const struct surface *s, int dim, int32_t feature)
{
    int32_t v, w;
    if (feature % SURFACE_FEATURES == 6) return false;
    ends_of(s, dim, feature, &v, &w);
    vec3 n = surface_normal(s, feature / SURFACE_FEATURES);
    for (int32_t i = s->star[v]; i < s->star[v + 1]; i++) {
        int32_t e = s->member[i];
        if (has_corner(s, e, w) && v3_norm(v3_cross(n, surface_normal(s, e))) > FLAT) return true;
    }
    return false;
}

/* Does another element at the corners v and w rise above the plane through x across n? */
static bool another_rises(const struct surface *s, int32_t v, int32_t w, vec3 x, vec3 n)
{
    for (int32_t i = s->star[v]; i < s->star[v + 1]; i++) {
        if (!has_corner(s, s->member[i], w)) continue;
        for (int k = 0; k < 3; k++) {
            vec3 d = v3_sub(s->at[s->member[i]][k], x);
            if (v3_dot(d, n) > FLAT * v3_norm(d)) return true;
        }
    }
    return false;
}

void surface_groove(struct grooves *out, const struct surface *s, int dim, const struct touch *t,
                    vec3 c, vec3 middle)
{
    int32_t v, w;
    const int first = out->n;
    ends_of(s, dim, t->feature, &v, &w);
    for (int32_t i = s->star[v]; i < s->star[v + 1] && out->n < TOUCHES_MOST; i++) {
        int32_t e = s->member[i];
        vec3 x = v3_axpy(c, -t->distance, t->n), up = surface_normal(s, e);
        bool again = (i > s->star[v] && s->member[i - 1] == e) || !has_corner(s, e, w);
        if (v3_dot(up, v3_sub(middle, x)) < 0) up = v3_scale(-1, up);
        for (int k = first; k < out->n; k++)
            again |= v3_norm(v3_cross(out->touch[k].n, up)) <= FLAT;
        if (again || !another_rises(s, v, w, x, up)) continue;
        out->touch[out->n++] =
            (struct touch){ up, v3_dot(up, v3_sub(c, x)), SURFACE_FEATURES * e + 6 };
    }
}

bool wall_ends_at(const struct wall *w, int dim, const struct surface *surface, vec3 c,
                  const struct touch *t)
{
    const double tiny = 1e-9;
    if (surface) return surface_ends(surface, dim, t->feature);
    if (w->shape == WALL_RECTANGLE || w->shape == WALL_DISC)
        return v3_norm(v3_cross(t->n, w->n)) > tiny;
    bool round = w->shape == WALL_CYLINDER || w->shape == WALL_CONE;
    if (!round) return false;
    // at its end the way to the place is not across the surface: it leads along it
    vec3 place = v3_axpy(c, -t->distance, t->n);
    vec3 radius = wall_edge_unit(v3_axpy(place, -v3_dot(place, w->n), w->n));
    double end = w->shape == WALL_CONE ? w->size[1] : w->size[0];
    vec3 line = wall_edge_unit(v3_axpy(v3_scale(end - w->size[0], radius), w->size[2], w->n));
    return fabs(v3_dot(t->n, v3_cross(w->n, radius))) > tiny || fabs(v3_dot(t->n, line)) > tiny;
}

/* Twice the area of the triangle a, b, c of the plane; above 0: counterclockwise */
static double wall_edge_turn(vec3 a, vec3 b, vec3 c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/* Six times the volume of the tetrahedron */
static double wall_edge_volume(vec3 a, vec3 b, vec3 c, vec3 d)
{
    return v3_dot(v3_sub(b, a), v3_cross(v3_sub(c, a), v3_sub(d, a)));
}

static bool opposite(double x, double y)
{
    return (x <= 0 && y >= 0) || (x >= 0 && y <= 0);
}

static bool crosses_segment(const vec3 x[2], vec3 a, vec3 b)
{
    return opposite(wall_edge_turn(x[0], x[1], a), wall_edge_turn(x[0], x[1], b)) &&
           opposite(wall_edge_turn(a, b, x[0]), wall_edge_turn(a, b, x[1]));
}

static bool crosses_triangle(const vec3 x[3], vec3 a, vec3 b)
{
    if (!opposite(wall_edge_volume(x[0], x[1], x[2], a), wall_edge_volume(x[0], x[1], x[2], b)))
        return false;
    double u = wall_edge_volume(a, b, x[0], x[1]), v = wall_edge_volume(a, b, x[1], x[2]),
           w = wall_edge_volume(a, b, x[2], x[0]);
    return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}

static bool in_surface(const struct surface *s, int dim, vec3 a, vec3 b)
{
    struct surface_walk walk;
    struct surface_branch leaf;
    vec3 middle = v3_scale(0.5, v3_add(a, b));
    double reach = 0.5 * v3_norm(v3_sub(b, a));
    surface_walk_begin(&walk, s->n);
    while (surface_walk_next(&walk, s->box, middle, reach, &leaf))
        for (int32_t i = leaf.lo; i < leaf.hi; i++) {
            const vec3 *x = s->at[s->order[i]];
            if (dim == 2 ? crosses_segment(x, a, b) : crosses_triangle(x, a, b)) return true;
        }
    return false;
}

bool wall_between(const struct wall *w, int dim, const struct surface *surface, vec3 a, vec3 b)
{
    if (surface) return in_surface(surface, dim, a, b);
    bool rectangle = w->shape == WALL_RECTANGLE;
    if (!rectangle && w->shape != WALL_DISC) return true;
    double ha = v3_dot(a, w->n), hb = v3_dot(b, w->n);
    if (!opposite(ha, hb)) return false;
    vec3 x = ha != hb ? v3_axpy(a, ha / (ha - hb), v3_sub(b, a)) : b;
    double along = fabs(v3_dot(x, w->along)),
           across = dim == 2 ? 0 : fabs(v3_dot(x, v3_cross(w->n, w->along))), rho = v3_norm(x);
    return rectangle ? along <= w->size[0] / 2 && (dim == 2 || across <= w->size[1] / 2)
                     : rho >= w->size[0] && rho <= w->size[1];
}
