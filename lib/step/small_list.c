/* step/small_list.c: pairs with a margin, in groups without a common body [step/small_list.h]. */
#include "step/small_list.h"

#include "base/array.h"
#include "contact/contact_law.h"
#include "solve/lay.h"
#include "step/small_stiff.h"

#include <stdlib.h>
#include <string.h>

/* Of the smallest radius: how much farther than contacts pairs are listed, and how near those are that come first */
#define MARGIN 0.3
#define BESIDE 0.1
/* Of the margin: by how much sooner pairs are looked at again than bounds of ways say */
#define CLOSE 1e-3

enum { COLOURS = 64 };

static void small_arrays_free(struct small_list *l)
{
    struct small *s = &l->s;
    free(s->bundle), free(s->turn), free(s->shift), free(s->hold), free(s->stick), free(s->spring),
        free(s->live), free(s->late), free(s->until), free(s->group);
    free(l->slot), free(l->image), free(l->touch), free(l->pairs.pair);
    small_meetings_free(&l->meetings);
}

/* The list has none of them. */
static void small_forget(struct small_list *l)
{
    struct small *s = &l->s;
    s->bundle = NULL, s->turn = NULL, s->shift = NULL, s->hold = NULL, s->stick = NULL,
    s->spring = NULL, s->live = s->late = NULL, s->until = NULL, s->group = NULL;
    s->bundles = s->groups = s->serial = 0;
    l->slot = l->image = NULL, l->images = 0, l->touch = NULL, l->touches = l->room = 0;
    l->pairs = (struct pairs){ 0 }, l->meetings = (struct small_meetings){ 0 };
}

void small_list_free(struct small_list *l)
{
    small_arrays_free(l);
    free(l->s.place), free(l->s.body), free(l->s.before), free(l->s.hot), free(l->s.change);
    free(l->listed), free(l->drift), free(l->stiffness);
    *l = (struct small_list){ 0 };
}

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

/* ---- groups ---- */

/* A pair's group; those of a class come after those of the classes before. */
struct small_colours {
    uint64_t *used; /* [bodies] */
    uint8_t *of;    /* [pairs] its colour; COLOURS: none is left */
    int64_t count[2][COLOURS + 1];
};

static double pair_gap(const struct packing *p, const vec3 *x, const vec3 *edge,
                       const struct pair *pair)
{
    vec3 d = v3_sub(x[pair->b], x[pair->a]);
    if (cell_repeats(&p->cell)) d = v3_add(d, cell_shift(edge, pair->shift));
    return v3_norm(d) - p->radius[pair->a] - p->radius[pair->b];
}

static void colour_class(struct small_colours *c, const struct packing *p,
                         const struct small_list *l, const bool *beside, int class)
{
    memset(c->used, 0, (size_t)p->n * sizeof *c->used);
    for (int64_t i = 0; i < l->pairs.n; i++) {
        const struct pair *pair = &l->pairs.pair[i];
        if (beside[i] != !class) continue;
        const uint64_t free = ~(c->used[pair->a] | c->used[pair->b]);
        const int k = free ? __builtin_ctzll(free) : COLOURS;
        c->of[i] = (uint8_t)k, c->count[class][k]++;
        if (free) c->used[pair->a] |= 1ULL << k, c->used[pair->b] |= 1ULL << k;
    }
}

static int64_t in_bundles(int64_t pairs)
{
    return (pairs + BUNDLE - 1) / BUNDLE;
}

/* Groups and slots of all pairs; false when memory is short. */
static bool small_lay(struct small_list *l, struct small_colours *c, const bool *beside)
{
    struct small *s = &l->s;
    int64_t next[2][COLOURS + 1], groups = 0, alone = c->count[0][COLOURS] + c->count[1][COLOURS];
    s->group = malloc((size_t)(2 * COLOURS + alone + 1) * sizeof *s->group);
    if (!s->group) return false;
    s->bundles = 0;
    for (int class = 0; class < 2; class ++)
        for (int k = 0; k < COLOURS; k++) {
            next[class][k] = BUNDLE * s->bundles;
            if (!c->count[class][k]) continue;
            s->group[groups++] = s->bundles;
            s->bundles += in_bundles(c->count[class][k]);
        }
    s->serial = groups;
    for (int class = 0; class < 2; class ++) {
        next[class][COLOURS] = BUNDLE * s->bundles;
        for (int64_t i = 0; i < c->count[class][COLOURS]; i++) s->group[groups++] = s->bundles++;
    }
    s->groups = groups, s->group[groups] = s->bundles;
    for (int64_t i = 0; i < l->pairs.n; i++) {
        int64_t *at = &next[!beside[i]][c->of[i]];
        l->slot[i] = *at;
        *at += c->of[i] == COLOURS ? BUNDLE : 1;
    }
    return true;
}

static bool small_colour(struct small_list *l, const struct packing *p, const vec3 *x,
                         const vec3 *edge)
{
    struct small_colours c = { .used = malloc((size_t)(p->n + 1) * sizeof *c.used),
                               .of = malloc((size_t)l->pairs.n + 1) };
    bool *beside = malloc((size_t)l->pairs.n + 1);
    l->slot = malloc((size_t)(l->pairs.n + 1) * sizeof *l->slot);
    bool room = c.used && c.of && beside && l->slot;
    const double near = BESIDE / MARGIN * l->spare;
    for (int64_t i = 0; room && i < l->pairs.n; i++)
        beside[i] = pair_gap(p, x, edge, &l->pairs.pair[i]) <= near;
    for (int class = 0; room && class < 2; class ++) colour_class(&c, p, l, beside, class);
    room = room && small_lay(l, &c, beside);
    free(c.used), free(c.of), free(beside);
    return room;
}

/* ---- pairs ---- */

static void set_pair(struct small_list *l, const struct packing *p, const vec3 *edge, int64_t i)
{
    const struct pair *pair = &l->pairs.pair[i];
    const int32_t m = packing_pair(p, pair->a, pair->b);
    const int k = (int)(l->slot[i] % BUNDLE);
    struct small_bundle *c = &l->s.bundle[l->slot[i] / BUNDLE];
    c->a[k] = body_place(pair->a), c->b[k] = body_place(pair->b);
    c->mu[k] = p->mu[m], c->e[0][k] = p->en[m], c->e[1][k] = p->et[m];
    if (l->s.shift) {
        vec3 d = cell_shift(edge, pair->shift);
        small_shift_set(&l->s.shift[l->slot[i] / BUNDLE], k, d,
                        cell_shift(p->cell.rate, pair->shift));
    }
    if (l->s.hold) {
        double x[HOLD_COUNT];
        small_tie_set(x, p, pair->a, pair->b, p->dt);
        for (int j = 0; j < HOLD_COUNT; j++) l->s.hold[l->slot[i] / BUNDLE].x[j][k] = x[j];
    }
    if (l->s.spring) {
        const struct body *a = &l->s.body[pair->a], *b = &l->s.body[pair->b];
        const double ra = p->radius[pair->a], rb = p->radius[pair->b], wn = a->im + b->im;
        double x[SPRING_COUNT] = { 0 };
        small_stiff_set(x, l->stiffness, p, pair->a, pair->b, wn,
                        wn + ra * ra * a->ii + rb * rb * b->ii);
        for (int j = 0; j < SPRING_COUNT; j++) l->s.spring[l->slot[i] / BUNDLE].x[j][k] = x[j];
    }
    if (l->s.stick) {
        struct small_stick *t = &l->s.stick[l->slot[i] / BUNDLE];
        double mu[2];
        small_tie_stick(mu, &t->v_s[k], p, m);
        t->mu[0][k] = mu[0], t->mu[1][k] = mu[1];
    }
    if (!l->s.turn) return;
    struct small_turn *t = &l->s.turn[l->slot[i] / BUNDLE];
    contact_laws_rolling(p, pair->a, pair->b, &t->most[1][k], &t->most[0][k]);
}

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

static bool small_pairs_lay(struct small_list *l, const struct packing *p, const vec3 *x,
                            const vec3 edge[3])
{
    struct small *s = &l->s;
    if (!small_colour(l, p, x, edge)) return false;
    s->bundle = lay_lines(s->bundles, sizeof *s->bundle);
    if (packing_rolls(p)) s->turn = lay_lines(s->bundles, sizeof *s->turn);
    if (cell_repeats(&p->cell)) s->shift = lay_lines(s->bundles, sizeof *s->shift);
    if (small_tie_holds(p)) s->hold = lay_lines(s->bundles, sizeof *s->hold);
    if (packing_sticks(p)) s->stick = lay_lines(s->bundles, sizeof *s->stick);
    if (l->stiffness) s->spring = lay_lines(s->bundles, sizeof *s->spring);
    s->live = calloc((size_t)(s->bundles + 1), BUNDLE);
    s->late = calloc((size_t)(s->bundles + 1), BUNDLE);
    s->until = calloc((size_t)(s->bundles + 1), BUNDLE * sizeof *s->until);
    if (!s->bundle || (packing_rolls(p) && !s->turn) || (cell_repeats(&p->cell) && !s->shift) ||
        (small_tie_holds(p) && !s->hold) || (packing_sticks(p) && !s->stick) ||
        (l->stiffness && !s->spring) || !s->live || !s->late || !s->until)
        return false;
    for (int64_t i = 0; i < s->bundles; i++)
        for (int k = 0; k < BUNDLE; k++)
            s->bundle[i].a[k] = body_place(p->n), s->bundle[i].b[k] = body_place(p->n + 1);
    for (int64_t i = 0; i < l->pairs.n; i++) set_pair(l, p, edge, i);
    return true;
}

/* What a slot has of the past */
struct small_past {
    double f[3], couple[3], m[3], sum[3], turned[3];
    double held[HOLD_COUNT];     /* from HOLD_WET on */
    double spring[SPRING_COUNT]; /* from SPRING_REST to SPRING_GIVEN */
};

static struct small_past past_of(const struct small *s, int64_t slot)
{
    struct small_past x;
    const int k = (int)(slot % BUNDLE);
    const struct small_bundle *c = &s->bundle[slot / BUNDLE];
    for (int j = 0; j < 3; j++) {
        x.f[j] = c->f[j][k], x.couple[j] = c->couple[j][k], x.sum[j] = c->sum[j][k];
        x.m[j] = s->turn ? s->turn[slot / BUNDLE].m[j][k] : 0;
        x.turned[j] = s->turn ? s->turn[slot / BUNDLE].sum[j][k] : 0;
    }
    for (int j = 0; j < HOLD_COUNT; j++) x.held[j] = s->hold ? s->hold[slot / BUNDLE].x[j][k] : 0;
    for (int j = 0; j < SPRING_COUNT; j++)
        x.spring[j] = s->spring ? s->spring[slot / BUNDLE].x[j][k] : 0;
    return x;
}

/* Does the reaction of a slot persist? */
static bool pair_pushes(const struct small *s, int64_t slot)
{
    const struct small_bundle *c = &s->bundle[slot / BUNDLE];
    const int k = (int)(slot % BUNDLE);
    return c->f[0][k] != 0 || c->f[1][k] != 0 || c->f[2][k] != 0;
}

void small_list_wake(struct small *s, int64_t slot)
{
    memset(&s->live[slot / BUNDLE * BUNDLE], 1, BUNDLE);
}

static void set_past(struct small *s, int64_t slot, const struct small_past *x)
{
    const int k = (int)(slot % BUNDLE);
    struct small_bundle *c = &s->bundle[slot / BUNDLE];
    for (int j = 0; j < 3; j++) {
        c->f[j][k] = x->f[j], c->couple[j][k] = x->couple[j], c->sum[j][k] = x->sum[j];
        if (!s->turn) continue;
        s->turn[slot / BUNDLE].m[j][k] = x->m[j], s->turn[slot / BUNDLE].sum[j][k] = x->turned[j];
    }
    for (int j = HOLD_WET; j < HOLD_COUNT && s->hold; j++)
        s->hold[slot / BUNDLE].x[j][k] = x->held[j];
    for (int j = SPRING_REST; j <= SPRING_GIVEN && s->spring; j++)
        s->spring[slot / BUNDLE].x[j][k] = x->spring[j];
    if (!small_is_zero(x->f) || x->held[HOLD_WET] > 0 || x->held[HOLD_PULL] > 0)
        small_list_wake(s, slot);
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

vec3 small_slot_force(const struct small *s, int64_t slot)
{
    const int k = (int)(slot % BUNDLE);
    const struct small_bundle *c = &s->bundle[slot / BUNDLE];
    const vec3 f = v3(c->f[0][k], c->f[1][k], c->f[2][k]);
    if (!s->hold) return f;
    const vec3 d = small_branch(s, slot);
    return v3_axpy(f, -s->hold[slot / BUNDLE].x[HOLD_PULL][k] / v3_norm(d), d);
}

struct contact_key small_pair_key(const struct pair *q)
{
    return (struct contact_key){ q->a, q->b, 0, { q->shift[0], q->shift[1], q->shift[2] } };
}

/* small_list_pair() among the first `end` pairs */
static int64_t find_pair(const struct small_list *l, int64_t from, int64_t end,
                         struct contact_key key, bool *found)
{
    int order = -1;
    while (from < end && (order = contact_key_order(small_pair_key(&l->pairs.pair[from]), key)) < 0)
        from++;
    *found = order == 0;
    return from;
}

int64_t small_list_pair(const struct small_list *l, int64_t from, struct contact_key key,
                        bool *found)
{
    return find_pair(l, from, l->pairs.n, key, found);
}

static bool has_pushed(const double f[3], const double sum[3], const double held[HOLD_COUNT])
{
    return !small_is_zero(f) || !small_is_zero(sum) || held[HOLD_JOINED] < 0;
}

static bool pair_has_pushed(const struct small_list *l, int64_t i)
{
    const struct small_past x = past_of(&l->s, l->slot[i]);
    return has_pushed(x.f, x.sum, x.held);
}

static int pair_order(const void *x, const void *y)
{
    return contact_key_order(small_pair_key(x), small_pair_key(y));
}

/* Pairs that have pushed in this interval stay in the list, however far they are: the frame has them. */
static bool keep_pairs(struct small_list *to, const struct small_list *from)
{
    struct pairs *p = &to->pairs;
    const int64_t n = p->n;
    int64_t k = 0, more = 0;
    bool found;
    for (int64_t i = 0; i < from->pairs.n; i++) more += pair_has_pushed(from, i);
    struct pair *pair = realloc(p->pair, (size_t)(n + more + 1) * sizeof *pair);
    if (!pair) return false;
    p->pair = pair;
    for (int64_t i = 0; i < from->pairs.n; i++) {
        if (!pair_has_pushed(from, i)) continue;
        k = find_pair(to, k, n, small_pair_key(&from->pairs.pair[i]), &found);
        if (!found) p->pair[p->n++] = from->pairs.pair[i];
    }
    if (p->n > n) qsort(p->pair, (size_t)p->n, sizeof *p->pair, pair_order);
    return true;
}

/* Pairs that were in the list before */
static void carry_pairs(struct small_list *to, const struct small_list *from)
{
    int64_t k = 0;
    bool found;
    for (int64_t i = 0; i < from->pairs.n; i++) {
        const struct small_past x = past_of(&from->s, from->slot[i]);
        const bool holds = x.held[HOLD_WET] > 0 || x.held[HOLD_PULL] > 0 ||
                           x.spring[SPRING_REST] < 0 || x.spring[SPRING_DUE] > 0 ||
                           x.spring[SPRING_HELD] > 0;
        if (!holds && !has_pushed(x.f, x.sum, x.held)) continue;
        k = small_list_pair(to, k, small_pair_key(&from->pairs.pair[i]), &found);
        if (found) set_past(&to->s, to->slot[k], &x);
    }
}

/* ---- walls ---- */

double small_wall_distance(const struct packing *p, const struct pose *pose, int32_t w, vec3 x,
                           double r, vec3 *n)
{
    const struct wall *wall = &p->wall[w];
    struct touch t;
    vec3 c = v3_sub(quat_turn_back(pose->q, v3_sub(x, pose->shift)), wall->x);
    if (wall->shape == WALL_PLANE) {
        t.n = wall->n, t.distance = v3_dot(c, wall->n);
    } else if (!wall_nearest(wall, p->dim, c, r, &t)) {
        return INFINITY;
    }
    *n = quat_turn(pose->q, t.n);
    return t.distance;
}

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

int64_t small_list_touch(const struct small_list *l, int64_t body, int32_t wall)
{
    int64_t lo = 0, hi = l->touches;
    while (lo < hi) {
        const int64_t mid = lo + (hi - lo) / 2;
        const struct small_touch *t = &l->touch[mid];
        if (t->body < body || (t->body == body && t->wall < wall))
            lo = mid + 1;
        else
            hi = mid;
    }
    return lo;
}

struct small_touch *small_list_find_touch(const struct small_list *l, int32_t body, int32_t wall)
{
    const int64_t k = small_list_touch(l, body, wall);
    return k < l->touches && l->touch[k].body == body && l->touch[k].wall == wall ? &l->touch[k]
                                                                                  : NULL;
}

/* Has body i pushed wall w in this interval? */
static bool touch_has_pushed(const struct small_list *l, int32_t i, int32_t w)
{
    const struct small_touch *t = small_list_find_touch(l, i, w);
    return t && has_pushed(t->f, t->sum, t->hold);
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
    for (int64_t i = 0; i < p->n; i++) most = fmax(most, v3_norm(v3_sub(o->v[i], *mean)));
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

/* Pairs that come near: sought among those whose bodies, in the middle of their ways, are as large as half of these */
static int seek_along(struct small_list *l, const struct packing *p, const struct small_start *o,
                      vec3 mean, struct failure *failure)
{
    const double half = 0.5 * l->serves;
    struct packing wide = *p;
    vec3 *x = malloc((size_t)(p->n + 1) * sizeof *x);
    double *radius = malloc((size_t)(p->n + 1) * sizeof *radius);
    int64_t n = 0;
    l->pairs = (struct pairs){ .bodies = p->n, .reach = l->margin };
    for (int64_t i = 0; x && radius && i < p->n; i++) {
        x[i] = v3_axpy(l->listed[i], half, l->drift[i]);
        radius[i] = p->radius[i] + half * v3_norm(v3_sub(l->drift[i], mean));
    }
    wide.radius = radius;
    if (!x || !radius)
        failure_set(failure, EX_SOFTWARE, "no memory for small steps");
    else
        seek_pairs(&l->pairs, &wide, x, o->edge, failure);
    for (int64_t i = 0; i < l->pairs.n; i++)
        if (comes_near(l, p, o->edge, &l->pairs.pair[i])) l->pairs.pair[n++] = l->pairs.pair[i];
    l->pairs.n = n;
    free(x), free(radius);
    return failure->status;
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
    small_forget(l);
    l->spare = MARGIN * packing_whole(p).small;
    l->margin = l->spare + small_tie_reach(p), l->s.slack = CLOSE * l->margin;
    set_ways(l, p, o, &mean);
    if (!seek_along(l, p, o, mean, failure)) {
        room = (!p->shape || take_meetings(l, p)) && keep_pairs(l, &was) &&
               small_pairs_lay(l, p, o->x, o->edge) && list_images(l) &&
               find_touches(l, &was, p, o->x, o->t) &&
               ((!p->shape && !p->mesh.elements) ||
                small_meetings_lay(&l->meetings, p, &was.meetings));
        if (room) carry_pairs(l, &was), carry_touches(l, &was);
        if (room) small_meetings_carry(&l->meetings, &was.meetings);
    }
    if (!room) failure_set(failure, EX_SOFTWARE, "no memory for small steps");
    small_arrays_free(&was);
    return failure->status;
}

/* ---- reactions, from what the packing remembers ---- */

bool small_list_recall(struct small_list *l, const struct packing *p, double part)
{
    int64_t at = 0;
    bool found, room = true;
    for (int64_t i = 0; i < p->memory.n; i++) {
        const struct recall *r = &p->memory.recall[i];
        struct small_past x = { 0 };
        small_array(x.f, v3_scale(part, r->r)), small_array(x.m, v3_scale(part, r->m));
        for (int k = 0; k < 3; k++)
            x.sum[k] = -x.f[k], x.turned[k] = -x.m[k]; // the interval before has counted it
        struct small_meeting *m = small_meetings_find(&l->meetings, recall_key(r));
        if (m) {
            room = room && small_meeting_recall(m, r, part);
            continue;
        }
        if (r->a < 0) {
            struct small_touch *t = small_list_find_touch(l, r->b, -1 - r->a);
            if (!t) continue;
            memcpy(t->f, x.f, sizeof t->f), memcpy(t->m, x.m, sizeof t->m);
            memcpy(t->sum, x.sum, sizeof t->sum), memcpy(t->turned, x.turned, sizeof t->turned);
            continue;
        }
        at = small_list_pair(l, at, recall_key(r), &found);
        if (found) set_past(&l->s, l->slot[at], &x);
    }
    return room;
}

/* ---- and back ---- */

/* In the order of contacts: walls first, the last one of them first */
static int touch_key_order(const void *x, const void *y)
{
    const struct small_touch *s = *(const struct small_touch *const *)x;
    const struct small_touch *t = *(const struct small_touch *const *)y;
    if (s->wall != t->wall) return s->wall > t->wall ? -1 : 1;
    return s->body < t->body ? -1 : s->body > t->body;
}

struct small_touch **small_list_touches(const struct small_list *l)
{
    struct small_touch **by = malloc(((size_t)l->touches + 1) * sizeof(struct small_touch *));
    for (int64_t i = 0; by && i < l->touches; i++) by[i] = &l->touch[i];
    if (by) qsort(by, (size_t)l->touches, sizeof(struct small_touch *), touch_key_order);
    return by;
}

static void remember_one(struct memory *m, struct contact_key k, const double f[3],
                         const double moment[3], double times)
{
    if (small_is_zero(f)) return;
    m->recall[m->n++] = (struct recall){ k.a,
                                         k.b,
                                         k.feature,
                                         { k.shift[0], k.shift[1], k.shift[2] },
                                         v3_scale(times, small_vec(f)),
                                         v3_scale(times, small_vec(moment)) };
}

int small_list_remember(const struct small_list *l, struct packing *p, double part,
                        struct failure *failure)
{
    struct small_touch **by = small_list_touches(l);
    struct memory m = { .on = true, .room = l->touches + l->pairs.n };
    m.room += small_meetings_points(&l->meetings);
    m.recall = malloc((size_t)(m.room + 1) * sizeof *m.recall);
    if (!by || !m.recall) {
        free(by), free(m.recall);
        return failure_set(failure, EX_SOFTWARE, "no memory for the last reactions");
    }
    for (int64_t i = 0; i < l->touches; i++) {
        const struct contact_key k = { .a = -1 - by[i]->wall, .b = by[i]->body };
        remember_one(&m, k, by[i]->f, by[i]->m, 1 / part);
    }
    for (int64_t i = 0; i < l->pairs.n; i++) {
        if (!pair_pushes(&l->s, l->slot[i])) continue;
        const struct small_past x = past_of(&l->s, l->slot[i]);
        remember_one(&m, small_pair_key(&l->pairs.pair[i]), x.f, x.m, 1 / part);
    }
    for (int64_t i = 0; i < l->meetings.n; i++) {
        const struct small_meeting *y = &l->meetings.of[i];
        struct contact_key k = y->key;
        for (int64_t j = 0; j < y->points; j++) {
            k.feature = y->point[j].from ? y->point[j].from - 1 : y->point[j].feature;
            remember_one(&m, k, y->point[j].f, y->point[j].m, 1 / part);
        }
    }
    if (l->meetings.n) memory_sort(&m);
    free(by);
    memory_free(&p->memory);
    p->memory = m;
    return 0;
}
