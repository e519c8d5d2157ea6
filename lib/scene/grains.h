/*
 * scene/grains.h: the bodies of a group before they are a packing: what a table, a document or a
 * random start says of each. What it does not say is the group's.
 */
#pragma once

#include "scene/scene.h"
#include "state/packing.h"

#include <gsl/gsl_rng.h>

/* How grains that have a shape are turned: as it is described, or at random. */

/* Each orientation as likely */
quat quat_draw(int dim, gsl_rng *rng);
/* From the shape's own axes to space; rng is used where orientations are random, each as likely. */
quat orientation_draw(const struct scene *s, const struct scene_form *form, gsl_rng *rng);

struct grain {
    vec3 x;                           /* m */
    quat q;                           /* orientation */
    vec3 v, w;                        /* m/s, rad/s */
    double r;                         /* m */
    double density;                   /* kg/m^3, in the plane kg/m^2; 0: not said */
    double mass, inertia;             /* kg, kg m^2; 0: not said */
    int32_t material, id;             /* -1: not said */
    int32_t shape;                    /* of its document's; 0: a ball */
    int32_t group;                    /* 1 + row of its document's names; 0: none */
    bool has_v, has_w, fixed, weighs; /* weighs: mass and inertia are said, even where they are 0 */
};

struct grains {
    int64_t n, room;
    struct grain *g;
};

/* A grain of which nothing is said but where and how large it is */
struct grain grain_at(vec3 x, double r);

/* Returns 0 or EX_SOFTWARE. */
int grains_add(struct grains *list, const struct grain *grain, struct failure *failure);
void grains_free(struct grains *list);

/* scene/grains.c: those of a table [scene/scene.h]; dir as of scene_build. Returns 0,
   EX_DATAERR with file:line, EX_NOINPUT or EX_SOFTWARE. */
int grains_of_table(struct grains *out, const struct scene *s, const char *dir, const char *name,
                    struct failure *failure);
/* The scene's material for material k of a document: of its name; of another program's file as "types" has it, else of its
   name, else the first, where it has just one. -1: none */
int32_t grains_material(const struct scene *s, const struct scene_bodies *b, int32_t k);
/* scene/grains.c: those of a document's frame: EX_DATAERR where a material is none of the scene's. */
int grains_of_document(struct grains *out, const struct scene *s, const struct scene_bodies *b,
                       struct failure *failure);

/* ---- scene/scene_fill.c: from there to rows of a packing ---- */

/* The bodies of all groups into a packing that has room for them; list[groups]: of those that are lists. Returns 0,
   EX_DATAERR or EX_SOFTWARE. */
int scene_fill(struct packing *p, const struct scene *s, const struct grains *list, gsl_rng *rng,
               struct failure *failure);
