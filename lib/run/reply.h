/*
 * run/reply.h: what a program answers that nsd-step asks before a step [nsd-step(1)], a line of JSON:
 *
 *   { "forces":  { ID: [x, y, z], ... } or [[x, y, z], ...],     N, of bodies by their ids, or of all in their order
 *     "torques": likewise,                                       N m
 *     "velocities", "angular_velocities": likewise,              m/s, rad/s
 *     "walls": { NUMBER or NAME: { "velocity": [x, y, z], "force": N }, ... },
 *     "gravity": [x, y, z], "friction": [[MATERIAL, MATERIAL, mu], ...], "stop": true }
 *
 * or the word stop. Forces act until the next answer, all else until it is changed.
 */
#pragma once

#include "run/control.h"

#include <jansson.h>

/* The JSON of a line, to be freed; NULL: it is none of these (EX_DATAERR), or no memory */
json_t *reply_parse(const char *line, size_t length, struct failure *failure);
/* Has it the keys of an answer, with values of their types? Whether the bodies, walls and materials exist that it names is
   seen when it is applied. Returns 0 or EX_DATAERR. */
int reply_check(const json_t *answer, struct failure *failure);
/* Applies it as the packing's next step is to begin. *stop: the run is to end before the step, and nothing else is applied.
   Returns 0, EX_DATAERR or EX_SOFTWARE, where nothing has changed. */
int reply_apply(const json_t *answer, struct control *acts, struct packing *p, bool *stop,
                struct failure *failure);
