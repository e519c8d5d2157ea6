/* step/hit_bound.c: restitution that neighbours allow [step/hit_bound.h]. */
#include "step/hit_bound.h"

#include <stdlib.h>

/* Of one contact: what it had */
struct hit {
    double en, et, r; /* r: N s */
    bool bounded;
};

struct hit_search {
    int solved; /* how often */
    struct hit *of;
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

int hit_reduce(struct hit_search **search, const struct packing *p, struct contacts *s, bool *again,
               struct failure *failure)
{
    *again = false;
    if (!packing_has_springs(p) || !s->law || !s->found) return 0;
    if (!*search) return hit_begin(search, s, again, failure);
    if ((*search)->solved++) return 0;
    for (int64_t i = 0; i < s->n; i++) {
        const struct hit *had = &(*search)->of[i];
        if (!had->bounded) continue;
        const double least = dmax(s->found[i].r[0], s->law[i].hit[0]), over = had->r - least;
        const bool much = had->r > HIT_MOST * least;
        hit_set(s, i, had, much ? (HIT_MOST - 1) * least / over : 1);
        *again = true;
    }
    return 0;
}
