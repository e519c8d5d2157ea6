/* step/rebound.c: the search for restitutions that gain nothing [step/rebound.h]. */
#include "step/rebound.h"

#include <stdlib.h>

enum {
    ROUNDS = 24 /* solves: of one impact 5 to 8 do */
};

/* Of the energy that an approach could give up: what a bounded impact may lose more than it must */
#define ENOUGH 1e-5

/* Of one pair: gains at most nothing with lo, something with hi */
struct bracket {
    double s, lo, hi;    /* of e_n and e_t */
    double at_lo, at_hi; /* J; at_lo NAN: not known */
    bool bounded;
};

struct rebound_search {
    int rounds;
    struct gain *gain;    /* [n] */
    struct bracket *pair; /* [n] */
};

void rebound_free(struct rebound_search *o)
{
    if (o) free(o->gain), free(o->pair);
    free(o);
}

static struct rebound_search *rebound_new(int64_t n)
{
    struct rebound_search *o = calloc(1, sizeof *o);
    if (!o) return NULL;
    o->gain = calloc((size_t)n + 1, sizeof *o->gain);
    o->pair = calloc((size_t)n + 1, sizeof *o->pair);
    for (int64_t i = 0; o->pair && i < n; i++)
        o->pair[i] = (struct bracket){ .s = 1, .hi = 1, .at_lo = NAN };
    if (o->gain && o->pair) return o;
    rebound_free(o);
    return NULL;
}

/* The next s, after the gain with this one; false: it stays. */
static bool narrow(struct bracket *b, const struct gain *g)
{
    bool gains = g->work > GAIN_LEAST * g->scale;
    if (!gains && (!b->bounded || g->work >= -ENOUGH * g->scale || b->s == 0)) return false;
    if (gains && b->s == 0) return false; // that is the others' doing
    b->bounded = true;
    if (gains) {
        b->hi = b->s, b->at_hi = g->work, b->at_lo *= 0.5; // the other end's share, lest it stays
    } else {
        b->lo = b->s, b->at_lo = g->work, b->at_hi *= 0.5;
    }
    double along = isnan(b->at_lo) ? 0.5 : b->at_lo / (b->at_lo - b->at_hi);
    b->s = b->lo + along * (b->hi - b->lo);
    return true;
}

/* Sets the restitution of the contacts from i to end-1. */
static void balance_set(const struct packing *p, struct contacts *s, int64_t i, int64_t end, double times)
{
    for (; i < end; i++) {
        const double mu = s->c[i].mu;
        packing_set_law(p, &s->c[i]);
        if (p->mu_s[packing_pair(p, s->c[i].a, s->c[i].b)] > 0) s->c[i].mu = mu;
        s->c[i].en *= times, s->c[i].et *= times;
    }
}

static int balance_find(struct rebound_search *o, const struct packing *p, const struct contacts *s,
                struct failure *failure)
{
    struct impulses sum;
    if (!impulses_init(&sum, p, s, false, failure)) balance_gains(o->gain, p, s, &sum, failure);
    impulses_free(&sum);
    return failure->status;
}

int rebound_reduce(struct rebound_search **search, const struct packing *p, struct contacts *s,
                   bool *again, struct failure *failure)
{
    *again = false;
    bool any = false;
    for (int64_t i = 0; i < s->n && !any; i++) any = packing_bounds(p, &s->c[i]);
    if (!any) return 0;
    struct rebound_search *o = *search = *search ? *search : rebound_new(s->n);
    if (!o) return failure_set(failure, EX_SOFTWARE, "no memory for the impacts");
    if (balance_find(o, p, s, failure)) return failure->status;
    o->rounds++;
    for (int64_t i = 0, next; i < s->n; i = next) {
        struct bracket *b = &o->pair[i];
        next = balance_next_pair(s, i);
        if (!packing_bounds(p, &s->c[i]) || !narrow(b, &o->gain[i])) continue;
        if (o->rounds >= ROUNDS) b->s = b->lo = 0; // the last
        balance_set(p, s, i, next, b->s);
        *again = o->rounds <= ROUNDS;
    }
    return 0;
}
