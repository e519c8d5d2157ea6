/* lu.c: see lu.h. KLU wants columns: it factorises the transpose of what it is given by rows. */
#include "lu.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <suitesparse/klu.h>

struct lu {
    int32_t n, *first, *col;
    double *a;     /* of the last matrix, borrowed */
    double *b, *r; /* [n] */
    klu_common common;
    klu_symbolic *order;
    klu_numeric *factors;
};

void lu_free(struct lu *lu)
{
    if (!lu) return;
    if (lu->factors) klu_free_numeric(&lu->factors, &lu->common);
    if (lu->order) klu_free_symbolic(&lu->order, &lu->common);
    free(lu->b), free(lu->r), free(lu);
}

struct lu *lu_new(int32_t n, int32_t *first, int32_t *col, double bytes)
{
    struct lu *lu = calloc(1, sizeof *lu);
    if (!lu) return NULL;
    lu->n = n, lu->first = first, lu->col = col;
    klu_defaults(&lu->common);
    lu->common.btf = 0; // one block: the pattern is a contact graph's
    lu->common.tol = 0; // pivots off the diagonal would fill without end
    lu->b = malloc(((size_t)n + 1) * sizeof *lu->b);
    lu->r = malloc(((size_t)n + 1) * sizeof *lu->r);
    lu->order = lu->b && lu->r ? klu_analyze(n, first, col, &lu->common) : NULL;
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

/* r = b - A x; returns |r| / |b|, the largest entries */
static double residual(struct lu *lu, const double *x)
{
    double worst = 0, size = 0;
    for (int32_t i = 0; i < lu->n; i++) {
        double s = lu->b[i];
        for (int32_t k = lu->first[i]; k < lu->first[i + 1]; k++) s -= lu->a[k] * x[lu->col[k]];
        lu->r[i] = s;
        worst = fmax(worst, fabs(s)), size = fmax(size, fabs(lu->b[i]));
        if (isnan(s)) return NAN;
    }
    return size > 0 ? worst / size : 0;
}

/* b into x, refined where that is of use; false: the factors are no good. */
static bool substitute(struct lu *lu, double *x)
{
    memcpy(x, lu->b, (size_t)lu->n * sizeof *x);
    if (!klu_tsolve(lu->order, lu->factors, lu->n, 1, x, &lu->common)) return false;
    double e = residual(lu, x);
    for (int k = 0; k < 3 && e > 1e-14 && e < 0.1; k++) {
        klu_tsolve(lu->order, lu->factors, lu->n, 1, lu->r, &lu->common);
        for (int32_t i = 0; i < lu->n; i++) x[i] += lu->r[i];
        double before = e;
        e = residual(lu, x);
        if (!(e < before / 4)) break;
    }
    return e < 1e-4;
}

bool lu_solve(struct lu *lu, double *a, double *x)
{
    klu_common *c = &lu->common;
    lu->a = a;
    memcpy(lu->b, x, (size_t)lu->n * sizeof *x);
    if (!lu->factors)
        lu->factors = klu_factor(lu->first, lu->col, a, lu->order, c);
    else if (!klu_refactor(lu->first, lu->col, a, lu->order, lu->factors, c))
        return false;
    return lu->factors && substitute(lu, x);
}

bool lu_again(struct lu *lu, double *x)
{
    memcpy(lu->b, x, (size_t)lu->n * sizeof *x);
    return substitute(lu, x);
}
