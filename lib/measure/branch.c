#include "measure/branch.h"

#include <stdlib.h>
#include <string.h>

int32_t *counts_of(const struct snapshot *s)
{
    int32_t *count = calloc((size_t)s->p->n + 1, sizeof *count);
    for (int64_t i = 0; count && i < s->s->n; i++) {
        const struct contact *c = &s->s->c[i];
        if (!branch_counts(s->s, i)) continue;
        if (c->a >= 0) count[c->a]++;
        count[c->b]++;
    }
    return count;
}

/* A body that moves and has too few contacts */
static bool rattles(const struct snapshot *s, const int32_t *count, int64_t i, int least)
{
    return i >= 0 && s->p->mass[i] > 0 && count[i] < least;
}

int counts_without_rattlers(int32_t *count, const struct snapshot *s, int least)
{
    // the contacts that are left, fewer from round to round
    int64_t *left = malloc(((size_t)s->s->n + 1) * sizeof *left), n = 0, before = -1;
    if (!left) return -1;
    for (int64_t i = 0; i < s->s->n; i++)
        if (branch_counts(s->s, i)) left[n++] = i;
    while (n != before) {
        before = n, n = 0;
        for (int64_t k = 0; k < before; k++) {
            const struct contact *c = &s->s->c[left[k]];
            if (!rattles(s, count, c->a, least) && !rattles(s, count, c->b, least)) {
                left[n++] = left[k];
                continue;
            }
            if (c->a >= 0) count[c->a]--;
            count[c->b]--;
        }
    }
    free(left);
    return 0;
}

bool counts_body(const struct snapshot *s, int64_t i)
{
    return s->p->mass[i] > 0 && snapshot_body(s, i) && region_holds(&s->region, s->p->x[i]);
}
