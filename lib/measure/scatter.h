/* measure/scatter.h: the centres of bodies as points, and in a periodic cell images of them. */
#ifndef NSD_SCATTER_H
#define NSD_SCATTER_H

#include "measure/period.h"

#include <stdint.h>

struct scatter {
    int64_t n, seekers, room; /* the first of x are the bodies, others images */
    vec3 *x;                  /* [n] m */
    int64_t *of;              /* [n] the body that each is, or is an image of */
    double size[3]; /* m: of the window along axes that do not repeat; INFINITY: it repeats */
    double volume;  /* m^3, m^2: of the window */
};

/* Appends a point; false when memory is short. */
bool scatter_add(struct scatter *a, vec3 x, int64_t of);
/* Brings the first `seekers` into the cell, and appends all their images within `reach` (m) of it; false when memory is
   short. */
bool scatter_images(struct scatter *a, const struct period *m, double reach);
void scatter_free(struct scatter *a);

#endif
