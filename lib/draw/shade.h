/*
 * draw/shade.h: the colours of the samples of a band, once it is known what is in front at each.
 *
 * A ball is lit by a lamp over the viewer's left shoulder [Lambert], whose soft reflection it shows
 * [Blinn], and by the sky all around unless something near is in the way. Of the sky over a point
 * with normal n, a ball of radius r whose centre lies d away along the unit vector e hides n.e
 * (r/d)^2.
 */
#ifndef NSD_SHADE_H
#define NSD_SHADE_H

#include "draw/band.h"

/* In this order: b->n; b->dark; the pixels of p in the band */
void shade_normals(struct band *b, const struct raster *s);
void shade_near(struct band *b, const struct raster *s);
void shade_pixels(const struct band *b, const struct raster *s, struct picture *p);

#endif
