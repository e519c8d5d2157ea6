/* solve/scaled.c: the scaled W, vectors in its units, and the natural map [solve/scaled.h]. */
#include "solve/scaled.h"

#include "solve/assembly.h"
#include "solve/device.h"

#include <stdlib.h>
#include <string.h>

int scaled_assemble(struct delassus *W, const struct problem *p, struct failure *failure)
{
    struct assembly A = { 0 };
    device_home((struct problem *)p, false);
    int e = assembly_init(&A, p, failure);
    if (!e) e = assembly_blocks(&A, W, failure);
    assembly_free(&A);
    return e;
}

static double *scaled_copy(const double *x, int64_t n)
{
    double *y = malloc((size_t)(n + 4) * sizeof *y);
    if (y && n) memcpy(y, x, (size_t)n * sizeof *y);
    return y;
}

/* W = a deep copy of V; to be freed in any case */
static int copy_W(struct delassus *W, const struct delassus *V, struct failure *failure)
{
    int64_t blocks = V->first[V->n], d = V->d, n = V->n;
    *W = (struct delassus){ .d = V->d, .n = n };
    W->first = calloc((size_t)n + 1, sizeof *W->first);
    W->col = malloc((size_t)(blocks + 1) * sizeof *W->col);
    W->block = scaled_copy(V->block, blocks * d * d), W->diag = scaled_copy(V->diag, 9 * n);
    W->q = scaled_copy(V->q, n * d), W->mu = scaled_copy(V->mu, n), W->r = scaled_copy(V->r, n * d);
    W->common = V->common;
    if (W->common) W->J = scaled_copy(V->J, n * d * W->common);
    if (!W->first || !W->col || !W->block || !W->diag || !W->q || !W->mu || !W->r ||
        (W->common && !W->J))
        return failure_set(failure, EX_SOFTWARE, "out of memory");
    memcpy(W->first, V->first, (size_t)(n + 1) * sizeof *W->first);
    if (blocks) memcpy(W->col, V->col, (size_t)blocks * sizeof *W->col);
    return 0;
}

static void scale(struct scaled *a)
{
    struct delassus *W = &a->W;
    int d = W->d, dd = d * d;
    double trace = 0;
    for (int64_t c = 0; c < W->n; c++) {
        double D[9];
        delassus_own(W, c, 1, D);
        double lambda = local_lambda_max(D);
        a->s[c] = lambda > 0 ? 1 / sqrt(lambda) : 1;
    }
    for (int64_t c = 0; c < W->n; c++) {
        for (int k = 0; k < 9; k++) W->diag[9 * c + k] *= a->s[c] * a->s[c];
        for (int k = 0; k < d; k++) W->q[d * c + k] *= a->s[c], trace += W->diag[9 * c + 4 * k];
        for (int k = 0; k < d * W->common; k++) W->J[d * W->common * c + k] *= a->s[c];
        for (int64_t e = W->first[c]; e < W->first[c + 1]; e++)
            for (int k = 0; k < dd; k++) W->block[dd * e + k] *= a->s[c] * a->s[W->col[e]];
    }
    a->mean = trace > 0 ? trace / a->size : 1;
}

int scaled_init(struct scaled *a, const struct problem *p, struct failure *failure)
{
    *a = (struct scaled){ 0 };
    if (p->n > INT32_MAX / 3) return failure_set(failure, EX_DATAERR, "too many contacts");
    int e = p->W ? copy_W(&a->W, p->W, failure) : scaled_assemble(&a->W, p, failure);
    if (e) return e;
    struct delassus *W = &a->W;
    if ((W->first[W->n] + W->n) * W->d * W->d > INT32_MAX)
        return failure_set(failure, EX_DATAERR, "too many blocks");
    a->size = (int32_t)(W->n * W->d);
    a->s = malloc((size_t)(W->n + 1) * sizeof *a->s);
    a->zero = calloc((size_t)a->size + 4, sizeof *a->zero);
    a->r = calloc(3 * (size_t)p->slots + 1, sizeof *a->r);
    if (!a->s || !a->zero || !a->r) return failure_set(failure, EX_SOFTWARE, "out of memory");
    scale(a);
    return 0;
}

void scaled_free(struct scaled *a)
{
    delassus_free(&a->W);
    free(a->s), free(a->zero), free(a->r);
    *a = (struct scaled){ 0 };
}

void scaled_get(const struct scaled *a, const struct problem *p, double *x)
{
    device_home((struct problem *)p, false);
    for (int64_t i = 0; i < p->slots; i++) {
        double r[3], u[3];
        int64_t c = p->contact[i];
        if (c < 0) continue;
        slot_get(p, i, r, u);
        for (int k = 0; k < p->d; k++) x[p->d * c + k] = r[k] / a->s[c];
    }
}

double scaled_put(struct scaled *a, struct solve *s, const double *x)
{
    const struct problem *p = s->p;
    for (int64_t i = 0; i < p->slots; i++) {
        double r[3];
        int64_t c = p->contact[i];
        if (c < 0) continue;
        scaled_load(p->d, x + p->d * c, r);
        for (int k = 0; k < 3; k++) a->r[3 * i + k] = r[k] * a->s[c];
    }
    solve_react(s, a->r);
    return solve_judge(s);
}

void scaled_velocity(const struct scaled *a, const double *x, double *v)
{
    delassus_apply(&a->W, x, a->W.q, v);
}

void scaled_product(const struct scaled *a, const double *x, double *v)
{
    delassus_apply(&a->W, x, a->zero, v);
}

/* |x_c - P(x_c - v^_c)|^2, and in *size |x_c|^2 */
static double scaled_natural2(const struct scaled *a, int64_t c, const double *x, const double *v,
                              double *size)
{
    int d = a->W.d;
    double r[3], u[3], tau[3], p[3], off = 0;
    scaled_load(d, x + d * c, r), scaled_load(d, v + d * c, u);
    cone_predict(a->W.mu[c], 1, r, u, tau);
    cone_project(a->W.mu[c], tau, p);
    *size = 0;
    for (int k = 0; k < 3; k++) off += (r[k] - p[k]) * (r[k] - p[k]), *size += r[k] * r[k];
    return off;
}

double scaled_natural_of(const struct scaled *a, int64_t c, const double *x, const double *v)
{
    double size;
    return sqrt(scaled_natural2(a, c, x, v, &size));
}

double scaled_natural(const struct scaled *a, const double *x, const double *v)
{
    double off = 0, size = 0, one;
    for (int64_t c = 0; c < a->W.n; c++) off += scaled_natural2(a, c, x, v, &one), size += one;
    return size > 0 ? sqrt(off / size) : off > 0 ? 1 : 0;
}
