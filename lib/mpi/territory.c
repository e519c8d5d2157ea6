/* mpi/territory.c: the ways to cut space [mpi/territory.h]. */
#include "mpi/territory.h"

#include "base/failure.h"

#include <stdlib.h>
#include <trilinos/zoltan.h>

static const struct cuts *const ways[] = { &cuts_bisection, &cuts_hypergraph }; // as --cut has them

struct decomposition {
    const struct cuts *way;
    void *made;
};

struct decomposition *decomposition_new(struct comm *t, int way)
{
    struct decomposition *y = comm_new(t, 1, sizeof *y);
    *y = (struct decomposition){ ways[way], ways[way]->begin(t) };
    return y;
}

void decomposition_free(struct decomposition *y)
{
    if (y) y->way->end(y->made);
    free(y);
}

void decomposition_cut(struct decomposition *y, int64_t n, const vec3 *x, const float *weight)
{
    y->way->cut(y->made, n, x, weight);
}

int decomposition_owner(const struct decomposition *y, vec3 x)
{
    return y->way->owner(y->made, x);
}

int decomposition_meets(const struct decomposition *y, vec3 lo, vec3 hi, int *rank)
{
    return y->way->meets(y->made, lo, hi, rank);
}

struct Zoltan_Struct *decomposition_zoltan(struct comm *t, const char *const set[][2])
{
    struct Zoltan_Struct *zz = NULL;
    float version;
    if (Zoltan_Initialize(0, NULL, &version) != ZOLTAN_OK || !(zz = Zoltan_Create(t->mpi)))
        comm_fail(t, EX_SOFTWARE, "Zoltan does not begin");
    Zoltan_Set_Param(zz, "DEBUG_LEVEL", "0");
    for (int k = 0; set[k][0]; k++) Zoltan_Set_Param(zz, set[k][0], set[k][1]);
    return zz;
}
