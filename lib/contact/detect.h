/*
 * contact/detect.h: which bodies touch, where, and the local basis there. A time step looks at the
 * predicted positions q + (1 - theta) dt qdot [globalmapapp1].
 */
#pragma once

#include "contact/neighbours.h"
#include "contact/seek.h"
#include "state/contact.h"

/*
 * out = a contact for every pair of bodies, and of a body and a wall, whose gap at the predicted
 * positions is at most `gap` (m) and of which one can move; where the law sees gaps
 * [state/packing.h], also for those that may close theirs within the step. Balls meet in one place,
 * bodies of other shapes in several [contact/detect_shapes.h]. Where the cell repeats, b is any image of a body
 * that a meets.
 *
 * kept: neighbours of these bodies, kept from one step to the next to save the search; or NULL. The
 * contacts are the same. Returns 0 or EX_SOFTWARE.
 */
int detect_contacts(struct contacts *out, const struct packing *p, double gap,
                    struct neighbours *kept, struct failure *failure);

/* Its parts: m, the largest gap of a pair that it looks at; those pairs; which of them are contacts, and
   what ties them */
double detect_reach(const struct packing *p, double gap);
int detect_near(struct contacts *out, const struct packing *p, double reach,
                struct neighbours *kept, struct failure *failure);
int detect_choose(struct contacts *s, const struct packing *p, double gap, double reach,
                  struct failure *failure);

/* The same with the bodies at x[n] (m), turned as they are, walls and cell where they are at time t (s). */
int detect_contacts_at(struct contacts *out, const struct packing *p, const vec3 *x, double t,
                       double gap, struct failure *failure);

/* Adds the contacts of one pair of bodies, and of body i and wall w, with at most this gap (m), sorted by feature; from where
   a situation has them. False when memory is short. */
bool detect_pair(struct contacts *out, const struct situation *o, const struct pair *pair,
                 double gap);
bool detect_wall(struct contacts *out, const struct situation *o, int32_t w, int64_t i, double gap);
