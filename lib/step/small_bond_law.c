/* step/small_bond_law.c: the law of a point whose bond holds [step/small_anchor.h]. */
#include "solve/local_exact.h"
#include "step/small_anchor.h"
#include "step/small_point.h"

#include <math.h>
#include <string.h>

/* A point whose bond holds, in its basis: the bond pulls by p = P - K u, and the rest of its reaction, f - p, is on the law with
   u = W^ (f - p) + b^ [nsd-methods(7)]. */
struct bonded_point {
    double P[3], K[3]; /* N s, kg */
    double W[9], b[3]; /* W^ and b^: 1/kg, m/s */
};

static struct bonded_point bonded_point(const struct small_run *r, const struct small_meeting *m,
                                        const struct small_point *t, const vec3 e[3],
                                        const double f[3])
{
    const vec3 u = small_point_velocity(r, m, t, r->l->s.body);
    const double *x = t->spring, hb = r->h * x[SPRING_BETA] * x[SPRING_BETA];
    struct bonded_point y = { .K = { hb * x[SPRING_SN], hb * x[SPRING_ST], hb * x[SPRING_ST] } };
    double A[3][3], n[3], pull[3], y3[3], row[3]; // A = 1 + W K
    small_array(n, t->n), small_bond_pull(x, n, t->gap, pull);
    for (int k = 0; k < 9; k++) A[k / 3][k % 3] = t->W[k] * y.K[k % 3] + (k % 4 ? 0 : 1);
    for (int k = 0; k < 3; k++) y.P[k] = v3_dot(e[k], small_vec(pull));
    for (int k = 0; k < 3; k++)
        y3[k] = dot3(t->W + 3 * k, f) - dot3(t->W + 3 * k, y.P) - v3_dot(e[k], u);
    solve3(A, y3, y.b);
    for (int k = 0; k < 3; k++) { // column k of W^
        for (int i = 0; i < 3; i++) y3[i] = -t->W[3 * i + k];
        solve3(A, y3, row);
        for (int i = 0; i < 3; i++) y.W[3 * i + k] = row[i];
    }
    return y;
}

double small_bond_law(const struct small_run *r, const struct small_meeting *m,
                      const struct small_point *t, const vec3 e[3], const double f[3], double is[3])
{
    const struct bonded_point y = bonded_point(r, m, t, e, f);
    const vec3 u = small_point_velocity(r, m, t, r->l->s.body);
    const double soft = t->soft * fmax(t->W[4], t->W[8]);
    double W[9], b[3];
    for (int k = 0; k < 3; k++) {
        b[k] = y.b[k] + v3_dot(e[k], small_vec(t->q));
        is[k] = f[k] - (y.P[k] - y.K[k] * v3_dot(e[k], u));
    }
    memcpy(W, y.W, sizeof W);
    W[0] += t->soft * t->W[0], W[4] += soft, W[8] += soft;
    small_point_solve(r->p->dim, W, b, t->mu * (1 - t->spring[SPRING_BETA]), is);
    const double push = is[0], rest[3] = { is[0], is[1], is[2] };
    for (int k = 0; k < 3; k++) is[k] += y.P[k] - y.K[k] * (dot3(y.W + 3 * k, rest) + y.b[k]);
    return push;
}
