/*
 * scene/scene_read.h: reads the parts of a scene [scene/scene.h] from its JSON [scene/json_node.h]
 * for scene_parse.c, a file for each. Each returns 0, or not 0 after a fault has been reported.
 */
#ifndef NSD_SCENE_READ_H
#define NSD_SCENE_READ_H

#include "scene/json_node.h"
#include "scene/scene.h"

static const char axis_name[3][2] = { "x", "y", "z" };

/* Zeroed memory; NULL, and the fault reported, when it is short. */
void *scene_alloc(jnode node, size_t count, size_t size);

/* scene/scene_material.c: mu, e_n, e_t; "kinds" and "pairs", with density and law for those that
   give none; the NAME of a kind */
int scene_read_law(const jnode *object, struct scene_law *law);
/* scene/scene_material.c: the laws beyond these; t: the time of the scene, s */
int scene_read_laws(const jnode *object, double t, struct pair_law *law);
int scene_read_kinds(jnode kinds, struct scene *s, double density);
int scene_read_pairs(jnode pairs, struct scene *s, struct scene_law law);
int scene_read_kind(jnode name, const struct scene *s, int32_t *kind);
/* scene/scene_material.c: a "name", *name = NULL where there is none; "parts" of the wall that comes next, and of a mesh
   whether they are the groups of its file (groups NULL: there is no file) */
int scene_read_name(jnode name, const struct scene *s, const char **out);
/* The "name" of a group, added to the scene's: 1 + its row; 0: there is none */
int scene_read_group(jnode name, struct scene *s, int32_t *group);
int scene_read_parts(jnode parts, struct scene *s, bool *groups);

/* scene/scene_walls.c: "walls", where *box = that of the first wall that is a box, the default of a
   lattice, and *boxed whether there is one; a BOX */
int scene_read_walls(jnode walls, struct scene *s, struct scene_box *box, bool *boxed);
/* a vector that is not zero, made of length 1; nothing when it is not there */
int scene_read_direction(jnode vector, int dim, vec3 *out);
/* scene/scene_shapes.c: the shape of a boundary, one of those of space or of the plane; common: the
   keys that it may have besides */
int scene_read_shape_2d(jnode object, const char *common, struct scene *s, struct wall *w);
int scene_read_shape_3d(jnode object, const char *common, struct scene *s, struct wall *w);
/* scene/scene_drives.c: "drives" of a boundary, behind those that are there */
int scene_read_drives(jnode array, struct scene *s, int32_t wall);
/* "forces" on bodies, in time */
int scene_read_forces(jnode a, struct scene *s);
/* a "force" or "torque", a number or a signal: the constant part of l, and pushes behind those that are
   there. Of l, way and axis are known. */
int scene_read_push(jnode force, struct scene *s, int32_t wall, struct load *l);
int scene_read_box(jnode object, int dim, struct scene_box *box);
/* scene/scene_walls.c: "room", the load of walls that have been read */
int scene_read_room(jnode room, struct scene *s);

/* scene/scene_solids.c: "shapes"; the shape of a group of bodies and their orientation; how large they
   are, by their radius or their size */
int scene_read_shapes(jnode shapes, struct scene *s);
int scene_read_form(jnode object, const struct scene *s, struct scene_form *form);
int scene_read_sizes(jnode object, const struct scene *s, const struct scene_form *form,
                     struct scene_size *z);

/* scene/scene_bodies.c: a SIZE; one that is not there leaves *z as it is */
int scene_read_size(jnode size, int dim, struct scene_size *z);

/* scene/scene_flow.c: "pour" and "remove" */
int scene_read_pours(jnode pours, struct scene *s);
int scene_read_removals(jnode removals, struct scene *s);
/* scene/scene_cell.c: "cell", at time t (s); edges may be left out where there are documents among the
   bodies */
int scene_read_cell(jnode cell, int dim, double t, bool documents, struct scene_cell *out);

/* scene/scene_bodies.c: "bodies"; a lattice without a box fills this one (NULL: must have its
   own). */
int scene_read_bodies(jnode bodies, struct scene *s, const struct scene_box *box);
int scene_read_spin(jnode spin, int dim, vec3 *w);
/* density or mass, not both; *density holds the default */
int scene_read_mass(const jnode *object, double *density, double *mass);

#endif
