#include "draw/ray.h"

/* The part of the line that is in something, and the normal where it comes out */
struct interval {
    double lo, hi;
    vec3 n;
};

static struct interval all_of_it(void)
{
    return (struct interval){ -INFINITY, INFINITY, { 0, 0, 0 } };
}

/* What is left of it where n . x <= at */
static void ray_cut(struct interval *k, const struct ray *l, vec3 n, double at)
{
    double slope = v3_dot(n, l->along), rest = at - v3_dot(n, l->from);
    if (slope > 1e-12) {
        if (rest / slope < k->hi) k->hi = rest / slope, k->n = n;
    } else if (slope < -1e-12) {
        k->lo = fmax(k->lo, rest / slope);
    } else if (rest < 0) {
        k->lo = INFINITY, k->hi = -INFINITY;
    }
}

static struct interval ray_in_ball(const struct ray *l, vec3 c, double r)
{
    vec3 d = v3_sub(c, l->from);
    double middle = v3_dot(d, l->along), h2 = r * r - v3_dot(d, d) + middle * middle;
    if (!(h2 > 0)) return (struct interval){ INFINITY, -INFINITY, { 0, 0, 0 } };
    double h = sqrt(h2);
    vec3 x = v3_sub(v3_axpy(l->from, middle + h, l->along), c);
    return (struct interval){ middle - h, middle + h, v3_scale(1 / r, x) };
}

/* In the cylinder around a segment, without round ends */
static struct interval ray_in_tube(const struct ray *l, vec3 a, vec3 b, double r)
{
    vec3 d = v3_sub(b, a), u = v3_scale(1 / v3_norm(d), d), o = v3_sub(l->from, a);
    vec3 p = v3_axpy(l->along, -v3_dot(l->along, u), u), q = v3_axpy(o, -v3_dot(o, u), u);
    double A = v3_dot(p, p), B = v3_dot(p, q), C = v3_dot(q, q) - r * r, D = B * B - A * C;
    if (A < 1e-12 || !(D > 0)) return (struct interval){ INFINITY, -INFINITY, { 0, 0, 0 } };
    struct interval k = { (-B - sqrt(D)) / A, (-B + sqrt(D)) / A, { 0, 0, 0 } };
    k.n = v3_scale(1 / r, v3_axpy(q, k.hi, p));
    ray_cut(&k, l, u, v3_dot(u, b)), ray_cut(&k, l, v3_scale(-1, u), -v3_dot(u, a));
    return k;
}

static struct interval in_core(const struct shape *s, const struct ray *l)
{
    struct interval k = all_of_it();
    for (int32_t f = 0; f < s->faces; f++)
        ray_cut(&k, l, s->normal[f], v3_dot(s->normal[f], s->vertex[s->corner[s->first[f]]]));
    return k;
}

static struct interval ray_over_face(const struct shape *s, const struct ray *l, int32_t f)
{
    struct interval k = all_of_it();
    vec3 n = s->normal[f];
    double at = v3_dot(n, s->vertex[s->corner[s->first[f]]]);
    for (int32_t i = s->first[f], end = s->first[f + 1]; i < end; i++) {
        vec3 a = s->vertex[s->corner[i]],
             b = s->vertex[s->corner[i + 1 < end ? i + 1 : s->first[f]]];
        vec3 out = v3_cross(v3_sub(b, a), n);
        ray_cut(&k, l, out, v3_dot(out, a));
    }
    ray_cut(&k, l, v3_scale(-1, n), -at), ray_cut(&k, l, n, at + s->round);
    return k;
}

/* The one that is nearest to the viewer, once what is cut away is */
static void ray_take(struct interval *best, struct interval k, const struct ray *l)
{
    if (!(k.lo < k.hi) || k.lo >= l->before) return;
    if (k.hi > l->before) k.hi = l->before, k.n = v3(0, 0, 0);
    if (k.hi > best->hi) *best = k;
}

bool ray_meets(const struct shape *s, const struct ray *l, double *t, vec3 *n)
{
    struct interval best = { INFINITY, -INFINITY, { 0, 0, 0 } };
    bool hull = shape_has_faces(s);
    if (hull) ray_take(&best, in_core(s, l), l);
    for (int32_t i = 0; i < s->vertices && shape_round(s, i) > 0; i++)
        ray_take(&best, ray_in_ball(l, s->vertex[i], shape_round(s, i)), l);
    for (int32_t k = 0; k < s->edges && hull && s->round > 0; k++)
        ray_take(&best,
                 ray_in_tube(l, s->vertex[s->edge[k].tail], s->vertex[s->edge[k].head], s->round),
                 l);
    for (int32_t f = 0; f < s->faces && hull && s->round > 0; f++)
        ray_take(&best, ray_over_face(s, l, f), l);
    for (int32_t k = 0; k < shape_parts(s) && !hull; k++) {
        const struct shape_part part = shape_part(s, k);
        const vec3 *v = s->vertex + part.first;
        if (part.n == 2) ray_take(&best, ray_in_tube(l, v[0], v[1], part.round), l);
    }
    *t = best.hi, *n = best.n;
    return best.lo < best.hi;
}

static double to_segment(vec3 x, vec3 a, vec3 b)
{
    vec3 d = v3_sub(b, a), o = v3_sub(x, a);
    double t = fmin(fmax(v3_dot(o, d) / v3_dot(d, d), 0), 1);
    return v3_norm(v3_axpy(o, -t, d));
}

double ray_depth(const struct shape *s, vec3 x)
{
    double depth = -INFINITY, inside = INFINITY, near = INFINITY;
    for (int32_t k = 0; k < shape_parts(s) && !shape_has_faces(s); k++) {
        const struct shape_part part = shape_part(s, k);
        const vec3 *v = s->vertex + part.first;
        double far = part.n == 1 ? v3_norm(v3_sub(x, v[0])) : to_segment(x, v[0], v[1]);
        depth = fmax(depth, part.round - far);
    }
    if (!shape_has_faces(s)) return depth;
    for (int32_t k = 0; k < s->edges; k++) {
        vec3 a = s->vertex[s->edge[k].tail], b = s->vertex[s->edge[k].head];
        inside = fmin(inside, v3_dot(s->normal[k], v3_sub(a, x)));
        near = fmin(near, to_segment(x, a, b));
    }
    return s->round + (inside > 0 ? inside : -near);
}
