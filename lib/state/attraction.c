#include "state/attraction.h"

#include "state/kinematics.h"
#include "state/rotation.h"

#include <stdlib.h>
#include <string.h>

enum { CORNERS = 256 /* of a face or of places that span one: of more, places share evenly */ };

static const double ALONG = 1e-6, /* 1 - cosine: of normals that are one, */
    FLUSH = 1e-5,                 /* radii: and of places in one plane */
    EVEN = 1e-9;                  /* of its size: a face's centre that is the mean of its places */
static const double WELD = 2e-6;  /* of the reach of a wall: how far parts of a surface are apart */

/* A contact as the body has it that the others are compared for */
struct attraction_hold {
    int32_t body, other; /* the other, if it moves too; -1: it does not */
    int64_t i;           /* the contact */
    vec3 n, x;           /* its normal towards the body, and its place where the body is */
    double flush;        /* m */
};

static bool attraction_moves(const struct packing *p, int32_t who)
{
    return who >= 0 && p->mass[who] > 0;
}

/* Of the movable one of its two bodies, b where both are */
static struct attraction_hold hold_of(const struct packing *p, const struct contacts *s, int64_t i,
                                      const vec3 edge[3])
{
    const struct contact *c = &s->c[i];
    struct attraction_hold h = { .body = c->b, .other = -1, .i = i, .n = c->n, .x = c->x };
    if (attraction_moves(p, c->a) && attraction_moves(p, c->b)) h.other = c->a;
    if (attraction_moves(p, c->b))
        h.x = v3_sub(h.x, cell_shift(edge, c->shift));
    else
        h.body = c->a, h.n = v3_scale(-1, c->n);
    h.flush = FLUSH * p->radius[h.body];
    if (c->a >= 0) return h;
    const struct wall *w = &p->wall[-1 - c->a];
    double weld = w->weld > 0 ? w->weld : WELD * wall_reach(w);
    if (isfinite(weld)) h.flush = fmax(h.flush, weld);
    return h;
}

/* Order: contacts of one body with what does not move, then those of pairs that move */
static int attraction_compare(const void *x, const void *y)
{
    const struct attraction_hold *a = x, *b = y;
    if (a->body != b->body) return a->body < b->body ? -1 : 1;
    if (a->other != b->other) return a->other < b->other ? -1 : 1;
    return a->i < b->i ? -1 : a->i > b->i;
}

static bool in_one_plane(const struct attraction_hold *a, const struct attraction_hold *b)
{
    return v3_dot(a->n, b->n) > 1 - ALONG &&
           fabs(v3_dot(a->n, v3_sub(b->x, a->x))) <= fmax(a->flush, b->flush);
}

/* ---- the centre of a face ---- */

struct flat {
    int n;
    double x[CORNERS][2]; /* m */
};

static double attraction_cross(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static int compare_points(const void *x, const void *y)
{
    const double *a = x, *b = y;
    if (a[0] != b[0]) return a[0] < b[0] ? -1 : 1;
    return a[1] < b[1] ? -1 : a[1] > b[1];
}

/* The convex hull of points, counterclockwise [Andrew 1979] */
static void make_hull(struct flat *f)
{
    double hull[2 * CORNERS][2];
    int n = 0;
    qsort(f->x, (size_t)f->n, sizeof *f->x, compare_points);
    for (int way = 0, least = 2; way < 2; way++, least = n + 1)
        for (int k = 0; k < f->n; k++) {
            const double *p = f->x[way ? f->n - 1 - k : k];
            if (way && !k) continue;
            while (n >= least && attraction_cross(hull[n - 2], hull[n - 1], p) <= 0) n--;
            hull[n][0] = p[0], hull[n++][1] = p[1];
        }
    if (n > 1) n--; // the first again
    for (int k = 0; k < n; k++) f->x[k][0] = hull[k][0], f->x[k][1] = hull[k][1];
    f->n = n;
}

/* The centroid of a convex polygon, or of what has no area: the middle of the two points farthest apart; *size: how wide */
static void find_centre(const struct flat *f, double out[2], double *size)
{
    double area = 0, sum[2] = { 0, 0 };
    int far[2] = { 0, 0 };
    *size = 0;
    for (int i = 0; i < f->n; i++)
        for (int j = 0; j < i; j++) {
            double dx = f->x[i][0] - f->x[j][0], dy = f->x[i][1] - f->x[j][1];
            double d = sqrt(dx * dx + dy * dy);
            if (d > *size) *size = d, far[0] = j, far[1] = i;
        }
    for (int k = 0; k < 2; k++) out[k] = 0.5 * (f->x[far[0]][k] + f->x[far[1]][k]);
    for (int i = 2; i < f->n; i++) {
        double part = attraction_cross(f->x[0], f->x[i - 1], f->x[i]);
        area += part;
        for (int k = 0; k < 2; k++)
            sum[k] += part / 3 * (f->x[i - 1][k] + f->x[i][k] - 2 * f->x[0][k]);
    }
    if (!(area > EVEN * *size * *size)) return;
    for (int k = 0; k < 2; k++) out[k] = f->x[0][k] + sum[k] / area;
}

/* ---- shares ---- */

/* The most even weights of n places x, at least 0 and 1 together, whose mean is c: 1/n + the places' distances from their
   mean, by their inverse covariance. A place whose weight would be negative has none. */
static void find_weights(int n, double x[][2], const double c[2], double *weight)
{
    for (int k = 0; k < n; k++) weight[k] = 1;
    for (int left = n; left > 0; left--) {
        double m[2] = { 0, 0 }, xx = 0, xy = 0, yy = 0, least = 0;
        int worst = -1;
        for (int k = 0; k < n; k++)
            for (int j = 0; j < 2 && weight[k] > 0; j++) m[j] += x[k][j] / left;
        for (int k = 0; k < n; k++) {
            double u = x[k][0] - m[0], v = x[k][1] - m[1];
            if (weight[k] > 0) xx += u * u, xy += u * v, yy += v * v;
        }
        double dx = c[0] - m[0], dy = c[1] - m[1], det = xx * yy - xy * xy, trace = xx + yy;
        double gx = 0, gy = 0;
        if (det > EVEN * trace * trace)
            gx = (yy * dx - xy * dy) / det, gy = (xx * dy - xy * dx) / det;
        else if (trace > 0) // all in a line: the matrix is trace times the projection on it
            gx = (xx * dx + xy * dy) / (trace * trace), gy = (xy * dx + yy * dy) / (trace * trace);
        for (int k = 0; k < n; k++) {
            if (!(weight[k] > 0)) continue;
            weight[k] = 1.0 / left + (x[k][0] - m[0]) * gx + (x[k][1] - m[1]) * gy;
            if (weight[k] < least) least = weight[k], worst = k;
        }
        if (worst < 0) return;
        for (int k = 0; k < n; k++) weight[k] = weight[k] != 0 && k != worst;
    }
}

/* Places of one surface, and what they share */
struct surface_hold {
    const struct contacts *s;
    const struct packing *p;
    const struct attraction_hold *hold; /* [n] */
    int n;
    vec3 origin, t1, t2; /* m; of the plane */
};

static void flatten(const struct surface_hold *y, vec3 x, double out[2])
{
    vec3 d = v3_sub(x, y->origin);
    out[0] = v3_dot(d, y->t1), out[1] = v3_dot(d, y->t2);
}

/* The face of hull i that looks along n (to the plane), where the body is `away` (m); its corners within `most` (m) of
   the plane. Returns false where it is no hull, or has too many. */
static bool face_of(const struct surface_hold *y, int32_t i, vec3 away, vec3 n, double most,
                    struct flat *out)
{
    const struct shape *shape = packing_shape(y->p, i);
    out->n = 0;
    if (!shape || !shape_has_faces(shape) || y->p->dim == 2) return false;
    const quat q = rotation_predict(y->p, i);
    const vec3 x = v3_add(packing_predict(y->p, i), away), along = quat_turn_back(q, n);
    int32_t best = 0;
    for (int32_t f = 1; f < shape->faces; f++)
        if (v3_dot(shape->normal[f], along) > v3_dot(shape->normal[best], along)) best = f;
    for (int32_t k = shape->first[best]; k < shape->first[best + 1]; k++) {
        vec3 v = v3_axpy(x, y->p->radius[i], quat_turn(q, shape->vertex[shape->corner[k]]));
        double depth = y->p->radius[i] * shape->round + v3_dot(n, v3_sub(v, y->origin));
        if (depth < -most) continue;
        if (out->n == CORNERS) return false;
        flatten(y, v, out->x[out->n++]);
    }
    return true;
}

/* What is left of a convex polygon on the left of all sides of another, counterclockwise both */
static void attraction_clip(struct flat *f, const struct flat *by)
{
    for (int s = 0; s < by->n; s++) {
        const struct flat was = *f;
        const double *a = by->x[s], *b = by->x[(s + 1) % by->n];
        f->n = 0;
        for (int k = 0; k < was.n && f->n < CORNERS - 1; k++) {
            const double *p = was.x[k], *q = was.x[(k + 1) % was.n];
            double dp = attraction_cross(a, b, p), dq = attraction_cross(a, b, q);
            if (dp >= 0) memcpy(f->x[f->n++], p, sizeof *f->x);
            if ((dp >= 0) == (dq >= 0)) continue;
            for (int j = 0; j < 2; j++) f->x[f->n][j] = p[j] + dp / (dp - dq) * (q[j] - p[j]);
            f->n++;
        }
    }
}

/* The faces where a pair meets of which detection has left four places; false: it has left all, or there are none */
static bool common_face(const struct surface_hold *y, struct flat *f)
{
    const struct contact *c = &y->s->c[y->hold[0].i];
    bool plane = c->a < 0 && y->p->wall[-1 - c->a].shape == WALL_PLANE;
    struct flat of_a;
    vec3 edge[3];
    double most = 0;
    if (y->n != 4 || (c->a < 0 && !plane)) return false;
    for (int k = 0; k < y->n; k++) {
        const struct contact *d = &y->s->c[y->hold[k].i];
        if (d->a != c->a || d->b != c->b) return false;
        most = fmax(most, fmax(d->gap, 0)); // the plane is that of the places, midway
    }
    most += FLUSH * packing_smaller_radius(y->p, c);
    cell_predict(&y->p->cell, step_ahead(y->p), edge);
    const bool b_is = y->hold[0].body == c->b && attraction_moves(y->p, c->b);
    const vec3 shift = cell_shift(edge, c->shift);
    if (!face_of(y, c->b, b_is ? v3(0, 0, 0) : shift, v3_scale(-1, c->n), most, f)) return false;
    make_hull(f);
    if (plane) return f->n > 2;
    if (!face_of(y, c->a, b_is ? v3_scale(-1, shift) : v3(0, 0, 0), c->n, most, &of_a))
        return false;
    make_hull(&of_a);
    if (of_a.n < 3 || f->n < 3) return false;
    attraction_clip(f, &of_a);
    return f->n > 2;
}

/* Has body i no faces, but balls? */
static bool is_clump(const struct packing *p, int32_t i)
{
    const struct shape *shape = i < 0 ? NULL : packing_shape(p, i);
    return shape && shape_is_union(shape);
}

/* All that the places' bodies hold by is these places, in one plane: the resultant is at the centre of the face. */
static void share_face(const struct surface_hold *y, struct attraction *of)
{
    double x[CORNERS][2], weight[CORNERS], c[2], mean[2] = { 0, 0 }, size;
    struct flat f = { .n = y->n };
    for (int k = 0; k < y->n; k++) {
        flatten(y, y->hold[k].x, x[k]);
        memcpy(f.x[k], x[k], sizeof *f.x);
        for (int j = 0; j < 2; j++) mean[j] += x[k][j] / y->n;
    }
    if (!common_face(y, &f)) {
        f.n = y->n;
        memcpy(f.x, x, (size_t)y->n * sizeof *f.x);
        make_hull(&f);
    }
    find_centre(&f, c, &size);
    double dx = c[0] - mean[0], dy = c[1] - mean[1];
    if (!(dx * dx + dy * dy > EVEN * EVEN * size * size)) return; // even shares are it
    find_weights(y->n, x, c, weight);
    for (int k = 0; k < y->n; k++)
        of[y->hold[k].i].among = weight[k] > 0 ? 1 / weight[k] : INFINITY;
}

/* Holds of one body with what does not move, or of one pair that moves; room[n] */
struct attraction_run {
    const struct contacts *s;
    const struct packing *p;
    struct attraction_hold *hold, *room;
    int64_t n;
};

static bool of_one_pair(const struct attraction_run *y, int64_t i, int64_t j)
{
    const struct contact *c = &y->s->c[y->hold[i].i], *d = &y->s->c[y->hold[j].i];
    return c->a == d->a && c->b == d->b && contact_shaped(y->p, c);
}

/* How many of hold i's pair are tied, or bonded; balls have each place for itself. */
static int64_t count_pair(const struct attraction_run *y, const struct attraction *of, int64_t i,
                          bool bonded)
{
    int64_t n = 0, k = i;
    while (k > 0 && of_one_pair(y, i, k - 1)) k--;
    for (; k < y->n && (k == i || of_one_pair(y, i, k)); k++) {
        const struct attraction *t = &of[y->hold[k].i];
        n += bonded ? t->bonded : t->tied;
    }
    return n;
}

/* What is in one plane with hold i, into room; returns how many. */
static int64_t attraction_gather(const struct attraction_run *y, const struct attraction *of,
                                 int64_t i, bool bonded)
{
    int64_t n = 0;
    for (int64_t k = 0; k < y->n; k++) {
        const struct attraction *t = &of[y->hold[k].i];
        bool counts = bonded ? t->bonded : t->tied;
        if (counts && (k == i || in_one_plane(&y->hold[i], &y->hold[k]))) y->room[n++] = y->hold[k];
    }
    return n;
}

/* The pull of hold i and of what is in one plane with it */
static void share_pull(const struct attraction_run *y, struct attraction *of, int64_t i)
{
    const int64_t n = attraction_gather(y, of, i, false);
    const struct attraction_hold *h = &y->hold[i];
    bool whole = n > 1 && n <= CORNERS;
    for (int64_t k = 0, in = 0; k < y->n; k++) {
        if (in == n || y->room[in].i != y->hold[k].i) continue;
        double pair = (double)count_pair(y, of, k, false);
        whole = whole && pair <= (double)n;
        of[y->hold[k].i].among = pair > (double)n ? pair : (double)n;
        in++;
    }
    // is there another of their pairs' places in another plane?
    for (int64_t k = 0; whole && k < n; k++)
        for (int64_t j = 0; whole && j < y->n; j++) {
            const struct contact *c = &y->s->c[y->room[k].i], *d = &y->s->c[y->hold[j].i];
            if (c->a == d->a && c->b == d->b && of[y->hold[j].i].tied)
                whole = in_one_plane(&y->room[k], &y->hold[j]);
        }
    const struct contact *c = &y->s->c[h->i];
    if (!whole || is_clump(y->p, c->a) || is_clump(y->p, c->b)) return;
    const struct surface_hold f = { y->s, y->p, y->room, (int)n, h->x, c->t1, contact_t2(c) };
    share_face(&f, of);
}

/* Does wall w pass through x (m), to `near`, for a body of this radius? */
static bool passes(const struct packing *p, int32_t w, vec3 x, double radius, double near)
{
    const struct wall *wall = &p->wall[w];
    if (wall->shape == WALL_PLANE || wall->shape == WALL_MESH) return false;
    const struct pose pose = wall_pose(p, wall, p->t + step_ahead(p));
    struct touch t;
    vec3 c = v3_sub(quat_turn_back(pose.q, v3_sub(x, pose.shift)), wall->x);
    return wall_nearest(wall, p->dim, c, radius, &t) && fabs(t.distance) <= near;
}

/* Is hold i with the end of a wall where another wall goes on, which has a place nearer to the body? */
static bool is_seam(const struct attraction_run *y, const struct attraction *of, int64_t i)
{
    const struct attraction_hold *h = &y->hold[i];
    const struct contact *c = &y->s->c[h->i];
    bool seam = false;
    for (int64_t k = 0; c->a < 0 && k < y->n && !seam; k++) {
        const struct contact *d = &y->s->c[y->hold[k].i];
        const double near = fmax(h->flush, y->hold[k].flush);
        if (d->a >= 0 || d->a == c->a || !of[y->hold[k].i].tied || d->gap >= c->gap) continue;
        seam = !in_one_plane(h, &y->hold[k]) &&
               passes(y->p, -1 - d->a, h->x, y->p->radius[h->body], near);
    }
    return seam;
}

static void share_run(const struct attraction_run *y, struct attraction *of)
{
    for (int64_t i = 0; i < y->n; i++) {
        struct attraction *t = &of[y->hold[i].i];
        if (t->tied && is_seam(y, of, i)) t->among = INFINITY;
    }
    for (int64_t i = 0; i < y->n; i++) {
        struct attraction *t = &of[y->hold[i].i];
        if (isinf(t->among)) t->tied = false;
    }
    for (int64_t i = 0; i < y->n; i++) {
        struct attraction *t = &of[y->hold[i].i];
        if (t->tied && t->among == 0) share_pull(y, of, i);
        if (!t->bonded) continue;
        double pair = (double)count_pair(y, of, i, true),
               n = (double)attraction_gather(y, of, i, true);
        t->bonds = pair > n ? pair : n;
    }
}

/* Does contact i share with others? */
static bool attraction_is_shared(const struct contacts *s, const struct packing *p,
                                 const struct attraction *of, int64_t i)
{
    const struct contact *c = &s->c[i];
    bool moves_both = attraction_moves(p, c->a) && attraction_moves(p, c->b);
    return (of[i].tied || of[i].bonded) && (!moves_both || contact_shaped(p, c));
}

int attraction_share(struct attraction *of, const struct contacts *s, const struct packing *p,
                     struct failure *failure)
{
    int64_t n = 0, count = 0;
    vec3 edge[3];
    cell_predict(&p->cell, step_ahead(p), edge);
    for (int64_t i = 0; i < s->n; i++)
        of[i].among = of[i].bonds = 0, n += attraction_is_shared(s, p, of, i);
    struct attraction_hold *hold = malloc((size_t)(2 * n + 1) * sizeof *hold);
    if (!hold) return failure_set(failure, EX_SOFTWARE, "no memory for the ties");
    for (int64_t i = 0; i < s->n; i++)
        if (attraction_is_shared(s, p, of, i)) hold[count++] = hold_of(p, s, i, edge);
    qsort(hold, (size_t)n, sizeof *hold, attraction_compare);
    for (int64_t i = 0, end; i < n; i = end) {
        for (end = i + 1;
             end < n && hold[end].body == hold[i].body && hold[end].other == hold[i].other;)
            end++;
        const struct attraction_run y = { s, p, hold + i, hold + n, end - i };
        share_run(&y, of);
    }
    for (int64_t i = 0; i < s->n; i++) {
        if (!(of[i].among > 0)) of[i].among = 1;
        if (!(of[i].bonds > 0)) of[i].bonds = 1;
    }
    free(hold);
    return 0;
}
