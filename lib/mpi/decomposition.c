/* mpi/decomposition.c: boxes, by Zoltan's recursive coordinate bisection, whose cuts are kept [mpi/decomposition.h]. */
#include "mpi/decomposition.h"

#include "base/failure.h"

#include <stdlib.h>
#include <trilinos/zoltan.h>

struct decomposition {
    struct comm *comm;
    struct Zoltan_Struct *zz;
    int64_t n; /* while space is being cut */
    const vec3 *x;
    const float *weight;
};

static int bisection_count(void *arg, int *error)
{
    const struct decomposition *y = arg;
    *error = ZOLTAN_OK;
    return (int)y->n;
}

static void bisection_list(void *arg, int gids, int lids, ZOLTAN_ID_PTR gid, ZOLTAN_ID_PTR lid,
                           int weights, float *weight, int *error)
{
    const struct decomposition *y = arg;
    (void)gids, (void)lids, (void)weights;
    for (int64_t i = 0; i < y->n; i++) {
        gid[2 * i] = (ZOLTAN_ID_TYPE)y->comm->me, gid[2 * i + 1] = (ZOLTAN_ID_TYPE)i;
        lid[i] = (ZOLTAN_ID_TYPE)i;
        weight[i] = y->weight[i];
    }
    *error = ZOLTAN_OK;
}

static int dimensions(void *arg, int *error)
{
    (void)arg;
    *error = ZOLTAN_OK;
    return 3;
}

static void places(void *arg, int gids, int lids, int n, ZOLTAN_ID_PTR gid, ZOLTAN_ID_PTR lid,
                   int dim, double *to, int *error)
{
    const struct decomposition *y = arg;
    (void)gids, (void)lids, (void)gid, (void)dim;
    for (int i = 0; i < n; i++) {
        vec3 x = y->x[lid[i]];
        to[3 * i] = x.x, to[3 * i + 1] = x.y, to[3 * i + 2] = x.z;
    }
    *error = ZOLTAN_OK;
}

struct decomposition *decomposition_new(struct comm *t)
{
    static const char *const set[][2] = {
        { "DEBUG_LEVEL", "0" },      { "LB_METHOD", "RCB" },      { "KEEP_CUTS", "1" },
        { "NUM_GID_ENTRIES", "2" },  { "NUM_LID_ENTRIES", "1" },  { "OBJ_WEIGHT_DIM", "1" },
        { "RETURN_LISTS", "NONE" },  { "IMBALANCE_TOL", "1.02" }, { "RCB_OUTPUT_LEVEL", "0" },
        { "REDUCE_DIMENSIONS", "0" }
    };
    struct decomposition *y = comm_new(t, 1, sizeof *y);
    float version;
    y->comm = t;
    if (Zoltan_Initialize(0, NULL, &version) != ZOLTAN_OK || !(y->zz = Zoltan_Create(t->mpi)))
        comm_fail(t, EX_SOFTWARE, "Zoltan does not begin");
    for (size_t k = 0; k < sizeof set / sizeof *set; k++)
        Zoltan_Set_Param(y->zz, set[k][0], set[k][1]);
    Zoltan_Set_Num_Obj_Fn(y->zz, bisection_count, y),
        Zoltan_Set_Obj_List_Fn(y->zz, bisection_list, y);
    Zoltan_Set_Num_Geom_Fn(y->zz, dimensions, y), Zoltan_Set_Geom_Multi_Fn(y->zz, places, y);
    return y;
}

void decomposition_free(struct decomposition *y)
{
    if (y) Zoltan_Destroy(&y->zz);
    free(y);
}

void decomposition_cut(struct decomposition *y, int64_t n, const vec3 *x, const float *weight)
{
    int changes, gids, lids, in, out;
    ZOLTAN_ID_PTR a = NULL, b = NULL, c = NULL, d = NULL;
    int *p1 = NULL, *p2 = NULL, *p3 = NULL, *p4 = NULL;
    y->n = n, y->x = x, y->weight = weight;
    if (n > INT32_MAX || Zoltan_LB_Partition(y->zz, &changes, &gids, &lids, &in, &a, &b, &p1, &p2,
                                             &out, &c, &d, &p3, &p4) != ZOLTAN_OK)
        comm_fail(y->comm, EX_SOFTWARE, "Zoltan finds no cuts");
    Zoltan_LB_Free_Part(&a, &b, &p1, &p2), Zoltan_LB_Free_Part(&c, &d, &p3, &p4);
}

int decomposition_owner(const struct decomposition *y, vec3 x)
{
    double at[3] = { x.x, x.y, x.z };
    int rank, part;
    if (Zoltan_LB_Point_PP_Assign(y->zz, at, &rank, &part) != ZOLTAN_OK)
        comm_fail(y->comm, EX_SOFTWARE, "Zoltan gives no owner of a point");
    return rank;
}

int decomposition_meets(const struct decomposition *y, vec3 lo, vec3 hi, int *rank)
{
    int n = 0;
    if (Zoltan_LB_Box_Assign(y->zz, lo.x, lo.y, lo.z, hi.x, hi.y, hi.z, rank, &n) != ZOLTAN_OK)
        comm_fail(y->comm, EX_SOFTWARE, "Zoltan gives no ranks of a box");
    return n;
}
