#include "measure/inside.h"

#include "measure/ball_part.h"
#include "measure/region.h"

#include <math.h>
#include <stdlib.h>

enum { BED = 100 }; /* bodies: fewer are no bed */
/* Of the solid volume: beyond the surface. In mean diameters: from there, from walls, and the least width */
static const double BEYOND = 0.1, FROM_SURFACE = 1, FROM_WALLS = 2, WIDTH = 2;

struct piece {
    double x, volume; /* m; m^3, of discs m^2 */
};

static int inside_by_place(const void *a, const void *b)
{
    const struct piece *x = a, *y = b;
    return (x->x > y->x) - (x->x < y->x);
}

static double inside_along(vec3 x, int axis)
{
    return axis == 0 ? x.x : axis == 1 ? x.y : x.z;
}

/* m: below and above which a tenth of the volume lies; n pieces, sorted in place */
static void tenths(struct piece *s, const struct packing *p, int axis, double *lo, double *hi)
{
    double all = 0, below = 0;
    for (int64_t i = 0; i < p->n; i++)
        s[i] = (struct piece){ inside_along(p->x[i], axis), grain_volume(p, i) },
        all += s[i].volume;
    qsort(s, (size_t)p->n, sizeof *s, inside_by_place);
    *lo = *hi = s[0].x;
    for (int64_t i = 0; i < p->n; i++) {
        if (below < BEYOND * all) *lo = s[i].x;
        if (below < (1 - BEYOND) * all) *hi = s[i].x;
        below += s[i].volume;
    }
}

static double inside_mean_diameter(const struct packing *p)
{
    double sum = 0;
    for (int64_t i = 0; i < p->n; i++) sum += p->radius[i];
    return 2 * sum / (double)p->n;
}

int region_inside(struct region *r, const struct packing *p, struct failure *failure)
{
    double lo[3] = { 0 }, hi[3] = { 0 };
    bool open = false;
    if (p->n < BED || r->period.any) return 1;
    struct piece *s = malloc((size_t)p->n * sizeof *s);
    if (!s) return failure_set(failure, EX_SOFTWARE, "no memory for the inside of the bed");
    const double d = inside_mean_diameter(p);
    for (int k = 0; k < p->dim; k++) {
        double below = -INFINITY, above = INFINITY;
        reach_of_planes(p, k, &below, &above);
        tenths(s, p, k, &lo[k], &hi[k]);
        open = open || isinf(below) || isinf(above);
        lo[k] = isinf(below) ? lo[k] + FROM_SURFACE * d : below + FROM_WALLS * d;
        hi[k] = isinf(above) ? hi[k] - FROM_SURFACE * d : above - FROM_WALLS * d;
    }
    free(s);
    for (int k = 0; k < p->dim; k++)
        if (!(hi[k] - lo[k] >= WIDTH * d)) return 1;
    if (!open) return 1;
    region_box(r, p, lo, hi);
    return 0;
}
