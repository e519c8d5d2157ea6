/* shape/fracture.c: Voronoi pieces by clipping, inscribed polyhedra and balls [shape/fracture.h]. */
#include "shape/fracture.h"

#include "base/array.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Units of the hull, of which the ball around it has the radius 1: a vertex that is nearer to a plane is in it. Rounding
   is 1e-16, and faces are flat to 1e-6. */
static const double IN_PLANE = 1e-9;

/* Behind a plane is n . x <= at. */
struct fracture_plane {
    vec3 n;
    double at;
};

/* A vertex that a plane has made of the edge of two */
struct fracture_vertex {
    int32_t tail, head, made;
};

/* A hull that is being clipped, and where what is left of it goes */
struct clip {
    vec3 *v;
    int32_t *first, *corner;
    int64_t vertices, faces, corners;
    int64_t vertex_room, face_room, corner_room;
    double *above; /* of vertices: how far beyond the plane; 0: in it */
    int64_t above_room;
    struct fracture_vertex *cut;
    int64_t cuts, cut_room;
    int32_t *next; /* of a vertex in the plane: the next one around the new face; -1: none */
    int64_t next_room;
};

static void clip_free(struct clip *c)
{
    free(c->v), free(c->first), free(c->corner), free(c->above), free(c->cut), free(c->next);
}

static bool add_vertex(struct clip *c, vec3 x, double above)
{
    if (!array_grow(&c->v, &c->vertex_room, c->vertices + 1, sizeof *c->v) ||
        !array_grow(&c->above, &c->above_room, c->vertices + 1, sizeof *c->above))
        return false;
    c->above[c->vertices] = above;
    c->v[c->vertices++] = x;
    return true;
}

static bool add_corner(struct clip *c, int32_t vertex)
{
    if (!array_grow(&c->corner, &c->corner_room, c->corners + 1, sizeof *c->corner)) return false;
    c->corner[c->corners++] = vertex;
    return true;
}

/* The face ends with its last corner. */
static bool end_face(struct clip *c)
{
    if (!array_grow(&c->first, &c->face_room, c->faces + 2, sizeof *c->first)) return false;
    c->first[++c->faces] = (int32_t)c->corners;
    return true;
}

static bool clip_begin(struct clip *c, const struct shape *s)
{
    if (!array_grow(&c->first, &c->face_room, 1, sizeof *c->first)) return false;
    c->first[0] = 0;
    for (int32_t i = 0; i < s->vertices; i++)
        if (!add_vertex(c, s->vertex[i], 0)) return false;
    for (int32_t f = 0; f < s->faces; f++) {
        for (int32_t i = s->first[f]; i < s->first[f + 1]; i++)
            if (!add_corner(c, s->corner[i])) return false;
        if (!end_face(c)) return false;
    }
    return true;
}

/* The vertex in the plane on the edge of two vertices on either side of it, one for both faces; -1: no memory */
static int32_t cut_edge(struct clip *c, int32_t a, int32_t b)
{
    const int32_t tail = a < b ? a : b, head = a < b ? b : a;
    for (int64_t k = 0; k < c->cuts; k++)
        if (c->cut[k].tail == tail && c->cut[k].head == head) return c->cut[k].made;
    const double t = c->above[tail] / (c->above[tail] - c->above[head]);
    const int32_t made = (int32_t)c->vertices;
    if (!add_vertex(c, v3_axpy(c->v[tail], t, v3_sub(c->v[head], c->v[tail])), 0) ||
        !array_grow(&c->cut, &c->cut_room, c->cuts + 1, sizeof *c->cut))
        return -1;
    c->cut[c->cuts++] = (struct fracture_vertex){ tail, head, made };
    return made;
}

/* What is behind the plane of a face with these corners, as a new face, unless nothing is */
static bool clip_face(struct clip *c, const int32_t *corner, int32_t n)
{
    const int64_t start = c->corners;
    bool behind = false;
    for (int32_t i = 0; i < n; i++) {
        const int32_t a = corner[i], b = corner[i + 1 < n ? i + 1 : 0];
        behind = behind || c->above[a] < 0;
        if (c->above[a] <= 0 && !add_corner(c, a)) return false;
        if (!(c->above[a] < 0 && c->above[b] > 0) && !(c->above[a] > 0 && c->above[b] < 0))
            continue;
        const int32_t made = cut_edge(c, a, b);
        if (made < 0 || !add_corner(c, made)) return false;
    }
    if (behind && c->corners - start >= 3) return end_face(c);
    c->corners = start;
    return true;
}

/* The face in the plane, whose edges are those of the others in it, the other way round. False: no memory; *closed: whether
   they make one loop. */
static bool close_face(struct clip *c, bool *closed)
{
    int32_t begin = -1, edges = 0;
    *closed = true;
    if (!array_grow(&c->next, &c->next_room, c->vertices, sizeof *c->next)) return false;
    for (int64_t i = 0; i < c->vertices; i++) c->next[i] = -1;
    for (int64_t f = 0; f < c->faces; f++)
        for (int32_t i = c->first[f], end = c->first[f + 1]; i < end; i++) {
            const int32_t a = c->corner[i], b = c->corner[i + 1 < end ? i + 1 : c->first[f]];
            if (c->above[a] != 0 || c->above[b] != 0) continue;
            *closed = *closed && c->next[b] < 0;
            c->next[b] = a, begin = b, edges++;
        }
    int32_t at = begin, n = 0;
    for (; *closed && at >= 0 && n < edges && (n == 0 || at != begin); at = c->next[at], n++)
        if (!add_corner(c, at)) return false;
    *closed = *closed && n == edges && n >= 3 && at == begin;
    return !*closed || end_face(c);
}

/* The vertices that faces have, and no others */
static void drop_vertices(struct clip *c)
{
    int64_t kept = 0;
    for (int64_t i = 0; i < c->vertices; i++) c->next[i] = -1;
    for (int64_t i = 0; i < c->corners; i++) c->next[c->corner[i]] = 0;
    for (int64_t i = 0; i < c->vertices; i++)
        if (c->next[i] == 0) c->v[kept] = c->v[i], c->next[i] = (int32_t)kept++;
    for (int64_t i = 0; i < c->corners; i++) c->corner[i] = c->next[c->corner[i]];
    c->vertices = kept;
}

/* Leaves what is behind the plane, of a polyhedron or, where dim is 2, of a polygon. False: no memory */
static bool clip_by(struct clip *c, struct fracture_plane plane, int dim, bool *closed)
{
    bool any = false;
    for (int64_t i = 0; i < c->vertices; i++) {
        const double d = v3_dot(plane.n, c->v[i]) - plane.at;
        c->above[i] = fabs(d) <= IN_PLANE ? 0 : d;
        any = any || c->above[i] > 0;
    }
    if (!any) return true;
    const int64_t faces = c->faces, corners = c->corners;
    const size_t size = (size_t)corners * sizeof *c->corner;
    int32_t *first = malloc(((size_t)faces + 1) * sizeof *first), *corner = malloc(size + 1);
    bool good = first && corner;
    if (good) memcpy(first, c->first, ((size_t)faces + 1) * sizeof *first);
    if (good) memcpy(corner, c->corner, size);
    c->faces = c->corners = c->cuts = 0;
    for (int64_t f = 0; good && f < faces; f++)
        good = clip_face(c, corner + first[f], first[f + 1] - first[f]);
    free(first), free(corner);
    if (good && dim == 3) good = close_face(c, closed);
    if (good && dim == 2) good = array_grow(&c->next, &c->next_room, c->vertices, sizeof *c->next);
    if (good) drop_vertices(c);
    *closed = *closed && c->faces >= (dim == 2 ? 1 : 4);
    return good;
}

static int fracture_no_memory(struct failure *failure)
{
    return failure_set(failure, EX_SOFTWARE, "no memory for pieces of a grain");
}

static int fracture_piece(struct shape *s, const struct clip *c, struct failure *failure)
{
    *s = (struct shape){ .form = SHAPE_HULL };
    if (shape_alloc(s, (int32_t)c->vertices, (int32_t)c->faces, (int32_t)c->corners, failure))
        return failure->status;
    for (int64_t i = 0; i < c->vertices; i++) s->vertex[i] = c->v[i];
    for (int64_t f = 0; f <= c->faces; f++) s->first[f] = c->first[f];
    for (int64_t i = 0; i < c->corners; i++) s->corner[i] = c->corner[i];
    return 0;
}

/* What is nearer to point i than to the others */
static int fracture_cell(struct shape *piece, int i, int n, const vec3 *point,
                         const struct shape *hull, int dim, struct failure *failure)
{
    struct clip c = { 0 };
    bool closed = true, good = clip_begin(&c, hull);
    for (int j = 0; good && closed && j < n; j++) {
        const vec3 way = v3_sub(point[j], point[i]);
        const double length = v3_norm(way);
        if (j == i) continue;
        if (!(length > IN_PLANE)) closed = false;
        const vec3 u = v3_scale(1 / length, way);
        const struct fracture_plane middle = { u, v3_dot(u, v3_scale(0.5,
                                                                     v3_add(point[i], point[j]))) };
        if (closed) good = clip_by(&c, middle, dim, &closed);
    }
    if (!good)
        fracture_no_memory(failure);
    else if (!closed)
        failure_set(failure, EX_DATAERR, "a piece has no closed surface");
    else
        fracture_piece(piece, &c, failure);
    clip_free(&c);
    return failure->status;
}

void fracture_free(struct shape *piece, int n)
{
    for (int i = 0; i < n; i++) shape_free(&piece[i]);
}

int fracture_cut(struct shape *piece, int n, const vec3 *point, const struct shape *hull, int dim,
                 struct failure *failure)
{
    for (int i = 0; i < n; i++)
        if (fracture_cell(&piece[i], i, n, point, hull, dim, failure)) {
            fracture_free(piece, i);
            return failure->status;
        }
    return 0;
}

static bool fracture_has(const struct shape *s, int dim, vec3 x)
{
    for (int32_t f = 0; f < (dim == 2 ? s->vertices : s->faces); f++) {
        const vec3 on = s->vertex[s->corner[dim == 2 ? f : s->first[f]]];
        if (v3_dot(s->normal[f], v3_sub(x, on)) > 0) return false;
    }
    return true;
}

void fracture_draw(vec3 *point, int n, const struct shape *s, int dim, gsl_rng *rng)
{
    vec3 lo = v3(INFINITY, INFINITY, INFINITY), hi = v3_scale(-1, lo);
    for (int32_t i = 0; i < s->vertices; i++)
        lo = v3_min(lo, s->vertex[i]), hi = v3_max(hi, s->vertex[i]);
    for (int k = 0; k < n; k++) do {
            point[k].x = lo.x + (hi.x - lo.x) * gsl_rng_uniform(rng);
            point[k].y = lo.y + (hi.y - lo.y) * gsl_rng_uniform(rng);
            point[k].z = dim == 2 ? 0 : lo.z + (hi.z - lo.z) * gsl_rng_uniform(rng);
        } while (!fracture_has(s, dim, point[k]));
}

/* ---- inside a ball ---- */

/* The icosahedron's vertices, and its faces, counterclockwise seen from outside */
static const double GOLDEN = 1.6180339887498949;
#define X GOLDEN
static const double icosahedron[12][3] = { { -1, X, 0 }, { 1, X, 0 }, { -1, -X, 0 }, { 1, -X, 0 },
                                           { 0, -1, X }, { 0, 1, X }, { 0, -1, -X }, { 0, 1, -X },
                                           { X, 0, -1 }, { X, 0, 1 }, { -X, 0, -1 }, { -X, 0, 1 } };
#undef X
static const int32_t icosahedron_face[20][3] = {
    { 0, 11, 5 }, { 0, 5, 1 },  { 0, 1, 7 },   { 0, 7, 10 }, { 0, 10, 11 },
    { 1, 5, 9 },  { 5, 11, 4 }, { 11, 10, 2 }, { 10, 7, 6 }, { 7, 1, 8 },
    { 3, 9, 4 },  { 3, 4, 2 },  { 3, 2, 6 },   { 3, 6, 8 },  { 3, 8, 9 },
    { 4, 9, 5 },  { 2, 4, 11 }, { 6, 2, 10 },  { 8, 6, 7 },  { 9, 8, 1 }
};

static vec3 icosahedron_at(int i)
{
    const double *x = icosahedron[i];
    const vec3 v = v3(x[0], x[1], x[2]);
    return v3_scale(1 / v3_norm(v), v);
}

enum { SIDES = 24, CORNERS = 42 };

static int inscribe_polygon(struct shape *s, struct failure *failure)
{
    if (shape_alloc(s, SIDES, 1, SIDES, failure)) return failure->status;
    s->first[1] = SIDES;
    for (int i = 0; i < SIDES; i++) {
        const double a = 2 * M_PI * i / SIDES;
        s->vertex[i] = v3(cos(a), sin(a), 0), s->corner[i] = i;
    }
    return 0;
}

/* The vertex in the middle of an edge, on the ball */
static int32_t middle_of(struct shape *s, int32_t edge[CORNERS][2], int32_t *n, int32_t a,
                         int32_t b)
{
    const int32_t tail = a < b ? a : b, head = a < b ? b : a;
    for (int32_t k = 12; k < *n; k++)
        if (edge[k][0] == tail && edge[k][1] == head) return k;
    const vec3 x = v3_add(s->vertex[tail], s->vertex[head]);
    edge[*n][0] = tail, edge[*n][1] = head;
    s->vertex[*n] = v3_scale(1 / v3_norm(x), x);
    return (*n)++;
}

int fracture_inscribe(struct shape *s, int dim, struct failure *failure)
{
    int32_t edge[CORNERS][2], n = 12, f = 0;
    *s = (struct shape){ .form = SHAPE_HULL };
    if (dim == 2) return inscribe_polygon(s, failure);
    if (shape_alloc(s, CORNERS, 80, 240, failure)) return failure->status;
    for (int i = 0; i < 12; i++) s->vertex[i] = icosahedron_at(i);
    for (int k = 0; k < 20; k++) {
        const int32_t *c = icosahedron_face[k];
        const int32_t ab = middle_of(s, edge, &n, c[0], c[1]),
                      bc = middle_of(s, edge, &n, c[1], c[2]),
                      ca = middle_of(s, edge, &n, c[2], c[0]);
        const int32_t four[4][3] = {
            { c[0], ab, ca }, { ab, c[1], bc }, { ca, bc, c[2] }, { ab, bc, ca }
        };
        for (int i = 0; i < 4; i++, f++) {
            memcpy(&s->corner[3 * f], four[i], sizeof four[i]);
            s->first[f + 1] = 3 * (f + 1);
        }
    }
    return 0;
}

int fracture_balls(vec3 centre[FRACTURE_BALLS], int dim)
{
    int n = 0;
    centre[n++] = v3(0, 0, 0);
    for (int i = 0; i < 6 && dim == 2; i++)
        centre[n++] = v3(2. / 3 * cos(M_PI / 3 * i), 2. / 3 * sin(M_PI / 3 * i), 0);
    for (int i = 0; i < 12 && dim == 3; i++) centre[n++] = v3_scale(2. / 3, icosahedron_at(i));
    return n;
}
