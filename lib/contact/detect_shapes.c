#include "contact/detect_shapes.h"

#include "shape/meet.h"
#include "shape/mesh.h"
#include "shape/wall_edge.h"

#include <stdlib.h>
#include <string.h>

enum {
    CORNERS = 256,     /* of a body that are near a wall, at most: of more the first */
    RIM_KEY = 1 << 30, /* features of rims; with RIM_END of their ends */
    MOVED_MOST = 256   /* corners of a body that is met as an image without memory of its own */
};

static bool detect_shapes_add(struct contacts *out, const struct placed *s, int32_t a, int32_t b,
                              const int8_t shift[3], const struct place *place)
{
    const struct packing *p = s->p;
    struct contact *c = contacts_add(out, a, b);
    if (!c) return false;
    vec3 n = place->n;
    if (p->dim == 2) n.z = 0;
    contact_basis(c, p->dim, n);
    c->gap = place->gap, c->x = place->x, c->feature = place->feature;
    for (int k = 0; k < 3; k++) c->shift[k] = shift[k];
    packing_set_law(p, c);
    contacts_settle(out);
    return true;
}

/* The core moved; room[n] is used where it has more than one vertex. */
static struct core moved(struct core c, vec3 away, vec3 *room)
{
    for (int32_t i = 0; i < c.n; i++) room[i] = v3_add(c.v[i], away);
    c.v = room, c.centre = v3_add(c.centre, away);
    return c;
}

/* Do the balls around two bodies, and those of a clump, come near? */
static bool detect_shapes_apart(const struct core *a, const struct core *b, double ra, double rb,
                                double gap)
{
    vec3 d = v3_sub(b->centre, a->centre);
    double most = ra + rb + gap;
    return v3_dot(d, d) > most * most * (1 + 1e-12);
}

static bool meet_pair(struct contacts *out, const struct placed *s, const struct pair *pair,
                      vec3 away, double gap, vec3 *room)
{
    const struct packing *p = s->p;
    const int32_t a = pair->a, b = pair->b;
    int32_t as = placed_cores(s, a), bs = placed_cores(s, b);
    bool image = away.x != 0 || away.y != 0 || away.z != 0, whole = as == 1 && bs == 1;
    for (int32_t i = 0; i < as; i++)
        for (int32_t j = 0; j < bs; j++) {
            struct core ca = placed_core(s, a, i), cb = placed_core(s, b, j);
            struct place place[PLACES_MOST];
            if (image) cb = moved(cb, away, room);
            if (detect_shapes_apart(&ca, &cb, as > 1 ? ca.round : p->radius[a],
                                    bs > 1 ? cb.round : p->radius[b], gap))
                continue;
            int n = meet_cores(p->dim, &ca, &cb, gap, place);
            for (int k = 0; k < n; k++) {
                if (!whole) place[k].feature = (i * bs + j) * PLACES_MOST + k;
                if (!detect_shapes_add(out, s, a, b, pair->shift, &place[k])) return false;
            }
        }
    return true;
}

bool detect_shapes_pair(struct contacts *out, const struct placed *s, const struct pair *pair,
                        vec3 away, double gap)
{
    vec3 few[MOVED_MOST];
    const struct shape *shape = packing_shape(s->p, pair->b);
    if (!shape || shape->vertices <= MOVED_MOST) return meet_pair(out, s, pair, away, gap, few);
    vec3 *many = malloc((size_t)shape->vertices * sizeof *many);
    bool good = many && meet_pair(out, s, pair, away, gap, many);
    free(many);
    return good;
}

/* ---- walls ---- */

/* A body and a wall, whose contacts are sought */
struct facing {
    const struct placed *s;
    int64_t i;
    const struct wall *wall;
    const struct surface *surface; /* of a mesh, else NULL */
    struct pose pose;              /* of the wall */
    double gap;                    /* m: the largest */
};

/* Where x (m) is for the wall as it is described */
static vec3 detect_shapes_described(const struct facing *o, vec3 x)
{
    return v3_sub(quat_turn_back(o->pose.q, v3_sub(x, o->pose.shift)), o->wall->x);
}

/* m: of the body and the gap around it */
static double reach_of(const struct facing *o)
{
    return o->s->p->radius[o->i] + fmax(o->gap, 0);
}

/* Is the place t of the end of a wall below a corner, to its weld tolerance? The normal of t is then that of
   the face: two walls may end there in one flat surface. */
static bool detect_shapes_over_face(const struct wall *wall, const struct surface *surface,
                                    struct touch *t)
{
    vec3 n = wall->n, d = v3_scale(t->distance, t->n);
    double near = 2 * WELD_USUAL * wall_reach(wall);
    if (surface) n = surface_normal(surface, t->feature / SURFACE_FEATURES), near = surface->weld;
    if (!surface && (wall->weld > 0 || wall->shape != WALL_RECTANGLE)) near = wall->weld;
    double height = v3_dot(d, n);
    if (!(v3_norm(v3_axpy(d, -height, n)) <= near)) return false;
    t->n = height < 0 ? v3_scale(-1, n) : n, t->distance = fabs(height);
    return true;
}

/* Of the radius: a corner there is the same place */
static const double SAME_PLACE = 1e-3;

/* A corner c (m, from the wall's point of reference) and the middle of its body */
struct detect_shapes_corner {
    const struct wall *wall;
    const struct surface *surface;
    int dim;
    vec3 c, middle;
};

static bool is_between(const struct detect_shapes_corner *o, vec3 a, vec3 b)
{
    return wall_between(o->wall, o->dim, o->surface, a, b);
}

/* Has the corner gone through the wall at t? Its normal then leads to the middle, and it is at a negative
   distance. */
static void turn_to_middle(const struct detect_shapes_corner *o, struct touch *t)
{
    if (v3_dot(t->n, v3_sub(o->middle, v3_axpy(o->c, -t->distance, t->n))) >= 0) return;
    t->n = v3_scale(-1, t->n), t->distance *= -1;
}

/* Is the corner on the side of the middle at t, or has it gone through there? At an end neither may be. */
static bool is_before(const struct detect_shapes_corner *o, const struct touch *t)
{
    vec3 place = v3_axpy(o->c, -t->distance, t->n);
    return v3_dot(t->n, v3_sub(o->middle, place)) >= 0 || is_between(o, o->middle, o->c);
}

/* The corner has gone through a surface: where it is nearest. Of its other places those remain that are seen from
   just before there, turned if it has gone through them, too. Returns how many remain. */
static int turn_touches(const struct detect_shapes_corner *o, struct touch *t, int n, double radius)
{
    int nearest = 0, kept = 0;
    for (int k = 1; k < n; k++)
        if (fabs(t[k].distance) < fabs(t[nearest].distance)) nearest = k;
    if (!n) return 0;
    turn_to_middle(o, &t[nearest]);
    double before = 2 * o->surface->weld + SAME_PLACE * SAME_PLACE * radius;
    vec3 from = v3_axpy(o->c, before - t[nearest].distance, t[nearest].n);
    bool through = is_between(o, o->middle, from);
    for (int k = 0; k < n; k++) {
        vec3 place = v3_axpy(o->c, -t[k].distance, t[k].n);
        vec3 to = v3_axpy(place, SAME_PLACE, v3_sub(o->c, place));
        if (k != nearest && is_between(o, from, to)) continue;
        if (k != nearest && through) turn_to_middle(o, &t[k]);
        t[kept++] = t[k];
    }
    return kept;
}

/* Where a corner v of the body, rounded by `round` (m), meets the surface; n points to the body's side. Where the
   wall ends or bends only what is round meets it by its corners: of sharp bodies, edges and faces meet rims
   [meet_rims()]. Returns how many places. */
static int near_surface(const struct facing *face, vec3 v, double round,
                        struct touch touch[TOUCHES_MOST])
{
    const struct packing *p = face->s->p;
    const struct wall *wall = face->wall;
    const struct surface *surface = face->surface;
    vec3 c = detect_shapes_described(face, v),
         middle = detect_shapes_described(face, face->s->x[face->i]);
    double r = p->radius[face->i];
    int n = surface ? surface_touches(surface, c, round + face->gap + r, touch)
                    : wall_nearest(wall, p->dim, c, r, touch);
    struct touch found[TOUCHES_MOST];
    struct grooves grooves;
    const struct detect_shapes_corner o = { wall, surface, p->dim, c, middle };
    const bool through = surface && n > 0 && is_between(&o, middle, c);
    int kept = 0;
    grooves.n = 0;
    memcpy(found, touch, (size_t)n * sizeof *touch);
    for (int k = 0; k < n && kept < TOUCHES_MOST; k++) {
        struct touch *t = &touch[kept], *f = &found[k];
        bool end = wall_ends_at(wall, p->dim, surface, c, f);
        if (round == 0 && end && !(detect_shapes_over_face(wall, surface, f) && is_before(&o, f)))
            continue;
        if (round == 0 && surface && surface_bends(surface, p->dim, f->feature)) {
            if (through) surface_groove(&grooves, surface, p->dim, f, c, middle);
            continue;
        }
        *t = *f, kept++;
        bool two_sided =
            wall->side == WALL_BOTH || wall->shape == WALL_RECTANGLE || wall->shape == WALL_DISC;
        if (!surface && two_sided && (!end || round == 0) && is_between(&o, middle, c))
            turn_to_middle(&o, t);
    }
    if (through) kept = turn_touches(&o, touch, kept, r);
    for (int k = 0; k < grooves.n && kept < TOUCHES_MOST; k++) touch[kept++] = grooves.touch[k];
    for (int k = 0; k < kept; k++) touch[k].n = quat_turn(face->pose.q, touch[k].n);
    return kept;
}

/* The outside of a sphere or an endless cylinder, as the core of a ball or capsule with ends v; false: no such
   wall */
static bool convex_wall(const struct facing *o, vec3 v[2], struct core *c)
{
    const struct packing *p = o->s->p;
    const struct wall *wall = o->wall;
    if (wall->side != WALL_OUTSIDE || wall->arc > 0) return false;
    bool ball = wall->shape == WALL_SPHERE || (wall->shape == WALL_CYLINDER && p->dim == 2);
    bool tube = wall->shape == WALL_CYLINDER && p->dim == 3 && wall->size[2] == 0;
    if (!ball && !tube) return false;
    vec3 x = pose_of(&o->pose, wall->x), n = quat_turn(o->pose.q, wall->n);
    double along = v3_dot(n, v3_sub(o->s->x[o->i], x)), reach = 2 * reach_of(o);
    v[0] = tube ? v3_axpy(x, along - reach, n) : x, v[1] = v3_axpy(x, along + reach, n);
    *c = (struct core){ .n = tube ? 2 : 1, .v = v, .round = wall->size[0] };
    c->centre = tube ? v3_axpy(x, along, n) : x;
    return true;
}

static bool meet_convex(struct contacts *out, const struct placed *s, int32_t w, int64_t i,
                        const struct core *wall_core, double gap)
{
    static const int8_t none[3] = { 0, 0, 0 };
    int32_t cores = placed_cores(s, i);
    for (int32_t k = 0; k < cores; k++) {
        struct core c = placed_core(s, i, k);
        struct place place[PLACES_MOST];
        int n = meet_cores(s->p->dim, wall_core, &c, gap, place);
        for (int l = 0; l < n; l++) {
            if (cores > 1) place[l].feature = k * PLACES_MOST + l;
            place[l].x = v3_axpy(place[l].x, -0.5 * place[l].gap, place[l].n); // on the surface
            if (!detect_shapes_add(out, s, -1 - w, (int32_t)i, none, &place[l])) return false;
        }
    }
    return true;
}

/* 1 - cosine: of two normals that are one */
static const double ALONG = 1e-12;
/* Sine: a face that lies on a surface to this is next to its rim, too */
static const double ALONG_SURFACE = 1e-3;

/* The part of a rim within reach of x, in space; returns its ends, 0: none. */
static int place_rim(const struct facing *o, const struct rim *r, vec3 x, vec3 v[2], bool cut[2])
{
    const double reach = reach_of(o);
    for (int k = 0; k < r->n; k++) v[k] = pose_of(&o->pose, v3_add(o->wall->x, r->v[k]));
    cut[0] = cut[1] = false;
    if (r->n == 1) return 1;
    vec3 a = v[0], d = v3_sub(v[1], a), w = v3_sub(x, a);
    double length2 = v3_dot(d, d), middle = v3_dot(w, d) / length2;
    double half2 = reach * reach - v3_dot(w, w) + middle * middle * length2;
    double half = half2 > 0 ? sqrt(half2 / length2) : 0;
    double lo = fmax(middle - half, 0), hi = fmin(middle + half, 1);
    if (!(lo < hi)) return 0;
    cut[0] = lo > 0, cut[1] = hi < 1;
    if (cut[0]) v[0] = v3_axpy(a, lo, d);
    if (cut[1]) v[1] = v3_axpy(a, hi, d);
    return 2;
}

/* Does n, from the rim to a body, lead into none of the surfaces that meet there? */
static bool leads_away(const struct rim *r, const struct pose *pose, vec3 n)
{
    for (int k = 0; k < r->sides; k++)
        if (v3_dot(quat_turn(pose->q, r->into[k]), n) > ALONG_SURFACE) return false;
    return true;
}

/* Is one of place[n] where f is? Of other rims, those beyond the first `corners`, with the same normal */
static bool detect_shapes_is_there(const struct place *place, int corners, int n,
                                   const struct place *f, double near)
{
    for (int k = 0; k < n; k++) {
        vec3 d = v3_sub(place[k].x, f->x);
        if (v3_dot(d, d) < near * near && (k < corners || v3_dot(place[k].n, f->n) > 1 - ALONG))
            return true;
    }
    return false;
}

/* Does the surface go on flat beyond the place x of a rim? Its triangles do not share their corners there. */
static bool detect_shapes_goes_on(const struct facing *o, const struct rim *r, vec3 x,
                                  double beyond)
{
    const struct surface *surface = o->surface;
    if (!surface) return false;
    vec3 c = detect_shapes_described(o, x);
    double step = fmax(beyond, 10 * surface->weld);
    for (int k = 0; k < r->sides; k++)
        if (!surface_is_at(surface, v3_axpy(c, -step, r->into[k]), NULL, 2 * surface->weld))
            return false;
    return true;
}

/* Adds where the rims of the wall meet the body's core and no corner does; returns how many places there are. */
static int meet_rims(const struct facing *o, const struct core *c, struct place *place, int count)
{
    const struct packing *p = o->s->p;
    struct rims rims;
    double near = SAME_PLACE * p->radius[o->i];
    vec3 at = detect_shapes_described(o, c->centre);
    const int corners = count;
    rims_near(&rims, o->wall, p->dim, o->surface, at, reach_of(o));
    for (int k = 0; k < rims.n; k++) {
        const struct rim *r = &rims.rim[k];
        vec3 v[2];
        bool cut[2];
        struct place found[PLACES_MOST];
        struct core line = { .n = place_rim(o, r, c->centre, v, cut), .v = v };
        if (!line.n) continue;
        line.centre = v3_scale(0.5, v3_add(v[0], v[line.n - 1]));
        int n = meet_cores(p->dim, &line, c, o->gap, found);
        for (int l = 0; l < n && count < CORNERS; l++) {
            struct place *f = &found[l];
            if (!leads_away(r, &o->pose, f->n)) continue;
            f->x = v3_axpy(f->x, -0.5 * f->gap, f->n); // on the rim
            if (detect_shapes_is_there(place, corners, count, f, near)) continue;
            if (detect_shapes_goes_on(o, r, f->x, near)) continue;
            int end = p->dim == 2 ? 0 : meet_end(f);
            f->feature = end >= 0 && !cut[end] ? RIM_KEY | RIM_END | r->corner[end]
                                               : RIM_KEY | (r->key % (RIM_END / 4) * 4 + l);
            place[count++] = *f;
        }
    }
    return count;
}

bool detect_shapes_wall(struct contacts *out, const struct situation *all, int32_t w, int64_t i,
                        double gap)
{
    static const int8_t none[3] = { 0, 0, 0 };
    const struct packing *p = all->p;
    const struct placed *s = all->shaped;
    const struct wall *wall = &p->wall[w];
    struct facing o = { s, i, wall, situation_surface(all, w), wall_pose(p, wall, all->t), gap };
    bool plane = wall->shape == WALL_PLANE;
    vec3 at = wall_at(p, wall, all->t), n = wall_normal(p, wall, all->t), ends[2];
    struct core wall_core;
    if (plane && v3_dot(v3_sub(s->x[i], at), n) > reach_of(&o)) return true;
    if (convex_wall(&o, ends, &wall_core)) return meet_convex(out, s, w, i, &wall_core, gap);
    struct place place[CORNERS];
    int count = 0;
    int32_t cores = placed_cores(s, i);
    for (int32_t k = 0; k < cores; k++) {
        const struct core c = placed_core(s, i, k);
        for (int32_t l = 0; l < c.n; l++) {
            struct touch touch[TOUCHES_MOST];
            int touches = 1;
            if (plane)
                touch[0] = (struct touch){ n, v3_dot(v3_sub(c.v[l], at), n), 0 };
            else
                touches = near_surface(&o, c.v[l], c.round, touch);
            for (int m = 0; m < touches && count < CORNERS; m++) {
                if (!(touch[m].distance - c.round <= gap)) continue;
                uint32_t key = (uint32_t)touch[m].feature * (uint32_t)(cores > 1 ? cores : c.n) +
                               (uint32_t)(cores > 1 ? k : l);
                place[count++] =
                    (struct place){ v3_axpy(c.v[l], -touch[m].distance, touch[m].n), touch[m].n,
                                    touch[m].distance - c.round, (int32_t)(key % RIM_END) };
            }
        }
    }
    const struct core c = placed_core(s, i, 0);
    if (cores == 1 && !plane && (c.hull || c.n == 2)) count = meet_rims(&o, &c, place, count);
    if (cores == 1 && plane) count = meet_few(place, count);
    for (int k = 0; k < count; k++)
        if (!detect_shapes_add(out, s, -1 - w, (int32_t)i, none, &place[k])) return false;
    return true;
}
