/* draw/camera.c: the camera turned, and fitted to a window. */
#include "draw/camera.h"

/* The rotation that brings z to a unit vector the short way */
static quat tilt_to(vec3 up)
{
    vec3 axis = v3(-up.y, up.x, 0); // z x up
    double across = v3_norm(axis), angle = atan2(across, up.z);
    return quat_rotation(across > 0 ? v3_scale(angle / across, axis) : v3(angle, 0, 0));
}

void camera_turn(struct camera *c, int dim, vec3 up, double azimuth, double elevation)
{
    if (dim == 2) {
        c->right = v3(up.y, -up.x, 0), c->up = up, c->toward = v3(0, 0, 1);
        return;
    }
    double a = azimuth * M_PI / 180, e = elevation * M_PI / 180;
    c->right = v3(cos(a), sin(a), 0);
    c->toward = v3(sin(a) * cos(e), -cos(a) * cos(e), sin(e));
    c->up = v3_cross(c->toward, c->right);
    if (up.z == 1) return;
    const quat q = tilt_to(up);
    c->right = quat_turn(q, c->right), c->up = quat_turn(q, c->up);
    c->toward = quat_turn(q, c->toward);
}

void window_add(struct window *w, const struct camera *c, vec3 x, double r)
{
    vec3 s = camera_sees(c, x);
    w->u0 = fmin(w->u0, s.x - r), w->u1 = fmax(w->u1, s.x + r);
    w->v0 = fmin(w->v0, s.y - r), w->v1 = fmax(w->v1, s.y + r);
    w->front = fmax(w->front, s.z + r);
}

double camera_round(double x)
{
    double power = pow(10, floor(log10(x))), m = x / power;
    return power * (m < 2 ? 1 : m < 5 ? 2 : 5);
}

void camera_perspective(struct camera *c, const struct window *w, double angle)
{
    c->eye = INFINITY, c->front = w->front;
    if (!(angle > 0) || !isfinite(w->front)) return;
    double longer = fmax(w->u1 - w->u0, w->v1 - w->v0);
    c->eye = 0.5 * longer / tan(0.5 * angle * M_PI / 180);
}

/* The nearest even number: encoders of films want even sides. */
static int round_even(double x)
{
    return 2 * (int)floor(0.5 * x + 0.5);
}

void camera_fit(struct camera *c, const struct window *w, double margin, int width, int height)
{
    // at least 1e-150 m, so that a window without a size is shown and squares do not vanish
    double du = fmax(w->u1 - w->u0, 1e-150), dv = fmax(w->v1 - w->v0, 1e-150);
    if (!width || !height) {
        double shape = fmin(fmax(du / dv, 1.0 / 3), 3);
        width = shape > 1 ? CAMERA_SIDE : round_even(CAMERA_SIDE * shape);
        height = shape > 1 ? round_even(CAMERA_SIDE / shape) : CAMERA_SIDE;
    }
    c->width = width, c->height = height;
    c->u = 0.5 * w->u0 + 0.5 * w->u1, c->v = 0.5 * w->v0 + 0.5 * w->v1;
    c->scale = (1 - 2 * margin) * fmin(width / du, height / dv);
}
