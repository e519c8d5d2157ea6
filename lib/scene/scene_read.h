/*
 * scene/scene_read.h: the parts of a scene [scene/scene.h] out of its JSON [scene/json_node.h], a file
 * each; for scene_parse.c. Each returns 0, or another number where a fault has been told.
 */
#ifndef NSD_SCENE_READ_H
#define NSD_SCENE_READ_H

#include "scene/json_node.h"
#include "scene/scene.h"

static const char axis_name[3][2] = { "x", "y", "z" };

/* Zeroed; the fault is told where there is none. */
void *scene_room(jnode, size_t count, size_t size);

/* scene/scene_material.c: kinds and their pairs; a NAME among them */
int scene_read_law(const jnode *, struct scene_law *);
int scene_read_kinds(jnode, struct scene *, double density);
int scene_read_pairs(jnode, struct scene *, struct scene_law);
int scene_read_kind(jnode, const struct scene *, int32_t *kind);

/* scene/scene_walls.c: *box is that of the first boxed wall, the default place of a lattice. */
int scene_read_walls(jnode, struct scene *, struct scene_box *box, bool *boxed);
int scene_read_box(jnode, int dim, struct scene_box *);

/* scene/scene_bodies.c: box, or NULL: where a lattice without one goes */
int scene_read_bodies(jnode, struct scene *, const struct scene_box *box);

#endif
