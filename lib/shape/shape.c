/* shape/shape.c: tables of shapes, and what makes a hull one [shape/shape.h]. */
#include "shape/shape.h"

#include <stdlib.h>
#include <string.h>

/* Of the radius: faces are flat, and vertices behind them, to this: files of triangles are written in
   single precision, and what overlaps at rest does so by 1e-4. */
static const double FLAT = 1e-6;

int shape_alloc(struct shape *s, int32_t vertices, int32_t faces, int32_t corners,
                struct failure *failure)
{
    s->vertices = vertices, s->faces = faces, s->corners = corners;
    s->vertex = calloc((size_t)vertices + 1, sizeof *s->vertex);
    s->ball = calloc((size_t)vertices + 1, sizeof *s->ball);
    s->first = calloc((size_t)faces + 1, sizeof *s->first);
    s->corner = calloc((size_t)corners + 1, sizeof *s->corner);
    if (s->vertex && s->ball && s->first && s->corner) return 0;
    shape_free(s);
    return failure_set(failure, EX_SOFTWARE, "no memory for a shape");
}

void shape_free(struct shape *s)
{
    free(s->name), free(s->vertex), free(s->ball), free(s->first), free(s->corner);
    free(s->normal), free(s->edge);
    *s = (struct shape){ 0 };
}

void shapes_free(struct shapes *t)
{
    for (int32_t k = 0; k < t->n; k++) shape_free(&t->s[k]);
    free(t->s), free(t->sorted);
    *t = (struct shapes){ 0 };
}

/* How many rows have names before this one; `equal`: or this one */
static int32_t names_before(const struct shapes *t, const char *name, bool equal)
{
    int32_t lo = 0, hi = t->n;
    while (lo < hi) {
        int32_t middle = lo + (hi - lo) / 2;
        int order = strcmp(t->s[t->sorted[middle]].name, name);
        *(order < 0 || (equal && !order) ? &lo : &hi) =
            order < 0 || (equal && !order) ? middle + 1 : middle;
    }
    return lo;
}

/* Room for one more; false: no memory */
static bool shape_grow(struct shapes *t)
{
    if (t->n < t->room) return true;
    int32_t room = t->n + t->n / 2 + 8;
    struct shape *s = realloc(t->s, (size_t)room * sizeof *s);
    if (s) t->s = s;
    int32_t *sorted = realloc(t->sorted, (size_t)room * sizeof *sorted);
    if (sorted) t->sorted = sorted;
    if (!s || !sorted) return false;
    t->room = room;
    return true;
}

static int shape_append(struct shapes *t, struct shape *s, struct failure *failure)
{
    if (!s->name || !shape_grow(t)) {
        shape_free(s);
        return failure_set(failure, EX_SOFTWARE, "no memory for the shapes");
    }
    int32_t at = names_before(t, s->name, true);
    memmove(&t->sorted[at + 1], &t->sorted[at], (size_t)(t->n - at) * sizeof *t->sorted);
    t->sorted[at] = t->n;
    t->s[t->n++] = *s;
    *s = (struct shape){ 0 };
    return 0;
}

int shapes_add(struct shapes *t, int dim, struct shape *s, struct failure *failure)
{
    if (t->n >= SHAPES_MOST) {
        shape_free(s);
        return failure_set(failure, EX_DATAERR, "more than %d shapes", SHAPES_MOST);
    }
    double volume = dim == 2 ? M_PI : 4 * M_PI / 3, k = dim == 2 ? 0.5 : 0.4;
    struct shape ball = { .volume = volume, .moment = { k, k, k } };
    if (!t->n) {
        ball.name = strdup("ball");
        if (shape_append(t, &ball, failure)) return shape_free(s), failure->status;
    }
    return shape_append(t, s, failure);
}

int32_t shapes_find(const struct shapes *t, const char *name)
{
    int32_t at = names_before(t, name, false);
    return at < t->n && !strcmp(t->s[t->sorted[at]].name, name) ? t->sorted[at] : -1;
}

bool shape_same(const struct shape *a, const struct shape *b)
{
    bool same = a->form == b->form && a->round == b->round && a->vertices == b->vertices &&
                a->faces == b->faces && a->corners == b->corners && a->volume == b->volume;
    for (int k = 0; same && k < 3; k++) same = a->moment[k] == b->moment[k];
    for (int32_t i = 0; same && i < a->vertices; i++)
        same = a->vertex[i].x == b->vertex[i].x && a->vertex[i].y == b->vertex[i].y &&
               a->vertex[i].z == b->vertex[i].z && a->ball[i] == b->ball[i];
    for (int32_t f = 0; same && f < a->faces; f++) same = a->first[f + 1] == b->first[f + 1];
    for (int32_t i = 0; same && i < a->corners; i++) same = a->corner[i] == b->corner[i];
    return same;
}

static int shape_copy_one(struct shape *to, const struct shape *from, struct failure *failure)
{
    *to = *from;
    to->name = strdup(from->name);
    to->normal = NULL, to->edge = NULL, to->edges = 0;
    if (!to->name) {
        to->vertex = NULL, to->ball = NULL, to->first = to->corner = NULL;
        return failure_set(failure, EX_SOFTWARE, "no memory for a shape");
    }
    char *name = to->name;
    if (shape_alloc(to, from->vertices, from->faces, from->corners, failure))
        return failure->status;
    to->name = name;
    for (int32_t i = 0; i < from->vertices; i++)
        to->vertex[i] = from->vertex[i], to->ball[i] = from->ball[i];
    for (int32_t i = 0; i <= from->faces && from->faces; i++) to->first[i] = from->first[i];
    for (int32_t i = 0; i < from->corners; i++) to->corner[i] = from->corner[i];
    size_t normals = (size_t)(from->faces > from->vertices ? from->faces : from->vertices);
    if (!from->normal) return 0;
    to->normal = calloc(normals + 1, sizeof *to->normal);
    to->edge = calloc((size_t)from->edges + 1, sizeof *to->edge);
    if (!to->normal || !to->edge) return failure_set(failure, EX_SOFTWARE, "no memory for a shape");
    memcpy(to->normal, from->normal, normals * sizeof *to->normal);
    to->edges = from->edges;
    for (int32_t i = 0; i < from->edges; i++) to->edge[i] = from->edge[i];
    return 0;
}

int shapes_copy(struct shapes *to, const struct shapes *from, struct failure *failure)
{
    *to = (struct shapes){ 0 };
    if (!from->n) return 0;
    to->s = calloc((size_t)from->n, sizeof *to->s);
    to->sorted = calloc((size_t)from->n, sizeof *to->sorted);
    if (!to->s || !to->sorted) {
        free(to->s), free(to->sorted);
        *to = (struct shapes){ 0 };
        return failure_set(failure, EX_SOFTWARE, "no memory for the shapes");
    }
    to->room = from->n;
    memcpy(to->sorted, from->sorted, (size_t)from->n * sizeof *to->sorted);
    for (; to->n < from->n; to->n++)
        if (shape_copy_one(&to->s[to->n], &from->s[to->n], failure)) {
            to->n++;
            shapes_free(to);
            return failure->status;
        }
    return 0;
}

/* ---- what makes a shape one ---- */

static const char *shape_number_trouble(const struct shape *s, int dim)
{
    if (s->form < 0 || s->form >= SHAPE_FORMS) return "no such form";
    if (!(s->volume > 0 && isfinite(s->volume))) return "its volume must be positive";
    for (int k = dim == 2 ? 2 : 0; k < 3; k++)
        if (!(s->moment[k] > 0 && s->moment[k] <= 1)) return "its moments are out of range";
    for (int k = 0; k < 3 && dim == 3; k++) // no body's inertia is otherwise
        if (!(s->moment[k] <= (s->moment[(k + 1) % 3] + s->moment[(k + 2) % 3]) * (1 + 1e-9)))
            return "its moments are no body's";
    if (!(s->round >= 0 && s->round <= 1)) return "its rounding is out of range";
    double reach = 0;
    for (int32_t i = 0; i < s->vertices; i++) {
        double r = shape_round(s, i);
        if (!v3_finite(s->vertex[i])) return "a vertex is not finite";
        if (shape_is_union(s) && !(r > 0)) return "a ball's radius must be positive";
        if (dim == 2 && s->vertex[i].z != 0) return "leaves the plane, and dim is 2";
        reach = fmax(reach, v3_norm(s->vertex[i]) + r);
    }
    if (s->form != SHAPE_BALL && !(fabs(reach - 1) < 1e-9)) return "does not reach to its radius";
    return NULL;
}

static const char *form_trouble(const struct shape *s)
{
    switch (s->form) {
    case SHAPE_BALL:
        return s->vertices ? "a ball has no vertices" : NULL;
    case SHAPE_CLUMP:
        return s->vertices < 1 ? "a clump needs balls" : NULL;
    case SHAPE_CAPSULE:
        return s->vertices != 2  ? "a capsule has two ends"
               : !(s->round > 0) ? "a capsule's radius must be positive"
                                 : NULL;
    default:
        return NULL;
    }
}

static vec3 loop_normal(const struct shape *s, int32_t f)
{
    vec3 n = v3(0, 0, 0);
    for (int32_t i = s->first[f], end = s->first[f + 1]; i < end; i++) // [Newell]
        n = v3_add(n, v3_cross(s->vertex[s->corner[i]],
                               s->vertex[s->corner[i + 1 < end ? i + 1 : s->first[f]]]));
    return n;
}

static const char *face_trouble(struct shape *s, int32_t f)
{
    vec3 n = loop_normal(s, f);
    double area = v3_norm(n);
    if (!(area > 1e-15)) return "a face has no area";
    n = s->normal[f] = v3_scale(1 / area, n);
    double at = 0;
    for (int32_t i = s->first[f]; i < s->first[f + 1]; i++)
        at = fmax(i == s->first[f] ? -INFINITY : at, v3_dot(n, s->vertex[s->corner[i]]));
    for (int32_t i = s->first[f]; i < s->first[f + 1]; i++)
        if (!(at - v3_dot(n, s->vertex[s->corner[i]]) < FLAT)) return "a face is not flat";
    if (!(at > 0)) return "a face is turned inside out";
    for (int32_t i = 0; i < s->vertices; i++)
        if (!(v3_dot(n, s->vertex[i]) < at + FLAT)) return "is not convex";
    return NULL;
}

static int compare_edges(const void *one, const void *other)
{
    const struct shape_edge *a = one, *b = other;
    int32_t a0 = a->tail < a->head ? a->tail : a->head, a1 = a->tail ^ a->head ^ a0;
    int32_t b0 = b->tail < b->head ? b->tail : b->head, b1 = b->tail ^ b->head ^ b0;
    if (a0 != b0) return a0 < b0 ? -1 : 1;
    if (a1 != b1) return a1 < b1 ? -1 : 1;
    return a->tail < b->tail ? -1 : a->tail > b->tail;
}

/* Every side of a face is one of exactly one other face, the other way round. */
static const char *pair_edges(struct shape *s)
{
    int32_t n = 0;
    for (int32_t f = 0; f < s->faces; f++)
        for (int32_t i = s->first[f], end = s->first[f + 1]; i < end; i++)
            s->edge[n++] =
                (struct shape_edge){ s->corner[i], s->corner[i + 1 < end ? i + 1 : s->first[f]], f,
                                     -1 };
    qsort(s->edge, (size_t)n, sizeof *s->edge, compare_edges);
    if (n % 2) return "its faces do not close";
    for (int32_t k = 0; k < n; k += 2) {
        const struct shape_edge *a = &s->edge[k], *b = a + 1;
        if (a->tail != b->head || a->head != b->tail || a->tail == a->head)
            return "its faces do not close";
        if (k > 1 && s->edge[k / 2 - 1].tail == a->tail && s->edge[k / 2 - 1].head == a->head)
            return "two sides of faces are one";
        s->edge[k / 2] = (struct shape_edge){ a->tail, a->head, a->left, b->left };
    }
    s->edges = n / 2;
    return s->vertices - s->edges + s->faces == 2 ? NULL : "its faces are no closed surface";
}

static const char *polyhedron_trouble(struct shape *s)
{
    for (int32_t f = 0; f < s->faces; f++) {
        const char *trouble = face_trouble(s, f);
        if (trouble) return trouble;
    }
    return pair_edges(s);
}

/* The normals of its sides, and that it turns left once around */
static const char *polygon_trouble(struct shape *s)
{
    int32_t n = s->corners;
    if (s->faces != 1 || n != s->vertices || n < 3) return "a polygon has one loop of vertices";
    double turned = 0;
    for (int32_t k = 0; k < n; k++) {
        vec3 a = s->vertex[s->corner[k]], b = s->vertex[s->corner[(k + 1) % n]];
        vec3 c = s->vertex[s->corner[(k + 2) % n]], d = v3_sub(b, a), e = v3_sub(c, b);
        double length = v3_norm(d);
        if (!(length > 1e-12)) return "two corners are in one place";
        s->normal[k] = v3(d.y / length, -d.x / length, 0);
        s->edge[k] = (struct shape_edge){ s->corner[k], s->corner[(k + 1) % n], 0, 0 };
        if (!(d.x * e.y - d.y * e.x > 0)) return "is not convex and counterclockwise";
        turned += atan2(d.x * e.y - d.y * e.x, v3_dot(d, e));
    }
    s->edges = n;
    return turned < 3 * M_PI ? NULL : "turns around more than once";
}

/* By Euler's formula no polyhedron has more. */
static const char *count_trouble(const struct shape *s, int dim)
{
    bool many = dim == 3 && (s->faces > 2 * s->vertices || s->corners > 6 * s->vertices);
    return many ? "has more faces than its vertices allow" : NULL;
}

static const char *index_trouble(const struct shape *s)
{
    if (s->first[0] != 0 || s->first[s->faces] != s->corners) return "its faces have no corners";
    for (int32_t f = 0; f < s->faces; f++)
        if ((int64_t)s->first[f + 1] - s->first[f] < 3 || s->first[f + 1] > s->corners)
            return "a face has fewer than three corners";
    for (int32_t i = 0; i < s->corners; i++)
        if (s->corner[i] < 0 || s->corner[i] >= s->vertices) return "a corner is no vertex";
    return NULL;
}

int shape_finish(struct shape *s, int dim, struct failure *failure)
{
    const char *trouble = s->vertices > SHAPE_VERTICES_MOST ? "has too many vertices" : NULL;
    if (!trouble) trouble = form_trouble(s);
    if (!trouble) trouble = shape_number_trouble(s, dim);
    if (trouble) return failure_set(failure, EX_DATAERR, "%s", trouble);
    if (!shape_has_faces(s)) return 0;
    if (s->faces < 1 || (trouble = count_trouble(s, dim)) || (trouble = index_trouble(s)))
        return failure_set(failure, EX_DATAERR, "%s", trouble ? trouble : "has no faces");
    size_t normals = (size_t)(s->faces > s->vertices ? s->faces : s->vertices);
    free(s->normal), free(s->edge);
    s->normal = calloc(normals + 1, sizeof *s->normal);
    s->edge = calloc((size_t)s->corners + 1, sizeof *s->edge);
    if (!s->normal || !s->edge) return failure_set(failure, EX_SOFTWARE, "no memory for a shape");
    trouble = dim == 2 ? polygon_trouble(s) : polyhedron_trouble(s);
    return trouble ? failure_set(failure, EX_DATAERR, "%s", trouble) : 0;
}
