#include "scene/mesh_shape.h"

#include "shape/solid.h"
#include "scene/hull.h"
#include "scene/line_crossings.h"
#include "scene/thin.h"

#include <stdlib.h>

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

static int surface_parts_judge_sides(const struct surface_parts_side *side, int32_t n, struct failure *failure)
{
    for (int32_t k = 0, end; k < n; k = end) {
        const struct surface_parts_side *a = &side[k];
        for (end = k + 1; end < n && side[end].lo == a->lo && side[end].hi == a->hi;) end++;
        if (end - k == 1)
            return failure_set(failure, EX_DATAERR, "is open: triangle %d has a side without a neighbour",
                           a->triangle);
        if (end - k > 2)
            return failure_set(failure, EX_DATAERR, "more than two triangles share a side of triangle %d",
                           a->triangle);
        if (a->back == side[k + 1].back)
            return failure_set(failure, EX_DATAERR,
                           "of triangles %d and %d, which share a side, one is turned inside out",
                           a->triangle, side[k + 1].triangle);
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
    if (volume < 0) return failure_set(failure, EX_DATAERR, "is turned inside out: turn its faces outward");
    if (crossings_judge(m, failure)) return failure->status;
    if (fabs(volume - hull.volume) > CONVEX * hull.volume)
        return failure_set(failure, EX_DATAERR,
                       "is not convex: its volume is %.6g m^3, that of its hull %.6g m^3", volume,
                       hull.volume);
    return 0;
}

int mesh_shape(struct shape *s, const struct mesh *m, bool hull, bool *by_hull, struct failure *failure)
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
