/* file/fclib_write.c: the contact problem of a packing written [file/fclib.h]. Programs that do not ask for it do not link it, nor
   what assembles such a problem. */
#include "file/fclib.h"

#include "file/h5.h"
#include "solve/assembly.h"
#include "solve/prepare.h"

#include <stdio.h>
#include <stdlib.h>

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
    for (int k = 0; !e && k < 4; k++) e = fclib_remove(file, outdated[k], failure);
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
