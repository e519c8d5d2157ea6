/*
 * draw/view.h: draws a packing. Balls are ray-cast: at each sample of the picture the ball in front
 * is found, with the exact point and normal seen there. Floors are panels, the edges of the walls
 * are lines, and balls darken what is near to them.
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
    int threads;               /* the picture does not depend on them */
    struct rgb background;
    struct paint paint;
    bool
        boxed; /* region is given: it fills the picture; bodies with centres outside are left out */
    struct region region;

    bool started; /* from here on set by view_extend and view_fit */
    int dim;
    struct window window; /* of the bodies */
    struct camera camera;
};

/*
 * Extends the window and the scale of colours to this packing. Returns 0, or EX_DATAERR when its
 * dim differs from that of those before or when it has neither bodies nor walls.
 */
int view_extend(struct view *v, const struct packing *p, struct why *why);
/* Fits the camera to all packings given to view_extend, and to the walls of this one. */
void view_fit(struct view *v, const struct packing *p);
/* pic = the picture, which the caller frees. Returns 0, EX_DATAERR (dim) or EX_SOFTWARE. */
int view_draw(const struct view *v, const struct packing *p, struct picture *pic, struct why *why);

#endif
