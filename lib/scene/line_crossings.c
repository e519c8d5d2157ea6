#include "scene/line_crossings.h"

#include "base/array.h"

#include <stdlib.h>

enum { CROSSINGS_MOST = 1 << 25, LINES = 128 /* of crossings_judge, along the longest side */ };

static const double WRONG_MOST =
    1e-3;                            /* of the volume: mass and moments are then as good as that */
static const double ROUNDING = 1e-6; /* of the extent: solids that touch overlap by this */

/* Shares of h by which lines pass beside what surfaces have at round numbers */
static const double ASIDE[3] = { 0.4142135623730951, 0.7320508075688772, 0.2360679774997898 };

static int line_crossings_add(struct crossings *t, struct tunnelling c, struct failure *failure)
{
    if (t->n == CROSSINGS_MOST)
        return failure_set(failure, EX_DATAERR, "has too many triangles above one another");
    if (!array_grow(&t->c, &t->room, t->n + 1, sizeof *t->c))
        return failure_set(failure, EX_SOFTWARE, "no memory for a surface");
    t->c[t->n++] = c;
    return 0;
}

int crossing_of(const vec3 v[3], double y, double z, double *x)
{
    const vec3 n = v3_cross(v3_sub(v[1], v[0]), v3_sub(v[2], v[0]));
    if (n.x == 0) return 0;
    for (int e = 0; e < 3; e++) {
        // each side from its lower end, so that both of its triangles find the same
        vec3 a = v[e], b = v[(e + 1) % 3];
        const bool back = a.y > b.y || (a.y == b.y && a.z > b.z);
        if (back) a = v[(e + 1) % 3], b = v[e];
        const bool left = (b.y - a.y) * (z - a.z) - (b.z - a.z) * (y - a.y) > 0;
        if ((left != back) != (n.x > 0)) return 0;
    }
    *x = v[0].x - (n.y * (y - v[0].y) + n.z * (z - v[0].z)) / n.x;
    return n.x > 0 ? 1 : -1;
}

/* The axes in the order from `axis` on */
static vec3 turned(vec3 x, int axis)
{
    return axis == 0 ? x : axis == 1 ? v3(x.y, x.z, x.x) : v3(x.z, x.x, x.y);
}

static void line_crossings_span(double from, double h, int n, double a, double b, int *lo, int *hi)
{
    *lo = (int)fmax(0, fmin(n, ceil((a - from) / h)));
    *hi = (int)fmax(-1, fmin(n - 1, floor((b - from) / h)));
}

/* Where the triangle is along y at this z; a hair more */
static void line_crossings_cut(const vec3 v[3], double z, double hair, double *from, double *to)
{
    *from = INFINITY, *to = -INFINITY;
    for (int e = 0; e < 3; e++) {
        const vec3 a = v[e], b = v[(e + 1) % 3];
        if ((a.z < z && b.z < z) || (a.z > z && b.z > z)) continue;
        const double share = a.z == b.z ? 0 : (z - a.z) / (b.z - a.z);
        const double y = a.y + share * (b.y - a.y);
        *from = fmin(*from, y - hair),
        *to = fmax(*to, y + hair); // of a level side the others have the end
    }
}

static int line_crossings_cross(struct crossings *t, const struct lines *l, const vec3 v[3],
                                struct failure *failure)
{
    int j0, j1, k0, k1;
    const vec3 lo = v3_min(v[0], v3_min(v[1], v[2])), hi = v3_max(v[0], v3_max(v[1], v[2]));
    line_crossings_span(l->origin.z, l->h, l->n[1], lo.z, hi.z, &k0, &k1);
    for (int k = k0; k <= k1; k++) {
        double from, to; // row by row: the box around a thin triangle has many lines that miss it
        line_crossings_cut(v, l->origin.z + k * l->h, 1e-6 * l->h, &from, &to);
        line_crossings_span(l->origin.y, l->h, l->n[0], fmax(from, lo.y), fmin(to, hi.y), &j0, &j1);
        for (int j = j0; j <= j1; j++) {
            struct tunnelling c = { k * l->n[0] + j, 0, 0 };
            c.way = crossing_of(v, l->origin.y + j * l->h, l->origin.z + k * l->h, &c.x);
            if (c.way && line_crossings_add(t, c, failure)) return failure->status;
        }
    }
    return 0;
}

static int line_crossings_by_place(const void *one, const void *other)
{
    const struct tunnelling *a = one, *b = other;
    if (a->line != b->line) return a->line < b->line ? -1 : 1;
    if (a->x != b->x) return a->x < b->x ? -1 : 1;
    return a->way - b->way;
}

int crossings_find(struct crossings *t, const struct mesh *m, const struct lines *l,
                   struct failure *failure)
{
    *t = (struct crossings){ 0 };
    for (int32_t e = 0; e < m->elements && !failure->status; e++) {
        vec3 v[3];
        for (int k = 0; k < 3; k++) v[k] = turned(m->vertex[m->element[e][k]], l->axis);
        line_crossings_cross(t, l, v, failure);
    }
    if (!failure->status && t->n) qsort(t->c, (size_t)t->n, sizeof *t->c, line_crossings_by_place);
    return failure->status;
}

void crossings_free(struct crossings *t)
{
    free(t->c);
    *t = (struct crossings){ 0 };
}

/* ---- winding numbers ---- */

/* Lengths (m) along lines that have the body around them, at all, too often, or inside out; and where that is worst */
struct windings {
    double body, twice, inside_out, worst;
    vec3 place; /* m */
};

static void line_crossings_add_line(struct windings *w, const struct lines *l,
                                    const struct tunnelling *c, int64_t n, double rounding)
{
    int winding = 0;
    for (int64_t i = 0; i + 1 < n; i++) {
        const double length = c[i + 1].x - c[i].x;
        winding -= c[i].way;
        if (length < rounding) continue;
        if (winding > 0) w->body += length;
        if (winding > 1) w->twice += length;
        if (winding < 0) w->inside_out += length;
        if (winding >= 0 && winding <= 1) continue;
        if (length <= w->worst) continue;
        const int j = c[i].line % l->n[0], k = c[i].line / l->n[0];
        w->worst = length;
        w->place =
            turned(v3(0.5 * (c[i].x + c[i + 1].x), l->origin.y + j * l->h, l->origin.z + k * l->h),
                   (3 - l->axis) % 3);
    }
}

static int line_crossings_judge(const struct windings *w, struct failure *failure)
{
    const vec3 x = w->place;
    if (w->inside_out > WRONG_MOST * (w->body + w->inside_out))
        return failure_set(
            failure, EX_DATAERR,
            "is turned inside out in parts, as around (%.4g, %.4g, %.4g): turn their "
            "faces outward",
            x.x, x.y, x.z);
    if (w->twice > WRONG_MOST * w->body)
        return failure_set(
            failure, EX_DATAERR,
            "overlaps or encloses itself, as around (%.4g, %.4g, %.4g): %.2g of its "
            "volume counts twice; unite its solids, and turn the faces of cavities inward",
            x.x, x.y, x.z, w->twice / w->body);
    return 0;
}

int crossings_judge(const struct mesh *m, struct failure *failure)
{
    vec3 lo, hi;
    mesh_box(m, &lo, &hi);
    const vec3 d = v3_sub(hi, lo);
    const double extent = fmax(d.x, fmax(d.y, d.z));
    for (int axis = 0; axis < 3 && !failure->status; axis++) {
        const vec3 sides = turned(d, axis), from = turned(lo, axis);
        struct lines l = { .axis = axis, .h = extent / LINES };
        struct crossings t = { 0 };
        struct windings w = { 0 };
        l.n[0] = (int)(sides.y / l.h) + 1, l.n[1] = (int)(sides.z / l.h) + 1;
        l.origin = v3(0, from.y + ASIDE[1] * l.h, from.z + ASIDE[2] * l.h);
        crossings_find(&t, m, &l, failure);
        for (int64_t i = 0, end; i < t.n && !failure->status; i = end) {
            for (end = i; end < t.n && t.c[end].line == t.c[i].line;) end++;
            line_crossings_add_line(&w, &l, t.c + i, end - i, ROUNDING * extent);
        }
        crossings_free(&t);
        if (!failure->status) line_crossings_judge(&w, failure);
    }
    return failure->status;
}
