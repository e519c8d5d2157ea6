/*
 * draw/raster.h: from things placed among the samples of a picture to its pixels, in bands of rows
 * that do not depend on each other, so that any number of threads draws the same picture.
 */
#pragma once

#include "draw/shade.h"

/* Draws all pixels of p, which has been initialised. Returns 0 or EX_SOFTWARE. */
int raster_draw(const struct raster *s, struct picture *p, struct failure *failure);
