#include "measure/follow.h"

#include "measure/branch.h"

#include <math.h>
#include <stdlib.h>

static struct frame_memory_body *frame_memory_of(struct frame_memory *now, int32_t id)
{
    return now->body + (frame_memory_find(now, id) - now->body);
}

void follow_chosen(struct frame_memory *now, const struct snapshot *s)
{
    for (int64_t i = 0; i < s->p->n; i++)
        frame_memory_of(now, s->p->id[i])->chosen = snapshot_body(s, i);
}

/* Since when each body is in the region: as before, or now. Of those in the first frame nobody knows. */
static void follow_bodies(struct frame_memory *now, const struct snapshot *s)
{
    const struct packing *p = s->p;
    for (int64_t i = 0; i < p->n; i++) {
        struct frame_memory_body *b = frame_memory_of(now, p->id[i]);
        const struct frame_memory_body *then =
            s->before ? frame_memory_find(s->before, p->id[i]) : NULL;
        if (!counts_body(s, i)) continue;
        b->entered = p->t, b->whole = s->before;
        if (then && follow_in(then)) b->entered = then->entered, b->whole = then->whole;
    }
    for (int64_t k = 0; s->before && k < p->events.n; k++) {
        const struct event *e = &p->events.e[k];
        const struct frame_memory_body *b = e->came ? frame_memory_find(now, e->id) : NULL;
        if (b && follow_in(b) && region_holds(&s->region, e->x))
            now->body[b - now->body].entered = e->t;
    }
}

double follow_removed(const struct snapshot *s, int32_t id)
{
    for (int64_t k = 0; k < s->p->events.n; k++)
        if (!s->p->events.e[k].came && s->p->events.e[k].id == id) return s->p->events.e[k].t;
    return s->p->t;
}

/* A pair of bodies, or of a wall and a body, is one, in however many places and across whatever edges it touches */
static struct frame_memory_pair pair_of(const struct packing *p, const struct contact *c)
{
    const int32_t a = c->a < 0 ? c->a : p->id[c->a], b = p->id[c->b];
    return a < 0 || a < b ? (struct frame_memory_pair){ .a = a, .b = b }
                          : (struct frame_memory_pair){ .a = b, .b = a };
}

static int follow_pairs(struct frame_memory *now, const struct snapshot *s, struct failure *failure)
{
    now->pair = malloc(((size_t)s->s->n + 1) * sizeof *now->pair);
    if (!now->pair) return failure_set(failure, EX_SOFTWARE, "no memory to remember contacts");
    int64_t n = 0;
    for (int64_t i = 0; i < s->s->n; i++)
        if (branch_counts(s->s, i)) now->pair[n++] = pair_of(s->p, &s->s->c[i]);
    if (n) qsort(now->pair, (size_t)n, sizeof *now->pair, frame_memory_pair_order);
    for (int64_t i = 0; i < n; i++) {
        struct frame_memory_pair *to = &now->pair[now->pairs];
        if (now->pairs && !frame_memory_pair_order(to - 1, &now->pair[i])) continue;
        *to = now->pair[i], to->began = s->p->t, to->whole = s->before && s->before->pair;
        const struct frame_memory_pair *then = frame_memory_pair_find(s->before, to);
        if (then) to->began = then->began, to->whole = then->whole;
        now->pairs++;
    }
    return 0;
}

int follow(struct frame_memory *now, const struct snapshot *s, bool pairs, struct failure *failure)
{
    *now = (struct frame_memory){ 0 };
    if (s->before) now->form = s->before->form;
    if (frame_memory_set(now, s->p, failure)) return failure->status;
    follow_chosen(now, s), follow_bodies(now, s);
    if (pairs && s->s && follow_pairs(now, s, failure)) frame_memory_free(now);
    return failure->status;
}
