/* scene/ears.c: ear clipping [scene/ears.h]. */
#include "scene/ears.h"

#include <stdbool.h>
#include <stddef.h>

static const double BENT_MOST = 1e-2; /* of the extent: how far corners lie off a plane */
static const double LINE = 1e-9;      /* of the extent: how far off a line rounding puts a corner */

enum { UNKNOWN, NO_EAR };

/* A polygon in its plane, counterclockwise, while corners are cut off */
struct ears_polygon {
    int32_t n;
    double extent;
    double u[POLYGON_CORNERS_MOST], v[POLYGON_CORNERS_MOST];
    int32_t next[POLYGON_CORNERS_MOST], last[POLYGON_CORNERS_MOST];
    int32_t blunts, blunt[POLYGON_CORNERS_MOST]; /* corners that do not turn left, or did not */
    int8_t known[POLYGON_CORNERS_MOST];
};

/* Twice the area of the triangle a b c */
static double twice_area(const struct ears_polygon *p, int32_t a, int32_t b, int32_t c)
{
    return (p->u[b] - p->u[a]) * (p->v[c] - p->v[a]) - (p->v[b] - p->v[a]) * (p->u[c] - p->u[a]);
}

/* How far c lies to the left of the line from a to b */
static double left_of(const struct ears_polygon *p, int32_t a, int32_t b, int32_t c)
{
    double x = p->u[b] - p->u[a], y = p->v[b] - p->v[a], length = sqrt(x * x + y * y);
    return length > 0 ? twice_area(p, a, b, c) / length : 0;
}

static bool ears_same_place(const struct ears_polygon *p, int32_t a, int32_t b)
{
    return p->u[a] == p->u[b] && p->v[a] == p->v[b];
}

/* How far the polygon bulges at i beyond the line between its neighbours; negative: at a concave corner */
static double bulge(const struct ears_polygon *p, int32_t i)
{
    return left_of(p, p->next[i], p->last[i], i);
}

/* Does the polygon turn left at i? Not where that is rounding. */
static bool turns_left(const struct ears_polygon *p, int32_t i)
{
    return bulge(p, i) > LINE * p->extent;
}

/* ---- into the plane ---- */

static vec3 newell_normal(const vec3 *x, int32_t n)
{
    vec3 sum = v3(0, 0, 0);
    for (int32_t i = 2; i < n; i++)
        sum = v3_add(sum, v3_cross(v3_sub(x[i - 1], x[0]), v3_sub(x[i], x[0])));
    return sum;
}

static bool on_a_line(const vec3 *x, int32_t n, double extent)
{
    vec3 far = v3(0, 0, 0);
    for (int32_t i = 1; i < n; i++)
        if (v3_norm(v3_sub(x[i], x[0])) > v3_norm(far)) far = v3_sub(x[i], x[0]);
    for (int32_t i = 1; i < n; i++)
        if (v3_norm(v3_cross(far, v3_sub(x[i], x[0]))) > LINE * extent * extent) return false;
    return true;
}

/* Leaves out the coordinate along which the normal is largest: the others keep their digits. */
static void lay_down(struct ears_polygon *p, const vec3 *x, vec3 normal)
{
    double a = fabs(normal.x), b = fabs(normal.y), c = fabs(normal.z);
    int axis = a >= b && a >= c ? 0 : b >= c ? 1 : 2;
    double along = axis == 0 ? normal.x : axis == 1 ? normal.y : normal.z;
    for (int32_t i = 0; i < p->n; i++) {
        vec3 d = v3_sub(x[i], x[0]);
        p->u[i] = axis == 0 ? d.y : axis == 1 ? d.z : d.x;
        p->v[i] = axis == 0 ? d.z : axis == 1 ? d.x : d.y;
        if (along < 0) p->u[i] = -p->u[i];
        p->next[i] = (i + 1) % p->n, p->last[i] = (i + p->n - 1) % p->n, p->known[i] = UNKNOWN;
    }
}

static bool is_bent(const vec3 *x, int32_t n, vec3 normal, double extent)
{
    double lo = 0, hi = 0, unit = 1 / v3_norm(normal);
    for (int32_t i = 1; i < n; i++) {
        double at = unit * v3_dot(normal, v3_sub(x[i], x[0]));
        lo = fmin(lo, at), hi = fmax(hi, at);
    }
    return hi - lo > BENT_MOST * extent;
}

/* ---- does it cross itself? ---- */

static bool ears_before(const struct ears_polygon *p, int32_t a, int32_t b)
{
    return p->u[a] != p->u[b] ? p->u[a] < p->u[b] : p->v[a] < p->v[b];
}

/* How often it comes to a place that lies farthest to the right: once, if it is convex and winds once */
static int32_t count_turns(const struct ears_polygon *p)
{
    int32_t turns = 0;
    for (int32_t i = 0; i < p->n; i++)
        turns += ears_before(p, p->last[i], i) && ears_before(p, p->next[i], i);
    return turns;
}

/* Are a and b on different sides of the line from c to d, and not as near as rounding puts them? */
static bool parted(const struct ears_polygon *p, int32_t a, int32_t b, int32_t c, int32_t d)
{
    double least = LINE * p->extent, x = left_of(p, c, d, a), y = left_of(p, c, d, b);
    return (x > least && y < -least) || (x < -least && y > least);
}

/* Do the sides from a and from b cross, each within the other? Touching is none. */
static bool sides_cross(const struct ears_polygon *p, int32_t a, int32_t b)
{
    int32_t c = p->next[a], d = p->next[b];
    return parted(p, b, d, a, c) && parted(p, a, c, b, d);
}

static bool crosses_itself(const struct ears_polygon *p)
{
    for (int32_t i = 0; i < p->n; i++)
        for (int32_t j = 0; j < i; j++)
            if (sides_cross(p, i, j)) return true;
    return false;
}

/* ---- ears ---- */

static bool is_in(const struct ears_polygon *p, int32_t a, int32_t b, int32_t c, int32_t i)
{
    double least = -LINE * p->extent;
    return left_of(p, a, b, i) > least && left_of(p, b, c, i) > least &&
           left_of(p, c, a, i) > least;
}

static bool is_ear(const struct ears_polygon *p, int32_t i)
{
    int32_t a = p->last[i], b = p->next[i];
    if (!turns_left(p, i)) return false;
    for (int32_t k = 0; k < p->blunts; k++) {
        int32_t j = p->blunt[k];
        if (ears_same_place(p, j, a) || ears_same_place(p, j, i) || ears_same_place(p, j, b))
            continue;
        if (is_in(p, a, i, b, j)) return false;
    }
    return true;
}

static void cut_off(struct ears_polygon *p, int32_t i)
{
    int32_t a = p->last[i], b = p->next[i];
    p->next[a] = b, p->last[b] = a;
    p->known[a] = p->known[b] = UNKNOWN;
    int32_t kept = 0; // what turns left now is in no ear's way
    for (int32_t k = 0; k < p->blunts; k++) {
        int32_t j = p->blunt[k];
        if (j != i && !((j == a || j == b) && turns_left(p, j))) p->blunt[kept++] = j;
    }
    p->blunts = kept;
}

static const char *ears_clip(struct ears_polygon *p, int32_t (*triangle)[3], int32_t *triangles)
{
    int32_t left = p->n, i = 1;
    for (int32_t tried = 0; left > 3; i = p->next[i]) {
        if (tried++ > left) return "a polygon that crosses itself";
        if (p->known[i] == NO_EAR) continue;
        p->known[i] = NO_EAR;
        if (!is_ear(p, i)) continue;
        int32_t *t = triangle[(*triangles)++];
        t[0] = p->last[i], t[1] = i, t[2] = p->next[i];
        cut_off(p, i);
        left--, tried = 0;
    }
    int32_t *t = triangle[(*triangles)++];
    t[0] = p->last[i], t[1] = i, t[2] = p->next[i];
    return NULL;
}

const char *ears_cut(const vec3 *x, int32_t n, int32_t (*triangle)[3], int32_t *triangles,
                     int64_t *work)
{
    struct ears_polygon p;
    *triangles = 0;
    if (n < 3) return NULL;
    if (n > POLYGON_CORNERS_MOST) return "a polygon of more than 4096 corners";
    vec3 normal = newell_normal(x, n);
    p.n = n, p.blunts = 0, p.extent = 0;
    for (int32_t i = 1; i < n; i++) p.extent = fmax(p.extent, v3_norm(v3_sub(x[i], x[0])));
    if (!(v3_norm(normal) > LINE * p.extent * p.extent))
        return on_a_line(x, n, p.extent) ? NULL : "a polygon that crosses itself";
    if (is_bent(x, n, normal, p.extent))
        return "a polygon that is not flat: cut it into triangles where it is made";
    lay_down(&p, x, normal);
    bool convex = count_turns(&p) == 1;
    for (int32_t i = 0; i < n; i++)
        if (!turns_left(&p, i)) {
            p.blunt[p.blunts++] = i;
            convex &= bulge(&p, i) > -LINE * p.extent;
        }
    if (!convex) {
        *work -= (int64_t)n * n;
        if (*work < 0)
            return "too many concave polygons: cut them into triangles where they are made";
        if (crosses_itself(&p)) return "a polygon that crosses itself";
    }
    return ears_clip(&p, triangle, triangles);
}
