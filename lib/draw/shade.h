/*
 * draw/shade.h: what the samples of a band look like, once it is known what is in front.
 *
 * A ball's light: from a lamp over the viewer's left shoulder [Lambert], its soft reflection
 * [Blinn], and from all around as far as nothing near is in the way. Of the sky over a point with
 * normal n, a ball of radius r whose centre lies d along the unit vector e takes away n.e (r/d)^2.
 */
#ifndef NSD_SHADE_H
#define NSD_SHADE_H

#include "draw/band.h"

void shade_normals(struct band *, const struct raster *);
void shade_near(struct band *, const struct raster *);
void shade_pixels(const struct band *, const struct raster *, struct picture *);

#endif
