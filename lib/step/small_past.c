/* step/small_past.c: what pairs and touches of small steps remember [step/small_past.h]. */
#include "step/small_past.h"

#include <stdlib.h>
#include <string.h>

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

static bool pair_has_pushed(const struct small_list *l, int64_t i)
{
    const struct small *s = &l->s;
    const int64_t at = l->slot[i] / BUNDLE;
    const int k = (int)(l->slot[i] % BUNDLE);
    const struct small_bundle *c = &s->bundle[at];
    bool pushed = s->hold && s->hold[at].x[HOLD_JOINED][k] < 0;
    for (int j = 0; j < 3; j++) pushed = pushed || c->f[j][k] != 0 || c->sum[j][k] != 0;
    return pushed;
}

/* Has it anything else of the past? */
static bool pair_holds(const struct small *s, int64_t slot)
{
    const int64_t at = slot / BUNDLE;
    const int k = (int)(slot % BUNDLE);
    const struct small_springs *x = s->spring ? &s->spring[at] : NULL;
    const struct small_holds *h = s->hold ? &s->hold[at] : NULL;
    return (h && (h->x[HOLD_WET][k] > 0 || h->x[HOLD_PULL][k] > 0)) ||
           (x && (x->x[SPRING_REST][k] < 0 || x->x[SPRING_DUE][k] > 0 || x->x[SPRING_HELD][k] > 0));
}

static int pair_order(const void *x, const void *y)
{
    return contact_key_order(small_pair_key(x), small_pair_key(y));
}

bool small_keep_pairs(struct small_list *to, const struct small_list *from)
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
        k = small_list_pair_before(to, k, n, small_pair_key(&from->pairs.pair[i]), &found);
        if (!found) p->pair[p->n++] = from->pairs.pair[i];
    }
    if (p->n > n) qsort(p->pair, (size_t)p->n, sizeof *p->pair, pair_order);
    return true;
}

void small_carry_pairs(struct small_list *to, const struct small_list *from)
{
    int64_t k = 0;
    bool found;
    for (int64_t i = 0; i < from->pairs.n; i++) {
        if (!pair_has_pushed(from, i) && !pair_holds(&from->s, from->slot[i])) continue;
        const struct small_past x = small_slot_past(&from->s, from->slot[i]);
        k = small_list_pair(to, k, small_pair_key(&from->pairs.pair[i]), &found);
        if (found) small_slot_set_past(&to->s, to->slot[k], &x);
    }
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
        struct small_meeting *m =
            small_meets(p, r->a, r->b) ? small_meetings_find(&l->meetings, recall_key(r)) : NULL;
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
        const int64_t at = l->slot[i] / BUNDLE;
        const int k = (int)(l->slot[i] % BUNDLE);
        const struct small_bundle *c = &l->s.bundle[at];
        const struct small_turn *t = l->s.turn ? &l->s.turn[at] : NULL;
        const double f[3] = { c->f[0][k], c->f[1][k], c->f[2][k] };
        const double moment[3] = { t ? t->m[0][k] : 0, t ? t->m[1][k] : 0, t ? t->m[2][k] : 0 };
        remember_one(&m, small_pair_key(&l->pairs.pair[i]), f, moment, 1 / part);
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
