/* scene/stiffness.c: a stiffness out of the loads and speeds of a packing [scene/stiffness.h]. */
#include "scene/stiffness.h"

#include "base/text.h"
#include "contact/spring.h"
#include "scene/inlet.h"
#include "scene/time_step.h"

#include <string.h>

#define DENSE 0.64

/* What there is and what will come */
struct stiffness_bodies {
    double large, heaviest,
        density;      /* m, kg, kg/m^3 or kg/m^2: the largest, the heaviest, of the solid */
    double low, high; /* m: along gravity */
};

static double stiffness_volume(int dim, double r)
{
    return dim == 2 ? M_PI * r * r : 4.0 / 3 * M_PI * r * r * r;
}

static struct stiffness_bodies bodies_of(const struct packing *p, const struct scene *s, vec3 up)
{
    struct stiffness_bodies b = { .low = INFINITY, .high = -INFINITY };
    double mass = 0, volume = 0;
    for (int64_t i = 0; i < p->n; i++) {
        const double r = p->radius[i], height = v3_dot(up, p->x[i]);
        b.large = fmax(b.large, r);
        b.low = fmin(b.low, height - r), b.high = fmax(b.high, height + r);
        if (!(p->mass[i] > 0)) continue;
        b.heaviest = fmax(b.heaviest, p->mass[i]);
        mass += p->mass[i], volume += stiffness_volume(p->dim, r);
    }
    if (volume > 0) b.density = mass / volume;
    for (int32_t k = 0; k < s->pours; k++) {
        const struct scene_pour *pour = &s->pour[k];
        const double of = stiffness_volume(p->dim, pour->size.max);
        const double m = pour->mass > 0 ? pour->mass : pour->density * of;
        b.large = fmax(b.large, pour->size.max), b.heaviest = fmax(b.heaviest, m);
        b.density = fmax(b.density, m / of);
    }
    return b;
}

int stiffness_needed(double *k, const struct packing *p, struct failure *failure)
{
    struct flow flow;
    struct time_step t;
    *k = 0;
    if (flow_read(&flow, p, failure)) return failure->status;
    const double g = v3_norm(p->g);
    const vec3 up = g > 0 ? v3_scale(-1 / g, p->g) : v3(0, 0, 0);
    time_step_of(&t, &flow.scene, p);
    const struct stiffness_bodies b = bodies_of(p, &flow.scene, up);
    flow_free(&flow);
    double v = 0;
    for (int i = LIMIT_SPEED; i <= LIMIT_WALL; i++) v = fmax(v, t.x[i]);
    const double fall = t.x[LIMIT_FALL], cross = p->dim == 2 ? 2 * b.large : 4 * b.large * b.large;
    const double height = fmax(b.high - b.low, g > 0 ? fall * fall / (2 * g) : 0);
    double F = fmax(b.heaviest * g, cross * t.pressure);
    if (g > 0) F = fmax(F, DENSE * b.density * g * height * cross);
    const double reach = STIFFNESS_IMPACT * t.radius;
    if (isfinite(t.radius))
        *k = fmax(F / (STIFFNESS_STATIC * t.radius), b.heaviest * v * v / (reach * reach));
    if (*k > 0 && isfinite(*k)) return 0;
    return failure_set(
        failure, EX_DATAERR,
        "nothing moves or is loaded, by which a stiffness could be chosen: give it in N/m");
}

int stiffness_read(double *k, const char *text, const struct packing *p, struct failure *failure)
{
    char *end;
    *k = 0;
    if (!strcmp(text, "rigid")) return 0;
    if (!strcmp(text, "auto")) return stiffness_needed(k, p, failure);
    *k = number_read(text, &end);
    if (end != text && !*end && *k > 0 && isfinite(*k)) return 0;
    return failure_set(failure, EX_USAGE,
                       "'%.60s' is neither a number above 0 (N/m) nor rigid nor auto", text);
}

int stiffness_set(struct packing *p, double k, struct failure *failure)
{
    const int32_t pairs = p->materials * p->materials;
    if (!p->law && !(k > 0)) return 0;
    if (!p->law && packing_alloc_laws(p, failure)) return failure->status;
    for (int32_t i = 0; i < pairs; i++)
        if (k > 0 && pair_law_adheres(&p->law[i]))
            return failure_set(
                failure, EX_DATAERR, "%s and %s adhere: such contacts have no stiffness",
                p->material_name[i / p->materials], p->material_name[i % p->materials]);
    for (int32_t i = 0; i < pairs; i++) p->law[i].kn = k, p->law[i].kt = SPRING_ACROSS * k;
    for (int64_t i = 0; !(k > 0) && i < p->bonds.n; i++)
        p->bonds.bond[i].pressed = 0, p->bonds.bond[i].rest = 0;
    return 0;
}

void stiffness_range(const struct packing *p, double k[2])
{
    k[0] = k[1] = 0;
    for (int32_t i = 0; p->law && i < p->materials * p->materials; i++) {
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
