/* state/memory.c: the reactions that last from step to step [state/memory.h]. */
#include "state/memory.h"

#include "base/array.h"
#include "state/fields.h"

#include <stdlib.h>
#include <string.h>

#define GROWTH 2.0   /* what is kept may grow by this factor in a step, */
#define TRUST  0.125 /* but of a new reaction this part is kept at once */

void memory_free(struct memory *m)
{
    free(m->recall);
    *m = (struct memory){ 0 };
}

void memory_set(struct memory *m, bool on)
{
    if (!on) memory_free(m);
    m->on = on;
}

/* What is remembered of the contact with this key, or NULL. *from, 0 at first, is where to look from on:
   contacts are asked for in their order. */
static const struct recall *memory_find(const struct memory *m, struct contact_key key,
                                        int64_t *from)
{
    int order = -1;
    while (*from < m->n && (order = contact_key_order(recall_key(&m->recall[*from]), key)) < 0)
        ++*from;
    return *from < m->n && order == 0 ? &m->recall[*from] : NULL;
}

/* How much of a reaction is remembered */
static double trust(vec3 r, const struct recall *before)
{
    double most = before ? GROWTH * v3_norm(before->r) : 0, size = v3_norm(r);
    return most >= size ? 1 : most > TRUST * size ? most / size : TRUST;
}

int memory_keep(struct memory *m, const struct contacts *s, struct failure *failure)
{
    struct memory now = { .on = true };
    if (!m->on || !s->found) return 0;
    for (int64_t i = 0; i < s->n; i++) now.room += s->found[i].r[0] != 0;
    now.recall = malloc((size_t)(now.room + 1) * sizeof *now.recall);
    if (!now.recall) return failure_set(failure, EX_SOFTWARE, "no memory for the last reactions");
    for (int64_t i = 0, from = 0; i < s->n; i++) {
        const struct contact *c = &s->c[i];
        if (s->found[i].r[0] == 0 || s->found[i].status == STATUS_JAMMED) continue;
        const struct contact_key k = contact_key(c);
        vec3 r = contact_in_space(c, s->found[i].r);
        double part = trust(r, memory_find(m, k, &from));
        vec3 moment = s->moment ? contact_in_space(c, s->moment[i]) : v3(0, 0, 0);
        now.recall[now.n++] = (struct recall){ k.a,
                                               k.b,
                                               k.feature,
                                               { k.shift[0], k.shift[1], k.shift[2] },
                                               v3_scale(part, r),
                                               v3_scale(part, moment) };
    }
    memory_free(m);
    *m = now;
    return 0;
}

static void in_basis(const struct contact *c, vec3 x, double r[3])
{
    r[0] = v3_dot(x, c->n), r[1] = v3_dot(x, c->t1), r[2] = v3_dot(x, contact_t2(c));
}

int memory_give(const struct memory *m, struct contacts *s, bool moments, struct failure *failure)
{
    if (contacts_alloc_found(s) || (moments && contacts_alloc_moment(s)))
        return failure_set(failure, EX_SOFTWARE, "no memory for the last reactions");
    for (int64_t i = 0, from = 0; i < s->n; i++) {
        const struct recall *x = memory_find(m, contact_key(&s->c[i]), &from);
        if (!x) continue;
        in_basis(&s->c[i], x->r, s->found[i].r);
        if (moments) in_basis(&s->c[i], x->m, s->moment[i]);
    }
    return 0;
}

static int memory_compare(const void *x, const void *y)
{
    return contact_key_order(recall_key(x), recall_key(y));
}

void memory_scale(struct memory *m, double factor)
{
    for (int64_t i = 0; i < m->n; i++) {
        m->recall[i].r = v3_scale(factor, m->recall[i].r);
        m->recall[i].m = v3_scale(factor, m->recall[i].m);
    }
}

void memory_sort(struct memory *m)
{
    array_sort(m->recall, m->n, sizeof *m->recall, memory_compare);
}

void memory_follow(struct memory *m, const int32_t *row)
{
    int64_t n = 0;
    for (int64_t i = 0; i < m->n; i++) {
        struct recall x = m->recall[i];
        bool there = row[x.b] >= 0 && (x.a < 0 || row[x.a] >= 0);
        x.a = x.a < 0 ? x.a : row[x.a], x.b = row[x.b];
        if (there) m->recall[n++] = x;
    }
    m->n = n;
}

int memory_check(const struct memory *m, int64_t bodies, int32_t walls, struct failure *failure)
{
    const char *what = "remembered reaction";
    if (records_check(RECORDS(recall_fields, m->n, m->recall), what, failure))
        return failure->status;
    for (int64_t i = 0; i < m->n; i++) {
        const struct recall *x = &m->recall[i];
        const char *trouble = NULL;
        if (x->b < 0 || x->b >= bodies || x->a >= bodies || x->a < -walls || x->a == x->b)
            trouble = "no such bodies";
        else if (i && memory_compare(x - 1, x) >= 0)
            trouble = "not sorted by its bodies, or twice";
        if (trouble)
            return failure_set(failure, EX_DATAERR, "%s %lld: %s", what, (long long)i, trouble);
    }
    return 0;
}
