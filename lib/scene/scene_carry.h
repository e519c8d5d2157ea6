/*
 * scene/scene_carry.h: what a document knows of its bodies besides their places and velocities, on its way into a packing
 * that is built of them. Bonds and liquid bridges come along wherever the scene has laws for them; bonds with a wall where
 * the scene has the same wall. A scene at the time of its document continues the run: it takes the remembered
 * reactions, forces that last, edges gone, and what the run does about overlaps, too.
 */
#pragma once

#include "scene/scene.h"
#include "state/packing.h"

/* Once p has the scene's bodies, of the documents' groups in their order, walls and laws; row[g]: where group g begins.
   Returns 0 or EX_SOFTWARE. */
int scene_carry(struct packing *p, const struct scene *s, const int64_t *row,
                struct failure *failure);
/* Once it has its dt, too */
void scene_carry_dt(struct packing *p, const struct scene *s);

/* A scene at the time of its first document counts its time as that does: it goes on with the same bits. */
void scene_carry_clock(struct packing *p, const struct scene *s);
/* The walls of the first document, where the scene has none; its cell, or what the scene leaves out of it. Each returns 0,
   EX_DATAERR or EX_SOFTWARE. */
int scene_carry_walls(struct packing *p, const struct scene *s, struct failure *failure);
int scene_carry_cell(struct packing *p, const struct scene *s, struct failure *failure);

/* What the documents have and p does not */
struct scene_lost {
    const char *file; /* the first document; NULL: there is none */
    int64_t bonds; /* bonds and bridges without a law, or with walls that the scene does not have */
    bool sums;     /* of walls: they begin with each scene */
    bool forces;   /* that last */
    bool poured;   /* what pours have brought: they begin again from 0 */
    bool steered;  /* a program has changed gravity, friction or the motion of walls */
    double dt;     /* s: of the run, where the scene's is chosen again; 0: it is not */
};
struct scene_lost scene_lost(const struct packing *p, const struct scene *s);
