/* base/lu.c: see base/lu.h. KLU wants columns: it factorises the transpose of what it is given by rows. */
#include "base/lu.h"

#include <stdlib.h>
#include <suitesparse/cholmod.h>
#include <suitesparse/klu.h>

struct lu {
    int32_t n, *first, *col;
    double entries, cost; /* of one factor, the other has as many; multiplications */
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
 * An order of the unknowns that makes little fill: the better of AMD and of nested dissection, which
 * saves a third of the work and more where contacts fill space. It is sought for what is below the
 * diagonal: the pattern above is the same but where a W is not symmetric, and there it serves as well.
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
    lu->common.tol = 0;    // pivots off the diagonal would fill without end
    lu->common.scale = -1; // the rows are of one size: solve/scaled.c
    lu->order = analyse(lu);
    // an entry of a factor has a number and an index; growing them copies them
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

/* Rows and columns are ordered alike and L has a diagonal of ones. */
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
