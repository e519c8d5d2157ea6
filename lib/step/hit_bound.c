/* step/hit_bound.c: restitution that neighbours allow, and impacts that springs do not soften [step/hit_bound.h]. */
#include "step/hit_bound.h"

#include "state/freedom.h"

#include <stdlib.h>

/* Of one contact: what it had */
struct hit {
    double en, et, r; /* r: N s */
    bool bounded;
};

struct hit_search {
    int solved; /* how often, for restitution */
    struct hit *of;
    bool much;          /* some restitution was more than neighbours allow */
    double speed;       /* m/s: of the fastest approach */
    double left, began; /* m/s: what springs left after the last solve, and when a cycle began */
    int rounds;
};

void hit_free(struct hit_search *o)
{
    if (o) free(o->of);
    free(o);
}

/* An impact with a restitution that pushes more than its pair would alone by HIT_MOST */
static bool hit_exceeds(const struct contacts *s, int64_t i)
{
    const struct contact_law *t = &s->law[i];
    return t->state & CONTACT_LAW_MEETS && s->c[i].en > 0 &&
           s->found[i].r[0] > HIT_MOST * t->hit[0];
}

/* Gives contact i the share `times` of the restitution that it had */
static void hit_set(struct contacts *s, int64_t i, const struct hit *had, double times)
{
    struct contact *c = &s->c[i];
    const double was = 1 + c->en;
    c->en = times * had->en, c->et = times * had->et;
    for (int k = 0; k < 3; k++) s->law[i].hit[k] *= (1 + c->en) / was;
}

static int hit_begin(struct hit_search **search, struct contacts *s, bool *again,
                     struct failure *failure)
{
    struct hit_search *o = *search = calloc(1, sizeof *o);
    if (!o || !(o->of = calloc((size_t)s->n + 1, sizeof *o->of)))
        return failure_set(failure, EX_SOFTWARE, "no memory for the impacts");
    for (int64_t i = 0; i < s->n; i++) {
        if (!hit_exceeds(s, i)) continue;
        o->of[i] = (struct hit){ s->c[i].en, s->c[i].et, s->found[i].r[0], true };
        hit_set(s, i, &o->of[i], 0);
        *again = true;
    }
    return 0;
}

/* 1/kg: c_n of a contact whose stiffness follows from the time step; 0: it has none. alpha: its compliance over W */
static double hit_compliance(const struct packing *p, const struct contacts *s, int64_t i,
                             double *alpha)
{
    const struct contact_law *t = &s->law[i];
    *alpha = p->law[packing_pair(p, s->c[i].a, s->c[i].b)].soft;
    return *alpha > 0 && t->spring[0] > 0 ? 1 / (t->spring[0] * p->dt * p->dt) : 0;
}

/* N s: what the spring of contact i pushed before the step, in its basis */
static void hit_before(const struct packing *p, const struct contact_law *t, double push[3])
{
    const bool meets = t->state & CONTACT_LAW_MEETS;
    for (int k = 0; k < 3; k++)
        push[k] = meets ? 0 : -t->spring[k > 0] * p->dt * (k ? t->jump[k] : fmin(0, t->jump[0]));
}

/* m/s: the fastest approach of an impact */
static double hit_speed(const struct packing *p, const struct contacts *s)
{
    double most = 0, alpha;
    for (int64_t i = 0; i < s->n; i++) {
        const struct contact_law *t = &s->law[i];
        const double c = hit_compliance(p, s, i, &alpha);
        if (c > 0 && t->state & CONTACT_LAW_MEETS)
            most = fmax(most, c / alpha * t->hit[0] / (1 + s->c[i].en));
    }
    return most;
}

/* m/s: the largest approach that springs leave */
static double hit_left(const struct packing *p, const struct contacts *s)
{
    double most = 0, alpha, push[3];
    for (int64_t i = 0; i < s->n; i++) {
        const double c = hit_compliance(p, s, i, &alpha), r = s->found[i].r[0];
        if (!(c > 0 && r > 0)) continue;
        hit_before(p, &s->law[i], push);
        most = fmax(most, c * fabs(r - s->law[i].hit[0] - push[0]));
    }
    return most;
}

/* What springs left is taken out of them: hit, so that the same r leaves nothing; and `more` times what they had since */
static void hit_shift(const struct packing *p, struct contacts *s, double more)
{
    double alpha, push[3];
    for (int64_t i = 0; i < s->n; i++) {
        struct contact_law *t = &s->law[i];
        if (!(hit_compliance(p, s, i, &alpha) > 0)) continue;
        hit_before(p, t, push);
        for (int k = 0; k < 3; k++) {
            const double to = s->found[i].r[k] - push[k];
            t->hit[k] = to + more * (to - t->hit[k]);
        }
    }
}

/* Takes what springs left out of them, to be solved again, unless it is little, or as much as HIT_CYCLE rounds before. The last
   round of a cycle goes to where a sequence with the ratio of the last two would end. */
static void hit_harden(struct hit_search *o, const struct packing *p, struct contacts *s,
                       bool *again)
{
    if (o->much || o->rounds >= HIT_ROUNDS) return;
    if (!o->rounds) o->speed = hit_speed(p, s);
    if (!(o->speed > 0)) return;
    const double left = hit_left(p, s), ratio = left / o->left;
    const bool first = o->rounds % HIT_CYCLE == 0, last = o->rounds % HIT_CYCLE == HIT_CYCLE - 1;
    if (left <= fmax(HIT_LEFT * o->speed, freedoms_calm(p))) return;
    if (first && o->rounds && left >= o->began) return;
    if (first) o->began = left;
    o->left = left, o->rounds++;
    hit_shift(p, s, last && ratio > 0.5 && ratio < 1 ? ratio / (1 - ratio) : 0);
    *again = true;
}

/* As much restitution as neighbours allow, after the solve without */
static void hit_restore(struct hit_search *o, struct contacts *s, bool *again)
{
    for (int64_t i = 0; i < s->n; i++) {
        const struct hit *had = &o->of[i];
        if (!had->bounded) continue;
        const double least = dmax(s->found[i].r[0], s->law[i].hit[0]), over = had->r - least;
        const bool much = had->r > HIT_MOST * least;
        hit_set(s, i, had, much ? (HIT_MOST - 1) * least / over : 1);
        o->much = o->much || much;
        *again = true;
    }
}

int hit_reduce(struct hit_search **search, const struct packing *p, struct contacts *s, bool *again,
               struct failure *failure)
{
    *again = false;
    if (!packing_has_springs(p) || !s->law || !s->found) return 0;
    if (!*search && hit_begin(search, s, again, failure)) return failure->status;
    if (!*again && !(*search)->solved++) hit_restore(*search, s, again);
    if (!*again) hit_harden(*search, p, s, again);
    return 0;
}
