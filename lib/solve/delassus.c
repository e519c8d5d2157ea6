/* solve/delassus.c: W made, its rows reordered, subsets of it, W x [solve/delassus.h]. */
#include "solve/delassus.h"

#include <stdlib.h>
#include <string.h>

/* to[entries] = order[] (NULL: 0, 1, 2 ...), sorted stably by the block of W that index[] lies in: a
   counting sort, with work space tally[W->n + 1] */
static void sort_by_block(const struct delassus *W, int64_t entries, const int32_t *index,
                          const int64_t *order, int64_t *to, int64_t *tally)
{
    const int d = W->d;
    const int64_t n = W->n;
    memset(tally, 0, (size_t)(n + 1) * sizeof *tally);
    for (int64_t k = 0; k < entries; k++) tally[index[k] / d + 1]++;
    for (int64_t c = 0; c < n; c++) tally[c + 1] += tally[c];
    for (int64_t k = 0; k < entries; k++) {
        int64_t e = order ? order[k] : k;
        to[tally[index[e] / d]++] = e;
    }
}

bool delassus_block_counts(int d, const double *B)
{
    for (int k = 0; k < d * d; k++)
        if (B[k] != 0) return true;
    return false;
}

void delassus_set_diag(struct delassus *W, int64_t c, const double *B)
{
    int d = W->d;
    double *D = W->diag + 9 * c;
    for (int j = 0; j < d; j++)
        for (int i = 0; i < d; i++) D[i + 3 * j] = B[i + d * j];
    if (d == 2) D[8] = D[4] > 0 ? D[4] : 1;
}

/* Puts the entries, taken in this order, into W block by block; its arrays have room for all. */
static void gather_blocks(struct delassus *W, const struct sparse *A, const int64_t *order)
{
    const int64_t entries = A->count;
    const int32_t *row = A->row, *col = A->col;
    const double *x = A->x;
    int d = W->d, dd = d * d;
    int64_t blocks = 0;
    for (int64_t k = 0; k < entries;) {
        int64_t c = row[order[k]] / d, b = col[order[k]] / d;
        double B[9] = { 0 };
        for (; k < entries && row[order[k]] / d == c && col[order[k]] / d == b; k++)
            B[row[order[k]] % d + d * (col[order[k]] % d)] += x[order[k]];
        if (b == c) {
            delassus_set_diag(W, c, B);
        } else if (delassus_block_counts(d, B)) {
            memcpy(W->block + dd * blocks, B, (size_t)dd * sizeof *B);
            W->col[blocks++] = (int32_t)b;
            W->first[c + 1]++;
        }
    }
    for (int64_t c = 0; c < W->n; c++) W->first[c + 1] += W->first[c];
}

static int64_t count_blocks(const struct sparse *A, const int64_t *order, int d)
{
    const int32_t *row = A->row, *col = A->col;
    int64_t blocks = 0;
    for (int64_t k = 0; k < A->count; k++) {
        int64_t e = order[k], f = k ? order[k - 1] : e;
        blocks += k == 0 || row[e] / d != row[f] / d || col[e] / d != col[f] / d;
    }
    return blocks;
}

static int delassus_no_memory(struct delassus *W, int64_t n, struct failure *failure)
{
    delassus_free(W);
    failure_set(failure, EX_SOFTWARE, "out of memory for a problem of %lld contacts", (long long)n);
    return EX_SOFTWARE;
}

int delassus_alloc(struct delassus *W, int d, int64_t n, int64_t blocks, struct failure *failure)
{
    *W = (struct delassus){ .d = d, .n = n };
    W->first = calloc((size_t)(n + 1), sizeof *W->first);
    W->col = malloc((size_t)(blocks + 1) * sizeof *W->col);
    W->block = calloc((size_t)(blocks + 1) * (size_t)(d * d) + 4, sizeof *W->block);
    W->diag = calloc((size_t)(n + 1) * 9, sizeof *W->diag);
    W->q = calloc((size_t)(n * d + 1), sizeof *W->q);
    W->mu = calloc((size_t)(n + 1), sizeof *W->mu);
    W->r = calloc((size_t)(n * d + 1), sizeof *W->r);
    bool room = W->first && W->col && W->block && W->diag && W->q && W->mu && W->r;
    return room ? 0 : delassus_no_memory(W, n, failure);
}

int delassus_alloc_common(struct delassus *W, int common, struct failure *failure)
{
    W->J = calloc((size_t)(W->n * W->d * common) + 1, sizeof *W->J);
    if (!W->J) return delassus_no_memory(W, W->n, failure);
    W->common = common;
    return 0;
}

int delassus_init(struct delassus *W, int d, int64_t n, const struct sparse *A,
                  struct failure *failure)
{
    const int64_t entries = A->count;
    *W = (struct delassus){ .d = d, .n = n };
    int64_t *tally = malloc((size_t)(n + 1) * sizeof *tally);
    int64_t *half = malloc((size_t)(entries + 1) * sizeof *half);
    int64_t *order = malloc((size_t)(entries + 1) * sizeof *order);
    int e = tally && half && order ? 0 : delassus_no_memory(W, n, failure);
    if (!e) { // by column, then stably by row
        sort_by_block(W, entries, A->col, NULL, half, tally);
        sort_by_block(W, entries, A->row, half, order, tally);
        e = delassus_alloc(W, d, n, count_blocks(A, order, d), failure);
    }
    if (!e) {
        const double none[9] = { 0 };
        for (int64_t c = 0; c < n; c++) delassus_set_diag(W, c, none);
        gather_blocks(W, A, order);
    }
    free(tally), free(half), free(order);
    return e;
}

void delassus_free(struct delassus *W)
{
    free(W->first), free(W->col), free(W->block), free(W->diag);
    free(W->q), free(W->mu), free(W->r), free(W->J);
    *W = (struct delassus){ 0 };
}

int delassus_sort(struct delassus *to, const struct delassus *W, int64_t rows, const int32_t *row,
                  struct failure *failure)
{
    int d = W->d, dd = d * d;
    size_t blocks = (size_t)W->first[W->n];
    *to = (struct delassus){ .d = d, .n = rows };
    to->first = calloc((size_t)rows + 1, sizeof *to->first);
    to->col = malloc((blocks + 1) * sizeof *to->col);
    to->block = calloc((size_t)dd * blocks + 4, sizeof *to->block);
    to->q = calloc((size_t)(d * rows) + 1, sizeof *to->q);
    if (!to->first || !to->col || !to->block || !to->q) {
        delassus_free(to);
        return failure_set(failure, EX_SOFTWARE, "no memory for the blocks of W");
    }
    for (int64_t i = 0; i < rows; i++) {
        int64_t at = to->first[i + 1] = to->first[i], c = row[i];
        if (c < 0) continue;
        size_t n = (size_t)(W->first[c + 1] - W->first[c]);
        memcpy(to->col + at, W->col + W->first[c], n * sizeof *to->col);
        memcpy(to->block + dd * at, W->block + dd * W->first[c], n * (size_t)dd * sizeof(double));
        memcpy(to->q + d * i, W->q + d * c, (size_t)d * sizeof *to->q);
        to->first[i + 1] += (int64_t)n;
    }
    return 0;
}

/* y[d] -= B x[d], B by columns */
static void subtract_product(int d, const double *B, const double *x, double *y)
{
    for (int j = 0; j < d; j++)
        for (int i = 0; i < d; i++) y[i] -= B[d * j + i] * x[j];
}

/* q -= J J^T r */
static void subtract_common(struct delassus *W)
{
    double sum[COMMON_MAX] = { 0 };
    delassus_common(W, W->r, sum);
    for (int64_t i = 0; i < W->d * W->n; i++)
        for (int k = 0; k < W->common; k++) W->q[i] -= W->J[W->common * i + k] * sum[k];
}

int delassus_subset(struct delassus *to, const struct delassus *W,
                    const struct selection_contacts *chosen, const double *r, const double *v,
                    struct failure *failure)
{
    const int64_t n = chosen->n;
    const int32_t *contact = chosen->contact, *of = chosen->of;
    int d = W->d, dd = d * d;
    int64_t blocks = 0;
    for (int64_t i = 0; i < n; i++) blocks += W->first[contact[i] + 1] - W->first[contact[i]];
    if (delassus_alloc(to, d, n, blocks, failure)) return failure->status;
    if (W->common && delassus_alloc_common(to, W->common, failure)) return failure->status;
    const int64_t row = d * W->common; // numbers of J of a contact
    for (int64_t i = 0; i < n && row; i++)
        memcpy(to->J + row * i, W->J + row * contact[i], (size_t)row * sizeof *to->J);
    for (int64_t i = 0; i < n; i++) {
        int64_t c = contact[i], at = to->first[i];
        double *q = to->q + d * i;
        memcpy(q, v + d * c, (size_t)d * sizeof *q);
        memcpy(to->r + d * i, r + d * c, (size_t)d * sizeof *r);
        memcpy(to->diag + 9 * i, W->diag + 9 * c, 9 * sizeof *W->diag);
        to->mu[i] = W->mu[c];
        for (int k = 0; k < d; k++)
            for (int j = 0; j < d; j++) q[k] -= W->diag[9 * c + k + 3 * j] * r[d * c + j];
        for (int64_t e = W->first[c]; e < W->first[c + 1]; e++) {
            int32_t b = W->col[e];
            if (of[b] < 0) continue;
            subtract_product(d, W->block + dd * e, r + d * b, q);
            to->col[at] = of[b];
            memcpy(to->block + dd * at++, W->block + dd * e, (size_t)dd * sizeof(double));
        }
        to->first[i + 1] = at;
    }
    subtract_common(to);
    return 0;
}

void delassus_apply(const struct delassus *W, const double *x, const double *q, double *v)
{
    int d = W->d;
    double sum[COMMON_MAX] = { 0 };
    delassus_common(W, x, sum);
    for (int64_t c = 0; c < W->n; c++) {
        const double *D = W->diag + 9 * c;
        double b[4];
        delassus_gather(W, c, q, x, b);
        for (int i = 0; i < d; i++) {
            v[d * c + i] = b[i];
            for (int j = 0; j < d; j++) v[d * c + i] += D[i + 3 * j] * x[d * c + j];
            for (int k = 0; k < W->common; k++)
                v[d * c + i] += W->J[W->common * (d * c + i) + k] * sum[k];
        }
    }
}

void delassus_common(const struct delassus *W, const double *x, double *sum)
{
    for (int k = 0; k < W->common; k++) sum[k] = 0;
    for (int64_t i = 0; i < W->d * W->n; i++)
        for (int k = 0; k < W->common; k++) sum[k] += W->J[W->common * i + k] * x[i];
}

void delassus_own(const struct delassus *W, int64_t c, double times, double D[9])
{
    const int d = W->d;
    memcpy(D, W->diag + 9 * c, 9 * sizeof *D);
    for (int k = 0; k < W->common; k++)
        for (int j = 0; j < d; j++)
            for (int i = 0; i < d; i++)
                D[i + 3 * j] +=
                    times * W->J[W->common * (d * c + i) + k] * W->J[W->common * (d * c + j) + k];
}
