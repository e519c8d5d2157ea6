/*
 * state/wall_faces.h: the faces of walls. A face is a triangle of a mesh, in the plane a segment; any other wall
 * is one face. Which face a contact is on is in state/face_of.h.
 */
#pragma once

#include "shape/mesh.h"
#include "shape/wall_shape.h"

struct wall_faces {
    int32_t n; /* faces of all walls */
    int32_t walls;
    int32_t *first;          /* [walls + 1] the faces of wall w are first[w] .. first[w+1]-1 */
    struct surface *surface; /* [walls] of meshes; NULL: not found among their faces */
};

/* mesh: places are to be found on the faces of meshes; NULL: not. Returns 0, EX_DATAERR or EX_SOFTWARE with nothing to
   free. */
int wall_faces_init(struct wall_faces *f, int32_t walls, const struct wall *wall,
                    const struct mesh *mesh, struct failure *failure);
void wall_faces_free(struct wall_faces *f);
