/* step/small_list.c: what pairs and touches have of the past, found and remembered [step/small_list.h]. */
#include "step/small_list.h"

#include <stdlib.h>
#include <string.h>

void small_list_free_arrays(struct small_list *l)
{
    struct small *s = &l->s;
    free(s->bundle), free(s->turn), free(s->shift), free(s->hold), free(s->stick), free(s->spring),
        free(s->live), free(s->late), free(s->until), free(s->group);
    free(l->slot), free(l->early), free(l->image), free(l->touch), free(l->pairs.pair);
    small_meetings_free(&l->meetings);
}

void small_list_forget(struct small_list *l)
{
    struct small *s = &l->s;
    s->bundle = NULL, s->turn = NULL, s->shift = NULL, s->hold = NULL, s->stick = NULL,
    s->spring = NULL, s->live = s->late = NULL, s->until = NULL, s->group = NULL;
    s->bundles = s->groups = s->serial = 0;
    l->slot = l->early = l->image = NULL, l->images = 0, l->touch = NULL, l->touches = l->room = 0;
    l->pairs = (struct pairs){ 0 }, l->meetings = (struct small_meetings){ 0 };
}

void small_list_free(struct small_list *l)
{
    small_list_free_arrays(l);
    free(l->s.place), free(l->s.body), free(l->s.before), free(l->s.hot), free(l->s.change);
    free(l->listed), free(l->drift), free(l->stiffness);
    *l = (struct small_list){ 0 };
}

struct small_past small_slot_past(const struct small *s, int64_t slot)
{
    struct small_past x = { 0 };
    const int k = (int)(slot % BUNDLE);
    const int64_t i = slot / BUNDLE;
    const struct small_bundle *c = &s->bundle[i];
    for (int j = 0; j < 3; j++)
        x.f[j] = c->f[j][k], x.couple[j] = c->couple[j][k], x.sum[j] = c->sum[j][k];
    for (int j = 0; j < 3 && s->turn; j++)
        x.m[j] = s->turn[i].m[j][k], x.turned[j] = s->turn[i].sum[j][k];
    for (int j = 0; j < HOLD_COUNT && s->hold; j++) x.held[j] = s->hold[i].x[j][k];
    for (int j = 0; j < SPRING_COUNT && s->spring; j++) x.spring[j] = s->spring[i].x[j][k];
    return x;
}

void small_list_wake(struct small *s, int64_t slot)
{
    memset(&s->live[slot / BUNDLE * BUNDLE], 1, BUNDLE);
}

void small_slot_set_past(struct small *s, int64_t slot, const struct small_past *x)
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

int64_t small_list_pair_before(const struct small_list *l, int64_t from, int64_t end,
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
    return small_list_pair_before(l, from, l->pairs.n, key, found);
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
        if (found) small_slot_set_past(&l->s, l->slot[at], &x);
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
        const int64_t slot = l->slot[i];
        const int k = (int)(slot % BUNDLE);
        const struct small_bundle *c = &l->s.bundle[slot / BUNDLE];
        const struct small_turn *t = l->s.turn ? &l->s.turn[slot / BUNDLE] : NULL;
        const double f[3] = { c->f[0][k], c->f[1][k], c->f[2][k] };
        const double moment[3] = { t ? t->m[0][k] : 0, t ? t->m[1][k] : 0, t ? t->m[2][k] : 0 };
        remember_one(&m, small_pair_key(&l->pairs.pair[i]), f, moment, 1 / part);
    }
    for (int64_t i = 0; i < l->meetings.n; i++) {
        const struct small_meeting *y = &l->meetings.of[i];
        struct contact_key k = y->key;
        for (int64_t j = 0; j < y->points; j++) {
            k.feature = y->point[j].feature;
            remember_one(&m, k, y->point[j].f, y->point[j].m, 1 / part);
        }
    }
    if (l->meetings.n) memory_sort(&m);
    free(by);
    memory_free(&p->memory);
    p->memory = m;
    return 0;
}
