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

/* Of the packing of a scene; *radius (m): the smallest, of bodies that inlets bring too */
static int stiffness_of(double *k, double *radius, const struct packing *p, const struct scene *s,
                        struct failure *failure)
{
    struct time_step t;
    *k = 0;
    const double g = v3_norm(p->g);
    const vec3 up = g > 0 ? v3_scale(-1 / g, p->g) : v3(0, 0, 0);
    time_step_of(&t, s, p);
    *radius = t.radius;
    const struct stiffness_bodies b = bodies_of(p, s, up);
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

int stiffness_needed(double *k, const struct packing *p, struct failure *failure)
{
    struct flow flow;
    double radius;
    *k = 0;
    if (flow_read(&flow, p, failure)) return failure->status;
    stiffness_of(k, &radius, p, &flow.scene, failure);
    flow_free(&flow);
    return failure->status;
}

/* N/m: of a bar with the cross-section and the length of a grain, in the plane for each metre of thickness */
static double stiffness_of_bar(int dim, double young, double radius)
{
    return dim == 2 ? young : M_PI_4 * young * 2 * radius;
}

void stiffness_expect(struct packing *p, const struct scene *s)
{
    for (int32_t i = 0; p->law && i < p->materials * p->materials; i++)
        if (stiffness_given(&s->law[i]) && !(p->law[i].kn > 0)) p->law[i].kn = p->law[i].kt = 1;
}

int stiffness_build(struct packing *p, const struct scene *s, struct failure *failure)
{
    struct failure why = { 0 };
    double needed = 0, radius = INFINITY;
    bool any = false;
    const int32_t pairs = p->materials * p->materials;
    for (int32_t i = 0; i < pairs; i++) any = any || s->law[i].softest || s->law[i].young > 0;
    if (any) stiffness_of(&needed, &radius, p, s, &why);
    for (int32_t i = 0; p->law && i < pairs; i++) {
        const struct scene_law *l = &s->law[i];
        if (l->softest && why.status)
            return failure_set(failure, why.status, "stiffness: auto: %s", why.text);
        if (p->dim == 3 && l->young > 0 && !isfinite(radius))
            return failure_set(failure, EX_DATAERR,
                               "stiffness: young: no body has a diameter: give a stiffness in N/m");
        if (l->softest) p->law[i].kn = needed;
        if (l->young > 0) p->law[i].kn = stiffness_of_bar(p->dim, l->young, radius);
        p->law[i].kt = l->tangential > 0 ? l->tangential : SPRING_ACROSS * p->law[i].kn;
    }
    return 0;
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
    for (int32_t i = 0; i < pairs; i++) p->law[i].kn = k, p->law[i].kt = SPRING_ACROSS * k;
    for (int64_t i = 0; !(k > 0) && i < p->bonds.n; i++)
        p->bonds.bond[i].pressed = 0, p->bonds.bond[i].rest = 0,
        p->bonds.bond[i].turn = v3(0, 0, 0);
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
