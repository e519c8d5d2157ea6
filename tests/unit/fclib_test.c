/* FCLIB problems: every stored one is read, what is written is what libfclib reads, and nothing
   wrong in a file is believed. */
#include "file/fclib.h"
#include "file/source.h"
#include "tap.h"

#include </usr/include/fclib.h> // libfclib's own; ours stands before it in the path
#include <assert.h>
#include <glob.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static uint64_t seed = 1;

/* uniform in ]-1, 1[ */
static double noise(void)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(int64_t)seed / 9223372036854775808.0;
}

static double *noises(int64_t n)
{
    double *x = calloc((size_t)n + 1, sizeof *x);
    for (int64_t k = 0; k < n; k++) x[k] = noise();
    return x;
}

static double norm(int64_t n, const double *x)
{
    double sum = 0;
    for (int64_t k = 0; k < n; k++) sum += x[k] * x[k];
    return sqrt(sum);
}

/* |x - y| / |y| */
static double apart(int64_t n, const double *x, const double *y)
{
    double sum = 0, size = norm(n, y);
    for (int64_t k = 0; k < n; k++) sum += (x[k] - y[k]) * (x[k] - y[k]);
    return sum == 0 ? 0 : sqrt(sum) / (size > 0 ? size : 1);
}

/* u = W r + q as the sweep has it */
static double *velocity(const struct delassus *W, const double *r)
{
    int d = W->d;
    double *u = calloc((size_t)(W->n * d) + 1, sizeof *u);
    for (int64_t c = 0; c < W->n; c++) {
        double b[4];
        delassus_gather(W, c, W->q, r, b);
        for (int i = 0; i < d; i++) {
            u[c * d + i] = b[i];
            for (int j = 0; j < d; j++) u[c * d + i] += W->diag[9 * c + i + 3 * j] * r[c * d + j];
        }
    }
    return u;
}

/* y += A x (or A^T x), A as libfclib read it; of triplets, p is the column */
static void multiply(const struct fclib_matrix *A, bool transposed, const double *x, double *y)
{
    int lines = A->nz == -2 ? A->m : A->nz == -1 ? A->n : 1;
    for (int l = 0; l < lines; l++) {
        int begin = A->nz >= 0 ? 0 : A->p[l], end = A->nz >= 0 ? A->nz : A->p[l + 1];
        for (int k = begin; k < end; k++) {
            int line = A->nz >= 0 ? A->p[k] : l;
            int row = A->nz == -2 ? line : A->i[k], col = A->nz == -2 ? A->i[k] : line;
            y[transposed ? col : row] += A->x[k] * x[transposed ? row : col];
        }
    }
}

/* fclib_read and fclib_load_solution of a file of our own */
static int read_problem(struct fclib *F, hid_t file, struct failure *failure)
{
    struct source *s;
    int e = source_of_own(&s, file, failure) ? failure->status : fclib_read(F, s, failure);
    source_close(s);
    return e;
}

static int read_solution(const struct fclib *F, hid_t file, double *r, struct failure *failure)
{
    struct source *s;
    int e =
        source_of_own(&s, file, failure) ? failure->status : fclib_load_solution(F, s, r, failure);
    source_close(s);
    return e;
}

static bool load(struct fclib *F, const char *path, struct failure *failure)
{
    *failure = (struct failure){ 0 };
    hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    int e = file < 0 ? failure_set(failure, EX_NOINPUT, "%s: cannot be opened", path)
                     : read_problem(F, file, failure);
    if (file >= 0) H5Fclose(file);
    if (e) diag("%s", failure->text);
    return !e;
}

/* ---- (a), (b): the collection ----------------------------------------------------------------- */

static const char *base(const char *path)
{
    return strrchr(path, '/') + 1;
}

static double worst_local, worst_global, worst_twin_W, worst_twin_q;

static void test_local(const char *path)
{
    struct failure failure;
    struct fclib F = { 0 };
    if (!ok(load(&F, path, &failure), "%s is read", base(path))) return;
    struct fclib_local *L = fclib_read_local(path);
    int m = L->W->m;
    double *r = noises(m), *u = velocity(&F.W, r), *v = calloc((size_t)m + 1, sizeof *v);
    memcpy(v, L->q, (size_t)m * sizeof *v);
    multiply(L->W, false, r, v);
    double e = apart(m, u, v);
    worst_local = fmax(worst_local, e);
    ok(e < 1e-14 && F.W.d == L->spacedim && F.W.n * F.W.d == m &&
           !memcmp(L->mu, F.W.mu, (size_t)F.W.n * sizeof *v),
       "%s: W r + q, mu as with libfclib (%.1e)", base(path), e);
    fclib_delete_local(L);
    free(L);
    free(r), free(u), free(v);
    fclib_free(&F);
}

/* M v = H r + G l + f, G^T v + b = 0, u = H^T v + w of the velocities stored for (u, r) */
static double global_residual(const struct fclib *F, const char *path, const double *u,
                              const double *r, const char *scratch)
{
    struct failure failure = { 0 };
    char command[1000];
    snprintf(command, sizeof command, "cp %s %s && chmod u+w %s", path, scratch, scratch);
    if (strcmp(path, scratch) != 0 && system(command) != 0) return NAN;
    hid_t file = H5Fopen(scratch, H5F_ACC_RDWR, H5P_DEFAULT);
    int e = fclib_store_solution(F, file, u, r, &failure) ||
            fclib_store_solution(F, file, u, r, &failure);
    H5Fclose(file);
    if (e) return diag("%s", failure.text), NAN;
    struct fclib_global *P = fclib_read_global(scratch);
    struct fclib_solution *S = fclib_read_solution(scratch);
    int nv = P->M->m, nd = P->H->n, nl = P->G ? P->G->n : 0;
    double *Mv = calloc((size_t)nv + 1, sizeof *Mv), *f = calloc((size_t)nv + 1, sizeof *f);
    double *Hv = calloc((size_t)nd + 1, sizeof *Hv), *Gv = calloc((size_t)nl + 1, sizeof *Gv);
    memcpy(f, P->f, (size_t)nv * sizeof *f);
    memcpy(Hv, P->w, (size_t)nd * sizeof *Hv);
    multiply(P->M, false, S->v, Mv);
    multiply(P->H, false, S->r, f);
    multiply(P->H, true, S->v, Hv);
    if (nl) multiply(P->G, false, S->l, f), multiply(P->G, true, S->v, Gv);
    double worst = fmax(apart(nv, Mv, f), apart(nd, Hv, u));
    for (int k = 0; k < nl; k++) worst = fmax(worst, fabs(Gv[k] + P->b[k]) / norm(nl, P->b));
    if (apart(nd, S->r, r) != 0 || apart(nd, S->u, u) != 0) worst = NAN;
    fclib_delete_solutions(S, 1);
    fclib_delete_global(P);
    free(P), free(Mv), free(f), free(Hv), free(Gv);
    return worst;
}

static void test_twin(const struct fclib *F, const char *path, const double *r)
{
    char twin[1000];
    int folder = (int)(strstr(path, "/global/") - path);
    snprintf(twin, sizeof twin, "%.*s/%s", folder, path, base(path));
    snprintf(strrchr(twin, '.'), 20, "-local.hdf5");
    if (access(twin, R_OK)) return;
    struct failure failure;
    struct fclib L = { 0 };
    if (!ok(load(&L, twin, &failure), "%s is read", base(twin))) return;
    int64_t nd = L.W.n * L.W.d;
    bool same = F->W.n == L.W.n && F->W.d == L.W.d;
    double eq = same ? apart(nd, F->W.q, L.W.q) : NAN, eW = NAN;
    if (same) {
        assert(F->W.q && L.W.q);
        memset(F->W.q, 0, (size_t)nd * sizeof *r), memset(L.W.q, 0, (size_t)nd * sizeof *r);
        double *u = velocity(&F->W, r), *v = velocity(&L.W, r);
        eW = apart(nd, u, v);
        free(u), free(v);
    }
    worst_twin_W = fmax(worst_twin_W, eW), worst_twin_q = fmax(worst_twin_q, eq);
    ok(eW < 1e-10 && eq < 1e-10, "%s: W (%.1e) and q (%.1e) are its local twin's", base(path), eW,
       eq);
    fclib_free(&L);
}

static void test_global(const char *path, const char *scratch)
{
    struct failure failure;
    struct fclib F = { 0 };
    if (!ok(load(&F, path, &failure), "%s is read", base(path))) return;
    double *r = noises(F.W.n * F.W.d), *u = velocity(&F.W, r);
    double e = global_residual(&F, path, u, r, scratch);
    worst_global = fmax(worst_global, e);
    ok(e < 1e-9, "%s: the stored v, u, r solve M, H, G (%.1e)", base(path), e);
    test_twin(&F, path, r);
    free(r), free(u);
    fclib_free(&F);
}

static void test_collection(const char *scratch)
{
    glob_t local, global;
    if (glob("../shared/problems/*.hdf5", 0, NULL, &local)) {
        globfree(&local);
        ok(true, "the collection # SKIP no ../shared/problems");
        return;
    }
    for (size_t k = 0; k < local.gl_pathc; k++) test_local(local.gl_pathv[k]);
    globfree(&local);
    if (!glob("../shared/problems/global/*.hdf5", 0, NULL, &global))
        for (size_t k = 0; k < global.gl_pathc; k++) test_global(global.gl_pathv[k], scratch);
    globfree(&global);
    diag("worst: local %.1e, global %.1e, twins' W %.1e, q %.1e", worst_local, worst_global,
         worst_twin_W, worst_twin_q);
}

/* ---- files in memory --------------------------------------------------------------------------- */

static hid_t memory_file(void)
{
    hid_t plist = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_fapl_core(plist, 1 << 20, 0);
    hid_t file = H5Fcreate("memory", H5F_ACC_TRUNC, H5P_DEFAULT, plist);
    H5Pclose(plist);
    return file;
}

static void put(hid_t file, const char *path, hid_t type, int64_t count, const void *x)
{
    struct failure failure = { 0 };
    hsize_t n = (hsize_t)count;
    if (h5_has(file, path)) H5Ldelete(file, path, H5P_DEFAULT);
    if (h5_write(file, path, h5_vector(type, n, x), NULL, &failure))
        ok(false, "put: %s", failure.text);
}

static void put_doubles(hid_t file, const char *path, int64_t count, const double *x)
{
    put(file, path, H5T_NATIVE_DOUBLE, count, x);
}

static void put_ints(hid_t file, const char *path, int64_t count, const int32_t *x)
{
    put(file, path, H5T_NATIVE_INT32, count, x);
}

static void put_matrix(hid_t file, const char *group, int32_t m, int32_t n, int32_t nz,
                       int32_t nzmax, int64_t np, const int32_t *p, int64_t ni, const int32_t *i,
                       const double *x)
{
    char path[64];
    const int32_t number[] = { m, n, nz, nzmax };
    const char *const name[] = { "m", "n", "nz", "nzmax" };
    for (int k = 0; k < 4; k++)
        snprintf(path, sizeof path, "%s/%s", group, name[k]), put_ints(file, path, 1, &number[k]);
    snprintf(path, sizeof path, "%s/p", group), put_ints(file, path, np, p);
    snprintf(path, sizeof path, "%s/i", group), put_ints(file, path, ni, i);
    snprintf(path, sizeof path, "%s/x", group), put_doubles(file, path, nzmax, x);
}

/* Two contacts in the plane: W = [ 4 1 0 0 ; 2 5 3 0 ; 0 3 6 0 ; 0 0 0 7 ] */
static const double dense[16] = { 4, 1, 0, 0, 2, 5, 3, 0, 0, 3, 6, 0, 0, 0, 0, 7 };

static void put_rest(hid_t file)
{
    const int32_t two = 2;
    put_ints(file, "/fclib_local/spacedim", 1, &two);
    put_doubles(file, "/fclib_local/vectors/q", 4, (double[]){ -1, 2, -3, 4 });
    put_doubles(file, "/fclib_local/vectors/mu", 2, (double[]){ 0.5, 0 });
}

static void test_form(const char *name, int32_t nz, int32_t nzmax, int64_t np, const int32_t *p,
                      int64_t ni, const int32_t *i, const double *x)
{
    hid_t file = memory_file();
    put_matrix(file, "/fclib_local/W", 4, 4, nz, nzmax, np, p, ni, i, x);
    put_rest(file);
    struct failure failure = { 0 };
    struct fclib F = { 0 };
    if (!ok(!read_problem(&F, file, &failure), "W as %s is read%s", name, failure.text)) {
        H5Fclose(file);
        return;
    }
    bool same = true;
    for (int j = 0; j < 4; j++) {
        double r[4] = { 0 }, *u;
        r[j] = 1;
        u = velocity(&F.W, r);
        for (int k = 0; k < 4; k++) same &= u[k] - F.W.q[k] == dense[4 * k + j];
        free(u);
    }
    ok(same, "W as %s is the same W", name);
    ok(F.W.first[2] == 2 && F.W.diag[8] == 5 && F.W.diag[17] == 7 && F.W.diag[2] == 0 &&
           F.W.diag[5] == 0,
       "W as %s: two blocks beside the diagonal, and that padded", name);
    fclib_free(&F);
    H5Fclose(file);
}

static void test_forms(void)
{
    test_form("CSR, unsorted", -2, 8, 5, (int32_t[]){ 0, 2, 5, 7, 8 }, 8,
              (int32_t[]){ 1, 0, 2, 0, 1, 1, 2, 3 }, (double[]){ 1, 4, 3, 2, 5, 3, 6, 7 });
    test_form("CSC", -1, 8, 5, (int32_t[]){ 0, 2, 5, 7, 8 }, 8,
              (int32_t[]){ 0, 1, 0, 1, 2, 1, 2, 3 }, (double[]){ 4, 2, 1, 5, 3, 3, 6, 7 });
    test_form("triplets (p column, i row)", 8, 8, 8, (int32_t[]){ 3, 2, 1, 0, 2, 1, 0, 1 }, 8,
              (int32_t[]){ 3, 2, 2, 1, 1, 1, 0, 0 }, (double[]){ 7, 6, 3, 2, 3, 5, 4, 1 });
    test_form("CSR with zeros, duplicates and nzmax beyond", -2, 12, 5,
              (int32_t[]){ 0, 3, 7, 9, 10 }, 12, (int32_t[]){ 1, 0, 3, 2, 0, 1, 1, 1, 2, 3, 9, 9 },
              (double[]){ 1, 4, 0, 3, 2, 2, 3, 3, 6, 7, NAN, NAN });
    test_form("triplets with nzmax beyond nz", 9, 11, 9, (int32_t[]){ 3, 2, 1, 0, 2, 1, 0, 1, 0 },
              9, (int32_t[]){ 3, 2, 2, 1, 1, 1, 0, 0, 3 },
              (double[]){ 7, 6, 3, 2, 3, 5, 4, 1, 0, 99, 99 });
}

static void test_empty(void)
{
    hid_t file = memory_file();
    put_rest(file);
    put_matrix(file, "/fclib_local/W", 0, 0, -2, 0, 1, (int32_t[]){ 0 }, 0, NULL, NULL);
    put_doubles(file, "/fclib_local/vectors/q", 0, NULL);
    put_doubles(file, "/fclib_local/vectors/mu", 0, NULL);
    struct failure failure = { 0 };
    struct fclib F = { 0 };
    ok(!read_problem(&F, file, &failure) && F.W.n == 0 && F.W.first[0] == 0,
       "a problem of no contact is a problem");
    ok(!fclib_store_solution(&F, file, F.W.q, F.W.r, &failure), "and its solution is stored");
    fclib_free(&F);
    H5Fclose(file);
}

/* ---- a global problem with G ------------------------------------------------------------------- */

static struct fclib_matrix triplets(int m, int n, double fill, double diagonal)
{
    struct fclib_matrix A = { .m = m, .n = n };
    A.p = malloc((size_t)(m * n) * sizeof *A.p);
    A.i = malloc((size_t)(m * n) * sizeof *A.i);
    A.x = malloc((size_t)(m * n) * sizeof *A.x);
    for (int i = 0; i < m; i++)
        for (int j = 0; j < n; j++) {
            if (i != j && fabs(noise()) > fill) continue;
            A.i[A.nz] = i, A.p[A.nz] = j, A.x[A.nz++] = noise() + (i == j ? diagonal : 0);
        }
    A.nzmax = A.nz;
    return A;
}

static void test_multipliers(const char *scratch)
{
    enum { NV = 40, ND = 27, NL = 7 };
    struct fclib_matrix M = triplets(NV, NV, 0.1, 5), H = triplets(NV, ND, 0.1, 1);
    struct fclib_matrix G = triplets(NV, NL, 0.2, 1);
    double *mu = noises(ND / 3);
    for (int k = 0; k < ND / 3; k++) mu[k] = fabs(mu[k]);
    struct fclib_global P = { .M = &M, .H = &H, .G = &G, .mu = mu, .spacedim = 3 };
    P.f = noises(NV), P.w = noises(ND), P.b = noises(NL);
    P.info = NULL;
    unlink(scratch);
    ok(fclib_write_global(&P, scratch), "libfclib writes a problem with G");
    struct failure failure;
    struct fclib F = { 0 };
    if (ok(load(&F, scratch, &failure), "and it is read")) {
        double *r = noises(ND), *u = velocity(&F.W, r), e;
        e = global_residual(&F, scratch, u, r, scratch);
        ok(e < 1e-12, "v, l, u, r solve it: M, H, G (%.1e)", e);
        free(u), free(r);
        fclib_free(&F);
    }
    struct fclib_matrix *const all[] = { &M, &H, &G };
    for (int k = 0; k < 3; k++) free(all[k]->p), free(all[k]->i), free(all[k]->x);
    free(mu), free(P.f), free(P.w), free(P.b);
}

/* ---- (c): a packing's problem ------------------------------------------------------------------ */

enum { BODIES = 12, CONTACTS = 30 };

struct made {
    struct problem p;
    struct body body[BODIES], free[BODIES];
    struct near_bundle bundle[(CONTACTS + BUNDLE - 1) / BUNDLE];
    struct rebound rebound[(CONTACTS + BUNDLE - 1) / BUNDLE];
    double u[(CONTACTS + BUNDLE - 1) / BUNDLE][3][BUNDLE];
    int32_t contact[CONTACTS + BUNDLE];
};

static void cross(const double a[3], const double b[3], double c[3])
{
    for (int k = 0; k < 3; k++)
        c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static void make_frame(int d, struct bundle *c, struct beside *t, int i)
{
    const double z[3] = { 0, 0, 1 };
    double other[3] = { noise(), noise(), noise() }, n[3], t1[3];
    for (int k = 0; k < 3; k++) n[k] = k < d ? noise() : 0;
    double size = norm(3, n);
    for (int k = 0; k < 3; k++) n[k] /= size;
    cross(d == 2 ? z : other, n, t1);
    size = norm(3, t1);
    for (int k = 0; k < 3; k++) t1[k] /= size;
    for (int k = 0; k < 3; k++) c->n[k][i] = n[k], t->t1[k][i] = t1[k];
}

/*
 * Random bodies, contacts and reactions: 0 and 1 are walls of which one moves (and one contact is
 * theirs), 2 cannot turn, 3 has no contact. The rows' order is not the contacts'.
 */
static void make(struct made *m, int d, int64_t n)
{
    *m = (struct made){ .p = { .d = d, .n = n, .dt = 1, .bundles = (n + BUNDLE - 1) / BUNDLE } };
    m->p.slots = m->p.bundles * BUNDLE;
    m->p.kind = kind_BALLS, m->p.bundle = &m->bundle[0].bundle, m->p.rebound = m->rebound,
    m->p.contact = m->contact, m->p.bodies = BODIES, m->p.body = m->body, m->p.u = m->u;
    for (int64_t i = n; i < m->p.slots; i++) m->contact[i] = -1;
    for (int i = 0; i < BODIES; i++) {
        struct body *b = &m->body[i];
        for (int k = 0; k < d; k++) b->v[k] = i == 0 ? 0 : noise();
        for (int k = d == 2 ? 2 : 0; k < 3; k++) b->w[k] = i < 2 ? 0 : noise();
        b->im = i < 2 ? 0 : exp(noise());
        b->ii = i < 3 ? 0 : exp(noise());
        m->free[i] = *b;
    }
    for (int64_t i = 0; i < n; i++) {
        struct bundle *c = slot_bundle(&m->p, i);
        int k = slot_lane(i);
        const double e[3] = { 0.5 + noise() / 2, 0.5 + noise() / 2 };
        m->contact[i] = (7 * i + 3) % n;
        int a, b = 4 + (int)(4 * (1 + noise()));
        do a = (int)(BODIES * (1 + noise()) / 2);
        while (a == b || a == 3);
        if (i == 5) a = 0, b = 1;
        c->a[k] = body_place(a), c->b[k] = body_place(b);
        make_frame(d, c, &m->bundle[i / BUNDLE].beside, k);
        c->la[k] = noise(), c->lb[k] = noise(), c->mu[k] = fabs(noise());
        for (int j = 0; j < 2; j++) slot_rebound(&m->p, i)->s[j][k] = 1 / (1 + e[j]);
        for (int j = 0; j < d; j++) {
            slot_rebound(&m->p, i)->offset[j][k] = noise();
            c->r[j][k] = noise();
        }
    }
    for (int64_t i = 0; i < n; i++) {
        double r[3], u[3];
        slot_get(&m->p, i, r, u);
        body_push(&m->p, m->body, slot_bundle(&m->p, i), slot_lane(i), r);
    }
}

/* D u~ of every contact, in the contacts' order, with reactions r instead of those in the rows */
static double *pushed(struct made *m, const double *r)
{
    struct problem p = m->p;
    struct body body[BODIES];
    memcpy(body, m->free, sizeof body);
    double *u = calloc((size_t)(p.n * p.d) + 1, sizeof *u);
    for (int64_t i = 0; i < p.n; i++) {
        double full[3] = { 0 };
        memcpy(full, r + p.d * p.contact[i], (size_t)p.d * sizeof *r);
        body_push(&p, body, slot_bundle(&p, i), slot_lane(i), full);
    }
    assert(p.d == 2 || p.d == 3);
    for (int64_t i = 0; i < p.n; i++) {
        double v[3];
        body_velocity(&p, body, slot_bundle(&p, i), slot_rebound(&p, i), slot_lane(i), v);
        for (int k = 0; k < p.d; k++)
            u[p.d * p.contact[i] + k] = v[k] / slot_rebound(&p, i)->s[k > 0][slot_lane(i)];
    }
    return u;
}

static bool write_made(const struct made *m, bool global, const char *scratch)
{
    struct failure failure = { 0 };
    hid_t file = H5Fcreate(scratch, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    int e = fclib_write_problem(&m->p, !global, file, &failure); // the other, to be replaced
    if (!e) e = fclib_write_problem(&m->p, global, file, &failure);
    H5O_info_t info;
    const char *x = global ? "/fclib_global/H/x" : "/fclib_local/W/x";
    bool timeless = H5Oget_info_by_name2(file, x, &info, H5O_INFO_TIME, H5P_DEFAULT) >= 0 &&
                    info.mtime == 0 && info.ctime == 0;
    bool closed = H5Fclose(file) >= 0;
    if (e) diag("%s", failure.text);
    return !e && timeless && closed;
}

/* What libfclib reads of a local one: W symmetric, W r + q, mu, info */
static void test_libfclib_local(struct made *m, const char *scratch, const double *r)
{
    struct fclib_local *L = fclib_read_local(scratch);
    int nd = (int)(m->p.n * m->p.d);
    if (!ok(L && L->W->m == nd && L->W->nz == -2 && L->spacedim == m->p.d && L->info &&
                strstr(L->info->title, "nsd") && strstr(L->info->description, "N s"),
            "libfclib reads it, and its title"))
        return;
    assert(L);
    double *u = pushed(m, r), *v = calloc((size_t)nd + 1, sizeof *v), *T = noises(nd), a = 0, b = 0;
    memcpy(v, L->q, (size_t)nd * sizeof *v);
    multiply(L->W, false, r, v);
    double e = apart(nd, v, u);
    ok(e < 1e-13, "W r + q is what pushing the bodies does (%.1e)", e);
    memset(u, 0, (size_t)nd * sizeof *u), memset(v, 0, (size_t)nd * sizeof *v);
    multiply(L->W, false, r, u), multiply(L->W, true, r, v);
    for (int k = 0; k < nd; k++) a += T[k] * u[k], b += r[k] * u[k];
    e = apart(nd, u, v);
    ok(e < 1e-14 && b >= 0 && isfinite(a), "W is symmetric (%.1e) and r W r >= 0", e);
    bool sorted = true, mu = true;
    for (int l = 0; l < nd; l++)
        for (int k = L->W->p[l] + 1; k < L->W->p[l + 1]; k++) sorted &= L->W->i[k] > L->W->i[k - 1];
    for (int64_t i = 0; i < m->p.n; i++)
        mu &= L->mu[m->p.contact[i]] == slot_bundle(&m->p, i)->mu[slot_lane(i)];
    ok(sorted && mu, "its columns ascend, mu is in the contacts' order");
    fclib_delete_local(L);
    free(L), free(u), free(v), free(T);
}

static void test_made(int d, int64_t n, bool global, const char *scratch)
{
    struct made m;
    struct failure failure;
    struct fclib F = { 0 };
    const char *kind = global ? "global" : "local";
    make(&m, d, n);
    struct made before = m;
    if (!ok(write_made(&m, global, scratch),
            "%dD: a %s problem is written without times: %lld contacts", d, kind, (long long)n))
        return;
    bool same = true;
    for (int i = 0; i < BODIES; i++)
        same &= apart(3, m.body[i].v, before.body[i].v) == 0 &&
                apart(3, m.body[i].w, before.body[i].w) == 0;
    ok(same, "and its bodies are left alone");
    if (!ok(load(&F, scratch, &failure) && F.global == global, "and read")) return;
    double *r = noises(n * d), *u = velocity(&F.W, r), *v = pushed(&m, r), e = apart(n * d, u, v);
    ok(e < 1e-13, "W r + q is what pushing the bodies does (%.1e)", e);
    if (!global) test_libfclib_local(&m, scratch, r);
    if (global && n) {
        e = global_residual(&F, scratch, u, r, scratch);
        ok(e < 1e-13, "libfclib reads it; v, u, r solve it (%.1e)", e);
    }
    hid_t file = H5Fopen(scratch, H5F_ACC_RDWR, H5P_DEFAULT);
    failure = (struct failure){ 0 };
    bool stored = !fclib_store_solution(&F, file, u, r, &failure);
    double *back = noises(n * d);
    stored = stored && !read_solution(&F, file, back, &failure);
    H5Fclose(file);
    struct fclib_solution *S = n ? fclib_read_solution(scratch) : NULL; // it needs a contact
    ok(stored && (S || !n) && apart(n * d, back, r) == 0 &&
           (!n || (apart(n * d, S->r, r) == 0 && apart(n * d, S->u, u) == 0)),
       "its solution is stored, and libfclib reads that too");
    if (S) fclib_delete_solutions(S, 1);
    free(back), free(r), free(u), free(v);
    fclib_free(&F);
}

/* ---- (d): nothing wrong is believed ------------------------------------------------------------ */

/* Two contacts in space, W = 1 in CSR; or M = 1, H = 1, G the first column of 1. */
static hid_t good_file(bool global)
{
    hid_t file = memory_file();
    const int32_t three = 3, p[] = { 0, 1, 2, 3, 4, 5, 6 }, i[] = { 0, 1, 2, 3, 4, 5 };
    const double one[] = { 1, 1, 1, 1, 1, 1 };
    if (!global) {
        put_matrix(file, "/fclib_local/W", 6, 6, -2, 6, 7, p, 6, i, one);
        put_ints(file, "/fclib_local/spacedim", 1, &three);
        put_doubles(file, "/fclib_local/vectors/q", 6, one);
        put_doubles(file, "/fclib_local/vectors/mu", 2, one);
        return file;
    }
    put_matrix(file, "/fclib_global/M", 6, 6, -1, 6, 7, p, 6, i, one);
    put_matrix(file, "/fclib_global/H", 6, 6, -2, 6, 7, p, 6, i, one);
    put_matrix(file, "/fclib_global/G", 6, 1, -1, 1, 2, p, 1, i, one);
    put_ints(file, "/fclib_global/spacedim", 1, &three);
    put_doubles(file, "/fclib_global/vectors/f", 6, one);
    put_doubles(file, "/fclib_global/vectors/w", 6, one);
    put_doubles(file, "/fclib_global/vectors/b", 1, one);
    put_doubles(file, "/fclib_global/vectors/mu", 2, one);
    return file;
}

#define HUGE_COUNT ((int64_t)1 << 40)

/* One thing made wrong: x is written at path (kind i: integers, d: reals), or the path is
   deleted (-), a text (t), a group (g) or an unwritten dataset of 2^40 values (h). */
struct wrong {
    const char *what, *path;
    char kind;
    int count;
    double x[8];
    const char *says;
};

static const struct wrong wrongs[] = {
    { "no W", "/fclib_local/W", '-', 0, { 0 }, "/fclib_local/W/m" },
    { "no W/p", "/fclib_local/W/p", '-', 0, { 0 }, "/fclib_local/W/p" },
    { "no q", "/fclib_local/vectors/q", '-', 0, { 0 }, "vectors/q" },
    { "no mu", "/fclib_local/vectors/mu", '-', 0, { 0 }, "vectors/mu" },
    { "no spacedim", "/fclib_local/spacedim", '-', 0, { 0 }, "spacedim" },
    { "spacedim 4", "/fclib_local/spacedim", 'i', 1, { 4 }, "4" },
    { "spacedim 2 of a problem in space", "/fclib_local/spacedim", 'i', 1, { 2 }, "q" },
    { "spacedim 2.5", "/fclib_local/spacedim", 'd', 1, { 2.5 }, "spacedim" },
    { "two spacedims", "/fclib_local/spacedim", 'i', 2, { 3, 3 }, "spacedim" },
    { "W is 5 x 6", "/fclib_local/W/m", 'i', 1, { 5 }, "5 x 6" },
    { "W is 6 x 7", "/fclib_local/W/n", 'i', 1, { 7 }, "6 x 7" },
    { "W has -6 rows", "/fclib_local/W/m", 'i', 1, { -6 }, "-6" },
    { "W is 2^31 - 1 wide", "/fclib_local/W/n", 'i', 1, { 2147483647 }, "2147483647" },
    { "nz -3", "/fclib_local/W/nz", 'i', 1, { -3 }, "-3" },
    { "nz beyond nzmax", "/fclib_local/W/nz", 'i', 1, { 1000000000 }, "nzmax" },
    { "triplets with one p too many", "/fclib_local/W/nz", 'i', 1, { 6 }, "/p" },
    { "nzmax negative", "/fclib_local/W/nzmax", 'i', 1, { -1 }, "nzmax" },
    { "nzmax too small", "/fclib_local/W/nzmax", 'i', 1, { 5 }, "nzmax" },
    { "i too short", "/fclib_local/W/i", 'i', 5, { 0, 1, 2, 3, 4 }, "W/i" },
    { "x too short", "/fclib_local/W/x", 'd', 5, { 1, 1, 1, 1, 1 }, "W/x" },
    { "x too long", "/fclib_local/W/x", 'd', 7, { 1, 1, 1, 1, 1, 1, 1 }, "W/x" },
    { "p too short", "/fclib_local/W/p", 'i', 6, { 0, 1, 2, 3, 4, 5 }, "W/p" },
    { "p empty", "/fclib_local/W/p", 'i', 0, { 0 }, "W/p" },
    { "p falls", "/fclib_local/W/p", 'i', 7, { 0, 1, 3, 2, 4, 5, 6 }, "falls from 3 to 2" },
    { "p begins with 1", "/fclib_local/W/p", 'i', 7, { 1, 1, 2, 3, 4, 5, 6 }, "begins" },
    { "p ends beyond", "/fclib_local/W/p", 'i', 7, { 0, 1, 2, 3, 4, 5, 2e9 }, "nzmax" },
    { "p negative", "/fclib_local/W/p", 'i', 7, { 0, -1, 2, 3, 4, 5, 6 }, "falls" },
    { "i out of range",
      "/fclib_local/W/i",
      'i',
      6,
      { 0, 1, 5000, 3, 4, 5 },
      "/fclib_local/W/i: entry 2 is 5000, W has 6 columns" },
    { "i negative", "/fclib_local/W/i", 'i', 6, { 0, 1, 2, -3, 4, 5 }, "entry 3 is -3" },
    { "i real", "/fclib_local/W/i", 'd', 6, { 0, 1, 2, 3, 4, 5 }, "integers" },
    { "NaN in W", "/fclib_local/W/x", 'd', 6, { 1, 1, 1, NAN, 1, 1 }, "W/x: entry 3" },
    { "infinity in q", "/fclib_local/vectors/q", 'd', 6, { 1, INFINITY, 1, 1, 1, 1 }, "entry 1" },
    { "mu negative", "/fclib_local/vectors/mu", 'd', 2, { 0.5, -0.1 }, "entry 1 is -0.1" },
    { "mu NaN", "/fclib_local/vectors/mu", 'd', 2, { NAN, 0 }, "entry 0" },
    { "mu too long", "/fclib_local/vectors/mu", 'd', 3, { 0 }, "q" },
    { "mu of no contact", "/fclib_local/vectors/mu", 'd', 0, { 0 }, "q" },
    { "q too short", "/fclib_local/vectors/q", 'd', 5, { 0 }, "5 values, 6" },
    { "q a text", "/fclib_local/vectors/q", 't', 0, { 0 }, "numbers" },
    { "q a group", "/fclib_local/vectors/q", 'g', 0, { 0 }, "vectors/q" },
    { "q says that it is huge", "/fclib_local/vectors/q", 'h', 0, { 0 }, "--unpack allows more" },
    { "W/i says that it is huge", "/fclib_local/W/i", 'h', 0, { 0 }, "--unpack allows more" },
    { "a mixed problem", "/fclib_local/V", 'g', 0, { 0 }, "mixed" },
    { "neither local nor global", "/fclib_local", '-', 0, { 0 }, "neither particles nor" },
    { "no M", "/fclib_global/M", '-', 0, { 0 }, "M/m" },
    { "no f", "/fclib_global/vectors/f", '-', 0, { 0 }, "vectors/f" },
    { "no b beside G", "/fclib_global/vectors/b", '-', 0, { 0 }, "vectors/b" },
    { "w too long", "/fclib_global/vectors/w", 'd', 7, { 0 }, "7 values, 6" },
    { "H too wide", "/fclib_global/H/n", 'i', 1, { 9 }, "6 x 9" },
    { "G too wide", "/fclib_global/G/n", 'i', 1, { 2 }, "6 x 2" },
    { "G/i out of range", "/fclib_global/G/i", 'i', 1, { 6 }, "G has 6 rows" },
    { "M singular", "/fclib_global/M/x", 'd', 6, { 1, 1, 1, 1, 1, 0 }, "singular" },
    { "M all zero", "/fclib_global/M/x", 'd', 6, { 0 }, "singular" },
    { "M nearly singular", "/fclib_global/M/i", 'i', 6, { 0, 1, 2, 2, 4, 5 }, "singular" },
    { "G zero", "/fclib_global/G/x", 'd', 1, { 0 }, "singular" },
};

static void spoil(hid_t file, const struct wrong *w)
{
    struct failure failure = { 0 };
    int32_t integers[8];
    for (int k = 0; k < 8; k++) integers[k] = w->kind == 'i' ? (int32_t)w->x[k] : 0;
    if (h5_has(file, w->path)) H5Ldelete(file, w->path, H5P_DEFAULT);
    if (w->kind == 'i') put_ints(file, w->path, w->count, integers);
    if (w->kind == 'd') put_doubles(file, w->path, w->count, w->x);
    if (w->kind == 't') h5_write_text(file, w->path, "six", &failure);
    if (w->kind == 'g') h5_group(file, w->path, &failure);
    if (w->kind != 'h') return;
    hsize_t huge = HUGE_COUNT;
    hid_t space = H5Screate_simple(1, &huge, NULL);
    H5Dclose(
        H5Dcreate2(file, w->path, H5T_NATIVE_INT32, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    H5Sclose(space);
}

static void test_wrong(const struct wrong *w)
{
    hid_t file = good_file(strncmp(w->path, "/fclib_global", 13) == 0);
    struct failure failure = { 0 };
    struct fclib F = { 0 };
    bool good = !read_problem(&F, file, &failure);
    if (good) fclib_free(&F);
    spoil(file, w);
    int e = read_problem(&F, file, &failure);
    if (!e) fclib_free(&F);
    ok(good && e == EX_DATAERR && failure.status == e && strstr(failure.text, w->says), "%s: %s",
       w->what, failure.text);
    H5Fclose(file);
}

static void test_wrong_solution(void)
{
    hid_t file = good_file(false);
    struct failure failure = { 0 };
    struct fclib F = { 0 };
    double r[6] = { 1, 1, 1, 1, 1, 1 };
    ok(!read_problem(&F, file, &failure) && !read_solution(&F, file, r, &failure) &&
           norm(6, r) == 0,
       "without a solution r = 0");
    put_doubles(file, "/solution/r", 5, r);
    ok(read_solution(&F, file, r, &failure) == EX_DATAERR, "a short one: %s", failure.text);
    fclib_free(&F);
    H5Fclose(file);
}

int main(void)
{
    h5_start();
    char scratch[] = "/tmp/nsd-fclib-XXXXXX";
    int fd = mkstemp(scratch);
    if (fd < 0) return 1;
    close(fd);
    test_forms();
    test_empty();
    for (size_t k = 0; k < sizeof wrongs / sizeof *wrongs; k++) test_wrong(&wrongs[k]);
    test_wrong_solution();
    test_multipliers(scratch);
    for (int d = 2; d <= 3; d++)
        for (int global = 0; global < 2; global++) {
            test_made(d, CONTACTS, global, scratch);
            test_made(d, 1, global, scratch);
            test_made(d, 0, global, scratch);
        }
    test_collection(scratch);
    unlink(scratch);
    H5close();
    return tap_done();
}
