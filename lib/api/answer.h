/*
 * api/answer.h: what a program answers that nsd-step asks before a step [nsd-step(1)], a line of JSON:
 *
 *   { "forces":  { ID: [x, y, z], ... } or [[x, y, z], ...],     N, of bodies by their ids, or of all in their order
 *     "torques": likewise,                                       N m
 *     "boundaries": { NUMBER: { "velocity": [x, y, z], "force": N }, ... },
 *     "gravity": [x, y, z], "friction": [[KIND, KIND, mu], ...], "stop": true }
 *
 * or the word stop. Forces act until the next answer, all else until it is changed.
 */
#ifndef NSD_ANSWER_H
#define NSD_ANSWER_H

#include "api/acts.h"

#include <jansson.h>

/* The JSON of a line, to be freed; NULL: it is none of these (EX_DATAERR), or no memory */
json_t *answer_parse(const char *line, size_t length, struct why *why);
/* Does it as the packing's next step is to begin. *stop: the run is to end before it. Returns 0, EX_DATAERR or EX_SOFTWARE,
   where some of it may be done. */
int answer_apply(const json_t *answer, struct acts *acts, struct packing *p, bool *stop,
                 struct why *why);

#endif
