/* measure/fabric.c: which way contacts point. */
#include "measure/branch.h"
#include "measure/measures.h"

#include <math.h>

static const struct quantity quantities[] = {
    { "contacts", "1", 1, "number of contacts with their point in the region" },
    { "tensor", "1", 9, "mean of n n^T" },
    { "principal", "1", 3, "principal values, the largest first" },
    { "anisotropy", "1", 1, "5/2 (2D: 2) times the largest minus the smallest principal value" },
    { 0 },
};

static int fabric_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    struct tensor F = { { { 0 } } };
    double n = 0, value[3], *at = table_row(t, failure);
    if (!at) return failure->status;
    for (int64_t i = 0; i < s->s->n; i++) {
        const struct contact *c = &s->s->c[i];
        int times = branch_counts(s->s, i) ? region_holds(&s->region, c->x) : 0;
        n += times;
        if (times) tensor_add(&F, times, c->n, c->n);
    }
    put(&at, n);
    if (!(n > 0)) {
        table_null(t, "no contact in the region");
        return 0;
    }
    tensor_scale(&F, 1 / n);
    tensor_principal(&F, s->p->dim, value);
    put_tensor(&at, &F);
    for (int k = 0; k < 3; k++) put(&at, value[k]);
    put(&at, s->p->dim == 2 ? 2 * (value[0] - value[1]) : 2.5 * (value[0] - value[2]));
    return 0;
}

const struct measure measure_fabric = {
    .name = "fabric",
    .help = "fabric tensor of the contact directions",
    .quantity = quantities,
    .needs = NEEDS_CONTACTS,
    .rows = fabric_rows,
};
