/* step/small_tell.c: what processes that divide small steps tell each other [step/small_part.h]. */
#include "step/small_part.h"
#include "step/small_past.h"

#include <stdlib.h>
#include <string.h>

/* ---- copies ---- */

/* A body in a sweep */
struct told_motion {
    double v[3], w[3], change;
    int64_t hot;
};

/* A body as a step begins */
struct told_place {
    double x[3], v[3], w[3]; /* m; m/s, rad/s: before the step */
};

_Static_assert(sizeof(struct told_motion) <= MESSAGE * sizeof(double) &&
                   sizeof(struct told_place) <= MESSAGE * sizeof(double),
               "bodies have room in a message");

static void put_motion(struct told_motion *to, const struct small *s, int64_t i)
{
    memcpy(to->v, s->body[i].v, sizeof to->v), memcpy(to->w, s->body[i].w, sizeof to->w);
    to->change = s->change[i], to->hot = s->hot[i];
}

static void take_motion(const struct told_motion *from, struct small *s, int64_t i)
{
    memcpy(s->body[i].v, from->v, sizeof from->v), memcpy(s->body[i].w, from->w, sizeof from->w);
    s->change[i] = from->change, s->hot[i] = (int32_t)from->hot;
    if (s->hot[i] >= s->sweep - 1) small_mark_bundles(s, i);
}

static void send_motion(struct small_run *r, const struct small_wire *w, const int32_t *body,
                        int64_t n)
{
    struct told_motion *m = (struct told_motion *)(void *)r->part->message;
    for (int64_t k = 0; k < n; k++) put_motion(&m[k], &r->l->s, body[k]);
    if (n) r->part->ranks->send(r->part->ranks, w->rank, m, (size_t)n * sizeof *m);
}

static void receive_motion(struct small_run *r, const struct small_wire *w, const int32_t *body,
                           int64_t n)
{
    struct told_motion *m = (struct told_motion *)(void *)r->part->message;
    if (n) r->part->ranks->receive(r->part->ranks, w->rank, m, (size_t)n * sizeof *m);
    for (int64_t k = 0; k < n; k++) take_motion(&m[k], &r->l->s, body[k]);
}

void small_part_send(struct small_run *r, int64_t phase)
{
    for (int k = 0; k < r->part->wires; k++) {
        const struct small_wire *w = &r->part->wire[k];
        send_motion(r, w, w->go_body + w->go[phase], w->go[phase + 1] - w->go[phase]);
    }
}

void small_part_receive(struct small_run *r, int64_t phase)
{
    for (int k = 0; k < r->part->wires; k++) {
        const struct small_wire *w = &r->part->wire[k];
        receive_motion(r, w, w->come_body + w->come[phase], w->come[phase + 1] - w->come[phase]);
    }
}

void small_part_refresh(struct small_run *r)
{
    for (int k = 0; k < r->part->wires; k++)
        send_motion(r, &r->part->wire[k], r->part->wire[k].lend, r->part->wire[k].lends);
    for (int k = 0; k < r->part->wires; k++)
        receive_motion(r, &r->part->wire[k], r->part->wire[k].borrow, r->part->wire[k].borrows);
}

void small_part_begin(struct small_run *r)
{
    struct small_part *y = r->part;
    struct small *s = &r->l->s;
    struct told_place *m = (struct told_place *)(void *)y->message;
    for (int k = 0; k < y->wires; k++) {
        const struct small_wire *w = &y->wire[k];
        for (int64_t j = 0; j < w->lends; j++) {
            const struct body *was = &s->before[w->lend[j]];
            memcpy(m[j].x, s->place[w->lend[j]].x, sizeof m->x);
            memcpy(m[j].v, was->v, sizeof m->v), memcpy(m[j].w, was->w, sizeof m->w);
        }
        if (w->lends) y->ranks->send(y->ranks, w->rank, m, (size_t)w->lends * sizeof *m);
    }
    for (int k = 0; k < y->wires; k++) {
        const struct small_wire *w = &y->wire[k];
        if (w->borrows) y->ranks->receive(y->ranks, w->rank, m, (size_t)w->borrows * sizeof *m);
        for (int64_t j = 0; j < w->borrows; j++) {
            struct body *was = &s->before[w->borrow[j]];
            memcpy(s->place[w->borrow[j]].x, m[j].x, sizeof m->x);
            memcpy(was->v, m[j].v, sizeof m->v), memcpy(was->w, m[j].w, sizeof m->w);
        }
    }
}

/* ---- all ---- */

/* put or take `size` bytes at *at, which moves behind them */
typedef void tell_bytes(char **at, void *x, size_t size);

static void put_bytes(char **at, void *x, size_t size)
{
    memcpy(*at, x, size), *at += size;
}

static void take_bytes(char **at, void *x, size_t size)
{
    memcpy(x, *at, size), *at += size;
}

/* All that steps change of a body; what was before a step the next one needs. */
static void tell_body(struct small_run *r, int64_t i, char **at, tell_bytes tell)
{
    struct small *s = &r->l->s;
    tell(at, s->place[i].x, sizeof s->place->x), tell(at, &r->turned[i], sizeof *r->turned);
    tell(at, s->body[i].v, sizeof s->body->v), tell(at, s->body[i].w, sizeof s->body->w);
    if (r->made < r->n)
        tell(at, s->before[i].v, sizeof s->before->v),
            tell(at, s->before[i].w, sizeof s->before->w);
    if (r->judged) tell(at, &s->missing[i], sizeof *s->missing);
    if (r->judged) tell(at, &s->load[i], sizeof *s->load);
    if (r->pull) tell(at, &r->pull[i], sizeof *r->pull);
}

enum { BODY_MOST = 20 * sizeof(double) + sizeof(struct small_pull) };

/* A touch or pair that has a past: its number, and as much of the past as there may be */
struct told_past {
    int64_t i;
    double work; /* J: of a touch */
    struct small_past past;
};

static size_t past_bytes(const struct small *s)
{
    if (s->spring) return sizeof(struct told_past);
    if (s->hold) return offsetof(struct told_past, past.spring);
    return s->turn ? offsetof(struct told_past, past.held) : offsetof(struct told_past, past.m);
}

/* Is x more than zeros without a sign? */
static bool has_bits(const void *x, size_t size)
{
    static const double none[sizeof(struct told_past) / sizeof(double)];
    return memcmp(x, none, size) != 0;
}

static void touch_past(const struct small_touch *t, struct told_past *x)
{
    memcpy(x->past.f, t->f, sizeof t->f), memcpy(x->past.couple, t->couple, sizeof t->couple);
    memcpy(x->past.sum, t->sum, sizeof t->sum), memcpy(x->past.m, t->m, sizeof t->m);
    memcpy(x->past.turned, t->turned, sizeof t->turned);
    memcpy(x->past.held, t->hold, sizeof t->hold);
    memcpy(x->past.spring, t->spring, sizeof t->spring);
    x->work = t->work;
}

static void touch_set_past(struct small_touch *t, const struct told_past *x, const struct small *s)
{
    memcpy(t->f, x->past.f, sizeof t->f), memcpy(t->couple, x->past.couple, sizeof t->couple);
    memcpy(t->sum, x->past.sum, sizeof t->sum), memcpy(t->m, x->past.m, sizeof t->m);
    memcpy(t->turned, x->past.turned, sizeof t->turned);
    if (s->hold) memcpy(t->hold, x->past.held, sizeof t->hold);
    if (s->spring) memcpy(t->spring, x->past.spring, sizeof t->spring);
    t->work = x->work;
}

/* Has a pair more than a place in the list? */
static bool pair_has_past(const struct small *s, int64_t slot)
{
    const struct small_bundle *c = &s->bundle[slot / BUNDLE];
    const int k = (int)(slot % BUNDLE);
    const double x[6] = { c->f[0][k],   c->f[1][k],   c->f[2][k],
                          c->sum[0][k], c->sum[1][k], c->sum[2][k] };
    return s->hold || s->spring || s->turn || has_bits(x, sizeof x);
}

/* Does nobody tell this process of the pair, which has one of its bodies? */
static bool is_swept_here(const struct small_run *r, const struct pair *q)
{
    return small_is_own(r, q->a) || small_is_own(r, q->b);
}

/* This process's own, into `at`, where there is room. Returns their end. */
static char *put_all(struct small_run *r, char *at)
{
    struct small_list *l = r->l;
    const size_t bytes = past_bytes(&l->s);
    int64_t count = 0;
    for (int64_t k = 0; k < r->part->owns; k++) tell_body(r, r->part->own[k], &at, put_bytes);
    char *many = at;
    put_bytes(&at, &count, sizeof count);
    for (int64_t i = 0; i < l->touches; i++) {
        struct told_past t = { .i = i };
        if (!small_is_own(r, l->touch[i].body)) continue;
        touch_past(&l->touch[i], &t);
        if (has_bits(&t.work, bytes - sizeof t.i)) put_bytes(&at, &t, bytes), count++;
    }
    put_bytes(&many, &count, sizeof count), count = 0, many = at;
    put_bytes(&at, &count, sizeof count);
    const int64_t swept = BUNDLE * l->s.group[l->s.groups];
    for (int64_t slot = 0; slot < swept; slot++) {
        struct told_past t = { .i = r->part->pair[slot] };
        if (t.i < 0 || !pair_has_past(&l->s, slot)) continue;
        if (!small_is_own(r, l->pairs.pair[t.i].b)) continue;
        t.past = small_slot_past(&l->s, slot);
        put_bytes(&at, &t, bytes), count++;
    }
    put_bytes(&many, &count, sizeof count);
    return at;
}

/* What rank q owns */
static void take_all(struct small_run *r, int q, char *at)
{
    struct small_list *l = r->l;
    const size_t bytes = past_bytes(&l->s);
    int64_t count;
    for (int64_t i = 0; i < l->s.bodies; i++)
        if (r->part->owner[i] == q) tell_body(r, i, &at, take_bytes);
    take_bytes(&at, &count, sizeof count);
    for (int64_t k = 0; k < count; k++) {
        struct told_past t = { 0 };
        take_bytes(&at, &t, bytes);
        touch_set_past(&l->touch[t.i], &t, &l->s);
    }
    take_bytes(&at, &count, sizeof count);
    for (int64_t k = 0; k < count; k++) {
        struct told_past t = { 0 };
        take_bytes(&at, &t, bytes);
        if (!is_swept_here(r, &l->pairs.pair[t.i]))
            small_slot_set_past(&l->s, l->slot[t.i], &t.past);
    }
}

/* What is not told of has no past. */
static void forget_all(struct small_run *r)
{
    struct small_list *l = r->l;
    const struct told_past none = { 0 };
    for (int64_t i = 0; i < l->touches; i++)
        if (!small_is_own(r, l->touch[i].body)) touch_set_past(&l->touch[i], &none, &l->s);
    for (int64_t slot = BUNDLE * l->s.group[l->s.groups]; slot < BUNDLE * l->s.bundles; slot++)
        if (pair_has_past(&l->s, slot)) small_slot_set_past(&l->s, slot, &none.past);
}

bool small_part_collect(struct small_run *r)
{
    const struct small_list *l = r->l;
    struct small_ranks *y = r->part->ranks;
    const size_t n = (size_t)l->s.bodies, m = (size_t)(l->touches + l->pairs.n);
    char *mine = malloc(n * BODY_MOST + m * past_bytes(&l->s) + 3 * sizeof(int64_t));
    struct gathered *at = malloc((size_t)y->n * sizeof *at);
    char *all = NULL;
    if (mine && at) all = y->gather(y, mine, (size_t)(put_all(r, mine) - mine), at);
    if (all) forget_all(r);
    for (int q = 0; all && q < y->n; q++)
        if (q != y->me) take_all(r, q, all + at[q].first);
    free(mine), free(at), free(all);
    return all != NULL;
}
