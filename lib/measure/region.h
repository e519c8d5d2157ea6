/*
 * measure/region.h: where a measure looks: all there is, a box, a layer, a shell. What lies only
 * partly in a region counts by its part: balls by their volume, forces by the part of the branch
 * vector along which they act, which is what coarse graining with the region's indicator function
 * gives [Goldhirsch 2010].
 *
 * Where the cell repeats, a region sees images.
 */
#pragma once

#include "base/failure.h"
#include "measure/near.h"
#include "state/packing.h"

/* How far planes let bodies reach. */

/* Narrows [lo, hi] (m) to what walls upright to the axis leave of it, where they are now. */
void reach_of_planes(const struct packing *p, int axis, double *lo, double *hi);

struct region {
    int dim;
    bool all;            /* everything is in it, wherever it is */
    double lo[3], hi[3]; /* m: a box; infinite: no bound. Of `all`: how far everything reaches */
    double inner, outer; /* m: distances from the line along z through centre; outer 0: no shell */
    vec3 centre;         /* m */
    double volume;       /* m^3, m^2 in the plane */
    struct period period;
};

/*
 * All there is: along an edge that repeats the cell, along others from wall to wall where a wall is
 * upright to the axis, else as far as bodies reach. The volume is 0 without bodies.
 */
void region_whole(struct region *r, const struct packing *p);
/* The box from lo to hi (m) */
void region_box(struct region *r, const struct packing *p, const double lo[3], const double hi[3]);
/*
 * n layers of a region along an axis; n shells of the same thickness around the line along z through
 * centre, out to where `in` ends. False, with a reason, where that is not possible.
 */
bool region_layers(struct region *layer, int64_t n, const struct region *in,
                   const struct packing *p, int axis, const char **reason);
bool region_shells(struct region *shell, int64_t n, const struct region *in,
                   const struct packing *p, vec3 centre, const char **reason);

/* The images of a point that are within a margin (m) of the region, one after another; where nothing
   repeats, or the region holds all, the point itself. region_next() is false after the last. */
struct region_walk {
    int64_t from[3], to[3], at[3]; /* edges */
};
struct region_walk region_walk(const struct region *r, vec3 x, double margin);
/* Are there so many of each of n bodies that a walk for each would take minutes? Returns 0, or EX_DATAERR with `what` in the
   reason. */
int region_check_images(const struct region *r, int64_t n, double margin, const char *what,
                        struct failure *failure);
bool region_next(struct region_walk *w, const struct region *r, vec3 x, vec3 *image);
/* m/s: how much faster than the body the image is that region_next() has found last */
vec3 region_rate(const struct region_walk *w, const struct region *r);

/* How many images of the point are in the region: 0 or 1 where nothing repeats */
int region_holds(const struct region *r, vec3 x);
/* m/s: the sum of their velocities, of a body at x whose own is v */
vec3 region_velocities(const struct region *r, vec3 x, vec3 v);
/* m^3, m^2: the volume in the region of a ball of this radius (m) at x */
double region_ball(const struct region *r, vec3 x, double radius);
/* The part in the region of the way from x to x + l, 0 to 1; 1 where it holds all */
double region_way(const struct region *r, vec3 x, vec3 l);
