#include "scene/obstacles.h"

#include "scene/line_crossings.h"
#include "scene/surface_parts.h"
#include "shape/mesh.h"

#include <stdlib.h>

enum { SAMPLES = 1 << 15 /* places of the box, by which its free share is known to 1e-3 */ };

/* ---- the sides of a mesh ---- */

/* Which way the line through c along x meets the triangle or segment beyond c: -1, 0, +1 */
static int meets_ahead(const vec3 *v, int dim, vec3 c)
{
    if (dim == 2) {
        const vec3 a = v[0], b = v[1];
        if ((a.y > c.y) == (b.y > c.y)) return 0;
        const double x = a.x + (c.y - a.y) / (b.y - a.y) * (b.x - a.x);
        return x > c.x ? (b.y > a.y ? 1 : -1) : 0;
    }
    double x = 0;
    const int way = crossing_of(v, c.y, c.z, &x);
    return x > c.x ? way : 0;
}

/* Is c within the closed surface? Its winding number is not 0. */
static bool is_within(const struct surface *s, int dim, vec3 c)
{
    struct surface_branch stack[64];
    int depth = 0, winding = 0;
    if (s->n) stack[depth++] = (struct surface_branch){ 0, 0, s->n };
    while (depth) {
        const struct surface_branch b = stack[--depth];
        const struct surface_box *box = &s->box[b.box];
        if (c.y < box->lo.y || c.y > box->hi.y || c.x > box->hi.x ||
            (dim == 3 && (c.z < box->lo.z || c.z > box->hi.z)))
            continue;
        if (b.hi - b.lo <= SURFACE_LEAF) {
            for (int32_t i = b.lo; i < b.hi; i++)
                winding += meets_ahead(s->at[s->order[i]], dim, c);
            continue;
        }
        const int32_t middle = b.lo + (b.hi - b.lo) / 2;
        stack[depth++] = (struct surface_branch){ box->next, middle, b.hi };
        stack[depth++] = (struct surface_branch){ b.box + 1, b.lo, middle };
    }
    return winding != 0;
}

/* Does each corner of the chain begin as many segments as it ends? */
static bool is_loop(const struct surface *s)
{
    bool closed = true;
    int32_t *sum = calloc(3 * (size_t)s->elements + 1, sizeof *sum);
    for (int32_t e = 0; sum && e < s->elements; e++)
        sum[s->corner[3 * e]]++, sum[s->corner[3 * e + 1]]--;
    for (int32_t k = 0; sum && k < 3 * s->elements; k++) closed = closed && sum[k] == 0;
    free(sum);
    return sum && closed;
}

/* Is the wall's part of the mesh closed? */
static bool is_closed(const struct packing *p, const struct wall *w, const struct surface *s)
{
    struct failure none = { 0 };
    const struct mesh part = { p->mesh.vertices, w->elements, p->mesh.vertex,
                               p->mesh.element + w->first_element };
    return s->n > 0 && (p->dim == 2 ? is_loop(s) : !mesh_closed(&part, &none));
}

/* ---- one wall ---- */

/* x in the axes in which the wall is described */
static vec3 obstacles_place_of(const struct obstacles *all, const struct obstacle *o, vec3 x)
{
    const struct wall *w = &all->p->wall[o->wall];
    return v3_sub(quat_turn_back(o->pose.q, v3_sub(x, o->pose.shift)), w->x);
}

/* Is c on the free side, of a closed mesh within it? Beyond the ends of a wall both are free. */
static bool is_free_side(const struct obstacles *all, const struct obstacle *o, vec3 c)
{
    const struct wall *w = &all->p->wall[o->wall];
    struct touch t;
    if (w->shape == WALL_MESH) return is_within(&o->surface, all->p->dim, c);
    return !wall_nearest(w, all->p->dim, c, INFINITY, &t) || t.distance >= 0;
}

static bool has_sides(const struct packing *p, const struct obstacle *o)
{
    const struct wall *w = &p->wall[o->wall];
    if (w->shape == WALL_MESH) return is_closed(p, w, &o->surface);
    const bool round =
        w->shape == WALL_CYLINDER || w->shape == WALL_CONE || w->shape == WALL_SPHERE;
    return w->shape == WALL_PLANE || (round && w->side != WALL_BOTH);
}

/* Does a ball touch it, and where? One of a side that the box does not reach only where its surface is */
static bool obstacles_touches(const struct obstacles *all, const struct obstacle *o, vec3 c,
                              double r)
{
    const struct wall *w = &all->p->wall[o->wall];
    struct touch t;
    if (w->shape == WALL_MESH) return surface_is_at(&o->surface, c, NULL, r);
    return wall_nearest(w, all->p->dim, c, r, &t) && t.distance < r;
}

static int find_touches(const struct obstacles *all, const struct obstacle *o, vec3 c, double r,
                        struct touch touch[TOUCHES_MOST])
{
    const struct wall *w = &all->p->wall[o->wall];
    if (w->shape == WALL_MESH) return surface_touches(&o->surface, c, r, touch);
    return wall_nearest(w, all->p->dim, c, r, &touch[0]) && touch[0].distance < r;
}

bool obstacles_meet(const struct obstacles *all, vec3 x, double r)
{
    for (int32_t k = 0; k < all->n; k++) {
        const struct obstacle *o = &all->o[k];
        const vec3 c = obstacles_place_of(all, o, x);
        if (obstacles_touches(all, o, c, r)) return true;
        if (o->sided && is_free_side(all, o, c) != o->hollow) return true;
    }
    return false;
}

double obstacles_push(const struct obstacles *all, vec3 *x, double r)
{
    struct touch touch[TOUCHES_MOST];
    double deepest = 0;
    for (int32_t k = 0; k < all->n; k++) {
        const struct obstacle *o = &all->o[k];
        const int n = find_touches(all, o, obstacles_place_of(all, o, *x), r, touch);
        for (int i = 0; i < n; i++) {
            const double depth = r - touch[i].distance;
            deepest = fmax(deepest, depth);
            *x = v3_axpy(*x, depth, quat_turn(o->pose.q, touch[i].n));
        }
    }
    return deepest;
}

/* ---- all of them ---- */

/* Place k of a sequence that fills the unit cube evenly: multiples of powers of the root of x^4 = x + 1 [Roberts 2018] */
static vec3 obstacles_sample(const struct scene_box *box, const struct cell *cell, int dim, int k)
{
    static const double step[3] = { 0.8191725133961645, 0.6710436067037893, 0.5497004779019703 };
    double u[3] = { 0 };
    for (int i = 0; i < 3; i++) u[i] = fmod(0.5 + k * step[i], 1);
    if (dim == 2) u[2] = 0;
    if (cell)
        return v3_axpy(v3_axpy(v3_axpy(cell->origin, u[0], cell->edge[0]), u[1], cell->edge[1]),
                       u[2], cell->edge[2]);
    for (int i = 0; i < dim; i++) u[i] = box->lo[i] + u[i] * (box->hi[i] - box->lo[i]);
    return v3(u[0], u[1], u[2]);
}

/* Does the box of the mesh contain that of the group? A hair of it is rounding. */
static bool contains(const struct obstacles *all, const struct obstacle *o,
                     const struct scene_box *box)
{
    const struct surface_box *b = o->surface.box;
    const double hair = 1e-6 * v3_norm(v3_sub(b->hi, b->lo));
    for (int k = 0; k < (all->p->dim == 2 ? 4 : 8); k++) {
        const vec3 corner = v3(k & 1 ? box->hi[0] : box->lo[0], k & 2 ? box->hi[1] : box->lo[1],
                               all->p->dim == 2 ? 0
                               : k & 4          ? box->hi[2]
                                                : box->lo[2]);
        const vec3 c = obstacles_place_of(all, o, corner), lo = v3_sub(b->lo, c),
                   hi = v3_sub(c, b->hi);
        if (fmax(fmax(lo.x, hi.x), fmax(lo.y, hi.y)) > hair || fmax(lo.z, hi.z) > hair)
            return false;
    }
    return true;
}

/* On which sides of the walls the box has places, which of them are free, and how much of the box */
static void obstacles_judge_sides(struct obstacles *all, const struct scene_box *box,
                                  const struct cell *cell)
{
    int64_t free = 0;
    bool any = false;
    for (int32_t k = 0; k < all->n; k++) {
        struct obstacle *o = &all->o[k];
        for (int i = 0; i < SAMPLES && o->sided; i++)
            *(is_free_side(all, o,
                           obstacles_place_of(all, o, obstacles_sample(box, cell, all->p->dim, i)))
                  ? &o->has_free
                  : &o->has_other) = true;
        const bool mesh = all->p->wall[o->wall].shape == WALL_MESH;
        o->hollow = !mesh || !o->has_other || (!cell && contains(all, o, box));
        o->sided = o->sided && o->has_free && o->has_other;
        any = any || o->sided;
    }
    for (int i = 0; i < SAMPLES && any; i++) {
        const vec3 x = obstacles_sample(box, cell, all->p->dim, i);
        bool is_free = true;
        for (int32_t k = 0; k < all->n && is_free; k++) {
            const struct obstacle *o = &all->o[k];
            is_free = !o->sided || is_free_side(all, o, obstacles_place_of(all, o, x)) == o->hollow;
        }
        free += is_free;
    }
    all->free = any ? (double)free / SAMPLES : 1;
}

int obstacles_init(struct obstacles *all, const struct packing *p, const struct scene_box *box,
                   const struct cell *cell, struct failure *failure)
{
    *all = (struct obstacles){ .p = p, .free = 1 };
    all->o = calloc((size_t)p->walls + 1, sizeof *all->o);
    if (!all->o) return failure_set(failure, EX_SOFTWARE, "no memory for the walls");
    for (int32_t w = 0; w < p->walls; w++) {
        const struct wall *wall = &p->wall[w];
        if (!wall_there(wall, p->t)) continue;
        struct obstacle *o = &all->o[all->n++];
        o->wall = w, o->pose = wall_pose(p, wall, p->t);
        if (wall->shape == WALL_MESH && surface_init(&o->surface, &p->mesh, wall->first_element,
                                                     wall->elements, wall->weld, failure))
            return failure->status;
        o->surface.seen = &all->seen, o->surface.seen_most = OBSTACLES_SEEN;
        o->sided = has_sides(p, o);
    }
    obstacles_judge_sides(all, box, cell);
    return 0;
}

void obstacles_free(struct obstacles *all)
{
    for (int32_t k = 0; all->o && k < all->n; k++) surface_free(&all->o[k].surface);
    free(all->o);
    *all = (struct obstacles){ 0 };
}
