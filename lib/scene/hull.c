/* scene/hull.c: qhull asked, and its triangles joined to faces [scene/hull.h]. */
#include "scene/hull.h"

#include <libqhull_r/qhull_ra.h>
#include <stdlib.h>
#include <string.h>

/* A triangle of the hull */
struct facet {
    int32_t point[3];
    vec3 n; /* outward, and where its plane is along it */
    double at, area;
};

/* What qhull says of the hull: its triangles (none in the plane), and which points are corners */
struct answer {
    int64_t facets;
    struct facet *facet;
    bool *corner; /* [points] */
};

static int no_memory(struct why *why)
{
    return why_set(why, EX_SOFTWARE, "no memory for a hull");
}

static struct facet facet_of(qhT *qh, facetT *f, const vec3 *x)
{
    struct facet to = { .n = v3(f->normal[0], f->normal[1], f->normal[2]), .at = -f->offset };
    vertexT *vertex, **vertexp;
    int k = 0;
    // cppcheck-suppress legacyUninitvar ; the loop sets it
    FOREACHvertex_(f->vertices) if (k < 3) to.point[k++] = qh_pointid(qh, vertex->point);
    vec3 a = x[to.point[0]];
    to.area = v3_norm(v3_cross(v3_sub(x[to.point[1]], a), v3_sub(x[to.point[2]], a)));
    return to;
}

static int ask_qhull(struct answer *a, int dim, int64_t n, const vec3 *x, struct why *why)
{
    qhT state, *qh = &state;
    double *flat = malloc((size_t)n * 3 * sizeof *flat);
    FILE *silent = fopen("/dev/null", "w");
    if (!flat || !silent) {
        free(flat);
        if (silent) fclose(silent);
        return no_memory(why);
    }
    for (int64_t i = 0; i < n; i++) {
        const double of[3] = { x[i].x, x[i].y, x[i].z };
        for (int k = 0; k < dim; k++) flat[dim * i + k] = of[k];
    }
    char command[] = "qhull Qt";
    qh_zero(qh, silent);
    bool flat_points = qh_new_qhull(qh, dim, (int)n, flat, False, command, NULL, silent) != 0;
    if (!flat_points) {
        facetT *facet;
        vertexT *vertex;
        a->facet = malloc(((size_t)qh->num_facets + 1) * sizeof *a->facet);
        a->corner = calloc((size_t)n, sizeof *a->corner);
        if (!a->facet || !a->corner) no_memory(why);
        // cppcheck-suppress uninitvar ; the loop sets it
        FORALLfacets if (a->facet && dim == 3) a->facet[a->facets++] = facet_of(qh, facet, x);
        // cppcheck-suppress legacyUninitvar ; so does this
        FORALLvertices if (a->corner) a->corner[qh_pointid(qh, vertex->point)] = true;
    }
    int left, total;
    qh_freeqhull(qh, !qh_ALL);
    qh_memfreeshort(qh, &left, &total);
    free(flat);
    fclose(silent);
    if (flat_points) why_set(why, EX_DATAERR, "is flat: its points have no volume");
    return why->status;
}

/* Corners of a plane, while they are sorted around its normal */
struct around {
    double angle;
    int32_t vertex;
};

static int by_angle(const void *one, const void *other)
{
    const struct around *a = one, *b = other;
    return (a->angle > b->angle) - (a->angle < b->angle);
}

/* The vertices within `flat` of the plane n . x = at, counterclockwise from the first; returns how many. */
static int32_t gather_face(const struct shape *s, vec3 normal, double at, double flat,
                           struct around *a)
{
    int32_t n = 0;
    vec3 middle = v3(0, 0, 0), e = v3_across(normal), f = v3_cross(normal, e);
    for (int32_t i = 0; i < s->vertices; i++)
        if (fabs(v3_dot(normal, s->vertex[i]) - at) < flat) {
            a[n++].vertex = i;
            middle = v3_add(middle, s->vertex[i]);
        }
    middle = v3_scale(1.0 / n, middle);
    for (int32_t k = 0; k < n; k++) {
        vec3 d = v3_sub(s->vertex[a[k].vertex], middle);
        a[k].angle = atan2(v3_dot(d, f), v3_dot(d, e));
    }
    qsort(a, (size_t)n, sizeof *a, by_angle);
    int32_t first = 0;
    for (int32_t k = 1; k < n; k++)
        if (a[k].vertex < a[first].vertex) first = k;
    struct around *copy = malloc(((size_t)n + 1) * sizeof *copy);
    if (!copy) return -1;
    for (int32_t k = 0; k < n; k++) copy[k] = a[(first + k) % n];
    memcpy(a, copy, (size_t)n * sizeof *a);
    free(copy);
    return n;
}

/* Does face (first place, length) a come before b? By corners, the shorter first where all are the same */
static bool comes_before(const struct shape *s, const int32_t a[2], const int32_t b[2])
{
    for (int32_t k = 0; k < a[1] && k < b[1]; k++) {
        int32_t x = s->corner[a[0] + k], y = s->corner[b[0] + k];
        if (x != y) return x < y;
    }
    return a[1] < b[1];
}

/* Faces in the order of their corners: qhull's is its own affair. */
static int sort_faces(struct shape *s, struct why *why)
{
    int32_t(*face)[2] = malloc(((size_t)s->faces + 1) * sizeof *face);
    int32_t *corner = malloc(((size_t)s->corners + 1) * sizeof *corner), n = 0;
    for (int32_t f = 0; f < s->faces && face && corner; f++) {
        const int32_t new[2] = { s->first[f], s->first[f + 1] - s->first[f] };
        int32_t k = f;
        for (; k > 0 && comes_before(s, new, face[k - 1]); k--)
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
        no_memory(why);
    free(face), free(corner);
    return why->status;
}

static int by_area(const void *one, const void *other)
{
    const struct facet *a = one, *b = other;
    if (a->area != b->area) return a->area > b->area ? -1 : 1;
    for (int k = 0; k < 3; k++)
        if (a->point[k] != b->point[k]) return a->point[k] < b->point[k] ? -1 : 1;
    return 0;
}

/* Is a triangle in the plane of a face that is there? */
static bool is_covered(const struct facet *f, const struct facet *face, int32_t faces,
                       const vec3 *x, double flat)
{
    for (int32_t k = 0; k < faces; k++) {
        bool in = true;
        for (int c = 0; c < 3; c++)
            in = in && fabs(v3_dot(face[k].n, x[f->point[c]]) - face[k].at) < flat;
        if (in) return true;
    }
    return false;
}

/* Leaves out vertices of fewer than three faces: rounding has put them beside an edge or a face. */
static int drop_between(struct shape *s, struct why *why)
{
    int32_t *of = calloc((size_t)s->vertices + 1, sizeof *of), n = 0, corners = 0, first = 0;
    if (!of) return no_memory(why);
    for (int32_t i = 0; i < s->corners; i++) of[s->corner[i]]++;
    for (int32_t i = 0; i < s->vertices; i++) {
        bool stays = of[i] >= 3;
        of[i] = stays ? n : -1;
        if (stays) s->vertex[n++] = s->vertex[i];
    }
    for (int32_t f = 0; f < s->faces; f++) {
        int32_t end = s->first[f + 1];
        for (int32_t i = first; i < end; i++)
            if (of[s->corner[i]] >= 0) s->corner[corners++] = of[s->corner[i]];
        first = end, s->first[f + 1] = corners;
    }
    s->vertices = n, s->corners = corners;
    free(of);
    return 0;
}

/* The largest triangles know their planes best. */
static int make_faces(struct shape *s, const struct answer *a, const vec3 *x, double flat,
                      struct why *why)
{
    struct around *around = malloc(((size_t)s->vertices + 1) * sizeof *around);
    if (!around) return no_memory(why);
    qsort(a->facet, (size_t)a->facets, sizeof *a->facet, by_area);
    for (int64_t k = 0; k < a->facets && !why->status; k++) {
        const struct facet f = a->facet[k];
        if (is_covered(&f, a->facet, s->faces, x, flat)) continue;
        int32_t n = gather_face(s, f.n, f.at, flat, around);
        if (n < 0) no_memory(why);
        if (n < 3) continue;
        if (s->faces + 1 > 2 * s->vertices || s->corners + n > 6 * s->vertices) {
            why_set(why, EX_DATAERR, "is flat to rounding");
            break;
        }
        a->facet[s->faces] = f; // faces are no more than what has been looked at
        for (int32_t i = 0; i < n; i++) s->corner[s->corners++] = around[i].vertex;
        s->first[++s->faces] = s->corners;
    }
    free(around);
    return why->status ? why->status : drop_between(s, why);
}

/* In the plane the loop of all corners */
static int make_loop(struct shape *s, struct why *why)
{
    struct around *around = malloc(((size_t)s->vertices + 1) * sizeof *around);
    if (!around) return no_memory(why);
    int32_t n = gather_face(s, v3(0, 0, 1), 0, INFINITY, around);
    for (int32_t i = 0; i < n; i++) s->corner[i] = around[i].vertex;
    s->faces = 1, s->corners = s->first[1] = n;
    free(around);
    return n < 0 ? no_memory(why) : 0;
}

int hull_of_points(struct shape *s, int dim, int64_t n, const vec3 *x, double flat, struct why *why)
{
    struct answer a = { 0 };
    double size = 0;
    for (int64_t i = 0; i < n; i++) size = fmax(size, v3_norm(v3_sub(x[i], x[0])));
    if (n <= dim || !(size > 0))
        return why_set(why, EX_DATAERR, "is flat: its points have no volume");
    char *name = s->name;
    int32_t corners = 0, form = s->form;
    double round = s->round;
    if (!ask_qhull(&a, dim, n, x, why)) {
        for (int64_t i = 0; i < n; i++) corners += a.corner[i];
        if (corners > SHAPE_VERTICES_MOST)
            why_set(why, EX_DATAERR, "its hull has more than %d corners", SHAPE_VERTICES_MOST);
        else if (!shape_alloc(s, corners, 2 * corners, 6 * corners, why)) {
            s->name = name, s->form = form, s->round = round;
            s->vertices = s->faces = s->corners = 0;
            for (int64_t i = 0; i < n; i++)
                if (a.corner[i]) s->vertex[s->vertices++] = x[i];
            if (dim == 2)
                make_loop(s, why);
            else if (!make_faces(s, &a, x, flat * size, why))
                sort_faces(s, why);
            if (!why->status && dim == 3) s->first[s->faces] = s->corners;
        }
    }
    free(a.facet), free(a.corner);
    return why->status;
}
