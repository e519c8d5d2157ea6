/* scene/thin.c: points sorted by the cells of a grid, and thinned out in that order [scene/thin.h]. */
#include "scene/thin.h"

#include <stdlib.h>

struct celled {
    int64_t cell[3];
    int32_t point;
};

static int by_cell(const void *one, const void *other)
{
    const struct celled *a = one, *b = other;
    for (int k = 0; k < 3; k++)
        if (a->cell[k] != b->cell[k]) return a->cell[k] < b->cell[k] ? -1 : 1;
    return (a->point > b->point) - (a->point < b->point);
}

/* The first of c[n], which are sorted, that is not before `wanted` */
static int64_t hull_find(const struct celled *c, int64_t n, const struct celled *wanted)
{
    int64_t lo = 0;
    for (int64_t hi = n; lo < hi;) {
        int64_t middle = lo + (hi - lo) / 2;
        if (by_cell(&c[middle], wanted) < 0)
            lo = middle + 1;
        else
            hi = middle;
    }
    return lo;
}

/* One of c[n], those that stay so far, within `apart` of a point; -1: none. A cell has eight of them at most. */
static int32_t find_near(const struct celled *c, int64_t n, struct celled at, const vec3 *x,
                         double apart)
{
    for (int row = 0; row < 9; row++) {
        const int64_t i = at.cell[0] + row / 3 - 1, j = at.cell[1] + row % 3 - 1, k = at.cell[2];
        const struct celled lo = { { i, j, k - 1 }, -1 }, hi = { { i, j, k + 2 }, -1 };
        for (int64_t m = hull_find(c, n, &lo); m < n && by_cell(&c[m], &hi) < 0; m++)
            if (v3_norm(v3_sub(x[c[m].point], x[at.point])) <= apart) return c[m].point;
    }
    return -1;
}

double thin_extent(const vec3 *x, int64_t n)
{
    double extent = 0;
    for (int64_t i = 0; i < n; i++) extent = fmax(extent, v3_norm(v3_sub(x[i], x[0])));
    return extent;
}

int thin_out(int32_t *to, const vec3 *x, int64_t n, double apart, struct failure *failure)
{
    struct celled *c = malloc(((size_t)n + 1) * sizeof *c);
    int64_t stay = 0;
    if (!c) return failure_set(failure, EX_SOFTWARE, "no memory for a hull");
    for (int32_t i = 0; i < n; i++) {
        vec3 d = v3_scale(1 / apart, v3_sub(x[i], x[0]));
        c[i] =
            (struct celled){ { (int64_t)floor(d.x), (int64_t)floor(d.y), (int64_t)floor(d.z) }, i };
    }
    qsort(c, (size_t)n, sizeof *c, by_cell);
    for (int64_t i = 0; i < n; i++) {
        int32_t point = c[i].point, near = find_near(c, stay, c[i], x, apart);
        to[point] = near < 0 ? point : near;
        if (near < 0) c[stay++] = c[i];
    }
    free(c);
    return 0;
}
