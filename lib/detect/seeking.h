/*
 * detect/seeking.h: the pairs of bodies that are near each other, sought anew; how long a list of them serves is
 * the affair of detect/neighbours.c. seek.c seeks them.
 *
 * Cost is linear: bodies are sorted by size into levels of a factor of two, each level into the
 * cells of its own grid, and a body looks into the grids of its own and of larger sizes only.
 * Cells are hashed, so that a body far away costs nothing. Bodies that
 * lie within reach of the cell's border look from their images too, which costs as much as the
 * border has bodies.
 */
#ifndef NSD_SEEKING_H
#define NSD_SEEKING_H

#include "base/why.h"
#include "bodies/packing.h"

struct neighbours;

/*
 * s->pair[s->n] = every pair whose gap is at most s->reach (m), the s->bodies bodies at x (m) and the cell's edges
 * at edge[3] (m). Returns 0, EX_SOFTWARE, or EX_DATAERR where bodies crowd, or are more than three cells apart.
 */
int seek_pairs(struct neighbours *s, const struct packing *p, const vec3 *x, const vec3 edge[3],
               struct why *why);

#endif
