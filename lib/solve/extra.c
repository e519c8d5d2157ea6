/* solve/extra.c: rolling friction, lane by lane [solve/extra.h]. */
#include "solve/extra.h"

#include <string.h>

/* The bodies' angular velocity relative to each other, in (n, t1, t2) */
static void extra_spin(const struct extra_lane *at, double omega[3])
{
    const double *wa = body_at(at->body, at->c->a[at->i]) + 3;
    const double *wb = body_at(at->body, at->c->b[at->i]) + 3;
    double basis[3][3];
    bundle_basis(at->c, at->t, at->i, basis[0], basis[1], basis[2]);
    for (int j = 0; j < 3; j++) {
        omega[j] = 0;
        for (int l = 0; l < 3; l++) omega[j] += basis[j][l] * (wb[l] - wa[l]);
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
static void extra_set_operator(const struct bundle *c, const struct extra *x, int i, const double w[2],
                         const double s[2], struct rolling *q)
{
    double l = x->length[i];
    *q = (struct rolling){ .wn = w[0] / s[0], .wt = w[1] / s[1] };
    q->k = l * x->s[1][i] * x->k[i];
    q->wp = l * l * x->wr[i];
    q->wr = l * l * (x->wr[i] - x->k[i] * x->k[i] * x->K[1][i] * x->s[1][i]);
    q->mu[0] = c->mu[i], q->mu[1] = x->mu_p[i] / l, q->mu[2] = x->mu_r[i] / l;
    q->rho = x->rho[i];
}

void extra_impulse(const struct extra *x, int i, const double r[3], double out[ROLLING])
{
    double l = x->length[i];
    for (int j = 0; j < 3; j++) out[j] = r[j];
    out[3] = x->m[0][i] / l, out[4] = -x->m[2][i] / l, out[5] = x->m[1][i] / l;
}

void extra_solve(struct extra *x, int i, enum method_id method, struct rolling *q,
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
        double spun = turned[j] - x->k[i] * felt - x->wr[i] * turned_m;
        q.b[1 + j] = bt, q.b[4 + j] = length * spun;
    }
    extra_solve(x, i, method, &q, opt, l);
    for (int j = 0; j < 3; j++) l->r[j] = q.x[j];
    for (int j = 0; j < 2; j++) l->b[1 + j] += l->s[1] * k * length * (q.x[4 + j] - was[j]);
}
