/* scene/scene_fill.h: bodies of groups, from their places and sizes to rows of a packing. */
#pragma once

#include "scene/grains.h"
#include "scene/scene.h"
#include "state/packing.h"

#include <gsl/gsl_rng.h>

/* The bodies of all groups into a packing that has room for them; list[groups]: of those that are lists. Returns 0,
   EX_DATAERR or EX_SOFTWARE. */
int scene_fill(struct packing *p, const struct scene *s, const struct grains *list, gsl_rng *rng,
               struct failure *failure);
