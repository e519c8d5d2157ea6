/* solve/bonded.c: M + H K H^T, condensed [solve/bonded.h]. */
#include "solve/bonded.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define GB 1e9 /* bytes */

static int bonded_check_memory(const struct problem *p, struct failure *failure)
{
    double entries = (double)p->n * (double)p->n * p->d * p->d, need = 3 * 16 * entries;
    double have = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    if (need <= have) return 0;
    return failure_set(failure, EX_SOFTWARE,
                   "the bonds couple %lld contacts: needs %.3g GB, the machine has %.3g; "
                   "--global auto, anderson and nlgs need no W, nor does --fclib=global",
                   (long long)p->n, need / GB, have / GB);
}

/* K and a of component j (0 to d-1) of contact c */
static double stiffness(const struct assembly *A, int64_t c, int j)
{
    int64_t i = A->slot[c];
    return A->p->extra[i / BUNDLE].K[j > 0][slot_lane(i)];
}
static double prestress(const struct assembly *A, int64_t c, int j)
{
    int64_t i = A->slot[c];
    return A->p->extra[i / BUNDLE].a[j][slot_lane(i)];
}

/* M += H K H^T, f -= H (a + K w); false when memory is short. */
static bool prepare_add_bonds(const struct assembly *A, struct global *P)
{
    struct lists of;
    int d = A->p->d;
    bool good = lists_init(&of, P->H.n, P->H.count, P->H.col);
    if (!good) return false;
    for (int64_t col = 0; good && col < P->H.n; col++) {
        int64_t c = col / d, from = of.first[col], to = of.first[col + 1];
        double K = stiffness(A, c, (int)(col % d)), a = prestress(A, c, (int)(col % d));
        for (int64_t k = from; good && k < to && (K > 0 || a != 0); k++) {
            int64_t e = of.item[k];
            P->f[P->H.row[e]] -= P->H.x[e] * (a + K * A->w[col]);
            for (int64_t l = from; good && l < to; l++) {
                int64_t g = of.item[l];
                good = sparse_add(&P->M, P->H.row[e], P->H.row[g], K * P->H.x[e] * P->H.x[g]);
            }
        }
    }
    lists_free(&of);
    return good;
}

int bonded_global(const struct assembly *A, struct global *P, struct failure *failure)
{
    struct stored M = { 0 }, H = { 0 };
    *P = (struct global){ 0 };
    int e = assembly_MH(A, &M, &H, &P->f, failure);
    P->nv = M.n;
    if (!e) e = sparse_unpack(&P->M, &M, "M", failure) || sparse_unpack(&P->H, &H, "H", failure);
    if (!e && !prepare_add_bonds(A, P)) failure_set(failure, EX_SOFTWARE, "no memory for the bonds");
    stored_free(&M), stored_free(&H);
    return failure->status;
}

int bonded_local(const struct assembly *A, struct sparse *W, double *q, struct failure *failure)
{
    struct global P = { 0 };
    struct motion U = { 0 };
    *W = (struct sparse){ 0 };
    int e = bonded_check_memory(A->p, failure);
    if (!e) e = bonded_global(A, &P, failure);
    if (!e) memcpy(q, A->w, (size_t)(A->p->n * A->p->d) * sizeof *q);
    if (!e) e = condense(&P, &U, W, q, failure);
    global_free(&P), motion_free(&U);
    return e;
}

static int prepare_fill(const struct assembly *A, struct delassus *W, struct failure *failure)
{
    struct sparse w = { 0 };
    int64_t n = A->p->n, d = A->p->d;
    double *q = malloc((size_t)(n * d + 1) * sizeof *q);
    int e = q ? 0 : failure_set(failure, EX_SOFTWARE, "no memory for the bonds");
    if (!e) e = bonded_local(A, &w, q, failure);
    if (!e) e = delassus_init(W, (int)d, n, &w, failure);
    if (!e) memcpy(W->q, q, (size_t)(n * d) * sizeof *q);
    for (int64_t c = 0; !e && c < n; c++)
        W->mu[c] = slot_bundle(A->p, A->slot[c])->mu[slot_lane(A->slot[c])];
    free(q);
    sparse_free(&w);
    return e;
}

int bonded_blocks(const struct problem *bodies, struct delassus *W, struct failure *failure)
{
    struct assembly A;
    int e = assembly_init(&A, bodies, failure);
    if (!e) e = prepare_fill(&A, W, failure);
    assembly_free(&A);
    return e;
}
