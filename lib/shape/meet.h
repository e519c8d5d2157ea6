/*
 * shape/meet.h: where two convex cores meet: at most four places, each with its gap.
 *
 * Hulls that overlap are told apart along the best of their separating axes, the normals of faces and,
 * in space, the products of edges that make a face of the Minkowski difference [Gregorius 2013]. Where
 * that is a face, the face of the other that looks at it most is clipped to its sides, and its corners
 * are places, each as deep as it is; the others that are left are those beyond `reach`, so that a
 * brick that is tipped loses its corners one by one. Crossed edges have one place. Cores that do not
 * overlap, points and segments among them, are told apart along their shortest connection
 * [shape/gjk.h], and where that is a face's normal, as above. Rounded edges side by side have two
 * places, as segments have: with one, at whichever end is nearer, two cards that lean against each other
 * fall.
 *
 * The gap between sharp hulls that do not overlap is that along the best axis: where a corner is next
 * to a corner it is less than their distance, never more.
 */
#pragma once

#include "shape/shape.h"

enum { PLACES_MOST = 4 };

struct place {
    vec3 x, n;  /* m: midway in the gap; from a to b */
    double gap; /* m */
    int32_t
        feature; /* what meets there: lasts from step to step while the same corners and edges do */
};

/* Returns how many places have a gap of at most `reach` (m). */
int meet_cores(int dim, const struct core *a, const struct core *b, double reach,
               struct place place[PLACES_MOST]);
/* Of a segment and a hull: which end of the segment meets there; -1: none */
int meet_end(const struct place *place);
/* Leaves four of n places: the deepest, and those that span most. Returns how many are left. */
int meet_few(struct place *place, int n);
