/*
 * draw/camera.h: a camera, and the window of its plane that a picture shows.
 *
 * A point x is seen at (right . x, up . x), and toward . x is its height above the picture's plane:
 * the highest point hides the others. Lengths across the line of sight keep their size at any
 * depth.
 *
 * With perspective, an eye at the distance `eye` from the plane toward . x = front sees a point at
 * the depth z below that plane nearer to the middle and smaller by eye/(eye + z), and z itself is
 * shrunk alike: so planes stay planes and lines lines, and what hides what is the same.
 */
#pragma once

#include "base/vec.h"

struct camera {
    vec3 right, up, toward; /* unit vectors; right x up = toward, which points to the viewer */
    double u, v;            /* m: the point of the plane in the picture's middle */
    double scale;           /* pixels a metre, with perspective in the plane `front` */
    double eye, front;      /* m; eye = INFINITY: without perspective */
    int width, height;      /* pixels */
};

/* m: [u0, u1] x [v0, v1] of the camera's plane; empty while u0 > u1 */
struct window {
    double u0, u1, v0, v1;
    double front; /* m: the greatest height in it */
};

enum { CAMERA_SIDE = 900 }; /* pixels of the longer side, by default */

/*
 * Turns the camera; azimuth and elevation in degrees. With `up` (a unit vector) along z, 0, 0 looks along y with z
 * upwards, and a positive azimuth moves it to the right about z; for another `up` all of that is turned as z is brought
 * to it the short way. In the plane (dim 2) it looks at x and y from the front, `up` upwards.
 */
void camera_turn(struct camera *c, int dim, vec3 up, double azimuth, double elevation);

/* (right . x, up . x, toward . x) */
static inline vec3 camera_sees(const struct camera *c, vec3 x)
{
    return v3(v3_dot(c->right, x), v3_dot(c->up, x), v3_dot(c->toward, x));
}

static const struct window window_empty = { INFINITY, -INFINITY, INFINITY, -INFINITY, -INFINITY };

/* Widens the window so that it shows a ball of radius r at x. */
void window_add(struct window *w, const struct camera *c, vec3 x, double r);

/* The same point with perspective, seen from the window's middle: how much smaller it is at this
   height (m), and where. 0 where it is not before the eye. */
static inline double camera_shrinks(const struct camera *c, double height)
{
    double depth = c->front - height;
    return isinf(c->eye) ? 1 : depth > -0.95 * c->eye ? c->eye / (c->eye + depth) : 0;
}

/* 1, 2 or 5 times a power of ten, not above x: the lengths that a picture shows */
double camera_round(double x);

/* The angle of sight (degrees; 0: none) over the longer side of what the camera shows */
void camera_perspective(struct camera *c, const struct window *w, double angle);

/* Shows the window in the middle of width x height pixels (0: chosen by its shape), as large as
   fits with a margin on each side, a share of the picture. */
void camera_fit(struct camera *c, const struct window *w, double margin, int width, int height);
