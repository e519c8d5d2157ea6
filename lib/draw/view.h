/*
 * draw/view.h: draws a packing. Balls are ray-cast: at each sample of the picture the ball in front
 * is found, with the exact point and normal seen there. Floors are panels, the edges of the walls
 * are lines, and balls darken what is near to them.
 *
 * The pictures of a series share one window and one scale of colours:
 *
 *     view_extend() for each packing, view_fit(); view_follow(), view_draw() for each packing
 */
#pragma once

#include "draw/camera.h"
#include "draw/paint.h"
#include "draw/picture.h"
#include "draw/wall_facets.h"
#include "draw/walls.h"

struct view {
    double azimuth, elevation; /* degrees */
    vec3 up;                   /* what is upwards in the picture; 0: what is against gravity */
    double angle;              /* degrees, of perspective; 0: none */
    bool cuts;                 /* what lies beyond cut . x = cut_at (m) is cut away */
    vec3 cut;                  /* unit vector */
    double cut_at;
    bool strays;    /* bodies and walls far from all others count too in what the picture shows */
    bool follows;   /* a body stays where it is in the picture: */
    int32_t follow; /* its id */
    bool glass;     /* walls are half-transparent, not lines alone [draw/wall_facets.h] */
    const struct selection *only;    /* bodies that are drawn, and what joins them; NULL: all */
    const struct solid_walls *solid; /* walls that are solid instead; NULL: none */
    float pale;                      /* 0 to 1: how much bodies are mixed with the background */
    int width, height;               /* pixels; 0: chosen */
    int samples;                     /* a pixel is the mean of samples x samples */
    int threads;                     /* the picture does not depend on them */
    struct rgb background;
    struct paint paint;
    bool
        boxed; /* region is given: it fills the picture; bodies with centres outside are left out */
    struct extent region;

    bool started; /* from here on set by view_extend and view_fit */
    int dim;
    struct window window; /* of the bodies */
    struct camera camera;
    vec3 followed; /* m: where the body was in the first packing */
    vec3 moved;    /* m: how far it has come since, set by view_follow() */
};

/* Whether body i is drawn: wanted, and in the picture's region */
bool view_shows(const struct view *v, const struct packing *p, int64_t i);
/* Whether what joins a and b, bodies or a wall (a < 0), is drawn: of a body that is wanted */
bool view_joins(const struct view *v, const struct packing *p, int32_t a, int32_t b);
/* Moves what is shown along with the body that is followed. */
void view_follow(struct view *v, const struct packing *p);
/* Pixels: where a point (m) of the packing is seen; x to the right, y down, z the height. `size` is
   what a length of 1 m has there, in pixels; 0 where the point is behind the eye. */
vec3 view_sees(const struct view *v, vec3 x, double *size);

/*
 * Extends the window and the scale of colours to this packing. Returns 0, or EX_DATAERR when its
 * dim differs from that of those before or when it has neither bodies nor walls.
 */
int view_extend(struct view *v, const struct packing *p, struct failure *failure);
/* Fits the camera to all packings given to view_extend, and to the walls of this one. */
void view_fit(struct view *v, const struct packing *p);
/* pic = the picture, which the caller frees. Returns 0, EX_DATAERR (dim) or EX_SOFTWARE. */
int view_draw(const struct view *v, const struct packing *p, struct picture *pic,
              struct failure *failure);
