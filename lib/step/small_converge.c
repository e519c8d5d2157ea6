/* step/small_converge.c: what sweeps change, kept and given back [step/small_converge.h]. */
#include "step/small_converge.h"

#include "base/array.h"
#include "step/small_part.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A copy of n rows; *good: memory was there */
static void *copy_of(const void *from, int64_t n, size_t size, bool *good)
{
    if (!from) return NULL;
    void *to = malloc((size_t)n * size + 1);
    if (to && n) memcpy(to, from, (size_t)n * size);
    *good = *good && to;
    return to;
}

bool small_copy_init(struct small_copy *c, const struct small_run *r)
{
    const struct small_list *l = r->l;
    const struct small *s = &l->s;
    const int64_t n = s->bodies + 2, lanes = BUNDLE * s->bundles;
    bool good = true;
    *c = (struct small_copy){ .sweep = s->sweep, .swept = r->swept, .far = r->far };
    c->body = copy_of(s->body, n, sizeof *c->body, &good);
    c->bundle = copy_of(s->bundle, s->bundles, sizeof *c->bundle, &good);
    c->turn = copy_of(s->turn, s->bundles, sizeof *c->turn, &good);
    c->live = copy_of(s->live, lanes, 1, &good), c->late = copy_of(s->late, lanes, 1, &good);
    c->hot = copy_of(s->hot, s->bodies, sizeof *c->hot, &good);
    c->change = copy_of(s->change, s->bodies, sizeof *c->change, &good);
    c->touch = copy_of(l->touch, l->touches, sizeof *c->touch, &good);
    c->load = copy_of(r->loads.change, r->loads.list.n, sizeof *c->load, &good);
    c->point = calloc((size_t)l->meetings.n + 1, sizeof(struct small_point *));
    good = good && c->point;
    for (int64_t i = 0; good && i < l->meetings.n; i++)
        c->point[i] =
            copy_of(l->meetings.of[i].point, l->meetings.of[i].points, sizeof **c->point, &good);
    return good;
}

void small_copy_free(struct small_copy *c, const struct small_run *r)
{
    for (int64_t i = 0; c->point && i < r->l->meetings.n; i++) free(c->point[i]);
    free(c->body), free(c->bundle), free(c->turn), free(c->live), free(c->late), free(c->hot);
    free(c->change), free(c->touch), free(c->load), free(c->point);
}

static void give(void *to, const void *from, int64_t n, size_t size)
{
    if (from && n) memcpy(to, from, (size_t)n * size);
}

void small_copy_give(const struct small_copy *c, struct small_run *r)
{
    struct small_list *l = r->l;
    struct small *s = &l->s;
    const int64_t lanes = BUNDLE * s->bundles;
    give(s->body, c->body, s->bodies + 2, sizeof *c->body);
    give(s->bundle, c->bundle, s->bundles, sizeof *c->bundle);
    give(s->turn, c->turn, s->bundles, sizeof *c->turn);
    give(s->live, c->live, lanes, 1), give(s->late, c->late, lanes, 1);
    give(s->hot, c->hot, s->bodies, sizeof *c->hot);
    give(s->change, c->change, s->bodies, sizeof *c->change);
    give(l->touch, c->touch, l->touches, sizeof *c->touch);
    give(r->loads.change, c->load, r->loads.list.n, sizeof *c->load);
    for (int64_t i = 0; i < l->meetings.n; i++)
        give(l->meetings.of[i].point, c->point[i], l->meetings.of[i].points, sizeof **c->point);
    s->sweep = c->sweep, r->swept = c->swept, r->far = c->far;
}

void small_copy_wake(struct small_run *r)
{
    struct small *s = &r->l->s;
    for (int64_t i = 0; i < s->bodies; i++) s->hot[i] = s->sweep;
    memset(s->live, 1, (size_t)(BUNDLE * s->bundles));
}

double small_copy_change(const struct small_run *r, struct body *was)
{
    const struct small *s = &r->l->s;
    double most = 0;
    for (int64_t k = 0; k < small_bodies_here(r); k++) {
        const int64_t i = small_body_here(r, k);
        const struct body *b = &s->body[i];
        const vec3 dv = v3_sub(small_vec(b->v), small_vec(was[i].v));
        const vec3 dw = v3_sub(small_vec(b->w), small_vec(was[i].w));
        const double change = v3_norm(dv) + s->place[i].r * v3_norm(dw);
        most = change <= most ? most : change; // not a number: it is the largest
        was[i] = *b;
    }
    return most;
}

/* Sums of squares */
struct distance {
    double off, all;
};

static void add_distance(struct distance *d, vec3 was, vec3 is)
{
    const vec3 off = v3_sub(is, was);
    d->off += v3_dot(off, off), d->all += v3_dot(is, is);
}

double small_copy_distance(const struct small_copy *c, const struct small_run *r)
{
    const struct small_list *l = r->l;
    struct distance d = { 0, 0 };
    const int64_t lanes = r->part ? l->pairs.n : BUNDLE * l->s.bundles;
    for (int64_t i = 0; i < lanes; i++)
        add_distance(&d, small_along(r, c->bundle, i), small_along(r, l->s.bundle, i));
    for (int64_t i = 0; i < l->touches; i++)
        add_distance(&d, small_vec(c->touch[i].f), small_vec(l->touch[i].f));
    for (int64_t i = 0; i < l->meetings.n; i++)
        for (int64_t k = 0; k < l->meetings.of[i].points; k++)
            add_distance(&d, small_vec(c->point[i][k].f), small_vec(l->meetings.of[i].point[k].f));
    return d.all > 0 ? sqrt(d.off / d.all) : 0;
}
