/*
 * mpi/hypergraph.c: the cells of a grid, each of which is one rank's, by Zoltan's hypergraph partitioner (PHG)
 * [mpi/decomposition.h]. A cell weighs what its bodies do. It makes a hyperedge with the cells around it, which
 * weighs as much as it has bodies: these are copied to all ranks that have one of the others, so what the
 * partitioner keeps small is the number of copies [Catalyurek & Aykanat 1999]. Cells without a body go with the
 * nearest that have one, and so do places outside of the grid.
 */
#include "mpi/decomposition.h"

#include "base/failure.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <trilinos/zoltan.h>

enum {
    CELLS_A_RANK = 500,   /* of the grid, about: enough to share out evenly */
    CELLS_MOST = 1 << 20, /* of the grid */
    AROUND = 27,          /* a cell, and those that touch it */
    WEIGHT_UNITS = 20     /* of weight 1: whole numbers have one sum in any order */
};

struct hypergraph_cells {
    struct comm *comm;
    struct Zoltan_Struct *zz;
    vec3 lo;        /* m: a corner of the grid */
    double side;    /* m: of a cell */
    int many[3];    /* cells along x, y, z */
    int64_t n;      /* cells; 0: nothing is cut yet */
    int *owner;     /* [n] rank */
    int64_t *work;  /* [n] weight of each cell's bodies, in units */
    int64_t *count; /* [n] bodies */
    int *home; /* [n] the rank that asks for the cell, while it is being dealt; -1: it is empty */
};

static int64_t hypergraph_along(const struct hypergraph_cells *c, double x, double lo, int k)
{
    double i = floor((x - lo) / c->side);
    return i > 0 ? (int64_t)fmin(i, c->many[k] - 1) : 0; // 0, too, where it is not a number
}

static void hypergraph_place(const struct hypergraph_cells *c, vec3 x, int64_t at[3])
{
    at[0] = hypergraph_along(c, x.x, c->lo.x, 0), at[1] = hypergraph_along(c, x.y, c->lo.y, 1);
    at[2] = hypergraph_along(c, x.z, c->lo.z, 2);
}

static int64_t cell_at(const struct hypergraph_cells *c, const int64_t at[3])
{
    return (at[2] * c->many[1] + at[1]) * c->many[0] + at[0];
}

/* near[] = the cell and those around it; returns how many. */
static int hypergraph_around(const struct hypergraph_cells *c, int64_t cell, int64_t near[AROUND])
{
    const int64_t at[3] = { cell % c->many[0], cell / c->many[0] % c->many[1],
                            cell / c->many[0] / c->many[1] };
    int n = 0;
    for (int i = 0; i < AROUND; i++) {
        const int64_t to[3] = { at[0] + i % 3 - 1, at[1] + i / 3 % 3 - 1, at[2] + i / 9 - 1 };
        bool inside = true;
        for (int k = 0; k < 3; k++) inside = inside && to[k] >= 0 && to[k] < c->many[k];
        if (inside) near[n++] = cell_at(c, to);
    }
    return n;
}

/* ---- what Zoltan asks ---- */

static bool is_asked(const struct hypergraph_cells *c, int64_t cell)
{
    return c->home[cell] == c->comm->me;
}

static int hypergraph_count(void *arg, int *error)
{
    const struct hypergraph_cells *c = arg;
    int n = 0;
    for (int64_t i = 0; i < c->n; i++) n += is_asked(c, i);
    *error = ZOLTAN_OK;
    return n;
}

static void hypergraph_list(void *arg, int gids, int lids, ZOLTAN_ID_PTR gid, ZOLTAN_ID_PTR lid,
                            int weights, float *weight, int *error)
{
    const struct hypergraph_cells *c = arg;
    int n = 0;
    (void)gids, (void)lids, (void)weights;
    for (int64_t i = 0; i < c->n; i++) {
        if (!is_asked(c, i)) continue;
        gid[n] = lid[n] = (ZOLTAN_ID_TYPE)i;
        weight[n++] = (float)c->work[i];
    }
    *error = ZOLTAN_OK;
}

/* The hyperedge of a cell: occupied ones around it */
static int hypergraph_edge_of(const struct hypergraph_cells *c, int64_t cell, int64_t edge[AROUND])
{
    int64_t near[AROUND];
    int n = hypergraph_around(c, cell, near), pins = 0;
    for (int i = 0; i < n; i++)
        if (c->home[near[i]] >= 0) edge[pins++] = near[i];
    return pins;
}

static void edge_sizes(void *arg, int *edges, int *pins, int *format, int *error)
{
    const struct hypergraph_cells *c = arg;
    int64_t edge[AROUND];
    *edges = *pins = 0, *format = ZOLTAN_COMPRESSED_EDGE, *error = ZOLTAN_OK;
    for (int64_t i = 0; i < c->n; i++)
        if (is_asked(c, i)) ++*edges, *pins += hypergraph_edge_of(c, i, edge);
}

static void edges(void *arg, int gids, int n, int pins, int format, ZOLTAN_ID_PTR gid, int *first,
                  ZOLTAN_ID_PTR pin, int *error)
{
    const struct hypergraph_cells *c = arg;
    int64_t edge[AROUND];
    int next = 0, k = 0;
    (void)gids, (void)n, (void)pins, (void)format;
    for (int64_t i = 0; i < c->n; i++) {
        if (!is_asked(c, i)) continue;
        gid[k] = (ZOLTAN_ID_TYPE)i, first[k++] = next;
        int m = hypergraph_edge_of(c, i, edge);
        for (int j = 0; j < m; j++) pin[next++] = (ZOLTAN_ID_TYPE)edge[j];
    }
    *error = ZOLTAN_OK;
}

static void weight_sizes(void *arg, int *n, int *error)
{
    *n = hypergraph_count(arg, error);
}

static void edge_weights(void *arg, int gids, int lids, int n, int weights, ZOLTAN_ID_PTR gid,
                         ZOLTAN_ID_PTR lid, float *weight, int *error)
{
    const struct hypergraph_cells *c = arg;
    int k = 0;
    (void)gids, (void)lids, (void)n, (void)weights;
    for (int64_t i = 0; i < c->n; i++) {
        if (!is_asked(c, i)) continue;
        gid[k] = lid[k] = (ZOLTAN_ID_TYPE)i;
        weight[k++] = (float)c->count[i];
    }
    *error = ZOLTAN_OK;
}

static void *hypergraph_begin(struct comm *t)
{
    static const char *const set[][2] = { { "LB_METHOD", "HYPERGRAPH" },
                                          { "HYPERGRAPH_PACKAGE", "PHG" },
                                          { "LB_APPROACH", "PARTITION" },
                                          { "NUM_GID_ENTRIES", "1" },
                                          { "NUM_LID_ENTRIES", "1" },
                                          { "OBJ_WEIGHT_DIM", "1" },
                                          { "EDGE_WEIGHT_DIM", "1" },
                                          { "RETURN_LISTS", "PARTS" },
                                          { "IMBALANCE_TOL", "1.02" },
                                          { "SEED", "1" },
                                          { NULL, NULL } };
    struct hypergraph_cells *c = comm_new(t, 1, sizeof *c);
    c->comm = t, c->zz = decomposition_zoltan(t, set);
    Zoltan_Set_Num_Obj_Fn(c->zz, hypergraph_count, c),
        Zoltan_Set_Obj_List_Fn(c->zz, hypergraph_list, c);
    Zoltan_Set_HG_Size_CS_Fn(c->zz, edge_sizes, c), Zoltan_Set_HG_CS_Fn(c->zz, edges, c);
    Zoltan_Set_HG_Size_Edge_Wts_Fn(c->zz, weight_sizes, c);
    Zoltan_Set_HG_Edge_Wts_Fn(c->zz, edge_weights, c);
    return c;
}

static void hypergraph_forget(struct hypergraph_cells *c)
{
    free(c->owner), free(c->work), free(c->count), free(c->home);
    c->owner = c->home = NULL, c->work = c->count = NULL, c->n = 0;
}

static void hypergraph_end(void *made)
{
    struct hypergraph_cells *c = made;
    Zoltan_Destroy(&c->zz), hypergraph_forget(c);
    free(c);
}

/* ---- the cut ---- */

/* The grid around the points of all ranks */
static void lay_grid(struct hypergraph_cells *c, int64_t n, const vec3 *x)
{
    struct comm *t = c->comm;
    double most[6] = { -INFINITY, -INFINITY, -INFINITY, -INFINITY, -INFINITY, -INFINITY }, all[6];
    for (int64_t i = 0; i < n; i++) {
        const double p[3] = { x[i].x, x[i].y, x[i].z };
        for (int k = 0; k < 3; k++)
            most[k] = fmax(most[k], -p[k]), most[3 + k] = fmax(most[3 + k], p[k]);
    }
    MPI_Allreduce(most, all, 6, MPI_DOUBLE, MPI_MAX, t->mpi);
    double size[3], longest = 0;
    for (int k = 0; k < 3; k++) {
        size[k] = all[k] + all[3 + k];
        if (!(size[k] >= 0 && isfinite(size[k])))
            size[k] = all[k] = 0; // no point, or one that is nowhere
        longest = fmax(longest, size[k]);
    }
    c->lo = v3(-all[0], -all[1], -all[2]);
    c->side = longest > 0 ? longest : 1, c->many[0] = c->many[1] = c->many[2] = 1, c->n = 1;
    double limit = fmin((double)CELLS_A_RANK * t->n, CELLS_MOST);
    for (int m = 2; longest > 0; m++) {
        double cells = 1;
        for (int k = 0; k < 3; k++) cells *= floor(size[k] / (longest / m)) + 1;
        if (cells > limit) break;
        c->side = longest / m, c->n = (int64_t)cells;
        for (int k = 0; k < 3; k++) c->many[k] = (int)floor(size[k] / c->side) + 1;
    }
}

/* What is in each cell, of all ranks */
static void hypergraph_weigh(struct hypergraph_cells *c, int64_t n, const vec3 *x,
                             const float *weight)
{
    struct comm *t = c->comm;
    c->work = comm_new(t, c->n, sizeof *c->work), c->count = comm_new(t, c->n, sizeof *c->count);
    for (int64_t i = 0; i < n; i++) {
        int64_t at[3];
        hypergraph_place(c, x[i], at);
        c->work[cell_at(c, at)] += (int64_t)(WEIGHT_UNITS * weight[i] + 0.5f);
        c->count[cell_at(c, at)]++;
    }
    MPI_Allreduce(MPI_IN_PLACE, c->work, (int)c->n, MPI_INT64_T, MPI_SUM, t->mpi);
    MPI_Allreduce(MPI_IN_PLACE, c->count, (int)c->n, MPI_INT64_T, MPI_SUM, t->mpi);
}

/* Cells in which nothing is go with the nearest, cell by cell outwards. */
static void spread(struct hypergraph_cells *c)
{
    int64_t *queue = comm_new(c->comm, c->n, sizeof *queue), first = 0, end = 0, near[AROUND];
    for (int64_t i = 0; i < c->n; i++)
        if (c->owner[i] >= 0) queue[end++] = i;
    if (!end) c->owner[0] = 0, queue[end++] = 0;
    for (; first < end; first++) {
        int n = hypergraph_around(c, queue[first], near);
        for (int i = 0; i < n; i++) {
            if (c->owner[near[i]] >= 0) continue;
            c->owner[near[i]] = c->owner[queue[first]], queue[end++] = near[i];
        }
    }
    free(queue);
}

/* Asks Zoltan whose the occupied cells are. */
static void share_out(struct hypergraph_cells *c)
{
    struct comm *t = c->comm;
    int changes, gids, lids, in, out;
    ZOLTAN_ID_PTR in_gid = NULL, in_lid = NULL, gid = NULL, lid = NULL;
    int *in_rank = NULL, *in_part = NULL, *rank = NULL, *part = NULL;
    if (Zoltan_LB_Partition(c->zz, &changes, &gids, &lids, &in, &in_gid, &in_lid, &in_rank,
                            &in_part, &out, &gid, &lid, &rank, &part) != ZOLTAN_OK)
        comm_fail(t, EX_SOFTWARE, "Zoltan finds no cuts");
    for (int k = 0; k < out; k++) c->owner[gid[k]] = part[k];
    Zoltan_LB_Free_Part(&in_gid, &in_lid, &in_rank, &in_part);
    Zoltan_LB_Free_Part(&gid, &lid, &rank, &part);
    MPI_Allreduce(MPI_IN_PLACE, c->owner, (int)c->n, MPI_INT, MPI_MAX, t->mpi);
}

static void hypergraph_cut(void *made, int64_t n, const vec3 *x, const float *weight)
{
    struct hypergraph_cells *c = made;
    struct comm *t = c->comm;
    hypergraph_forget(c);
    lay_grid(c, n, x);
    hypergraph_weigh(c, n, x, weight);
    c->owner = comm_new(t, c->n, sizeof *c->owner), c->home = comm_new(t, c->n, sizeof *c->home);
    int64_t occupied = 0, next = 0;
    for (int64_t i = 0; i < c->n; i++) occupied += c->count[i] > 0;
    for (int64_t i = 0; i < c->n; i++) {
        c->owner[i] = -1;
        c->home[i] = c->count[i] && occupied ? (int)(next++ * t->n / occupied) : -1;
    }
    // so few cells Zoltan does not share out
    if (occupied >= 2 * t->n)
        share_out(c);
    else
        for (int64_t i = 0; i < c->n; i++) c->owner[i] = c->home[i];
    spread(c);
}

static int hypergraph_owner(const void *made, vec3 x)
{
    const struct hypergraph_cells *c = made;
    int64_t at[3];
    hypergraph_place(c, x, at);
    return c->owner[cell_at(c, at)];
}

static int hypergraph_meets(const void *made, vec3 lo, vec3 hi, int *rank)
{
    const struct hypergraph_cells *c = made;
    int64_t from[3], to[3], at[3];
    int n = 0;
    hypergraph_place(c, lo, from), hypergraph_place(c, hi, to);
    for (at[2] = from[2]; at[2] <= to[2]; at[2]++)
        for (at[1] = from[1]; at[1] <= to[1]; at[1]++)
            for (at[0] = from[0]; at[0] <= to[0]; at[0]++) {
                int k = 0, has = c->owner[cell_at(c, at)];
                while (k < n && rank[k] != has) k++;
                if (k == n) rank[n++] = has;
            }
    return n;
}

const struct cuts cuts_hypergraph = { hypergraph_begin, hypergraph_end, hypergraph_cut,
                                      hypergraph_owner, hypergraph_meets };
