/* solve/small_stirred.c: which bundles have a body that sweeps have changed [solve/small.h]. */
#include "solve/small.h"

#include <stdlib.h>

void small_stirred_free(struct small *s)
{
    free(s->stirred.last), free(s->stirred.of), free(s->stirred.first);
    s->stirred = (struct small_stirred){ 0 };
}

/* Of a pair of bundle c: its body on one side; -1: the lane has none */
static int64_t lane_body(const struct small *s, const struct small_bundle *c, int k)
{
    const int64_t i = body_index(k < BUNDLE ? c->a[k] : c->b[k - BUNDLE]);
    return i < s->bodies ? i : -1;
}

void small_stirred_init(struct small *s)
{
    struct small_stirred *t = &s->stirred;
    const size_t lanes = 2 * BUNDLE * (size_t)s->bundles;
    if (t->last) return;
    t->last = calloc((size_t)s->bundles + 1, sizeof *t->last);
    t->of = malloc((lanes + 1) * sizeof *t->of);
    t->first = calloc((size_t)s->bodies + 2, sizeof *t->first);
    if (!t->last || !t->of || !t->first) {
        small_stirred_free(s);
        return;
    }
    for (size_t k = 0; k < lanes; k++) {
        const int64_t i = lane_body(s, &s->bundle[k / (2 * BUNDLE)], (int)(k % (2 * BUNDLE)));
        if (i >= 0) t->first[i + 2]++;
    }
    for (int64_t i = 0; i < s->bodies; i++) t->first[i + 2] += t->first[i + 1];
    for (size_t k = 0; k < lanes; k++) {
        const size_t j = k / (2 * BUNDLE);
        const int64_t i = lane_body(s, &s->bundle[j], (int)(k % (2 * BUNDLE)));
        if (i < 0) continue;
        t->of[t->first[i + 1]++] = (int32_t)j; // it moves from where body i begins to where it ends
        if (s->hot[i] > t->last[j]) t->last[j] = s->hot[i];
    }
}
