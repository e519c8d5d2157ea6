/*
 * solve/central_path.h: the central path of all contacts at once, for the methods that follow it.
 *
 * In x = (mu r_n, r_t) and z = (u_n/mu + |u_t|, u_t) Coulomb's and Signorini's laws read
 *
 *     x in K,  z in K,  x o z = 0                              [De Saxce's u^; K, o: base/jordan.h]
 *
 * and the path is that of x o z = g (1, 0, 0), g > 0, to g = 0. Let y(x) be what the motion makes of x;
 * then z = y(x) is what else is wanted. |u_t| is smoothed over a width of g. Newton's direction, in
 * Nesterov's and Todd's scaling F, T = F F, D = diag(mu, 1, 1),
 *
 *     F dx + F^-1 dz = c,   z + dz = y + dy + p,
 *
 * is that of the system (W + t E W + D T D) dr = ..., E the derivative of mu |u_t|. t = 1 is Newton's
 * method; t = 0, the fixed point of De Saxce, has a problem with a minimum.
 */
#ifndef NSD_CENTRAL_PATH_H
#define NSD_CENTRAL_PATH_H

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

/* dx and dz of a contact, to be had again */
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
    struct newton *newton; /* borrowed: the problem, its factors, and the last steps */
    struct side *side;     /* [n] */
    double *room;          /* of x, v, b [n d] and L, D [n][9]: */
    double *x, *v, *b;     /* reactions, what they make of velocities, a right-hand side */
    double *L, *D;
    struct best best; /* the reactions of the least natural map */
    double unit;      /* of velocities: q is of order 1 after it */
    double gap;       /* g */
    double tried;     /* the natural map at which Newton's steps were tried last, */
    int tries;        /* and how often */
};

/*
 * From the iterate's reactions, or from none, with x o z = gap exactly. False where memory is short; then
 * there is nothing to end.
 */
bool central_init(struct central *m, struct newton *newton, struct solve *s, double gap, bool cold);
void central_free(struct central *m);

/* The mean of x.z */
double central_mean_gap(const struct central *m);

/* y of all contacts at their x, smoothed over the gap; the scaled natural map as the reactions stand,
   the best of which are kept. */
double central_evaluate(struct central *m);

/* F and l of all contacts; false where one of them has come too near the border. */
bool central_scale(struct central *m);

/* The matrix with this t, for the directions that follow */
void central_matrix(struct central *m, double t);
/* dx and dz of all contacts, by c and p; false where the matrix is singular or there is no time left for
   it. The first after central_matrix() factorises it: a Newton step. */
bool central_direction(struct central *m, bool factorised);

/*
 * Newton's steps on the law itself from here, where the natural map is so small that each contact's
 * status may be clear. A try costs as much as a step of the path, and where it arrives it is nearer
 * than ten of them lead. False where it was too early.
 */
bool central_finish(struct central *m, double map);

/* The best reactions, brought back into their cones, become the iterate, and are forgotten. */
void central_restore_best(struct central *m);

#endif
