/* solve/two_thread_split.c: the cut and the zones [solve/two_thread_split.h]. */
#include "solve/two_thread_split.h"

#include "base/team.h"

#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>

enum {
    SAMPLE = 16384,            /* contacts that decide where to cut, at most */
    SPLIT_CONTACTS_PER_THREAD = 8192 /* the fewest contacts that are worth a thread */
};

struct division {
    int64_t n;
    int32_t (*body)[2];
    const struct packing *p;
    int8_t *zone;
    int axis;     /* of the cut */
    double at;    /* m */
    bool *shared; /* [p->n] the body has a contact in the border zone */
};

static double coordinate(const struct packing *p, int32_t body, int axis)
{
    vec3 x = p->x[body];
    return axis == 0 ? x.x : axis == 1 ? x.y : x.z;
}

/* From where to where contact c's movable bodies are along the axis, by their centres */
static void schedule_extent(const struct division *y, int64_t c, int axis, double *lo, double *hi)
{
    *lo = INFINITY, *hi = -INFINITY;
    for (int j = 0; j < 2 && y->body[c][j] >= 0; j++) {
        double x = coordinate(y->p, y->body[c][j], axis);
        *lo = dmin(*lo, x), *hi = dmax(*hi, x);
    }
}

/*
 * Chooses the axis and the place of the cut: half of the contacts are below, and as few as possible
 * across. Of many contacts a sample decides; top[SAMPLE] is work space.
 */
static void choose_cut(struct division *y, double *top)
{
    int64_t stride = (y->n + SAMPLE - 1) / SAMPLE, least = y->n;
    for (int k = 0; k < y->p->dim; k++) {
        double lo, hi;
        int64_t n = 0, across = 0;
        for (int64_t c = 0; c < y->n; c += stride) schedule_extent(y, c, k, &lo, &top[n++]);
        double middle = gsl_stats_select(top, 1, (size_t)n, (size_t)n / 2);
        for (int64_t c = 0; c < y->n; c += stride) {
            schedule_extent(y, c, k, &lo, &hi);
            across += lo < middle && hi >= middle;
        }
        if (across < least) least = across, y->axis = k, y->at = middle;
    }
}

static void cut_some(void *arg, int64_t first, int64_t end)
{
    struct division *y = arg;
    double lo, hi;
    for (int64_t c = first; c < end; c++) {
        schedule_extent(y, c, y->axis, &lo, &hi);
        y->zone[c] = hi < y->at ? ZONE_INSIDE : lo < y->at ? ZONE_BORDER : ZONE_BEYOND;
    }
}

static void find_rim(void *arg, int64_t first, int64_t end)
{
    struct division *y = arg;
    for (int64_t c = first; c < end; c++)
        for (int k = 0; k < 2 && y->zone[c] == ZONE_INSIDE && y->body[c][k] >= 0; k++)
            if (y->shared[y->body[c][k]]) y->zone[c] = ZONE_RIM;
}

int two_thread_split_divide(int64_t n, int32_t (*body)[2], const struct packing *p, int8_t *zone)
{
    double *top = malloc(SAMPLE * sizeof *top);
    struct division y = { n, body, p, zone, 0, 0, calloc((size_t)p->n + 1, sizeof *y.shared) };
    bool room = top && y.shared;
    if (room) {
        choose_cut(&y, top);
        team_share(team_size(), n, SPLIT_CONTACTS_PER_THREAD, cut_some, &y);
        for (int64_t c = 0; c < n; c++)
            for (int k = 0; k < 2 && zone[c] == ZONE_BORDER && body[c][k] >= 0; k++)
                y.shared[body[c][k]] = true;
        team_share(team_size(), n, SPLIT_CONTACTS_PER_THREAD, find_rim, &y);
    }
    free(top), free(y.shared);
    return room ? 0 : -1;
}
