/* contact/depth.c: the deepest contact, and bodies that are pinched [contact/depth.h]. */
#include "contact/depth.h"

#include "contact/spring.h"

#include <stdlib.h>

/* A body's side of a contact that is too deep, its normal pointing into the body */
struct depth_side {
    int32_t body;
    vec3 n;
};

static int by_body(const void *x, const void *y)
{
    const struct depth_side *a = x, *b = y;
    return (a->body > b->body) - (a->body < b->body);
}

/* Of contact i, without what its springs carry */
static double radii(const struct packing *p, const struct contacts *s, int64_t i)
{
    const struct contact *c = &s->c[i];
    double small = c->a < 0 ? p->radius[c->b] : dmin(p->radius[c->a], p->radius[c->b]);
    return -(s->law ? spring_unloaded_gap(c, &s->law[i]) : c->gap) / small;
}

/* Whether normals among these sides, of one body, point against each other */
static bool held(const struct depth_side *s, int64_t n)
{
    for (int64_t i = 1; i < n; i++)
        for (int64_t k = 0; k < i; k++)
            if (v3_dot(s[i].n, s[k].n) < 0) return true;
    return false;
}

static void count_pinched(struct depth *d, const struct packing *p, struct depth_side *s, int64_t n,
                          const bool *counts)
{
    qsort(s, (size_t)n, sizeof *s, by_body);
    for (int64_t i = 0, k; i < n; i = k) {
        for (k = i; k < n && s[k].body == s[i].body; k++) continue;
        if ((counts && !counts[s[i].body]) || !held(s + i, k - i)) continue;
        if (!d->pinched++) d->pinched_id = p->id[s[i].body];
    }
}

int depth_of(struct depth *d, const struct packing *p, const struct contacts *s, const bool *counts,
             struct failure *failure)
{
    int64_t deep = 0, most = -1;
    *d = (struct depth){ 0 };
    for (int64_t i = 0; i < s->n; i++) {
        if (s->c[i].gap >= 0) continue; // as most are, without a quotient
        double depth = radii(p, s, i);
        deep += depth > DEPTH_PINCHED;
        if (depth > d->deepest) d->deepest = depth, most = i;
    }
    if (most >= 0) {
        const struct contact *c = &s->c[most];
        d->pair[0] = c->a < 0 ? c->a : p->id[c->a], d->pair[1] = p->id[c->b];
    }
    if (deep < 2) return 0;
    struct depth_side *side = malloc(2 * (size_t)deep * sizeof *side);
    if (!side) return failure_set(failure, EX_SOFTWARE, "no memory for overlaps");
    int64_t n = 0;
    for (int64_t i = 0; i < s->n; i++) {
        const struct contact *c = &s->c[i];
        if (!(c->gap < 0 && radii(p, s, i) > DEPTH_PINCHED)) continue;
        if (p->mass[c->b] > 0) side[n++] = (struct depth_side){ c->b, c->n };
        if (c->a >= 0 && p->mass[c->a] > 0)
            side[n++] = (struct depth_side){ c->a, v3_scale(-1, c->n) };
    }
    count_pinched(d, p, side, n, counts);
    free(side);
    return 0;
}
