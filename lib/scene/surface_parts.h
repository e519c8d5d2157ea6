/*
 * scene/surface_parts.h: the convex shape of a grain from the triangles of a file [scene/mesh_file.h].
 *
 * The triangles are to be the surface of a convex body as they stand: closed, each edge the side of two
 * of them, once either way, corners within 1e-6 of the extent being one; outward; nowhere around a place twice; with the volume of their convex hull to 1e-5. What is taken is then the hull, whose faces are as large as they can be,
 * not triangles. Or the hull of the corners is wanted, and of the triangles nothing is asked.
 */
#pragma once

#include "scene/scene.h"
#include "shape/mesh.h"
#include "shape/shape.h"

/* s's vertices (m), faces and corners. hull: of the corners, whatever the triangles are. Returns 0,
   EX_DATAERR with what is wrong with the surface, or EX_SOFTWARE. *by_hull: the hull may do where the surface does not. */
int mesh_shape(struct shape *s, const struct mesh *m, bool hull, bool *by_hull,
               struct failure *failure);

/* Is every side of a triangle that of two, once either way? Returns 0, EX_DATAERR or EX_SOFTWARE. */
int mesh_closed(const struct mesh *m, struct failure *failure);

/*
 * Parts of a surface that are of another material, or move along themselves otherwise. They become
 * walls of their own behind the others, which move as the surface does; the rest is the surface.
 */

/* When meshes have been read. Returns 0, EX_SOFTWARE, or EX_DATAERR where faces do not exist or are named twice. */
int scene_parts_split(struct scene *s, struct failure *failure);
