#include "scene/surface_parts.h"

#include "scene/hull.h"
#include "scene/line_crossings.h"
#include "shape/solid.h"

#include <stdlib.h>
#include <string.h>

/* Of the hull's volume: the surface has it to this. Single precision makes 1e-7 of it, HULL_FLAT 1e-6. */
static const double CONVEX = 1e-5;

enum { CORNERS_MOST = 1 << 20 /* whose hull takes ten seconds */ };

static int surface_parts_no_memory(struct failure *failure)
{
    return failure_set(failure, EX_SOFTWARE, "no memory for a mesh");
}

/* A side of a triangle, from the lesser vertex to the greater or back */
struct surface_parts_side {
    int32_t lo, hi, back, triangle;
};

static int by_vertices(const void *one, const void *other)
{
    const struct surface_parts_side *a = one, *b = other;
    if (a->lo != b->lo) return a->lo < b->lo ? -1 : 1;
    if (a->hi != b->hi) return a->hi < b->hi ? -1 : 1;
    if (a->back != b->back) return a->back - b->back;
    return (a->triangle > b->triangle) - (a->triangle < b->triangle);
}

static int surface_parts_judge_sides(const struct surface_parts_side *side, int32_t n,
                                     struct failure *failure)
{
    for (int32_t k = 0, end; k < n; k = end) {
        const struct surface_parts_side *a = &side[k];
        for (end = k + 1; end < n && side[end].lo == a->lo && side[end].hi == a->hi;) end++;
        if (end - k == 1)
            return failure_set(failure, EX_DATAERR,
                               "is open: triangle %d has a side without a neighbour", a->triangle);
        if (end - k > 2)
            return failure_set(failure, EX_DATAERR,
                               "more than two triangles share a side of triangle %d", a->triangle);
        if (a->back == side[k + 1].back)
            return failure_set(
                failure, EX_DATAERR,
                "of triangles %d and %d, which share a side, one is turned inside out", a->triangle,
                side[k + 1].triangle);
    }
    return 0;
}

/* Is every side that of two triangles, once either way? Corners as near as those of a hull may be are one. */
int mesh_closed(const struct mesh *m, struct failure *failure)
{
    struct surface_parts_side *side = malloc((3 * (size_t)m->elements + 1) * sizeof *side);
    int32_t *to = malloc(((size_t)m->vertices + 1) * sizeof *to), n = 0;
    double apart = HULL_APART * thin_extent(m->vertex, m->vertices);
    if (!side || !to) surface_parts_no_memory(failure);
    if (!failure->status && !thin_out(to, m->vertex, m->vertices, apart, failure)) {
        for (int32_t i = 0; i < m->elements; i++) {
            const int32_t *e = m->element[i], c[3] = { to[e[0]], to[e[1]], to[e[2]] };
            if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue; // has become a line
            for (int k = 0; k < 3; k++) {
                int32_t p = c[k], q = c[(k + 1) % 3];
                side[n++] = (struct surface_parts_side){ p < q ? p : q, p < q ? q : p, p > q, i };
            }
        }
        qsort(side, (size_t)n, sizeof *side, by_vertices);
        surface_parts_judge_sides(side, n, failure);
    }
    free(side), free(to);
    return failure->status;
}

/* m^3: within the triangles, by the divergence theorem, about one of the corners */
static double surface_parts_volume_of(const struct mesh *m)
{
    double sum = 0;
    vec3 o = m->vertex[m->element[0][0]];
    for (int32_t i = 0; i < m->elements; i++) {
        const int32_t *e = m->element[i];
        vec3 a = v3_sub(m->vertex[e[0]], o), b = v3_sub(m->vertex[e[1]], o),
             c = v3_sub(m->vertex[e[2]], o);
        sum += v3_dot(a, v3_cross(b, c)) / 6;
    }
    return sum;
}

static int judge_convex(const struct mesh *m, const struct shape *s, struct failure *failure)
{
    struct solid hull;
    double volume = surface_parts_volume_of(m);
    if (solid_of(&hull, s, 3, failure)) return failure->status;
    if (volume < 0)
        return failure_set(failure, EX_DATAERR, "is turned inside out: turn its faces outward");
    if (crossings_judge(m, failure)) return failure->status;
    if (fabs(volume - hull.volume) > CONVEX * hull.volume)
        return failure_set(failure, EX_DATAERR,
                           "is not convex: its volume is %.6g m^3, that of its hull %.6g m^3",
                           volume, hull.volume);
    return 0;
}

int mesh_shape(struct shape *s, const struct mesh *m, bool hull, bool *by_hull,
               struct failure *failure)
{
    *by_hull = false;
    if (m->vertices > CORNERS_MOST)
        return failure_set(
            failure, EX_DATAERR,
            "has %d corners, and a grain has %d at most: give it fewer triangles (decimate it)",
            m->vertices, CORNERS_MOST);
    if (mesh_check(m, 3, failure)) return failure->status;
    if (!hull && mesh_closed(m, failure)) return *by_hull = true, failure->status;
    if (hull_of_points(s, 3, m->vertices, m->vertex, failure)) return failure->status;
    *by_hull = !hull && judge_convex(m, s, failure);
    return failure->status;
}

/* The drives of a wall again, of the last wall */
static int copy_drives(struct scene *s, struct wall *w, struct failure *failure)
{
    const int32_t first = w->first_drive, n = w->drives;
    struct drives *d = &s->drives;
    w->first_drive = d->n;
    if (!n) return 0;
    struct drive *more = realloc(d->drive, (size_t)(d->n + n) * sizeof *more);
    if (!more) return failure_set(failure, EX_SOFTWARE, "no memory for the drives");
    d->drive = more;
    for (int32_t k = 0; k < n; k++) {
        d->drive[d->n] = d->drive[first + k];
        d->drive[d->n++].wall = s->walls;
    }
    return 0;
}

/* Makes room for one more wall. */
static int surface_parts_grow(struct scene *s, struct failure *failure)
{
    const size_t n = (size_t)s->walls + 1;
    struct wall *wall = realloc(s->wall, n * sizeof *wall);
    if (wall) s->wall = wall;
    int32_t *item = wall ? realloc(s->wall_item, n * sizeof *item) : NULL;
    if (item) s->wall_item = item;
    return item ? 0 : failure_set(failure, EX_SOFTWARE, "no memory for the parts of a surface");
}

/* Which part each of the wall's elements is of, -1: none */
static int name_parts(int32_t *of, const struct scene *s, int32_t w, struct failure *failure)
{
    const int32_t n = s->wall[w].elements;
    for (int32_t e = 0; e < n; e++) of[e] = -1;
    for (int32_t k = 0; k < s->parts; k++) {
        const struct scene_part *part = &s->part[k];
        if (part->wall != w) continue;
        if (part->last >= n)
            return failure_set(failure, EX_DATAERR,
                               "walls[%d].materials: no face %lld: the surface has %d, from 0 on",
                               s->wall_item[w], (long long)part->last, n);
        for (int64_t e = part->first; e <= part->last; e++) {
            if (of[e] >= 0)
                return failure_set(failure, EX_DATAERR,
                                   "walls[%d].materials: face %lld is named twice", s->wall_item[w],
                                   (long long)e);
            of[e] = k;
        }
    }
    return 0;
}

/* The elements of part k become those of a new wall; *at, where they lie. */
static int surface_parts_add_part(struct scene *s, int32_t k, int32_t first, int32_t n,
                                  struct failure *failure)
{
    const struct scene_part *part = &s->part[k];
    struct wall w = s->wall[part->wall];
    if (surface_parts_grow(s, failure) || copy_drives(s, &w, failure)) return failure->status;
    w.material = part->material, w.belt = part->belt, w.first_element = first, w.elements = n;
    s->wall_item[s->walls] = s->wall_item[part->wall];
    s->wall[s->walls++] = w;
    return 0;
}

/* Sorts the elements of wall w by parts, those of none first, and makes walls of the parts. */
static int split(struct scene *s, int32_t w, struct failure *failure)
{
    const int32_t first = s->wall[w].first_element, n = s->wall[w].elements;
    int32_t *of = malloc(((size_t)n + 1) * sizeof *of);
    int32_t(*had)[3] = malloc(((size_t)n + 1) * sizeof *had);
    if (!of || !had) failure_set(failure, EX_SOFTWARE, "no memory for the parts of a surface");
    if (!failure->status && !name_parts(of, s, w, failure)) {
        int32_t at = 0;
        if (n) memcpy(had, s->mesh.element + first, (size_t)n * sizeof *had);
        for (int32_t k = -1; k < s->parts && !failure->status; k++) {
            const int32_t from = at;
            if (k >= 0 && s->part[k].wall != w) continue;
            for (int32_t e = 0; e < n; e++)
                if (of[e] == k) memcpy(s->mesh.element[first + at++], had[e], sizeof *had);
            if (k < 0)
                s->wall[w].elements = at;
            else if (!s->wall[w].elements) // all are of parts: the surface is the first of them
                s->wall[w].material = s->part[k].material, s->wall[w].belt = s->part[k].belt,
                s->wall[w].elements = at;
            else
                surface_parts_add_part(s, k, first + from, at - from, failure);
        }
    }
    free(of), free(had);
    return failure->status;
}

int scene_parts_split(struct scene *s, struct failure *failure)
{
    const int32_t walls = s->walls;
    for (int32_t k = 0; k < s->parts && !failure->status; k++)
        if (s->part[k].wall < walls && (!k || s->part[k].wall != s->part[k - 1].wall))
            split(s, s->part[k].wall, failure);
    return failure->status;
}
