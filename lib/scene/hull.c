/* scene/hull.c: points thinned out, their hull by qhull, its triangles joined to faces, and the shape made of these [scene/hull.h]. */
#include "scene/hull.h"

#include "base/failure.h"
#include "base/vec.h"

#include <libqhull_r/qhull_ra.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/*
 * The triangles of a convex hull joined to faces [scene/hull.h]. Triangles next to each other
 * that are in one plane become one face. Then corners that only two faces have, and faces of two corners, are left
 * out until there are none: each step leaves a closed surface closed.
 */

/* A triangle of the hull; in the plane a segment, which has two points */
struct facet {
    int32_t point[3]; /* counterclockwise seen from outside */
    int32_t next[3];  /* the facet across from each of them */
    int32_t face;     /* that it belongs to; -1: to none yet */
    vec3 n;           /* outward */
    double area;      /* twice */
};

/* All of a hull */
struct facets {
    int32_t n;
    struct facet *of; /* [n] */
    int32_t points;
    const vec3 *x; /* [points] */
};

/* Loops of points: of face f corner[first[f]] .. corner[first[f + 1] - 1], from the least on */
struct loops {
    int32_t faces;
    int32_t *first, *corner;
};

/* The faces of a hull; in a plane: what is closer to it than `flat`. Returns 0, EX_DATAERR where
   no body is left, or EX_SOFTWARE; loops_free() in any case. */
static int hull_faces(struct loops *l, const struct facets *hull, double flat,
                      struct failure *failure);
/* The same in the plane: one loop, of segments. */
static int hull_loop(struct loops *l, const struct facets *hull, double flat,
                     struct failure *failure);
static void loops_free(struct loops *l);

/* ---- points sorted by the cells of a grid, and thinned out in that order ---- */

struct celled {
    int64_t cell[3];
    int32_t point;
};

static int by_cell(const void *one, const void *other)
{
    const struct celled *a = one, *b = other;
    for (int k = 0; k < 3; k++)
        if (a->cell[k] != b->cell[k]) return a->cell[k] < b->cell[k] ? -1 : 1;
    return (a->point > b->point) - (a->point < b->point);
}

/* The first of c[n], which are sorted, that is not before `wanted` */
static int64_t hull_find(const struct celled *c, int64_t n, const struct celled *wanted)
{
    int64_t lo = 0;
    for (int64_t hi = n; lo < hi;) {
        int64_t middle = lo + (hi - lo) / 2;
        if (by_cell(&c[middle], wanted) < 0)
            lo = middle + 1;
        else
            hi = middle;
    }
    return lo;
}

/* One of c[n], those that stay so far, within `apart` of a point; -1: none. A cell has eight of them at most. */
static int32_t find_near(const struct celled *c, int64_t n, struct celled at, const vec3 *x,
                         double apart)
{
    for (int row = 0; row < 9; row++) {
        const int64_t i = at.cell[0] + row / 3 - 1, j = at.cell[1] + row % 3 - 1, k = at.cell[2];
        const struct celled lo = { { i, j, k - 1 }, -1 }, hi = { { i, j, k + 2 }, -1 };
        for (int64_t m = hull_find(c, n, &lo); m < n && by_cell(&c[m], &hi) < 0; m++)
            if (v3_norm(v3_sub(x[c[m].point], x[at.point])) <= apart) return c[m].point;
    }
    return -1;
}

double thin_extent(const vec3 *x, int64_t n)
{
    double extent = 0;
    for (int64_t i = 0; i < n; i++) extent = fmax(extent, v3_norm(v3_sub(x[i], x[0])));
    return extent;
}

int thin_out(int32_t *to, const vec3 *x, int64_t n, double apart, struct failure *failure)
{
    struct celled *c = malloc(((size_t)n + 1) * sizeof *c);
    int64_t stay = 0;
    if (!c) return failure_set(failure, EX_SOFTWARE, "no memory for a hull");
    for (int32_t i = 0; i < n; i++) {
        vec3 d = v3_scale(1 / apart, v3_sub(x[i], x[0]));
        c[i] =
            (struct celled){ { (int64_t)floor(d.x), (int64_t)floor(d.y), (int64_t)floor(d.z) }, i };
    }
    qsort(c, (size_t)n, sizeof *c, by_cell);
    for (int64_t i = 0; i < n; i++) {
        int32_t point = c[i].point, near = find_near(c, stay, c[i], x, apart);
        to[point] = near < 0 ? point : near;
        if (near < 0) c[stay++] = c[i];
    }
    free(c);
    return 0;
}

/* ---- faces grown over triangles, and their loops of corners ---- */

static int hull_faces_no_memory(struct failure *failure)
{
    return failure_set(failure, EX_SOFTWARE, "no memory for a hull");
}

static int hull_faces_is_flat(struct failure *failure)
{
    return failure_set(failure, EX_DATAERR, "is flat to rounding");
}

static void loops_free(struct loops *l)
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
static void hull_grow(const struct facets *hull, int32_t seed, int32_t face, double flat,
                      int32_t *stack)
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
static int close_loops(struct loops *l, struct hull_side *side, int32_t sides,
                       struct failure *failure)
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

static int hull_faces(struct loops *l, const struct facets *hull, double flat,
                      struct failure *failure)
{
    const struct facet *facet = hull->of;
    const int32_t facets = hull->n;
    int32_t faces = hull_join(hull, flat), sides = 0;
    struct hull_side *side = malloc((3 * (size_t)facets + 1) * sizeof *side);
    int32_t *of = calloc((size_t)hull->points + 1, sizeof *of);
    if (faces < 0 || !side || !of || loops_alloc(l, faces, 3 * facets, failure))
        hull_faces_no_memory(failure);
    for (int32_t i = 0; i < facets && !failure->status; i++)
        for (int k = 0; k < 3; k++) {
            const struct facet *f = &facet[i];
            if (facet[f->next[k]].face == f->face) continue;
            side[sides++] =
                (struct hull_side){ f->face, f->point[(k + 1) % 3], f->point[(k + 2) % 3] };
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

static int hull_loop(struct loops *l, const struct facets *hull, double flat,
                     struct failure *failure)
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

/* A hull while it is made */
struct hull {
    int dim;
    int64_t n;
    int32_t *kept; /* [n] of all points those that are looked at, */
    vec3 *x;       /* [n] and where they are: from the first, in units of the extent */
    int32_t facets;
    struct facet *facet; /* [facets] of these points */
};

static int hull_no_memory(struct failure *failure)
{
    return failure_set(failure, EX_SOFTWARE, "no memory for a hull");
}

static int hull_is_flat(struct failure *failure)
{
    return failure_set(failure, EX_DATAERR, "is flat: its points have no volume");
}

/* ---- qhull ---- */

static void turn_over(struct facet *f)
{
    int32_t point = f->point[0], next = f->next[0];
    f->point[0] = f->point[1], f->point[1] = point;
    f->next[0] = f->next[1], f->next[1] = next;
}

/* Points and neighbours, each across from a point, are in an order of which qhull says whether it is that of all
   others, or the opposite one. */
static struct facet facet_of(qhT *qh, facetT *f, const int32_t *number)
{
    struct facet to = { .face = -1 };
    vertexT *vertex, **vertexp;
    facetT *neighbor, **neighborp;
    int k = 0, l = 0;
    // cppcheck-suppress legacyUninitvar ; the loops set them
    FOREACHvertex_(f->vertices) if (k < 3) to.point[k++] = qh_pointid(qh, vertex->point);
    // cppcheck-suppress uninitvar
    FOREACHneighbor_(f) if (l < 3) to.next[l++] = number[neighbor->id];
    if (f->toporient) turn_over(&to);
    return to;
}

static int take_facets(struct hull *h, qhT *qh, struct failure *failure)
{
    facetT *facet;
    int32_t *number = calloc((size_t)qh->facet_id + 1, sizeof *number), n = 0;
    h->facet = malloc(((size_t)qh->num_facets + 1) * sizeof *h->facet);
    if (!number || !h->facet) hull_no_memory(failure);
    // cppcheck-suppress uninitvar ; the loop sets it
    FORALLfacets if (!failure->status) number[facet->id] = n++;
    // cppcheck-suppress uninitvar
    FORALLfacets if (!failure->status) h->facet[h->facets++] = facet_of(qh, facet, number);
    free(number);
    return failure->status;
}

/* All are turned alike: outward, if their volume, in the plane their area, is positive. */
static void turn_outward(struct hull *h)
{
    double volume = 0;
    for (int32_t i = 0; i < h->facets; i++) {
        const int32_t *p = h->facet[i].point;
        vec3 area = v3_cross(h->x[p[0]], h->x[p[1]]);
        volume += h->dim == 2 ? area.z : v3_dot(area, h->x[p[2]]);
    }
    for (int32_t i = 0; i < h->facets && volume < 0; i++) turn_over(&h->facet[i]);
}

static int ask_qhull(struct hull *h, struct failure *failure)
{
    qhT state, *qh = &state;
    double *flat = malloc(((size_t)h->n * 3 + 1) * sizeof *flat);
    FILE *silent = fopen("/dev/null", "w");
    if (!flat || !silent) {
        free(flat);
        if (silent) fclose(silent);
        return hull_no_memory(failure);
    }
    for (int64_t i = 0; i < h->n; i++) {
        const double of[3] = { h->x[i].x, h->x[i].y, h->x[i].z };
        for (int k = 0; k < 3 && k < h->dim; k++) flat[h->dim * i + k] = of[k];
    }
    char command[] = "qhull QJ";
    qh_zero(qh, silent);
    if (qh_new_qhull(qh, h->dim, (int)h->n, flat, False, command, NULL, silent))
        hull_is_flat(failure);
    else if (!take_facets(h, qh, failure))
        turn_outward(h);
    int left, total;
    qh_freeqhull(qh, !qh_ALL);
    qh_memfreeshort(qh, &left, &total);
    free(flat);
    fclose(silent);
    return failure->status;
}

/* ---- the shape ---- */

/* Does face (first place, length) a come before b? By corners, the shorter first where all are the same */
static bool hull_comes_before(const struct shape *s, const int32_t a[2], const int32_t b[2])
{
    for (int32_t k = 0; k < a[1] && k < b[1]; k++) {
        int32_t x = s->corner[a[0] + k], y = s->corner[b[0] + k];
        if (x != y) return x < y;
    }
    return a[1] < b[1];
}

/* Faces in the order of their corners: qhull's is its own affair. */
static int sort_faces(struct shape *s, struct failure *failure)
{
    int32_t(*face)[2] = malloc(((size_t)s->faces + 1) * sizeof *face);
    int32_t *corner = malloc(((size_t)s->corners + 1) * sizeof *corner), n = 0;
    for (int32_t f = 0; f < s->faces && face && corner; f++) {
        const int32_t new[2] = { s->first[f], s->first[f + 1] - s->first[f] };
        int32_t k = f;
        for (; k > 0 && hull_comes_before(s, new, face[k - 1]); k--)
            memcpy(face[k], face[k - 1], sizeof *face);
        memcpy(face[k], new, sizeof new);
    }
    for (int32_t f = 0; f < s->faces && face && corner; f++) {
        s->first[f] = n;
        for (int32_t k = 0; k < face[f][1]; k++) corner[n++] = s->corner[face[f][0] + k];
    }
    if (face && corner)
        memcpy(s->corner, corner, (size_t)n * sizeof *corner);
    else
        hull_no_memory(failure);
    free(face), free(corner);
    return failure->status;
}

/* Points that are corners, numbered: number[i] from 0, -1 those that are none */
static int32_t count_corners(const struct loops *l, int64_t points, int32_t *number)
{
    int32_t n = 0;
    for (int64_t i = 0; i < points; i++) number[i] = -1;
    for (int32_t i = 0; i < l->first[l->faces]; i++) number[l->corner[i]] = 0;
    for (int64_t i = 0; i < points; i++)
        if (number[i] == 0) number[i] = n++;
    return n;
}

static int hull_make_shape(struct shape *s, const struct hull *h, const struct loops *l,
                           const vec3 *x, struct failure *failure)
{
    int32_t *number = malloc(((size_t)h->n + 1) * sizeof *number), corners = l->first[l->faces];
    int32_t n = number ? count_corners(l, h->n, number) : 0;
    if (!number) hull_no_memory(failure);
    if (n > SHAPE_VERTICES_MOST)
        failure_set(failure, EX_DATAERR,
                    "its hull has %d corners, and a shape has %d at most: leave out points "
                    "(decimate the mesh), or make a \"clump\" of it",
                    n, SHAPE_VERTICES_MOST);
    if (!failure->status && !shape_alloc(s, n, l->faces, corners, failure)) {
        for (int64_t i = 0; i < h->n; i++)
            if (number[i] >= 0) s->vertex[number[i]] = x[h->kept[i]];
        for (int32_t f = 0; f <= l->faces; f++) s->first[f] = l->first[f];
        for (int32_t i = 0; i < corners; i++) s->corner[i] = number[l->corner[i]];
        sort_faces(s, failure);
    }
    free(number);
    return failure->status;
}

/* Of the points those that are apart, from the first one, in units of the extent */
static int take_points(struct hull *h, int64_t n, const vec3 *x, struct failure *failure)
{
    double size = thin_extent(x, n);
    if (!(size > 0)) return hull_is_flat(failure);
    if (!isfinite(size))
        return failure_set(failure, EX_DATAERR, "the extent of its points is not finite");
    h->kept = malloc(((size_t)n + 1) * sizeof *h->kept);
    h->x = calloc((size_t)n + 1, sizeof *h->x);
    if (!h->kept || !h->x) return hull_no_memory(failure);
    if (thin_out(h->kept, x, n, HULL_APART * size, failure)) return failure->status;
    for (int32_t i = 0; i < n; i++)
        if (h->kept[i] == i) h->kept[h->n++] = i; // not behind what is read
    for (int64_t i = 0; i < h->n; i++) h->x[i] = v3_scale(1 / size, v3_sub(x[h->kept[i]], x[0]));
    return h->n > h->dim ? 0 : hull_is_flat(failure);
}

int hull_of_points(struct shape *s, int dim, int64_t n, const vec3 *x, struct failure *failure)
{
    struct hull h = { .dim = dim };
    struct loops l = { 0 };
    if (n <= dim) return hull_is_flat(failure);
    if (!take_points(&h, n, x, failure) && !ask_qhull(&h, failure)) {
        const struct facets all = { h.facets, h.facet, (int32_t)h.n, h.x };
        if (!(dim == 2 ? hull_loop : hull_faces)(&l, &all, HULL_FLAT, failure))
            hull_make_shape(s, &h, &l, x, failure);
    }
    loops_free(&l);
    free(h.kept), free(h.x), free(h.facet);
    return failure->status;
}
