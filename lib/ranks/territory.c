/* ranks/territory.c: the ways to cut space [ranks/territory.h]. */
#include "ranks/territory.h"

#include "base/why.h"

#include <stdlib.h>
#include <trilinos/zoltan.h>

static const struct cuts *const ways[] = { &cuts_bisection, &cuts_hypergraph }; // as --cut has them

struct territory {
    const struct cuts *way;
    void *made;
};

struct territory *territory_new(struct comm *t, int way)
{
    struct territory *y = comm_new(t, 1, sizeof *y);
    *y = (struct territory){ ways[way], ways[way]->begin(t) };
    return y;
}

void territory_free(struct territory *y)
{
    if (y) y->way->end(y->made);
    free(y);
}

void territory_cut(struct territory *y, int64_t n, const vec3 *x, const float *weight)
{
    y->way->cut(y->made, n, x, weight);
}

int territory_owner(const struct territory *y, vec3 x)
{
    return y->way->owner(y->made, x);
}

int territory_meets(const struct territory *y, vec3 lo, vec3 hi, int *rank)
{
    return y->way->meets(y->made, lo, hi, rank);
}

struct Zoltan_Struct *territory_zoltan(struct comm *t, const char *const set[][2])
{
    struct Zoltan_Struct *zz = NULL;
    float version;
    if (Zoltan_Initialize(0, NULL, &version) != ZOLTAN_OK || !(zz = Zoltan_Create(t->mpi)))
        comm_fail(t, EX_SOFTWARE, "Zoltan does not begin");
    Zoltan_Set_Param(zz, "DEBUG_LEVEL", "0");
    for (int k = 0; set[k][0]; k++) Zoltan_Set_Param(zz, set[k][0], set[k][1]);
    return zz;
}
