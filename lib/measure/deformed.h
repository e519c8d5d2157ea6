/*
 * measure/deformed.h: how the room of the grains is deformed from frame to frame: dx = F dX, by the edges
 * of the periodic cell and, along other axes, by how far walls are apart that are upright to the axis,
 * or the bodies reach where there are none.
 *
 * The edges of a cell are a basis of a lattice, and a run may change it [state/wrap.h]. From one frame to
 * the next E' = F E N, N whole numbers of determinant 1 or -1: those that leave F nearest to what the
 * edges' rates say.
 */
#ifndef NSD_DEFORMED_H
#define NSD_DEFORMED_H

#include "state/packing.h"
#include "measure/tensor.h"

/* All zero to begin with. */
struct deformed {
    bool known;      /* of a frame */
    bool lost;       /* the frames were too far apart to follow the cell's edges */
    double t;        /* s */
    struct tensor F; /* since the first frame */
    vec3 span[3];    /* m: edges, or the extents along the axes */
    vec3 rate[3];    /* m/s: of the edges; 0 of extents */
};

/* To the frame that the packing is: the first one has F = 1. */
void deformed_follow(struct deformed *d, const struct packing *p);

#endif
