/* contact/detect.c: gaps and points of contact of balls; bodies of other shapes: detect_shapes.c. */
#include "contact/detect.h"

#include "base/team.h"
#include "contact/bond_anchor.h"
#include "contact/contact_law.h"
#include "contact/detect_shapes.h"
#include "contact/internal_edge.h"
#include "contact/seek.h"
#include "state/freedom.h"
#include "state/kinematics.h"
#include "state/rotation.h"

#include <stdlib.h>
#include <string.h>

enum {
    PER_THREAD_CURVED =
        512, /* bodies whose places on a curved wall are worth a thread: 50 us of work, */
    PER_THREAD_FLAT = 16384, /* and bodies at a plane, or pairs */
    ELEMENTS_BODY =
        4096, /* elements of meshes near a body: one ten times as wide as they are has 600 */
    ELEMENTS_LEAST = 1 << 26 /* and those that all may have: a second's work */
};

/* A place where ball i meets wall w, in space; false when memory is short. */
static bool add_touch(struct contacts *out, const struct packing *p, int32_t w, int64_t i, vec3 x,
                      const struct touch *t)
{
    struct contact *c = contacts_add(out, -1 - w, (int32_t)i);
    if (!c) return false;
    contact_basis(c, p->dim, t->n);
    c->gap = t->distance - p->radius[i];
    c->x = v3_axpy(x, -t->distance, t->n);
    c->feature = t->feature;
    packing_set_law(p, c);
    return true;
}

/* What contacts are sought of */
struct sought {
    struct situation all;
    double gap; /* m */
    const struct neighbours *near;
    int32_t wall; /* the one in hand */
};

/* Adds those of first .. end-1, bodies or pairs of near ones; false when memory is short. */
typedef bool find_text(struct contacts *out, const struct sought *o, int64_t first, int64_t end);

/* Parts of a search: their contacts, one after another, are those of the whole. */
struct parts {
    const struct sought *o;
    find_text *find;
    int64_t n, parts;
    struct contacts *found; /* [parts] */
    struct contact *at;     /* where they go */
    int64_t guess;          /* contacts of a part: as many as in the step before */
    _Atomic bool failed;
};

static void find_parts(void *arg, int64_t first, int64_t end)
{
    struct parts *s = arg;
    for (int64_t k = first; k < end; k++)
        if (!contacts_reserve(&s->found[k], s->guess) ||
            !s->find(&s->found[k], s->o, s->n * k / s->parts, s->n * (k + 1) / s->parts))
            s->failed = true;
}

static void copy_parts(void *arg, int64_t first, int64_t end)
{
    const struct parts *s = arg;
    struct contact *to = s->at;
    for (int64_t k = 0; k < end; to += s->found[k++].n)
        if (k >= first && s->found[k].n)
            memcpy(to, s->found[k].c, (size_t)s->found[k].n * sizeof *to);
}

/* All of 0 .. n-1, in parts of at least `least` where there are threads for them */
static bool find_all(struct contacts *out, const struct sought *o, int64_t n, int64_t least,
                     find_text *find)
{
    struct parts s = { o, find, n, 4 * (int64_t)team_size(), NULL, NULL, 0, false };
    int64_t more = 0;
    s.guess = out->room / s.parts;
    if (team_size() == 1 || n < 2 * least) return find(out, o, 0, n);
    if (!(s.found = calloc((size_t)s.parts, sizeof *s.found))) return false;
    team_share(team_size(), s.parts, 1, find_parts, &s);
    for (int64_t k = 0; k < s.parts; k++) more += s.found[k].n;
    if (!contacts_reserve(out, more)) s.failed = true;
    s.at = out->c + out->n;
    if (!s.failed) team_share(team_size(), more ? s.parts : 0, 1, copy_parts, &s), out->n += more;
    for (int64_t k = 0; k < s.parts; k++) contacts_free(&s.found[k]);
    free(s.found);
    return !s.failed;
}

static bool add_plane(struct contacts *out, const struct sought *o, int64_t first, int64_t end)
{
    const struct packing *p = o->all.p;
    const int32_t w = o->wall;
    const vec3 *x = o->all.x;
    const double gap = o->gap;
    vec3 at = wall_at(p, &p->wall[w], o->all.t), n = wall_normal(p, &p->wall[w], o->all.t);
    for (int64_t i = first; i < end; i++) {
        struct touch touch = { n, v3_dot(v3_sub(x[i], at), n), 0 };
        if (!(touch.distance - p->radius[i] <= gap)) continue;
        if (!packing_may_meet(p, -1 - w, (int32_t)i)) continue;
        if (o->all.shaped && packing_shape(p, i)) {
            if (!detect_shapes_wall(out, &o->all, w, i, gap)) return false;
            continue;
        }
        if (!add_touch(out, p, w, i, x[i], &touch)) return false;
    }
    return true;
}

/* Body i and a wall of any other shape. A ball is brought to where the shape is described, and what it touches
   back from there. */
static bool detect_add_body(struct contacts *out, const struct sought *o, const struct pose *pose,
                            int64_t i)
{
    const struct packing *p = o->all.p;
    const int32_t w = o->wall;
    const struct wall *wall = &p->wall[w];
    const struct surface *surface = situation_surface(&o->all, w);
    double r = p->radius[i];
    struct touch touch[TOUCHES_MOST];
    if (o->all.shaped && packing_shape(p, i)) return detect_shapes_wall(out, &o->all, w, i, o->gap);
    vec3 c = v3_sub(quat_turn_back(pose->q, v3_sub(o->all.x[i], pose->shift)), wall->x);
    int n = surface ? surface_touches(surface, c, r + o->gap, touch)
                    : wall_nearest(wall, p->dim, c, r, touch);
    for (int k = 0; k < n; k++) {
        if (!(touch[k].distance - r <= o->gap)) continue;
        touch[k].n = quat_turn(pose->q, touch[k].n);
        if (!add_touch(out, p, w, i, o->all.x[i], &touch[k])) return false;
    }
    return true;
}

static bool detect_add_shape(struct contacts *out, const struct sought *o, int64_t first,
                             int64_t end)
{
    const struct packing *p = o->all.p;
    struct pose pose = wall_pose(p, &p->wall[o->wall], o->all.t);
    for (int64_t i = first; i < end; i++) {
        if (!packing_may_meet(p, -1 - o->wall, (int32_t)i)) continue;
        if (!detect_add_body(out, o, &pose, i)) return false;
    }
    return true;
}

/* pair: with its shift now. False when memory is short. */
static bool add_pair(struct contacts *out, const struct sought *o, const struct pair *pair)
{
    const struct packing *p = o->all.p;
    const struct placed *shaped = o->all.shaped;
    const vec3 *x = o->all.x;
    const double gap = o->gap;
    int32_t a = pair->a, b = pair->b;
    vec3 d = v3_sub(x[b], x[a]);
    if (o->all.edge) d = v3_add(d, cell_shift(o->all.edge, pair->shift));
    double radii = p->radius[a] + p->radius[b], most = radii + gap, d2 = v3_dot(d, d);
    if (d2 > most * most * (1 + 1e-12)) return true; // clearly apart: no square root needed
    if (shaped && (packing_shape(p, a) || packing_shape(p, b)))
        return detect_shapes_pair(out, shaped, pair, v3_sub(d, v3_sub(x[b], x[a])), gap);
    double distance = sqrt(d2), g = distance - radii;
    if (!(g <= gap)) return true;
    struct contact *c = contacts_add(out, a, b);
    if (!c) return false;
    // balls with the same centre: any normal will do, so b is taken to lie above a
    vec3 up = p->dim == 2 ? v3(0, 1, 0) : v3(0, 0, 1);
    contact_basis(c, p->dim, distance > 0 ? v3_scale(1 / distance, d) : up);
    for (int k = 0; k < 3; k++) c->shift[k] = pair->shift[k];
    c->gap = g;
    c->x = v3_axpy(x[a], p->radius[a] + 0.5 * g, c->n);
    packing_set_law(p, c);
    return true;
}

bool detect_pair(struct contacts *out, const struct situation *o, const struct pair *pair,
                 double gap)
{
    const struct sought one = { .all = *o, .gap = gap };
    return add_pair(out, &one, pair);
}

bool detect_wall(struct contacts *out, const struct situation *o, int32_t w, int64_t i, double gap)
{
    const struct sought one = { .all = *o, .gap = gap, .wall = w };
    if (o->p->wall[w].shape == WALL_PLANE) return add_plane(out, &one, i, i + 1);
    const struct pose pose = wall_pose(o->p, &o->p->wall[w], o->t);
    return detect_add_body(out, &one, &pose, i);
}

/* From i on, the first entry that is not of the pair of bodies before it: what two bodies and their images
   have for contacts is sorted together. */
static int64_t next_bodies(const struct pairs *s, int64_t i)
{
    while (i > 0 && i < s->n && s->pair[i].a == s->pair[i - 1].a &&
           s->pair[i].b == s->pair[i - 1].b)
        i++;
    return i;
}

/* Pairs of near bodies, the first and last of the part whole */
static bool add_pairs(struct contacts *out, const struct sought *o, int64_t first, int64_t end)
{
    end = next_bodies(&o->near->list, end);
    for (int64_t i = next_bodies(&o->near->list, first); i < end; i++) {
        struct pair pair = o->near->list.pair[i];
        if (o->all.edge) neighbours_shift(o->near, o->all.p, &o->near->list.pair[i], pair.shift);
        if (!add_pair(out, o, &pair)) return false;
    }
    return true;
}

/* The elements of meshes that bodies have for neighbours are counted: no heap has so many near each body,
   and elements that crowd would keep the search busy for hours. */
static void count_elements(struct neighbours *near, const struct packing *p, _Atomic int64_t *seen)
{
    for (int32_t w = 0; near->surface && w < p->walls; w++)
        near->surface[w].seen = seen,
        near->surface[w].seen_most = ELEMENTS_LEAST + ELEMENTS_BODY * p->n;
}

static int check_crowd(struct neighbours *near, const struct packing *p, int64_t seen,
                       struct failure *failure)
{
    int64_t most = ELEMENTS_LEAST + ELEMENTS_BODY * p->n;
    for (int32_t w = 0; near->surface && w < p->walls; w++) near->surface[w].seen = NULL;
    if (seen <= most) return 0;
    return failure_set(
        failure, EX_DATAERR,
        "bodies have more than %lld elements of meshes near them: a mesh much finer than the "
        "bodies, or crowded",
        (long long)most);
}

static int detect_all(struct contacts *out, const struct packing *p, const struct positions *at,
                      double gap, struct neighbours *kept, struct failure *failure)
{
    struct placed placed = { 0 }, *shaped = p->shape ? &placed : NULL;
    struct neighbours once = { 0 }, *near = kept ? kept : &once;
    const vec3 *edges = cell_repeats(&p->cell) ? at->edge : NULL;
    struct sought o = { { p, at->x, edges, at->t, shaped, NULL }, gap, near, 0 };
    bool stored = true;
    _Atomic int64_t seen = 0;
    out->n = 0, contacts_free_found(out), contacts_free_tie(out);
    int e = neighbours_find(near, p, at, gap, kept, failure);
    if (!e) e = neighbours_surfaces(near, p, failure);
    if (!e) count_elements(near, p, &seen);
    if (!e && shaped) e = placed_init(shaped, p, at, failure);
    o.all.surface = near->surface;
    for (o.wall = p->walls - 1; !e && stored && o.wall >= 0; o.wall--) {
        const struct wall *wall = &p->wall[o.wall];
        bool plane = wall->shape == WALL_PLANE;
        if (!wall_there(wall, at->t)) continue;
        stored = find_all(out, &o, p->n, plane && !shaped ? PER_THREAD_FLAT : PER_THREAD_CURVED,
                          plane ? add_plane : detect_add_shape);
    }
    if (!e && stored)
        stored = find_all(out, &o, near->list.n, shaped ? PER_THREAD_CURVED : PER_THREAD_FLAT,
                          add_pairs);
    if (!e && stored) e = seams_drop(out, &o.all, failure);
    placed_free(&placed);
    if (!e) e = check_crowd(near, p, seen, failure);
    neighbours_free(&once);
    return e || stored ? e : failure_set(failure, EX_SOFTWARE, "no memory for the contacts");
}

int detect_contacts_at(struct contacts *out, const struct packing *p, const vec3 *x, double t,
                       double gap, struct failure *failure)
{
    struct positions at = { .x = x, .q = p->q, .t = t };
    cell_predict(&p->cell, t - p->t, at.edge);
    return detect_all(out, p, &at, gap, NULL, failure);
}

/* What decides which pairs that do not touch the law sees */
struct detect_sight {
    bool meets;  /* those that approach, too */
    bool soft;   /* the same of contacts with a stiffness, if there are any */
    double calm; /* m/s */
    double near; /* m: what loads may close in a step */
    double most; /* m: half the smallest radius, so that lists of neighbours stay short where
                    something flies off */
};

static struct detect_sight ray_of(const struct packing *p)
{
    return (struct detect_sight){ overlap_meets(p->overlap), packing_has_springs(p),
                                  freedoms_calm(p), p->dt * freedoms_speed(p),
                                  0.5 * packing_whole(p).small };
}

/* m: how far apart two bodies may be that touch before the next step's contacts are sought: those that
   are near, and where pairs meet the way of the fastest in a step, twice */
static double seeing_reach(const struct packing *p)
{
    const struct whole all = packing_whole(p);
    const struct detect_sight o = ray_of(p);
    double speed = p->shape ? all.rotation_speed : all.speed; // a corner is faster than its body
    for (int32_t w = 0; w < p->walls; w++) speed = fmax(speed, wall_top_speed(p, &p->wall[w]));
    double near = fmin(OVERLAP_NEAR * all.large + o.near, o.most);
    return o.meets || o.soft ? fmax(near, fmin(p->dt * (2 * speed + o.calm), o.most)) : near;
}

double detect_reach(const struct packing *p, double gap)
{
    bool sees = overlap_sees_gaps(p->overlap) || packing_has_springs(p);
    double reach = sees ? fmax(gap, seeing_reach(p)) : gap;
    return p->law ? fmax(reach, contact_laws_reach(p)) : reach;
}

/* Whether the law sees a pair with a gap above that of a contact. Where it would rebound from afar, the
   impact waits for the bodies to touch. */
static bool is_seen(const struct packing *p, const struct detect_sight *o, const struct contact *c)
{
    double small = c->a < 0 ? p->radius[c->b] : dmin(p->radius[c->a], p->radius[c->b]);
    const bool soft = o->soft && packing_springs(p, c);
    if (!soft && !overlap_sees_gaps(p->overlap)) return false;
    if (c->gap <= OVERLAP_NEAR * small) return true;
    double approach = -opening_of(p, c, step_ahead(p));
    if (soft) return c->gap <= fmax(o->near, p->dt * (approach + o->calm));
    if (c->en > 0 && approach > o->calm) return false;
    return c->gap <= o->near || (o->meets && c->gap <= p->dt * (approach + o->calm));
}

/* Keeps the contacts with at most this gap, those that the law sees besides, and those that other laws
   hold. */
static void keep_seen(struct contacts *s, const struct packing *p, double gap)
{
    int64_t n = 0;
    const struct detect_sight o = ray_of(p);
    bool sees = overlap_sees_gaps(p->overlap) || o.soft;
    for (int64_t i = 0; i < s->n; i++) {
        bool held = s->law && contact_law_holds(&s->law[i]);
        bool seen = sees && is_seen(p, &o, &s->c[i]);
        if (!(s->c[i].gap <= gap || held || seen)) continue;
        if (s->law) s->law[n] = s->law[i];
        s->c[n++] = s->c[i];
    }
    s->n = n;
}

/* Positions predicted for a step: at its midpoint, for theta = 1/2. */
struct prediction {
    vec3 *x; /* [n] m */
    quat *q; /* [n]; NULL: no body has a shape */
    struct positions at;
};

static void prediction_free(struct prediction *m)
{
    free(m->x), free(m->q);
}

/* Bodies whose places are predicted */
struct predicting {
    const struct packing *p;
    struct prediction *m;
};

static void predict_some(void *arg, int64_t first, int64_t end)
{
    const struct predicting *y = arg;
    const struct packing *p = y->p;
    for (int64_t i = first; i < end; i++) y->m->x[i] = packing_predict(p, i);
    for (int64_t i = first; i < end && y->m->q; i++)
        y->m->q[i] = packing_shape(p, i) ? rotation_predict(p, i) : p->q[i];
}

static int detect_predict(struct prediction *m, const struct packing *p, struct failure *failure)
{
    double ahead = step_ahead(p);
    *m = (struct prediction){ .x = malloc(((size_t)p->n + 1) * sizeof *m->x) };
    if (p->shape) m->q = malloc(((size_t)p->n + 1) * sizeof *m->q);
    if (!m->x || (p->shape && !m->q)) {
        prediction_free(m);
        return failure_set(failure, EX_SOFTWARE, "no memory for the contacts");
    }
    struct predicting y = { p, m };
    team_share(team_size(), p->n, PER_THREAD_FLAT, predict_some, &y);
    m->at = (struct positions){ .x = m->x, .q = m->q, .t = p->t + ahead };
    cell_predict(&p->cell, ahead, m->at.edge);
    return 0;
}

int detect_near(struct contacts *out, const struct packing *p, double reach,
                struct neighbours *kept, struct failure *failure)
{
    struct prediction m;
    if (detect_predict(&m, p, failure)) return failure->status;
    int e = detect_all(out, p, &m.at, reach, kept, failure);
    prediction_free(&m);
    return e;
}

/* The places of bonds between shapes are contacts, too. */
static int add_anchored(struct contacts *s, const struct packing *p, struct failure *failure)
{
    struct prediction m;
    if (detect_predict(&m, p, failure)) return failure->status;
    int e = anchors_place(s, p, &m.at, failure);
    prediction_free(&m);
    return e;
}

int detect_choose(struct contacts *s, const struct packing *p, double gap, double reach,
                  struct failure *failure)
{
    int e = p->law && p->shape && p->bonds.n ? add_anchored(s, p, failure) : 0;
    if (!e) friction_choose(s, p);
    if (!e && p->law) e = contact_laws_find(s, p, failure);
    if (!e && reach > gap) keep_seen(s, p, gap);
    return e;
}

int detect_contacts(struct contacts *out, const struct packing *p, double gap,
                    struct neighbours *kept, struct failure *failure)
{
    double reach = detect_reach(p, gap);
    int e = detect_near(out, p, reach, kept, failure);
    return e ? e : detect_choose(out, p, gap, reach, failure);
}
