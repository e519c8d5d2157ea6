/*
 * scene/scene_height.h: how high a group of bodies is that fills its box from below: a lattice by the rows of
 * its cells, a random start of so many grains by the solid fraction that it reaches in a wide box, 0.6, in the
 * plane 0.82.
 */
#pragma once

#include "scene/scene.h"

/* m: along the last axis, where `places` cells of this height are on a floor */
double scene_lattice_height(const struct scene_bodies *b, int dim);
/* m: that grains of this volume (m^3, in the plane m^2) take at random on a floor of this area (m^2, m) */
double scene_random_height(int dim, double volume, double area);
/* m: of group g; NAN: of one that has none. *has: that of its box, may be infinite */
double scene_height(const struct scene *s, int64_t g, double *has);
