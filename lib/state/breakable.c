#include "state/breakable.h"

#include "base/random.h"
#include "shape/fracture.h"

#include <math.h>
#include <stdlib.h>

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
