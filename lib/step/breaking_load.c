#include "step/breaking_load.h"

#include "state/breakable.h"
#include "state/placement.h"
#include "step/balance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What a step does to a body */
struct breaking_body {
    const struct breakage *how; /* NULL: it does not break */
    double d;                   /* m: its diameter */
    double strength, scale;     /* 0: not yet asked for */
    double force;               /* N: the largest of a neighbour */
    double stress[3][3];        /* N m: - sum of arm x force, the stress times the volume */
};

static void ask_strength(struct breaking_body *b, const struct packing *p, int64_t i)
{
    if (b->strength > 0) return;
    b->strength = breakage_strength(p, i, b->d, &b->scale);
}

/* An impact of this energy per mass, J/kg */
static void breaking_hit(struct packing *p, struct breaking_body *b, int64_t i, double energy)
{
    const struct breakage *how = b->how;
    double *damage = &p->damage[i];
    ask_strength(b, p, i);
    const double load = (energy - how->least * b->scale) / b->strength;
    if (!(load > 0) || *damage >= 1) return;
    if (how->damage == DAMAGE_NONE) *damage = fmax(*damage, load);
    if (how->damage == DAMAGE_LINEAR) *damage += load;
    if (how->damage == DAMAGE_TAVARES) *damage = breakage_tavares(*damage, load, how->gamma);
    *damage = fmin(*damage, 1);
}

/* m/s: of b against a at a contact, at the beginning of the step */
static vec3 breaking_approach(const struct packing *p, const struct breaking_start *was,
                              const struct contact *c)
{
    const vec3 shift = cell_shift(p->cell.edge, c->shift);
    const vec3 xb = v3_add(p->x[c->b], shift);
    vec3 u = v3_add(was->v[c->b], v3_cross(was->w[c->b], v3_sub(c->x, xb)));
    u = v3_add(u, cell_shift(p->cell.rate, c->shift));
    if (c->a < 0) return v3_sub(u, wall_velocity(p, &p->wall[-1 - c->a], c->x));
    const vec3 arm = v3_sub(c->x, p->x[c->a]);
    return v3_sub(u, v3_add(was->v[c->a], v3_cross(was->w[c->a], arm)));
}

/* J: of the impact of a pair with the contacts from..to */
static double impact_energy(const struct packing *p, const struct contacts *s,
                            const struct breaking_start *was, int64_t from, int64_t to)
{
    double work = 0;
    for (int64_t k = from; was->v && k < to; k++)
        work -=
            v3_dot(contact_in_space(&s->c[k], s->found[k].r), breaking_approach(p, was, &s->c[k]));
    return work / (2 * (1 + s->c[from].en));
}

/* Body i of the contacts from..to of a pair, whose reactions sum to r; side: -1 of a, 1 of b; energy: J, its part */
static void add_pair(struct packing *p, struct breaking_body *b, const struct contacts *s,
                     int64_t from, int64_t to, int64_t i, int side, double energy)
{
    vec3 sum = v3(0, 0, 0);
    if (!b->how) return;
    for (int64_t k = from; k < to; k++) {
        const struct contact *c = &s->c[k];
        const vec3 f = v3_scale(side / p->dt, contact_in_space(c, s->found[k].r));
        const vec3 at = side > 0 ? v3_sub(c->x, cell_shift(p->cell.edge, c->shift)) : c->x;
        sum = v3_add(sum, f);
        if (b->how->by == BREAKAGE_STRESS || b->how->by == BREAKAGE_SHEAR)
            v3_outer(b->stress, -1, v3_sub(at, p->x[i]), f);
    }
    b->force = fmax(b->force, v3_norm(sum));
    if (b->how->by == BREAKAGE_ENERGY && energy > 0) breaking_hit(p, b, i, energy / p->mass[i]);
}

/* Pa: the mean of the stress, or its octahedral shear stress */
static double breaking_stress(const struct packing *p, const struct breaking_body *b)
{
    const double volume = p->dim == 2 ? M_PI / 4 * b->d * b->d : M_PI / 6 * b->d * b->d * b->d;
    double mean = 0, square = 0;
    for (int k = 0; k < p->dim; k++) mean += b->stress[k][k] / p->dim;
    if (b->how->by == BREAKAGE_STRESS) return mean / volume;
    for (int k = 0; k < 9; k++) {
        const int x = k / 3, y = k % 3;
        if (x >= p->dim || y >= p->dim) continue;
        const double s = 0.5 * (b->stress[x][y] + b->stress[y][x]) - (x == y ? mean : 0);
        square += s * s;
    }
    return sqrt(square / p->dim) / volume;
}

static void breaking_end(struct packing *p, struct breaking_body *b, int64_t i)
{
    if (!b->how || b->how->by == BREAKAGE_ENERGY || !(b->force > 0)) return;
    const double load = b->how->by == BREAKAGE_FORCE ? b->force / (p->dim == 2 ? b->d : b->d * b->d)
                                                     : breaking_stress(p, b);
    if (!(load > 0)) return;
    ask_strength(b, p, i);
    p->damage[i] = fmin(fmax(p->damage[i], load / b->strength), 1);
}

int breaking_start(struct breaking_start *start, struct packing *p, struct failure *failure)
{
    bool asks = false;
    *start = (struct breaking_start){ 0 };
    for (int32_t k = 0; p->breakage && k < p->materials; k++)
        asks = asks || (p->breakage[k].strength > 0 && p->breakage[k].by == BREAKAGE_ENERGY);
    if (!asks) return 0;
    const size_t bytes = (size_t)p->n * sizeof *start->v;
    packing_wrap(p, NULL);
    start->v = malloc(bytes + 1), start->w = malloc(bytes + 1);
    if (!start->v || !start->w) {
        breaking_start_free(start);
        return failure_set(failure, EX_SOFTWARE, "no memory for the loads of grains");
    }
    if (p->n) memcpy(start->v, p->v, bytes), memcpy(start->w, p->w, bytes);
    return 0;
}

void breaking_start_free(struct breaking_start *start)
{
    free(start->v), free(start->w);
    *start = (struct breaking_start){ 0 };
}

int breaking_load(struct packing *p, const struct contacts *s, const struct breaking_start *start,
                  struct failure *failure)
{
    if (!s->found || !s->n) return 0;
    struct breaking_body *body = calloc((size_t)p->n + 1, sizeof *body);
    if (!body) return failure_set(failure, EX_SOFTWARE, "no memory for the loads of grains");
    for (int64_t i = 0; i < p->n; i++) {
        body[i].how = breakage_of(p, i);
        if (body[i].how) body[i].d = breakage_diameter(p, i);
    }
    for (int64_t k = 0, end; k < s->n; k = end) {
        const int32_t a = s->c[k].a, b = s->c[k].b;
        end = balance_next_pair(s, k);
        const double share = a >= 0 && p->mass[a] > 0 && p->mass[b] > 0 ? 0.5 : 1;
        const double energy = share * impact_energy(p, s, start, k, end);
        if (a >= 0) add_pair(p, &body[a], s, k, end, a, -1, energy);
        add_pair(p, &body[b], s, k, end, b, 1, energy);
    }
    for (int64_t i = 0; i < p->n; i++) breaking_end(p, &body[i], i);
    free(body);
    return 0;
}
