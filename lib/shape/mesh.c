/* shape/mesh.c: a tree of boxes over the elements of a surface, and the local minima of its distance
   from a point [shape/mesh.h]. */
#include "shape/mesh.h"

#include <stdlib.h>
#include <string.h>

int mesh_alloc(struct mesh *m, int32_t vertices, int32_t elements, struct failure *failure)
{
    mesh_free(m);
    m->vertex = calloc((size_t)vertices + 1, sizeof *m->vertex);
    m->element = calloc((size_t)elements + 1, sizeof *m->element);
    if (!m->vertex || !m->element) {
        mesh_free(m);
        return failure_set(failure, EX_SOFTWARE, "no memory for a mesh of %d elements", elements);
    }
    m->vertices = vertices, m->elements = elements;
    return 0;
}

void mesh_free(struct mesh *m)
{
    free(m->vertex), free(m->element);
    *m = (struct mesh){ 0 };
}

int mesh_grow(struct mesh *m, int32_t vertices, int32_t elements, vec3 **vertex,
              int32_t (**element)[3], struct failure *failure)
{
    if (vertices > INT32_MAX - m->vertices || elements > INT32_MAX - m->elements)
        return failure_set(failure, EX_SOFTWARE, "no memory for so many triangles");
    vec3 *v = realloc(m->vertex, ((size_t)m->vertices + (size_t)vertices + 1) * sizeof *v);
    if (v) m->vertex = v;
    int32_t(*e)[3] = realloc(m->element, ((size_t)m->elements + (size_t)elements + 1) * sizeof *e);
    if (e) m->element = e;
    if (!v || !e) return failure_set(failure, EX_SOFTWARE, "no memory for a mesh");
    *vertex = v + m->vertices, *element = e + m->elements;
    memset(*vertex, 0, (size_t)vertices * sizeof **vertex);
    m->vertices += vertices, m->elements += elements;
    return 0;
}

int mesh_copy(struct mesh *to, const struct mesh *from, struct failure *failure)
{
    *to = (struct mesh){ 0 };
    if (!from->elements) return 0;
    if (mesh_alloc(to, from->vertices, from->elements, failure)) return failure->status;
    memcpy(to->vertex, from->vertex, (size_t)from->vertices * sizeof *to->vertex);
    memcpy(to->element, from->element, (size_t)from->elements * sizeof *to->element);
    return 0;
}

int mesh_check(const struct mesh *m, int dim, struct failure *failure)
{
    for (int32_t i = 0; i < m->vertices; i++)
        if (!v3_finite(m->vertex[i]) || (dim == 2 && m->vertex[i].z != 0))
            return failure_set(failure, EX_DATAERR,
                               "vertex %d of the mesh: not finite, or not in the plane", i);
    for (int32_t i = 0; i < m->elements; i++) {
        const int32_t *e = m->element[i];
        for (int k = 0; k < 3; k++)
            if (e[k] < 0 || e[k] >= m->vertices)
                return failure_set(failure, EX_DATAERR, "element %d of the mesh: no such vertex",
                                   i);
        vec3 a = v3_sub(m->vertex[e[1]], m->vertex[e[0]]);
        vec3 b = v3_sub(m->vertex[e[2]], m->vertex[e[0]]);
        if ((dim == 2 && e[2] != e[1]) || !(v3_norm(dim == 2 ? a : v3_cross(a, b)) > 0))
            return failure_set(failure, EX_DATAERR, "element %d of the mesh: without an extent", i);
    }
    return 0;
}

/* ---- the tree ---- */

struct keyed {
    double key;
    int32_t element;
};

static int mesh_by_key(const void *a, const void *b)
{
    const struct keyed *p = a, *q = b;
    if (p->key != q->key) return p->key < q->key ? -1 : 1;
    return (p->element > q->element) - (p->element < q->element);
}

/* Makes the boxes of order[lo .. hi-1] from box `at` on; returns the index behind them. */
static int32_t mesh_grow_tree(struct surface *s, struct keyed *room, int32_t lo, int32_t hi,
                              int32_t at)
{
    struct surface_box *b = &s->box[at];
    b->lo = v3(INFINITY, INFINITY, INFINITY), b->hi = v3_scale(-1, b->lo);
    for (int32_t i = lo; i < hi; i++)
        for (int k = 0; k < 3; k++) {
            vec3 x = s->at[s->order[i]][k];
            b->lo = v3_min(b->lo, x), b->hi = v3_max(b->hi, x);
        }
    if (hi - lo <= SURFACE_LEAF) return b->next = at + 1;
    vec3 d = v3_sub(b->hi, b->lo);
    int axis = d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
    for (int32_t i = lo; i < hi; i++) {
        vec3 sum =
            v3_add(s->at[s->order[i]][0], v3_add(s->at[s->order[i]][1], s->at[s->order[i]][2]));
        room[i] = (struct keyed){ axis == 0 ? sum.x : axis == 1 ? sum.y : sum.z, s->order[i] };
    }
    qsort(room + lo, (size_t)(hi - lo), sizeof *room, mesh_by_key);
    for (int32_t i = lo; i < hi; i++) s->order[i] = room[i].element;
    int32_t middle = lo + (hi - lo) / 2;
    b->next = mesh_grow_tree(s, room, lo, middle, at + 1);
    return mesh_grow_tree(s, room, middle, hi, b->next);
}

/* ---- which elements meet at a corner ---- */

/* A corner, and where it lies along a direction that no plane of a drawing is across */
struct along {
    double key;
    int32_t corner;
};

static int by_along(const void *a, const void *b)
{
    const struct along *p = a, *q = b;
    if (p->key != q->key) return p->key < q->key ? -1 : 1;
    return (p->corner > q->corner) - (p->corner < q->corner);
}

/* The first of the corners that are one with c */
static int32_t mesh_first_of(int32_t *corner, int32_t c)
{
    while (corner[c] != c) c = corner[c] = corner[corner[c]];
    return c;
}

/* corner[c] = the first of the corners that are one with c, where all of them then lie */
static bool weld(struct surface *s)
{
    const vec3 direction = { 0.7548776662466927, 0.5698402909980532, 0.3247179572447460 };
    int32_t n = 3 * s->elements;
    struct along *p = malloc(((size_t)n + 1) * sizeof *p);
    if (!p) return false;
    for (int32_t c = 0; c < n; c++) {
        p[c] = (struct along){ v3_dot(direction, s->at[c / 3][c % 3]), c };
        s->corner[c] = c;
    }
    qsort(p, (size_t)n, sizeof *p, by_along);
    double reach = s->weld * v3_norm(direction);
    for (int32_t i = 0; i < n; i++)
        for (int32_t j = i - 1; j >= 0 && p[i].key - p[j].key <= reach; j--) {
            int32_t c = p[i].corner, d = p[j].corner;
            int32_t a = mesh_first_of(s->corner, c), b = mesh_first_of(s->corner, d);
            vec3 way = v3_sub(s->at[c / 3][c % 3], s->at[d / 3][d % 3]);
            if (a != b && v3_norm(way) <= s->weld) s->corner[a > b ? a : b] = a > b ? b : a;
        }
    free(p);
    for (int32_t c = 0; c < n; c++) {
        int32_t first = s->corner[c] = mesh_first_of(s->corner, c);
        s->at[c / 3][c % 3] = s->at[first / 3][first % 3];
    }
    return true;
}

/* Has element e still an extent? Of a triangle all corners differ, of a segment two. */
static bool extends(const struct surface *s, const struct mesh *m, int32_t first, int32_t e)
{
    const int32_t *c = &s->corner[3 * e], *v = m->element[first + e];
    bool segment = v[1] == v[2];
    return c[0] != c[1] && c[0] != c[2] && (segment || c[1] != c[2]);
}

/* star[] and member[], of the elements in order[] */
static void meet(struct surface *s)
{
    int32_t n = 3 * s->elements;
    for (int32_t i = 0; i < s->n; i++)
        for (int k = 0; k < 3; k++) s->star[s->corner[3 * s->order[i] + k] + 2]++;
    for (int32_t v = 0; v < n; v++) s->star[v + 2] += s->star[v + 1];
    // star[v+1] is now where v begins, and moves to where v ends
    for (int32_t i = 0; i < s->n; i++)
        for (int k = 0; k < 3; k++)
            s->member[s->star[s->corner[3 * s->order[i] + k] + 1]++] = s->order[i];
}

/* m: that of a surface for which none was asked */
static double usual_weld(const struct surface *s)
{
    vec3 lo = v3(INFINITY, INFINITY, INFINITY), hi = v3_scale(-1, lo);
    for (int32_t c = 0; c < 3 * s->elements; c++)
        lo = v3_min(lo, s->at[c / 3][c % 3]), hi = v3_max(hi, s->at[c / 3][c % 3]);
    return s->elements ? WELD_USUAL * v3_norm(v3_sub(hi, lo)) : 0;
}

static bool surface_alloc(struct surface *s)
{
    size_t n = (size_t)s->elements;
    s->at = malloc((n + 1) * sizeof *s->at);
    s->order = calloc(n + 1, sizeof *s->order);
    s->box = malloc((2 * n + 1) * sizeof *s->box);
    s->corner = calloc(3 * n + 1, sizeof *s->corner);
    s->star = calloc(3 * n + 2, sizeof *s->star);
    s->member = calloc(3 * n + 1, sizeof *s->member);
    return s->at && s->order && s->box && s->corner && s->star && s->member;
}

int surface_init(struct surface *s, const struct mesh *m, int32_t first, int32_t n, double weld_at,
                 struct failure *failure)
{
    *s = (struct surface){ .elements = n };
    struct keyed *room = malloc(((size_t)n + 1) * sizeof *room);
    bool good = room && surface_alloc(s);
    for (int32_t i = 0; good && i < n; i++)
        for (int k = 0; k < 3; k++) s->at[i][k] = m->vertex[m->element[first + i][k]];
    if (good) s->weld = weld_at > 0 ? weld_at : usual_weld(s);
    good = good && weld(s);
    for (int32_t i = 0; good && i < n; i++)
        if (extends(s, m, first, i)) s->order[s->n++] = i;
    if (good) meet(s), mesh_grow_tree(s, room, 0, s->n, 0);
    free(room);
    for (int32_t v = 0; good && v < 3 * n; v++)
        if (s->star[v + 1] - s->star[v] > STAR_MOST)
            return failure_set(failure, EX_DATAERR,
                               "a mesh: more than %d elements meet at a corner", STAR_MOST);
    return good ? 0
                : failure_set(failure, EX_SOFTWARE, "no memory for a surface of %d elements", n);
}

void surface_free(struct surface *s)
{
    free(s->at), free(s->order), free(s->box), free(s->corner), free(s->star), free(s->member);
    *s = (struct surface){ 0 };
}

/* ---- distances ---- */

/* The nearest place of an element, and which part of it: below 3 the edge from that corner, below 6
   a corner, 6 the inside */
struct mesh_place {
    vec3 x;
    int part;
};

static struct mesh_place mesh_near_segment(vec3 a, vec3 b, vec3 c)
{
    vec3 ab = v3_sub(b, a);
    double s = v3_dot(v3_sub(c, a), ab), most = v3_dot(ab, ab);
    if (s <= 0) return (struct mesh_place){ a, 3 };
    if (s >= most) return (struct mesh_place){ b, 4 };
    return (struct mesh_place){ v3_axpy(a, s / most, ab), 6 };
}

/* By the regions of Voronoi [Ericson 2005, Real-Time Collision Detection, 5.1.5] */
static struct mesh_place mesh_near_triangle(vec3 a, vec3 b, vec3 c, vec3 p)
{
    vec3 ab = v3_sub(b, a), ac = v3_sub(c, a), ap = v3_sub(p, a);
    double d1 = v3_dot(ab, ap), d2 = v3_dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return (struct mesh_place){ a, 3 };
    vec3 bp = v3_sub(p, b), cp = v3_sub(p, c);
    double d3 = v3_dot(ab, bp), d4 = v3_dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return (struct mesh_place){ b, 4 };
    double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0)
        return (struct mesh_place){ v3_axpy(a, d1 / (d1 - d3), ab), 0 };
    double d5 = v3_dot(ab, cp), d6 = v3_dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return (struct mesh_place){ c, 5 };
    double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0)
        return (struct mesh_place){ v3_axpy(a, d2 / (d2 - d6), ac), 2 };
    double va = d3 * d6 - d5 * d4, along = (d4 - d3) + (d5 - d6);
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
        return (struct mesh_place){ v3_axpy(b, (d4 - d3) / along, v3_sub(c, b)), 1 };
    double sum = va + vb + vc;
    return (struct mesh_place){ v3_axpy(v3_axpy(a, vb / sum, ab), vc / sum, ac), 6 };
}

static struct mesh_place near_element(const struct surface *s, int32_t e, vec3 c)
{
    const vec3 *x = s->at[e];
    if (s->corner[3 * e + 1] == s->corner[3 * e + 2]) return mesh_near_segment(x[0], x[1], c);
    return mesh_near_triangle(x[0], x[1], x[2], c);
}

/* Which corner of element e is vertex v; -1: none */
static int which_corner(const struct surface *s, int32_t e, int32_t v)
{
    for (int k = 0; k < 3; k++)
        if (s->corner[3 * e + k] == v) return k;
    return -1;
}

/* Is `part` of element e on the edge of the corners v and w, or for w = v at that corner? */
static bool mesh_is_there(const struct surface *s, int32_t e, int part, int32_t v, int32_t w)
{
    if (part == 6) return false;
    const int32_t *corner = &s->corner[3 * e];
    if (part >= 3) return corner[part - 3] == v || corner[part - 3] == w;
    int32_t from = corner[part], to = corner[(part + 1) % 3];
    return v != w && ((from == v && to == w) || (from == w && to == v));
}

/* Whether the place on an edge or at a corner of element e is a minimum that e reports, the first of
   those that meet there */
static bool is_minimum(const struct surface *s, int32_t e, int part, vec3 c, int *looked)
{
    int k = part < 3 ? part : part - 3;
    int32_t v = s->corner[3 * e + k], w = part < 3 ? s->corner[3 * e + (k + 1) % 3] : v;
    // at the hub of a fan is all of it
    if (s->star[w + 1] - s->star[w] < s->star[v + 1] - s->star[v]) {
        int32_t hub = v;
        v = w, w = hub;
    }
    for (int32_t i = s->star[v]; i < s->star[v + 1]; i++) {
        int32_t other = s->member[i];
        ++*looked;
        if (other == e || which_corner(s, other, w) < 0) continue;
        struct mesh_place at = near_element(s, other, c);
        if (!mesh_is_there(s, other, at.part, v, w)) return false;
        if (other < e) return false;
    }
    return true;
}

vec3 surface_normal(const struct surface *s, int32_t e)
{
    const vec3 *x = s->at[e];
    vec3 ab = v3_sub(x[1], x[0]), up = v3_cross(ab, v3_sub(x[2], x[0]));
    if (s->corner[3 * e + 1] == s->corner[3 * e + 2]) up = v3(-ab.y, ab.x, 0);
    return v3_scale(1 / v3_norm(up), up);
}

vec3 surface_nearest(const struct surface *s, int32_t e, vec3 c)
{
    return near_element(s, e, c).x;
}

/* Returns how many elements were looked at for it, of those at its corners each. */
static int mesh_look_at(const struct surface *s, int32_t e, vec3 c, double most,
                        struct touch *touch, int *n)
{
    struct mesh_place at = near_element(s, e, c);
    vec3 d = v3_sub(c, at.x);
    double distance = v3_norm(d);
    int looked = 1;
    if (!(distance <= most)) return looked;
    bool minimum = at.part == 6 || is_minimum(s, e, at.part, c, &looked);
    if (!minimum || *n == TOUCHES_MOST) return looked;
    struct touch *t = &touch[(*n)++];
    *t = (struct touch){ .distance = distance, .feature = SURFACE_FEATURES * e + at.part };
    vec3 up = surface_normal(s, e); // where d is rounding
    t->n = distance > s->weld  ? v3_scale(1 / distance, d)
           : v3_dot(up, d) < 0 ? v3_scale(-1, up)
                               : up;
    return looked;
}

static int by_feature(const void *a, const void *b)
{
    const struct touch *p = a, *q = b;
    return (p->feature > q->feature) - (p->feature < q->feature);
}

bool surface_is_at(const struct surface *s, vec3 c, const vec3 *n, double near)
{
    struct surface_walk walk;
    struct surface_branch leaf;
    surface_walk_begin(&walk, s->n);
    while (surface_walk_next(&walk, s->box, c, near, &leaf))
        for (int32_t i = leaf.lo; i < leaf.hi; i++)
            if (v3_norm(v3_sub(c, surface_nearest(s, s->order[i], c))) <= near &&
                (!n || fabs(v3_dot(*n, surface_normal(s, s->order[i]))) > 1 - 1e-6))
                return true;
    return false;
}

/* Leaves the first of those at one place; returns how many are left. */
static int leave_one(const struct surface *s, struct touch *touch, int n)
{
    int kept = 0;
    for (int k = 0; k < n; k++) {
        bool again = false;
        for (int l = 0; l < kept && !again; l++)
            again = v3_dot(touch[l].n, touch[k].n) > 1 - 1e-12 &&
                    fabs(touch[l].distance - touch[k].distance) <= s->weld;
        if (!again) touch[kept++] = touch[k];
    }
    return kept;
}

int surface_touches(const struct surface *s, vec3 c, double most, struct touch touch[TOUCHES_MOST])
{
    struct surface_walk walk;
    struct surface_branch leaf;
    int n = 0;
    surface_walk_begin(&walk, s->n);
    int64_t seen = 0;
    if (s->seen && *s->seen > s->seen_most) return 0;
    while (surface_walk_next(&walk, s->box, c, most, &leaf))
        for (int32_t i = leaf.lo; i < leaf.hi; i++)
            seen += mesh_look_at(s, s->order[i], c, most, touch, &n);
    if (s->seen) *s->seen += seen;
    qsort(touch, (size_t)n, sizeof *touch, by_feature);
    return leave_one(s, touch, n);
}

void mesh_box(const struct mesh *m, vec3 *lo, vec3 *hi)
{
    *lo = v3(INFINITY, INFINITY, INFINITY), *hi = v3_scale(-1, *lo);
    for (int32_t i = 0; i < m->elements; i++)
        for (int k = 0; k < 3; k++) {
            *lo = v3_min(*lo, m->vertex[m->element[i][k]]);
            *hi = v3_max(*hi, m->vertex[m->element[i][k]]);
        }
}
