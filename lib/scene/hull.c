/* scene/hull.c: qhull asked, and a shape made of its answer [scene/hull.h]. */
#include "scene/hull.h"

#include "scene/hull_faces.h"
#include "scene/thin.h"

#include <libqhull_r/qhull_ra.h>
#include <stdlib.h>
#include <string.h>

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

static int hull_make_shape(struct shape *s, const struct hull *h, const struct loops *l, const vec3 *x,
                      struct failure *failure)
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
    if (!isfinite(size)) return failure_set(failure, EX_DATAERR, "the extent of its points is not finite");
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
