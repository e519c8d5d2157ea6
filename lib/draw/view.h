/*
 * draw/view.h: a packing drawn. Balls are ray-cast: of every sample of the picture the ball in front is
 * known with the exact point and normal that are seen there. Floors lie under them, the edges of
 * the walls are lines, and what is near darkens what it is near to.
 *
 * The pictures of a series share one window and one scale of colours:
 *
 *     view_extend() for each packing, view_fit(), view_draw() for each packing
 */
#ifndef NSD_VIEW_H
#define NSD_VIEW_H

#include "draw/camera.h"
#include "draw/paint.h"
#include "draw/picture.h"
#include "draw/walls.h"

struct view {
    double azimuth, elevation; /* degrees */
    int width, height;         /* pixels; 0: chosen */
    int samples;               /* a pixel is the mean of samples x samples */
    int threads;               /* they never change the picture */
    struct rgb background;
    struct paint paint;
    bool boxed; /* only the bodies whose centre is in the region, which fills the picture */
    struct region region;

    bool started; /* what view_extend has seen so far: */
    int dim;
    struct window window; /* of the bodies */
    struct camera camera;
};

/*
 * Room for this packing. EX_DATAERR: it has another dim than those before, or there is nothing to
 * see, neither bodies nor walls.
 */
int view_extend(struct view *, const struct packing *, struct why *);
/* The camera looks at all that view_extend was shown, and at this packing's walls. */
void view_fit(struct view *, const struct packing *);
/* The picture, which is freed by the caller. */
int view_draw(const struct view *, const struct packing *, struct picture *, struct why *);

#endif
