/*
 * scene/scene_read.h: the tables of keys of a scene's objects [scene/keys.h], a file for each part of it, and what reads
 * the values that need more than a table. Each returns 0, or not 0 after a fault has been reported.
 */
#pragma once

#include "scene/keys.h"
#include "shape/solid.h"

static const char axis_name[3][2] = { "x", "y", "z" };

/* Zeroed memory; NULL, and the fault reported, when it is short. */
void *scene_alloc(jnode node, size_t count, size_t size);

/* scene/scene_parse.c: the scene itself */
extern const struct keys scene_keys;

/* scene/scene_material.c: mu, e_n, e_t and the laws beyond; materials and pairs of them; names of walls, of parts of their
   surfaces and of groups of bodies */
extern const struct keys scene_law_keys, scene_material_keys, scene_pair_keys, scene_part_keys,
    scene_breaks_keys;
extern const struct key_type key_material; /* int32_t, a row of the materials */
extern const struct key_type key_name;     /* const char *, borrowed */
extern const struct key_type key_group;    /* int32_t: 1 + the row of the scene's names */
extern const struct key_type key_faces;    /* int64_t[2], which scene_check_faces() checks */
int scene_check_faces(jnode object, const int64_t face[2]);
extern const struct key_type key_parts, key_mesh_parts;
int scene_read_materials(jnode n, struct scene *s, void *out);
int scene_read_pairs(jnode n, struct scene *s, void *out);
/* Of the wall that comes next; of a mesh: or *groups = whether they are the groups of its file */
int scene_read_parts(jnode n, struct scene *s, void *out);
int scene_read_mesh_parts(jnode n, struct scene *s, void *groups);

/* scene/scene_shapes.c: the shapes of walls, into a struct wall */
extern const struct keys scene_rectangle_keys, scene_disc_keys, scene_cylinder_keys,
    scene_cone_keys, scene_sphere_keys, scene_mesh_keys, scene_circle_keys, scene_arc_keys,
    scene_polygon_keys;
extern const struct key_type key_segment;
int scene_read_segment(jnode n, struct scene *s, void *wall);
int scene_read_polygon(jnode n, struct scene *s, void *wall);
int scene_read_mesh(jnode n, struct scene *s, void *wall);

/* scene/scene_walls.c: "walls" and the "room" between them; a BOX */
extern const struct keys scene_wall_keys, scene_room_keys;
extern const struct key_type key_box; /* struct scene_box */
int scene_read_walls(jnode n, struct scene *s, void *out);
int scene_read_room(jnode n, struct scene *s, void *out);

/* scene/scene_drives.c: "drives" of the wall that comes next, behind those that are there; "forces" on bodies */
extern const struct keys scene_drive_keys, scene_force_keys;
int scene_read_drives(jnode n, struct scene *s);
int scene_read_forces(jnode n, struct scene *s, void *out);
/* A "force" or "torque", a number or a signal: the constant part of l, and pushes behind those that are
   there. Of l, way and axis are known. */
extern const struct key_type key_signal; /* which scene_read_push() reads */
int scene_read_push(jnode force, struct scene *s, int32_t wall, struct load *l);
/* "from" and "until", of a struct whose members AT() finds */
#define FROM(help)  "from", &key_number, AT(from), "s", "-infinity", "0.3", help
#define UNTIL(help) "until", &key_number, AT(until), "s", "infinity", "2", help
int scene_check_span(jnode object, double from, double until);

/* scene/scene_solids.c: "shapes" of grains */
extern const struct key_type key_forms;
int scene_read_shapes(jnode n, struct scene *s, void *out);

/* The shape of the bodies of a group or of a pour, whose struct T has a form and a size; and how large they are.
   scene_finish_grain() scales what is given as the size of a shape. */
extern const struct key_type key_shape, key_orientation, key_size;
#define SHAPE_OF(T)                                                                                \
    "shape", &key_shape, offsetof(T, form), "-", "a ball", "\"stone\"",                            \
        "Name of the shape; without it, a ball, in 2D a disc."
#define ORIENTATION_OF(T)                                                                          \
    "orientation", &key_orientation, offsetof(T, form), "rad", "0", "\"random\"",                  \
        "Uniformly random orientation, or a rotation vector (2D: an angle) for all bodies.",       \
        .with = "shape"
#define RADIUS_OF(T)                                                                               \
    "radius", &key_size, offsetof(T, size), "m", REQUIRED, "1e-3",                                 \
        "Radii; with a shape, of the circumscribed balls, and not required.", .unless = "shape"
#define SIZE_OF(T)                                                                                 \
    "size", &key_size, offsetof(T, size), "-", "1", "2",                                           \
        "Scale factor of the shape; of a sieve curve it is half the aperture.",                    \
        .with = "shape", .without = "radius", .why = "a radius is given too"
int scene_finish_grain(jnode object, const struct scene *s, const struct scene_form *form,
                       struct scene_size *z);

/* scene/scene_flow.c: "pour" and "remove" */
extern const struct keys scene_pour_keys, scene_removal_keys;
int scene_read_pours(jnode n, struct scene *s, void *out);
int scene_read_removals(jnode n, struct scene *s, void *out);

/* scene/scene_cell.c: "cell"; edges may be left out where there are documents among the bodies */
extern const struct keys scene_cell_keys;
extern const struct key_type key_cell, key_repeats; /* bool[3] */
int scene_read_cell(jnode n, struct scene *s, void *cell);

/* scene/scene_bodies.c: "bodies" */
extern const struct keys scene_bodies_keys;
int scene_read_bodies(jnode n, struct scene *s, void *out);

/* Of a type whose values are read when the other keys of the object are known */
int scene_read_later(jnode n, const struct key *k, struct scene *s, void *member);

/* scene/scene_solids.c, scene/scene_clump.c: shapes of grains. */
/* A shape that is read, and what it stands for; without a volume: itself */
struct form {
    struct shape shape;
    struct solid as;
};

/* "solid", "clump", "mesh" */
extern const struct keys solid_keys, clump_keys, grain_mesh_keys;
int scene_read_grain_mesh(jnode mesh, struct scene *scene, void *form);
