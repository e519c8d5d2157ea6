/*
 * solve/central_path.h: the central path of all contacts at once, for the methods that follow it.
 *
 * In x = (mu r_n, r_t) and z = (u_n/mu + |u_t|, u_t) Coulomb's and Signorini's laws read
 *
 *     x in K,  z in K,  x o z = 0                              [De Saxce's u^; K, o: base/jordan.h]
 *
 * and the path consists of the points with x o z = g (1, 0, 0), from some g > 0 to g = 0. With y(x)
 * the z that the motion makes of x, the other equation is z = y(x). In y, |u_t| is smoothed over a
 * width of g. Newton's direction, in the scaling F of Nesterov and Todd, with T = F F and D =
 * diag(mu, 1, 1),
 *
 *     F dx + F^-1 dz = c,   z + dz = y + dy + p,
 *
 * is the solution of a system (W + t E W + D T D) dr = ..., E the derivative of mu |u_t|. t = 1 is
 * Newton's method; t = 0, De Saxce's fixed point, holds mu |u_t| fixed and leaves a convex problem.
 */
#pragma once

#include "base/jordan.h"
#include "solve/newton.h"

/* One contact; the third components are 0 in the plane. */
struct side {
    double mu;
    double x[3], z[3], dx[3], dz[3];
    double y[3];
    double e[2];      /* u_t/|u_t|, smoothed */
    struct scaling F; /* at x and z */
    double l[3];      /* F x */
    double c[3], p[3];
};

/* Saves dx and dz of a contact, and restores them. */
static inline void side_save(const struct side *s, double to[2][3])
{
    for (int k = 0; k < 3; k++) to[0][k] = s->dx[k], to[1][k] = s->dz[k];
}
static inline void side_restore(struct side *s, double from[2][3])
{
    for (int k = 0; k < 3; k++) s->dx[k] = from[0][k], s->dz[k] = from[1][k];
}

struct central {
    struct solve *solve;   /* borrowed */
    struct newton *newton; /* borrowed: the problem, its factors, and Newton's last steps */
    struct side *side;     /* [n] */
    double *room;          /* holds all of the following: */
    double *x, *v, *b;     /* [n d] reactions, their velocities, a right-hand side */
    double *L, *D;         /* [n][9] */
    struct best best;      /* the reactions with the smallest natural map */
    double unit;           /* of reactions and velocities, in which q is of order 1 */
    double gap;            /* g */
    double tried;          /* the natural map when Newton's steps were last tried */
    int tries;             /* how often they were */
};

/*
 * Starts from the iterate's reactions, or if `cold` from r = 0, moved to where x o z = gap (1, 0,
 * 0) exactly. Borrows newton and s. False when memory is short: then there is nothing to free.
 */
bool central_init(struct central *m, struct newton *newton, struct solve *s, double gap, bool cold);
void central_free(struct central *m);

/* The mean of x.z over the contacts */
double central_mean_gap(const struct central *m);

/* Computes y of all contacts, smoothed over the gap; returns the scaled natural map of the
   reactions, and keeps them if they are the best so far. */
double central_evaluate(struct central *m);

/* F and l of all contacts; false where one of them is too near the border of K. */
bool central_scale(struct central *m);

/* Sets the matrix with this t, for the directions that follow. */
void central_matrix(struct central *m, double t);
/*
 * dx and dz of all contacts from their c and p; false where the matrix is singular or the time left
 * is too short. The first direction after central_matrix() factorises the matrix (factorised =
 * false) and counts as a Newton step; later ones reuse the factors.
 */
bool central_direction(struct central *m, bool factorised);

/*
 * Tries Newton's steps on the law itself, where the natural map `map` is so small that the status
 * of each contact may be clear. A try costs as much as a step along the path; where it succeeds it
 * is worth more than ten of them. False where it was too early.
 */
bool central_finish(struct central *m, double map);

/* The best reactions, projected onto their cones, become the iterate, and are no longer kept. */
void central_restore_best(struct central *m);
