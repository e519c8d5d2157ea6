/* step/small_give.c: the contacts at the end of small steps [step/small_give.h]. */
#include "step/small_give.h"

#include "base/array.h"
#include "step/small_wall.h"

#include <stdlib.h>
#include <string.h>

/* Of a contact in the interval: on b */
struct small_sum {
    vec3 f, m; /* N s, N m s */
};

/* Contacts as they are given: with what they have pushed, or, where nobody reads that, those alone that overlap */
struct given {
    const struct small_run *r;
    struct contacts *out;
    struct small_sum *sum; /* [out->n]; NULL: nobody reads them */
};

/* False when memory is short, as all that give. */
static bool give_contact(struct given *g, const struct contact *at, bool near, struct small_sum sum)
{
    const struct packing *p = g->r->p;
    if (!(near && at->gap <= 0) && !(g->sum && v3_dot(sum.f, sum.f) > 0)) return true;
    struct contact *c = contacts_add(g->out, at->a, at->b);
    if (!c) return false;
    memcpy(c->shift, at->shift, sizeof c->shift);
    c->gap = at->gap, c->x = at->x, c->n = at->n, c->feature = at->feature;
    if (!g->sum) return true;
    contact_basis(c, p->dim, at->n);
    packing_set_law(p, c);
    g->sum[g->out->n - 1] = sum;
    return true;
}

static bool give_touches(struct given *g)
{
    const struct small_run *r = g->r;
    struct small_list *l = r->l;
    struct small_touch **by = small_list_touches(l);
    bool room = by != NULL;
    for (int64_t i = 0; room && i < l->touches; i++) {
        struct small_touch *t = by[i];
        const struct small_sum sum = { v3_add(small_vec(t->sum), small_vec(t->f)),
                                       v3_add(small_vec(t->turned), small_vec(t->m)) };
        const bool near = small_look_at_touch(r, t, l->margin);
        struct contact c = { .a = -1 - t->wall, .b = t->body, .n = t->n };
        c.gap = t->arm - l->s.place[t->body].r;
        c.x = v3_axpy(small_vec(l->s.place[t->body].x), -t->arm, t->n);
        room = give_contact(g, &c, near, sum);
    }
    free(by);
    return room;
}

static bool give_points(struct given *g)
{
    const struct small_run *r = g->r;
    bool room = true;
    for (int64_t i = 0; room && i < r->l->meetings.n; i++) {
        const struct small_meeting *m = &r->l->meetings.of[i];
        struct contact c = { .a = m->key.a, .b = m->key.b };
        memcpy(c.shift, m->key.shift, sizeof c.shift);
        for (int64_t k = 0; room && k < m->points; k++) {
            const struct small_point *t = &m->point[k];
            const struct small_sum sum = { v3_add(small_vec(t->sum), small_vec(t->f)),
                                           v3_add(small_vec(t->turned), small_vec(t->m)) };
            c.feature = t->from ? t->from - 1 : t->feature, c.n = t->n, c.gap = t->gap, c.x = t->x;
            room = give_contact(g, &c, t->near, sum);
        }
    }
    return room;
}

/* Are the bodies of a pair, of which none is an image, apart? */
static bool is_apart(const struct small *s, const struct pair *q, double touching)
{
    const vec3 d = v3_sub(small_vec(s->place[q->b].x), small_vec(s->place[q->a].x));
    return v3_dot(d, d) > touching * touching;
}

static bool give_pairs(struct given *g)
{
    const struct small_run *r = g->r;
    const struct small *s = &r->l->s;
    bool room = true;
    for (int64_t i = 0; room && i < r->l->pairs.n; i++) {
        const struct pair *q = &r->l->pairs.pair[i];
        const int64_t slot = r->l->slot[i];
        const double ra = s->place[q->a].r, touching = ra + s->place[q->b].r;
        const bool image = q->shift[0] || q->shift[1] || q->shift[2];
        if (!g->sum && !image && is_apart(s, q, touching)) continue; // without a look at the slot
        const vec3 d = small_branch(s, slot);
        if (!g->sum && v3_dot(d, d) > touching * touching) continue;
        const struct small_bundle *b = &s->bundle[slot / BUNDLE];
        const int k = (int)(slot % BUNDLE);
        struct small_sum sum = { v3(b->sum[0][k] + b->f[0][k], b->sum[1][k] + b->f[1][k],
                                    b->sum[2][k] + b->f[2][k]),
                                 v3(0, 0, 0) };
        const struct small_turn *t = s->turn ? &s->turn[slot / BUNDLE] : NULL;
        if (t)
            sum.m =
                v3(t->sum[0][k] + t->m[0][k], t->sum[1][k] + t->m[1][k], t->sum[2][k] + t->m[2][k]);
        const double length = v3_norm(d);
        struct contact c = { .a = q->a, .b = q->b, .n = small_normal(d) };
        memcpy(c.shift, q->shift, sizeof c.shift);
        c.gap = length - touching;
        c.x = v3_axpy(small_vec(s->place[q->a].x), ra + 0.5 * c.gap, c.n);
        room = give_contact(g, &c, true, sum);
    }
    return room;
}

struct small_given {
    struct contact c;
    struct small_sum sum;
};
static int by_key(const void *x, const void *y)
{
    const struct small_given *s = x, *t = y;
    return contact_compare(&s->c, &t->c);
}

/* Contacts and their sums in the order of keys; false when memory is short. */
static bool sort_given(struct contacts *out, struct small_sum *sum)
{
    struct small_given *all = malloc((size_t)(out->n + 1) * sizeof *all);
    for (int64_t i = 0; all && i < out->n; i++) all[i] = (struct small_given){ out->c[i], sum[i] };
    if (all) array_sort(all, out->n, sizeof *all, by_key);
    for (int64_t i = 0; all && i < out->n; i++) out->c[i] = all[i].c, sum[i] = all[i].sum;
    free(all);
    return all != NULL;
}

/* r: x in the basis of c */
static void set_along(double r[3], const struct contact *c, vec3 x)
{
    r[0] = v3_dot(x, c->n), r[1] = v3_dot(x, c->t1), r[2] = v3_dot(x, contact_t2(c));
}

/* Their reactions and moments are their sums. */
static bool set_sums(struct contacts *out, const struct small_sum *sum, bool rolls)
{
    if (contacts_alloc_found(out) || (rolls && contacts_alloc_moment(out))) return false;
    for (int64_t i = 0; i < out->n; i++) {
        set_along(out->found[i].r, &out->c[i], sum[i].f), out->found[i].status = STATUS_SUMMED;
        if (rolls) set_along(out->moment[i], &out->c[i], sum[i].m);
    }
    return true;
}

int small_give_contacts(const struct small_run *r, struct contacts *out, bool bare,
                        struct failure *failure)
{
    const int64_t most = r->l->touches + r->l->pairs.n + small_meetings_points(&r->l->meetings);
    struct given g = { r, out, bare ? NULL : malloc((size_t)(most + 1) * sizeof *g.sum) };
    out->n = 0, contacts_free_found(out), contacts_free_tie(out);
    bool room = (bare || g.sum) && give_touches(&g) && give_pairs(&g) && give_points(&g);
    if (room && !bare && r->l->meetings.n) room = sort_given(out, g.sum);
    if (room && !bare) room = set_sums(out, g.sum, packing_rolls(r->p));
    free(g.sum);
    return room ? 0 : failure_set(failure, EX_SOFTWARE, "no memory for the contacts");
}
