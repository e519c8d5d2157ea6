/* problem/two_thread_split.c: the cut and the zones [problem/two_thread_split.h]. */
#include "problem/two_thread_split.h"

#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>

enum {
    SAMPLE = 16384 /* contacts that decide where to cut, at most */
};

static double coordinate(const struct packing *p, int32_t body, int axis)
{
    vec3 x = p->x[body];
    return axis == 0 ? x.x : axis == 1 ? x.y : x.z;
}

/* From where to where contact c's movable bodies are along the axis, by their centres */
static void extent(const struct packing *p, const struct contact *c, int axis, double *lo,
                   double *hi)
{
    int32_t body[2];
    int k = packing_movable(p, c->a, c->b, body);
    *lo = INFINITY, *hi = -INFINITY;
    for (int j = 0; j < k; j++) {
        double x = coordinate(p, body[j], axis);
        *lo = dmin(*lo, x), *hi = dmax(*hi, x);
    }
}

/*
 * Chooses the axis and the place of the cut: half of the contacts are below, and as few as possible
 * across. Of many contacts a sample decides; top[SAMPLE] is work space.
 */
static void choose_cut(const struct packing *p, const struct contacts *s, double *top, int *axis,
                       double *at)
{
    int64_t stride = (s->n + SAMPLE - 1) / SAMPLE, least = s->n;
    for (int k = 0; k < p->dim; k++) {
        double lo, hi;
        int64_t n = 0, across = 0;
        for (int64_t c = 0; c < s->n; c += stride) extent(p, &s->c[c], k, &lo, &top[n++]);
        double middle = gsl_stats_select(top, 1, (size_t)n, (size_t)n / 2);
        for (int64_t c = 0; c < s->n; c += stride) {
            extent(p, &s->c[c], k, &lo, &hi);
            across += lo < middle && hi >= middle;
        }
        if (across < least) least = across, *axis = k, *at = middle;
    }
}

int two_thread_split_divide(const struct contacts *s, const struct packing *p, int8_t *zone)
{
    double *top = malloc(SAMPLE * sizeof *top), lo, hi, at = 0;
    bool *shared = calloc((size_t)p->n + 1, sizeof *shared), room = top && shared;
    int axis = 0;
    int32_t body[2];
    if (room) choose_cut(p, s, top, &axis, &at);
    for (int64_t c = 0; room && c < s->n; c++) {
        const struct contact *t = &s->c[c];
        extent(p, t, axis, &lo, &hi);
        zone[c] = hi < at ? ZONE_INSIDE : lo < at ? ZONE_BORDER : ZONE_BEYOND;
        for (int k = packing_movable(p, t->a, t->b, body); zone[c] == ZONE_BORDER && k > 0; k--)
            shared[body[k - 1]] = true;
    }
    for (int64_t c = 0; room && c < s->n; c++) {
        const struct contact *t = &s->c[c];
        for (int k = packing_movable(p, t->a, t->b, body); zone[c] == ZONE_INSIDE && k > 0; k--)
            if (shared[body[k - 1]]) zone[c] = ZONE_RIM;
    }
    free(top), free(shared);
    return room ? 0 : -1;
}
