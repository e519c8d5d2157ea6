/* draw/page_shapes.h: the shapes of grains as a page has them: triangles, and which of their sides are edges. */
#ifndef NSD_PAGE_SHAPES_H
#define NSD_PAGE_SHAPES_H

#include "state/packing.h"
#include "draw/page_chunk.h"

/*
 * u32 shapes, of which the first is the ball, and has no triangles; u32[shapes] triangles of each; f32[9] the
 * corners of each triangle, of a grain of radius 1 in its own axes; u8 of each triangle, a bit k where its
 * side from corner k to the next is an edge of the surface and not a cut through a face.
 *
 * b->at is to be freed in any case. Returns 0 or EX_SOFTWARE.
 */
int page_shapes(struct chunk *b, int dim, const struct shapes *t, struct failure *failure);

#endif
