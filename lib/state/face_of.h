/*
 * state/face_of.h: on which face of a wall [state/wall_faces.h] a contact lies. One on an edge or at a corner is on
 * the first face that it belongs to, by the order of the mesh.
 */
#pragma once

#include "state/packing.h"
#include "state/wall_faces.h"

/* meshes: contacts are to be found on the faces of meshes; else all are on face 0. Returns as wall_faces_init(). */
int face_of_init(struct wall_faces *f, const struct packing *p, bool meshes,
                 struct failure *failure);
/* The face of a contact with a wall, counted from the wall's first one; ahead (s): from the packing's time to
   where the contact acts */
int32_t face_of_contact(const struct wall_faces *f, const struct packing *p,
                        const struct contact *c, double ahead);
/* m^2, in the plane m: of a face; INFINITY: it has no end */
double face_of_area(const struct packing *p, int32_t wall, int32_t face);
