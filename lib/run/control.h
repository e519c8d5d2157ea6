/*
 * run/control.h: what a program does to a packing between steps. Forces last until they are changed, or act in one step;
 * both are summed into the packing's forces from outside [state/external_force.h] as a step begins. The rest changes the
 * packing at once.
 *
 * All that fail return EX_DATAERR, EX_USAGE or EX_SOFTWARE, and leave everything as it was.
 */
#pragma once

#include "state/packing.h"

enum control_lasting { CONTROL_ONCE, CONTROL_LASTING, CONTROL_TERMS };

/* All zero to begin with */
struct control {
    int64_t n;                                          /* bodies that the arrays are of */
    int32_t *id;                                        /* [n] which; NULL: there are no arrays */
    vec3 *force[CONTROL_TERMS], *torque[CONTROL_TERMS]; /* [n] N, N m */
    bool pushes[CONTROL_TERMS],
        twists[CONTROL_TERMS];   /* there may be forces, torques other than 0 */
    double *push[CONTROL_TERMS]; /* [walls] N, N m; NULL: none */
};

void control_free(struct control *acts);
/* to = a deep copy; to need not be initialised. */
int control_copy(struct control *to, const struct control *from, int32_t walls,
                 struct failure *failure);
/* The arrays exist, and are those of the packing's bodies, by their ids; new ones are zero. */
int control_arrays(struct control *acts, const struct packing *p, struct failure *failure);
/* A step of p begins: the sums are what acts on it from outside. EX_DATAERR: one is not finite. */
int control_begin(struct control *acts, struct packing *p, struct failure *failure);
/* It has been made: what acts in one step does so no more. */
void control_end(struct control *acts, int32_t walls);
/* What lasts is that of a document in p, which gives it away. Returns 0 or EX_SOFTWARE. */
int control_take(struct control *acts, struct packing *p, struct failure *failure);
/* What of it documents of p keep, borrowed from acts, whose arrays are those of p's bodies */
struct lasting control_lend(const struct control *acts, int32_t walls);
/* Nothing acts any more. */
void control_clear(struct control *acts, int32_t walls);

/* May anything act? */
bool control_any(const struct control *acts);

/* The row of the body with this id; -1: there is none */
int64_t control_row(const struct packing *p, int32_t id);

/* What acts on a body */
struct wrench {
    vec3 force, torque; /* N, N m */
};
/* In place of what acts on the body of this id for so long */
int control_force(struct control *acts, const struct packing *p, int32_t id, struct wrench w,
                  enum control_lasting term, struct failure *failure);
/* N along the axis of its load, N m about it, added to that. EX_DATAERR: the wall has none. */
int control_push(struct control *acts, const struct packing *p, int64_t wall, double force,
                 enum control_lasting term, struct failure *failure);
/* m/s: its prescribed velocity from now on; from its present position on. EX_DATAERR: it turns. */
int control_velocity(struct packing *p, int64_t wall, vec3 v, struct failure *failure);
/* m/s, rad/s: the velocity, or the angular velocity, of the body in row i */
int control_motion(struct packing *p, int64_t i, bool turns, vec3 v, struct failure *failure);
int control_gravity(struct packing *p, vec3 g, struct failure *failure);
/* Between two materials, by their names */
int control_friction(struct packing *p, const char *a, const char *b, double mu,
                     struct failure *failure);
