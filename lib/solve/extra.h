/*
 * solve/extra.h: what the sweep reads of contacts that are bonded or have rolling friction,
 * after their bundles.
 *
 * A bond pulls with p = - a - K u~, K = h^2 S beta^2 C, and the bodies feel r = r* + p, where r* is
 * what the local method looks for [contact/contact_law.h]. Of its own contact it sees
 *
 *     u~ = W^ r* + b^,   W^ = (1 + W K)^-1 W,   b^ = (1 + W K)^-1 (b - W a),
 *
 * which for balls is a number along n and one across: w^ = s w, s = 1/(1 + w K). p is that of the
 * last visit, kept as z = p + a, and the bodies have the velocities that r* + p makes. Where all are
 * visited often enough p is - a - K u~, and u~ that of M + H K H^T.
 *
 * Rolling friction adds a moment, and the relative angular velocity of the bodies, which is coupled
 * to u_t by k = l_b/I_b - l_a/I_a [solve/rolling.h]. With a stiffness the law has omega + law + soft m in place of
 * omega [contact/spring.h].
 */
#pragma once

#include "solve/bundle.h"
#include "solve/rolling.h"

/* Lane k of each belongs to lane k of the bundle. */
struct extra {
    double s[2][BUNDLE]; /* 1/(1 + w K), along n and across; 1: not bonded */
    double K[2][BUNDLE]; /* kg */
    double z[3][BUNDLE]; /* N s: p + a = - K u~ of the last visit, in (n, t1, t2) */
    double a[3][BUNDLE]; /* N s */

    double mu_r[BUNDLE], mu_p[BUNDLE]; /* m; both 0: only the vector text solves the lane */
    double k[BUNDLE], wr[BUNDLE];      /* m/(kg m^2), 1/(kg m^2) */
    double length[BUNDLE];             /* m: of solve/rolling.h */
    double rho[BUNDLE];                /* kg: its step */
    double soft[BUNDLE];               /* 1/(kg m^2): compliance of the moment; 0: rigid */
    double law[3][BUNDLE]; /* rad/s: what its spring adds to omega besides, in (n, t1, t2) */
    double m[3][BUNDLE];   /* N m s: on b, in (n, t1, t2) */
};

/*
 * The same where lever arms are any vectors [solve/bundle.h]: what is single numbers for balls is
 * matrices.
 *
 * With W_cc full the bond of a contact makes
 *
 *     W^ = S W,   b^ = S (b - W a),   S = (1 + W K)^-1,   K = diag(K_n, K_t, K_t),
 *
 * W^ symmetric as W is, and in its place in the block. The relative angular velocity is
 *
 *     omega_i = R_b,i . y_b - R_a,i . y_a,   R_i = I^-1/2 e_i,
 *
 * over the basis turned a quarter, (n, -t2, t1), times the length of solve/rolling.h. With V what r makes
 * of omega and Z what moments do, the bond leaves
 *
 *     W^ of (u, omega) = ( S W    S V^T          )
 *                        ( V S^T  Z - V K S V^T ).
 *
 * Z has a positive number where nothing can turn: omega is 0 or given there, and the moment is at its
 * limit against it. All but S are set where there is rolling friction.
 */
struct extra_levers {
    double S[9][BUNDLE];
    double Ra[9][BUNDLE], Rb[9][BUNDLE]; /* m (kg m^2)^-1/2: component j of R_i at 3 i + j */
    double V[9][BUNDLE];                 /* kg^-1 */
    double W[ROLLING * ROLLING][BUNDLE]; /* kg^-1: W^ of (u, omega) */
    double lambda[BUNDLE];               /* kg^-1: its largest eigenvalue */
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

static inline bool extra_rolls(const struct extra *x, int lane)
{
    return x->mu_r[lane] > 0 || x->mu_p[lane] > 0;
}

/* Lane i of a bundle, with its record beside */
struct extra_lane {
    int i;
    const struct bundle *c;
    const struct beside *t; /* NULL: none */
    struct extra *x;
    const struct extra_levers *y; /* NULL: all bodies are balls */
    struct body *body;            /* that the places of c are in */
};

/* Solves a lane with its moment: l->r and x->m are the new ones, l->b that for the new moment. The
   bodies turn at their velocities of before. */
void extra_roll(const struct extra_lane *at, enum method_id method, const struct local_opt *opt,
                struct rolling_lane *l);

/* What a change dm of the moment makes of the bodies */
void extra_push(const struct extra_lane *at, const double dm[3]);

/* The contact as one of solve/rolling.h, without b; its x, and its u where u_D = (1 + e) u~ is u_n, u_t.
   w (kg^-1): w^ along n and across; between balls */
void extra_rolling(const struct extra_lane *at, const double w[2], const double s[2],
                   const double u[3], struct rolling *q, double v[ROLLING]);

/* Sets S of lane i for a bond of K[2] (kg), and puts W^ in place of the block's W. */
void extra_levers_bond(double block[9][BUNDLE], struct extra_levers *y, int i, const double K[2]);
/* What the turning of a lane is made of */
struct turning {
    double W[9]; /* kg^-1: without the bond */
    double K[2]; /* kg: of the bond, which has made W^ of the block */
    double iia,
        iib;     /* 1/inertia of both bodies in the problem's unknowns, 0 where one cannot move */
    double soft; /* 1/(kg m^2): of the moment's spring */
};
/* Sets the rest of lane i, which rolls, after its bond. On entry R_a and R_b are those of length 1. Returns the
   length (m). */
double extra_levers_turn(const struct levers *g, double block[9][BUNDLE], struct extra_levers *y,
                         int i, const struct turning *t);

/* As extra_roll(), extra_push() and extra_rolling() */
void extra_levers_roll(const struct extra_lane *at, enum method_id method,
                       const struct local_opt *opt, struct rolling_lane *l);
void extra_levers_push(const struct extra_lane *at, const double dm[3]);
void extra_levers_rolling(const struct extra_lane *at, const double u[3], struct rolling *q,
                          double v[ROLLING]);
