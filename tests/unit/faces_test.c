/* Contacts that repeat one another are found in W, and the system solved without them is the same. */
#include "solve/faces.h"
#include "solve/ipm.h"
#include "solve/nlgs.h"
#include "solve/system.h"
#include "step/step.h"
#include "tap.h"

#include <gsl/gsl_linalg.h>
#include <gsl/gsl_rng.h>
#include <stdlib.h>
#include <string.h>

enum { NX = 4, NY = 3, MOST = 2048 };

/* A wall in running bond on the ground: W = H' M^-1 H, q = H' v_free */
struct bricks {
    int d, n, size; /* contacts; n d */
    double *W;      /* [size][size] */
    double *q, *mu;
};

struct point {
    int body[2]; /* below, above; -1: the ground */
    double x[3];
};

static gsl_rng *rng;

static double number(double low, double high)
{
    return low + (high - low) * gsl_rng_uniform(rng);
}

static double random_sign(void)
{
    return gsl_rng_uniform(rng) < 0.5 ? -1 : 1;
}

/* Bricks 2 x 1 x 1, every second row half a brick further on; a face is where two overlap. */
static int points(struct point *p, int d, int each)
{
    int n = 0;
    for (int row = 0; row < NY; row++)
        for (int i = 0; i < NX; i++)
            for (int j = row ? 0 : -1; j < (row ? NX : 0); j++) {
                double left = 2 * i + row % 2, below = 2 * j + (row - 1) % 2;
                double a = row ? fmax(left, below) : left,
                       b = row ? fmin(left, below) + 2 : left + 2;
                for (int k = 0; b - a > 0.5 && k < each; k++, n++) {
                    p[n].body[0] = row ? (row - 1) * NX + j : -1, p[n].body[1] = row * NX + i;
                    p[n].x[0] = a + (b - a) * (each > 4 ? number(0.1, 0.9) : k % 2 ? 0.9 : 0.1);
                    p[n].x[1] = d == 3 ? each > 4 ? number(-0.5, 0.5) : k / 2 - 0.5 : 0;
                    p[n].x[2] = row;
                }
            }
    return n;
}

/* The velocity of a point of a body that moves with unit speed k of 6: normal (z), then x and y */
static void moves(int k, const double arm[3], double u[3])
{
    double v[3] = { k == 0, k == 1, k == 2 }, w[3] = { k == 3, k == 4, k == 5 };
    for (int i = 0; i < 3; i++)
        v[i] += w[(i + 1) % 3] * arm[(i + 2) % 3] - w[(i + 2) % 3] * arm[(i + 1) % 3];
    u[0] = v[2], u[1] = v[0], u[2] = v[1];
}

/* How contact c's velocity (n, t1, t2; d of them) changes with speed k of the body on side s */
static void jacobian(const struct point *p, int s, int k, double u[3])
{
    int body = p->body[s];
    double centre[3] = { 2 * (body % NX) + body / NX % 2 + 1, 0, body / NX + 0.5 }, arm[3];
    for (int i = 0; i < 3; i++) arm[i] = p->x[i] - centre[i];
    moves(k, arm, u);
    for (int i = 0; i < 3 && !s; i++) u[i] = -u[i];
}

static struct bricks lay(int d, int each)
{
    static struct point p[MOST];
    struct bricks w = { .d = d, .n = points(p, d, each) };
    w.size = d * w.n;
    w.W = calloc((size_t)(w.size * w.size), sizeof *w.W);
    w.q = calloc((size_t)w.size, sizeof *w.q), w.mu = calloc((size_t)w.n, sizeof *w.mu);
    for (int a = 0; a < w.n; a++) w.mu[a] = 0.5;
    for (int body = 0; body < NX * NY; body++)
        for (int k = 0; k < 6; k++) {
            if (d == 2 && k != 0 && k != 2 && k != 4) continue; // in the plane
            double m = (k < 3 ? 1 : 1.0 / 3) * (1 + body % 3), ua[3], ub[3];
            double free_speed = (k == 2 ? -1 : 0) + number(-0.2, 0.2);
            for (int a = 0; a < 2 * w.n; a++) {
                if (p[a / 2].body[a % 2] != body) continue;
                jacobian(p + a / 2, a % 2, k, ua);
                for (int i = 0; i < d; i++) w.q[d * (a / 2) + i] += ua[i] * free_speed;
                for (int b = 0; b < 2 * w.n; b++) {
                    if (p[b / 2].body[b % 2] != body) continue;
                    jacobian(p + b / 2, b % 2, k, ub);
                    for (int i = 0; i < d; i++)
                        for (int j = 0; j < d; j++)
                            w.W[(d * (a / 2) + i) * w.size + d * (b / 2) + j] += ua[i] * ub[j] / m;
                }
            }
        }
    return w;
}

static void bricks_free(struct bricks *w)
{
    free(w->W), free(w->q), free(w->mu);
}

static struct delassus delassus(const struct bricks *w)
{
    struct delassus W;
    struct failure failure = { 0 };
    int64_t n = (int64_t)w->size * w->size, k = 0;
    int32_t *row = malloc((size_t)n * sizeof *row), *col = malloc((size_t)n * sizeof *col);
    double *x = malloc((size_t)n * sizeof *x);
    for (int64_t i = 0; i < n; i++)
        if (w->W[i] != 0)
            row[k] = (int32_t)(i / w->size), col[k] = (int32_t)(i % w->size), x[k++] = w->W[i];
    const struct sparse A = { .count = k, .row = row, .col = col, .x = x };
    if (delassus_init(&W, w->d, w->n, &A, &failure)) {
        printf("Bail out! %s\n", failure.text);
        exit(1);
    }
    memcpy(W.q, w->q, (size_t)w->size * sizeof *W.q);
    memcpy(W.mu, w->mu, (size_t)w->n * sizeof *W.mu);
    free(row), free(col), free(x);
    return W;
}

static struct scaled scaled(struct delassus *W, struct problem *p)
{
    struct scaled w;
    struct failure failure = { 0 };
    if (problem_prepare_delassus(p, W, &(struct prepare_opt){ .rho_factor = 1 }, &failure) ||
        scaled_init(&w, p, &failure)) {
        printf("Bail out! %s\n", failure.text);
        exit(1);
    }
    return w;
}

/* W x of a basis vector: entry (i, j) of the scaled W, by a way that knows no faces */
static double *dense(const struct scaled *w)
{
    double *a = malloc((size_t)w->size * (size_t)w->size * sizeof *a);
    double *e = calloc((size_t)w->size + 4, sizeof *e), *v = calloc((size_t)w->size + 4, sizeof *v);
    for (int j = 0; j < w->size; j++) {
        e[j] = 1;
        scaled_product(w, e, v);
        for (int i = 0; i < w->size; i++) a[i * w->size + j] = v[i];
        e[j] = 0;
    }
    free(e), free(v);
    return a;
}

/* The largest entry of W - T S T' */
static double apart(const struct faces *f, const double *W, int d, int size)
{
    double *T = calloc((size_t)size * (size_t)f->size, sizeof *T), most = 0;
    double *TS = calloc((size_t)size * (size_t)f->size, sizeof *TS);
    for (int32_t k = 0; k < f->n; k++) {
        const struct face *g = f->face + k;
        for (int i = 0; i < g->rows; i++)
            for (int j = 0; j < g->rank; j++)
                T[(d * g->contact[i / d] + i % d) * f->size + g->at + j] =
                    g->rank < g->rows ? g->T[i * g->rank + j] : i == j;
    }
    for (int i = 0; i < size; i++)
        for (int k = 0; k < f->size; k++)
            for (int32_t e = f->first[k]; e < f->first[k + 1]; e++)
                TS[i * f->size + f->col[e]] += T[i * f->size + k] * f->S[e];
    for (int i = 0; i < size; i++)
        for (int j = 0; j < size; j++) {
            double w = 0;
            for (int k = 0; k < f->size; k++) w += TS[i * f->size + k] * T[j * f->size + k];
            most = fmax(most, fabs(w - W[i * size + j]));
        }
    free(T), free(TS);
    return most;
}

static void test_faces(int d, int each, int rank)
{
    struct bricks w = lay(d, each);
    struct delassus W = delassus(&w);
    struct problem p;
    struct scaled all = scaled(&W, &p);
    struct faces f;
    double *a = dense(&all);
    ok(faces_init(&f, &all.W), "%dD, %d points a face: looked for", d, each);
    int scaled_faces = 0;
    for (int32_t k = 0; k < f.n; k++)
        scaled_faces += f.face[k].count == each && f.face[k].rank == rank;
    ok(scaled_faces * each == w.n && f.size == scaled_faces * rank,
       "%d contacts are %d faces of rank %d", w.n, scaled_faces, rank);
    double off = apart(&f, a, d, all.size);
    ok(off < 1e-9, "W = T S T' (%.1e)", off);
    faces_free(&f), scaled_free(&all), problem_free(&p), delassus_free(&W);

    // one in 1e4 of noise, and nothing repeats
    for (int i = 0; i < w.size; i++)
        for (int j = 0; j <= i; j++)
            w.W[i * w.size + j] = w.W[j * w.size + i] *= 1 + 1e-4 * number(-1, 1);
    W = delassus(&w), all = scaled(&W, &p);
    ok(faces_init(&f, &all.W) && f.size == all.size, "with noise nothing repeats");
    faces_free(&f), scaled_free(&all), problem_free(&p), delassus_free(&W);
    free(a), bricks_free(&w);
}

/* D of sizes from `least` to 1/least, as where contacts stick and part, L nearly 1 */
static void test_system(int d, int each, double least)
{
    struct bricks w = lay(d, each);
    struct delassus W = delassus(&w);
    struct problem p;
    struct scaled all = scaled(&W, &p);
    bool large;
    struct system *s = system_new(&all, 1e9, &large);
    int n = all.size;
    double *a = dense(&all), *x = calloc((size_t)n, sizeof *x), *b = calloc((size_t)n, sizeof *b);
    double *L = calloc(9 * (size_t)w.n, sizeof *L), *D = calloc(9 * (size_t)w.n, sizeof *D);
    for (int c = 0; c < w.n; c++) {
        double size = pow(least, number(-1, 1)),
               v[3] = { number(-1, 1), number(-1, 1), number(-1, 1) };
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                L[9 * c + 3 * i + j] = i == j ? 1 : i ? 0 : 0.5 * random_sign();
                D[9 * c + 3 * i + j] = size * ((i == j) + v[i] * v[j]);
            }
    }
    for (int i = 0; i < n; i++) x[i] = b[i] = number(-1, 1);
    bool solved = system_solve(s, L, D, x), again = true;
    for (int round = 0; round < 2; round++) {
        double worst = 0;
        for (int i = 0; i < n; i++) {
            double e = b[i], scale = fabs(b[i]);
            for (int k = 0; k < d; k++) {
                const int c = i / d;
                double v = 0;
                for (int j = 0; j < n; j++) v += a[(d * c + k) * n + j] * x[j];
                double t[2] = { L[9 * c + 3 * (i % d) + k] * v,
                                D[9 * c + 3 * (i % d) + k] * x[d * c + k] };
                e -= t[0] + t[1], scale = fmax(scale, fmax(fabs(t[0]), fabs(t[1])));
            }
            worst = fmax(worst, fabs(e) / scale);
        }
        ok(solved && again && worst < 1e-7,
           "%dD, %d points, D from %.0e to %.0e, %s: residual %.1e", d, each, least, 1 / least,
           round ? "again" : "solved", worst);
        for (int i = 0; i < n; i++) x[i] = b[i] = number(-1, 1);
        if (!round) again = system_solve_again(s, x);
    }
    system_free(s), scaled_free(&all), problem_free(&p), delassus_free(&W), bricks_free(&w);
    free(a), free(x), free(b), free(L), free(D);
}

/* The sign of the determinant, against that of the dense matrix */
static void test_sign(int d, int each)
{
    struct bricks w = lay(d, each);
    struct delassus W = delassus(&w);
    struct problem p;
    struct scaled all = scaled(&W, &p);
    bool large;
    struct system *s = system_new(&all, 1e9, &large);
    size_t n = (size_t)all.size;
    double *a = dense(&all), *x = calloc(n, sizeof *x);
    double *L = calloc(9 * (size_t)w.n, sizeof *L), *D = calloc(9 * (size_t)w.n, sizeof *D);
    gsl_matrix *A = gsl_matrix_alloc(n, n);
    gsl_permutation *P = gsl_permutation_alloc(n);
    int agree = 0, negative = 0;
    enum { ROUNDS = 40 };
    for (int round = 0; round < ROUNDS; round++) {
        for (int c = 0; c < w.n; c++)
            for (int i = 0; i < 9; i++) {
                L[9 * c + i] = i % 4 ? 0.3 * number(-1, 1) : 1;
                D[9 * c + i] = i % 4 ? number(-1, 1) : number(-1, 2);
            }
        for (size_t i = 0; i < n; i++)
            for (size_t j = 0; j < n; j++) {
                size_t c = i / (size_t)d, row = i % (size_t)d;
                double sum = j / (size_t)d == c ? D[9 * c + 3 * row + j % (size_t)d] : 0;
                for (size_t k = 0; k < (size_t)d; k++)
                    sum += L[9 * c + 3 * row + k] * a[((size_t)d * c + k) * n + j];
                gsl_matrix_set(A, i, j, sum);
            }
        int sign;
        gsl_linalg_LU_decomp(A, P, &sign);
        sign = gsl_linalg_LU_sgndet(A, sign);
        for (size_t i = 0; i < n; i++) x[i] = number(-1, 1);
        system_solve(s, L, D, x);
        agree += sign == system_sign(s), negative += sign < 0;
    }
    ok((agree == 0 || agree == ROUNDS) && negative > 0 && negative < ROUNDS,
       "%dD, %d points: the sign of %d determinants, %d negative, is right %d times", d, each,
       ROUNDS, negative, agree);
    gsl_matrix_free(A), gsl_permutation_free(P);
    system_free(s), scaled_free(&all), problem_free(&p), delassus_free(&W), bricks_free(&w);
    free(a), free(x), free(L), free(D);
}

/* The interior point method of all contacts, after sweeps */
static int in_the_interior(struct solve *s)
{
    struct newton w;
    if (nlgs_sweeps(s, 500, 1.3)) return -1;
    if (solve_over(s)) return 0;
    if (newton_init(&w, s) || solve_keep_best(s)) return -1;
    ipm_solve(&w, s);
    newton_free(&w);
    return 0;
}

/* A wall, whose W has no inverse, by the interior point method and by auto */
static void test_wall(int d, int each, const struct solver *global)
{
    struct bricks w = lay(d, each);
    struct delassus W = delassus(&w);
    struct failure failure = { 0 };
    struct report rep = { 0 };
    double *u = calloc((size_t)w.size, sizeof *u), worst = 0;
    struct step_opt o = { .order = ORDER_COLOUR,
                          .solve = { .global = global,
                                     .method = &local_exact,
                                     .criterion = CRITERION_NATURAL,
                                     .eps = 1e-10,
                                     .max_sweeps = 100000,
                                     .threads = 1,
                                     .local = { .newton_eps = 1e-13, .newton_max = 100 } } };
    bool solved = !step_solve_delassus(&W, u, &o, &rep, &failure) && rep.converged;
    for (int i = 0; i < w.size; i++) {
        double v = w.q[i];
        for (int j = 0; j < w.size; j++) v += w.W[i * w.size + j] * W.r[j];
        worst = fmax(worst, fabs(v - u[i]));
    }
    ok(solved && worst < 1e-8,
       "%dD, %d points: %s after %d sweeps, %d Newton steps; u = W r + q to %.1e", d, each,
       global->name, (int)rep.sweeps, (int)rep.newton, worst);
    report_free(&rep), delassus_free(&W), bricks_free(&w);
    free(u);
}

int main(void)
{
    rng = gsl_rng_alloc(gsl_rng_mt19937);
    test_faces(3, 4, 6), test_faces(3, 8, 6), test_faces(2, 2, 3);
    for (int k = 0; k < 3; k++) {
        double least = k ? k == 1 ? 1e-4 : 1e-9 : 1;
        test_system(3, 4, least), test_system(3, 1, least), test_system(2, 2, least);
    }
    test_sign(3, 1), test_sign(3, 4), test_sign(2, 2);
    static const struct solver ipm = { "interior point", "", 0, in_the_interior };
    const struct solver *const tested[] = { &ipm, &solver_auto };
    for (int k = 0; k < 2; k++)
        test_wall(3, 4, tested[k]), test_wall(3, 8, tested[k]), test_wall(2, 2, tested[k]);
    gsl_rng_free(rng);
    return tap_done();
}
