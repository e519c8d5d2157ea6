/* shape/wall_in_cell.h: walls in a periodic cell: along an edge, or between its faces. */
#pragma once

#include "shape/cell.h"
#include "shape/mesh.h"
#include "shape/wall_shape.h"

/* What a wall's motion and its triangles are read from, of its packing */
struct wall_parts {
    int dim;
    const struct drives *drives;
    const struct mesh *mesh;
};

/*
 * Is the wall the same after a shift by edge k, or does it stand between the faces of that edge, farther from them than a
 * body is thick (m), and never move along their normal? Bodies are in the cell, so that such a wall meets none of their
 * images.
 */
bool wall_fits_edge(const struct wall *w, const struct wall_parts *of, const struct cell *c, int k,
                    double thick);
