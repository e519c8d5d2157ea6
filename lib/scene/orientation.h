/* scene/orientation.h: how grains that have a shape are turned: as it is described, or at random. */
#ifndef NSD_ORIENTATION_H
#define NSD_ORIENTATION_H

#include "scene/scene.h"

#include <gsl/gsl_rng.h>

/* From the shape's own axes to space; rng is used where orientations are random, each as likely. */
quat orientation_draw(const struct scene *s, const struct scene_form *form, gsl_rng *rng);

#endif
