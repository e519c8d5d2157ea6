/*
 * state/selection.h: which walls, faces and bodies a list of names means: "floor,blade,3". A word is the number of
 * a wall, or a name: of walls, of parts of them, of a group of bodies, or of a material, which walls and bodies have.
 */
#pragma once

#include "state/packing.h"
#include "state/wall_faces.h"

struct selection {
    bool any;       /* a list is given; else all are chosen */
    bool walls;     /* it names a wall, or a part of one */
    bool bodies;    /* it names a group of bodies or a material */
    bool *wall;     /* [walls] as a whole */
    bool *name;     /* [names.n] */
    bool *material; /* [materials] */
};

/* list NULL: all. option: "--only", for the message, which lists what there is. Returns 0, EX_DATAERR or EX_SOFTWARE
   with nothing to free. */
int selection_init(struct selection *c, const struct packing *p, const char *option,
                   const char *list, struct failure *failure);
void selection_free(struct selection *c);

/* The wall, or any of its faces; the face, counted from the wall's first one; the body */
bool selection_wall(const struct selection *c, const struct packing *p, int32_t wall);
bool selection_face(const struct selection *c, const struct packing *p, int32_t wall, int32_t face);
bool selection_body(const struct selection *c, const struct packing *p, int64_t i);
/* The contact of such a body, or with such a face; faces: of face_of_init() */
bool selection_contact(const struct selection *c, const struct packing *p,
                       const struct wall_faces *faces, const struct contact *contact);
