/*
 * draw/camera.h: an orthographic camera, and the window of its plane that a picture shows.
 *
 * A point x is seen at (right . x, up . x), and toward . x is its height above the picture's plane:
 * the largest one hides the others. Lengths across the line of sight are true, near and far alike.
 */
#ifndef NSD_CAMERA_H
#define NSD_CAMERA_H

#include "base/vec.h"

struct camera {
    vec3 right, up, toward; /* unit vectors; right x up = toward, which points to the viewer */
    double u, v;            /* m: what is seen in the picture's middle */
    double scale;           /* pixels a metre */
    int width, height;      /* pixels */
};

/* m; empty while u0 > u1 */
struct window {
    double u0, u1, v0, v1;
};

enum { CAMERA_SIDE = 900 }; /* pixels of the longer side, unless they are given */

/*
 * azimuth, elevation in degrees: 0, 0 looks along y with z upwards, and the azimuth then goes to the
 * right about z. In the plane (dim 2) it looks at x and y from the front.
 */
void camera_turn(struct camera *, int dim, double azimuth, double elevation);

static inline vec3 camera_sees(const struct camera *c, vec3 x)
{
    return v3(v3_dot(c->right, x), v3_dot(c->up, x), v3_dot(c->toward, x));
}

static const struct window window_empty = { INFINITY, -INFINITY, INFINITY, -INFINITY };

/* The window grows to hold a ball of radius r at x. */
void window_add(struct window *, const struct camera *, vec3 x, double r);

/* The window in the middle of width x height pixels (0: chosen by its shape), as large as it goes
   with this part of it as margin on each side. */
void camera_fit(struct camera *, const struct window *, double margin, int width, int height);

#endif
