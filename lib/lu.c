/* lu.c: see lu.h. KLU wants columns: it factorises the transpose of what it is given by rows. */
#include "lu.h"

#include <stdlib.h>
#include <suitesparse/klu.h>

struct lu {
    int32_t n, *first, *col;
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

struct lu *lu_new(int32_t n, int32_t *first, int32_t *col, double bytes)
{
    struct lu *lu = calloc(1, sizeof *lu);
    if (!lu) return NULL;
    lu->n = n, lu->first = first, lu->col = col;
    klu_defaults(&lu->common);
    lu->common.btf = 0; // one block: the pattern is a contact graph's
    lu->common.tol = 0; // pivots off the diagonal would fill without end
    lu->order = klu_analyze(n, first, col, &lu->common);
    // an entry of a factor has a number and an index; growing them copies them
    if (lu->order && 24 * (lu->order->lnz + lu->order->unz) <= bytes) return lu;
    lu_free(lu);
    return NULL;
}

double lu_cost(const struct lu *lu)
{
    // as if the fill were spread evenly over the columns
    return lu->order->lnz * lu->order->unz / lu->n;
}

bool lu_factorise(struct lu *lu, double *a)
{
    klu_common *c = &lu->common;
    if (lu->factors) return klu_refactor(lu->first, lu->col, a, lu->order, lu->factors, c);
    lu->factors = klu_factor(lu->first, lu->col, a, lu->order, c);
    return lu->factors != NULL;
}

bool lu_substitute(struct lu *lu, double *x)
{
    return lu->factors && klu_tsolve(lu->order, lu->factors, lu->n, 1, x, &lu->common);
}
