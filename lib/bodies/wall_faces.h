/*
 * bodies/wall_faces.h: the faces of boundaries, and on which of them a contact lies. A face is a triangle of a mesh, in the
 * plane a segment; any other boundary is one face. A contact on an edge or at a corner is one of the first face
 * that it belongs to, by the order of the mesh.
 */
#ifndef NSD_WALL_FACES_H
#define NSD_WALL_FACES_H

#include "bodies/packing.h"

struct wall_faces {
    int32_t n; /* faces of all boundaries */
    int32_t walls;
    int32_t *first;          /* [walls + 1] the faces of boundary w are first[w] .. first[w+1]-1 */
    struct surface *surface; /* [walls] of meshes; NULL: not found among their faces */
};

/* meshes: contacts are to be found on the faces of meshes; else all are on face 0. Returns 0, EX_DATAERR or EX_SOFTWARE
   with nothing to free. */
int wall_faces_init(struct wall_faces *f, const struct packing *p, bool meshes, struct why *why);
void wall_faces_free(struct wall_faces *f);

/* The face of a contact with a boundary, counted from the boundary's first one; ahead (s): from the packing's time to
   where the contact acts */
int32_t wall_faces_find(const struct wall_faces *f, const struct packing *p,
                        const struct contact *c, double ahead);
/* m^2, in the plane m: of a face; INFINITY: it has no end */
double wall_faces_area(const struct packing *p, int32_t wall, int32_t face);

#endif
