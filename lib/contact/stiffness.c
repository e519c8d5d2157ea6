/* contact/stiffness.c: a stiffness out of the loads and speeds of a packing [contact/stiffness.h]. */
#include "contact/stiffness.h"

#include "contact/spring.h"
#include "state/freedom.h"
#include "state/kinematics.h"

#define DENSE 0.64
#define LOOSE 0.55 /* share of space of a packing through which nothing falls any more */

/* What bodies and walls say of loads and speeds */
struct stiffness_extent {
    vec3 low, high;           /* m: of all bodies */
    double small, large;      /* m: radii */
    double mass, volume;      /* kg, m^3 or m^2: of all that move */
    double heaviest, fastest; /* kg, m/s */
};

static double stiffness_volume(const struct packing *p, int64_t i)
{
    const double r = p->radius[i];
    return p->dim == 2 ? M_PI * r * r : 4.0 / 3 * M_PI * r * r * r;
}

static struct stiffness_extent extent_of(const struct packing *p)
{
    struct stiffness_extent e = { .low = v3(INFINITY, INFINITY, INFINITY), .small = INFINITY };
    e.high = v3_scale(-1, e.low);
    for (int64_t i = 0; i < p->n; i++) {
        const vec3 x = p->x[i], r = v3(p->radius[i], p->radius[i], p->radius[i]);
        const vec3 low = v3_sub(x, r), high = v3_add(x, r);
        e.low = v3(fmin(e.low.x, low.x), fmin(e.low.y, low.y), fmin(e.low.z, low.z));
        e.high = v3(fmax(e.high.x, high.x), fmax(e.high.y, high.y), fmax(e.high.z, high.z));
        e.small = fmin(e.small, r.x), e.large = fmax(e.large, r.x);
        e.fastest = fmax(e.fastest, v3_norm(p->v[i]) + r.x * v3_norm(p->w[i]));
        if (!(p->mass[i] > 0)) continue;
        e.mass += p->mass[i], e.volume += stiffness_volume(p, i);
        e.heaviest = fmax(e.heaviest, p->mass[i]);
    }
    for (int32_t w = 0; w < p->walls; w++) {
        const struct wall *wall = &p->wall[w];
        e.fastest = fmax(e.fastest, wall_top_speed(p, wall) + v3_norm(wall->belt));
    }
    return e;
}

/* m: by which the highest body is above the lowest place that it may fall to: of bodies, floors and other walls */
static double height_of(const struct packing *p, double down)
{
    double most = down;
    const vec3 up = v3_scale(-1 / v3_norm(p->g), p->g);
    for (int32_t k = 0; k < p->walls; k++) {
        const struct wall *w = &p->wall[k];
        const bool plane = w->shape == BOUNDARY_PLANE;
        const double steep = v3_dot(w->n, up);
        if (plane && !(steep > 0.1)) continue; // no floor
        for (int64_t i = 0; i < p->n; i++) {
            const vec3 d = v3_sub(p->x[i], w->x);
            most = fmax(most, plane ? v3_dot(d, w->n) / steep : v3_dot(d, up));
        }
    }
    return most;
}

/* N: the largest of what loads and stresses push */
static int stiffness_load(double *most, const struct packing *p, struct failure *failure)
{
    struct freedoms list;
    *most = 0;
    if (!freedoms_in(p)) return 0;
    if (freedoms_init(&list, p, p->cell.edge, false, failure)) return failure->status;
    for (int32_t k = 0; k < list.n; k++)
        if (!list.f[k].turns) *most = fmax(*most, fabs(list.f[k].force));
    freedoms_free(&list);
    return 0;
}

int stiffness_needed(double *k, const struct packing *p, struct failure *failure)
{
    const struct stiffness_extent e = extent_of(p);
    double load;
    *k = 0;
    if (stiffness_load(&load, p, failure)) return failure->status;
    const double g = v3_norm(p->g), cross = p->dim == 2 ? 2 * e.large : 4 * e.large * e.large;
    const vec3 size = v3_sub(e.high, e.low);
    const double x = size.x, y = size.y, z = size.z;
    const double down = g > 0 ? fabs(v3_dot(size, p->g)) / g : 0; // of a box along its edges
    const double face = p->dim == 2 ? fmin(x, y) : fmin(x * y, fmin(y * z, z * x));
    double F = e.heaviest * g;
    if (e.volume > 0) F = fmax(F, DENSE * e.mass / e.volume * g * down * cross);
    if (face > 0) F = fmax(F, load * fmin(1, cross / face));
    const double all =
        p->dim == 2 ? x * y : x * y * z; // what bodies settle to, and how far they fall to it
    const double settled = all > 0 ? e.volume / LOOSE / (all / down) : 0;
    const double fall = g > 0 ? fmax(0, height_of(p, down) - settled) : 0;
    const double v = fmax(e.fastest, sqrt(2 * g * fall)), reach = STIFFNESS_IMPACT * e.small;
    if (e.mass > 0)
        *k = fmax(F / (STIFFNESS_STATIC * e.small), e.heaviest * v * v / (reach * reach));
    if (*k > 0 && isfinite(*k)) return 0;
    return failure_set(
        failure, EX_DATAERR,
        "nothing moves or is loaded, by which a stiffness could be chosen: give it in N/m");
}

int stiffness_set(struct packing *p, double k, struct failure *failure)
{
    const int32_t pairs = p->kinds * p->kinds;
    if (!p->law && !(k > 0)) return 0;
    if (!p->law && packing_alloc_laws(p, failure)) return failure->status;
    for (int32_t i = 0; i < pairs; i++)
        if (k > 0 && pair_law_adheres(&p->law[i]))
            return failure_set(failure, EX_DATAERR,
                               "%s and %s adhere: such contacts have no stiffness",
                               p->kind_name[i / p->kinds], p->kind_name[i % p->kinds]);
    for (int32_t i = 0; i < pairs; i++) p->law[i].kn = k, p->law[i].kt = SPRING_ACROSS * k;
    for (int64_t i = 0; !(k > 0) && i < p->bonds.n; i++)
        p->bonds.bond[i].pressed = 0, p->bonds.bond[i].rest = 0;
    return 0;
}

void stiffness_range(const struct packing *p, double k[2])
{
    k[0] = k[1] = 0;
    for (int32_t i = 0; p->law && i < p->kinds * p->kinds; i++) {
        const double kn = p->law[i].kn;
        k[0] = i ? fmin(k[0], kn) : kn, k[1] = fmax(k[1], kn);
    }
}

double stiffness_softness(const struct packing *p)
{
    double k[2];
    stiffness_range(p, k);
    return k[1] > 0 ? packing_mean_mass(p) / (2 * k[1] * p->dt * p->dt) : 0;
}
