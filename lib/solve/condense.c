/* solve/condense.c: the factors of K, V column by column, and W [solve/condense.h]. */
#include "solve/condense.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <suitesparse/klu.h>

static int condense_short_of_memory(struct failure *failure)
{
    failure_set(failure, EX_SOFTWARE, "out of memory for a global problem");
    return EX_SOFTWARE;
}

/* K = [ M -G ; G^T 0 ], the matrix of (v, lambda), factorised; by columns. */
struct factor {
    int64_t n;
    SuiteSparse_long *p, *i;
    double *x;
    klu_l_common common;
    klu_l_symbolic *symbolic;
    klu_l_numeric *numeric;
    double *dense; /* [n] work */
};

static void factor_free(struct factor *K)
{
    if (K->numeric) klu_l_free_numeric(&K->numeric, &K->common);
    if (K->symbolic) klu_l_free_symbolic(&K->symbolic, &K->common);
    free(K->p), free(K->i), free(K->x), free(K->dense);
}

/* The entries of K; those at the same place are not yet added. */
static bool factor_entries(struct sparse *K, const struct global *P)
{
    bool good = true;
    for (int64_t e = 0; good && e < P->M.count; e++)
        good = sparse_add(K, P->M.row[e], P->M.col[e], P->M.x[e]);
    for (int64_t e = 0; good && e < P->G.count; e++)
        good = sparse_add(K, P->G.row[e], P->nv + P->G.col[e], -P->G.x[e]) &&
               sparse_add(K, P->nv + P->G.col[e], P->G.row[e], P->G.x[e]);
    return good;
}

/* The columns of K, entries at the same place added. at[row]: where the column has that row */
static bool factor_columns(struct factor *K, const struct sparse *A, int64_t *at)
{
    struct lists of = { 0 };
    if (!lists_init(&of, K->n, A->count, A->col)) return false;
    int64_t count = 0;
    for (int64_t i = 0; i < K->n; i++) at[i] = -1;
    for (int64_t j = 0; j < K->n; j++) {
        for (int64_t k = of.first[j]; k < of.first[j + 1]; k++) {
            assert(A->row && A->x); // where there are items there are entries
            int64_t e = of.item[k], i = A->row[e];
            if (at[i] < K->p[j]) at[i] = count++, K->i[at[i]] = i, K->x[at[i]] = 0;
            K->x[at[i]] += A->x[e];
        }
        K->p[j + 1] = count;
    }
    lists_free(&of);
    return true;
}

static bool factor_gather(struct factor *K, const struct global *P)
{
    struct sparse A = { 0 };
    bool good = factor_entries(&A, P);
    int64_t *at = malloc((size_t)(K->n + 1) * sizeof *at);
    K->p = calloc((size_t)K->n + 1, sizeof *K->p);
    K->i = malloc((size_t)(A.count + 1) * sizeof *K->i);
    K->x = malloc((size_t)(A.count + 1) * sizeof *K->x);
    K->dense = malloc((size_t)(K->n + 1) * sizeof *K->dense);
    good = good && at && K->p && K->i && K->x && K->dense && factor_columns(K, &A, at);
    free(at);
    sparse_free(&A);
    return good;
}

static int factor_init(struct factor *K, const struct global *P, struct failure *failure)
{
    K->n = P->nv + P->nl;
    if (K->n == 0) return 0;
    if (!factor_gather(K, P)) return condense_short_of_memory(failure);
    klu_l_common *c = &K->common;
    klu_l_defaults(c);
    K->symbolic = klu_l_analyze(K->n, K->p, K->i, c);
    if (K->symbolic) K->numeric = klu_l_factor(K->p, K->i, K->x, K->symbolic, c);
    if (c->status == KLU_OUT_OF_MEMORY || c->status == KLU_TOO_LARGE)
        return condense_short_of_memory(failure);
    bool good = K->numeric && c->status == KLU_OK && klu_l_rcond(K->symbolic, K->numeric, c);
    if (!good || !(c->rcond >= 1e-16))
        return failure_set(failure, EX_DATAERR, "/fclib_global/M: %s singular (rcond %.1g)",
                           P->nl ? "with G it is" : "is", good ? c->rcond : 0);
    return 0;
}

/* x = K^-1 b */
static int factor_solve(struct factor *K, const double *b, double *x, struct failure *failure)
{
    if (K->n == 0) return 0;
    memcpy(x, b, (size_t)K->n * sizeof *x);
    bool good = klu_l_solve(K->symbolic, K->numeric, K->n, 1, x, &K->common);
    for (int64_t k = 0; good && k < K->n; k++) good = isfinite(x[k]);
    return good
               ? 0
               : failure_set(failure, EX_DATAERR, "/fclib_global/M: singular to working precision");
}

/* (v0, l0) = K^-1 (f, -b) */
static int condense_free(struct motion *U, const struct global *P, struct factor *K,
                         struct failure *failure)
{
    U->v0 = calloc((size_t)K->n + 1, sizeof *U->v0);
    if (!U->v0) return condense_short_of_memory(failure);
    if (K->n == 0) return 0;
    for (int64_t k = 0; k < P->nv; k++) K->dense[k] = P->f[k];
    for (int64_t k = 0; k < P->nl; k++) K->dense[P->nv + k] = -P->b[k];
    return factor_solve(K, K->dense, U->v0, failure);
}

static int32_t component_of(int32_t *component, int32_t i)
{
    while (component[i] != i) i = component[i] = component[component[i]];
    return i;
}

/* K consists of components with no entry between them, as separate bodies are. component[i]: the
   lowest unknown of i's component */
static void find_components(const struct factor *K, int32_t *component)
{
    for (int64_t i = 0; i < K->n; i++) component[i] = (int32_t)i;
    for (int64_t j = 0; j < K->n; j++)
        for (SuiteSparse_long k = K->p[j]; k < K->p[j + 1]; k++) {
            int32_t a = component_of(component, (int32_t)j),
                    b = component_of(component, (int32_t)K->i[k]);
            component[a > b ? a : b] = a > b ? b : a;
        }
    for (int64_t i = 0; i < K->n; i++) component[i] = component_of(component, (int32_t)i);
}

/* Adds column j of H to the right-hand side b, unless a component that it has entries in belongs to
   another column already. */
static bool join_columns(const struct sparse *H, const struct lists *of, int32_t j,
                         const int32_t *component, int32_t *owner, double *b)
{
    for (int64_t k = of->first[j]; k < of->first[j + 1]; k++)
        if (owner[component[H->row[of->item[k]]]] >= 0) return false;
    for (int64_t k = of->first[j]; k < of->first[j + 1]; k++) {
        assert(b);
        int32_t i = H->row[of->item[k]];
        owner[component[i]] = j;
        b[i] += H->x[of->item[k]];
    }
    return true;
}

/* The entries of H by columns, and work space */
struct condense_columns {
    struct lists of;
    int32_t *component; /* [2 K->n] */
    int32_t *todo;      /* [H->n] */
    double *y;          /* [K->n] */
};

/*
 * V = K^-1 (H, 0), without its zeros. Columns with entries in different components of K share one
 * right-hand side: for a packing that takes about as many solutions as a ball has neighbours, times
 * d.
 */
static int solve_columns(struct sparse *V, const struct sparse *H, struct factor *K,
                         const struct condense_columns *s, struct failure *failure)
{
    const struct lists *of = &s->of;
    int32_t *component = s->component, *owner = component + K->n, *todo = s->todo;
    double *y = s->y;
    find_components(K, component);
    for (int32_t j = 0; j < H->n; j++) todo[j] = j;
    for (int64_t left = H->n, kept; left > 0; left = kept) {
        for (int64_t i = 0; i < K->n; i++) owner[i] = -1, K->dense[i] = 0;
        kept = 0;
        for (int64_t k = 0; k < left; k++)
            if (!join_columns(H, of, todo[k], component, owner, K->dense)) todo[kept++] = todo[k];
        if (factor_solve(K, K->dense, y, failure)) return failure->status;
        for (int64_t i = 0; i < K->n; i++)
            if (owner[component[i]] >= 0 && y[i] != 0 &&
                !sparse_add(V, i, owner[component[i]], y[i]))
                return condense_short_of_memory(failure);
    }
    return 0;
}

static int condense_columns(struct motion *U, const struct global *P, struct factor *K,
                            struct failure *failure)
{
    struct condense_columns s = { .component = calloc((size_t)(2 * K->n + 1), sizeof *s.component),
                                  .todo = malloc((size_t)(P->H.n + 1) * sizeof *s.todo),
                                  .y = malloc((size_t)(K->n + 1) * sizeof *s.y) };
    bool room = s.y && s.component && s.todo && lists_init(&s.of, P->H.n, P->H.count, P->H.col);
    int e = room ? solve_columns(&U->V, &P->H, K, &s, failure) : condense_short_of_memory(failure);
    lists_free(&s.of);
    free(s.todo), free(s.component), free(s.y);
    return e;
}

/* W = H^T V, column by column, from the rows of H in which V's column has entries */
static bool condense_W(struct sparse *W, const struct sparse *H, const struct sparse *V)
{
    struct lists rows = { 0 }, columns = { 0 };
    double *sum = calloc((size_t)H->n + 1, sizeof *sum);
    int32_t *met = malloc((size_t)(H->n + 1) * sizeof *met);
    int32_t *last = malloc((size_t)(H->n + 1) * sizeof *last); // the column that met it last
    bool good = sum && met && last && lists_init(&rows, V->m, H->count, H->row) &&
                lists_init(&columns, V->n, V->count, V->col);
    for (int64_t a = 0; good && a < H->n; a++) last[a] = -1;
    for (int32_t j = 0; good && j < H->n; j++) {
        int64_t mets = 0;
        for (int64_t k = columns.first[j]; k < columns.first[j + 1]; k++) {
            int64_t v = columns.item[k], i = V->row[v]; // none of H in the rows of multipliers
            for (int64_t l = rows.first[i]; l < rows.first[i + 1]; l++) {
                int32_t a = H->col[rows.item[l]];
                if (last[a] != j) last[a] = j, sum[a] = 0, met[mets++] = a;
                sum[a] += H->x[rows.item[l]] * V->x[v];
            }
        }
        for (int64_t k = 0; good && k < mets; k++) good = sparse_add(W, met[k], j, sum[met[k]]);
    }
    lists_free(&columns);
    lists_free(&rows);
    free(last), free(met), free(sum);
    return good;
}

int condense(const struct global *P, struct motion *U, struct sparse *W, double *q,
             struct failure *failure)
{
    struct factor K = { 0 };
    int64_t n = P->nv + P->nl, nd = P->H.n;
    *U = (struct motion){ .nv = P->nv, .nl = P->nl, .V = { .m = n, .n = nd } };
    *W = (struct sparse){ .m = nd, .n = nd };
    int e = factor_init(&K, P, failure);
    if (!e) e = condense_free(U, P, &K, failure);
    if (!e) e = condense_columns(U, P, &K, failure);
    factor_free(&K);
    if (!e && !condense_W(W, &P->H, &U->V)) e = condense_short_of_memory(failure);
    for (int64_t k = 0; !e && k < P->H.count; k++) q[P->H.col[k]] += P->H.x[k] * U->v0[P->H.row[k]];
    return e;
}

void motion_of(const struct motion *U, const double *r, double *v)
{
    memcpy(v, U->v0, (size_t)(U->nv + U->nl) * sizeof *v);
    for (int64_t k = 0; k < U->V.count; k++) v[U->V.row[k]] += U->V.x[k] * r[U->V.col[k]];
}

void motion_free(struct motion *U)
{
    free(U->v0);
    sparse_free(&U->V);
    *U = (struct motion){ 0 };
}

void global_free(struct global *P)
{
    struct sparse *const matrix[] = { &P->M, &P->H, &P->G };
    for (int k = 0; k < 3; k++) sparse_free(matrix[k]);
    free(P->f), free(P->b);
    *P = (struct global){ 0 };
}
