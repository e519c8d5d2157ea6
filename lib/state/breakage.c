#include "state/breakage.h"

#include "base/random.h"
#include "shape/fracture.h"
#include "state/packing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *breakage_trouble(const struct breakage *b)
{
    if (!(b->strength > 0)) return NULL;
    if (b->by < 0 || b->by >= BREAKAGE_BYS) return "by is no criterion of breakage";
    if (b->damage < 0 || b->damage >= DAMAGES) return "damage is no law of damage";
    if (b->into < 0 || b->into >= INTOS) return "into is nothing that grains break into";
    if (b->pieces < 2 || b->pieces > FRACTURE_MOST) return "pieces must lie in [2, 64]";
    if (!(b->smallest > 0)) return "smallest must be positive";
    if (!(b->size > 0) && b->exponent != 0)
        return "size must be positive where strength depends on it";
    if (b->damage && b->by != BREAKAGE_ENERGY) return "damage adds up impacts: by energy alone";
    if (b->damage == DAMAGE_TAVARES && !(b->gamma > 0)) return "gamma must be positive";
    return NULL;
}

int32_t breakage_fragment(const char *name)
{
    char again[32];
    int id;
    if (sscanf(name, BREAKAGE_FRAGMENT, &id) != 1 || id < 0) return -1;
    snprintf(again, sizeof again, BREAKAGE_FRAGMENT, id);
    return strcmp(again, name) ? -1 : id;
}

double breakage_tavares(double damage, double load, double gamma)
{
    const double e = load / (1 - damage);
    double D = 0;
    if (!(e < 1)) return 1;
    for (int k = 0; k < 50; k++) // a contraction: five are enough where E < 0.9
        D = pow(2 * gamma * e / (2 * gamma - 5 * D + 5), 2 * gamma / 5);
    return damage + (1 - damage) * D;
}

/* ---- of a packing ---- */

int breakage_alloc(struct packing *p, struct failure *failure)
{
    static const int columns[] = { BODY_damage, BODY_parent, BODY_generation, BODY_born };
    const size_t n = (size_t)p->materials;
    free(p->breakage), free(p->broken);
    p->breakage = calloc(n + 1, sizeof *p->breakage), p->broken = calloc(n + 1, sizeof *p->broken);
    if (!p->breakage || !p->broken)
        return failure_set(failure, EX_SOFTWARE, "no memory for the breakage of %d materials",
                           p->materials);
    for (int k = 0; k < 4; k++)
        if (packing_alloc_column(p, columns[k], failure)) return failure->status;
    for (int64_t i = 0; i < p->n; i++) p->parent[i] = -1;
    return 0;
}

double breakage_diameter_of(int dim, const struct shape *s, double radius)
{
    if (!s) return 2 * radius;
    return 2 * radius * (dim == 2 ? sqrt(s->volume / M_PI) : cbrt(s->volume * 3 / (4 * M_PI)));
}

double breakage_diameter(const struct packing *p, int64_t i)
{
    return breakage_diameter_of(p->dim, packing_shape(p, i), p->radius[i]);
}

const struct breakage *breakage_of(const struct packing *p, int64_t i)
{
    const struct breakage *b = p->breakage ? &p->breakage[p->material[i]] : NULL;
    const struct shape *s = packing_shape(p, i);
    if (!b || !(b->strength > 0) || !(p->mass[i] > 0)) return NULL;
    if (s && (b->into != INTO_PIECES || !fracture_cuts(s))) return NULL;
    return breakage_diameter(p, i) >= b->smallest ? b : NULL;
}

double breakage_strength(const struct packing *p, int64_t i, double d, double *scale)
{
    const struct breakage *b = &p->breakage[p->material[i]];
    *scale = b->exponent != 0 ? pow(d / b->size, -b->exponent) : 1;
    if (!(b->modulus > 0)) return b->strength * *scale;
    const double q = counter_uniform(p->seed, COUNTER_STRENGTH, (uint64_t)p->id[i], 0, 0);
    return b->strength * *scale * pow(-log1p(-q), 1 / b->modulus);
}

struct broken breakage_total(const struct packing *p)
{
    struct broken sum = { 0 };
    for (int32_t k = 0; p->broken && k < p->materials; k++) {
        const struct broken *b = &p->broken[k];
        sum.grains += b->grains, sum.originals += b->originals, sum.fragments += b->fragments;
        sum.waiting += b->waiting, sum.mass += b->mass, sum.dust += b->dust;
        sum.kinetic += b->kinetic, sum.potential += b->potential, sum.taken += b->taken;
        for (int d = 0; d < 3; d++) sum.momentum[d] += b->momentum[d];
    }
    return sum;
}
