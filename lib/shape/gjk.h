/*
 * shape/gjk.h: the distance of two convex cores [Gilbert, Johnson & Keerthi 1988], with the places
 * of both that are nearest. What points, segments and hulls that do not overlap need; libccd, which
 * is at hand, says only whether they overlap.
 */
#pragma once

#include "shape/shape.h"

struct nearest {
    double distance; /* m; 0: they overlap, or touch */
    vec3 a, b;       /* m: the nearest places of either */
};

struct nearest gjk_nearest(const struct core *a, const struct core *b);
