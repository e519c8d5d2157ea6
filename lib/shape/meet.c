/* shape/meet.c: separating axes, and faces clipped to faces [shape/meet.h]. */
#include "shape/meet.h"

#include "shape/gjk.h"

#include <stdlib.h>

enum {
    CORNERS_MOST =
        520, /* of two faces while one is clipped: of larger ones some corners are left out */
    /* Features: what met, in the bits above those that tell which */
    BY_CORNER = 0,
    BY_SIDES = 1 << 26, /* an edge of one face over a side of the other */
    BY_REFERENCE = 2 << 26,
    BY_EDGES = 3 << 26,
    BY_NEAREST = 6 << 26,
    OF_B = 7 << 26, /* added where the face is b's */
    BITS = 12
};

/* Of the size: edges must be better by more than faces, which hold a body in several places, and faces
   of b than those of a, so that which it is lasts. What overlaps at rest does so by 1e-4. */
static const double FACE_FIRST = 1e-3, A_FIRST = 1e-4;
static const double PARALLEL = 1e-6; /* sine^2 of two edges that have no axis */
static const double ALONG = 1e-6;    /* 1 - cosine: the shortest way is along a face's normal */
static const double NEARLY_ACROSS = 2e-2; /* cosine: an edge that lies across the shortest way */
static const double APART = 1e-9;         /* of the size: a distance that is one */

/* Two cores, and how far apart places of theirs may be */
struct two {
    int dim;
    const struct core *a, *b;
    double reach; /* m: the largest gap */
};

/* The best axis so far */
struct axis {
    enum { AXIS_NONE, AXIS_FACE_A, AXIS_FACE_B, AXIS_EDGES } by;
    int32_t i, j; /* the face; the edges */
    vec3 n;       /* from a to b */
    double gap;   /* m: between the cores */
};

static int32_t faces_of(const struct core *c, int dim)
{
    return !c->hull ? 0 : dim == 2 ? c->n : c->hull->faces;
}

/* A corner of face f; in the plane a side has two. */
static int32_t corner_of(const struct core *c, int dim, int32_t f, int32_t k)
{
    const struct shape *s = c->hull;
    if (dim == 2) return s->corner[(f + k) % s->corners];
    return s->corner[s->first[f] + k];
}

static int32_t corners_of(const struct core *c, int dim, int32_t f)
{
    return dim == 2 ? 2 : c->hull->first[f + 1] - c->hull->first[f];
}

/* The face of c from which the other is farthest; false: one is farther than `most`. */
static bool try_faces(struct axis *best, const struct core *c, const struct core *other, int dim,
                      double most, bool b)
{
    for (int32_t f = 0; f < faces_of(c, dim); f++) {
        vec3 n = c->normal[f];
        double gap = core_bottom(other, n) - v3_dot(n, c->v[corner_of(c, dim, f, 0)]);
        if (gap > most) return false;
        if (best->by == AXIS_NONE || gap > best->gap)
            *best =
                (struct axis){ b ? AXIS_FACE_B : AXIS_FACE_A, f, 0, b ? v3_scale(-1, n) : n, gap };
    }
    return true;
}

/* The arc of an edge on the unit sphere, between the normals of its faces, and its direction */
struct arc {
    vec3 p, q, along;
    int32_t edge;
};
enum { ARCS = 64 }; /* of b at a time */

static struct arc arc_of(const struct core *c, int32_t i, double sign)
{
    const struct shape_edge *e = &c->hull->edge[i];
    const vec3 p = v3_scale(sign, c->normal[e->left]), q = v3_scale(sign, c->normal[e->right]);
    return (struct arc){ p, q, v3_cross(q, p), i };
}

/* Do the arcs of two edges cross, of which b's is mirrored? */
static bool arcs_cross(const struct arc *a, const struct arc *b)
{
    const double pa = v3_dot(b->p, a->along), qa = v3_dot(b->q, a->along);
    if (!(pa * qa < 0)) return false;
    const double pb = v3_dot(a->p, b->along), qb = v3_dot(a->q, b->along);
    return pb * qb < 0 && pa * qb > 0;
}

/* m: of the faces of a hull from its centre, the least; below 0: that is outside */
static double inner(const struct core *c)
{
    double least = INFINITY;
    for (int32_t f = 0; f < c->hull->faces; f++) {
        const vec3 corner = c->v[corner_of(c, 3, f, 0)];
        least = fmin(least, v3_dot(c->normal[f], v3_sub(corner, c->centre)));
    }
    return least;
}

/* Along n hulls are as far apart as their centres less what both have on the way, their inner radii at least. So none of the axes
   of an edge that looks away is the best one, unless all overlap by more; ahead: from a's centre to b's, or 0 then. */
static vec3 meet_ahead(const struct core *a, const struct core *b, double at_least)
{
    const double of_a = inner(a), of_b = inner(b);
    const bool counts = of_a > 0 && of_b > 0 && at_least > -(of_a + of_b);
    return counts ? v3_sub(b->centre, a->centre) : v3(0, 0, 0);
}

static bool looks_away(const struct arc *e, vec3 ahead)
{
    return v3_dot(e->p, ahead) < 0 && v3_dot(e->q, ahead) < 0;
}

/* Edges of b from *next on that do not look away, mirrored, ARCS at most */
static int take_arcs(struct arc to[ARCS], const struct core *b, vec3 ahead, int32_t *next)
{
    int n = 0;
    for (; *next < b->hull->edges && n < ARCS; ++*next) {
        to[n] = arc_of(b, *next, -1);
        n += !looks_away(&to[n], ahead);
    }
    return n;
}

/* The axis of two edges whose arcs cross; false: the hulls are farther apart than `most`. */
static bool try_axis(struct axis *best, const struct core *a, const struct core *b, int32_t i,
                     int32_t j, double at_least, double most)
{
    const struct shape_edge *e = &a->hull->edge[i], *f = &b->hull->edge[j];
    const vec3 x = a->v[e->tail], y = b->v[f->tail];
    const vec3 d = v3_sub(a->v[e->head], x), g = v3_sub(b->v[f->head], y);
    vec3 n = v3_cross(d, g);
    const double n2 = v3_dot(n, n);
    if (n2 < PARALLEL * v3_dot(d, d) * v3_dot(g, g)) return true;
    n = v3_scale(1 / sqrt(n2), n);
    if (v3_dot(n, v3_sub(x, a->centre)) < 0) n = v3_scale(-1, n);
    const double gap = v3_dot(n, v3_sub(y, x));
    if (gap > at_least && gap > best->gap) *best = (struct axis){ AXIS_EDGES, i, j, n, gap };
    return !(gap > most);
}

static bool try_edges(struct axis *best, const struct core *a, const struct core *b,
                      double handicap, double most)
{
    const double at_least = best->gap + handicap;
    const vec3 ahead = meet_ahead(a, b, at_least);
    struct arc of_b[ARCS];
    for (int32_t next = 0, n; next < b->hull->edges;) {
        n = take_arcs(of_b, b, ahead, &next);
        for (int32_t i = 0; i < a->hull->edges; i++) {
            const struct arc of_a = arc_of(a, i, 1);
            if (looks_away(&of_a, ahead)) continue;
            for (int32_t k = 0; k < n; k++)
                if (arcs_cross(&of_a, &of_b[k]) &&
                    !try_axis(best, a, b, i, of_b[k].edge, at_least, most))
                    return false;
        }
    }
    return true;
}

/* A segment and the edges of a hull: its arc on the unit sphere is a whole circle. of_a: it is a's. */
static bool try_segment(struct axis *best, const struct core *segment, const struct core *hull,
                        bool of_a, double handicap, double most)
{
    double at_least = best->gap + handicap;
    vec3 x = segment->v[0], d = v3_sub(segment->v[1], x);
    for (int32_t i = 0; i < hull->hull->edges; i++) {
        const struct shape_edge *e = &hull->hull->edge[i];
        vec3 p = hull->normal[e->left], q = hull->normal[e->right], y = hull->v[e->tail];
        double pd = v3_dot(p, d), qd = v3_dot(q, d);
        if (!(pd * qd < 0)) continue;
        vec3 out = v3_add(v3_scale(fabs(qd), p), v3_scale(fabs(pd), q));
        vec3 edge = v3_sub(hull->v[e->head], y), across = v3_cross(edge, d);
        if (v3_dot(across, across) < PARALLEL * v3_dot(edge, edge) * v3_dot(d, d)) continue;
        out = v3_scale(1 / v3_norm(out), out);
        double gap = v3_dot(out, v3_sub(x, y));
        if (gap > most) return false;
        if (gap > at_least && gap > best->gap)
            *best = of_a ? (struct axis){ AXIS_EDGES, 0, i, v3_scale(-1, out), gap }
                         : (struct axis){ AXIS_EDGES, i, 0, out, gap };
    }
    return true;
}

/* ---- places ---- */

/* A corner of a face while it is clipped, and what the edge that begins there is: an edge of the
   face (>= 0), or side -1 - k of the other */
struct clipped {
    vec3 x;
    int32_t feature, edge;
};

/* Where an edge leaves or enters: its own edge over a side, or a corner of the reference */
static int32_t crossing(int32_t edge, int32_t side)
{
    if (edge >= 0) return BY_SIDES | edge << BITS | side;
    int32_t other = -1 - edge;
    return BY_REFERENCE | (other < side ? other << BITS | side : side << BITS | other);
}

/* What is left of a polygon (or of a segment, n = 2) where m . x <= at */
static int meet_clip(struct clipped *to, const struct clipped *from, int n, vec3 m, double at,
                     int32_t side)
{
    int count = 0;
    for (int k = 0; k < n && count < CORNERS_MOST - 2; k++) {
        const struct clipped *p = &from[k], *q = &from[(k + 1) % n];
        double dp = v3_dot(m, p->x) - at, dq = v3_dot(m, q->x) - at;
        if (dp <= 0) to[count++] = *p;
        if (n == 2 && k == 1) break; // a segment has one edge
        if (n == 1 || (dp <= 0) == (dq <= 0)) continue;
        vec3 x = v3_axpy(p->x, dp / (dp - dq), v3_sub(q->x, p->x));
        // going out the edge along the side begins here, coming in the rest of this one
        to[count++] = (struct clipped){ x, crossing(p->edge, side), dp <= 0 ? -1 - side : p->edge };
    }
    return count;
}

/* The corner of c that is farthest against n */
static int32_t lowest(const struct core *c, vec3 n)
{
    int32_t low = 0;
    double least = INFINITY;
    for (int32_t i = 0; i < c->n; i++)
        if (v3_dot(n, c->v[i]) < least) least = v3_dot(n, c->v[i]), low = i;
    return low;
}

static bool has_corner(const struct core *c, int dim, int32_t face, int32_t corner)
{
    bool has = false;
    for (int32_t k = 0; k < corners_of(c, dim, face) && !has; k++)
        has = corner_of(c, dim, face, k) == corner;
    return has;
}

/* Of the faces of c at the corner that is farthest against n, the one that looks most against it; its corners. Others may look more
   against it and be beside what meets. */
static int incident(struct clipped *out, const struct core *c, int dim, vec3 n)
{
    int32_t face = 0;
    double least = INFINITY;
    if (!c->hull) {
        for (int32_t k = 0; k < c->n; k++) out[k] = (struct clipped){ c->v[k], k, k };
        return c->n;
    }
    const int32_t low = lowest(c, n);
    for (int32_t f = 0; f < faces_of(c, dim); f++) {
        double along = v3_dot(n, c->normal[f]);
        if (along < least && has_corner(c, dim, f, low)) least = along, face = f;
    }
    int32_t corners = corners_of(c, dim, face),
            m = corners < CORNERS_MOST / 2 ? corners : CORNERS_MOST / 2;
    for (int32_t k = 0; k < m; k++) {
        int32_t v = corner_of(c, dim, face, (int32_t)((int64_t)k * corners / m));
        out[k] = (struct clipped){ c->v[v], v, v };
    }
    return m;
}

static int add_place(struct place *place, int count, const struct place *new, double reach)
{
    if (!(new->gap <= reach)) return count;
    for (int k = 0; k < count; k++)
        if (place[k].feature == new->feature) return count;
    place[count] = *new;
    return count + 1;
}

/* A corner of the other over or below a face with this normal through x */
static struct place place_at(const struct two *o, const struct axis *best, vec3 n, vec3 x,
                             const struct clipped *corner)
{
    const bool flipped = best->by == AXIS_FACE_B; // the face is b's
    const double depth = v3_dot(n, v3_sub(corner->x, x)), of_a = o->a->round, of_b = o->b->round;
    const double middle = 0.5 * (flipped ? of_b + depth - of_a : of_a + depth - of_b);
    return (struct place){ v3_axpy(corner->x, middle - depth, n), flipped ? v3_scale(-1, n) : n,
                           depth - of_a - of_b, corner->feature + (flipped ? OF_B : 0) };
}

/* The other's face clipped to the face that is the best axis; n: its normal, away from it. Where nothing is left of it, but for
   rounding or because an edge was better by less than FACE_FIRST, hulls that overlap do so at the lowest corner. */
static int by_face(const struct two *o, const struct axis *best, struct place out[PLACES_MOST])
{
    const int dim = o->dim;
    const bool flipped = best->by == AXIS_FACE_B; // it is b's
    const struct core *face = flipped ? o->b : o->a, *other = flipped ? o->a : o->b;
    const int32_t f = best->i;
    struct clipped buffer[2][CORNERS_MOST], *now = buffer[0], *next = buffer[1];
    struct place place[CORNERS_MOST];
    vec3 n = face->normal[f], x = face->v[corner_of(face, dim, f, 0)];
    int count = incident(now, other, dim, n), places = 0, sides = corners_of(face, dim, f);
    for (int32_t k = 0; k < sides && count; k++) {
        vec3 p = face->v[corner_of(face, dim, f, k)],
             q = face->v[corner_of(face, dim, f, (k + 1) % sides)];
        vec3 d = v3_sub(q, p), m = dim == 2 ? v3_scale(-1, d) : v3_cross(d, n);
        count = meet_clip(next, now, count, m, v3_dot(m, p), k);
        struct clipped *was = now;
        now = next, next = was;
    }
    for (int k = 0; k < count; k++) {
        const struct place one = place_at(o, best, n, x, &now[k]);
        places = add_place(place, places, &one, o->reach);
    }
    if (!places && other->hull && best->gap < 0) {
        const int32_t low = lowest(other, n);
        const struct clipped corner = { other->v[low], low, low };
        place[places++] = place_at(o, best, n, x, &corner);
    }
    places = meet_few(place, places);
    for (int k = 0; k < places; k++) out[k] = place[k];
    return places;
}

int meet_end(const struct place *p)
{
    int32_t which = p->feature >= OF_B ? p->feature - OF_B : p->feature;
    return which == 0 || which == 1 ? which : -1;
}

int meet_few(struct place *p, int n)
{
    if (n <= PLACES_MOST) return n;
    for (int k = 0; k < PLACES_MOST; k++) {
        int best = k;
        double most = -INFINITY;
        for (int i = k; i < n; i++) {
            double score = -p[i].gap; // the deepest; the farthest; the largest triangle; beyond it
            vec3 d = v3_sub(p[i].x, p[0].x);
            if (k == 1) score = v3_dot(d, d);
            vec3 e = v3_sub(p[1].x, p[0].x);
            if (k == 2) score = v3_norm(v3_cross(e, d));
            if (k == 3) { // how far it lies outside the triangle
                const vec3 c[3] = { p[0].x, p[1].x, p[2].x };
                vec3 up = v3_cross(e, v3_sub(p[2].x, p[0].x));
                for (int s = 0; s < 3; s++) {
                    vec3 side = v3_sub(c[(s + 1) % 3], c[s]);
                    score = fmax(s ? score : -INFINITY,
                                 -v3_dot(v3_cross(side, v3_sub(p[i].x, c[s])), up));
                }
            }
            if (score > most) most = score, best = i;
        }
        struct place was = p[k];
        p[k] = p[best], p[best] = was;
    }
    return PLACES_MOST;
}

/* An edge of a hull; a segment is one. */
static vec3 meet_edge_of(const struct core *c, int32_t k, vec3 *along)
{
    int32_t tail = c->hull ? c->hull->edge[k].tail : 0, head = c->hull ? c->hull->edge[k].head : 1;
    *along = v3_sub(c->v[head], c->v[tail]);
    return c->v[tail];
}

/* Two edges that cross: the places on both lines that are nearest, and the middle */
static int by_edges(const struct core *a, const struct core *b, const struct axis *best,
                    struct place *out)
{
    vec3 d, g, p = meet_edge_of(a, best->i, &d), q = meet_edge_of(b, best->j, &g), w = v3_sub(q, p);
    double dd = v3_dot(d, d), gg = v3_dot(g, g), dg = v3_dot(d, g), det = dd * gg - dg * dg;
    double s = (v3_dot(w, d) * gg - v3_dot(w, g) * dg) / det;
    double t = (v3_dot(w, d) * dg - v3_dot(w, g) * dd) / det;
    s = fmin(fmax(s, 0), 1), t = fmin(fmax(t, 0), 1);
    vec3 x = v3_axpy(v3_axpy(p, s, d), a->round, best->n),
         y = v3_axpy(v3_axpy(q, t, g), -b->round, best->n);
    // two edges of at most 12288 each: more bits than there are; a few may share a key
    int32_t which = (int32_t)(((uint32_t)best->i << 13 ^ (uint32_t)best->j) & ((1U << 26) - 1));
    out[0] = (struct place){ v3_scale(0.5, v3_add(x, y)), best->n, best->gap - a->round - b->round,
                             BY_EDGES | which };
    return 1;
}

/* ---- points and segments ---- */

static double meet_clamp(double x)
{
    return fmin(fmax(x, 0), 1);
}

/* The places of two segments (or points) with parameters s and t */
static int at_parameters(const struct two *o, double s, double t, int32_t feature,
                         struct place *out)
{
    const struct core *a = o->a, *b = o->b;
    vec3 p = v3_axpy(a->v[0], s, v3_sub(a->v[a->n - 1], a->v[0]));
    vec3 q = v3_axpy(b->v[0], t, v3_sub(b->v[b->n - 1], b->v[0])), d = v3_sub(q, p);
    double distance = v3_norm(d), gap = distance - a->round - b->round;
    if (!(gap <= o->reach)) return 0;
    vec3 n = v3_sub(b->centre, a->centre); // cores that cross: any way out will do
    double length = v3_norm(n);
    n = length > 0 ? v3_scale(1 / length, n) : v3(0, 1, 0);
    if (distance > 0) n = v3_scale(1 / distance, d);
    *out = (struct place){ v3_axpy(p, a->round + 0.5 * gap, n), n, gap, feature };
    return 1;
}

/* Segments side by side meet in two places, at the ends of what they have in common: where one of them ends, next
   to that end, whichever of them is a. */
static int meet_segments(const struct two *o, struct place *out)
{
    const struct core *a = o->a, *b = o->b;
    vec3 d = v3_sub(a->v[a->n - 1], a->v[0]), e = v3_sub(b->v[b->n - 1], b->v[0]),
         w = v3_sub(b->v[0], a->v[0]);
    double dd = v3_dot(d, d), ee = v3_dot(e, e), de = v3_dot(d, e), dw = v3_dot(d, w),
           ew = v3_dot(e, w), det = dd * ee - de * de;
    if (a->n == 1 || b->n == 1) {
        double s = a->n == 2 ? meet_clamp(dw / dd) : 0, t = b->n == 2 ? meet_clamp(-ew / ee) : 0;
        return at_parameters(o, s, t, BY_NEAREST, out);
    }
    if (det > 1e-4 * dd * ee) { // crossed by more than half a degree
        double s = meet_clamp((dw * ee - ew * de) / det), t = meet_clamp((s * de - ew) / ee);
        s = meet_clamp((t * de + dw) / dd);
        return at_parameters(o, s, t, BY_NEAREST, out);
    }
    double lo = meet_clamp(dw / dd), hi = meet_clamp((dw + de) / dd);
    double t_lo = lo > 0 && lo < 1 ? 0 : meet_clamp((lo * de - ew) / ee);
    double t_hi = hi > 0 && hi < 1 ? 1 : meet_clamp((hi * de - ew) / ee);
    int count = at_parameters(o, lo, t_lo, BY_CORNER, out);
    if (fabs(hi - lo) < 1e-9) return count;
    return count + at_parameters(o, hi, t_hi, BY_CORNER + 1, out + count);
}

/* The corner of c that is farthest along n, and the one that falls off least on the way there; false:
   that is no edge across n. */
static bool edge_across(const struct core *c, vec3 n, vec3 v[2])
{
    double top = -INFINITY, least = NEARLY_ACROSS;
    int32_t first = 0, second = -1;
    for (int32_t i = 0; i < c->n; i++)
        if (v3_dot(n, c->v[i]) > top) top = v3_dot(n, c->v[i]), first = i;
    for (int32_t i = 0; i < c->n; i++) {
        vec3 d = v3_sub(c->v[i], c->v[first]);
        double length = v3_norm(d), slope = length > 0 ? -v3_dot(n, d) / length : INFINITY;
        if (slope < least) least = slope, second = i;
    }
    if (second < 0) return false;
    int32_t lo = first < second ? first : second; // in an order that lasts
    v[0] = c->v[lo], v[1] = c->v[first + second - lo];
    return true;
}

/* Apart along the shortest way. Edges side by side meet in two places, as segments do. */
static int by_nearest(const struct two *o, const struct nearest *way, double size,
                      struct place *out)
{
    const struct core *a = o->a, *b = o->b;
    vec3 n = v3_scale(1 / way->distance, v3_sub(way->b, way->a)), of_a[2], of_b[2];
    double gap = way->distance - a->round - b->round;
    if (o->dim == 3 && edge_across(a, n, of_a) && edge_across(b, v3_scale(-1, n), of_b)) {
        const struct core s = { .n = 2, .v = of_a, .round = a->round, .centre = a->centre };
        const struct core t = { .n = 2, .v = of_b, .round = b->round, .centre = b->centre };
        const struct two edges = { o->dim, &s, &t, o->reach };
        int count = meet_segments(&edges, out);
        if (count == 2 && fmin(out[0].gap, out[1].gap) < gap + ALONG * size) return count;
    }
    out[0] = (struct place){ v3_axpy(way->a, a->round + 0.5 * gap, n), n, gap, BY_NEAREST };
    return gap <= o->reach;
}

/* ---- all of them ---- */

int meet_cores(int dim, const struct core *a, const struct core *b, double reach,
               struct place out[PLACES_MOST])
{
    const struct two both = { dim, a, b, reach };
    struct axis best = { .by = AXIS_NONE, .gap = -INFINITY };
    double round = a->round + b->round, most = reach + round;
    if (!a->hull && !b->hull) return meet_segments(&both, out);
    double size = v3_norm(v3_sub(a->v[0], a->centre)) + v3_norm(v3_sub(b->v[0], b->centre));
    if (!try_faces(&best, a, b, dim, most, false)) return 0;
    struct axis of_a = best;
    best.by = AXIS_NONE;
    if (!try_faces(&best, b, a, dim, most, true)) return 0;
    if (of_a.by && (!best.by || of_a.gap + A_FIRST * size >= best.gap)) best = of_a;
    bool sharp = a->hull && b->hull && round == 0, apart = false;
    if (!sharp && (best.gap > -APART * size || !a->hull || !b->hull)) {
        const struct nearest o = gjk_nearest(a, b);
        apart = o.distance > APART * size;
        if (apart) {
            vec3 n = v3_scale(1 / o.distance, v3_sub(o.b, o.a));
            if (o.distance > most) return 0;
            if (1 - v3_dot(n, best.n) > ALONG) return by_nearest(&both, &o, size, out);
        }
    }
    if (a->hull && b->hull && dim == 3 && !try_edges(&best, a, b, FACE_FIRST * size, most))
        return 0;
    if (!apart && dim == 3 && !a->hull && a->n == 2 &&
        !try_segment(&best, a, b, true, FACE_FIRST * size, most))
        return 0;
    if (!apart && dim == 3 && !b->hull && b->n == 2 &&
        !try_segment(&best, b, a, false, FACE_FIRST * size, most))
        return 0;
    if (best.by == AXIS_EDGES) return by_edges(a, b, &best, out);
    int count = by_face(&both, &best, out);
    if (count || round == 0) return count;
    const struct nearest o = gjk_nearest(a, b); // a corner beside the face
    return o.distance > 0 ? by_nearest(&both, &o, size, out) : 0;
}
