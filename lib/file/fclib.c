/* file/fclib.c: the reading half of file/fclib.h; file/fclib.c is the other. */
#include "file/fclib.h"

#include "file/h5.h"
#include "file/source.h"
#include "solve/assembly.h"
#include "solve/prepare.h"

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

/* The writing half of file/fclib.h: solutions, and the problem of a packing. */

static int fclib_short_of_memory(struct failure *failure)
{
    return failure_set(failure, EX_SOFTWARE, "out of memory for an FCLIB problem");
}

/* Writes group/name. */
static int write_array(hid_t file, const char *group, const char *name, struct h5_data data,
                       struct failure *failure)
{
    char path[64];
    snprintf(path, sizeof path, "%s/%s", group, name);
    return h5_write(file, path, data, NULL, failure);
}

static int write_ints(hid_t file, const char *group, const char *name, int64_t count,
                      const int32_t *x, struct failure *failure)
{
    return write_array(file, group, name, h5_vector(H5T_NATIVE_INT32, (hsize_t)count, x), failure);
}

static int write_vector(hid_t file, const char *group, const char *name, int64_t count,
                        const double *x, struct failure *failure)
{
    return write_array(file, group, name, h5_vector(H5T_NATIVE_DOUBLE, (hsize_t)count, x), failure);
}

static int remove_old(hid_t file, const char *path, struct failure *failure)
{
    if (!h5_has(file, path) || H5Ldelete(file, path, H5P_DEFAULT) >= 0) return 0;
    return failure_set(failure, EX_IOERR, "%s: cannot be replaced", path);
}

int fclib_store_solution(const struct fclib *F, int64_t file, const double *u, const double *r,
                         struct failure *failure)
{
    const char *group = "/solution";
    int64_t nd = F->W.n * F->W.d;
    double *v = NULL;
    if (remove_old(file, group, failure)) return failure->status;
    int64_t nv = F->motion.nv, nl = F->motion.nl;
    if (F->global) {
        if (!(v = malloc((size_t)(nv + nl + 1) * sizeof *v))) return fclib_short_of_memory(failure);
        motion_of(&F->motion, r, v);
    }
    int e = write_vector(file, group, "u", nd, u, failure);
    if (!e) e = write_vector(file, group, "r", nd, r, failure);
    if (!e && nv) e = write_vector(file, group, "v", nv, v, failure);
    if (!e && nl) e = write_vector(file, group, "l", nl, v + nv, failure);
    free(v);
    return e;
}

/* A compressed matrix, with libfclib's fields */
static int stored_write(const struct stored *A, hid_t file, const char *group,
                        struct failure *failure)
{
    int32_t lines = A->nz == -2 ? A->m : A->n, count = A->p[lines];
    int e = write_ints(file, group, "m", 1, &A->m, failure);
    if (!e) e = write_ints(file, group, "n", 1, &A->n, failure);
    if (!e) e = write_ints(file, group, "nz", 1, &A->nz, failure);
    if (!e) e = write_ints(file, group, "nzmax", 1, &count, failure);
    if (!e) e = write_ints(file, group, "p", lines + 1LL, A->p, failure);
    if (!e) e = write_ints(file, group, "i", count, A->i, failure);
    if (!e) e = write_vector(file, group, "x", count, A->x, failure);
    return e;
}

/* W^ and q^ of contacts that are bonded */
static int write_bonded_W(const struct assembly *A, hid_t file, struct failure *failure)
{
    struct sparse W = { 0 };
    struct stored S = { 0 };
    int64_t rows = A->p->n * A->p->d;
    double *q = malloc((size_t)(rows + 1) * sizeof *q);
    int e = q ? bonded_local(A, &W, q, failure) : fclib_short_of_memory(failure);
    if (!e && !stored_columns(&S, &W)) e = fclib_short_of_memory(failure);
    if (!e) e = stored_write(&S, file, "/fclib_local/W", failure);
    if (!e) e = write_vector(file, "/fclib_local", "vectors/q", rows, q, failure);
    sparse_free(&W), stored_free(&S), free(q);
    return e;
}

static int write_bonded_MH(const struct assembly *A, hid_t file, struct failure *failure)
{
    struct global P;
    struct stored M = { 0 }, H = { 0 };
    int e = bonded_global(A, &P, failure);
    if (!e && (!stored_columns(&M, &P.M) || !stored_columns(&H, &P.H)))
        e = fclib_short_of_memory(failure);
    if (!e) e = stored_write(&M, file, "/fclib_global/M", failure);
    if (!e) e = stored_write(&H, file, "/fclib_global/H", failure);
    if (!e) e = write_vector(file, "/fclib_global/vectors", "f", P.nv, P.f, failure);
    stored_free(&M), stored_free(&H), global_free(&P);
    return e;
}

static int write_W(const struct assembly *A, hid_t file, struct failure *failure)
{
    if (A->p->kind.extra) return write_bonded_W(A, file, failure);
    struct stored W;
    int e = assembly_W(A, &W, failure);
    if (!e) e = stored_write(&W, file, "/fclib_local/W", failure);
    stored_free(&W);
    return e;
}

static int write_MH(const struct assembly *A, hid_t file, struct failure *failure)
{
    if (A->p->kind.extra) return write_bonded_MH(A, file, failure);
    struct stored M, H;
    double *f;
    int e = assembly_MH(A, &M, &H, &f, failure);
    if (!e) e = stored_write(&M, file, "/fclib_global/M", failure);
    if (!e) e = stored_write(&H, file, "/fclib_global/H", failure);
    if (!e) e = write_vector(file, "/fclib_global/vectors", "f", M.n, f, failure);
    stored_free(&M);
    stored_free(&H);
    free(f);
    return e;
}

static int write_info(hid_t file, const char *group, struct failure *failure)
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
    for (int k = 0; !e && k < 3; k++) {
        snprintf(path, sizeof path, "%s/%s", group, text[k][0]);
        e = h5_write_text(file, path, text[k][1], failure);
    }
    return e;
}

/* Writes everything but the matrices, after removing what an older problem has left. */
static int write_vectors(const struct assembly *A, bool global, hid_t file, struct failure *failure)
{
    static const char *const outdated[] = { "/fclib_local", "/fclib_global", "/solution",
                                            "/guesses" };
    const char *group = global ? "/fclib_global" : "/fclib_local";
    const int32_t d = A->p->d;
    int64_t n = A->p->n;
    int e = 0;
    for (int k = 0; !e && k < 4; k++) e = remove_old(file, outdated[k], failure);
    if (!e) e = write_info(file, global ? "/fclib_global/info" : "/fclib_local/info", failure);
    if (!e) e = write_ints(file, group, "spacedim", 1, &d, failure);
    double *mu = malloc((size_t)(n + 1) * sizeof *mu);
    if (!mu) return fclib_short_of_memory(failure);
    for (int64_t c = 0; c < n; c++)
        mu[c] = slot_bundle(A->p, A->slot[c])->mu[slot_lane(A->slot[c])];
    if (!e) e = write_vector(file, group, "vectors/mu", n, mu, failure);
    if (!e && global) e = write_vector(file, group, "vectors/w", n * d, A->w, failure);
    if (!e && !global && !A->p->kind.extra)
        e = write_vector(file, group, "vectors/q", n * d, A->q, failure);
    free(mu);
    return e;
}

int fclib_write_problem(const struct problem *p, bool global, int64_t file, struct failure *failure)
{
    if (!p->body)
        return failure_set(failure, EX_SOFTWARE, "a problem given by W has no bodies to write");
    struct assembly A;
    int e = assembly_init(&A, p, failure);
    if (!e) e = write_vectors(&A, global, file, failure);
    if (!e) e = global ? write_MH(&A, file, failure) : write_W(&A, file, failure);
    assembly_free(&A);
    return e;
}
