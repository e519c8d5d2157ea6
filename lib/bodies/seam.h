/*
 * bodies/seam.h: seams of surfaces that are assembled of several parts: triangles, walls, bodies side by
 * side. A body that slides on one part meets the rim of the next, which lies in the same plane, with a
 * normal along that plane; where the law sees gaps it would be stopped there. Such a contact is none.
 *
 * A contact of body s with part B, of normal n towards s, is dropped where s also touches a part E, and
 *
 *     the place lies on E, to a tolerance, and n leads from there into E;
 *     no other place of these two with that normal is above E's plane on the side of s;
 *     and B does not rise above it there by more than 30 degrees.
 *
 * What rises is a wall or a step, and is met as it would be without E: a step that is higher than the
 * tolerance is not flush. Ends of surfaces, ridges and grooves are as they were: n leads into no surface there.
 * B and E may be one mesh, whose triangles do not share all corners. The tolerance is the larger of the weld
 * tolerances of both [bodies/boundary.h] and 1e-5 of the radius of s.
 */
#ifndef NSD_SEAM_H
#define NSD_SEAM_H

#include "bodies/contact.h"
#include "bodies/mesh.h"
#include "bodies/placed.h"

/* Where contacts have been found */
struct seams {
    const struct packing *p;
    const vec3 *x, *edge;          /* [p->n] m; edges of the cell, NULL: it does not repeat */
    double t;                      /* s: of the walls */
    const struct placed *shaped;   /* NULL: all are balls */
    const struct surface *surface; /* [p->walls] of those that are meshes */
};

/* Drops contacts of s, sorted, at seams. Returns 0 or EX_SOFTWARE. */
int seams_drop(struct contacts *s, const struct seams *o, struct why *why);

#endif
