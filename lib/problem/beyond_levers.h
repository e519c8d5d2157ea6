/*
 * problem/beyond_levers.h: bonds and rolling friction where lever arms are any vectors
 * [problem/levers.h]; what problem/beyond.h has in single numbers for balls is matrices here.
 *
 * With W_cc full the bond of a contact makes
 *
 *     W^ = S W,   b^ = S (b - W a),   S = (1 + W K)^-1,   K = diag(K_n, K_t, K_t),
 *
 * W^ symmetric as W is, and in the bundle in its place. The relative angular velocity is
 *
 *     omega_i = R_b,i . y_b - R_a,i . y_a,   R_i = I^-1/2 e_i,
 *
 * over the basis turned a quarter, (n, -t2, t1), times the length of law/rolling.h. With V what r makes
 * of omega and Z what moments do, the bond leaves
 *
 *     W^ of (u, omega) = ( S W    S V^T          )
 *                        ( V S^T  Z - V K S V^T ).
 *
 * Z has a positive number where nothing can turn: omega is 0 or given there, and the moment is at its
 * limit against it.
 */
#ifndef NSD_BEYOND_LEVERS_H
#define NSD_BEYOND_LEVERS_H

#include "problem/beyond.h"
#include "problem/levers.h"

/* Lane k of each belongs to lane k of the bundle. All but S are set where there is rolling friction. */
struct beyond_levers {
    double S[9][BUNDLE];
    double Ra[9][BUNDLE], Rb[9][BUNDLE]; /* m (kg m^2)^-1/2: component j of R_i at 3 i + j */
    double V[9][BUNDLE];                 /* kg^-1 */
    double W[ROLLING * ROLLING][BUNDLE]; /* kg^-1: W^ of (u, omega) */
    double lambda[BUNDLE];               /* kg^-1: its largest eigenvalue */
};

/*
 * The bond of lane i, with K[2] (kg): S, and W^ in place of W in the bundle. Then, where it rolls, the
 * rest by R_a and R_b of length 1, which are set, between bodies of these 1/mass and 1/inertia;
 * returns the length (m).
 */
void beyond_levers_bond(struct bundle *c, struct beyond_levers *y, int i, const double K[2]);
double beyond_levers_turn(const struct levers *g, const struct bundle *c, struct beyond_levers *y,
                          int i, const double W[9], const double K[2], double iia, double iib);

/* As beyond_roll(), beyond_push() and beyond_rolling() */
void beyond_levers_roll(const struct bundle *c, struct beyond *x, const struct beyond_levers *y,
                        struct body *body, int i, enum method_id method,
                        const struct local_opt *opt, struct rolling_lane *l);
void beyond_levers_push(const struct bundle *c, const struct beyond *x,
                        const struct beyond_levers *y, int i, struct body *body,
                        const double dm[3]);
void beyond_levers_rolling(const struct bundle *c, const struct beyond *x,
                           const struct beyond_levers *y, struct body *body, int i,
                           const double u[3], struct rolling *q, double v[ROLLING]);

#endif
