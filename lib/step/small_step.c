/* step/small_step.c: a step in small ones: what it begins with and what is told of it [step/small_step.h]. */
#include "step/small_step.h"

#include "base/team.h"
#include "contact/depth.h"
#include "solve/backend.h"
#include "state/freedom.h"
#include "state/placement.h"
#include "step/small_loop.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    COUNT_MOST = 100000 /* small steps of a step; one that needs more is made at once */
};

/* C over W of a pair */
#define COMPLIANCE 0.04
/* Times the lightest body */
#define UNEVEN 30
/* Of h: tau, in which overlaps are left */
#define RELAXES 8
/* Of the fastest speed, or of what moves a body by UNSEEN of the smallest radius in h: a change of a velocity that is not
   followed up, in the first sweep of a step and in others */
#define UNSEEN 1e-3
static const double ALLOWED[2] = { 1, 0.3 };

const char *small_lacks(const struct packing *p)
{
    if (p->shape) return "grains other than balls";
    if (freedoms_in(p)) return "loads";
    if (p->outside.force || p->outside.torque || p->pulls.n) return "forces on bodies";
    if (packing_sticks(p)) return "static friction";
    if (packing_has_springs(p)) return "contacts with a stiffness";
    if (p->sums.n) return "sums of what bodies do to walls";
    for (int k = 0; k < 3; k++)
        if (cell_repeats(&p->cell) && v3_norm(p->cell.rate[k]) > 0) return "a cell that moves";
    for (int32_t w = 0; w < p->walls; w++)
        if (p->wall[w].shape == WALL_MESH) return "surfaces as walls";
    for (int32_t k = 0; p->law && k < p->materials * p->materials; k++)
        if (pair_law_attracts(&p->law[k])) return "cohesion";
    return NULL;
}

/* ---- the interval ---- */

static void small_set_rates(struct small_run *r)
{
    const struct packing *p = r->p;
    const double g = v3_norm(p->g);
    double heaviest = 0, lightest = INFINITY;
    for (int64_t i = 0; i < p->n; i++) {
        heaviest = fmax(heaviest, p->mass[i]);
        if (p->mass[i] > 0) lightest = fmin(lightest, p->mass[i]);
    }
    r->uneven = heaviest > UNEVEN * lightest;
    const double fastest =
        fmax(packing_whole(p).speed, small_wall_speed(p)) + g * r->h * (double)r->n;
    const double change = fmax(fastest, UNSEEN * packing_whole(p).small / r->h);
    r->l->s.rate = (struct small_rates){ .h = r->h,
                                         .per_h = 1 / r->h,
                                         .relax = 1 / ((1 + RELAXES) * r->h),
                                         .push = 2 * g * r->h * (double)r->n + 0.02 * fastest,
                                         .soft = COMPLIANCE,
                                         .calm = freedoms_calm(p),
                                         .allowed = { ALLOWED[0] * change, ALLOWED[1] * change } };
}

static void take_bodies(struct small_run *r)
{
    const struct packing *p = r->p;
    struct small *s = &r->l->s;
    for (int64_t i = 0; i < p->n; i++) {
        small_array(s->place[i].x, r->x[i]);
        small_array(s->body[i].v, p->v[i]), small_array(s->body[i].w, p->w[i]);
    }
    s->sweep = 1;
    memset(s->hot, 0, (size_t)s->bodies * sizeof *s->hot);
}

static void give_bodies(const struct small_run *r)
{
    struct packing *p = r->p;
    const struct small *s = &r->l->s;
    for (int64_t i = 0; i < p->n; i++) {
        p->v[i] = small_vec(s->body[i].v), p->w[i] = small_vec(s->body[i].w);
        p->x[i] = v3_axpy(small_vec(s->place[i].x), -r->ahead, p->v[i]);
        p->q[i] = quat_mul(quat_rotation(r->turned[i]), p->q[i]);
    }
}

/* All small steps: bodies at r->x with the velocities of the packing, which does not change but for its time */
static int small_steps(struct small_run *r, const struct small_opt *o, struct report *rep,
                       struct failure *failure)
{
    for (int64_t i = 0; i < r->p->n; i++) r->x[i] = v3_axpy(r->p->x[i], r->ahead, r->p->v[i]);
    small_list_free(r->l);
    rep->detection = 0, r->begins = true;
    while (!failure->status && !r->failed && r->made < r->n) {
        const double cpu = report_seconds(CLOCK_CPU);
        if (small_list_make(r->l, r->p, r->x, r->p->t + r->ahead, failure)) break;
        rep->detection += report_seconds(CLOCK_CPU) - cpu;
        if (r->begins) {
            small_set_rates(r), take_bodies(r);
            if (o->warm) small_list_recall(r->l, r->p, 1 / (double)r->n);
        }
        r->stop = false;
        team_do(o->threads, small_loop, r);
        for (int64_t i = 0; i < r->p->n; i++) r->x[i] = small_vec(r->l->s.place[i].x);
    }
    return failure->status;
}

/* ---- its report ---- */

struct small_energy {
    double kinetic, potential;
    vec3 momentum;
};

static struct small_energy energy_of(const struct packing *p)
{
    struct small_energy e = { 0 };
    for (int64_t i = 0; i < p->n; i++) {
        const double m = p->mass[i];
        if (!(m > 0)) continue;
        e.kinetic +=
            0.5 * (m * v3_dot(p->v[i], p->v[i]) + p->inertia[i] * v3_dot(p->w[i], p->w[i]));
        e.potential -= m * v3_dot(p->g, p->x[i]);
        e.momentum = v3_axpy(e.momentum, m, p->v[i]);
    }
    return e;
}

/* Dissipation is what the other terms leave. */
static void small_balance(struct balance *b, const struct small_energy *before,
                          const struct small_energy *after, const struct small_list *l)
{
    vec3 impulse = l->gone_impulse;
    *b = (struct balance){ .kinetic = after->kinetic, .potential = after->potential };
    b->change = after->kinetic - before->kinetic;
    b->gravity = before->potential - after->potential;
    b->drives = -l->gone_work;
    for (int64_t i = 0; i < l->touches; i++) {
        const struct small_touch *t = &l->touch[i];
        b->drives -= t->work;
        impulse = v3_add(impulse, v3_add(small_vec(t->sum), small_vec(t->f)));
    }
    b->dissipation = b->gravity + b->drives - b->change;
    small_array(b->momentum, after->momentum), small_array(b->impulse, impulse);
}

/* A contact with what it has pushed; false when memory is short. */
static bool give_contact(struct contacts *out, const struct packing *p, const struct contact *at,
                         vec3 sum, vec3(**sums))
{
    struct contact *c = contacts_add(out, at->a, at->b);
    if (!c) return false;
    contact_basis(c, p->dim, at->n);
    memcpy(c->shift, at->shift, sizeof c->shift);
    c->gap = at->gap, c->x = at->x;
    packing_set_law(p, c);
    *(*sums)++ = sum;
    return true;
}

static bool give_touches(struct contacts *out, const struct small_run *r, vec3 **sums)
{
    struct small_list *l = r->l;
    struct small_touch **by = small_list_touches(l);
    bool room = by != NULL;
    for (int64_t i = 0; room && i < l->touches; i++) {
        struct small_touch *t = by[i];
        const vec3 sum = v3_add(small_vec(t->sum), small_vec(t->f));
        if (!small_look_at_touch(r, t, l->margin)) continue;
        struct contact c = { .a = -1 - t->wall, .b = t->body, .n = t->n };
        c.gap = t->arm - l->s.place[t->body].r;
        c.x = v3_axpy(small_vec(l->s.place[t->body].x), -t->arm, t->n);
        if (c.gap <= 0 || v3_dot(sum, sum) > 0) room = give_contact(out, r->p, &c, sum, sums);
    }
    free(by);
    return room;
}

static bool give_pairs(struct contacts *out, const struct small_run *r, vec3 **sums)
{
    const struct small *s = &r->l->s;
    bool room = true;
    for (int64_t i = 0; room && i < r->l->pairs.n; i++) {
        const struct pair *q = &r->l->pairs.pair[i];
        const int64_t slot = r->l->slot[i];
        const struct small_bundle *b = &s->bundle[slot / BUNDLE];
        const int k = (int)(slot % BUNDLE);
        const vec3 sum =
            v3(b->sum[0][k] + b->f[0][k], b->sum[1][k] + b->f[1][k], b->sum[2][k] + b->f[2][k]);
        const vec3 d = small_branch(s, slot);
        const double length = v3_norm(d), ra = s->place[q->a].r;
        struct contact c = { .a = q->a, .b = q->b, .n = v3_scale(1 / length, d) };
        memcpy(c.shift, q->shift, sizeof c.shift);
        c.gap = length - ra - s->place[q->b].r;
        c.x = v3_axpy(small_vec(s->place[q->a].x), ra + 0.5 * c.gap, c.n);
        if (c.gap <= 0 || v3_dot(sum, sum) > 0) room = give_contact(out, r->p, &c, sum, sums);
    }
    return room;
}

/* The contacts at the end of the interval, with the sums of their reactions over it */
static int give_contacts(const struct small_run *r, struct contacts *out, struct failure *failure)
{
    vec3 *sum = malloc((size_t)(r->l->touches + r->l->pairs.n + 1) * sizeof *sum), *next = sum;
    out->n = 0, contacts_free_found(out), contacts_free_tie(out);
    bool room = sum && give_touches(out, r, &next) && give_pairs(out, r, &next);
    room = room && !contacts_alloc_found(out);
    for (int64_t i = 0; room && i < out->n; i++) {
        const struct contact *c = &out->c[i];
        struct found *f = &out->found[i];
        f->r[0] = v3_dot(sum[i], c->n), f->r[1] = v3_dot(sum[i], c->t1);
        f->r[2] = v3_dot(sum[i], contact_t2(c)), f->status = STATUS_SUMMED;
    }
    free(sum);
    return room ? 0 : failure_set(failure, EX_SOFTWARE, "no memory for the contacts");
}

/* What the report has been given before the step, and nothing of another step */
static void small_report(struct report *rep, const struct small_run *r, const struct contacts *s)
{
    *rep = (struct report){ .options = rep->options,
                            .criterion = rep->criterion,
                            .eps = rep->eps,
                            .detection = rep->detection,
                            .method = "small",
                            .step = r->p->step,
                            .t = r->p->t,
                            .err = { .contacts = s->n, .max_overlap = contacts_max_overlap(s) },
                            .balanced = true,
                            .converged = true,
                            .sweeps = (int32_t)r->sweeps,
                            .substeps = 1,
                            .small = r->n,
                            .small_limited = r->unsolved };
}

/* s: in which a column of grains as high as the packing falls by STEADY of the smallest radius */
#define STEADY 1e-3
static double small_steady(const struct packing *p)
{
    const double g = v3_norm(p->g), least = packing_whole(p).small;
    double lo = INFINITY, hi = -INFINITY;
    for (int64_t i = 0; i < p->n; i++) {
        const double z = v3_dot(p->g, p->x[i]);
        if (p->mass[i] > 0) lo = fmin(lo, z), hi = fmax(hi, z);
    }
    if (!(g > 0) || !(hi >= lo)) return INFINITY;
    const double grains = 1 + (hi - lo) / g / (2 * packing_whole(p).large);
    return sqrt(STEADY * least / (g * grains));
}

int64_t small_count(const struct packing *p, double overlap)
{
    const double fastest = fmax(packing_whole(p).speed, small_wall_speed(p));
    const double way = p->dt * (fastest + v3_norm(p->g) * p->dt);
    const double n = fmax(way / (overlap * packing_whole(p).small), p->dt / small_steady(p));
    return n > COUNT_MOST ? 0 : (int64_t)fmax(1, ceil(n));
}

int small_advance(struct packing *p, struct contacts *s, struct small_list *l,
                  const struct small_opt *o, struct report *rep, bool *made,
                  struct failure *failure)
{
    const double cpu = report_seconds(CLOCK_CPU), elapsed = report_seconds(CLOCK_WALL);
    const struct packing whole = *p;
    const int64_t count = small_count(p, o->overlap);
    *made = false;
    if (!count) return 0;
    const size_t n = (size_t)p->n + 1;
    packing_wrap(p, NULL);
    const struct small_energy before = energy_of(p);
    struct small_run r = { .p = p, .l = l, .lock = PTHREAD_MUTEX_INITIALIZER };
    r.n = count, r.kernel = backend_widest()->small;
    r.h = p->dt / (double)r.n, r.ahead = (1 - p->theta) * r.h;
    r.wall = calloc((size_t)p->walls + 1, sizeof *r.wall);
    r.x = calloc(n, sizeof *r.x), r.turned = calloc(n, sizeof *r.turned);
    p->dt = r.h, p->t0 = p->t, p->step0 = p->step;
    if (!r.wall || !r.x || !r.turned)
        failure_set(failure, EX_SOFTWARE, "no memory for small steps");
    else
        small_steps(&r, o, rep, failure);
    p->dt = whole.dt, p->t0 = whole.t0, p->step0 = whole.step0;
    *made = !failure->status && !r.failed;
    if (*made && !give_contacts(&r, s, failure) &&
        !(o->warm && small_list_remember(l, p, 1 / (double)r.n, failure))) {
        give_bodies(&r);
        memory_set(&p->memory, o->warm);
        p->step++, p->t = packing_time(p, p->step);
        const struct small_energy after = energy_of(p);
        small_report(rep, &r, s);
        small_balance(&rep->balance, &before, &after, l);
        depth_of(&rep->depth, p, s, NULL, failure);
    } else {
        p->t = whole.t;
    }
    rep->seconds = report_seconds(CLOCK_CPU) - cpu - rep->detection;
    rep->elapsed = report_seconds(CLOCK_WALL) - elapsed;
    free(r.wall), free(r.x), free(r.turned);
    return failure->status;
}
