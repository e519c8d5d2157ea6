/*
 * state/wall_load.h: what bodies do to the faces of walls [state/wall_faces.h], summed over all steps of a run since the
 * sums began, not only over the frames that are kept. The difference of two frames is what was done between them.
 *
 * A step counts by its reactions r and, for works, by the mean of the velocities before and after it, by which the
 * balance of energy is exact [step/balance.h].
 */
#pragma once

#include "base/failure.h"
#include "base/vec.h"

#include <stdint.h>

struct wall;
struct wall_faces;

struct face_sums {
    vec3 impulse;      /* N s: of the bodies on it */
    vec3 moment;       /* N m s: of that about the origin */
    double normal;     /* N s: r_n */
    double tangential; /* N s: |r_t| of each contact */
    double work;       /* J: that the bodies do on it, by its motion */
    double
        friction; /* J: that friction takes, - r_t . u_t, rolling and pivoting friction included */
    double rub;   /* J: r_n |u_t|; Archard's volume of wear is this by a coefficient */
};

struct wall_sums {
    int32_t n;                /* faces of all walls; 0: no sums are kept */
    struct face_sums *face;   /* [n] */
    double since;             /* s: the time at which they began */
    struct wall_faces *faces; /* where contacts are found on them, once a step has asked; owned */
};

/* Sums of 0 that begin at time t (s), of these walls. Returns 0, EX_DATAERR (no walls) or EX_SOFTWARE. */
int sums_begin(struct wall_sums *s, int32_t walls, const struct wall *wall, double t,
               struct failure *failure);
void sums_free(struct wall_sums *s);
/* Frees `faces` alone. */
void sums_forget_faces(struct wall_sums *s);
int sums_copy(struct wall_sums *to, const struct wall_sums *from, struct failure *failure);
/* Are they of these walls' faces, and finite? Returns 0 or EX_DATAERR. */
int sums_check(const struct wall_sums *s, int32_t walls, const struct wall *wall,
               struct failure *failure);
