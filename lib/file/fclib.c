/* file/fclib.c: contact problems read, and solutions read and written [file/fclib.h]. */
#include "file/fclib.h"

#include "file/h5.h"
#include "file/source.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A problem as the file stores it: W and q, or M, H, G, f, w, b. */
struct raw {
    int d;
    int64_t n; /* contacts */
    struct sparse W;
    struct global global;
    double *mu, *q; /* [n], [n d] (w of a global one) */
};

/* group/name */
static const char *fclib_join(char path[64], const char *group, const char *name)
{
    snprintf(path, 64, "%s/%s", group, name);
    return path;
}

/* `count` finite numbers; count < 0: any number of them, told in *found. To be freed. */
static double *read_vector(struct source *source, const char *group, const char *name,
                           int64_t count, int64_t *found, struct failure *failure)
{
    char path[64];
    uint64_t length;
    double *x =
        source_read_all(source, fclib_join(path, group, name), COLUMN_F64, &length, failure);
    if (!x) return NULL;
    if (count >= 0 && length != (uint64_t)count)
        failure_set(failure, EX_DATAERR, "%s: %llu values, %lld are needed", path,
                    (unsigned long long)length, (long long)count);
    for (uint64_t k = 0; k < length && !failure->status; k++)
        if (!isfinite(x[k]))
            failure_set(failure, EX_DATAERR, "%s: entry %llu is %g", path, (unsigned long long)k,
                        x[k]);
    if (found) *found = (int64_t)length;
    if (!failure->status) return x;
    free(x);
    return NULL;
}

static int stored_read(struct stored *S, struct source *source, const char *group,
                       struct failure *failure)
{
    char path[64];
    int32_t *const number[] = { &S->m, &S->n, &S->nz, &S->nzmax };
    const char *const name[] = { "m", "n", "nz", "nzmax" };
    for (int k = 0; k < 4; k++)
        if (source_read(source, fclib_join(path, group, name[k]), COLUMN_I32, 1, number[k],
                        failure))
            return failure->status;
    uint64_t np = 0, ni = 0, nx = 0;
    S->p = source_read_all(source, fclib_join(path, group, "p"), COLUMN_I32, &np, failure);
    if (S->p)
        S->i = source_read_all(source, fclib_join(path, group, "i"), COLUMN_I32, &ni, failure);
    if (S->i)
        S->x = source_read_all(source, fclib_join(path, group, "x"), COLUMN_F64, &nx, failure);
    S->np = np, S->ni = ni, S->nx = nx;
    return S->x ? 0 : failure->status;
}

/* An m x n matrix */
static int fclib_read_matrix(struct sparse *A, struct source *source, const char *group, int64_t m,
                             int64_t n, struct failure *failure)
{
    struct stored S = { 0 };
    int e = stored_read(&S, source, group, failure);
    if (!e && (S.m != m || S.n != n))
        e = failure_set(failure, EX_DATAERR, "%s: is %d x %d, the vectors need %lld x %lld", group,
                        S.m, S.n, (long long)m, (long long)n);
    if (!e) e = sparse_unpack(A, &S, group, failure);
    stored_free(&S);
    return e;
}

/* spacedim and mu, which every problem has */
static int fclib_read_law(struct raw *R, struct source *source, const char *group,
                          struct failure *failure)
{
    char path[64];
    int32_t d;
    if (source_read(source, fclib_join(path, group, "spacedim"), COLUMN_I32, 1, &d, failure))
        return failure->status;
    if (d != 2 && d != 3) return failure_set(failure, EX_DATAERR, "%s: is %d, not 2 or 3", path, d);
    R->d = d;
    if (!(R->mu = read_vector(source, group, "vectors/mu", -1, &R->n, failure)))
        return failure->status;
    if (R->n > INT32_MAX / d)
        return failure_set(failure, EX_DATAERR, "%s/vectors/mu: too many contacts", group);
    for (int64_t c = 0; c < R->n; c++)
        if (R->mu[c] < 0)
            return failure_set(failure, EX_DATAERR, "%s/vectors/mu: entry %lld is %g", group,
                               (long long)c, R->mu[c]);
    return 0;
}

static int read_local(struct raw *R, struct source *source, struct failure *failure)
{
    const char *group = "/fclib_local";
    if (source_has(source, "/fclib_local/V") || source_has(source, "/fclib_local/R"))
        return failure_set(failure, EX_DATAERR,
                           "%s: a mixed problem (V, R, s), which is not solved here", group);
    if (fclib_read_law(R, source, group, failure)) return failure->status;
    int64_t nd = R->n * R->d;
    if (!(R->q = read_vector(source, group, "vectors/q", nd, NULL, failure)))
        return failure->status;
    return fclib_read_matrix(&R->W, source, "/fclib_local/W", nd, nd, failure);
}

static int read_global(struct raw *R, struct source *source, struct failure *failure)
{
    const char *group = "/fclib_global";
    struct global *P = &R->global;
    if (fclib_read_law(R, source, group, failure)) return failure->status;
    int64_t nd = R->n * R->d;
    if (!(R->q = read_vector(source, group, "vectors/w", nd, NULL, failure)))
        return failure->status;
    if (!(P->f = read_vector(source, group, "vectors/f", -1, &P->nv, failure)))
        return failure->status;
    if (fclib_read_matrix(&P->M, source, "/fclib_global/M", P->nv, P->nv, failure))
        return failure->status;
    if (fclib_read_matrix(&P->H, source, "/fclib_global/H", P->nv, nd, failure))
        return failure->status;
    if (!source_has(source, "/fclib_global/G")) return 0;
    if (!(P->b = read_vector(source, group, "vectors/b", -1, &P->nl, failure)))
        return failure->status;
    if (P->nl > INT32_MAX - P->nv)
        return failure_set(failure, EX_DATAERR, "%s/vectors/b: too many unknowns", group);
    return fclib_read_matrix(&P->G, source, "/fclib_global/G", P->nv, P->nl, failure);
}

static void raw_free(struct raw *R)
{
    sparse_free(&R->W);
    global_free(&R->global);
    free(R->mu);
    free(R->q);
}

bool fclib_in(const struct source *source)
{
    return source_has(source, "/fclib_global") || source_has(source, "/fclib_local");
}

int fclib_none(const struct source *source, struct failure *failure)
{
    static const char read[] =
        "only /fclib_local and /fclib_global are read, without rolling friction";
    const char *path;
    const uint64_t *shape;
    for (int64_t k = 0; source_object(source, k, &path, &shape); k++)
        if (!strncmp(path, "/fclib", 6))
            return failure_set(failure, EX_DATAERR,
                               "%.*s: a kind of FCLIB problem that is not solved: %s",
                               (int)(1 + strcspn(path + 1, "/")), path, read);
    return failure_set(failure, EX_DATAERR, "holds neither particles nor an FCLIB problem");
}

int fclib_read(struct fclib *F, struct source *source, struct failure *failure)
{
    struct raw R = { 0 };
    *F = (struct fclib){
        .global = source_has(source, "/fclib_global")
    }; // libfclib, too, looks for the global one first
    if (!fclib_in(source)) return fclib_none(source, failure);
    int e = F->global ? read_global(&R, source, failure) : read_local(&R, source, failure);
    if (!e && F->global) e = condense(&R.global, &F->motion, &R.W, R.q, failure);
    if (!e) e = delassus_init(&F->W, R.d, R.n, &R.W, failure);
    if (!e && R.n) {
        memcpy(F->W.q, R.q, (size_t)(R.n * R.d) * sizeof *R.q);
        memcpy(F->W.mu, R.mu, (size_t)R.n * sizeof *R.mu);
    }
    raw_free(&R);
    if (e) fclib_free(F);
    return e;
}

int fclib_load_solution(const struct fclib *F, struct source *source, double *r,
                        struct failure *failure)
{
    int64_t nd = F->W.n * F->W.d;
    memset(r, 0, (size_t)nd * sizeof *r);
    if (!source_has(source, "/solution/r")) return 0;
    double *stored = read_vector(source, "/solution", "r", nd, NULL, failure);
    if (!stored) return failure->status;
    memcpy(r, stored, (size_t)nd * sizeof *r);
    free(stored);
    return 0;
}

void fclib_free(struct fclib *F)
{
    delassus_free(&F->W);
    motion_free(&F->motion);
    *F = (struct fclib){ 0 };
}

int fclib_remove(int64_t file, const char *path, struct failure *failure)
{
    if (!h5_has(file, path) || H5Ldelete(file, path, H5P_DEFAULT) >= 0) return 0;
    return failure_set(failure, EX_IOERR, "%s: cannot be replaced", path);
}

static int solution_write(hid_t file, const char *path, int64_t count, const double *x,
                          struct failure *failure)
{
    return h5_write(file, path, h5_vector(H5T_NATIVE_DOUBLE, (hsize_t)count, x), NULL, failure);
}

int fclib_store_solution(const struct fclib *F, int64_t file, const double *u, const double *r,
                         struct failure *failure)
{
    int64_t nd = F->W.n * F->W.d;
    double *v = NULL;
    if (fclib_remove(file, "/solution", failure)) return failure->status;
    int64_t nv = F->motion.nv, nl = F->motion.nl;
    if (F->global) {
        if (!(v = malloc((size_t)(nv + nl + 1) * sizeof *v)))
            return failure_set(failure, EX_SOFTWARE, "out of memory for an FCLIB problem");
        motion_of(&F->motion, r, v);
    }
    int e = solution_write(file, "/solution/u", nd, u, failure);
    if (!e) e = solution_write(file, "/solution/r", nd, r, failure);
    if (!e && nv) e = solution_write(file, "/solution/v", nv, v, failure);
    if (!e && nl) e = solution_write(file, "/solution/l", nl, v + nv, failure);
    free(v);
    return e;
}
