/*
 * solve/local_exact.c: the search for the exact solution of one contact where solve/local_exact.h has
 * not found it: all directions to slide in, and a singular W. g is a trigonometric polynomial of
 * degree 2 in the angle of d and has at most four roots.
 */
#include "solve/local_exact.h"

#include <complex.h>
#include <gsl/gsl_linalg.h>

/*
 * Candidates for d, all roots of g among them; returns how many. In x = tan(angle/2), (1 + x^2)^2 g
 * is a quartic with leading coefficient g(pi). To keep it from zero, and the roots from infinity,
 * the angle is counted from the one of eight directions o for which |g(-o)| is largest. The
 * iteration of Durand and Kerner finds all four roots roughly; their real parts are refined by
 * Newton. Where g = 0 everywhere any direction slides, and the eight are the candidates.
 */
static int slide_roots(const struct slide *k, double root[8][2])
{
    double most = -1, hd, dg, o[2] = { 1, 0 };
    for (int i = 0; i < 8; i++) {
        root[i][0] = 1, root[i][1] = 0;
        for (int j = 0; j < i; j++) slide_turn(root[i], 1);
        double g = fabs(slide_g(k, (double[]){ -root[i][0], -root[i][1] }, &hd, &dg));
        if (g > most) most = g, o[0] = root[i][0], o[1] = root[i][1];
    }
    if (!(most > 1e-12 * k->scale)) return 8;

    // p and Q in the axes o and its normal m
    double m[2] = { -o[1], o[0] }, Qo[2], Qm[2];
    for (int i = 0; i < 2; i++) {
        Qo[i] = k->Q[i][0] * o[0] + k->Q[i][1] * o[1];
        Qm[i] = k->Q[i][0] * m[0] + k->Q[i][1] * m[1];
    }
    double p1 = k->p[0] * o[0] + k->p[1] * o[1], p2 = k->p[0] * m[0] + k->p[1] * m[1];
    double Q11 = o[0] * Qo[0] + o[1] * Qo[1], Q12 = o[0] * Qm[0] + o[1] * Qm[1];
    double Q21 = m[0] * Qo[0] + m[1] * Qo[1], Q22 = m[0] * Qm[0] + m[1] * Qm[1];
    double c4 = Q21 - p2, c[4] = { (Q21 + p2) / c4, 2 * (Q22 - Q11 - p1) / c4,
                                   -2 * (Q21 + 2 * Q12) / c4, 2 * (Q11 - Q22 - p1) / c4 };

    double complex x[4] = { 1, 0.4 + 0.9 * I, -0.65 + 0.72 * I, -0.908 - 0.297 * I };
    for (double change = 1, step = 0; change > 1e-8 && step < 60; step++) {
        change = 0;
        for (int i = 0; i < 4; i++) {
            double complex y = (((x[i] + c[3]) * x[i] + c[2]) * x[i] + c[1]) * x[i] + c[0], w = 1;
            for (int j = 0; j < 4; j++)
                if (j != i && x[j] != x[i]) w *= x[i] - x[j];
            y /= w;
            x[i] -= y;
            change = fmax(change, cabs(y) / (1 + cabs(x[i])));
        }
    }
    for (int i = 0; i < 4; i++) { // the angle 2 atan x from o
        double t = creal(x[i]), s = 1 / (1 + t * t), co = s * (1 - t * t), si = s * 2 * t;
        root[i][0] = isfinite(t) ? co * o[0] + si * m[0] : 1;
        root[i][1] = isfinite(t) ? co * o[1] + si * m[1] : 0;
        slide_polish(k, root[i], 60, ~NONE);
    }
    return 4;
}

/*
 * Of all sliding solutions (with large mu W_nt there may be several) the one whose reaction is
 * nearest to that of the last sweep.
 */
static bool slide_nearest(struct local *l)
{
    struct slide k;
    double root[8][2] = { { 0 } }, r[3], best[3] = { 0 }, nearest = INFINITY;
    slide_init(&k, l);
    for (int i = 0, n = slide_roots(&k, root); i < n; i++) {
        if (!slide_accept(l, &k, root[i], r)) continue;
        double far2 = 0;
        for (int j = 0; j < 3; j++) far2 += (r[j] - l->r[j]) * (r[j] - l->r[j]);
        if (!(far2 < nearest)) continue;
        nearest = far2;
        for (int j = 0; j < 3; j++) best[j] = r[j];
    }
    if (!(nearest < INFINITY)) return false;
    for (int j = 0; j < 3; j++) l->r[j] = best[j];
    return true;
}

/* The shortest r among those that minimise |W r + b|: for singular W. */
static void least_squares(const double *W, const double b[3], double r[3])
{
    double a[9], tq[3], tz[3], work[3], rest[3], y[3] = { -b[0], -b[1], -b[2] };
    for (int i = 0; i < 9; i++) a[i] = W[i];
    size_t order[3], rank;
    gsl_permutation p = { 3, order };
    gsl_matrix_view A = gsl_matrix_view_array(a, 3, 3);
    gsl_vector_view Tq = gsl_vector_view_array(tq, 3), Tz = gsl_vector_view_array(tz, 3),
                    R = gsl_vector_view_array(r, 3), Y = gsl_vector_view_array(y, 3),
                    Rest = gsl_vector_view_array(rest, 3), Work = gsl_vector_view_array(work, 3);
    double tol = 1e-12 * (norm3(W) + norm3(W + 3) + norm3(W + 6));
    gsl_linalg_COD_decomp_e(&A.matrix, &Tq.vector, &Tz.vector, &p, tol, &rank, &Work.vector);
    r[0] = r[1] = r[2] = 0;
    if (rank > 0)
        gsl_linalg_COD_lssolve(&A.matrix, &Tq.vector, &Tz.vector, &p, rank, &Y.vector, &R.vector,
                               &Rest.vector);
}

/* Solves W r = -b of a singular W; is r in the cone? */
static bool stick_singular(struct local *l)
{
    double r[3], u[3];
    least_squares(l->W, l->b, r);
    if (!exact_stopped(l, r, u)) return false;
    if (l->d == 2) r[2] = 0;
    if (!(norm2(r + 1) <= l->mu * r[0])) return false;
    for (int i = 0; i < 3; i++) l->r[i] = r[i];
    return true;
}

bool exact_search(int d, const double W[9], const double b[3], double mu, bool singular,
                  double r[3])
{
    struct local l = { .d = d, .W = W, .mu = mu };
    double slid[3];
    for (int k = 0; k < 3; k++) l.b[k] = b[k], l.r[k] = r[k];
    bool found = singular && stick_singular(&l);
    if (!found && singular && exact_slide(&l, ~NONE, slid)) {
        for (int k = 0; k < 3; k++) l.r[k] = slid[k];
        found = true;
    }
    found = found || (d == 3 && slide_nearest(&l));
    for (int k = 0; k < 3; k++) r[k] = l.r[k];
    return found;
}
