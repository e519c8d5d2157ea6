/*
 * state/external_force.h: forces and torques on single bodies as functions of time, which a scene has: signals in N, N m along
 * and about an axis, each of the body whose id is its `wall`, in the order of these ids. A step sees them at its
 * middle, beside gravity.
 */
#pragma once

#include "base/failure.h"
#include "base/vec.h"
#include "shape/drive.h"

#include <stdbool.h>
#include <stdint.h>

/* N; N m where `turns`: the sum on the body with this id at time t (s) */
vec3 pulls_on(const struct drives *pulls, int32_t id, double t, bool turns);
/* m/s^2: no body of these ids and masses (kg) [n] gains more by them */
double pulls_most(const struct drives *pulls, int64_t n, const int32_t *id, const double *mass);
/* Are they signals of forces, in their order, and `most` (m/s^2) a number? Returns 0 or EX_DATAERR. */
int pulls_check(const struct drives *pulls, double most, int dim, struct failure *failure);

/*
 * What acts on a packing from outside: a program that steps it (run/nsd.h) or that nsd-step
 * asks (nsd-step --with). The forces enter the equation of motion in addition to gravity,
 *
 *     M (v+ - v) = dt (M g + F) + H r
 *
 * and those of walls add to their loads. All is of the step to come. A packing without any has none of the arrays.
 */

/* Forces that act until they are changed: they go with documents, and a step of them makes its own [run/control.h]. */
struct lasting {
    vec3 *force, *torque; /* [n] N, N m, in space; NULL: none, of either */
    double *push;         /* [walls] N, N m; NULL: none */
};

struct external_force {
    vec3 *force, *torque; /* [n] N, N m, in space; NULL: none, of either */
    double most;          /* m/s^2: no body gains more by them; outside_measure() keeps it */
    double *push;         /* [walls] N, N m: added to the load of a wall; NULL: none */
    struct lasting lasts;
    bool steered; /* gravity, friction or the motion of a wall may differ from frame to frame */
    int64_t length, room; /* bytes of words */
    char *words; /* what was answered since the last frame: JSON lines, not ended by a 0; or NULL */
};

void external_force_free(struct external_force *outside);
/* The forces are of a step that has been made, and the words are written: they are gone, but for those that last. */
void external_force_forget(struct external_force *outside);
/* *to = force or torque, [n], zero, unless it exists; push[walls], likewise. Each returns 0 or EX_SOFTWARE, where nothing
   has changed. */
int external_force_alloc(vec3 **to, int64_t n, struct failure *failure);
int external_force_alloc_push(struct external_force *outside, int32_t walls,
                              struct failure *failure);
/* A step begins: its forces are those that last. mass[n], kg. Returns 0 or EX_SOFTWARE. */
int external_force_begin(struct external_force *outside, const double *mass, int64_t n,
                         int32_t walls, struct failure *failure);
/* Bodies are removed: body i is now in row[i], in the same order; < 0: it is gone. Of those that last. */
void external_force_follow(struct external_force *outside, const int32_t *row, int64_t n);
/* Forces of n bodies in place of those of `had`; new ones are zero. Returns 0 or EX_SOFTWARE, where nothing has
   changed. */
int external_force_resize(struct external_force *outside, int64_t had, int64_t n,
                          struct failure *failure);
/* Finds `most`, of bodies with these masses (kg). */
void external_force_measure(struct external_force *outside, const double *mass, int64_t n);
/* Appends words of length bytes. Returns 0 or EX_SOFTWARE, where nothing has changed. */
int external_force_say(struct external_force *outside, const char *words, int64_t length,
                       struct failure *failure);
/* Is every number finite, and in the plane where dim is 2? Returns 0 or EX_DATAERR. */
int external_force_check(const struct external_force *outside, int dim, int64_t n, int32_t walls,
                         struct failure *failure);
