/* base/matrix.c: Jacobi's method, with square roots alone [base/matrix.h]. */
#include "base/matrix.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <suitesparse/cholmod.h>
#include <suitesparse/klu.h>

/* Times through all pairs: it converges quadratically, and fewer serve for six rows. */
enum { ROUNDS = 8 };

/* Turns rows and columns p and q so that S[p][q] becomes 0. */
static inline void matrix_rotate(int n, double S[EIGEN_MOST][EIGEN_MOST], int p, int q)
{
    double h = 0.5 * (S[q][q] - S[p][p]) / S[p][q];
    double t = copysign(1 / (fabs(h) + sqrt(1 + h * h)), h), c = 1 / sqrt(1 + t * t), s = t * c;
    S[p][p] -= t * S[p][q], S[q][q] += t * S[p][q];
    S[p][q] = S[q][p] = 0;
    for (int k = 0; k < n; k++) {
        if (k == p || k == q) continue;
        double a = S[k][p], b = S[k][q];
        S[k][p] = S[p][k] = c * a - s * b;
        S[k][q] = S[q][k] = s * a + c * b;
    }
}

/* Is what is beside the diagonal so small that no rotation changes the largest entry of the diagonal, not even in
   its last bit? */
static inline bool settled(int n, double S[EIGEN_MOST][EIGEN_MOST])
{
    double most = 0, beside = 0;
    for (int i = 0; i < n; i++)
        for (int j = 0; j <= i; j++) {
            double *to = i == j ? &most : &beside;
            *to = fmax(*to, fabs(S[i][j]));
        }
    return beside <= 1e-20 * most;
}

/* Pairs one apart, then two apart ..., round the corner */
static inline double eigen_jacobi(int n, const double *A)
{
    double S[EIGEN_MOST][EIGEN_MOST] = { { 0 } }, most;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) S[i][j] = 0.5 * (A[n * i + j] + A[n * j + i]);
    for (int round = 0; round < ROUNDS && !settled(n, S); round++)
        for (int apart = 1; apart <= n / 2; apart++)
            for (int k = 1; k <= n; k++) {
                int p = k % n, q = (k + apart) % n;
                if (S[p][q] != 0) matrix_rotate(n, S, p, q);
            }
    most = S[0][0];
    for (int i = 1; i < n; i++) most = fmax(most, S[i][i]);
    return most;
}

double eigen_largest(int n, const double *A)
{
    return n == 3 ? eigen_jacobi(3, A) : eigen_jacobi(n, A); // contacts' matrices in straight code
}

/* Entries, the checks of stored matrices, and lists by owner. */

bool sparse_add(struct sparse *A, int64_t row, int64_t col, double x)
{
    if (A->count == A->room) {
        int64_t room = 2 * A->room + 64;
        int32_t *r = realloc(A->row, (size_t)room * sizeof *r);
        if (r) A->row = r;
        int32_t *c = realloc(A->col, (size_t)room * sizeof *c);
        if (c) A->col = c;
        double *v = realloc(A->x, (size_t)room * sizeof *v);
        if (v) A->x = v;
        if (!r || !c || !v) return false;
        A->room = room;
    }
    A->row[A->count] = (int32_t)row, A->col[A->count] = (int32_t)col, A->x[A->count++] = x;
    return true;
}

void sparse_free(struct sparse *A)
{
    free(A->row);
    free(A->col);
    free(A->x);
    *A = (struct sparse){ 0 };
}

bool stored_init(struct stored *S, int64_t m, int64_t n, int32_t nz, int64_t count)
{
    uint64_t lines = (uint64_t)(nz == -2 ? m : n) + 1;
    *S = (struct stored){ (int32_t)m, (int32_t)n, nz, (int32_t)count, .np = lines };
    S->ni = S->nx = (uint64_t)count;
    S->p = calloc(lines, sizeof *S->p);
    S->i = malloc((size_t)(count + 1) * sizeof *S->i);
    S->x = malloc((size_t)(count + 1) * sizeof *S->x);
    return S->p && S->i && S->x;
}

void stored_free(struct stored *S)
{
    free(S->p);
    free(S->i);
    free(S->x);
    *S = (struct stored){ 0 };
}

/* p of a compressed matrix begins at 0, never decreases and has lines + 1 values. */
static int check_pointers(const struct stored *S, const char *name, int32_t lines,
                          struct failure *failure)
{
    if (S->np != (uint64_t)lines + 1)
        return failure_set(failure, EX_DATAERR, "%s/p: %llu pointers, %lld are needed", name,
                           (unsigned long long)S->np, lines + 1LL);
    if (S->p[0] != 0)
        return failure_set(failure, EX_DATAERR, "%s/p: begins with %d, not 0", name, S->p[0]);
    for (int32_t k = 0; k < lines; k++)
        if (S->p[k + 1] < S->p[k])
            return failure_set(failure, EX_DATAERR, "%s/p: falls from %d to %d at entry %lld", name,
                               S->p[k], S->p[k + 1], k + 1LL);
    return 0;
}

/* i, x and, of triplets, p have at least count and at most nzmax values. */
static int check_lengths(const struct stored *S, const char *name, int64_t count,
                         struct failure *failure)
{
    if (S->nzmax < count)
        return failure_set(failure, EX_DATAERR, "%s/nzmax: is %d and there are %lld entries", name,
                           S->nzmax, (long long)count);
    const struct {
        const char *name;
        uint64_t length;
    } of[] = { { "i", S->ni }, { "x", S->nx }, { "p", S->nz < 0 ? S->ni : S->np } };
    for (int k = 0; k < 3; k++)
        if (of[k].length < (uint64_t)count || of[k].length > (uint64_t)S->nzmax)
            return failure_set(failure, EX_DATAERR, "%s/%s: %llu values for %lld entries, nzmax %d",
                               name, of[k].name, (unsigned long long)of[k].length, (long long)count,
                               S->nzmax);
    return 0;
}

static int check_entries(const struct sparse *A, bool by_rows, const char *name,
                         struct failure *failure)
{
    const char *row = by_rows ? "p" : "i", *col = by_rows ? "i" : "p";
    const char *letter = strrchr(name, '/') ? strrchr(name, '/') + 1 : name;
    for (int64_t k = 0; k < A->count; k++) {
        if (A->row[k] < 0 || A->row[k] >= A->m)
            return failure_set(failure, EX_DATAERR, "%s/%s: entry %lld is %d, %s has %lld rows",
                               name, row, (long long)k, A->row[k], letter, (long long)A->m);
        if (A->col[k] < 0 || A->col[k] >= A->n)
            return failure_set(failure, EX_DATAERR, "%s/%s: entry %lld is %d, %s has %lld columns",
                               name, col, (long long)k, A->col[k], letter, (long long)A->n);
        if (!isfinite(A->x[k]))
            return failure_set(failure, EX_DATAERR, "%s/x: entry %lld is %g", name, (long long)k,
                               A->x[k]);
    }
    return 0;
}

/* The line (row or column) of every entry, from p of a compressed matrix; NULL: no memory */
static int32_t *lines_of_entries(const int32_t *p, int32_t lines)
{
    int32_t *line = calloc((size_t)p[lines] + 1, sizeof *line);
    for (int32_t l = 0; line && l < lines; l++)
        for (int32_t k = p[l]; k < p[l + 1]; k++) line[k] = l;
    return line;
}

int sparse_unpack(struct sparse *A, struct stored *S, const char *name, struct failure *failure)
{
    bool by_rows = S->nz == -2;
    int32_t lines = by_rows ? S->m : S->n;
    if (S->nz < -2)
        return failure_set(failure, EX_DATAERR, "%s/nz: %d is no form of storage", name, S->nz);
    if (S->nz < 0 && check_pointers(S, name, lines, failure)) return failure->status;
    int64_t count = S->nz < 0 ? S->p[lines] : S->nz;
    if (check_lengths(S, name, count, failure)) return failure->status;
    if (S->nz < 0) { // triplets, once p has the line of every entry
        int32_t *line = lines_of_entries(S->p, lines);
        if (!line) return failure_set(failure, EX_SOFTWARE, "%s: out of memory", name);
        free(S->p);
        S->p = line;
    }
    *A = (struct sparse){ S->m, S->n, count, count, by_rows ? S->p : S->i, by_rows ? S->i : S->p,
                          S->x };
    *S = (struct stored){ 0 };
    return check_entries(A, by_rows, name, failure);
}

bool lists_init(struct lists *L, int64_t n, int64_t count, const int32_t *owner)
{
    L->first = calloc((size_t)n + 2, sizeof *L->first);
    L->item = malloc((size_t)(count + 1) * sizeof *L->item);
    if (!L->first || !L->item) return lists_free(L), false;
    for (int64_t k = 0; k < count; k++)
        if (owner[k] >= 0) L->first[owner[k] + 2]++;
    for (int64_t o = 0; o < n; o++) L->first[o + 2] += L->first[o + 1];
    for (int64_t k = 0; k < count; k++)
        if (owner[k] >= 0) L->item[L->first[owner[k] + 1]++] = k;
    return true;
}

void lists_free(struct lists *L)
{
    free(L->first);
    free(L->item);
    *L = (struct lists){ 0 };
}

bool stored_columns(struct stored *S, const struct sparse *A)
{
    struct lists rows = { 0 };
    *S = (struct stored){ 0 };
    int32_t *last = malloc((size_t)(A->n + 1) * sizeof *last); // of a column: its last row so far
    bool good = A->count <= INT32_MAX && last && stored_init(S, A->m, A->n, -1, A->count) &&
                lists_init(&rows, A->m, A->count, A->row);
    // the columns' lengths, then their entries: both row by row, so that rows ascend
    for (int pass = 0; good && pass < 2; pass++) {
        for (int64_t j = 0; j < A->n; j++) last[j] = -1;
        for (int64_t i = 0; i < A->m; i++)
            for (int64_t k = rows.first[i]; k < rows.first[i + 1]; k++) {
                int64_t e = rows.item[k];
                int32_t j = A->col[e];
                bool new = last[j] != i;
                last[j] = (int32_t)i;
                if (pass == 0) {
                    S->p[j + 1] += new;
                    continue;
                }
                int32_t at = S->p[j + 1] - !new; // p[j + 1] is where the next entry goes
                S->i[at] = (int32_t)i, S->x[at] = new ? A->x[e] : S->x[at] + A->x[e];
                S->p[j + 1] += new;
            }
        // after the first pass p[j + 1] becomes the column's beginning, after the second its end
        for (int64_t j = 0, sum = 0; pass == 0 && j < A->n; j++) {
            int32_t length = S->p[j + 1];
            S->p[j + 1] = (int32_t)sum, sum += length;
        }
    }
    lists_free(&rows), free(last);
    return good;
}

/* Sparse LU by KLU, which takes columns: from our rows it factorises the transpose. */

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
