/*
 * scene/size_table.h: how grains are distributed by size: as a SIZE of a scene asks for [scene/scene_size.h], and as they were
 * drawn. Sizes are diameters, of shaped grains those of the balls around them; shares are of the number, and of the mass at
 * one density.
 */
#pragma once

#include "base/failure.h"
#include "scene/scene_size.h"

#include <stdbool.h>

enum size_share { SIZE_BY_NUMBER, SIZE_BY_MASS, SIZE_SHARES };

/* Diameters, rising, and which share lies at or below each; between them linear where `smooth`, else in steps */
struct size_table {
    int64_t n;
    bool smooth;
    double mean; /* m: by number */
    double *d;   /* [n] m */
    double *below[SIZE_SHARES];
};

/* Each returns 0 or EX_SOFTWARE; size_table_free() in any case. */
int size_table_asked(struct size_table *t, const struct scene_size *z, int dim,
                     struct failure *failure);
/* Of n grains with these radii (m) */
int size_table_drawn(struct size_table *t, const double *radius, int64_t n, int dim,
                     struct failure *failure);
void size_table_free(struct size_table *t);

/* m: the diameter below which there is a share; the share below a diameter */
double size_table_quantile(const struct size_table *t, enum size_share of, double share);
double size_table_below(const struct size_table *t, enum size_share of, double d);
