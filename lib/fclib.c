/* fclib.c: see fclib.h. What is read comes first, then the condensation, then what is written. */
#include "fclib.h"
#include "h5.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <suitesparse/umfpack.h>

/* A sparse m x n matrix, entries in any order; those of one place add up. */
struct sparse {
    int64_t m, n, count, room;
    int32_t *row, *col; /* [count] */
    double *x;
};

/* A problem as its file has it: local W, q; global M, H, G, f, w, b. */
struct raw {
    int d;
    int64_t n, nv, nl; /* contacts, unknowns, multipliers */
    struct sparse W, M, H, G;
    double *mu, *q, *f, *b; /* [n], [n d] (w of a global one), [nv], [nl] */
};

static int short_of_memory(struct why *why)
{
    why_set(why, EX_SOFTWARE, "out of memory for an FCLIB problem");
    return EX_SOFTWARE;
}

static void sparse_free(struct sparse *A)
{
    free(A->row);
    free(A->col);
    free(A->x);
    *A = (struct sparse){ 0 };
}

static bool sparse_add(struct sparse *A, int64_t row, int64_t col, double x)
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

/* Things that belong to n owners, listed by owner: those of o are item[first[o]] .. */
struct lists {
    int64_t *first; /* [n + 1] */
    int64_t *item;
};

static void lists_free(struct lists *L)
{
    free(L->first);
    free(L->item);
    *L = (struct lists){ 0 };
}

/* Things 0 .. count-1, owner[k] < n, or none if negative; each list ascends. */
static bool lists_init(struct lists *L, int64_t n, int64_t count, const int32_t *owner)
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

/* ---- in ---------------------------------------------------------------------------------- */

/* group/name */
static const char *join(char path[64], const char *group, const char *name)
{
    snprintf(path, 64, "%s/%s", group, name);
    return path;
}

/* count finite numbers; count < 0: however many there are, told in *found. To be freed. */
static double *read_vector(hid_t file, const char *group, const char *name, int64_t count,
                           int64_t *found, struct why *why)
{
    char path[64];
    hsize_t length;
    double *x = h5_read_all(file, join(path, group, name), H5T_NATIVE_DOUBLE, &length, why);
    if (!x) return NULL;
    if (count >= 0 && length != (hsize_t)count)
        why_set(why, EX_DATAERR, "%s: %llu values, %lld are wanted", path,
                (unsigned long long)length, (long long)count);
    for (hsize_t k = 0; k < length && !why->status; k++)
        if (!isfinite(x[k]))
            why_set(why, EX_DATAERR, "%s: entry %llu is %g", path, (unsigned long long)k, x[k]);
    if (found) *found = (int64_t)length;
    if (!why->status) return x;
    free(x);
    return NULL;
}

/* A matrix as it is stored, before anything of it is believed */
struct stored {
    int32_t m, n, nz, nzmax, *p, *i;
    double *x;
    hsize_t np, ni, nx; /* lengths of p, i, x */
};

static int stored_read(struct stored *S, hid_t file, const char *group, struct why *why)
{
    char path[64];
    int32_t *const number[] = { &S->m, &S->n, &S->nz, &S->nzmax };
    const char *const name[] = { "m", "n", "nz", "nzmax" };
    for (int k = 0; k < 4; k++)
        if (h5_read(file, join(path, group, name[k]), H5T_NATIVE_INT32, 1, number[k], why))
            return why->status;
    S->p = h5_read_all(file, join(path, group, "p"), H5T_NATIVE_INT32, &S->np, why);
    if (S->p) S->i = h5_read_all(file, join(path, group, "i"), H5T_NATIVE_INT32, &S->ni, why);
    if (S->i) S->x = h5_read_all(file, join(path, group, "x"), H5T_NATIVE_DOUBLE, &S->nx, why);
    return S->x ? 0 : why->status;
}

/* p of a compressed matrix: from 0, never falling, `lines` + 1 long */
static int check_pointers(const struct stored *S, const char *group, int32_t lines, struct why *why)
{
    if (S->np != (hsize_t)lines + 1)
        return why_set(why, EX_DATAERR, "%s/p: %llu pointers, %lld are wanted", group,
                       (unsigned long long)S->np, lines + 1LL);
    if (S->p[0] != 0)
        return why_set(why, EX_DATAERR, "%s/p: begins with %d, not 0", group, S->p[0]);
    for (int32_t k = 0; k < lines; k++)
        if (S->p[k + 1] < S->p[k])
            return why_set(why, EX_DATAERR, "%s/p: falls from %d to %d at entry %lld", group,
                           S->p[k], S->p[k + 1], k + 1LL);
    return 0;
}

/* p, i and x hold `count` entries or up to nzmax. */
static int check_lengths(const struct stored *S, const char *group, int64_t count, struct why *why)
{
    if (S->nzmax < count)
        return why_set(why, EX_DATAERR, "%s/nzmax: is %d and there are %lld entries", group,
                       S->nzmax, (long long)count);
    const struct {
        const char *name;
        hsize_t length;
    } of[] = { { "i", S->ni }, { "x", S->nx }, { "p", S->nz < 0 ? S->ni : S->np } };
    for (int k = 0; k < 3; k++)
        if (of[k].length < (hsize_t)count || of[k].length > (hsize_t)S->nzmax)
            return why_set(why, EX_DATAERR, "%s/%s: %llu values for %lld entries, nzmax %d", group,
                           of[k].name, (unsigned long long)of[k].length, (long long)count,
                           S->nzmax);
    return 0;
}

static int check_entries(const struct sparse *A, const struct stored *S, const char *group,
                         struct why *why)
{
    const char *row = S->nz == -2 ? "p" : "i", *col = S->nz == -2 ? "i" : "p";
    for (int64_t k = 0; k < A->count; k++) {
        if (A->row[k] < 0 || A->row[k] >= A->m)
            return why_set(why, EX_DATAERR, "%s/%s: entry %lld is %d, %s has %lld rows", group, row,
                           (long long)k, A->row[k], strrchr(group, '/') + 1, (long long)A->m);
        if (A->col[k] < 0 || A->col[k] >= A->n)
            return why_set(why, EX_DATAERR, "%s/%s: entry %lld is %d, %s has %lld columns", group,
                           col, (long long)k, A->col[k], strrchr(group, '/') + 1, (long long)A->n);
        if (!isfinite(A->x[k]))
            return why_set(why, EX_DATAERR, "%s/x: entry %lld is %g", group, (long long)k, A->x[k]);
    }
    return 0;
}

/*
 * nz = -2: CSR, -1: CSC, else triplets, in which real files have the columns in p and the rows in i
 * (fclib.h says the opposite): the same as CSC once p is spelled out. The arrays of S move into A.
 */
static int unpack(struct sparse *A, struct stored *S, const char *group, struct why *why)
{
    int32_t lines = S->nz == -2 ? S->m : S->n;
    if (S->nz < -2)
        return why_set(why, EX_DATAERR, "%s/nz: %d is no form of storage", group, S->nz);
    if (S->nz < 0 && check_pointers(S, group, lines, why)) return why->status;
    A->m = S->m, A->n = S->n;
    A->count = A->room = S->nz >= 0 ? S->nz : S->p[lines];
    if (check_lengths(S, group, A->count, why)) return why->status;
    int32_t *line = S->p;
    if (S->nz < 0) {
        line = malloc((size_t)(A->count + 1) * sizeof *line);
        if (!line) return short_of_memory(why);
        for (int32_t l = 0; l < lines; l++)
            for (int32_t k = S->p[l]; k < S->p[l + 1]; k++) line[k] = l;
        free(S->p);
    }
    A->row = S->nz == -2 ? line : S->i;
    A->col = S->nz == -2 ? S->i : line;
    A->x = S->x;
    S->p = S->i = NULL, S->x = NULL;
    return check_entries(A, S, group, why);
}

/* An m x n matrix */
static int read_matrix(struct sparse *A, hid_t file, const char *group, int64_t m, int64_t n,
                       struct why *why)
{
    struct stored S = { 0 };
    int e = stored_read(&S, file, group, why);
    if (!e && (S.m != m || S.n != n))
        e = why_set(why, EX_DATAERR, "%s: is %d x %d, the vectors want %lld x %lld", group, S.m,
                    S.n, (long long)m, (long long)n);
    if (!e) e = unpack(A, &S, group, why);
    free(S.p);
    free(S.i);
    free(S.x);
    return e;
}

/* spacedim and mu, which every problem has */
static int read_law(struct raw *R, hid_t file, const char *group, struct why *why)
{
    char path[64];
    int32_t d;
    if (h5_read(file, join(path, group, "spacedim"), H5T_NATIVE_INT32, 1, &d, why))
        return why->status;
    if (d != 2 && d != 3) return why_set(why, EX_DATAERR, "%s: is %d, not 2 or 3", path, d);
    R->d = d;
    if (!(R->mu = read_vector(file, group, "vectors/mu", -1, &R->n, why))) return why->status;
    if (R->n > INT32_MAX / d)
        return why_set(why, EX_DATAERR, "%s/vectors/mu: too many contacts", group);
    for (int64_t c = 0; c < R->n; c++)
        if (R->mu[c] < 0)
            return why_set(why, EX_DATAERR, "%s/vectors/mu: entry %lld is %g", group, (long long)c,
                           R->mu[c]);
    return 0;
}

static int read_local(struct raw *R, hid_t file, struct why *why)
{
    const char *group = "/fclib_local";
    if (h5_has(file, "/fclib_local/V") || h5_has(file, "/fclib_local/R"))
        return why_set(why, EX_DATAERR, "%s: a mixed problem (V, R, s), which is not solved here",
                       group);
    if (read_law(R, file, group, why)) return why->status;
    int64_t nd = R->n * R->d;
    if (!(R->q = read_vector(file, group, "vectors/q", nd, NULL, why))) return why->status;
    return read_matrix(&R->W, file, "/fclib_local/W", nd, nd, why);
}

static int read_global(struct raw *R, hid_t file, struct why *why)
{
    const char *group = "/fclib_global";
    if (read_law(R, file, group, why)) return why->status;
    int64_t nd = R->n * R->d;
    if (!(R->q = read_vector(file, group, "vectors/w", nd, NULL, why))) return why->status;
    if (!(R->f = read_vector(file, group, "vectors/f", -1, &R->nv, why))) return why->status;
    if (read_matrix(&R->M, file, "/fclib_global/M", R->nv, R->nv, why)) return why->status;
    if (read_matrix(&R->H, file, "/fclib_global/H", R->nv, nd, why)) return why->status;
    if (!h5_has(file, "/fclib_global/G")) return 0;
    if (!(R->b = read_vector(file, group, "vectors/b", -1, &R->nl, why))) return why->status;
    if (R->nl > INT32_MAX - R->nv)
        return why_set(why, EX_DATAERR, "%s/vectors/b: too many unknowns", group);
    return read_matrix(&R->G, file, "/fclib_global/G", R->nv, R->nl, why);
}

static void raw_free(struct raw *R)
{
    struct sparse *const matrix[] = { &R->W, &R->M, &R->H, &R->G };
    for (int k = 0; k < 4; k++) sparse_free(matrix[k]);
    free(R->mu);
    free(R->q);
    free(R->f);
    free(R->b);
}

/* ---- the condensation ---------------------------------------------------------------------- */

/* K = [ M -G ; G^T 0 ], the matrix of (v, lambda), factorised; by columns. */
struct factor {
    int64_t n;
    SuiteSparse_long *p, *i;
    double *x;
    void *numeric;
    double *dense; /* [n] work */
};

static void factor_free(struct factor *K)
{
    if (K->numeric) umfpack_dl_free_numeric(&K->numeric);
    free(K->p);
    free(K->i);
    free(K->x);
    free(K->dense);
}

/* The columns of K, entries of one place added */
static int factor_columns(struct factor *K, const struct raw *R, struct why *why)
{
    int64_t n = K->n, count = R->M.count + 2 * R->G.count, k = 0;
    SuiteSparse_long *row = malloc((size_t)(count + 1) * sizeof *row);
    SuiteSparse_long *col = malloc((size_t)(count + 1) * sizeof *col);
    double *x = malloc((size_t)(count + 1) * sizeof *x);
    K->p = malloc((size_t)(n + 1) * sizeof *K->p);
    K->i = malloc((size_t)(count + 1) * sizeof *K->i);
    K->x = malloc((size_t)(count + 1) * sizeof *K->x);
    K->dense = malloc((size_t)(n + 1) * sizeof *K->dense);
    bool good = row && col && x && K->p && K->i && K->x && K->dense;
    for (int64_t e = 0; good && e < R->M.count; e++, k++)
        row[k] = R->M.row[e], col[k] = R->M.col[e], x[k] = R->M.x[e];
    for (int64_t e = 0; good && e < R->G.count; e++, k += 2) {
        row[k] = col[k + 1] = R->G.row[e];
        col[k] = row[k + 1] = R->nv + R->G.col[e];
        x[k] = -(x[k + 1] = R->G.x[e]);
    }
    if (good) good = !umfpack_dl_triplet_to_col(n, n, count, row, col, x, K->p, K->i, K->x, NULL);
    free(row);
    free(col);
    free(x);
    return good ? 0 : short_of_memory(why);
}

static int factor_init(struct factor *K, const struct raw *R, struct why *why)
{
    K->n = R->nv + R->nl;
    if (K->n == 0) return 0;
    if (factor_columns(K, R, why)) return why->status;
    double info[UMFPACK_INFO];
    void *symbolic = NULL;
    int e = (int)umfpack_dl_symbolic(K->n, K->n, K->p, K->i, K->x, &symbolic, NULL, info);
    if (!e) e = (int)umfpack_dl_numeric(K->p, K->i, K->x, symbolic, &K->numeric, NULL, info);
    if (symbolic) umfpack_dl_free_symbolic(&symbolic);
    if (e == UMFPACK_ERROR_out_of_memory) return short_of_memory(why);
    if (e || info[UMFPACK_RCOND] < 1e-16)
        return why_set(why, EX_DATAERR, "/fclib_global/M: %s singular (rcond %.1g)",
                       R->nl ? "with G it is" : "is", e ? 0 : info[UMFPACK_RCOND]);
    return 0;
}

/* x = K^-1 b, x not b */
static int factor_solve(const struct factor *K, const double *b, double *x, struct why *why)
{
    if (K->n == 0) return 0;
    int e = (int)umfpack_dl_solve(UMFPACK_A, K->p, K->i, K->x, x, b, K->numeric, NULL, NULL);
    if (e == UMFPACK_ERROR_out_of_memory) return short_of_memory(why);
    for (int64_t k = 0; !e && k < K->n; k++) e = !isfinite(x[k]);
    return e ? why_set(why, EX_DATAERR, "/fclib_global/M: singular to working precision") : 0;
}

/* (v0, l0) = K^-1 (f, -b) */
static int condense_free(struct fclib *F, const struct raw *R, struct factor *K, struct why *why)
{
    F->v0 = calloc((size_t)K->n + 1, sizeof *F->v0);
    if (!F->v0) return short_of_memory(why);
    for (int64_t k = 0; k < R->nv; k++) K->dense[k] = R->f[k];
    for (int64_t k = 0; k < R->nl; k++) K->dense[R->nv + k] = -R->b[k];
    return factor_solve(K, K->dense, F->v0, why);
}

static int32_t part_of(int32_t *part, int32_t i)
{
    while (part[i] != i) i = part[i] = part[part[i]];
    return i;
}

/* K falls into parts that have nothing to do with each other, as bodies do: part[i] is the lowest
   unknown of the part that i is in. */
static void find_parts(const struct factor *K, int32_t *part)
{
    for (int64_t i = 0; i < K->n; i++) part[i] = (int32_t)i;
    for (int64_t j = 0; j < K->n; j++)
        for (SuiteSparse_long k = K->p[j]; k < K->p[j + 1]; k++) {
            int32_t a = part_of(part, (int32_t)j), b = part_of(part, (int32_t)K->i[k]);
            part[a > b ? a : b] = a > b ? b : a;
        }
    for (int64_t i = 0; i < K->n; i++) part[i] = part_of(part, (int32_t)i);
}

/* Column j of H into the right-hand side, unless a part that it meets has an owner already */
static bool join_columns(const struct sparse *H, const struct lists *of, int32_t j,
                         const int32_t *part, int32_t *owner, double *b)
{
    for (int64_t k = of->first[j]; k < of->first[j + 1]; k++)
        if (owner[part[H->row[of->item[k]]]] >= 0) return false;
    for (int64_t k = of->first[j]; k < of->first[j + 1]; k++) {
        int32_t i = H->row[of->item[k]];
        owner[part[i]] = j;
        b[i] += H->x[of->item[k]];
    }
    return true;
}

/*
 * (V, L) = K^-1 (H, 0), what is not zero of it. Columns that meet different parts of K share one
 * right-hand side: of a packing it takes as many solutions as a ball has neighbours, times d.
 */
static int solve_columns(struct sparse *V, const struct sparse *H, struct factor *K,
                         const struct lists *of, int32_t *part, int32_t *todo, double *y,
                         struct why *why)
{
    int32_t *owner = part + K->n;
    find_parts(K, part);
    for (int32_t j = 0; j < H->n; j++) todo[j] = j;
    for (int64_t left = H->n, kept; left > 0; left = kept) {
        for (int64_t i = 0; i < K->n; i++) owner[i] = -1, K->dense[i] = 0;
        kept = 0;
        for (int64_t k = 0; k < left; k++)
            if (!join_columns(H, of, todo[k], part, owner, K->dense)) todo[kept++] = todo[k];
        if (factor_solve(K, K->dense, y, why)) return why->status;
        for (int64_t i = 0; i < K->n; i++)
            if (owner[part[i]] >= 0 && y[i] != 0 && !sparse_add(V, i, owner[part[i]], y[i]))
                return short_of_memory(why);
    }
    return 0;
}

static int condense_columns(struct fclib *F, const struct raw *R, struct factor *K, struct why *why)
{
    struct sparse V = { 0 };
    struct lists of = { 0 };
    double *y = malloc((size_t)(K->n + 1) * sizeof *y);
    int32_t *part = malloc((size_t)(2 * K->n + 1) * sizeof *part);
    int32_t *todo = malloc((size_t)(R->H.n + 1) * sizeof *todo);
    bool room = y && part && todo && lists_init(&of, R->H.n, R->H.count, R->H.col);
    int e = room ? solve_columns(&V, &R->H, K, &of, part, todo, y, why) : short_of_memory(why);
    F->vn = V.count, F->vi = V.row, F->vj = V.col, F->vx = V.x;
    lists_free(&of);
    free(todo);
    free(part);
    free(y);
    return e;
}

/* W = H^T V, column by column, from the rows of H that V's column meets */
static bool condense_W(struct sparse *W, const struct fclib *F, const struct raw *R)
{
    const struct sparse *H = &R->H;
    struct lists rows = { 0 }, columns = { 0 };
    double *sum = calloc((size_t)H->n + 1, sizeof *sum);
    int32_t *met = malloc((size_t)(H->n + 1) * sizeof *met);
    int32_t *last = malloc((size_t)(H->n + 1) * sizeof *last); // the column that met it last
    bool good = sum && met && last && lists_init(&rows, F->nv + F->nl, H->count, H->row) &&
                lists_init(&columns, H->n, F->vn, F->vj);
    for (int64_t a = 0; good && a < H->n; a++) last[a] = -1;
    for (int32_t j = 0; good && j < H->n; j++) {
        int64_t mets = 0;
        for (int64_t k = columns.first[j]; k < columns.first[j + 1]; k++) {
            int64_t v = columns.item[k], i = F->vi[v]; // rows of multipliers meet nothing
            for (int64_t l = rows.first[i]; l < rows.first[i + 1]; l++) {
                int32_t a = H->col[rows.item[l]];
                if (last[a] != j) last[a] = j, sum[a] = 0, met[mets++] = a;
                sum[a] += H->x[rows.item[l]] * F->vx[v];
            }
        }
        for (int64_t k = 0; good && k < mets; k++) good = sparse_add(W, met[k], j, sum[met[k]]);
    }
    lists_free(&columns);
    lists_free(&rows);
    free(last);
    free(met);
    free(sum);
    return good;
}

/* u = H^T (v0 + V r) + w = W r + q */
static int condense(struct fclib *F, struct raw *R, struct why *why)
{
    struct factor K = { 0 };
    F->nv = R->nv, F->nl = R->nl;
    int e = factor_init(&K, R, why);
    if (!e) e = condense_free(F, R, &K, why);
    if (!e) e = condense_columns(F, R, &K, why);
    factor_free(&K);
    if (!e && !condense_W(&R->W, F, R)) e = short_of_memory(why);
    for (int64_t k = 0; !e && k < R->H.count; k++)
        R->q[R->H.col[k]] += R->H.x[k] * F->v0[R->H.row[k]];
    return e;
}

bool fclib_in(int64_t file)
{
    return h5_has(file, "/fclib_global") || h5_has(file, "/fclib_local");
}

int fclib_read(struct fclib *F, int64_t file, struct why *why)
{
    struct raw R = { 0 };
    *F = (struct fclib){ .global = h5_has(file, "/fclib_global") }; // libfclib asks in this order
    if (!fclib_in(file))
        return why_set(why, EX_DATAERR, "/fclib_local: there is none, and no /fclib_global");
    int e = F->global ? read_global(&R, file, why) : read_local(&R, file, why);
    if (!e && F->global) e = condense(F, &R, why);
    if (!e) e = delassus_init(&F->W, R.d, R.n, R.W.count, R.W.row, R.W.col, R.W.x, R.q, R.mu, why);
    raw_free(&R);
    if (e) fclib_free(F);
    return e;
}

int fclib_load_solution(const struct fclib *F, int64_t file, double *r, struct why *why)
{
    int64_t nd = F->W.n * F->W.d;
    memset(r, 0, (size_t)nd * sizeof *r);
    if (!h5_has(file, "/solution/r")) return 0;
    double *stored = read_vector(file, "/solution", "r", nd, NULL, why);
    if (!stored) return why->status;
    memcpy(r, stored, (size_t)nd * sizeof *r);
    free(stored);
    return 0;
}

void fclib_free(struct fclib *F)
{
    delassus_free(&F->W);
    free(F->v0);
    free(F->vi);
    free(F->vj);
    free(F->vx);
    *F = (struct fclib){ 0 };
}

/* ---- out ----------------------------------------------------------------------------------- */

static int write_vector(hid_t file, const char *group, const char *name, int64_t count,
                        const double *x, const char *units, struct why *why)
{
    char path[64];
    hsize_t length = (hsize_t)count;
    return h5_write(file, join(path, group, name), H5T_NATIVE_DOUBLE, 1, &length, x, units, why);
}

static int write_ints(hid_t file, const char *group, const char *name, int64_t count,
                      const int32_t *x, struct why *why)
{
    char path[64];
    hsize_t length = (hsize_t)count;
    return h5_write(file, join(path, group, name), H5T_NATIVE_INT32, 1, &length, x, NULL, why);
}

static int drop(hid_t file, const char *path, struct why *why)
{
    if (!h5_has(file, path) || H5Ldelete(file, path, H5P_DEFAULT) >= 0) return 0;
    return why_set(why, EX_IOERR, "%s: cannot be replaced", path);
}

int fclib_store_solution(const struct fclib *F, int64_t file, const double *u, const double *r,
                         struct why *why)
{
    const char *group = "/solution";
    int64_t nd = F->W.n * F->W.d;
    double *v = NULL;
    if (drop(file, group, why)) return why->status;
    if (F->global) { // (v, l) = (v0, l0) + (V, L) r
        int64_t n = F->nv + F->nl;
        if (!(v = malloc((size_t)(n + 1) * sizeof *v))) return short_of_memory(why);
        memcpy(v, F->v0, (size_t)n * sizeof *v);
        for (int64_t k = 0; k < F->vn; k++) v[F->vi[k]] += F->vx[k] * r[F->vj[k]];
    }
    int e = write_vector(file, group, "u", nd, u, NULL, why);
    if (!e) e = write_vector(file, group, "r", nd, r, NULL, why);
    if (!e && F->nv) e = write_vector(file, group, "v", F->nv, v, NULL, why);
    if (!e && F->nl) e = write_vector(file, group, "l", F->nl, v + F->nv, NULL, why);
    free(v);
    return e;
}

/*
 * A packing's problem, contact by contact in the packing's order. Its unknowns are the velocities of
 * the movable bodies that have a contact, in their order: (vx, vy, vz, wx, wy, wz), or (vx, vy, wz)
 * in the plane.
 */
struct output {
    const struct problem *p;
    int64_t bodies;    /* 1 + the highest that is mentioned */
    int64_t *row;      /* [n] contact c is row[c] of p */
    int32_t *end;      /* [2 n] bodies a and b of contact c at 2 c, 2 c + 1; -1: immovable */
    struct lists of;   /* the ends of each body */
    double *q, *w;     /* [n d] D u~ at v_free, and with the movable bodies at rest */
    struct body *free; /* [bodies] at v_free */
};

static void output_free(struct output *O)
{
    free(O->row);
    free(O->end);
    free(O->q);
    free(O->w);
    free(O->free);
    lists_free(&O->of);
}

static const struct row *output_row(const struct output *O, int64_t c)
{
    return &O->p->row[O->row[c]];
}

/* out = D u~ of every contact with the bodies as they are here; D u~ = u + E u^- */
static void output_velocity(const struct output *O, struct body *body, double *out)
{
    struct problem p = *O->p;
    p.body = body;
    for (int64_t c = 0; c < p.n; c++) {
        const struct row *row = output_row(O, c);
        double u[3];
        body_velocity(&p, row, u);
        for (int k = 0; k < p.d; k++) *out++ = u[k] / row->s[k > 0];
    }
}

/* q with the reactions taken out of the bodies, w with the rest of their motion too */
static bool output_vectors(struct output *O)
{
    struct problem p = *O->p;
    struct body *still = malloc((size_t)(O->bodies + 1) * sizeof *still);
    if (!still) return false;
    if (O->bodies) memcpy(O->free, p.body, (size_t)O->bodies * sizeof *still);
    p.body = O->free;
    for (int64_t i = 0; i < p.n; i++) {
        const struct row *c = &p.row[i];
        const double back[3] = { -c->r[0], -c->r[1], -c->r[2] };
        body_push(&p, c, back);
    }
    for (int64_t i = 0; i < O->bodies; i++) {
        still[i] = O->free[i];
        if (still[i].im > 0) memset(still[i].v, 0, sizeof still[i].v);
        if (still[i].im > 0 && still[i].ii > 0) memset(still[i].w, 0, sizeof still[i].w);
    }
    output_velocity(O, O->free, O->q);
    output_velocity(O, still, O->w);
    free(still);
    return true;
}

static int output_init(struct output *O, const struct problem *p, struct why *why)
{
    *O = (struct output){ .p = p };
    size_t n = (size_t)p->n, nd = n * (size_t)p->d;
    for (int64_t i = 0; i < p->n; i++)
        for (int s = 0; s < 2; s++) {
            int64_t body = s ? p->row[i].b : p->row[i].a;
            if (body >= O->bodies) O->bodies = body + 1;
        }
    O->row = malloc((n + 1) * sizeof *O->row);
    O->end = malloc((2 * n + 1) * sizeof *O->end);
    O->q = malloc((nd + 1) * sizeof *O->q);
    O->w = malloc((nd + 1) * sizeof *O->w);
    O->free = malloc((size_t)(O->bodies + 1) * sizeof *O->free);
    bool good = O->row && O->end && O->q && O->w && O->free;
    for (int64_t i = 0; good && i < p->n; i++) {
        const struct row *row = &p->row[i];
        int64_t c = p->contact[i];
        O->row[c] = i;
        O->end[2 * c] = p->body[row->a].im > 0 ? row->a : -1;
        O->end[2 * c + 1] = p->body[row->b].im > 0 ? row->b : -1;
    }
    good = good && lists_init(&O->of, O->bodies, 2 * p->n, O->end) && output_vectors(O);
    return good ? 0 : short_of_memory(why);
}

/* u_c = J (v, w) of the body at this end of the contact; see body_velocity. */
static void jacobian(const struct row *c, int end, double J[3][6])
{
    double sign = end ? 1 : -1, l = end ? c->lb : c->la;
    for (int k = 0; k < 3; k++) {
        J[0][k] = sign * c->n[k], J[0][3 + k] = 0;
        J[1][k] = sign * c->t1[k], J[1][3 + k] = -l * c->t2[k];
        J[2][k] = sign * c->t2[k], J[2][3 + k] = l * c->t1[k];
    }
}

/* W_cb = sum over the bodies they share of J_c M^-1 J_b^T */
static void output_block(const struct output *O, int64_t c, int64_t b, double B[3][3])
{
    memset(B, 0, 9 * sizeof **B);
    for (int s = 0; s < 4; s++) {
        int32_t body = O->end[2 * c + s / 2];
        if (body < 0 || body != O->end[2 * b + s % 2]) continue;
        double im = O->p->body[body].im, ii = O->p->body[body].ii, J[3][6], K[3][6];
        jacobian(output_row(O, c), s / 2, J);
        jacobian(output_row(O, b), s % 2, K);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                B[i][j] += im * (J[i][0] * K[j][0] + J[i][1] * K[j][1] + J[i][2] * K[j][2]) +
                           ii * (J[i][3] * K[j][3] + J[i][4] * K[j][4] + J[i][5] * K[j][5]);
    }
}

/* The contacts that share a movable body with c, itself among them, ascending; how many. */
static int64_t output_neighbours(const struct output *O, int64_t c, int64_t *met)
{
    int64_t at[2] = { 0 }, end[2] = { 0 }, count = 0;
    for (int s = 0; s < 2; s++) {
        int32_t body = O->end[2 * c + s];
        if (body >= 0) at[s] = O->of.first[body], end[s] = O->of.first[body + 1];
    }
    while (at[0] < end[0] || at[1] < end[1]) {
        int64_t a = at[0] < end[0] ? O->of.item[at[0]] / 2 : INT64_MAX;
        int64_t b = at[1] < end[1] ? O->of.item[at[1]] / 2 : INT64_MAX;
        met[count++] = a < b ? a : b;
        at[0] += a <= b, at[1] += b <= a;
    }
    return count;
}

/* A matrix by rows (nz = -2) or columns (-1), with libfclib's fields */
struct compressed {
    int32_t m, n, nz, *p, *i;
    double *x;
};

static bool compressed_init(struct compressed *A, int64_t m, int64_t n, int nz, int64_t count)
{
    *A = (struct compressed){ .m = (int32_t)m, .n = (int32_t)n, .nz = nz };
    A->p = calloc((size_t)(nz == -2 ? m : n) + 1, sizeof *A->p);
    A->i = malloc((size_t)(count + 1) * sizeof *A->i);
    A->x = malloc((size_t)(count + 1) * sizeof *A->x);
    return A->p && A->i && A->x;
}

static void compressed_free(struct compressed *A)
{
    free(A->p);
    free(A->i);
    free(A->x);
}

static int compressed_write(const struct compressed *A, hid_t file, const char *group,
                            struct why *why)
{
    int32_t lines = A->nz == -2 ? A->m : A->n, count = A->p[lines];
    int e = write_ints(file, group, "m", 1, &A->m, why);
    if (!e) e = write_ints(file, group, "n", 1, &A->n, why);
    if (!e) e = write_ints(file, group, "nz", 1, &A->nz, why);
    if (!e) e = write_ints(file, group, "nzmax", 1, &count, why);
    if (!e) e = write_ints(file, group, "p", lines + 1LL, A->p, why);
    if (!e) e = write_ints(file, group, "i", count, A->i, why);
    if (!e) e = write_vector(file, group, "x", count, A->x, NULL, why);
    return e;
}

static void output_W(const struct output *O, struct compressed *W, int64_t *met)
{
    int d = O->p->d;
    int64_t k = 0;
    for (int64_t c = 0; c < O->p->n; c++) {
        int64_t count = output_neighbours(O, c, met);
        for (int64_t b = 0; b < count; b++) {
            double B[3][3];
            output_block(O, c, met[b], B);
            for (int i = 0; i < d; i++)
                for (int j = 0; j < d; j++) {
                    int64_t e = k + (i * count + b) * d + j;
                    W->i[e] = (int32_t)(d * met[b] + j), W->x[e] = B[i][j];
                }
        }
        for (int i = 0; i < d; i++) W->p[d * c + i + 1] = (int32_t)(k += count * d);
    }
}

static int write_W(const struct output *O, hid_t file, struct why *why)
{
    int64_t n = O->p->n, d = O->p->d, blocks = 0;
    struct compressed W = { 0 };
    int64_t *met = malloc((size_t)(n + 1) * sizeof *met);
    if (!met) return short_of_memory(why);
    for (int64_t c = 0; c < n; c++) blocks += output_neighbours(O, c, met);
    int e;
    if (n * d > INT32_MAX || blocks * d * d > INT32_MAX) {
        e = why_set(why, EX_DATAERR, "/fclib_local/W: too large for the 32-bit indices of FCLIB");
    } else if (!compressed_init(&W, n * d, n * d, -2, blocks * d * d)) {
        e = short_of_memory(why);
    } else {
        output_W(O, &W, met);
        e = compressed_write(&W, file, "/fclib_local/W", why);
    }
    compressed_free(&W);
    free(met);
    return e;
}

/* The unknowns of a body are dof[0 .. dofs-1] of its (v, w). */
static const int dof_plane[] = { 0, 1, 5 }, dof_space[] = { 0, 1, 2, 3, 4, 5 };

/* M diagonal, f = M v_free; first[body] is its first unknown. A body that cannot turn has unknowns
   that nothing drives, and its w stays in the vector w. */
static void output_M(const struct output *O, const int32_t *first, struct compressed *M, double *f)
{
    int dofs = O->p->d == 2 ? 3 : 6;
    const int *dof = O->p->d == 2 ? dof_plane : dof_space;
    for (int64_t i = 0; i < O->bodies; i++) {
        const struct body *b = &O->free[i];
        for (int k = 0; first[i] >= 0 && k < dofs; k++) {
            int32_t row = first[i] + k;
            bool turns = dof[k] > 2;
            M->p[row + 1] = row + 1, M->i[row] = row;
            M->x[row] = !turns ? 1 / b->im : b->ii > 0 ? 1 / b->ii : 1;
            f[row] = M->x[row] * (turns ? b->w[dof[k] - 3] : b->v[dof[k]]);
        }
    }
}

/* H = J^T by columns */
static void output_H(const struct output *O, const int32_t *first, struct compressed *H)
{
    int d = O->p->d, dofs = d == 2 ? 3 : 6;
    const int *dof = d == 2 ? dof_plane : dof_space;
    int32_t count = 0;
    for (int64_t c = 0; c < O->p->n; c++) {
        double J[2][3][6];
        for (int s = 0; s < 2; s++) jacobian(output_row(O, c), s, J[s]);
        int before = O->end[2 * c] > O->end[2 * c + 1]; // rows ascend
        for (int i = 0; i < d; i++) {
            for (int s = 0; s < 2; s++) {
                int32_t body = O->end[2 * c + (s ^ before)];
                for (int k = 0; body >= 0 && k < dofs; k++) {
                    double x = J[s ^ before][i][dof[k]];
                    if (x == 0 || (dof[k] > 2 && O->free[body].ii == 0)) continue;
                    H->i[count] = first[body] + k, H->x[count++] = x;
                }
            }
            H->p[d * c + i + 1] = count;
        }
    }
}

/* first[body], -1 for those that do not move or have no contact; returns the number of unknowns. */
static int64_t output_unknowns(const struct output *O, int32_t *first)
{
    int64_t nv = 0;
    for (int64_t i = 0; i < O->bodies; i++) {
        bool in = O->of.first[i] < O->of.first[i + 1];
        first[i] = in ? (int32_t)nv : -1;
        if (in) nv += O->p->d == 2 ? 3 : 6;
    }
    return nv;
}

static int write_MH(const struct output *O, hid_t file, struct why *why)
{
    int64_t nd = O->p->n * O->p->d;
    if (O->bodies > INT32_MAX / 6 || nd > INT32_MAX / 12)
        return why_set(why, EX_DATAERR,
                       "/fclib_global/H: too large for the 32-bit indices of FCLIB");
    struct compressed M = { 0 }, H = { 0 };
    int32_t *first = malloc((size_t)(O->bodies + 1) * sizeof *first);
    int64_t nv = first ? output_unknowns(O, first) : 0;
    double *f = malloc((size_t)(nv + 1) * sizeof *f);
    int e = 0;
    if (!first || !f || !compressed_init(&M, nv, nv, -1, nv) ||
        !compressed_init(&H, nv, nd, -1, 12 * nd)) {
        e = short_of_memory(why);
    } else {
        output_M(O, first, &M, f);
        output_H(O, first, &H);
        e = compressed_write(&M, file, "/fclib_global/M", why);
    }
    if (!e) e = compressed_write(&H, file, "/fclib_global/H", why);
    if (!e) e = write_vector(file, "/fclib_global/vectors", "f", nv, f, NULL, why);
    compressed_free(&M);
    compressed_free(&H);
    free(first);
    free(f);
    return e;
}

static int write_info(hid_t file, const char *group, struct why *why)
{
    static const char *const text[][2] = {
        { "title", "nsd: one time step of a packing" },
        { "description",
          "Contact by contact (n, t1, t2), in the plane (n, t); SI units, reactions are "
          "impulses in N s. Velocities are u + E u^-, E the coefficients of "
          "restitution: Newton's impact law, and Coulomb's, as the law sees them." },
        { "math_info", "W symmetric, positive semi-definite" },
    };
    char path[64];
    int e = 0;
    for (int k = 0; !e && k < 3; k++)
        e = h5_write_text(file, join(path, group, text[k][0]), text[k][1], why);
    return e;
}

/* Everything but the matrices; what stood there of an older problem goes. */
static int write_vectors(const struct output *O, bool global, hid_t file, struct why *why)
{
    static const char *const old[] = { "/fclib_local", "/fclib_global", "/solution", "/guesses" };
    const char *group = global ? "/fclib_global" : "/fclib_local";
    const int32_t d = O->p->d;
    int64_t n = O->p->n;
    int e = 0;
    for (int k = 0; !e && k < 4; k++) e = drop(file, old[k], why);
    if (!e) e = write_info(file, global ? "/fclib_global/info" : "/fclib_local/info", why);
    if (!e) e = write_ints(file, group, "spacedim", 1, &d, why);
    double *mu = malloc((size_t)(n + 1) * sizeof *mu);
    if (!mu) return short_of_memory(why);
    for (int64_t c = 0; c < n; c++) mu[c] = output_row(O, c)->mu;
    if (!e) e = write_vector(file, group, "vectors/mu", n, mu, NULL, why);
    if (!e && global) e = write_vector(file, group, "vectors/w", n * d, O->w, NULL, why);
    if (!e && !global) e = write_vector(file, group, "vectors/q", n * d, O->q, NULL, why);
    free(mu);
    return e;
}

int fclib_write_problem(const struct problem *p, bool global, int64_t file, struct why *why)
{
    if (!p->body) return why_set(why, EX_SOFTWARE, "a problem given by W has no bodies to write");
    struct output O;
    int e = output_init(&O, p, why);
    if (!e) e = write_vectors(&O, global, file, why);
    if (!e) e = global ? write_MH(&O, file, why) : write_W(&O, file, why);
    output_free(&O);
    return e;
}
