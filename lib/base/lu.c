/* base/lu.c: sparse LU by KLU, which takes columns: from our rows it factorises the transpose. */
#include "base/lu.h"

#include <stdlib.h>
#include <suitesparse/cholmod.h>
#include <suitesparse/klu.h>

struct lu {
    int32_t n, *first, *col;
    double entries, cost; /* entries of either factor; multiplications */
    klu_common common;
    klu_symbolic *order;
    klu_numeric *factors;
};

void lu_free(struct lu *lu)
{
    if (!lu) return;
    if (lu->factors) klu_free_numeric(&lu->factors, &lu->common);
    if (lu->order) klu_free_symbolic(&lu->order, &lu->common);
    free(lu);
}

/*
 * An order of the unknowns with little fill: the better of AMD and nested dissection, which saves a
 * third of the work or more where contacts fill space. It is chosen for the pattern below the
 * diagonal, which is that above it except when W is not symmetric; the order is then valid all the
 * same.
 */
static klu_symbolic *analyse(struct lu *lu)
{
    cholmod_common c;
    cholmod_start(&c);
    c.print = 0;
    c.nmethods = 2;
    c.method[0].ordering = CHOLMOD_AMD, c.method[1].ordering = CHOLMOD_NESDIS;
    size_t n = (size_t)lu->n;
    cholmod_sparse A = { .nrow = n,
                         .ncol = n,
                         .nzmax = (size_t)lu->first[n],
                         .p = lu->first,
                         .i = lu->col,
                         .stype = -1,
                         .itype = CHOLMOD_INT,
                         .xtype = CHOLMOD_PATTERN,
                         .packed = 1 };
    cholmod_factor *L = cholmod_analyze(&A, &c);
    klu_symbolic *order = NULL;
    if (L) {
        lu->entries = c.lnz, lu->cost = c.fl;
        order = klu_analyze_given(lu->n, lu->first, lu->col, L->Perm, L->Perm, &lu->common);
        if (order) order->Lnz[0] = order->lnz = order->unz = c.lnz;
        cholmod_free_factor(&L, &c);
    }
    cholmod_finish(&c);
    return order;
}

struct lu *lu_new(int32_t n, int32_t *first, int32_t *col, double bytes, bool *too_large)
{
    *too_large = false;
    struct lu *lu = calloc(1, sizeof *lu);
    if (!lu) return NULL;
    lu->n = n, lu->first = first, lu->col = col;
    klu_defaults(&lu->common);
    lu->common.btf = 0;    // one block: the pattern is a contact graph's
    lu->common.tol = 0;    // no pivots off the diagonal: their fill would not be bounded
    lu->common.scale = -1; // solve/scaled.c has scaled the rows
    lu->order = analyse(lu);
    // 48 bytes: an entry of both factors, a number and an index each, and copies when they grow
    *too_large = lu->order && 48 * lu->entries > bytes;
    if (lu->order && !*too_large) return lu;
    lu_free(lu);
    return NULL;
}

double lu_cost(const struct lu *lu)
{
    return lu->cost;
}

bool lu_factorise(struct lu *lu, double *a)
{
    klu_common *c = &lu->common;
    if (lu->factors) return klu_refactor(lu->first, lu->col, a, lu->order, lu->factors, c);
    lu->factors = klu_factor(lu->first, lu->col, a, lu->order, c);
    return lu->factors != NULL;
}

/* The product of U's diagonal: rows and columns have one order, and L has ones on its diagonal. */
int lu_sign(const struct lu *lu)
{
    const double *u = lu->factors->Udiag;
    int sign = 1;
    for (int32_t i = 0; i < lu->n; i++) sign = u[i] < 0 ? -sign : sign;
    return sign;
}

bool lu_substitute(struct lu *lu, double *x)
{
    return lu->factors && klu_tsolve(lu->order, lu->factors, lu->n, 1, x, &lu->common);
}
