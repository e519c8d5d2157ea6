/* measure/sizes.c: where large and small bodies are. */
#include "measure/ball_part.h"
#include "measure/branch.h"
#include "measure/measures.h"

#include <math.h>

static const struct quantity quantities[] = {
    { "from", "m", 1, "lower end of the layer, or inner radius of the shell" },
    { "to", "m", 1, "upper end, or outer radius" },
    { "bodies", "1", 1, "number of movable bodies with their centre in the layer" },
    { "radius", "m", 1, "mean radius" },
    { "least", "m", 1, "smallest radius" },
    { "most", "m", 1, "largest radius" },
    { "large", "1", 1, "fraction of their volume in bodies larger than the mean of all" },
    { 0 },
};

/* m: of all that move, in the region */
static double sizes_mean_radius(const struct snapshot *s)
{
    double sum = 0, n = 0;
    for (int64_t i = 0; i < s->p->n; i++)
        if (counts_body(s, i)) sum += s->p->radius[i], n++;
    return n > 0 ? sum / n : NAN;
}

static void sizes_add_layer(struct table *t, const struct snapshot *s, const struct region *layer,
                            double *at, const void *with)
{
    double n = 0, sum = 0, least = INFINITY, most = 0, volume = 0, large = 0,
           mean = *(const double *)with;
    for (int64_t i = 0; i < s->p->n; i++) {
        double r = s->p->radius[i], v = grain_volume(s->p, i);
        if (!(s->p->mass[i] > 0) || !snapshot_body(s, i) || !region_holds(layer, s->p->x[i]))
            continue;
        n++, sum += r, least = fmin(least, r), most = fmax(most, r);
        volume += v, large += r > mean ? v : 0;
    }
    put(&at, n);
    if (n > 0)
        put(&at, sum / n), put(&at, least), put(&at, most), put(&at, large / volume);
    else
        table_null(t, "layers without bodies have no sizes");
}

static int sizes_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    const double mean = sizes_mean_radius(s);
    return snapshot_layers(s, t, sizes_add_layer, &mean, failure);
}

const struct measure measure_sizes = {
    .name = "sizes",
    .help = "sizes of bodies by layer",
    .quantity = quantities,
    .keeps_to = KEEPS_TO_BODIES,
    .list = true,
    .rows = sizes_rows,
};

/* ---- one number for it ---- */

static const struct quantity one[] = {
    { "correlation", "1", 1, "correlation of radius and height, -1 to 1" },
    { "large", "m", 1, "mean height of bodies larger than the mean" },
    { "small", "m", 1, "mean height of the others" },
    { "index", "1", 1, "(large - small) over its value for complete segregation, -1 to 1" },
    { 0 },
};

/* m: along up, or the asked axis */
static double sizes_height(const struct snapshot *s, int axis, int64_t i)
{
    const vec3 x = s->p->x[i], d = v3_sub(x, s->asked->point);
    return axis == 3 ? hypot(d.x, d.y) : axis == 0 ? x.x : axis == 1 ? x.y : x.z;
}

struct moments {
    double n, r, h, rr, hh, rh;  /* sums about the means */
    double large, small, nl, ns; /* of heights; bodies */
};

static void sizes_moments_of(struct moments *m, const struct snapshot *s, int axis)
{
    double r = 0, h = 0, n = 0;
    *m = (struct moments){ 0 };
    for (int64_t i = 0; i < s->p->n; i++)
        if (counts_body(s, i)) r += s->p->radius[i], h += sizes_height(s, axis, i), n++;
    if (!(n > 0)) return;
    m->n = n, m->r = r / n, m->h = h / n;
    for (int64_t i = 0; i < s->p->n; i++) {
        if (!counts_body(s, i)) continue;
        double dr = s->p->radius[i] - m->r, y = sizes_height(s, axis, i), dh = y - m->h;
        m->rr += dr * dr, m->hh += dh * dh, m->rh += dr * dh;
        if (dr > 1e-12 * m->r)
            m->large += y, m->nl++;
        else
            m->small += y, m->ns++;
    }
}

static int segregation_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    struct moments m;
    double *at = table_row(t, failure);
    if (!at) return failure->status;
    if (snapshot_axis(s) >= s->p->dim && snapshot_axis(s) < 3) {
        table_null(t, "in the plane there are no heights along z");
        return 0;
    }
    sizes_moments_of(&m, s, snapshot_axis(s));
    if (!(m.nl > 0)) {
        table_null(t, m.n > 0 ? "all bodies have the same size"
                              : "no body that moves is in the region");
        return 0;
    }
    // fully apart and spread evenly over a height H, the two means are H/2 apart; H^2/12 is the variance
    double large = m.large / m.nl, small = m.small / m.ns, spread = sqrt(3 * m.hh / m.n);
    if (!(m.hh > 0)) table_null(t, "all bodies are at the same height");
    put(&at, m.hh > 0 ? m.rh / sqrt(m.rr * m.hh) : NAN);
    put(&at, large), put(&at, small), put(&at, m.hh > 0 ? (large - small) / spread : NAN);
    return 0;
}

const struct measure measure_segregation = {
    .name = "segregation",
    .help = "vertical segregation by size",
    .quantity = one,
    .keeps_to = KEEPS_TO_BODIES,
    .rows = segregation_rows,
};
