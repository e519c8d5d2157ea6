/* step/levels.c: the level of each contact, and a counting sort by it [bodies/levels.h]. */
#include "step/levels.h"

#include <stdlib.h>

/* level[i] of every contact; returns the number of levels. after[bodies]: one above the highest level of a body's
   contacts so far. */
static int32_t project_find(const struct contacts *s, int32_t *after, int32_t *level)
{
    int32_t n = 0;
    for (int64_t i = 0; i < s->n; i++) {
        int32_t a = s->c[i].a, b = s->c[i].b, at = after[b];
        if (a >= 0 && after[a] > at) at = after[a];
        level[i] = at++;
        after[b] = at;
        if (a >= 0) after[a] = at;
        if (at > n) n = at;
    }
    return n;
}

int levels_init(struct levels *l, const struct contacts *s, int64_t bodies)
{
    *l = (struct levels){ 0 };
    int32_t *after = calloc((size_t)bodies + 1, sizeof *after);
    int32_t *level = malloc((size_t)(s->n + 1) * sizeof *level);
    l->contact = malloc((size_t)(s->n + 1) * sizeof *l->contact);
    int32_t n = after && level && l->contact ? project_find(s, after, level) : 0;
    int64_t *at = calloc((size_t)n + 2, sizeof *at);
    bool room = after && level && l->contact && at;
    for (int64_t i = 0; room && i < s->n; i++) at[level[i] + 2]++;
    for (int32_t k = 0; room && k < n; k++) at[k + 2] += at[k + 1];
    for (int64_t i = 0; room && i < s->n; i++) l->contact[at[level[i] + 1]++] = (int32_t)i;
    free(after), free(level);
    if (!room) return free(at), -1;
    l->first = at, l->n = n;
    return 0;
}

void levels_free(struct levels *l)
{
    free(l->first), free(l->contact);
    *l = (struct levels){ 0 };
}
