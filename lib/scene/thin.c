/* scene/thin.c: points sorted by the cells of a grid, and thinned out in that order [scene/thin.h]. */
#include "scene/thin.h"

#include <stdbool.h>
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
static int64_t find(const struct celled *c, int64_t n, const struct celled *wanted)
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

/* Is one of c[n], those that are kept so far, within `apart` of a point? A cell has eight of them at most. */
static bool is_near(const struct celled *c, int64_t n, struct celled at, const vec3 *x,
                    double apart)
{
    for (int row = 0; row < 9; row++) {
        const int64_t i = at.cell[0] + row / 3 - 1, j = at.cell[1] + row % 3 - 1, k = at.cell[2];
        const struct celled lo = { { i, j, k - 1 }, -1 }, hi = { { i, j, k + 2 }, -1 };
        for (int64_t m = find(c, n, &lo); m < n && by_cell(&c[m], &hi) < 0; m++)
            if (v3_norm(v3_sub(x[c[m].point], x[at.point])) <= apart) return true;
    }
    return false;
}

static int by_number(const void *a, const void *b)
{
    int32_t i = *(const int32_t *)a, j = *(const int32_t *)b;
    return (i > j) - (i < j);
}

int thin_out(int32_t *kept, int64_t *n_kept, const vec3 *x, int64_t n, double apart,
             struct why *why)
{
    struct celled *c = malloc(((size_t)n + 1) * sizeof *c);
    int64_t m = 0;
    if (!c) return why_set(why, EX_SOFTWARE, "no memory for a hull");
    for (int32_t i = 0; i < n; i++) {
        vec3 d = v3_scale(1 / apart, v3_sub(x[i], x[0]));
        c[i] =
            (struct celled){ { (int64_t)floor(d.x), (int64_t)floor(d.y), (int64_t)floor(d.z) }, i };
    }
    qsort(c, (size_t)n, sizeof *c, by_cell);
    for (int64_t i = 0; i < n; i++)
        if (!is_near(c, m, c[i], x, apart)) c[m++] = c[i];
    for (int64_t i = 0; i < m; i++) kept[i] = c[i].point;
    qsort(kept, (size_t)m, sizeof *kept, by_number);
    free(c);
    *n_kept = m;
    return 0;
}
