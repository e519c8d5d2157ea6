/* step/small_tell.c: what processes that divide small steps tell each other [step/small_part.h]. */
#include "step/small_part.h"

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

static void put_motion(struct told_motion *to, const struct small *s, int64_t i)
{
    memcpy(to->v, s->body[i].v, sizeof to->v), memcpy(to->w, s->body[i].w, sizeof to->w);
    to->change = s->change[i], to->hot = s->hot[i];
}

static void take_motion(const struct told_motion *from, struct small *s, int64_t i)
{
    memcpy(s->body[i].v, from->v, sizeof from->v), memcpy(s->body[i].w, from->w, sizeof from->w);
    s->change[i] = from->change, s->hot[i] = (int32_t)from->hot;
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

/* All of a body that steps change */
struct told_body {
    int64_t i;
    double x[3];
    struct body body, before;
    vec3 turned;
    double missing, load;
    struct small_pull pull;
};

/* Bytes of all that this process owns; of a pair that has a past: its number, and as much of struct small_past as there may be. */
struct told_pair {
    int64_t i;
    struct small_past past;
};

/* Of struct told_pair: what may differ from 0 */
static size_t pair_bytes(const struct small *s)
{
    if (s->spring) return sizeof(struct told_pair);
    if (s->hold) return offsetof(struct told_pair, past.spring);
    return s->turn ? offsetof(struct told_pair, past.held) : offsetof(struct told_pair, past.m);
}

static char *put_bodies(const struct small_run *r, char *to)
{
    const struct small *s = &r->l->s;
    for (int64_t i = 0; i < s->bodies; i++) {
        struct told_body b = { .i = i };
        if (!small_is_own(r, i)) continue;
        memcpy(b.x, s->place[i].x, sizeof b.x);
        b.body = s->body[i], b.before = s->before[i], b.turned = r->turned[i];
        if (r->judged) b.missing = s->missing[i], b.load = s->load[i];
        if (r->pull) b.pull = r->pull[i];
        memcpy(to, &b, sizeof b), to += sizeof b;
    }
    return to;
}

static void take_body(struct small_run *r, const struct told_body *b)
{
    struct small *s = &r->l->s;
    const int64_t i = b->i;
    memcpy(s->place[i].x, b->x, sizeof b->x);
    s->body[i] = b->body, s->before[i] = b->before, r->turned[i] = b->turned;
    if (r->judged) s->missing[i] = b->missing, s->load[i] = b->load;
    if (r->pull) r->pull[i] = b->pull;
}

static char *put_touches(const struct small_run *r, char *to)
{
    for (int64_t i = 0; i < r->l->touches; i++) {
        if (!small_is_own(r, r->l->touch[i].body)) continue;
        memcpy(to, &r->l->touch[i], sizeof *r->l->touch), to += sizeof *r->l->touch;
    }
    return to;
}

/* Is it more than zeros without a sign? */
static bool has_past(const struct small_past *x)
{
    static const struct small_past none;
    return memcmp(x, &none, sizeof none) != 0;
}

static char *put_pairs(const struct small_run *r, char *to)
{
    const struct small_list *l = r->l;
    const size_t bytes = pair_bytes(&l->s);
    for (int64_t i = 0; i < l->pairs.n; i++) {
        struct told_pair t = { .i = i };
        if (!small_is_own(r, l->pairs.pair[i].b)) continue;
        t.past = small_slot_past(&l->s, l->slot[i]);
        if (has_past(&t.past)) memcpy(to, &t, bytes), to += bytes;
    }
    return to;
}

/* Pairs of which this process knows nothing have no past until it is told. */
static void forget_pairs(struct small_run *r)
{
    struct small_list *l = r->l;
    const struct small_past none = { 0 };
    const int32_t me = r->part->ranks->me, *owner = r->part->owner;
    for (int64_t i = 0; i < l->pairs.n; i++) {
        const struct pair *q = &l->pairs.pair[i];
        if (owner[q->a] != me && owner[q->b] != me) small_slot_set_past(&l->s, l->slot[i], &none);
    }
}

/* What one process owns: numbers of bodies, touches and pairs, and these */
static void take_part(struct small_run *r, const char *from)
{
    struct small_list *l = r->l;
    const size_t bytes = pair_bytes(&l->s);
    int64_t n[3], at = 0;
    memcpy(n, from, sizeof n), from += sizeof n;
    for (int64_t k = 0; k < n[0]; k++, from += sizeof(struct told_body)) {
        struct told_body b;
        memcpy(&b, from, sizeof b);
        take_body(r, &b);
    }
    for (int64_t k = 0; k < n[1]; k++, from += sizeof *l->touch) {
        struct small_touch t;
        memcpy(&t, from, sizeof t);
        while (l->touch[at].body != t.body || l->touch[at].wall != t.wall) at++;
        l->touch[at] = t;
    }
    for (int64_t k = 0; k < n[2]; k++, from += bytes) {
        struct told_pair t = { 0 };
        memcpy(&t, from, bytes);
        const struct pair *q = &l->pairs.pair[t.i];
        const int32_t me = r->part->ranks->me, *owner = r->part->owner;
        if (owner[q->a] != me && owner[q->b] != me)
            small_slot_set_past(&l->s, l->slot[t.i], &t.past);
    }
}

bool small_part_collect(struct small_run *r)
{
    struct small_list *l = r->l;
    struct small_ranks *y = r->part->ranks;
    int64_t n[3] = { 0, 0, l->pairs.n };
    for (int64_t i = 0; i < l->s.bodies; i++) n[0] += small_is_own(r, i);
    for (int64_t i = 0; i < l->touches; i++) n[1] += small_is_own(r, l->touch[i].body);
    const size_t bytes = pair_bytes(&l->s);
    const size_t fixed =
        sizeof n + (size_t)n[0] * sizeof(struct told_body) + (size_t)n[1] * sizeof *l->touch;
    char *mine = malloc(fixed + (size_t)n[2] * bytes + 1);
    size_t *at = malloc((size_t)(y->n + 1) * sizeof *at);
    if (!mine || !at) {
        free(mine), free(at);
        return false;
    }
    char *end = put_touches(r, put_bodies(r, mine + sizeof n));
    char *last = put_pairs(r, end);
    n[2] = (last - end) / (int64_t)bytes;
    memcpy(mine, n, sizeof n);
    char *all = y->gather(y, mine, (size_t)(last - mine), at);
    if (all) forget_pairs(r);
    for (int q = 0; all && q < y->n; q++)
        if (q != y->me) take_part(r, all + at[q]);
    free(mine), free(at), free(all);
    return all != NULL;
}
