/*
 * shape/mesh.h: surfaces of triangles, in the plane chains of segments, and where they are next to
 * a point.
 *
 * A ball, or a corner of another body, touches a surface where its distance has a local minimum: in a triangle, on an edge or at
 * a corner. An edge counts when no triangle that meets there comes nearer elsewhere, a corner
 * likewise; so a flat wall of many triangles is met once, and a ball in a groove twice. Both
 * sides of the surface are met.
 *
 * Corners that lie within the weld tolerance of each other are one, and triangles that are thinner than
 * that are none: an STL file has each corner once a triangle, in single precision. At a distance below the
 * tolerance the way from the surface to a point is rounding, and the normal is that of the triangle.
 */
#pragma once

#include "base/failure.h"
#include "base/vec.h"
#include "shape/wall_shape.h"

#include <stdbool.h>
#include <stdint.h>

/* The tree of boxes over the elements of a surface [shape/mesh.h], and a walk
   to those near a place. */

enum {
    SURFACE_LEAF = 4, /* elements that are looked at one by one */
    SURFACE_FEATURES =
        7 /* of a triangle: edges 0 to 2 (from corner k), corners 3 to 5, its inside */
};

/* Of order[lo .. hi-1]; its halves are in the boxes that follow, the second from `next` on. */
struct surface_box {
    vec3 lo, hi;  /* m */
    int32_t next; /* the index of the second half's box */
};

/* A box of the tree, over order[lo .. hi-1] */
struct surface_branch {
    int32_t box, lo, hi;
};

struct surface_walk {
    struct surface_branch stack[64];
    int depth;
};

static inline double surface_beyond(double x, double lo, double hi)
{
    return x < lo ? lo - x : x > hi ? x - hi : 0;
}

static inline bool surface_is_near(const struct surface_box *b, vec3 c, double most)
{
    double x = surface_beyond(c.x, b->lo.x, b->hi.x), y = surface_beyond(c.y, b->lo.y, b->hi.y);
    double z = surface_beyond(c.z, b->lo.z, b->hi.z);
    return x * x + y * y + z * z <= most * most * (1 + 1e-12);
}

/* Of n elements; what is above the stack's depth is not set. */
static inline void surface_walk_begin(struct surface_walk *w, int32_t n)
{
    w->stack[0] = (struct surface_branch){ 0, 0, n }, w->depth = 1;
}

/* The next few elements, order[leaf->lo .. leaf->hi - 1], of which some are at most `most` (m) from c;
   false: no more. */
static inline bool surface_walk_next(struct surface_walk *w, const struct surface_box *box, vec3 c,
                                     double most, struct surface_branch *leaf)
{
    while (w->depth) {
        const struct surface_branch b = w->stack[--w->depth];
        if (!surface_is_near(&box[b.box], c, most)) continue;
        *leaf = b;
        if (b.hi - b.lo <= SURFACE_LEAF) return true;
        int32_t middle = b.lo + (b.hi - b.lo) / 2;
        w->stack[w->depth++] = (struct surface_branch){ box[b.box].next, middle, b.hi };
        w->stack[w->depth++] = (struct surface_branch){ b.box + 1, b.lo, middle };
    }
    return false;
}

struct mesh {
    int32_t vertices, elements;
    vec3 *vertex;          /* [vertices] m, from the point of reference of their wall */
    int32_t (*element)[3]; /* [elements] vertices; in the plane the third is that of the second */
};

/* Room for so many, all zero, in place of the old ones. Returns 0 or EX_SOFTWARE. */
int mesh_alloc(struct mesh *m, int32_t vertices, int32_t elements, struct failure *failure);
void mesh_free(struct mesh *m);
/* Room for more at its end, where the caller fills it in; vertices are counted from the mesh's first.
   Returns 0 or EX_SOFTWARE. */
int mesh_grow(struct mesh *m, int32_t vertices, int32_t elements, vec3 **vertex,
              int32_t (**element)[3], struct failure *failure);
int mesh_copy(struct mesh *to, const struct mesh *from, struct failure *failure);
/* Are vertices finite, and elements of vertices that are there, with an extent? Returns 0, or EX_DATAERR
   with the first that is not. */
int mesh_check(const struct mesh *m, int dim, struct failure *failure);

/* The elements of one wall that have an extent, ordered so that those near a place are found at once */
struct surface {
    int32_t n;        /* elements with an extent; */
    int32_t elements; /* all */
    double weld;      /* m: corners nearer than this are one */
    vec3 (*at)[3];    /* [elements] m: their vertices; of a segment the third is the second */
    int32_t *order;   /* [n] elements, as the tree has them */
    struct surface_box *box; /* of a tree over order[] */
    int32_t *corner;         /* [3 elements] numbers of corners, of those at one place the first */
    int32_t *star, *member;  /* of corner v: elements member[star[v]] .. member[star[v+1]-1] */
    _Atomic int64_t *seen;   /* borrowed: counts elements that surface_touches looks at; or NULL */
    int64_t seen_most;       /* beyond it there are no touches */
};

/* m: the box around the elements of a mesh of triangles; without any, from infinity to minus infinity */
void mesh_box(const struct mesh *m, vec3 *lo, vec3 *hi);

/* weld: m; 0: WELD_USUAL. Returns 0, EX_SOFTWARE, or EX_DATAERR: too many elements at a corner;
   surface_free() in any case. */
int surface_init(struct surface *s, const struct mesh *m, int32_t first, int32_t n, double weld,
                 struct failure *failure);
void surface_free(struct surface *s);

/* The tolerance relative to the diagonal of the box around a surface: ten roundings of single precision */
#define WELD_USUAL 1e-6

enum {
    STAR_MOST = 4096, /* elements that meet at a corner: to look at all pairs has to end */
    TOUCHES_MOST = 64 /* of a ball and a surface: beyond it the last ones are left out */
};
/* The places at most `most` (m) from c (m, from the wall's point of reference) at which the distance has
   a minimum, sorted by feature; returns how many. t.n points from the place to c. Triangles that lie on each
   other have one. */
int surface_touches(const struct surface *s, vec3 c, double most, struct touch touch[TOUCHES_MOST]);

/* Does the surface lie at c, to `near` (m)? n: across this unit vector; NULL: in any direction */
bool surface_is_at(const struct surface *s, vec3 c, const vec3 *n, double near);
/* Of an element: its unit normal, in the plane across the segment; its place next to c */
vec3 surface_normal(const struct surface *s, int32_t e);
vec3 surface_nearest(const struct surface *s, int32_t e, vec3 c);
