/* scene/hull_faces.c: faces grown over triangles, and their loops of corners [scene/hull_faces.h]. */
#include "scene/hull_faces.h"

#include <stdbool.h>
#include <stdlib.h>

static int hull_faces_no_memory(struct failure *failure)
{
    return failure_set(failure, EX_SOFTWARE, "no memory for a hull");
}

static int hull_faces_is_flat(struct failure *failure)
{
    return failure_set(failure, EX_DATAERR, "is flat to rounding");
}

void loops_free(struct loops *l)
{
    free(l->first), free(l->corner);
    *l = (struct loops){ 0 };
}

static int loops_alloc(struct loops *l, int32_t faces, int32_t corners, struct failure *failure)
{
    l->first = calloc((size_t)faces + 1, sizeof *l->first);
    l->corner = calloc((size_t)corners + 1, sizeof *l->corner);
    return l->first && l->corner ? 0 : hull_faces_no_memory(failure);
}

/* ---- faces grow ---- */

static bool in_plane(const struct facet *f, vec3 n, double at, const vec3 *x, double flat)
{
    bool in = true;
    for (int k = 0; k < 3; k++) in &= fabs(v3_dot(n, x[f->point[k]]) - at) < flat;
    return in;
}

/* Gives a facet, and all that are joined to it in its plane, to one face; stack: room for all facets */
static void hull_grow(const struct facets *hull, int32_t seed, int32_t face, double flat, int32_t *stack)
{
    struct facet *facet = hull->of;
    const vec3 *x = hull->x;
    int32_t n = 0;
    const vec3 normal = facet[seed].n;
    const double at = v3_dot(normal, x[facet[seed].point[0]]);
    facet[seed].face = face, stack[n++] = seed;
    while (n) {
        int32_t f = stack[--n];
        for (int k = 0; k < 3; k++) {
            int32_t next = facet[f].next[k];
            struct facet *g = &facet[next];
            if (g->face >= 0 || !in_plane(g, normal, at, x, flat)) continue;
            g->face = face, stack[n++] = next;
        }
    }
}

struct by_size {
    double area;
    int32_t facet;
};

static int compare_sizes(const void *one, const void *other)
{
    const struct by_size *a = one, *b = other;
    if (a->area != b->area) return a->area > b->area ? -1 : 1;
    return (a->facet > b->facet) - (a->facet < b->facet);
}

/* The largest facets know their planes best. Returns how many faces there are; -1: no memory. */
static int32_t hull_join(const struct facets *hull, double flat)
{
    struct facet *facet = hull->of;
    const int32_t facets = hull->n;
    const vec3 *x = hull->x;
    int32_t *stack = malloc(((size_t)facets + 1) * sizeof *stack), faces = 0;
    struct by_size *order = malloc(((size_t)facets + 1) * sizeof *order);
    for (int32_t i = 0; i < facets && stack && order; i++) {
        struct facet *f = &facet[i];
        vec3 a = x[f->point[0]], b = x[f->point[1]], c = x[f->point[2]];
        f->n = v3_cross(v3_sub(b, a), v3_sub(c, a)), f->area = v3_norm(f->n), f->face = -1;
        if (f->area > 0) f->n = v3_scale(1 / f->area, f->n);
        order[i] = (struct by_size){ f->area, i };
    }
    if (stack && order) qsort(order, (size_t)facets, sizeof *order, compare_sizes);
    for (int32_t i = 0; i < facets && stack && order; i++)
        if (facet[order[i].facet].face < 0) hull_grow(hull, order[i].facet, faces++, flat, stack);
    bool done = stack && order;
    free(stack), free(order);
    return done ? faces : -1;
}

/* ---- their loops ---- */

/* A side of a face, with what is inside on its left */
struct hull_side {
    int32_t face, tail, head;
};

static int by_tail(const void *one, const void *other)
{
    const struct hull_side *a = one, *b = other;
    if (a->face != b->face) return a->face < b->face ? -1 : 1;
    return (a->tail > b->tail) - (a->tail < b->tail);
}

/* Goes around each face, from its least corner. */
static int close_loops(struct loops *l, struct hull_side *side, int32_t sides, struct failure *failure)
{
    int32_t n = 0;
    qsort(side, (size_t)sides, sizeof *side, by_tail);
    for (int32_t start = 0, end; start < sides; start = end, l->first[++l->faces] = n) {
        const struct hull_side *at = &side[start];
        for (end = start; end < sides && side[end].face == side[start].face;) end++;
        for (int32_t k = start; k < end; k++) {
            l->corner[n++] = at->tail;
            const struct hull_side next = { at->face, at->head, 0 };
            at = bsearch(&next, side + start, (size_t)(end - start), sizeof *side, by_tail);
            if (!at || (at == &side[start]) != (k == end - 1)) return hull_faces_is_flat(failure);
        }
    }
    return 0;
}

/* Leaves out corners of fewer than three faces, and faces of fewer than three corners. Returns whether there were
   any; of: room for all points */
static bool thin_loops(struct loops *l, int32_t *of, int32_t points)
{
    int32_t faces = 0, n = 0, first = 0, all = l->first[l->faces];
    for (int32_t i = 0; i < points; i++) of[i] = 0;
    for (int32_t i = 0; i < all; i++) of[l->corner[i]]++;
    for (int32_t f = 0; f < l->faces; f++) {
        int32_t from = n, end = l->first[f + 1];
        for (int32_t i = first; i < end; i++)
            if (of[l->corner[i]] >= 3) l->corner[n++] = l->corner[i];
        if (n - from < 3)
            n = from;
        else
            l->first[++faces] = n;
        first = end;
    }
    l->faces = faces;
    return n < all;
}

int hull_faces(struct loops *l, const struct facets *hull, double flat, struct failure *failure)
{
    const struct facet *facet = hull->of;
    const int32_t facets = hull->n;
    int32_t faces = hull_join(hull, flat), sides = 0;
    struct hull_side *side = malloc((3 * (size_t)facets + 1) * sizeof *side);
    int32_t *of = calloc((size_t)hull->points + 1, sizeof *of);
    if (faces < 0 || !side || !of || loops_alloc(l, faces, 3 * facets, failure)) hull_faces_no_memory(failure);
    for (int32_t i = 0; i < facets && !failure->status; i++)
        for (int k = 0; k < 3; k++) {
            const struct facet *f = &facet[i];
            if (facet[f->next[k]].face == f->face) continue;
            side[sides++] = (struct hull_side){ f->face, f->point[(k + 1) % 3], f->point[(k + 2) % 3] };
        }
    if (!failure->status && !close_loops(l, side, sides, failure)) {
        while (thin_loops(l, of, hull->points)) {
        }
        if (l->faces < 4) hull_faces_is_flat(failure);
    }
    free(side), free(of);
    return failure->status;
}

/* ---- in the plane ---- */

/* How far b lies from the line through a and c */
static double off_line(vec3 a, vec3 b, vec3 c)
{
    vec3 d = v3_sub(c, a), e = v3_sub(b, a);
    return fabs(d.x * e.y - d.y * e.x) / v3_norm(d);
}

int hull_loop(struct loops *l, const struct facets *hull, double flat, struct failure *failure)
{
    const struct facet *facet = hull->of;
    const int32_t facets = hull->n;
    const vec3 *x = hull->x;
    struct hull_side *side = malloc(((size_t)facets + 1) * sizeof *side);
    if (!side || loops_alloc(l, facets, facets, failure)) hull_faces_no_memory(failure);
    for (int32_t i = 0; i < facets && !failure->status; i++)
        side[i] = (struct hull_side){ 0, facet[i].point[0], facet[i].point[1] };
    if (!failure->status && !close_loops(l, side, facets, failure)) {
        int32_t m = l->first[1], kept = 0;
        for (int32_t k = 0; k < m; k++) { // corners from the last one that is kept to the next one
            vec3 a = x[kept ? l->corner[kept - 1] : l->corner[m - 1]], b = x[l->corner[k]];
            if (off_line(a, b, x[k + 1 < m ? l->corner[k + 1] : l->corner[0]]) >= flat)
                l->corner[kept++] = l->corner[k];
        }
        l->first[1] = kept;
        if (kept < 3) hull_faces_is_flat(failure);
    }
    free(side);
    return failure->status;
}
