/* step/small_make.c: what comes near on straight ways [step/small_make.h]. */
#include "step/small_make.h"

#include "base/array.h"
#include "base/team.h"
#include "contact/contact_law.h"
#include "solve/lay.h"
#include "step/small_part.h"
#include "step/small_past.h"
#include "step/small_stiff.h"

#include <stdlib.h>
#include <string.h>

/* Of the margin: by how much sooner pairs are looked at again than bounds of ways say */
#define CLOSE 1e-3

enum { PER_THREAD = 4096 }; /* pairs that are worth a thread: 50 us */

/* ---- bodies ---- */

static int small_bodies(struct small_list *l, const struct packing *p, struct failure *failure)
{
    struct small *s = &l->s;
    const int64_t n = p->n + 2;
    if (s->bodies == p->n && s->body) return 0;
    s->bodies = p->n;
    s->place = lay_lines(n, sizeof *s->place), s->body = lay_lines(n, sizeof *s->body);
    s->before = lay_lines(n, sizeof *s->before), s->hot = calloc((size_t)n, sizeof *s->hot);
    s->change = calloc((size_t)n, sizeof *s->change);
    l->listed = calloc((size_t)n, sizeof *l->listed);
    l->drift = calloc((size_t)n, sizeof *l->drift);
    if (!s->place || !s->body || !s->before || !s->hot || !s->change || !l->listed || !l->drift)
        return failure_set(failure, EX_SOFTWARE, "no memory for small steps");
    for (int k = 0; k < 2; k++) s->place[p->n + k].x[0] = k ? 1e100 : -1e100;
    for (int64_t i = 0; i < p->n; i++) {
        s->place[i].r = p->radius[i];
        if (!(p->mass[i] > 0)) continue;
        s->body[i].im = s->before[i].im = 1 / p->mass[i];
        s->body[i].ii = s->before[i].ii = 1 / p->inertia[i];
    }
    return 0;
}

/* ---- pairs ---- */

/* Leaves pairs of balls to l->pairs; others are meetings. */
static bool take_meetings(struct small_list *l, const struct packing *p)
{
    int64_t n = 0;
    bool room = true;
    for (int64_t i = 0; room && i < l->pairs.n; i++) {
        const struct pair pair = l->pairs.pair[i];
        if (small_meets(p, pair.a, pair.b))
            room = small_meetings_add(&l->meetings, p, small_pair_key(&pair));
        else
            l->pairs.pair[n++] = pair;
    }
    l->pairs.n = n;
    return room;
}

/* Pairs of images that move; false when memory is short. */
static bool list_images(struct small_list *l)
{
    if (!l->s.moves) return true;
    l->image = malloc((size_t)(l->pairs.n + 1) * sizeof *l->image);
    for (int64_t i = 0; l->image && i < l->pairs.n; i++) {
        const int8_t *k = l->pairs.pair[i].shift;
        if (k[0] || k[1] || k[2]) l->image[l->images++] = i;
    }
    return l->image != NULL;
}

/* ---- walls ---- */

static bool add_touch(struct small_list *l, const struct packing *p, int32_t w, int32_t i)
{
    const int32_t m = packing_pair(p, -1 - w, i);
    if (!array_grow(&l->touch, &l->room, l->touches + 1, sizeof *l->touch)) return false;
    struct small_touch *t = &l->touch[l->touches++];
    *t = (struct small_touch){ .wall = w, .body = i, .mu = p->mu[m], .e = { p->en[m], p->et[m] } };
    contact_laws_rolling(p, -1 - w, i, &t->most[1], &t->most[0]);
    if (l->s.hold) small_tie_set(t->hold, p, -1 - w, i, p->dt);
    const double im = l->s.body[i].im, r = p->radius[i];
    if (l->stiffness)
        small_stiff_set(t->spring, l->stiffness, p, -1 - w, i, im, im + r * r * l->s.body[i].ii);
    return true;
}

/* Has the mesh of wall w elements at most `most` (m) from x, or nearly? */
static bool near_mesh(const struct small_list *l, const struct packing *p, const struct pose *pose,
                      int32_t w, vec3 x, double most)
{
    const struct surface *s = &l->surface[w];
    struct surface_walk walk;
    struct surface_branch leaf;
    const vec3 c = v3_sub(quat_turn_back(pose->q, v3_sub(x, pose->shift)), p->wall[w].x);
    if (!s->n) return false;
    surface_walk_begin(&walk, s->n);
    return surface_walk_next(&walk, s->box, c, most, &leaf);
}

/* Has body i pushed wall w in this interval? */
static bool touch_has_pushed(const struct small_list *l, int32_t i, int32_t w)
{
    const struct small_touch *t = small_list_find_touch(l, i, w);
    return t && (!small_is_zero(t->f) || !small_is_zero(t->sum) || t->hold[HOLD_JOINED] < 0);
}

/* Does body i come near wall w, where `pose` has brought it? */
static bool near_wall(const struct small_list *l, const struct packing *p, const struct pose *pose,
                      int32_t w, int32_t i, vec3 x)
{
    vec3 n;
    const double most = p->radius[i] + l->margin + l->serves * (v3_norm(l->drift[i]) + l->wall);
    if (!packing_may_meet(p, -1 - w, i)) return false;
    if (p->wall[w].shape == WALL_MESH) return near_mesh(l, p, pose, w, x, most);
    return small_wall_distance(p, pose, w, x, most, &n) <= most;
}

/* Touches and meetings with walls; those that have pushed in this interval stay, however far they are. */
static bool find_touches(struct small_list *l, const struct small_list *from,
                         const struct packing *p, const vec3 *x, double t)
{
    struct pose *pose = malloc(((size_t)p->walls + 1) * sizeof *pose);
    bool room = pose != NULL;
    for (int32_t w = 0; room && w < p->walls; w++) pose[w] = wall_pose(p, &p->wall[w], t);
    for (int32_t i = 0; room && i < p->n; i++)
        for (int32_t w = 0; room && w < p->walls; w++) {
            const bool near = wall_there(&p->wall[w], t) && near_wall(l, p, &pose[w], w, i, x[i]);
            if (small_meets(p, -1 - w, i)) {
                if (near)
                    room = small_meetings_add(&l->meetings, p,
                                              (struct contact_key){ .a = -1 - w, .b = i });
            } else if (near || touch_has_pushed(from, i, w)) {
                room = add_touch(l, p, w, i);
            }
        }
    free(pose);
    return room;
}

static void carry_touches(struct small_list *to, const struct small_list *from)
{
    for (int64_t i = 0; i < from->touches; i++) {
        const struct small_touch *t = &from->touch[i];
        struct small_touch *same = small_list_find_touch(to, t->body, t->wall);
        if (same) *same = *t;
    }
}

/* ---- ways ---- */

/* Of the smallest radius: the way of the fastest body, against the mean of all, that a list is to serve: a longer one has many pairs that
   do not meet */
#define LONG 1

/* The straight ways of bodies, and for how long the list serves, 0 where they have none */
static void set_ways(struct small_list *l, const struct packing *p, const struct small_start *o,
                     vec3 *mean)
{
    double most = 0;
    *mean = v3(0, 0, 0);
    memcpy(l->listed, o->x, (size_t)p->n * sizeof *o->x);
    l->serves = l->since = l->strays = l->walls = l->wall = 0;
    if (!o->v || !p->n) return;
    memcpy(l->drift, o->v, (size_t)p->n * sizeof *o->v);
    for (int64_t i = 0; i < p->n; i++) *mean = v3_axpy(*mean, 1.0 / (double)p->n, o->v[i]);
    for (int64_t i = 0; i < p->n; i++) most = dmax(most, v3_norm(v3_sub(o->v[i], *mean)));
    most = fmax(most, o->wall);
    const double way = LONG * packing_whole(p).small;
    l->serves = most * o->span > way ? way / most : o->span, l->wall = o->wall;
}

/* Do the bodies of a pair come nearer than the margin on their ways? */
static bool comes_near(const struct small_list *l, const struct packing *p, const vec3 edge[3],
                       const struct pair *pair)
{
    const double most = p->radius[pair->a] + p->radius[pair->b] + l->margin;
    vec3 d = v3_sub(l->listed[pair->b], l->listed[pair->a]);
    const vec3 u = v3_sub(l->drift[pair->b], l->drift[pair->a]);
    if (cell_repeats(&p->cell)) d = v3_add(d, cell_shift(edge, pair->shift));
    const double closes = -v3_dot(d, u), u2 = v3_dot(u, u);
    const double t = closes > 0 ? fmin(l->serves, closes / u2) : 0;
    const vec3 least = v3_axpy(d, t, u);
    return v3_dot(least, least) <= most * most;
}

/* Which pairs do */
struct small_ways {
    const struct small_list *l;
    const struct packing *p;
    const vec3 *edge;
    bool *near; /* [pairs] */
};

static void look_along_ways(void *arg, int64_t first, int64_t end)
{
    const struct small_ways *o = arg;
    for (int64_t i = first; i < end; i++)
        o->near[i] = comes_near(o->l, o->p, o->edge, &o->l->pairs.pair[i]);
}

/* Leaves those that come near; false when memory is short. */
static bool keep_near(struct small_list *l, const struct packing *p, const vec3 edge[3])
{
    int64_t n = 0;
    struct small_ways o = { l, p, edge, malloc((size_t)l->pairs.n + 1) };
    if (!o.near) return false;
    team_share(team_size(), l->pairs.n, PER_THREAD, look_along_ways, &o);
    for (int64_t i = 0; i < l->pairs.n; i++)
        if (o.near[i]) l->pairs.pair[n++] = l->pairs.pair[i];
    l->pairs.n = n;
    free(o.near);
    return true;
}

/* Pairs that come near: sought among those whose bodies, in the middle of their ways, are as large as half of these */
static int seek_along(struct small_list *l, const struct packing *p, const struct small_start *o,
                      vec3 mean, struct failure *failure)
{
    const double half = 0.5 * l->serves;
    struct packing wide = *p;
    vec3 *x = malloc((size_t)(p->n + 1) * sizeof *x);
    double *radius = malloc((size_t)(p->n + 1) * sizeof *radius);
    l->pairs = (struct pairs){ .bodies = p->n, .reach = l->margin };
    if (l->part) l->pairs.part = l->part->ranks->me, l->pairs.parts = l->part->ranks->n;
    for (int64_t i = 0; x && radius && i < p->n; i++) {
        x[i] = v3_axpy(l->listed[i], half, l->drift[i]);
        radius[i] = p->radius[i] + half * v3_norm(v3_sub(l->drift[i], mean));
    }
    wide.radius = radius;
    if (!x || !radius ||
        (!seek_pairs(&l->pairs, &wide, x, o->edge, failure) && !keep_near(l, p, o->edge)))
        failure_set(failure, EX_SOFTWARE, "no memory for small steps");
    free(x), free(radius);
    return l->part ? small_part_join(&l->pairs, l->part->ranks, failure) : failure->status;
}

/* ---- the list ---- */

int small_list_make(struct small_list *l, const struct packing *p, const struct small_start *o,
                    struct failure *failure)
{
    struct small_list was;
    bool room = true;
    vec3 mean;
    if (small_bodies(l, p, failure)) return failure->status;
    if (!l->stiffness && small_stiff_acts(p) && !(l->stiffness = small_stiff_table(p, l->interval)))
        return failure_set(failure, EX_SOFTWARE, "no memory for the springs");
    was = *l;
    small_list_forget(l);
    l->spare = SMALL_MARGIN * packing_whole(p).small;
    l->margin = l->spare + small_tie_reach(p), l->s.slack = CLOSE * l->margin;
    set_ways(l, p, o, &mean);
    if (!seek_along(l, p, o, mean, failure)) {
        room = (!p->shape || take_meetings(l, p)) && small_keep_pairs(l, &was) &&
               small_pairs_lay(l, p, o->x, o->edge) && list_images(l) &&
               find_touches(l, &was, p, o->x, o->t) &&
               ((!p->shape && !p->mesh.elements) ||
                small_meetings_lay(&l->meetings, p, &was.meetings));
        if (room) small_carry_pairs(l, &was), carry_touches(l, &was);
        if (room) small_meetings_carry(&l->meetings, &was.meetings);
    }
    if (!room) failure_set(failure, EX_SOFTWARE, "no memory for small steps");
    small_list_empty(&was);
    return failure->status;
}
