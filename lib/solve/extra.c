/* solve/extra.c: rolling friction, lane by lane [solve/extra.h]. */
#include "solve/extra.h"

#include "base/matrix.h"

#include <string.h>

/* The bodies' angular velocity relative to each other as the law has it, in (n, t1, t2) */
static void extra_spin(const struct extra_lane *at, double omega[3])
{
    const double *wa = body_at(at->body, at->c->a[at->i]) + 3;
    const double *wb = body_at(at->body, at->c->b[at->i]) + 3;
    double basis[3][3];
    bundle_basis(at->c, at->t, at->i, basis[0], basis[1], basis[2]);
    const struct extra *x = at->x;
    for (int j = 0; j < 3; j++) {
        omega[j] = 0;
        for (int l = 0; l < 3; l++) omega[j] += basis[j][l] * (wb[l] - wa[l]);
        if (x->soft[at->i] > 0) omega[j] += x->law[j][at->i] + x->soft[at->i] * x->m[j][at->i];
    }
}

void extra_push(const struct extra_lane *at, const double dm[3])
{
    if (at->y) {
        extra_levers_push(at, dm);
        return;
    }
    double *a = body_at(at->body, at->c->a[at->i]), *b = body_at(at->body, at->c->b[at->i]);
    double basis[3][3];
    bundle_basis(at->c, at->t, at->i, basis[0], basis[1], basis[2]);
    for (int l = 0; l < 3; l++) {
        double m = dm[0] * basis[0][l] + dm[1] * basis[1][l] + dm[2] * basis[2][l];
        a[3 + l] -= a[7] * m, b[3 + l] += b[7] * m; // a[7]: 1/inertia
    }
}

/* W, limits and step of a contact with these w^ and s of the impact law, in the units of
   solve/rolling.h. Impact multiplies u by s, which changes no law; without it W is symmetric. */
static void extra_set_operator(const struct bundle *c, const struct extra *x, int i,
                               const double w[2], const double s[2], struct rolling *q)
{
    double l = x->length[i], turns = x->wr[i] + x->soft[i];
    *q = (struct rolling){ .wn = w[0] / s[0], .wt = w[1] / s[1] };
    q->k = l * x->s[1][i] * x->k[i];
    q->wp = l * l * turns;
    q->wr = l * l * (turns - x->k[i] * x->k[i] * x->K[1][i] * x->s[1][i]);
    q->mu[0] = c->mu[i], q->mu[1] = x->mu_p[i] / l, q->mu[2] = x->mu_r[i] / l;
    q->rho = x->rho[i];
}

/* What balls and levers share. out = x of lane i: r* (N s), and the moment, turned a quarter and over the
   length. */
static void extra_impulse(const struct extra *x, int i, const double r[3], double out[ROLLING])
{
    double l = x->length[i];
    for (int j = 0; j < 3; j++) out[j] = r[j];
    out[3] = x->m[0][i] / l, out[4] = -x->m[2][i] / l, out[5] = x->m[1][i] / l;
}

/* Solves q, relaxed: the moment of lane i becomes that of q->x, and l has its change and how it was found. */
static void extra_solve(struct extra *x, int i, enum method_id method, struct rolling *q,
                        const struct local_opt *opt, struct rolling_lane *l)
{
    double was[ROLLING], tau[ROLLING], length = x->length[i];
    memcpy(was, q->x, sizeof was);
    rolling_solve(method, q, opt);
    if (l->relax != 1) {
        for (int j = 0; j < ROLLING; j++) tau[j] = was[j] + l->relax * (q->x[j] - was[j]);
        rolling_project(q, tau, q->x);
    }
    const double m[3] = { length * q->x[3], length * q->x[5], -length * q->x[4] };
    for (int j = 0; j < 3; j++) l->dm[j] = m[j] - x->m[j][i], x->m[j][i] = m[j];
    l->steps = q->steps, l->safeguarded = q->safeguarded, l->gave_up = q->gave_up;
}

void extra_rolling(const struct extra_lane *at, const double w[2], const double s[2],
                   const double u[3], struct rolling *q, double v[ROLLING])
{
    if (at->y) {
        extra_levers_rolling(at, u, q, v);
        return;
    }
    const struct bundle *c = at->c;
    const struct extra *x = at->x;
    int i = at->i;
    const double r[3] = { c->r[0][i], c->r[1][i], c->r[2][i] };
    double omega[3], l = x->length[i];
    extra_set_operator(c, x, i, w, s, q);
    extra_impulse(x, i, r, q->x);
    extra_spin(at, omega);
    for (int j = 0; j < 3; j++) v[j] = u[j] / s[j > 0];
    v[3] = l * omega[0], v[4] = -l * omega[2], v[5] = l * omega[1];
}

void extra_roll(const struct extra_lane *at, enum method_id method, const struct local_opt *opt,
                struct rolling_lane *l)
{
    if (at->y) {
        extra_levers_roll(at, method, opt, l);
        return;
    }
    struct extra *x = at->x;
    int i = at->i;
    struct rolling q;
    double omega[3], k = x->s[1][i] * x->k[i], length = x->length[i];
    extra_set_operator(at->c, x, i, l->w, l->s, &q);
    extra_impulse(x, i, l->r, q.x);
    const double was[2] = { q.x[4], q.x[5] };
    extra_spin(at, omega);
    const double turned[2] = { -omega[2], omega[1] };
    q.b[0] = l->b[0] / l->s[0];
    q.b[3] = length * omega[0] - q.wp * q.x[3];
    for (int j = 0; j < 2; j++) { // what is there without r* and m
        double turned_m = length * q.x[4 + j], bt = l->b[1 + j] / l->s[1] - k * turned_m;
        double felt = l->r[1 + j] + x->z[1 + j][i] + x->K[1][i] * bt;
        double spun = turned[j] - x->k[i] * felt - (x->wr[i] + x->soft[i]) * turned_m;
        q.b[1 + j] = bt, q.b[4 + j] = length * spun;
    }
    extra_solve(x, i, method, &q, opt, l);
    for (int j = 0; j < 3; j++) l->r[j] = q.x[j];
    for (int j = 0; j < 2; j++) l->b[1 + j] += l->s[1] * k * length * (q.x[4 + j] - was[j]);
}

/* ---- bonds and moments as matrices ---- */

/* C = A^-1, 3 x 3; A's eigenvalues are at least 1. */
static void extra_invert(const double A[9], double C[9])
{
    double B[9];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int k = (i + 1) % 3, l = (i + 2) % 3, m = (j + 1) % 3, n = (j + 2) % 3;
            B[3 * j + i] = A[3 * k + m] * A[3 * l + n] - A[3 * k + n] * A[3 * l + m];
        }
    double det = A[0] * B[0] + A[1] * B[3] + A[2] * B[6];
    for (int i = 0; i < 9; i++) C[i] = B[i] / det;
}

void extra_levers_bond(double block[9][BUNDLE], struct extra_levers *y, int i, const double K[2])
{
    double A[9], S[9], W[9];
    for (int j = 0; j < 9; j++) A[j] = (j % 4 == 0) + block[j][i] * K[j % 3 > 0];
    extra_invert(A, S);
    for (int j = 0; j < 9; j++) {
        y->S[j][i] = S[j], W[j] = 0;
        for (int l = 0; l < 3; l++) W[j] += S[3 * (j / 3) + l] * block[3 * l + j % 3][i];
    }
    for (int j = 0; j < 9; j++) block[j][i] = 0.5 * (W[j] + W[3 * (j % 3) + j / 3]);
}

static double dot_rows(double (*A)[BUNDLE], double (*B)[BUNDLE], int i, int j, int lane)
{
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += A[3 * i + k][lane] * B[3 * j + k][lane];
    return sum;
}

double extra_levers_turn(const struct levers *g, double block[9][BUNDLE], struct extra_levers *y,
                         int i, const struct turning *t)
{
    const double *W = t->W, *K = t->K, iia = t->iia, iib = t->iib;
    struct levers arm = *g; // not const, for dot_rows()
    double Z[9], wt = fmax(W[4], W[8]), length = 1, full[ROLLING * ROLLING];
    for (int j = 0; j < 9; j++)
        Z[j] = iia * dot_rows(y->Ra, y->Ra, j / 3, j % 3, i) +
               iib * dot_rows(y->Rb, y->Rb, j / 3, j % 3, i);
    double wr = fmax(Z[4], Z[8]);
    if (wr > 0) length = sqrt(wt / wr);
    for (int j = 0; j < 9; j++) {
        y->Ra[j][i] *= length, y->Rb[j][i] *= length;
        Z[j] *= length * length;
    }
    for (int j = 0; j < 9; j += 4) {
        Z[j] += length * length * t->soft;
        if (!(Z[j] > 0)) Z[j] = wt;
    }
    for (int j = 0; j < 9; j++)
        y->V[j][i] = iia * dot_rows(y->Ra, arm.Ga, j / 3, j % 3, i) +
                     iib * dot_rows(y->Rb, arm.Gb, j / 3, j % 3, i);
    for (int j = 0; j < 3; j++)
        for (int k = 0; k < 3; k++) {
            double on = 0, left = 0; // V S^T and V K S V^T
            for (int l = 0; l < 3; l++) {
                on += y->V[3 * j + l][i] * y->S[3 * k + l][i];
                for (int m = 0; m < 3; m++)
                    left += y->V[3 * j + l][i] * K[l > 0] * y->S[3 * l + m][i] * y->V[3 * k + m][i];
            }
            full[ROLLING * j + k] = block[3 * j + k][i];
            full[ROLLING * (3 + j) + k] = full[ROLLING * k + 3 + j] = on;
            full[ROLLING * (3 + j) + 3 + k] = Z[3 * j + k] - left;
        }
    for (int j = 0; j < ROLLING; j++)
        for (int k = 0; k < j; k++) {
            double mean = 0.5 * (full[ROLLING * j + k] + full[ROLLING * k + j]);
            full[ROLLING * j + k] = full[ROLLING * k + j] = mean;
        }
    for (int j = 0; j < ROLLING * ROLLING; j++) y->W[j][i] = full[j];
    y->lambda[i] = fmax(0, eigen_largest(ROLLING, full));
    return length;
}

/* The bodies' angular velocity relative to each other, as solve/rolling.h has it */
static void extra_levers_spin(const struct extra_lane *at, double omega[3])
{
    const struct extra_levers *y = at->y;
    int i = at->i;
    const double *wa = body_at(at->body, at->c->a[i]) + 3, *wb = body_at(at->body, at->c->b[i]) + 3;
    for (int j = 0; j < 3; j++) {
        omega[j] = 0;
        for (int l = 0; l < 3; l++)
            omega[j] += y->Rb[3 * j + l][i] * wb[l] - y->Ra[3 * j + l][i] * wa[l];
    }
    const struct extra *x = at->x;
    const double soft = x->soft[i], l = x->length[i];
    if (!(soft > 0)) return;
    omega[0] += l * (x->law[0][i] + soft * x->m[0][i]);
    omega[1] -= l * (x->law[2][i] + soft * x->m[2][i]);
    omega[2] += l * (x->law[1][i] + soft * x->m[1][i]);
}

/* The contact without its b and x: W and limits */
static void extra_levers_set_operator(const struct extra_lane *at, struct rolling *q)
{
    const struct extra *x = at->x;
    const struct extra_levers *y = at->y;
    int i = at->i;
    *q = (struct rolling){ .full = true, .lambda = y->lambda[i], .rho = x->rho[i] };
    for (int j = 0; j < ROLLING * ROLLING; j++) q->W[j] = y->W[j][i];
    q->mu[0] = at->c->mu[i], q->mu[1] = x->mu_p[i] / x->length[i],
    q->mu[2] = x->mu_r[i] / x->length[i];
}

void extra_levers_rolling(const struct extra_lane *at, const double u[3], struct rolling *q,
                          double v[ROLLING])
{
    const double r[3] = { at->c->r[0][at->i], at->c->r[1][at->i], at->c->r[2][at->i] };
    extra_levers_set_operator(at, q);
    extra_impulse(at->x, at->i, r, q->x);
    for (int j = 0; j < 3; j++) v[j] = u[j];
    extra_levers_spin(at, v + 3);
}

void extra_levers_push(const struct extra_lane *at, const double dm[3])
{
    const struct extra_levers *y = at->y;
    int i = at->i;
    double *a = body_at(at->body, at->c->a[i]), *b = body_at(at->body, at->c->b[i]);
    double l = at->x->length[i];
    const double turned[3] = { dm[0] / l, -dm[2] / l, dm[1] / l };
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++) {
            a[3 + k] -= a[7] * y->Ra[3 * j + k][i] * turned[j];
            b[3 + k] += b[7] * y->Rb[3 * j + k][i] * turned[j];
        }
}

void extra_levers_roll(const struct extra_lane *at, enum method_id method,
                       const struct local_opt *opt, struct rolling_lane *l)
{
    struct extra *x = at->x;
    const struct extra_levers *y = at->y;
    int i = at->i;
    struct rolling q;
    double now[ROLLING], omega[3], dp[3];
    extra_levers_set_operator(at, &q);
    extra_impulse(x, i, l->r, q.x);
    extra_levers_spin(at, omega);
    for (int j = 0; j < 3; j++) { // u and omega with the bond's pull that goes with them
        now[j] = 0;
        for (int k = 0; k < 3; k++)
            now[j] += y->S[3 * j + k][i] * l->u[k] - y->W[ROLLING * j + k][i] * x->z[k][i];
        dp[j] = -x->K[j > 0][i] * now[j] - x->z[j][i];
    }
    for (int j = 0; j < 3; j++) {
        now[3 + j] = omega[j];
        for (int k = 0; k < 3; k++) now[3 + j] += y->V[3 * j + k][i] * dp[k];
    }
    for (int j = 0; j < ROLLING; j++) {
        q.b[j] = now[j];
        for (int k = 0; k < ROLLING; k++) q.b[j] -= q.W[ROLLING * j + k] * q.x[k];
    }
    extra_solve(x, i, method, &q, opt, l);
    for (int j = 0; j < 3; j++) {
        l->b[j] = q.b[j]; // that without r alone, as the vector text has it
        for (int k = 3; k < ROLLING; k++) l->b[j] += q.W[ROLLING * j + k] * q.x[k];
        l->r[j] = q.x[j];
    }
}
