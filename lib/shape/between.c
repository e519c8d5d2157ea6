#include "shape/between.h"

#include "shape/surface_tree.h"

/* Twice the area of the triangle a, b, c of the plane; above 0: counterclockwise */
static double wall_edge_turn(vec3 a, vec3 b, vec3 c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/* Six times the volume of the tetrahedron */
static double wall_edge_volume(vec3 a, vec3 b, vec3 c, vec3 d)
{
    return v3_dot(v3_sub(b, a), v3_cross(v3_sub(c, a), v3_sub(d, a)));
}

static bool opposite(double x, double y)
{
    return (x <= 0 && y >= 0) || (x >= 0 && y <= 0);
}

static bool crosses_segment(const vec3 x[2], vec3 a, vec3 b)
{
    return opposite(wall_edge_turn(x[0], x[1], a), wall_edge_turn(x[0], x[1], b)) &&
           opposite(wall_edge_turn(a, b, x[0]), wall_edge_turn(a, b, x[1]));
}

static bool crosses_triangle(const vec3 x[3], vec3 a, vec3 b)
{
    if (!opposite(wall_edge_volume(x[0], x[1], x[2], a), wall_edge_volume(x[0], x[1], x[2], b))) return false;
    double u = wall_edge_volume(a, b, x[0], x[1]), v = wall_edge_volume(a, b, x[1], x[2]), w = wall_edge_volume(a, b, x[2], x[0]);
    return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}

static bool in_surface(const struct surface *s, int dim, vec3 a, vec3 b)
{
    struct surface_walk walk;
    struct surface_branch leaf;
    vec3 middle = v3_scale(0.5, v3_add(a, b));
    double reach = 0.5 * v3_norm(v3_sub(b, a));
    surface_walk_begin(&walk, s->n);
    while (surface_walk_next(&walk, s->box, middle, reach, &leaf))
        for (int32_t i = leaf.lo; i < leaf.hi; i++) {
            const vec3 *x = s->at[s->order[i]];
            if (dim == 2 ? crosses_segment(x, a, b) : crosses_triangle(x, a, b)) return true;
        }
    return false;
}

bool boundary_between(const struct wall *w, int dim, const struct surface *surface, vec3 a, vec3 b)
{
    if (surface) return in_surface(surface, dim, a, b);
    bool rectangle = w->shape == BOUNDARY_RECTANGLE;
    if (!rectangle && w->shape != BOUNDARY_DISC) return true;
    double ha = v3_dot(a, w->n), hb = v3_dot(b, w->n);
    if (!opposite(ha, hb)) return false;
    vec3 x = ha != hb ? v3_axpy(a, ha / (ha - hb), v3_sub(b, a)) : b;
    double along = fabs(v3_dot(x, w->along)),
           across = dim == 2 ? 0 : fabs(v3_dot(x, v3_cross(w->n, w->along))), rho = v3_norm(x);
    return rectangle ? along <= w->size[0] / 2 && (dim == 2 || across <= w->size[1] / 2)
                     : rho >= w->size[0] && rho <= w->size[1];
}
