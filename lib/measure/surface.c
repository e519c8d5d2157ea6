/*
 * measure/surface.c: the angle of the free surface. The plane across gravity is divided into squares
 * as wide as three mean radii; of each the highest body counts. Through these a plane is laid, and a
 * cone around the axis of their mean, both by least squares.
 */
#include "measure/branch.h"
#include "measure/measures.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct quantity quantities[] = {
    { "columns", "1", 1, "number of squares that contain a body" },
    { "angle", "deg", 1, "angle of the plane through the highest bodies to the horizontal" },
    { "downhill", "1", 3, "horizontal direction in which the plane descends" },
    { "spread", "m", 1, "standard deviation of the highest bodies from the plane" },
    { "cone", "deg", 1, "angle of a cone through the highest bodies at 20 to 80 % of the height" },
    { "apex", "m", 3, "position of the highest body" },
    { 0 },
};

/* A point of the surface: across gravity and up (m) */
struct rotation {
    double a, b, h;
    int64_t i;
};

struct basis {
    vec3 up, a, b;
};

static struct basis basis_of(const struct packing *p)
{
    struct basis e = { v3_scale(-1 / v3_norm(p->g), p->g), { 0, 0, 0 }, { 0, 0, 0 } };
    struct contact c;
    contact_basis(&c, p->dim, e.up);
    e.a = c.t1, e.b = contact_t2(&c);
    return e;
}

static int by_square(const void *x, const void *y)
{
    const struct rotation *one = x, *other = y;
    if (one->a != other->a) return one->a < other->a ? -1 : 1;
    if (one->b != other->b) return one->b < other->b ? -1 : 1;
    if (one->h != other->h) return one->h > other->h ? -1 : 1;
    return one->i < other->i ? -1 : one->i > other->i;
}

/* top[] = the highest body of each square; returns how many. Where contacts are known only bodies that
   touch something count: what flies is not the surface. -1 when memory is short. */
static int64_t tops(struct rotation *top, const struct snapshot *s, const struct basis *e)
{
    const struct packing *p = s->p;
    int32_t *count = s->s ? counts_of(s) : NULL;
    double width = 0;
    int64_t n = 0, kept = 0;
    if (s->s && !count) return -1;
    for (int64_t i = 0; i < p->n; i++) width += 3 * p->radius[i] / (double)p->n;
    for (int64_t i = 0; i < p->n; i++) {
        if (!counts_body(s, i) || (count && !count[i])) continue;
        vec3 x = p->x[i];
        top[n++] =
            (struct rotation){ floor(v3_dot(x, e->a) / width), floor(v3_dot(x, e->b) / width),
                               v3_dot(x, e->up) + p->radius[i], i };
    }
    qsort(top, (size_t)n, sizeof *top, by_square);
    for (int64_t k = 0; k < n; k++)
        if (!k || top[k].a != top[k - 1].a || top[k].b != top[k - 1].b) top[kept++] = top[k];
    for (int64_t k = 0; k < kept; k++) {
        vec3 x = p->x[top[k].i];
        top[k].a = v3_dot(x, e->a), top[k].b = p->dim == 2 ? 0 : v3_dot(x, e->b);
    }
    free(count);
    return kept;
}

struct surface_mean {
    double a, b, h;
};

static struct surface_mean mean_of(const struct rotation *top, int64_t n)
{
    struct surface_mean m = { 0, 0, 0 };
    for (int64_t k = 0; k < n; k++)
        m.a += top[k].a / (double)n, m.b += top[k].b / (double)n, m.h += top[k].h / (double)n;
    return m;
}

/* h = mean + slope[0] a + slope[1] b; false: the points do not say */
static bool plane(const struct rotation *top, int64_t n, int dim, double slope[2], double *spread)
{
    struct surface_mean m = mean_of(top, n);
    double aa = 0, ab = 0, bb = 0, ah = 0, bh = 0, sum = 0;
    for (int64_t k = 0; k < n; k++) {
        double a = top[k].a - m.a, b = top[k].b - m.b, h = top[k].h - m.h;
        aa += a * a, ab += a * b, bb += b * b, ah += a * h, bh += b * h;
    }
    double det = dim == 2 ? aa : aa * bb - ab * ab;
    if (!(det > 1e-9 * (dim == 2 ? aa : aa * bb)) || n < dim) return false;
    slope[0] = dim == 2 ? ah / aa : (ah * bb - bh * ab) / det;
    slope[1] = dim == 2 ? 0 : (bh * aa - ah * ab) / det;
    for (int64_t k = 0; k < n; k++) {
        double d = top[k].h - m.h - slope[0] * (top[k].a - m.a) - slope[1] * (top[k].b - m.b);
        sum += d * d / (double)n;
    }
    *spread = sqrt(sum);
    return true;
}

/* Of the least squares' variance about a plane: a cone is one about which the flanks scatter less than this. A bed
   or a drum's slope scatters about the best cone as about a plane, or more. */
static const double NEARER_TO_CONE = 0.5;

/* How much the surface falls with the distance from its axis; NaN: the points do not say, or lie on a plane, h =
   mean + slope . (a, b), as well as on a cone */
static double flank(const struct rotation *top, int64_t n, const double slope[2])
{
    struct surface_mean m = mean_of(top, n);
    double least = INFINITY, most = -INFINITY, count = 0, r = 0, h = 0, rr = 0, rh = 0;
    double off_plane = 0, off_cone = 0;
    for (int64_t k = 0; k < n; k++) least = fmin(least, top[k].h), most = fmax(most, top[k].h);
    double from = least + 0.2 * (most - least), to = least + 0.8 * (most - least);
    for (int pass = 0; pass < 3; pass++)
        for (int64_t k = 0; k < n; k++) {
            double a = top[k].a - m.a, b = top[k].b - m.b, d = hypot(a, b);
            if (!(top[k].h >= from && top[k].h <= to)) continue;
            double e = top[k].h - m.h - slope[0] * a - slope[1] * b;
            double c = top[k].h - h / count - rh / rr * (d - r / count); // in the last pass
            if (pass == 0)
                count++, r += d, h += top[k].h;
            else if (pass == 1)
                rr += (d - r / count) * (d - r / count),
                    rh += (d - r / count) * (top[k].h - h / count);
            else
                off_plane += e * e, off_cone += c * c;
        }
    bool cone = count > 2 && rr > 0 && off_cone < NEARER_TO_CONE * off_plane;
    return cone ? -rh / rr : NAN;
}

static double degrees(double slope)
{
    return 180 / M_PI * atan(slope);
}

static void surface_fill(double *at, struct table *t, const struct snapshot *s,
                         const struct basis *e, const struct rotation *top, int64_t n)
{
    double slope[2], spread, steep;
    int64_t apex = 0;
    put(&at, (double)n);
    if (!plane(top, n, s->p->dim, slope, &spread)) {
        table_null(t, "too few bodies for a surface");
        return;
    }
    steep = hypot(slope[0], slope[1]);
    vec3 down = v3_axpy(v3_scale(-slope[0], e->a), -slope[1], e->b);
    put(&at, degrees(steep));
    if (steep > 0)
        put_vec(&at, v3_scale(1 / steep, down));
    else
        at += 3, table_null(t, "a level surface falls nowhere");
    put(&at, spread);
    double cone = flank(top, n, slope);
    if (!isfinite(cone)) table_null(t, "no cone: the surface is as near to a plane");
    put(&at, degrees(cone));
    for (int64_t k = 1; k < n; k++)
        if (top[k].h > top[apex].h) apex = k;
    put_vec(&at, v3_axpy(s->p->x[top[apex].i], s->p->radius[top[apex].i], e->up));
}

static int surface_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    double *at = table_row(t, failure);
    if (!at) return failure->status;
    if (!(v3_norm(s->p->g) > 0)) {
        table_null(t, "without gravity no side is up");
        return 0;
    }
    struct basis e = basis_of(s->p);
    struct rotation *top = malloc(((size_t)s->p->n + 1) * sizeof *top);
    int64_t n = top ? tops(top, s, &e) : -1;
    if (n < 0)
        failure_set(failure, EX_SOFTWARE, "no memory for the surface");
    else
        surface_fill(at, t, s, &e, top, n);
    free(top);
    return failure->status;
}

const struct measure measure_surface = {
    .name = "surface",
    .help = "angle of the free surface",
    .quantity = quantities,
    .rows = surface_rows,
};
