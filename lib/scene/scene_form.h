/* scene/scene_form.h: a shape of grains while it is read. */
#pragma once

#include "scene/scene_read.h"
#include "shape/solid.h"

/* A shape that is read, and what it stands for; without a volume: itself */
struct form {
    struct shape shape;
    struct solid as;
};

/* "solid", "clump", "mesh" */
extern const struct keys solid_keys, clump_keys, grain_mesh_keys;
int scene_read_grain_mesh(jnode mesh, struct scene *scene, void *form);
