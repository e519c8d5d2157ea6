/*
 * scene/scene_breaks.h: the table of the keys of "breaks", and what a scene makes of it in a packing [state/breakage.h].
 */
#pragma once

#include "scene/scene.h"

/* Of the shape that a ball is cut as */
#define FRACTURE_INSCRIBED "inscribed in a ball"

/* The packing's breakage, and the shape and the columns that it needs. Returns 0, EX_DATAERR or EX_SOFTWARE. */
int scene_breaks_set(struct packing *p, const struct scene *s, struct failure *failure);
/* Can bodies and pours break so, and into how many? Returns 0 or EX_DATAERR. */
int scene_breaks_check(const struct packing *p, const struct scene *s, struct failure *failure);
