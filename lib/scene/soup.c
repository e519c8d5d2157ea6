/* scene/soup.c: polygons gathered, and made a mesh [scene/soup.h]. */
#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier): qsort_r
#include "scene/soup.h"

#include "scene/ears.h"
#include "state/names.h"

#include <float.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Of the extent: what numbers as coarse as this describe is another body. */
static const double COARSE = 1e-3;

int soup_fault(struct soup *s, const char *format, ...)
{
    char trouble[200];
    va_list ap;
    va_start(ap, format);
    vsnprintf(trouble, sizeof trouble, format, ap);
    va_end(ap);
    for (char *c = trouble; *c; c++)
        if (*c & 0x80)
            *c = '?'; // of words out of the file; half a character, or one that moves a terminal
    if (!s->unit) return failure_set(s->failure, EX_DATAERR, "%s: %s", s->name, trouble);
    return failure_set(s->failure, EX_DATAERR, "%s: %s %lld: %s", s->name, s->unit,
                       (long long)s->at, trouble);
}

static int soup_no_memory(struct soup *s)
{
    return failure_set(s->failure, EX_SOFTWARE, "%s: no memory for a mesh", s->name);
}

void soup_free(struct soup *s)
{
    for (int32_t k = 0; k < s->parts; k++) free(s->part[k]);
    free(s->corner), free(s->triangle), free(s->part_of), free(s->part);
    s->corner = NULL, s->triangle = NULL, s->part_of = NULL, s->part = NULL, s->parts = 0;
}

int soup_corner(struct soup *s, vec3 x)
{
    if (!v3_finite(x)) return soup_fault(s, "a corner that is not finite");
    if (s->corners == SOUP_CORNERS_MOST)
        return soup_fault(s, "more than %d corners", SOUP_CORNERS_MOST);
    if (s->corners == s->corner_room) {
        s->corner_room += s->corner_room / 2 + 1024;
        vec3 *more = realloc(s->corner, (size_t)s->corner_room * sizeof *more);
        if (!more) return soup_no_memory(s);
        s->corner = more;
    }
    s->corner[s->corners++] = v3(x.x + 0.0, x.y + 0.0, x.z + 0.0); // no -0
    return 0;
}

static int soup_make_room(struct soup *s, int64_t triangles)
{
    if (s->triangles + triangles > SOUP_TRIANGLES_MOST)
        return soup_fault(s, "more than %d triangles", SOUP_TRIANGLES_MOST);
    if (s->triangles + triangles <= s->triangle_room) return 0;
    s->triangle_room += s->triangle_room / 2 + (int32_t)triangles + 1024;
    int32_t(*more)[3] = realloc(s->triangle, (size_t)s->triangle_room * sizeof *more);
    if (!more) return soup_no_memory(s);
    s->triangle = more;
    if (!s->grouped) return 0;
    int32_t *of = realloc(s->part_of, (size_t)s->triangle_room * sizeof *of);
    if (!of) return soup_no_memory(s);
    s->part_of = of;
    return 0;
}

/* ---- parts ---- */

/* Row of the part of the polygons to come, in *now; -1: of none */
static int find_part(struct soup *s)
{
    char both[2 * SOUP_LABEL];
    if (s->now >= -1) return 0;
    snprintf(both, sizeof both, "%s%s", s->label[0], s->label[1]);
    if ((s->work -= s->parts) < 0) return soup_fault(s, "groups that change too often");
    for (s->now = *both ? 0 : -1; s->now >= 0 && s->now < s->parts; s->now++)
        if (!strcmp(s->part[s->now], both)) return 0;
    if (s->now < 0) return 0;
    if (s->parts == SOUP_PARTS_MOST)
        return soup_fault(s, "more than %d groups of polygons", SOUP_PARTS_MOST);
    char **more = realloc(s->part, ((size_t)s->parts + 1) * sizeof *more);
    if (!more) return soup_no_memory(s);
    s->part = more;
    if (!(s->part[s->parts] = strdup(both))) return soup_no_memory(s);
    s->now = s->parts++;
    return 0;
}

void soup_no_label(struct soup *s, int which)
{
    s->label[which][0] = 0, s->now = -2;
}

int soup_label(struct soup *s, int which, const char *name, int n)
{
    const char *trouble = name_trouble(name, (size_t)n);
    size_t length = strlen(s->label[which]);
    if (trouble) return soup_fault(s, "the name of a group %s", trouble);
    if (length + (size_t)n + 2 > SOUP_LABEL) return soup_fault(s, "too many groups at once");
    memcpy(s->label[which] + length, name, (size_t)n);
    memcpy(s->label[which] + length + n, "\n", 2);
    s->now = -2;
    return 0;
}

static bool soup_same_place(vec3 a, vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

int soup_polygon(struct soup *s, const int64_t *corner, int64_t n)
{
    vec3 x[POLYGON_CORNERS_MOST];
    int32_t number[POLYGON_CORNERS_MOST], kept = 0, triangles;
    if (n < 3) return soup_fault(s, "a polygon of %lld corners", (long long)n);
    if (n > POLYGON_CORNERS_MOST)
        return soup_fault(s, "a polygon of more than %d corners", POLYGON_CORNERS_MOST);
    for (int64_t k = 0; k < n; k++) {
        if (corner[k] < 0 || corner[k] >= s->corners)
            return soup_fault(s, "a polygon has a corner that does not exist (%lld of %d)",
                              (long long)corner[k] + 1, s->corners);
        vec3 at = s->corner[corner[k]];
        if (kept && soup_same_place(at, x[kept - 1])) continue;
        x[kept] = at, number[kept++] = (int32_t)corner[k];
    }
    while (kept > 1 && soup_same_place(x[kept - 1], x[0])) kept--;
    if (soup_make_room(s, n - 2) || (s->grouped && find_part(s))) return s->failure->status;
    int32_t(*t)[3] = s->triangle + s->triangles;
    const char *trouble = NULL;
    if (kept <= 3)
        t[0][0] = 0, t[0][1] = 1, t[0][2] = 2, triangles = kept == 3;
    else
        trouble = ears_cut(x, kept, t, &triangles, &s->work);
    if (trouble) return soup_fault(s, "%s", trouble);
    for (int32_t i = 0; i < triangles; i++)
        for (int k = 0; k < 3; k++) t[i][k] = number[t[i][k]];
    for (int32_t i = 0; s->grouped && i < triangles; i++) s->part_of[s->triangles + i] = s->now;
    s->triangles += triangles, s->flat += (int32_t)n - 2 - triangles;
    return 0;
}

/* ---- a mesh of it ---- */

static int soup_by_place(const void *one, const void *other, void *of)
{
    const vec3 *x = of;
    int32_t i = *(const int32_t *)one, j = *(const int32_t *)other;
    vec3 a = x[i], b = x[j];
    if (a.x != b.x) return a.x < b.x ? -1 : 1;
    if (a.y != b.y) return a.y < b.y ? -1 : 1;
    if (a.z != b.z) return a.z < b.z ? -1 : 1;
    return (i > j) - (i < j);
}

static int32_t *count_up(int32_t n)
{
    int32_t *order = malloc(((size_t)n + 1) * sizeof *order);
    for (int32_t i = 0; order && i < n; i++) order[i] = i;
    return order;
}

/* The corners of triangles become the first of those that lie in their place. */
static int join_corners(struct soup *s)
{
    int32_t *order = count_up(s->corners), *first = count_up(s->corners);
    if (!order || !first) {
        free(order), free(first);
        return soup_no_memory(s);
    }
    qsort_r(order, (size_t)s->corners, sizeof *order, soup_by_place, s->corner);
    for (int32_t i = 1; i < s->corners; i++)
        if (soup_same_place(s->corner[order[i]], s->corner[order[i - 1]]))
            first[order[i]] = first[order[i - 1]];
    for (int32_t i = 0; i < s->triangles; i++)
        for (int k = 0; k < 3; k++) s->triangle[i][k] = first[s->triangle[i][k]];
    free(order), free(first);
    return 0;
}

static void sort3(const int32_t t[3], int32_t out[3])
{
    int32_t a = t[0], b = t[1], c = t[2], swap;
    if (a > b) swap = a, a = b, b = swap;
    if (b > c) swap = b, b = c, c = swap;
    if (a > b) swap = a, a = b, b = swap;
    out[0] = a, out[1] = b, out[2] = c;
}

static int compare_corners(const int32_t t[3], const int32_t u[3])
{
    int32_t a[3], b[3];
    sort3(t, a), sort3(u, b);
    for (int k = 0; k < 3; k++)
        if (a[k] != b[k]) return a[k] < b[k] ? -1 : 1;
    return 0;
}

static int by_corners(const void *one, const void *other, void *of)
{
    int32_t(*triangle)[3] = of;
    int32_t i = *(const int32_t *)one, j = *(const int32_t *)other;
    int order = compare_corners(triangle[i], triangle[j]);
    return order ? order : (i > j) - (i < j);
}

/* Of triangles of the same corners, the first stays; the others are marked by a corner -1. */
static int mark_repeated(struct soup *s)
{
    int32_t *order = count_up(s->triangles), last = 0;
    if (!order) return soup_no_memory(s);
    qsort_r(order, (size_t)s->triangles, sizeof *order, by_corners, s->triangle);
    for (int32_t i = 1; i < s->triangles; i++) {
        bool same = !compare_corners(s->triangle[order[i]], s->triangle[order[last]]);
        if (same) s->triangle[order[i]][0] = -1;
        if (!same) last = i;
    }
    free(order);
    return 0;
}

static bool has_area(const struct soup *s, const int32_t t[3], double scale)
{
    vec3 a = v3_scale(scale, s->corner[t[0]]);
    vec3 b = v3_sub(v3_scale(scale, s->corner[t[1]]), a),
         c = v3_sub(v3_scale(scale, s->corner[t[2]]), a);
    return v3_norm(v3_cross(b, c)) > 0;
}

/* The triangles that stay move to the front. */
static void leave_out(struct soup *s, double scale)
{
    int32_t n = 0;
    for (int32_t i = 0; i < s->triangles; i++) {
        const int32_t *t = s->triangle[i];
        if (t[0] < 0 || !has_area(s, t, scale)) continue;
        for (int k = 0; k < 3; k++) s->triangle[n][k] = t[k];
        if (s->grouped) s->part_of[n] = s->part_of[i];
        n++;
    }
    s->triangles = n;
}

/* Numbers anew, in the order in which triangles have them, the corners that there are; how many. */
static int32_t number_corners(struct soup *s, int32_t *number)
{
    int32_t n = 0;
    for (int32_t i = 0; i < s->corners; i++) number[i] = -1;
    for (int32_t i = 0; i < s->triangles; i++)
        for (int k = 0; k < 3; k++)
            if (number[s->triangle[i][k]] < 0) number[s->triangle[i][k]] = n++;
    return n;
}

static int judge_numbers(struct soup *s, double scale)
{
    vec3 lo = s->corner[s->triangle[0][0]], hi = lo;
    for (int32_t i = 0; i < s->triangles; i++)
        for (int k = 0; k < 3; k++) {
            vec3 x = s->corner[s->triangle[i][k]];
            lo = v3_min(lo, x), hi = v3_max(hi, x);
        }
    vec3 far = v3_max(hi, v3_scale(-1, lo)), sides = v3_sub(hi, lo);
    double most = fmax(far.x, fmax(far.y, far.z)), extent = fmax(sides.x, fmax(sides.y, sides.z));
    double coarse = most * (s->single ? FLT_EPSILON : DBL_EPSILON) / extent;
    s->unit = NULL;
    if (!isfinite(scale * most)) return soup_fault(s, "corners are not finite with this scale");
    if (!(coarse <= COARSE))
        return soup_fault(
            s,
            "its corners, up to %.3g from the origin, are rounded to %.1g of its size by %d-bit "
            "numbers: move it to the origin before it is written%s",
            most, coarse, s->single ? 32 : 64, s->single ? ", or write it as OBJ" : "");
    return 0;
}

static int soup_add_to(struct mesh *to, struct soup *s, double scale)
{
    int32_t *number = malloc(((size_t)s->corners + 1) * sizeof *number), first = to->vertices;
    vec3 *vertex;
    int32_t(*element)[3];
    if (!number) return soup_no_memory(s);
    if (to->elements > SOUP_TRIANGLES_MOST - s->triangles)
        soup_fault(s, "more than %d triangles, with those of other files", SOUP_TRIANGLES_MOST);
    else if (!mesh_grow(to, number_corners(s, number), s->triangles, &vertex, &element,
                        s->failure)) {
        for (int32_t i = 0; i < s->corners; i++)
            if (number[i] >= 0) vertex[number[i]] = v3_scale(scale, s->corner[i]);
        for (int32_t i = 0; i < s->triangles; i++)
            for (int k = 0; k < 3; k++) element[i][k] = first + number[s->triangle[i][k]];
    }
    free(number);
    return s->failure->status;
}

int soup_mesh(struct mesh *to, struct soup *s, double scale, int32_t *left_out)
{
    int32_t all = s->triangles + s->flat;
    s->unit = NULL;
    if (join_corners(s) || mark_repeated(s)) return s->failure->status;
    leave_out(s, scale);
    *left_out = all - s->triangles;
    if (!s->triangles) return soup_fault(s, all ? "no triangle with an area" : "no triangles");
    return judge_numbers(s, scale) || soup_add_to(to, s, scale) ? s->failure->status : 0;
}
