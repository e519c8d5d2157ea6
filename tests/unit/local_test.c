/*
 * The five local methods on random one-contact problems, judged by the law itself and not by their
 * own formulas.
 */
#include "base/matrix.h"
#define METHOD_CODE
#include "solve/method.h"
#include "tap.h"

#include <gsl/gsl_deriv.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_rng.h>
#include <string.h>

enum { PROBLEMS = 10000 };

static gsl_rng *rng;
static double flat(double a, double b)
{
    return a + (b - a) * gsl_rng_uniform(rng);
}
static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
static double norm(const double a[3])
{
    return sqrt(dot(a, a));
}
static double normt(const double a[3])
{
    return hypot(a[1], a[2]);
}

/* One contact alone, in one lane, without relaxation; sets l->v = W r + b first. */
static void method_solve(const struct method *m, struct local *l, const struct local_opt *opt)
{
    local_velocity(l, l->r, l->v);
    l->relax = 1;
    switch (m->id) {
#define CASE(name, ...)                                                                            \
    case METHOD_##name:                                                                            \
        name##_solve(l, opt);                                                                      \
        break;
        EACH_METHOD(CASE)
#undef CASE
    case METHOD_COUNT:
        break;
    }
}

/* As eal_linearise(), of the Newton of EBP [predbipo; corrected] */
static enum local_status ebp_linearise(double mu, double rho, const double r[3], const double v[3],
                                       double Z[3], double A[3][3], double B[3][3])
{
    return newton_linearise(mu, rho, r, v, EBP, Z, A, B);
}

/* ---- derivatives ---------------------------------------------------------------------------- */

typedef enum local_status linearise(double mu, double rho, const double r[3], const double v[3],
                                    double Z[3], double A[3][3], double B[3][3]);

struct state {
    linearise *f;
    double mu, rho, x[6]; /* r, v */
    int i, j;             /* dZ_i/dx_j */
};

static double z_of(double x, void *p)
{
    struct state s = *(struct state *)p;
    double Z[3], A[3][3], B[3][3];
    s.x[s.j] = x;
    s.f(s.mu, s.rho, s.x, s.x + 3, Z, A, B);
    return Z[s.i];
}

/* A state on a random branch, at least 1e-3 from any kink. */
static enum local_status random_state(struct state *s, int d)
{
    for (;;) {
        double Z[3], A[3][3], B[3][3];
        s->mu = flat(0.05, 1.5), s->rho = flat(0.2, 2);
        for (int k = 0; k < 6; k++) s->x[k] = d == 2 && k % 3 == 2 ? 0 : flat(-1, 1);
        enum local_status status = s->f(s->mu, s->rho, s->x, s->x + 3, Z, A, B);
        bool near = normt(s->x + 3) < 0.02;
        for (int k = 0; k < 64; k++) { // kinks are where a neighbour is on another branch
            struct state y = *s;
            for (int j = 0; j < 6; j++) y.x[j] += (k >> j & 1) ? 4e-3 : -4e-3;
            near |= y.f(y.mu, y.rho, y.x, y.x + 3, Z, A, B) != status;
        }
        if (!near) return status;
    }
}

static void test_derivatives(const char *name, linearise *f)
{
    static const char *const branch[] = { "free", "stick", "slide" };
    double worst[3][2] = { 0 };
    int count[3] = { 0 };
    for (int n = 0; n < 2000; n++) {
        struct state s = { .f = f };
        double Z[3], A[3][3], B[3][3], slope, error;
        enum local_status status = random_state(&s, 3);
        f(s.mu, s.rho, s.x, s.x + 3, Z, A, B);
        count[status]++;
        for (s.i = 0; s.i < 3; s.i++)
            for (s.j = 0; s.j < 6; s.j++) {
                gsl_function g = { z_of, &s };
                gsl_deriv_central(&g, s.x[s.j], 1e-4, &slope, &error);
                double *w = &worst[status][s.j / 3];
                *w = fmax(*w, fabs(slope - (s.j < 3 ? A[s.i][s.j] : B[s.i][s.j - 3])));
            }
    }
    for (int k = 0; k < 3; k++) {
        diag("%s %s: %d states, |dA| %.1e, |dB| %.1e", name, branch[k], count[k], worst[k][0],
             worst[k][1]);
        ok(count[k] > 50 && worst[k][0] < 1e-6, "%s: A is dZ/dr, %s", name, branch[k]);
        ok(count[k] > 50 && worst[k][1] < 1e-6, "%s: B is dZ/dv, %s", name, branch[k]);
    }
}

/* The paper's sliding formulas of the plane, as corrected. */
static void test_planar_formulas(const char *name, linearise *f, bool bipotential)
{
    double worst = 0;
    int slides = 0;
    while (slides < 500) {
        struct state s = { .f = f };
        double Z[3], A[3][3], B[3][3];
        if (random_state(&s, 2) != LOCAL_SLIDE) continue;
        slides++;
        f(s.mu, s.rho, s.x, s.x + 3, Z, A, B);
        double mu = s.mu, rho = s.rho, c = 1 / (1 + mu * mu);
        double tr = s.x[1] - rho * s.x[4] > 0 ? 1 : -1, tv = s.x[4] > 0 ? 1 : -1;
        double a_ebp[2][2] = { { c * mu * mu, -c * mu * tr }, { -c * mu * tr, c } };
        double b_ebp[2][2] = { { rho * c, rho * mu * c * (tv + tr) },
                               { rho * c * mu * tr, rho * mu * mu * c * (1 + tr * tv) } };
        double a_eal[2][2] = { { 0, 0 }, { -mu * tr, 1 } };
        double b_eal[2][2] = { { rho, 0 }, { rho * mu * tr, 0 } };
        for (int i = 0; i < 2; i++)
            for (int j = 0; j < 2; j++) {
                worst = fmax(worst, fabs(A[i][j] - (bipotential ? a_ebp : a_eal)[i][j]));
                worst = fmax(worst, fabs(B[i][j] - (bipotential ? b_ebp : b_eal)[i][j]));
            }
    }
    ok(worst < 1e-12, "%s: sliding in the plane, A and B are the paper's as corrected", name);
}

/* Where balls slide the step is in closed form: that of the whole system, of W = diag(w_n, w_t, w_t). */
static void test_slip(const char *name, linearise *f, enum newton_formulation form)
{
    double worst = 0;
    int slid = 0;
    for (int n = 0; n < PROBLEMS; n++) {
        struct state s = { .f = f };
        double w[3] = { flat(0.1, 1), flat(1, 3) }, iw[3], W[9] = { 0 }, dr[2][3], big = 0;
        w[2] = w[1];
        if (random_state(&s, 2 + n % 2) != LOCAL_SLIDE) continue;
        for (int i = 0; i < 3; i++) W[4 * i] = w[i], iw[i] = 1 / w[i];
        for (int k = 0; k < 2; k++) {
            struct local l = { .W = k ? W : NULL, .mu = s.mu, .rho = s.rho };
            struct newton_point x = { .r = { s.x[0], s.x[1], s.x[2] },
                                      .v = { s.x[3], s.x[4], s.x[5] } };
            for (int i = 0; i < 3; i++) l.w[i] = w[i], l.iw[i] = iw[i];
            BY_FORMULATION(form, residual, l.mu, l.rho, &x);
            newton_direction(&l, &x, form, dr[k]);
        }
        for (int i = 0; i < 3; i++) big = fmax(big, fabs(dr[1][i]));
        for (int i = 0; i < 3; i++) worst = fmax(worst, fabs(dr[0][i] - dr[1][i]) / big);
        slid++;
    }
    ok(slid > 500 && worst < 1e-10,
       "%s: the step of balls that slide is that of their W, to %.1e of %d", name, worst, slid);
}

/* ---- cone ----------------------------------------------------------------------------------- */

static void test_cone(void)
{
    double idem = 0, out = 0, moreau = 0, brute = 0;
    for (int n = 0; n < PROBLEMS; n++) {
        double mu = n % 10 ? flat(0, 1.5) : 0, tau[3], p[3], pp[3], q[3], s[3];
        for (int k = 0; k < 3; k++) tau[k] = flat(-1, 1);
        if (n % 7 == 0) tau[1] = tau[2] = 0;
        cone_project(mu, tau, p);
        cone_project(mu, p, pp);
        for (int k = 0; k < 3; k++) q[k] = tau[k] - p[k], s[k] = pp[k] - p[k];
        idem = fmax(idem, norm(s));
        out = fmax(out, fmax(-p[0], normt(p) - mu * p[0]));
        // tau = p + q, p in K, q in the polar cone, p.q = 0
        moreau = fmax(moreau, fmax(fabs(dot(p, q)), mu * normt(q) + q[0]));
        for (int k = 0; k < 50; k++) {
            double rn = flat(0, 2), t = mu * rn * gsl_rng_uniform(rng), a = flat(0, 2 * M_PI);
            double e[3] = { rn - tau[0], t * cos(a) - tau[1], t * sin(a) - tau[2] };
            brute = fmax(brute, norm(q) - norm(e));
        }
    }
    ok(idem < 1e-15, "cone projection: idempotent (%.1e)", idem);
    ok(out < 1e-15, "cone projection: into the cone (%.1e)", out);
    ok(moreau < 1e-15, "cone projection: the rest is in the polar cone and orthogonal (%.1e)",
       moreau);
    ok(brute < 1e-15, "cone projection: no point of the cone is nearer (%.1e)", brute);
}

/* ---- random problems ------------------------------------------------------------------------ */

enum kind { BALLS, SPD, UNSYMMETRIC, IMPACT, KINDS };
static const char *const kind_name[] = { "balls", "SPD", "nearly symmetric", "D^-1 W, e in 0..1" };

struct one {
    struct local l;
    double W[9];
};

static void random_rotation(double R[3][3])
{
    double q[4], n = 0;
    for (int k = 0; k < 4; k++) q[k] = flat(-1, 1), n += q[k] * q[k];
    for (int k = 0; k < 4; k++) q[k] /= sqrt(n);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int k = 3 - i - j;
            double sign = (j - i + 3) % 3 == 1 ? -1 : 1;
            R[i][j] = i == j ? 1 - 2 * (1 - q[0] * q[0] - q[1 + i] * q[1 + i])
                             : 2 * (q[1 + i] * q[1 + j] + sign * q[0] * q[1 + k]);
        }
}

/* W with the eigenvalues e, two of them in the plane for d = 2 */
static void random_W(double W[9], int d, const double e[3])
{
    double R[3][3];
    random_rotation(R);
    if (d == 2) {
        double a = flat(0, 2 * M_PI);
        memset(R, 0, sizeof R);
        R[0][0] = R[1][1] = cos(a), R[1][0] = sin(a), R[0][1] = -sin(a), R[2][2] = 1;
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            W[3 * i + j] = 0;
            for (int k = 0; k < 3; k++) W[3 * i + j] += R[i][k] * e[k] * R[j][k];
        }
    if (d == 2) W[8] = fabs(W[4]) + 1e-3;
}

/* An eigenvalue in 10^-decades .. 1 */
static double eigenvalue(double decades)
{
    return pow(10, flat(-decades, 0));
}

static void random_problem(struct one *o, enum kind kind, int d, double decades)
{
    struct local *l = &o->l;
    double unit = pow(10, flat(-6, 6)), speed = pow(10, flat(-6, 3));
    double en = gsl_rng_uniform(rng), et = gsl_rng_uniform(rng);
    *l = (struct local){ .d = d, .mu = gsl_rng_uniform_int(rng, 20) ? flat(0, 1.5) : 0 };
    if (kind == BALLS) {
        l->w[0] = unit / (1 + en), l->w[1] = l->w[2] = 3.5 * unit / (1 + et);
        memset(o->W, 0, sizeof o->W);
        for (int k = 0; k < 3; k++) o->W[4 * k] = l->w[k], l->iw[k] = 1 / l->w[k];
    } else {
        double e[3] = { eigenvalue(decades), eigenvalue(decades), eigenvalue(decades) };
        double smallest = fmin(e[0], fmin(e[1], e[2]));
        random_W(o->W, d, e);
        l->W = o->W;
        for (int i = 0; i < 9; i++) {
            bool pad = d == 2 && (i % 3 == 2 || i / 3 == 2);
            if (kind == UNSYMMETRIC && !pad) o->W[i] += 0.1 * smallest * flat(-1, 1);
            if (kind == IMPACT) o->W[i] /= 1 + (i < 3 ? en : et);
            o->W[i] *= unit;
        }
        for (int i = 0; i < 3; i++) l->w[i] = o->W[4 * i];
    }
    for (int k = 0; k < d; k++) l->b[k] = speed * flat(-1, 1);
    if (gsl_rng_uniform_int(rng, 2)) l->b[0] = -fabs(l->b[0]);
    if (gsl_rng_uniform_int(rng, 10) == 0) l->b[1] = l->b[2] = 0;
    l->rho = 1 / local_lambda_max(o->W);
    if (gsl_rng_uniform_int(rng, 3)) { // else r = 0
        double tau[3] = { 0 };
        for (int k = 0; k < d; k++) tau[k] = speed / unit * flat(-3, 3);
        cone_project(l->mu, tau, l->r);
    }
}

/*
 * How far (r, W r + b) is from the law, without units: r over |r| + rho |b|, u over that over rho.
 * The least of the two sides of each alternative; rho scales, no projection is used.
 */
static double law_error(const struct one *o)
{
    const struct local *l = &o->l;
    const double *r = l->r, *W = o->W;
    double scale = norm(r) + l->rho * norm(l->b) + 1e-300, u[3];
    for (int i = 0; i < 3; i++)
        u[i] = l->rho * (W[3 * i] * r[0] + W[3 * i + 1] * r[1] + W[3 * i + 2] * r[2] + l->b[i]);
    double rt = normt(r), ut = normt(u);
    double signorini = fmax(fabs(fmin(u[0], r[0])), fmax(-u[0], -r[0]));
    double cone = fmax(0, rt - l->mu * r[0]);
    double slip = fmin(ut, fabs(l->mu * r[0] - rt)); // u_t = 0 or on the mantle
    double oblique = fmin(ut, fabs(u[1] * r[2] - u[2] * r[1]) / (rt + 1e-300)); // u_t along r_t
    double along = fmin(ut, fmax(0, (u[1] * r[1] + u[2] * r[2]) / (rt + 1e-300)));
    if (r[0] <= 1e-14 * scale || l->mu == 0) oblique = along = slip = 0;
    double e = fmax(fmax(signorini, cone), fmax(slip, fmax(oblique, along))) / scale;
    return isfinite(e) ? e : INFINITY;
}

static bool finite_in_cone(const struct local *l)
{
    for (int k = 0; k < 3; k++)
        if (!isfinite(l->r[k])) return false;
    return l->r[0] >= 0 && normt(l->r) <= l->mu * l->r[0] * (1 + 1e-14);
}

static const struct local_opt fast = { .newton_eps = 1e-12, .newton_max = 100 };
static const struct local_opt plain = { .plain = true, .newton_eps = 1e-12, .newton_max = 100 };

static void test_law(const struct method *m, enum kind kind, int d)
{
    int gave_up = 0, safeguarded = 0, broken = 0, most = 0;
    double worst = 0, steps = 0;
    for (int n = 0; n < PROBLEMS; n++) {
        struct one o;
        random_problem(&o, kind, d, 4);
        method_solve(m, &o.l, &fast);
        gave_up += o.l.gave_up != 0;
        safeguarded += o.l.safeguarded != 0;
        broken += !finite_in_cone(&o.l) || (m != &local_exact && o.l.steps < 1);
        broken += d == 2 && o.l.r[2] != 0;
        if (!o.l.gave_up) worst = fmax(worst, law_error(&o));
        steps += o.l.steps;
        if (o.l.steps > most) most = o.l.steps;
    }
    diag("%s, %s, %dD: worst %.1e, gave up %d, safeguarded %d, steps %.2f (most %d) of %d problems",
         m->name, kind_name[kind], d, worst, gave_up, safeguarded, steps / PROBLEMS, most,
         PROBLEMS);
    ok(worst < 1e-10 && !gave_up, "%s, %s, %dD: the law holds", m->name, kind_name[kind], d);
    ok(!broken, "%s, %s, %dD: r finite and in the cone", m->name, kind_name[kind], d);
}

/*
 * One projected step again and again, the sweep of a single contact. With W_nt and a large mu, SAL
 * needs a smaller rho than 2/lambda_max.
 */
static void test_iterated(const struct method *m, enum kind kind, int d)
{
    int slow = 0, broken = 0, limit = kind != BALLS && m == &local_sal ? 1 : 2;
    double worst = 0;
    for (int n = 0; n < PROBLEMS / 10; n++) {
        struct one o;
        random_problem(&o, kind, d, 1.5);
        o.l.rho *= flat(0.2, 0.95 * limit);
        int k = 0;
        for (; k < 20000 && (k == 0 || law_error(&o) > 1e-10); k++) method_solve(m, &o.l, &fast);
        slow += law_error(&o) > 1e-10;
        broken += !finite_in_cone(&o.l);
        if (law_error(&o) <= 1e-10) worst = fmax(worst, k);
    }
    diag("%s, %s, %dD: %d of %d not there, at most %g steps", m->name, kind_name[kind], d, slow,
         PROBLEMS / 10, worst);
    ok(!slow && !broken, "%s, %s, %dD: repeated with rho lambda_max < %d it meets the law", m->name,
       kind_name[kind], d, limit);
}

/* ---- special cases -------------------------------------------------------------------------- */

static void test_hopeless(void)
{
    for (const struct method *const *m = methods; *m; m++) {
        int broken = 0, gave_up = 0, wrong = 0;
        for (int n = 0; n < PROBLEMS; n++) {
            struct one o;
            int d = 2 + n % 2;
            double e[3];
            random_problem(&o, SPD, d, 4);
            for (int k = 0; k < 3; k++)
                e[k] = eigenvalue(4) * ((double)gsl_rng_uniform_int(rng, 3) - 1);
            random_W(o.W, d, e);
            o.l.W = o.W;
            if (n % 50 == 0) memset(o.W, 0, sizeof o.W);
            if (n % 50 == 1)
                o.l.W = NULL, memset(o.l.w, 0, sizeof o.l.w), o.l.iw[0] = o.l.iw[1] = INFINITY;
            if (n % 50 == 2) o.l.rho = INFINITY;
            if ((*m)->believes) {
                method_solve(*m, &o.l, n % 3 ? &fast : &plain);
                broken += !finite_in_cone(&o.l);
                gave_up += o.l.gave_up != 0;
                if (!strcmp((*m)->name, "exact") && o.l.W && o.l.rho < INFINITY)
                    wrong += !o.l.gave_up && law_error(&o) > 1e-9;
            }
        }
        if (!(*m)->believes) continue;
        diag("%s, W of any sign and rank: gave up %d of %d, wrong %d", (*m)->name, gave_up,
             PROBLEMS, wrong);
        ok(!broken && !wrong, "%s, W of any sign and rank: finite and in the cone, or so it says",
           (*m)->name);
    }
}

/* W of full rank less one or two, b in its range: there is a solution. */
static void test_semidefinite(void)
{
    int gave_up = 0;
    double worst = 0;
    for (int n = 0; n < PROBLEMS; n++) {
        struct one o;
        double x[3], e[3] = { 1, n % 2 ? flat(0, 1) : 0, 0 };
        random_W(o.W, 3, e);
        o.l = (struct local){ .d = 3, .W = o.W, .mu = flat(0, 1.5), .rho = 1 };
        for (int i = 0; i < 3; i++) x[i] = flat(-1, 1);
        for (int i = 0; i < 3; i++) o.l.b[i] = -dot(o.W + 3 * i, x);
        method_solve(&local_exact, &o.l, &fast);
        gave_up += o.l.gave_up != 0;
        if (!o.l.gave_up) worst = fmax(worst, law_error(&o));
    }
    diag("exact, semidefinite W: gave up %d of %d, worst %.1e", gave_up, PROBLEMS, worst);
    ok(worst < 1e-9 && gave_up == 0, "exact: W singular, b in its range: the law holds");
}

/* A planar problem in space, turned by any angle about n, has the same solution. */
static void test_planar(const struct method *m)
{
    double worst = 0;
    for (int n = 0; n < PROBLEMS; n++) {
        struct one p, s;
        random_problem(&p, n % 2 ? BALLS : SPD, 2, 4);
        s = p;
        s.l.d = 3;
        if (s.l.W) s.l.W = s.W;
        if (p.l.W) p.l.W = p.W;
        method_solve(m, &p.l, &fast);
        method_solve(m, &s.l, &fast);
        double e[3] = { p.l.r[0] - s.l.r[0], p.l.r[1] - s.l.r[1], s.l.r[2] };
        worst = fmax(worst, norm(e) / (norm(s.l.r) + p.l.rho * norm(p.l.b)));
    }
    ok(worst < 1e-9, "%s: d = 2 is d = 3 in the plane (%.1e)", m->name, worst);
}

/* The paper's Newton cycles on some contacts of balls, ours on none. */
static void test_cycles(const struct method *m, double least, double most)
{
    int n = 20000, plainly = 0, now = 0;
    for (int i = 0; i < n; i++) {
        struct local l = {
            .d = 3, .w = { 1, 3.5, 3.5 }, .iw = { 1, 2 / 7.0, 2 / 7.0 }, .mu = 0.7, .rho = 1
        };
        l.b[0] = flat(-1, 1), l.b[1] = flat(-1.5, 1.5), l.b[2] = flat(-1.5, 1.5);
        struct local again = l;
        method_solve(m, &l, &plain);
        method_solve(m, &again, &fast);
        plainly += l.gave_up != 0;
        now += again.gave_up || again.safeguarded;
    }
    double share = 100.0 * plainly / n;
    diag("%s: plain Newton cycles on %.2f %%, line search fails on %d of %d", m->name, share, now,
         n);
    ok(share > least && share < most, "%s: the plain Newton cycles on some contacts", m->name);
    ok(now == 0, "%s: the line search ends on all of them", m->name);
}

/* newton_abs stops on |Z| alone, the paper's way: fewer steps, an error of that size. */
static void test_absolute(const struct method *m)
{
    int wide = 0, tight = 0;
    double worst = 0;
    struct local_opt loose = { .newton_eps = 1e-12, .newton_abs = 1e-5, .newton_max = 100 };
    for (int n = 0; n < PROBLEMS; n++) {
        struct one o, p;
        random_problem(&o, BALLS, 3, 0);
        double unit = norm(o.l.b) * o.l.rho, r[3];
        for (int k = 0; k < 3; k++) { // scaled to |b| = rho = 1
            o.l.w[k] *= o.l.rho, o.l.iw[k] /= o.l.rho, o.l.b[k] *= o.l.rho / unit, o.l.r[k] /= unit;
        }
        o.l.rho = 1;
        p = o;
        method_solve(m, &o.l, &loose);
        method_solve(m, &p.l, &fast);
        wide += o.l.steps, tight += p.l.steps;
        for (int k = 0; k < 3; k++) r[k] = o.l.r[k] - p.l.r[k];
        worst = fmax(worst, norm(r));
    }
    ok(worst < 1e-4 && wide <= tight, "%s: newton_abs 1e-5 leaves an error of %.1e, saves %d of %d",
       m->name, worst, tight - wide, tight);
}

static void test_lambda_max(void)
{
    double worst = 0, W[9];
    for (int n = 0; n < PROBLEMS; n++) {
        double e[3] = { flat(-1, 1), flat(-1, 1), flat(-1, 1) };
        if (n % 3 == 0) e[1] = e[0];
        random_W(W, 3, e);
        for (int k = 0; k < 3; k++) { // a skew part does not count
            double skew = flat(-1, 1);
            W[3 * k + (k + 1) % 3] += skew, W[3 * ((k + 1) % 3) + k] -= skew;
        }
        worst = fmax(worst, fabs(local_lambda_max(W) - fmax(e[0], fmax(e[1], e[2]))));
    }
    ok(worst < 1e-14, "local_lambda_max is the largest eigenvalue of the symmetric part (%.1e)",
       worst);
    double balls[9] = { 1, 0, 0, 0, 3.5, 0, 0, 0, 3.5 };
    ok(local_lambda_max(balls) == 3.5, "local_lambda_max of balls is w_t to the last bit");
}

/* Six rows, as of contacts that roll, beside GSL's method */
static void test_eigen(void)
{
    double worst = 0;
    for (int n = 0; n < PROBLEMS; n++) {
        double A[36], whole[36], e[6], d[6], sd[6], most = -INFINITY;
        gsl_eigen_symm_workspace room = { 6, d, sd };
        for (int i = 0; i < 36; i++) A[i] = flat(-1, 1);
        for (int i = 0; i < 36; i++) whole[i] = 0.5 * (A[i] + A[6 * (i % 6) + i / 6]);
        gsl_matrix_view M = gsl_matrix_view_array(whole, 6, 6);
        gsl_vector_view v = gsl_vector_view_array(e, 6);
        gsl_eigen_symm(&M.matrix, &v.vector, &room);
        for (int i = 0; i < 6; i++) most = fmax(most, e[i]);
        worst = fmax(worst, fabs(eigen_largest(6, A) - most));
    }
    ok(worst < 1e-13, "eigen_largest of six rows is GSL's (%.1e)", worst);
}

int main(void)
{
    rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(rng, 12045392);
    test_derivatives("ebp", ebp_linearise);
    test_derivatives("eal", eal_linearise);
    test_planar_formulas("ebp", ebp_linearise, true);
    test_planar_formulas("eal", eal_linearise, false);
    test_slip("ebp", ebp_linearise, EBP);
    test_slip("eal", eal_linearise, EAL);
    test_cone();
    test_lambda_max();
    for (const struct method *const *m = methods; *m; m++) {
        ok((int)(*m)->id == (int)(m - methods), "%s is in the place of its id", (*m)->name);
        for (int kind = 0; kind < KINDS; kind++)
            for (int d = 2; d <= 3; d++) {
                if ((*m)->believes)
                    test_law(*m, (enum kind)kind, d);
                else
                    test_iterated(*m, (enum kind)kind, d);
            }
        test_planar(*m);
    }
    test_absolute(&local_ebp);
    test_absolute(&local_eal);
    test_cycles(&local_ebp, 4, 25);
    test_cycles(&local_eal, 1, 10);
    test_semidefinite();
    test_hopeless();
    test_eigen();
    gsl_rng_free(rng);
    return tap_done();
}
