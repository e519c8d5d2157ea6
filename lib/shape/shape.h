/*
 * shape/shape.h: the shapes that grains have, a table from which each grain takes a row.
 *
 * A shape is a ball (row 0 of every table), a clump of balls, a capsule, or a convex hull: in space a
 * polyhedron, in the plane a polygon. Capsules and hulls are rounded: all points within `round` of
 * their core. Everything is described in the principal axes about the centre of mass, in units of the
 * radius of the ball around it: a grain of `radius` r reaches r from its centre, whatever its shape,
 * and is the shape r times as large.
 */
#pragma once

#include "base/failure.h"
#include "base/vec.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/*
 * Convex cores: grains are made of them, as all points within `round` of a core. A ball
 * is a point, a clump several of them, a capsule a segment, a hull a polygon or a polyhedron.
 */

struct core {
    int32_t n;                /* vertices */
    const vec3 *v;            /* [n] m */
    const vec3 *normal;       /* unit normals of a hull's faces, in the plane of its sides */
    const struct shape *hull; /* its faces and edges; NULL: a point or a segment */
    double round;             /* m */
    vec3 centre;              /* m: a point inside */
};

/* m: the largest n . v over the core's vertices */
static inline double core_top(const struct core *c, vec3 n)
{
    double most = v3_dot(n, c->v[0]);
    for (int32_t i = 1; i < c->n; i++) {
        double at = v3_dot(n, c->v[i]);
        most = at > most ? at : most;
    }
    return most;
}
static inline double core_bottom(const struct core *c, vec3 n)
{
    double least = v3_dot(n, c->v[0]);
    for (int32_t i = 1; i < c->n; i++) {
        double at = v3_dot(n, c->v[i]);
        least = at < least ? at : least;
    }
    return least;
}

enum shape_form { SHAPE_BALL, SHAPE_CLUMP, SHAPE_CAPSULE, SHAPE_HULL, SHAPE_FORMS };

enum {
    SHAPE_VERTICES_MOST = 4096, /* of one shape, so that keys of contacts are 32 bits wide */
    SHAPES_MOST = 1 << 16       /* in a table */
};

struct shape_edge {
    int32_t tail, head;  /* vertices, counterclockwise around the face `left` */
    int32_t left, right; /* faces; in the plane both 0 */
};

struct shape {
    char *name;
    int32_t form;
    double round;     /* of capsules and hulls; 0: sharp */
    double volume;    /* of the shape with radius 1; in the plane its area */
    double moment[3]; /* principal moments of inertia of mass 1 and radius 1; in the plane [2] */

    int32_t vertices;
    vec3 *vertex; /* [vertices] of a clump the balls' centres; of a capsule the two ends */
    double *ball; /* [vertices] radii of a clump's balls; of other shapes `round` */

    /* Of a hull: its faces, corners counterclockwise seen from outside; in the plane one, from +z. */
    int32_t faces, corners;
    int32_t *first;  /* [faces + 1] face f has corner[first[f]] .. corner[first[f + 1] - 1] */
    int32_t *corner; /* [corners] vertices */

    /* What follows from these, by shape_finish() */
    vec3 *normal; /* [faces] outward unit normals; in the plane [vertices], of the sides */
    int32_t edges;
    struct shape_edge *edge; /* [edges] in the plane edge k begins at the k-th corner */
};

/* A convex part of a shape: all within `round` of the vertices first .. first+n-1, and between them */
struct shape_part {
    int32_t first, n;
    double round;
};
/* Is it a union of parts, each of which may be a point? Other shapes are one part. */
static inline bool shape_is_union(const struct shape *s)
{
    return s->form == SHAPE_CLUMP;
}
static inline bool shape_has_faces(const struct shape *s)
{
    return s->form == SHAPE_HULL;
}
static inline int32_t shape_parts(const struct shape *s)
{
    return shape_is_union(s) ? s->vertices : 1;
}
static inline struct shape_part shape_part(const struct shape *s, int32_t k)
{
    if (shape_is_union(s)) return (struct shape_part){ k, 1, s->ball[k] };
    return (struct shape_part){ 0, s->vertices, s->round };
}
/* The distance from vertex k to the surface around it; before shape_finish(), too */
static inline double shape_round(const struct shape *s, int32_t k)
{
    return shape_is_union(s) ? s->ball[k] : s->round;
}
/* Part k of a body at x (m) of this radius (m), whose vertices are at v (m), and whose faces have these normals */
static inline struct core shape_core(const struct shape *s, double radius, vec3 x, const vec3 *v,
                                     const vec3 *normal, int32_t k)
{
    if (shape_is_union(s)) {
        const struct shape_part part = shape_part(s, k);
        v += part.first;
        return (struct core){ .n = part.n, .v = v, .round = radius * part.round, .centre = *v };
    }
    return (struct core){ .n = s->vertices,
                          .v = v,
                          .normal = normal,
                          .hull = shape_has_faces(s) ? s : NULL,
                          .round = radius * s->round,
                          .centre = x };
}

struct shapes {
    int32_t n;       /* 0: all grains are balls */
    int32_t room;    /* rows that the arrays below have memory for */
    struct shape *s; /* [n] s[0] is the ball */
    int32_t *sorted; /* [n] rows by their names */
};

void shapes_free(struct shapes *t);
/* to = a deep copy of from; to need not be initialised. Returns 0 or EX_SOFTWARE. */
int shapes_copy(struct shapes *to, const struct shapes *from, struct failure *failure);
/* A new last row, which takes what *s owns, also where it fails; before the first one comes the ball.
   Returns 0, EX_DATAERR where there are too many, or EX_SOFTWARE. */
int shapes_add(struct shapes *t, int dim, struct shape *s, struct failure *failure);
/* The row with this name; -1: none */
int32_t shapes_find(const struct shapes *t, const char *name);
/* Is it the same shape, whatever its name? */
bool shape_same(const struct shape *a, const struct shape *b);

/* Arrays for so many vertices, faces and corners, all zero. Returns 0, or EX_SOFTWARE with nothing to
   free. */
int shape_alloc(struct shape *s, int32_t vertices, int32_t faces, int32_t corners,
                struct failure *failure);
void shape_free(struct shape *s);
/*
 * Checks that a shape is one, and makes normals and edges: numbers finite and in range, faces flat and
 * closed, all vertices behind every face, all within the ball of radius 1. Returns 0, EX_DATAERR with
 * what is wrong, or EX_SOFTWARE.
 */
int shape_finish(struct shape *s, int dim, struct failure *failure);
