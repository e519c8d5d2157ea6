/* shape/wall_shape.c: the place of a wall's surface that is next to a point
   [shape/wall_shape.h]. */
#include "shape/wall_shape.h"

const char *const wall_shape_name[] = { "plane", "rectangle", "disc", "cylinder",
                                        "cone",  "sphere",    "mesh", NULL };
const char *const wall_side_name[] = { "inside", "outside", "both", NULL };

struct wall wall_plane(vec3 x, vec3 n, int32_t material)
{
    return (struct wall){ .x = x, .n = n, .material = material, .until = INFINITY };
}

static bool is_round(const struct wall *w)
{
    return w->shape == WALL_CYLINDER || w->shape == WALL_CONE;
}

static const char *size_trouble(const struct wall *w, int dim)
{
    const double *s = w->size;
    for (int k = 0; k < 3; k++)
        if (!(s[k] >= 0 && isfinite(s[k]))) return "a size is negative or not finite";
    switch (w->shape) {
    case WALL_RECTANGLE:
        return s[0] > 0 && (dim == 2 || s[1] > 0) ? NULL : "its sides must be positive";
    case WALL_DISC:
        return s[1] > s[0] ? NULL : "its radius must be above that of its hole";
    case WALL_CYLINDER:
    case WALL_SPHERE:
        return s[0] > 0 ? NULL : "its radius must be positive";
    case WALL_CONE:
        return s[2] > 0 && s[0] + s[1] > 0 ? NULL : "its length and a radius must be positive";
    case WALL_MESH:
        return w->elements > 0 ? NULL : "its mesh is empty";
    default:
        return NULL;
    }
}

const char *wall_shape_trouble(const struct wall *w, int dim)
{
    if (w->shape < 0 || w->shape >= WALL_SHAPES) return "no such shape";
    if (w->side < 0 || w->side >= WALL_SIDES) return "no such side";
    if (!v3_finite(w->x) || !v3_finite(w->v)) return "point or velocity is not finite";
    if (!(fabs(v3_dot(w->n, w->n) - 1) < 1e-6)) return "normal is not a unit vector";
    if (!(w->until > -INFINITY)) return "the time of its removal is not a number";
    bool flat = w->shape == WALL_PLANE || w->shape == WALL_RECTANGLE;
    if (dim == 2) {
        if (w->v.z != 0 || w->x.z != 0 || (flat && w->n.z != 0))
            return "leaves the plane, and dim is 2";
        if (w->shape == WALL_DISC || w->shape == WALL_CONE || w->shape == WALL_SPHERE)
            return "a shape of space, and dim is 2";
        if (w->shape == WALL_CYLINDER && (w->n.z != 1 || w->size[2] != 0))
            return "in the plane a cylinder is a circle around z";
    }
    if (!(w->weld >= 0 && isfinite(w->weld))) return "its weld tolerance is out of range";
    if (!(w->arc >= 0 && w->arc < 2 * M_PI)) return "its arc is out of range";
    bool directed = w->shape == WALL_RECTANGLE || (is_round(w) && w->arc > 0);
    if (directed &&
        !(fabs(v3_dot(w->along, w->along) - 1) < 1e-6 && fabs(v3_dot(w->along, w->n)) < 1e-6))
        return "its direction is not a unit vector across its normal";
    if (dim == 2 && directed && w->along.z != 0) return "leaves the plane, and dim is 2";
    return size_trouble(w, dim);
}

double wall_reach(const struct wall *w)
{
    const double *s = w->size;
    switch (w->shape) {
    case WALL_RECTANGLE:
        return 0.5 * sqrt(s[0] * s[0] + s[1] * s[1]);
    case WALL_DISC:
        return s[1];
    case WALL_CYLINDER:
        return s[2] > 0 ? sqrt(s[0] * s[0] + s[2] * s[2]) : INFINITY;
    case WALL_CONE:
        return fmax(s[0], sqrt(s[1] * s[1] + s[2] * s[2]));
    case WALL_SPHERE:
        return s[0];
    default:
        return INFINITY;
    }
}

/* ---- flat shapes ---- */

static double wall_shape_clamp(double x, double lo, double hi)
{
    return x < lo ? lo : x > hi ? hi : x;
}

/* From the nearest place to c; where c lies in the surface, along `otherwise` */
static struct touch touch_at(vec3 place, vec3 c, vec3 otherwise)
{
    vec3 d = v3_sub(c, place);
    double distance = v3_norm(d);
    if (!(distance > 0)) return (struct touch){ otherwise, 0, 0 };
    return (struct touch){ v3_scale(1 / distance, d), distance, 0 };
}

static struct touch near_rectangle(const struct wall *w, int dim, vec3 c)
{
    vec3 across = v3_cross(w->n, w->along);
    double a = v3_dot(c, w->along), b = v3_dot(c, across), h = v3_dot(c, w->n);
    double pa = wall_shape_clamp(a, -0.5 * w->size[0], 0.5 * w->size[0]);
    double pb = dim == 2 ? 0 : wall_shape_clamp(b, -0.5 * w->size[1], 0.5 * w->size[1]);
    if (pa == a && (dim == 2 || pb == b)) // the very normal, without a square root's rounding
        return (struct touch){ h < 0 ? v3_scale(-1, w->n) : w->n, fabs(h), 0 };
    return touch_at(v3_axpy(v3_scale(pa, w->along), pb, across), c, w->n);
}

/* c = z n + rho d: d of unit length, across n */
static vec3 radial(vec3 n, vec3 c, double *z, double *rho)
{
    *z = v3_dot(c, n);
    vec3 d = v3_axpy(c, -*z, n);
    *rho = v3_norm(d);
    return *rho > 0 ? v3_scale(1 / *rho, d) : v3_across(n);
}

static struct touch near_disc(const struct wall *w, vec3 c)
{
    double z, rho;
    vec3 d = radial(w->n, c, &z, &rho);
    if (rho >= w->size[0] && rho <= w->size[1])
        return (struct touch){ z < 0 ? v3_scale(-1, w->n) : w->n, fabs(z), 0 };
    return touch_at(v3_scale(wall_shape_clamp(rho, w->size[0], w->size[1]), d), c, w->n);
}

/* ---- round shapes ---- */

/* The generatrix of a cylinder or cone in the half plane of (rho, z) */
struct generatrix {
    double rho0, drho, dz; /* m: from (rho0, 0) to (rho0 + drho, dz); dz 0: endless along z */
};

static struct generatrix generatrix_of(const struct wall *w)
{
    double end = w->shape == WALL_CONE ? w->size[1] : w->size[0];
    return (struct generatrix){ w->size[0], end - w->size[0], w->size[2] };
}

/* Is a direction across the axis within the arc? Without an arc tangent, whose last bits differ
   between machines */
static bool in_arc(const struct wall *w, vec3 d)
{
    if (w->arc == 0) return true;
    quat q = quat_rotation(v3_scale(w->arc, w->n));
    vec3 end = quat_turn(q, w->along);
    bool after = v3_dot(v3_cross(w->along, d), w->n) >= 0;
    bool before = v3_dot(v3_cross(d, end), w->n) >= 0;
    return w->arc <= M_PI ? after && before : after || before;
}

/* The nearest place of the generatrix that lies at direction d, as a vector of space */
static vec3 near_generatrix(const struct wall *w, vec3 d, vec3 c, bool *inner)
{
    struct generatrix g = generatrix_of(w);
    double z = v3_dot(c, w->n), rho = v3_dot(c, d);
    if (g.dz == 0) {
        *inner = true;
        return v3_axpy(v3_scale(g.rho0, d), z, w->n);
    }
    double s = ((rho - g.rho0) * g.drho + z * g.dz) / (g.drho * g.drho + g.dz * g.dz);
    *inner = s >= 0 && s <= 1;
    s = wall_shape_clamp(s, 0, 1);
    return v3_axpy(v3_scale(g.rho0 + s * g.drho, d), s * g.dz, w->n);
}

/* c lies on the surface's side of its ends: signed by the side that is allowed */
static bool sided(const struct wall *w, vec3 outward, double out, double r, bool ends,
                  struct touch *t)
{
    bool inward = w->side == WALL_INSIDE || (w->side == WALL_BOTH && out < 0);
    *t = (struct touch){ inward ? v3_scale(-1, outward) : outward, inward ? -out : out, 0 };
    return !ends || w->side == WALL_BOTH || t->distance >= -r;
}

static bool near_round(const struct wall *w, vec3 c, double r, struct touch *t)
{
    double z, rho;
    bool inner;
    vec3 d = radial(w->n, c, &z, &rho);
    if (!in_arc(w, d)) { // the nearer of the two straight edges
        quat q = quat_rotation(v3_scale(w->arc, w->n));
        vec3 one = near_generatrix(w, w->along, c, &inner);
        vec3 other = near_generatrix(w, quat_turn(q, w->along), c, &inner);
        bool first = v3_norm(v3_sub(c, one)) <= v3_norm(v3_sub(c, other));
        *t = touch_at(first ? one : other, c, w->n);
        return true;
    }
    struct generatrix g = generatrix_of(w);
    vec3 place = near_generatrix(w, d, c, &inner);
    if (!inner) {
        *t = touch_at(place, c, d);
        return true;
    }
    double length = g.dz > 0 ? sqrt(g.drho * g.drho + g.dz * g.dz) : 1;
    double cosine = g.dz > 0 ? g.dz / length : 1, sine = g.dz > 0 ? g.drho / length : 0;
    vec3 outward = v3_axpy(v3_scale(cosine, d), -sine, w->n);
    double out = (rho - g.rho0) * cosine - (g.dz > 0 ? z * sine : 0);
    return sided(w, outward, out, r, g.dz > 0 || w->arc > 0, t);
}

bool wall_nearest(const struct wall *w, int dim, vec3 c, double r, struct touch *t)
{
    double distance;
    switch (w->shape) {
    case WALL_PLANE:
        *t = (struct touch){ w->n, v3_dot(c, w->n), 0 };
        return true;
    case WALL_RECTANGLE:
        *t = near_rectangle(w, dim, c);
        return true;
    case WALL_DISC:
        *t = near_disc(w, c);
        return true;
    case WALL_SPHERE:
        distance = v3_norm(c);
        return sided(w, distance > 0 ? v3_scale(1 / distance, c) : w->n, distance - w->size[0], r,
                     false, t);
    default:
        return near_round(w, c, r, t);
    }
}
