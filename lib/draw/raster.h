/*
 * draw/raster.h: from things placed among the samples of a picture to its pixels, in bands that know
 * nothing of each other: any number of threads draws the same.
 */
#ifndef NSD_RASTER_H
#define NSD_RASTER_H

#include "draw/band.h"

/* All pixels of the picture, which is there already. Returns 0 or EX_SOFTWARE without memory. */
int raster_draw(const struct raster *, struct picture *, struct why *);

#endif
