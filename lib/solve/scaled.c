/* solve/scaled.c: see solve/scaled.h. */
#include "solve/scaled.h"

#include "problem/assembly.h"
#include "problem/sweep.h"

#include <stdlib.h>
#include <string.h>

int scaled_assemble(struct delassus *W, const struct problem *p, struct why *why)
{
    struct assembly A = { 0 };
    struct stored S = { 0 };
    struct sparse entries = { 0 };
    double *mu = calloc((size_t)p->n + 1, sizeof *mu);
    if (!mu) return why_set(why, EX_SOFTWARE, "out of memory");
    for (int64_t i = 0; i < p->slots; i++)
        if (p->contact[i] >= 0) mu[p->contact[i]] = slot_bundle(p, i)->mu[slot_lane(i)];
    int e = assembly_init(&A, p, why);
    if (!e) e = assembly_W(&A, &S, why);
    if (!e) e = sparse_unpack(&entries, &S, "W", why);
    if (!e)
        e = delassus_init(W, p->d, p->n, entries.count, entries.row, entries.col, entries.x, A.q,
                          mu, why);
    assembly_free(&A), sparse_free(&entries), stored_free(&S), free(mu);
    return e;
}

static double *copy(const double *x, int64_t n)
{
    double *y = malloc((size_t)(n + 4) * sizeof *y);
    if (y && n) memcpy(y, x, (size_t)n * sizeof *y);
    return y;
}

/* A W of our own, whoever the other belongs to */
static int borrow(struct delassus *W, const struct delassus *V, struct why *why)
{
    int64_t blocks = V->first[V->n], d = V->d, n = V->n;
    *W = (struct delassus){ .d = V->d, .n = n };
    W->first = calloc((size_t)n + 1, sizeof *W->first);
    W->col = malloc((size_t)(blocks + 1) * sizeof *W->col);
    W->block = copy(V->block, blocks * d * d), W->diag = copy(V->diag, 9 * n);
    W->q = copy(V->q, n * d), W->mu = copy(V->mu, n), W->r = copy(V->r, n * d);
    if (!W->first || !W->col || !W->block || !W->diag || !W->q || !W->mu || !W->r)
        return why_set(why, EX_SOFTWARE, "out of memory");
    memcpy(W->first, V->first, (size_t)(n + 1) * sizeof *W->first);
    if (blocks) memcpy(W->col, V->col, (size_t)blocks * sizeof *W->col);
    return 0;
}

static void scale(struct scaled *w)
{
    struct delassus *W = &w->W;
    int d = W->d, dd = d * d;
    double trace = 0;
    for (int64_t c = 0; c < W->n; c++) {
        double lambda = local_lambda_max(W->diag + 9 * c);
        w->s[c] = lambda > 0 ? 1 / sqrt(lambda) : 1;
    }
    for (int64_t c = 0; c < W->n; c++) {
        for (int k = 0; k < 9; k++) W->diag[9 * c + k] *= w->s[c] * w->s[c];
        for (int k = 0; k < d; k++) W->q[d * c + k] *= w->s[c], trace += W->diag[9 * c + 4 * k];
        for (int64_t e = W->first[c]; e < W->first[c + 1]; e++)
            for (int k = 0; k < dd; k++) W->block[dd * e + k] *= w->s[c] * w->s[W->col[e]];
    }
    w->mean = trace > 0 ? trace / w->size : 1;
}

int scaled_init(struct scaled *w, const struct problem *p, struct why *why)
{
    *w = (struct scaled){ 0 };
    if (p->n > INT32_MAX / 3) return why_set(why, EX_DATAERR, "too many contacts");
    int e = p->W ? borrow(&w->W, p->W, why) : scaled_assemble(&w->W, p, why);
    if (e) return e;
    struct delassus *W = &w->W;
    if ((W->first[W->n] + W->n) * W->d * W->d > INT32_MAX)
        return why_set(why, EX_DATAERR, "too many blocks");
    w->size = (int32_t)(W->n * W->d);
    w->s = malloc((size_t)(W->n + 1) * sizeof *w->s);
    w->zero = calloc((size_t)w->size + 4, sizeof *w->zero);
    if (!w->s || !w->zero) return why_set(why, EX_SOFTWARE, "out of memory");
    scale(w);
    return 0;
}

void scaled_free(struct scaled *w)
{
    delassus_free(&w->W);
    free(w->s), free(w->zero);
    *w = (struct scaled){ 0 };
}

void scaled_get(const struct scaled *w, const struct problem *p, double *x)
{
    for (int64_t i = 0; i < p->slots; i++) {
        double r[3], u[3];
        int64_t c = p->contact[i];
        if (c < 0) continue;
        slot_get(p, i, r, u);
        for (int k = 0; k < p->d; k++) x[p->d * c + k] = r[k] / w->s[c];
    }
}

void scaled_put(const struct scaled *w, struct problem *p, const double *x)
{
    for (int64_t i = 0; i < p->slots; i++) {
        double r[3];
        int64_t c = p->contact[i];
        if (c < 0) continue;
        scaled_load(p->d, x + p->d * c, r);
        for (int k = 0; k < 3; k++) r[k] *= w->s[c];
        slot_react(p, i, r);
    }
    sweep_widest()->velocities(p, 0, p->bundles);
}

/* v = W x + q */
static void multiply(const struct delassus *W, const double *x, const double *q, double *v)
{
    int d = W->d;
    for (int64_t c = 0; c < W->n; c++) {
        double b[4];
        delassus_gather(W, c, q, x, b);
        for (int i = 0; i < d; i++) {
            v[d * c + i] = b[i];
            for (int j = 0; j < d; j++) v[d * c + i] += W->diag[9 * c + 3 * i + j] * x[d * c + j];
        }
    }
}

void scaled_velocity(const struct scaled *w, const double *x, double *v)
{
    multiply(&w->W, x, w->W.q, v);
}

void scaled_product(const struct scaled *w, const double *x, double *v)
{
    multiply(&w->W, x, w->zero, v);
}

double scaled_natural(const struct scaled *w, const double *x, const double *v)
{
    double off = 0, size = 0;
    int d = w->W.d;
    for (int64_t c = 0; c < w->W.n; c++) {
        double r[3], u[3], tau[3], p[3];
        scaled_load(d, x + d * c, r), scaled_load(d, v + d * c, u);
        cone_predict(w->W.mu[c], 1, r, u, tau);
        cone_project(w->W.mu[c], tau, p);
        for (int k = 0; k < 3; k++) off += (r[k] - p[k]) * (r[k] - p[k]), size += r[k] * r[k];
    }
    return size > 0 ? sqrt(off / size) : off > 0 ? 1 : 0;
}
