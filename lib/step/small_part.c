/* step/small_part.c: which process has which bodies and pairs, and what it tells others when [step/small_part.h]. */
#include "step/small_part.h"

#include "base/array.h"

#include <stdlib.h>
#include <string.h>

static void small_wires_free(struct small_part *y)
{
    for (int k = 0; k < y->wires; k++) {
        struct small_wire *w = &y->wire[k];
        free(w->go), free(w->come), free(w->go_body), free(w->come_body);
        free(w->lend), free(w->borrow);
    }
    free(y->wire);
    y->wire = NULL, y->wires = 0;
}

void small_part_free(struct small_part *y)
{
    small_wires_free(y);
    free(y->owner), free(y->own), free(y->along), free(y->pair), free(y->message);
    *y = (struct small_part){ .ranks = y->ranks };
}

/* ---- bodies ---- */

struct placed_body {
    double along; /* m */
    int64_t i;
};

static int by_place(const void *a, const void *b)
{
    const struct placed_body *x = a, *y = b;
    if (x->along != y->along) return x->along < y->along ? -1 : 1;
    return x->i < y->i ? -1 : x->i > y->i;
}

/* The bodies b[n] at x are those of `ranks` processes from the first on, each of which gets as many: cut across their longest
   extent, and the halves again. */
static void bisect(int32_t *owner, const vec3 *x, struct placed_body *b, int64_t n, int first,
                   int ranks)
{
    vec3 lo = v3(INFINITY, INFINITY, INFINITY), hi = v3(-INFINITY, -INFINITY, -INFINITY);
    if (ranks == 1) {
        for (int64_t k = 0; k < n; k++) owner[b[k].i] = first;
        return;
    }
    for (int64_t k = 0; k < n; k++) {
        const vec3 at = x[b[k].i];
        lo = v3(fmin(lo.x, at.x), fmin(lo.y, at.y), fmin(lo.z, at.z));
        hi = v3(fmax(hi.x, at.x), fmax(hi.y, at.y), fmax(hi.z, at.z));
    }
    const vec3 size = v3_sub(hi, lo);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    for (int64_t k = 0; k < n; k++) {
        const vec3 at = x[b[k].i];
        b[k].along = axis == 0 ? at.x : axis == 1 ? at.y : at.z;
    }
    qsort(b, (size_t)n, sizeof *b, by_place);
    const int half = ranks / 2;
    const int64_t cut = n * half / ranks;
    bisect(owner, x, b, cut, first, half);
    bisect(owner, x, b + cut, n - cut, first + half, ranks - half);
}

/* Lists after which bodies are divided anew: they flow from one process to another, and every division costs */
enum { DIVIDES_AFTER = 20 };

static bool divide_bodies(struct small_part *y, const struct small_list *l)
{
    const int64_t n = l->s.bodies;
    if (y->bodies == n && y->lists > 0 && y->lists++ < DIVIDES_AFTER) return true;
    struct placed_body *b = malloc((size_t)(n + 1) * sizeof *b);
    free(y->owner), free(y->own);
    y->owner = malloc((size_t)(n + 1) * sizeof *y->owner);
    y->own = malloc((size_t)(n + 1) * sizeof *y->own);
    const bool room = b && y->owner && y->own;
    for (int64_t i = 0; room && i < n; i++) b[i].i = i;
    if (room) bisect(y->owner, l->listed, b, n, 0, y->ranks->n);
    y->bodies = n, y->lists = 1, y->owns = 0;
    for (int32_t i = 0; room && i < n; i++)
        if (y->owner[i] == y->ranks->me) y->own[y->owns++] = i;
    free(b);
    return room;
}

/* ---- pairs ---- */

int small_part_join(struct pairs *s, struct small_ranks *ranks, struct failure *failure)
{
    double status = failure->status;
    struct gathered *at = malloc((size_t)ranks->n * sizeof *at);
    ranks->most(ranks, &status, 1);
    if (status > 0) {
        free(at);
        if (failure->status) return failure->status;
        return failure_set(failure, (int)status, "another process could not find its pairs");
    }
    const size_t size = (size_t)s->n * sizeof *s->pair;
    char *all = at ? ranks->gather(ranks, s->pair, size, at) : NULL;
    int64_t n = 0;
    for (int q = 0; all && q < ranks->n; q++) n += (int64_t)(at[q].size / sizeof *s->pair);
    struct pair *pair = all ? realloc(s->pair, (size_t)(n + 1) * sizeof *pair) : NULL;
    if (pair) s->pair = pair, s->n = 0, s->room = n + 1;
    for (int q = 0; pair && q < ranks->n; q++) {
        memcpy(s->pair + s->n, all + at[q].first, at[q].size);
        s->n += (int64_t)(at[q].size / sizeof *s->pair);
    }
    if (!pair || !pairs_sort(s)) failure_set(failure, EX_SOFTWARE, "no memory for the neighbours");
    free(at), free(all);
    return failure->status;
}

/* The order of one process's slots */
static bool order_pairs(struct small_part *y, const struct small_list *l, const int64_t *in)
{
    int64_t *next = calloc((size_t)l->s.groups + 1, sizeof *next);
    free(y->along);
    y->along = malloc((size_t)(l->pairs.n + 1) * sizeof *y->along);
    const bool room = next && y->along;
    for (int64_t i = 0; room && i < l->pairs.n; i++) next[in[i] + 1]++;
    for (int64_t g = 0; room && g < l->s.groups; g++) next[g + 1] += next[g];
    for (int64_t i = 0; room && i < l->pairs.n; i++) y->along[next[in[i]]++] = i;
    free(next);
    return room;
}

/* Of a division, while it is made */
struct division {
    struct small_part *y;
    const struct small_list *l;
    const int64_t *in;
    bool *border; /* [bodies] one process has it and another one a copy, of which this is one */
    int64_t pairs, *pair; /* those with bodies at borders, along the order of slots */
    int64_t
        *since; /* [bodies] the phase that the other process does not know; -1: it knows the body */
};

static void find_borders(struct division *d)
{
    const int32_t *owner = d->y->owner, me = d->y->ranks->me;
    for (int64_t i = 0; i < d->l->pairs.n; i++) {
        const struct pair *q = &d->l->pairs.pair[i];
        const bool here = owner[q->a] == me || owner[q->b] == me;
        if (!here || owner[q->a] == owner[q->b]) continue;
        d->border[q->a] = d->border[q->b] = true;
    }
    for (int64_t k = 0; k < d->l->pairs.n; k++) {
        const int64_t i = d->y->along[k];
        const struct pair *q = &d->l->pairs.pair[i];
        if (d->border[q->a] || d->border[q->b]) d->pair[d->pairs++] = i;
    }
}

struct errand {
    int64_t phase;
    int32_t body;
};
struct errands {
    int64_t n, room;
    struct errand *of;
};

static bool add_errand(struct errands *e, int64_t phase, int32_t body)
{
    if (!array_grow(&e->of, &e->room, e->n + 1, sizeof *e->of)) return false;
    e->of[e->n++] = (struct errand){ phase, body };
    return true;
}

/* Body b of rank `from` is swept in group g, with one of rank `other`: e gets it where rank `to` has to be told before. */
static bool pass_body(struct division *d, struct errands *e, int32_t b, int32_t other, int to,
                      int64_t g)
{
    bool room = true;
    if (other != to) {
        d->since[b] = g + 1;
    } else if (d->since[b] >= 0) {
        room = add_errand(e, d->since[b], b);
        d->since[b] = -1;
    }
    return room;
}

static int by_phase(const void *a, const void *b)
{
    const struct errand *x = a, *y = b;
    if (x->phase != y->phase) return x->phase < y->phase ? -1 : 1;
    return x->body < y->body ? -1 : x->body > y->body;
}

/* What `from` tells `to` in a sweep: at[phases + 1], body; and which bodies these are */
static bool plan_way(struct division *d, int from, int to, int64_t **at, int32_t **body,
                     int64_t *copies, int32_t **copy)
{
    const int32_t *owner = d->y->owner;
    const int64_t phases = d->y->phases;
    struct errands e = { 0 };
    bool room = true;
    for (int64_t k = 0; k < d->pairs; k++) {
        const struct pair *q = &d->l->pairs.pair[d->pair[k]];
        d->since[q->a] = d->since[q->b] = 0;
    }
    for (int64_t k = 0; room && k < d->pairs; k++) {
        const int64_t i = d->pair[k], g = d->in[i];
        const struct pair *q = &d->l->pairs.pair[i];
        if (owner[q->a] == from) room = pass_body(d, &e, q->a, owner[q->b], to, g);
        if (owner[q->b] == from) room = room && pass_body(d, &e, q->b, owner[q->a], to, g);
    }
    if (e.n) qsort(e.of, (size_t)e.n, sizeof *e.of, by_phase);
    *at = calloc((size_t)phases + 1, sizeof **at);
    *body = malloc((size_t)(e.n + 1) * sizeof **body);
    *copy = malloc((size_t)(e.n + 1) * sizeof **copy);
    room = room && *at && *body && *copy;
    *copies = 0;
    for (int64_t k = 0; room && k < e.n; k++) {
        const int32_t b = e.of[k].body;
        (*at)[e.of[k].phase + 1]++, (*body)[k] = b;
        if (d->since[b] == -2) continue; // it is among them
        (*copy)[(*copies)++] = b, d->since[b] = -2;
    }
    for (int64_t k = 0; room && k < phases; k++) (*at)[k + 1] += (*at)[k];
    free(e.of);
    return room;
}

static bool lay_wires(struct division *d)
{
    struct small_part *y = d->y;
    const int me = y->ranks->me;
    size_t most = 0;
    bool room = true;
    y->wire = calloc((size_t)y->ranks->n, sizeof *y->wire);
    for (int q = 0; y->wire && room && q < y->ranks->n; q++) {
        struct small_wire *w = &y->wire[y->wires];
        if (q == me) continue;
        *w = (struct small_wire){ .rank = q }, y->wires++;
        room = plan_way(d, me, q, &w->go, &w->go_body, &w->lends, &w->lend) &&
               plan_way(d, q, me, &w->come, &w->come_body, &w->borrows, &w->borrow);
        if (w->lends > (int64_t)most) most = (size_t)w->lends;
        if (w->borrows > (int64_t)most) most = (size_t)w->borrows;
    }
    free(y->message);
    y->message = malloc((most + 1) * MESSAGE * sizeof *y->message);
    return room && y->wire && y->message;
}

/* Pairs in which a body is told with their group */
static void mark_early(const struct division *d, uint8_t *kind)
{
    const struct small_part *y = d->y;
    for (int k = 0; k < y->wires; k++) {
        const struct small_wire *w = &y->wire[k];
        for (int64_t g = 0, at = 0; w->go && g + 1 < y->phases; g++) {
            if (w->go[g + 1] == w->go[g + 2]) continue;
            for (int64_t j = w->go[g + 1]; j < w->go[g + 2]; j++) d->since[w->go_body[j]] = -3 - g;
            while (at < d->pairs && d->in[d->pair[at]] < g) at++;
            for (; at < d->pairs && d->in[d->pair[at]] == g; at++) {
                const struct pair *q = &d->l->pairs.pair[d->pair[at]];
                if (d->since[q->a] == -3 - g || d->since[q->b] == -3 - g)
                    kind[d->pair[at]] = PAIR_EARLY;
            }
        }
    }
}

bool small_part_divide(struct small_part *y, const struct small_list *l, const int64_t *in,
                       uint8_t *kind)
{
    const size_t n = (size_t)l->s.bodies + 1, m = (size_t)l->pairs.n + 1;
    struct division d = { .y = y,
                          .l = l,
                          .in = in,
                          .border = calloc(n, 1),
                          .pair = malloc(m * sizeof *d.pair),
                          .since = malloc(n * sizeof *d.since) };
    small_wires_free(y);
    y->phases = l->s.groups + 1;
    bool room = d.border && d.pair && d.since && divide_bodies(y, l) && order_pairs(y, l, in);
    if (room) find_borders(&d), room = lay_wires(&d);
    const int32_t me = y->ranks->me;
    for (int64_t i = 0; room && i < l->pairs.n; i++) {
        const struct pair *q = &l->pairs.pair[i];
        if (y->owner[q->a] != me && y->owner[q->b] != me) kind[i] = PAIR_FOREIGN;
    }
    if (room) mark_early(&d, kind);
    free(d.border), free(d.pair), free(d.since);
    return room;
}

bool small_part_laid(struct small_part *y, const struct small_list *l)
{
    const int64_t lanes = BUNDLE * l->s.bundles;
    free(y->pair);
    y->pair = malloc((size_t)(lanes + 1) * sizeof *y->pair);
    if (!y->pair) return false;
    for (int64_t k = 0; k < lanes; k++) y->pair[k] = -1;
    for (int64_t i = 0; i < l->pairs.n; i++) y->pair[l->slot[i]] = i;
    return true;
}
