/* draw/outline.c: surfaces as grids of points, and their borders [draw/outline.h]. */
#include "draw/outline.h"

#include "base/array.h"

#include <stdlib.h>

#define SHARP 0.94 /* the cosine of the least angle between triangles whose edge is drawn */

/* A wall where it is now */
struct outline_placed {
    const struct packing *p;
    const struct wall *w;
    int32_t wall;
    struct pose pose;
    double reach; /* m */
};

static bool add_triangle(struct outline *o, const struct outline_placed *b, int32_t face, vec3 x,
                         vec3 y, vec3 z)
{
    if (!array_grow(&o->triangle, &o->triangle_room, o->triangles + 1, sizeof *o->triangle))
        return false;
    o->triangle[o->triangles++] = (struct outline_triangle){ { x, y, z }, b->wall, face };
    return true;
}

static bool outline_add_line(struct outline *o, const struct outline_placed *b, vec3 x, vec3 y)
{
    if (!array_grow(&o->line, &o->line_room, o->lines + 1, sizeof *o->line)) return false;
    o->line[o->lines++] = (struct outline_line){ { x, y }, b->wall, 0 };
    return true;
}

/* ---- shapes that are grids ---- */

/* Across the axis, at a share u of the whole angle */
static vec3 outline_around(const struct wall *w, double u)
{
    bool given = v3_dot(w->along, w->along) > 0;
    vec3 along = given ? w->along : v3_across(w->n);
    double angle = (w->arc > 0 ? w->arc : 2 * M_PI) * u;
    return v3_add(v3_scale(cos(angle), along), v3_scale(sin(angle), v3_cross(w->n, along)));
}

/* The point (u, v) of the surface, both from 0 to 1: u around the axis, v along the generatrix */
static vec3 point_of(const struct outline_placed *b, double u, double v)
{
    const struct wall *w = b->w;
    const double *s = w->size;
    bool endless = w->shape == WALL_CYLINDER && s[2] == 0;
    vec3 x, d = outline_around(w, u);
    switch (w->shape) {
    case WALL_RECTANGLE:
        x = v3_axpy(v3_scale((u - 0.5) * s[0], w->along), (v - 0.5) * s[1],
                    v3_cross(w->n, w->along));
        break;
    case WALL_DISC:
        x = v3_scale(s[0] + v * (s[1] - s[0]), d);
        break;
    case WALL_SPHERE:
        x = v3_axpy(v3_scale(s[0] * sin(M_PI * v), d), -s[0] * cos(M_PI * v), w->n);
        break;
    default:
        x = v3_scale(w->shape == WALL_CONE ? s[0] + v * (s[1] - s[0]) : s[0], d);
        x = v3_axpy(x, endless ? (2 * v - 1) * b->reach : v * s[2], w->n);
    }
    return pose_of(&b->pose, v3_add(w->x, x));
}

/* A line in the parameters of a surface, which is a curve in space */
struct curve {
    double u0, v0, u1, v1; /* from (u0, v0) to (u1, v1) */
};

/* In n pieces */
static bool add_curve(struct outline *o, const struct outline_placed *b, struct curve c, int n)
{
    vec3 last = point_of(b, c.u0, c.v0);
    for (int i = 1; i <= n; i++) {
        double s = (double)i / n;
        vec3 next = point_of(b, c.u0 + s * (c.u1 - c.u0), c.v0 + s * (c.v1 - c.v0));
        if (!outline_add_line(o, b, last, next)) return false;
        last = next;
    }
    return true;
}

static bool add_grid(struct outline *o, const struct outline_placed *b, int nu, int nv)
{
    for (int i = 0; i < nu; i++)
        for (int j = 0; j < nv; j++) {
            double u[2] = { (double)i / nu, (double)(i + 1) / nu };
            double v[2] = { (double)j / nv, (double)(j + 1) / nv };
            vec3 x[4] = { point_of(b, u[0], v[0]), point_of(b, u[1], v[0]), point_of(b, u[1], v[1]),
                          point_of(b, u[0], v[1]) };
            if (!add_triangle(o, b, 0, x[0], x[1], x[2]) ||
                !add_triangle(o, b, 0, x[0], x[2], x[3]))
                return false;
        }
    return true;
}

static bool outline_add_shape(struct outline *o, const struct outline_placed *b)
{
    const struct wall *w = b->w;
    bool flat = b->p->dim == 2, rectangle = w->shape == WALL_RECTANGLE;
    bool sphere = w->shape == WALL_SPHERE;
    int n = rectangle ? 1 : OUTLINE_FACETS;
    if (flat) return add_curve(o, b, (struct curve){ 0, 0.5, 1, 0.5 }, n);
    if (!add_grid(o, b, n, sphere ? OUTLINE_FACETS / 2 : 1)) return false;
    for (int k = 0; k < 3; k++) { // borders, of a sphere three circles
        double v = sphere ? 0.25 * (k + 1) : k % 2;
        bool point = !sphere && w->shape != WALL_CYLINDER && w->size[v > 0] == 0;
        if (k == 2 && !sphere) break;
        if ((rectangle || !point) && !add_curve(o, b, (struct curve){ 0, v, 1, v }, n))
            return false;
    }
    // straight lines, which show that it turns
    int lines = rectangle || w->arc > 0 ? 2 : 8, pieces = sphere ? n / 2 : 1;
    for (int k = 0; k < lines && w->shape != WALL_DISC; k++) {
        double u = lines == 2 ? k : (double)k / lines;
        if (!add_curve(o, b, (struct curve){ u, 0, u, 1 }, pieces)) return false;
    }
    return true;
}

/* ---- meshes ---- */

/* An edge of a triangle, its lower vertex first */
struct outline_side {
    vec3 end[2], normal;
};

static int outline_compare(vec3 a, vec3 b)
{
    if (a.x != b.x) return a.x < b.x ? -1 : 1;
    if (a.y != b.y) return a.y < b.y ? -1 : 1;
    return a.z < b.z ? -1 : a.z > b.z;
}

static int by_ends(const void *a, const void *b)
{
    const struct outline_side *s = a, *t = b;
    int first = outline_compare(s->end[0], t->end[0]);
    return first ? first : outline_compare(s->end[1], t->end[1]);
}

/* Edges that are no other triangle's, or where two meet at an angle */
static bool add_sharp(struct outline *o, const struct outline_placed *b, struct outline_side *s,
                      size_t n)
{
    qsort(s, n, sizeof *s, by_ends);
    for (size_t i = 0, next; i < n; i = next) {
        for (next = i + 1; next < n && !by_ends(&s[i], &s[next]);) next++;
        bool smooth = next == i + 2 && fabs(v3_dot(s[i].normal, s[i + 1].normal)) > SHARP;
        if (!smooth && !outline_add_line(o, b, s[i].end[0], s[i].end[1])) return false;
    }
    return true;
}

static bool add_mesh(struct outline *o, const struct outline_placed *b)
{
    const struct mesh *m = &b->p->mesh;
    const struct wall *w = b->w;
    struct outline_side *side = malloc(3 * (size_t)w->elements * sizeof *side + 1);
    bool good = side, flat = b->p->dim == 2;
    size_t n = 0;
    for (int32_t e = w->first_element; good && e < w->first_element + w->elements; e++) {
        vec3 x[3];
        for (int k = 0; k < 3; k++)
            x[k] = pose_of(&b->pose, v3_add(w->x, m->vertex[m->element[e][k]]));
        if (flat) {
            good = outline_add_line(o, b, x[0], x[1]);
            if (good) o->line[o->lines - 1].face = e - w->first_element;
            continue;
        }
        vec3 normal = v3_cross(v3_sub(x[1], x[0]), v3_sub(x[2], x[0]));
        normal = v3_scale(1 / fmax(v3_norm(normal), 1e-300), normal);
        good = add_triangle(o, b, e - w->first_element, x[0], x[1], x[2]);
        for (int k = 0; k < 3; k++) {
            vec3 from = x[k], to = x[(k + 1) % 3];
            bool rises = outline_compare(from, to) < 0;
            side[n++] = (struct outline_side){ { rises ? from : to, rises ? to : from }, normal };
        }
    }
    good = good && add_sharp(o, b, side, n);
    free(side);
    return good;
}

int outline_init(struct outline *o, const struct packing *p, double reach, struct failure *failure)
{
    bool good = true;
    *o = (struct outline){ 0 };
    for (int32_t w = 0; good && w < p->walls; w++) {
        const struct wall *wall = &p->wall[w];
        if (wall->shape == WALL_PLANE || !wall_there(wall, p->t)) continue;
        const struct outline_placed b = { p, wall, w, wall_pose(p, wall, p->t), reach };
        good = wall->shape == WALL_MESH ? add_mesh(o, &b) : outline_add_shape(o, &b);
    }
    if (good) return 0;
    outline_free(o);
    return failure_set(failure, EX_SOFTWARE, "no memory for the outlines of the walls");
}

void outline_free(struct outline *o)
{
    free(o->triangle), free(o->line);
    *o = (struct outline){ 0 };
}
