/* contact/neighbours.c: how long a list of near pairs serves [contact/neighbours.h]. */
#include "contact/neighbours.h"

#include "base/team.h"
#include "contact/seek.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

enum {
    KEEP_STEPS = 8, /* steps that a list is meant to serve, all at the speed of the fastest body; */
    KEEP_LEAST = 3, /* no list is kept that would serve fewer */
    PER_THREAD = 16384 /* bodies whose ways are worth a thread: 100 us */
};
/* What a list may reach further than was asked, in mean radii: */
static const double MIN_SPARE = 0.02, /* when (nearly) nothing moves */
    MAX_SPARE = 0.5;                  /* beyond it a list would be crowded: it serves one step */

static void surfaces_free(struct neighbours *s)
{
    for (int32_t w = 0; w < s->surfaces; w++) surface_free(&s->surface[w]);
    free(s->surface);
    s->surface = NULL, s->surfaces = 0;
}

void neighbours_free(struct neighbours *s)
{
    surfaces_free(s);
    free(s->listed), free(s->list.pair), free(s->image);
    *s = (struct neighbours){ 0 };
}

/* 1 - |F - 1| <= |F d| / |d| for all d: how much a deformation F, of columns f, may shorten */
static double least_stretch(const vec3 f[3])
{
    const vec3 one[3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        vec3 d = v3_sub(f[k], one[k]);
        sum += v3_dot(d, d);
    }
    return 1 - sqrt(sum);
}

static double largest_radius(const struct packing *p)
{
    double most = 0;
    for (int64_t i = 0; i < p->n; i++) most = dmax(most, p->radius[i]);
    return most;
}

/* F x, of columns f */
static vec3 deform(const vec3 f[3], vec3 x)
{
    return v3_axpy(v3_axpy(v3_scale(x.x, f[0]), x.y, f[1]), x.z, f[2]);
}

/*
 * The same where the cell repeats and may have moved. Since the list was made the edges have been
 * deformed by F, and a pair at p_0 is now at F p_0 plus what its bodies have moved beyond F; bodies
 * that have been wrapped count as if they had not.
 */
static bool list_serves_cell(const struct neighbours *s, const struct packing *p, const vec3 *x,
                             const vec3 edge[3], double gap)
{
    if (!s->listed || !s->image) return false;
    const vec3 *inverse = s->inverse, o = p->cell.origin;
    vec3 f[3];
    for (int k = 0; k < 3; k++) {
        vec3 e = v3(k == 0, k == 1, k == 2);
        f[k] =
            deform(edge, v3(v3_dot(inverse[0], e), v3_dot(inverse[1], e), v3_dot(inverse[2], e)));
    }
    double stretch = fmin(least_stretch(f), 1), wide = 2 * largest_radius(p);
    double most = 0.49 * (stretch * s->list.reach - gap - (1 - stretch) * wide);
    if (!(most >= 0)) return false;
    for (int64_t i = 0; i < s->list.bodies; i++) {
        vec3 d = v3_sub(v3_sub(x[i], o), deform(f, v3_sub(s->listed[i], o)));
        for (int k = 0; k < 3; k++)
            if (p->image[i][k] != s->image[i][k])
                d = v3_axpy(d, (double)p->image[i][k] - s->image[i][k], edge[k]);
        if (!(v3_dot(d, d) <= most * most)) return false;
    }
    return true;
}

/* The ways of bodies since a list was made */
struct ways {
    const struct neighbours *s;
    const vec3 *x;
    vec3 common;          /* m: a way that all have gone, which brings no two nearer */
    double most;          /* m: that each may have gone beyond it */
    pthread_mutex_t lock; /* of what follows */
    vec3 lo, hi;          /* m: the box of all ways */
    bool far;             /* some body has gone further */
};

static void look_at_ways(void *arg, int64_t first, int64_t end)
{
    struct ways *o = arg;
    vec3 lo = v3(INFINITY, INFINITY, INFINITY), hi = v3_scale(-1, lo);
    bool far = false;
    for (int64_t i = first; i < end; i++) {
        vec3 d = v3_sub(o->x[i], o->s->listed[i]), beyond = v3_sub(d, o->common);
        lo = v3_min(lo, d), hi = v3_max(hi, d);
        far |= !(v3_dot(beyond, beyond) <= o->most * o->most);
    }
    pthread_mutex_lock(&o->lock);
    o->lo = v3_min(o->lo, lo), o->hi = v3_max(o->hi, hi);
    if (far) o->far = true;
    pthread_mutex_unlock(&o->lock);
}

/* Has the list still every pair with at most this gap (m)? Yes if no body has moved by half of what
   the list reaches further; what all bodies move, as those that fall, does not count. */
static bool list_serves(const struct neighbours *s, const struct packing *p, const vec3 *x,
                        const vec3 edge[3], double gap)
{
    if (cell_repeats(&p->cell)) return list_serves_cell(s, p, x, edge, gap);
    struct ways o = { .s = s,
                      .x = x,
                      .most = 0.49 * (s->list.reach - gap), // not 0.5: a margin for rounding
                      .lock = PTHREAD_MUTEX_INITIALIZER,
                      .lo = v3(INFINITY, INFINITY, INFINITY),
                      .hi = v3(-INFINITY, -INFINITY, -INFINITY) };
    if (!s->listed || o.most < 0) return false;
    team_share(team_size(), s->list.bodies, PER_THREAD, look_at_ways, &o);
    if (!o.far) return true;
    o.common = v3_scale(0.5, v3_add(o.lo, o.hi)), o.far = false;
    if (!(v3_norm(v3_sub(o.hi, o.lo)) <= 4 * o.most)) return false;
    team_share(team_size(), s->list.bodies, PER_THREAD, look_at_ways, &o);
    return !o.far;
}

/* m/s: the fastest body beyond a velocity that all share: by how much two bodies may differ at most, and
   half of it */
static double fastest_of_all(const struct packing *p)
{
    vec3 lo = v3(INFINITY, INFINITY, INFINITY), hi = v3_scale(-1, lo);
    double v2 = 0, beyond2 = 0;
    for (int64_t i = 0; i < p->n; i++) {
        v2 = dmax(v2, v3_dot(p->v[i], p->v[i]));
        lo = v3_min(lo, p->v[i]), hi = v3_max(hi, p->v[i]);
    }
    vec3 common = v3_scale(0.5, v3_add(lo, hi));
    for (int64_t i = 0; i < p->n; i++) {
        vec3 d = v3_sub(p->v[i], common);
        beyond2 = dmax(beyond2, v3_dot(d, d));
    }
    return sqrt(fmin(v2, beyond2));
}

/* The same, where the cell repeats beyond the flow that its edges make */
static double neighbours_fastest(const struct packing *p)
{
    double v2 = 0;
    if (!cell_repeats(&p->cell)) return fastest_of_all(p);
    vec3 inverse[3], mean = v3(0, 0, 0);
    cell_inverse(p->cell.edge, inverse);
    for (int pass = 0; pass < 2; pass++)
        for (int64_t i = 0; i < p->n; i++) {
            vec3 v = p->v[i], d = v3_sub(p->x[i], p->cell.origin);
            for (int k = 0; k < 3; k++) v = v3_axpy(v, -v3_dot(inverse[k], d), p->cell.rate[k]);
            if (pass == 0) mean = v3_axpy(mean, 1 / (double)p->n, v);
            v = v3_sub(v, mean);
            if (pass == 1) v2 = dmax(v2, v3_dot(v, v));
        }
    return sqrt(v2);
}

/* m: what a list shall reach further. Twice the way of KEEP_STEPS steps: both bodies may move. */
static double spare_reach(const struct packing *p)
{
    double r = 0;
    for (int64_t i = 0; i < p->n; i++) r += p->radius[i];
    r /= (double)(p->n ? p->n : 1);
    double way = neighbours_fastest(p);
    for (int k = 0; cell_repeats(&p->cell) && k < 3; k++) // what the edges' motion takes from it
        way += v3_norm(p->cell.rate[k]) / v3_norm(p->cell.edge[k]) * largest_radius(p);
    double step = 2 * p->dt * way, s = fmax(KEEP_STEPS * step, MIN_SPARE * r);
    if (s <= MAX_SPARE * r) return s;
    return KEEP_LEAST * step <= MAX_SPARE * r ? MAX_SPARE * r : 0;
}

/* Where the list is made: images and edges, for the steps that it is to serve */
static int note_images(struct neighbours *s, const struct packing *p, const vec3 edge[3],
                       struct failure *failure)
{
    size_t size = (size_t)p->n * sizeof *s->image;
    int32_t(*image)[3] = realloc(s->image, size + sizeof *image);
    if (!image) return failure_set(failure, EX_SOFTWARE, "no memory for the neighbours");
    s->image = image;
    memcpy(image, p->image, size);
    cell_inverse(edge, s->inverse);
    return 0;
}

void neighbours_shift(const struct neighbours *s, const struct packing *p, const struct pair *pair,
                      int8_t shift[3])
{
    for (int k = 0; k < 3; k++) {
        shift[k] = pair->shift[k];
        if (!s->image) continue;
        int64_t b = (int64_t)p->image[pair->b][k] - s->image[pair->b][k];
        int64_t a = (int64_t)p->image[pair->a][k] - s->image[pair->a][k];
        shift[k] = (int8_t)(shift[k] + b - a);
    }
}

int neighbours_find(struct neighbours *s, const struct packing *p, const struct positions *at,
                    double gap, bool keep, struct failure *failure)
{
    const vec3 *x = at->x, *edge = at->edge;
    size_t size = (size_t)p->n * sizeof *x;
    bool images = cell_repeats(&p->cell);
    if (images) {
        struct cell now = { .origin = p->cell.origin };
        for (int k = 0; k < 3; k++) now.edge[k] = edge[k], now.repeats[k] = p->cell.repeats[k];
        const double thick = 2 * largest_radius(p);
        if (cell_check(&now, p->dim, thick + gap, failure)) return failure->status;
        if (thick > s->thick && packing_check_walls(p, thick, failure)) return failure->status;
        s->thick = fmax(s->thick, thick);
    }
    if (s->list.bodies == p->n && list_serves(s, p, x, edge, gap)) return 0;
    vec3 *listed = keep ? realloc(s->listed, size + sizeof *x) : s->listed;
    if (keep && !listed) return failure_set(failure, EX_SOFTWARE, "no memory for the neighbours");
    s->listed = listed, s->list.bodies = p->n, s->list.reach = gap + (keep ? spare_reach(p) : 0);
    if (seek_pairs(&s->list, p, x, edge, failure)) {
        s->list.bodies = 0; // such a list serves nobody
        return failure->status;
    }
    if (keep && p->n) memcpy(s->listed, x, size);
    return keep && images ? note_images(s, p, edge, failure) : 0;
}

int neighbours_surfaces(struct neighbours *s, const struct packing *p, struct failure *failure)
{
    if (!p->mesh.elements || s->surfaces == p->walls) return 0;
    surfaces_free(s);
    s->surface = calloc((size_t)p->walls + 1, sizeof *s->surface);
    if (!s->surface)
        return failure_set(failure, EX_SOFTWARE, "no memory for the surfaces of meshes");
    s->surfaces = p->walls;
    for (int32_t w = 0; w < p->walls; w++) {
        const struct wall *wall = &p->wall[w];
        if (wall->shape == WALL_MESH && surface_init(&s->surface[w], &p->mesh, wall->first_element,
                                                     wall->elements, wall->weld, failure))
            return failure->status;
    }
    return 0;
}
