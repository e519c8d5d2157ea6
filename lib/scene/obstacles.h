/*
 * scene/obstacles.h: the walls of a scene as a random start meets them [scene/random_start.h]: a ball must touch none, and
 * lie on the side that is free.
 *
 * The free side of a plane, cylinder, cone or sphere is the wall's own. A closed mesh, in the plane a closed polygon, has two:
 * where its box contains the box of the group, grains are inside it (a vessel), else outside (an obstacle). A wall whose free
 * side the box does not reach, such as that of another vessel, is met only at its surface.
 */
#pragma once

#include "scene/scene.h"
#include "shape/mesh.h"
#include "state/packing.h"

#define OBSTACLES_SEEN ((int64_t)1 << 33) /* some minutes */

struct obstacle {
    int32_t wall;
    struct pose pose;
    struct surface surface; /* of a mesh */
    bool sided;             /* grains stay on one side: */
    bool hollow; /* the free one of a round wall; within a mesh. false: outside the mesh */
    bool has_free, has_other; /* that one has a part of the box; the other one has */
};

struct obstacles {
    const struct packing *p; /* borrowed: its walls */
    int32_t n;
    struct obstacle *o; /* [n] */
    double free;        /* share of the box on the free sides of all */
    _Atomic int64_t
        seen; /* elements of meshes that obstacles_push has looked at; beyond OBSTACLES_SEEN it sees none */
};

/* The walls of p at its time, for a group in the box, or in its cell where `cell`. Returns 0, EX_DATAERR or EX_SOFTWARE;
   obstacles_free() in any case. */
int obstacles_init(struct obstacles *all, const struct packing *p, const struct scene_box *box,
                   const struct cell *cell, struct failure *failure);
void obstacles_free(struct obstacles *all);

/* Does the ball at x with radius r (m) touch a wall, or lie on the wrong side of one? */
bool obstacles_meet(const struct obstacles *all, vec3 x, double r);
/* Moves x out of the walls that a ball of radius r touches; returns the deepest overlap before that, m. */
double obstacles_push(const struct obstacles *all, vec3 *x, double r);
