/*
 * api/acts.h: what a program does to a packing between steps. Forces last until they are changed, or act in one step;
 * both are summed into the packing's forces from outside [bodies/outside.h] as a step begins. The rest changes the
 * packing at once.
 *
 * All that fail return EX_DATAERR, EX_USAGE or EX_SOFTWARE, and leave everything as it was.
 */
#ifndef NSD_ACTS_H
#define NSD_ACTS_H

#include "bodies/packing.h"

enum acts_lasting { ACTS_ONCE, ACTS_LASTING, ACTS_TERMS };

/* All zero to begin with */
struct acts {
    int64_t n;                                    /* bodies that the arrays are of */
    int32_t *id;                                  /* [n] which; NULL: there are no arrays */
    vec3 *force[ACTS_TERMS], *torque[ACTS_TERMS]; /* [n] N, N m */
    bool pushes[ACTS_TERMS], twists[ACTS_TERMS];  /* there may be forces, torques other than 0 */
    double *push[ACTS_TERMS];                     /* [walls] N, N m; NULL: none */
};

void acts_free(struct acts *acts);
/* to = a deep copy; to need not be initialised. */
int acts_copy(struct acts *to, const struct acts *from, int32_t walls, struct why *why);
/* The arrays exist, and are those of the packing's bodies, by their ids; new ones are zero. */
int acts_arrays(struct acts *acts, const struct packing *p, struct why *why);
/* A step of p begins: the sums are what acts on it from outside. EX_DATAERR: one is not finite. */
int acts_begin(struct acts *acts, struct packing *p, struct why *why);
/* It has been made: what acts in one step does so no more. */
void acts_end(struct acts *acts, int32_t walls);
/* What lasts is that of a document in p, which gives it away. Returns 0 or EX_SOFTWARE. */
int acts_take(struct acts *acts, struct packing *p, struct why *why);
/* What of it documents of p keep, borrowed from acts, whose arrays are those of p's bodies */
struct lasting acts_lend(const struct acts *acts, int32_t walls);
/* Nothing acts any more. */
void acts_clear(struct acts *acts, int32_t walls);

/* May anything act? */
bool acts_any(const struct acts *acts);

/* The row of the body with this id; -1: there is none */
int64_t acts_row(const struct packing *p, int32_t id);

/* What acts on a body */
struct wrench {
    vec3 force, torque; /* N, N m */
};
/* In place of what acts on the body of this id for so long */
int acts_force(struct acts *acts, const struct packing *p, int32_t id, struct wrench w,
               enum acts_lasting term, struct why *why);
/* N along the axis of its load, N m about it, added to that. EX_DATAERR: the boundary has none. */
int acts_push(struct acts *acts, const struct packing *p, int64_t wall, double force,
              enum acts_lasting term, struct why *why);
/* m/s: its prescribed velocity from now on; from its present position on. EX_DATAERR: it turns. */
int acts_velocity(struct packing *p, int64_t wall, vec3 v, struct why *why);
/* m/s, rad/s: the velocity, or the angular velocity, of the body in row i */
int acts_motion(struct packing *p, int64_t i, bool turns, vec3 v, struct why *why);
int acts_gravity(struct packing *p, vec3 g, struct why *why);
/* Between two kinds of material, by their names */
int acts_friction(struct packing *p, const char *a, const char *b, double mu, struct why *why);

#endif
