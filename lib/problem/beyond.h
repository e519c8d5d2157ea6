/*
 * problem/beyond.h: what the sweep reads of contacts that are bonded or have rolling friction,
 * beside their bundles.
 *
 * A bond pulls with p = - a - K u~, K = h^2 S beta^2 C, and the bodies feel r = r* + p, where r* is
 * what the local method looks for [bodies/tie.h]. Of its own contact it sees
 *
 *     u~ = W^ r* + b^,   W^ = (1 + W K)^-1 W,   b^ = (1 + W K)^-1 (b - W a),
 *
 * which for balls is a number along n and one across: w^ = s w, s = 1/(1 + w K). p is that of the
 * last visit, and the bodies have the velocities that r* + p makes. Where all are visited often
 * enough p is - a - K u~, and u~ that of M + H K H^T.
 *
 * Rolling friction adds a moment, and the relative angular velocity of the bodies, which is coupled
 * to u_t by k = l_b/I_b - l_a/I_a [law/rolling.h].
 */
#ifndef NSD_BEYOND_H
#define NSD_BEYOND_H

#include "law/rolling.h"
#include "problem/bundle.h"

/* Lane k of each belongs to lane k of the bundle. */
struct beyond {
    double s[2][BUNDLE]; /* 1/(1 + w K), along n and across; 1: not bonded */
    double K[2][BUNDLE]; /* kg */
    double a[3][BUNDLE]; /* N s */
    double p[3][BUNDLE]; /* N s: of the bond, in (n, t1, t2) */

    double mu_r[BUNDLE], mu_p[BUNDLE]; /* m; both 0: only the vector text solves the lane */
    double k[BUNDLE], wr[BUNDLE];      /* m/(kg m^2), 1/(kg m^2) */
    double length[BUNDLE];             /* m: of law/rolling.h */
    double rho[BUNDLE];                /* kg: its step */
    double m[3][BUNDLE];               /* N m s: on b, in (n, t1, t2) */
};

/* What of a local problem the moment needs, and changes */
struct rolling_lane {
    double w[2], b[3], r[3]; /* w^, b^; r* of the last sweep */
    double u[3];             /* u~ of the last sweep, where there are levers */
    double s[2];             /* of the impact law, 1/(1 + e) */
    double relax;
    double dm[3]; /* out: change of m, in (n, t1, t2) */
    int steps;    /* out: as in struct rolling */
    bool safeguarded, gave_up;
};

static inline bool beyond_rolls(const struct beyond *x, int lane)
{
    return x->mu_r[lane] > 0 || x->mu_p[lane] > 0;
}

struct beyond_levers; /* [problem/beyond_levers.h]; NULL: a bundle of balls */

/* Solves lane i with its moment: l->r and x->m are the new ones, l->b that for the new moment. The
   bodies turn at their velocities of before. */
void beyond_roll(const struct bundle *c, struct beyond *x, const struct beyond_levers *y,
                 struct body *body, int i, enum method_id method, const struct local_opt *opt,
                 struct rolling_lane *l);

/* What a change dm of the moment makes of the bodies */
void beyond_push(const struct bundle *c, const struct beyond *x, const struct beyond_levers *y,
                 int i, struct body *body, const double dm[3]);

/* The contact as one of law/rolling.h, without b; its x, and its u where u_D = (1 + e) u~ is u_n, u_t */
void beyond_rolling(const struct bundle *c, const struct beyond *x, const struct beyond_levers *y,
                    struct body *body, int i, const double s[2], const double u[3],
                    struct rolling *q, double v[ROLLING]);

#endif
