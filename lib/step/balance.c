/* step/balance.c: energy and momentum, summed over bodies and contacts, and restitutions that gain no energy [step/balance.h]. */
#include "step/balance.h"

#include "contact/contact_law.h"
#include "state/freedom.h"
#include "state/rotation.h"

#include <stdlib.h>

/* The mean velocities of a body over the step */
struct balance_mean {
    vec3 v, w; /* m/s, rad/s */
};

static void balance_add_to(double t[3], double s, vec3 a)
{
    t[0] += s * a.x, t[1] += s * a.y, t[2] += s * a.z;
}

/* The cell's flow accelerates body i, whose velocity the rest of the step changes by *dv. */
static void add_flow(struct balance *b, const struct packing *p, const struct impulses *sum,
                     int64_t i, vec3 *dv)
{
    vec3 gain = cell_flow_gain(&sum->flow, packing_predict(p, i));
    *dv = v3_add(*dv, gain);
    b->drives += p->mass[i] * v3_dot(gain, v3_axpy(p->v[i], 0.5, *dv));
    balance_add_to(b->impulse, p->mass[i], gain);
}

/* The sums over bodies of[], and mean[n] of all */
static void add_bodies(struct balance *of_all, const struct packing *p, const struct impulses *sum,
                       const bool *of, struct balance_mean *mean)
{
    double before = step_ahead(p), after = step_after(p);
    struct balance none = { 0 }; // of those that do not count
    for (int64_t i = 0; i < p->n; i++) {
        struct balance *b = !of || of[i] ? of_all : &none;
        double m = p->mass[i];
        mean[i] = (struct balance_mean){ p->v[i], p->w[i] };
        if (!(m > 0)) continue;
        vec3 dv = v3_axpy(v3_scale(p->dt, p->g), 1 / m, sum->force[i]);
        if (sum->flow.changes) add_flow(b, p, sum, i, &dv);
        quat q = rotation_is(p, i) ? rotation_predict(p, i) : p->q[i]; // where the reactions act
        vec3 dw = rotation_spin(p, i, q, sum->moment[i]), was = rotation_predict_spin(p, i, q);
        vec3 v = v3_add(p->v[i], dv), w = v3_add(was, dw);
        vec3 x = v3_axpy(v3_axpy(p->x[i], before, p->v[i]), after, v);
        mean[i] = (struct balance_mean){ v3_axpy(p->v[i], 0.5, dv), v3_axpy(was, 0.5, dw) };
        b->kinetic += 0.5 * (m * v3_dot(v, v) + rotation_energy2(p, i, q, w));
        b->potential -= m * v3_dot(p->g, x);
        b->change += 0.5 * m * (v3_dot(v, v) - v3_dot(p->v[i], p->v[i]));
        b->change += rotation_is(p, i)
                         ? 0.5 * (rotation_energy2(p, i, q, w) - rotation_energy2(p, i, q, was))
                         : 0.5 * p->inertia[i] * (v3_dot(w, w) - v3_dot(p->w[i], p->w[i]));
        b->gravity += p->dt * m * v3_dot(p->g, mean[i].v);
        balance_add_to(b->momentum, m, v);
        if (p->outside.force) b->loads += p->dt * v3_dot(p->outside.force[i], mean[i].v);
        if (p->outside.torque) b->loads += p->dt * v3_dot(p->outside.torque[i], mean[i].w);
        if (!p->pulls.n) continue;
        const double middle = p->t + p->dt / 2;
        b->loads += p->dt * v3_dot(packing_pull(p, i, middle, false), mean[i].v);
        b->loads += p->dt * v3_dot(packing_pull(p, i, middle, true), mean[i].w);
    }
}

static void balance_add_freedoms(struct balance *b, const struct packing *p,
                                 const struct impulses *sum)
{
    for (int32_t k = 0; k < sum->freedoms.n; k++) {
        const struct freedom *f = &sum->freedoms.f[k];
        double change = impulses_change(sum, p, k), s = f->speed + change;
        b->kinetic += 0.5 * f->mass * s * s;
        b->change += 0.5 * f->mass * (s * s - f->speed * f->speed);
        b->loads += p->dt * f->force * (f->speed + 0.5 * change);
    }
}

/* J: r . u of what is prescribed of the velocity at a contact, and of the rest, with the mean over
   the step */
struct balance_work {
    double held, free;
};

/*
 * What freedoms and the cell add to it. Of an edge that yields the contact sees the mean rate by the shift; the
 * freedom gets what it sees by J, and the rest is the bodies', which follow the flow.
 */
static void add_beyond(struct balance_work *w, const struct packing *p, const struct impulses *sum,
                       const struct contact *c, vec3 f)
{
    vec3 twice = v3_add(cell_shift(p->cell.rate, c->shift), cell_shift(sum->next, c->shift));
    w->held += 0.5 * v3_dot(f, twice);
    for (int32_t k = 0; k < sum->freedoms.n; k++) {
        const struct freedom *freedom = &sum->freedoms.f[k];
        double half = 0.5 * impulses_change(sum, p, k);
        double got = v3_dot(f, freedom_direction(freedom, p, c, sum->ahead, sum->edge)) *
                     (freedom->speed + half);
        w->free += got;
        if (!freedom_of_cell(freedom)) continue;
        w->held += v3_dot(f, cell_shift(freedom->gain, c->shift)) * half - got;
    }
}

/* What tied contacts store is not dissipated. */
static void add_ties(struct balance *b, const struct packing *p, const struct contacts *s)
{
    for (int64_t i = 0; s->law && i < s->n; i++) {
        const struct contact_law *t = &s->law[i];
        if (!t->state && !(t->pull > 0) && !(t->spring[0] > 0)) continue;
        struct contact_law_end end =
            contact_law_end(p, &s->c[i], t, &s->found[i], s->moment ? s->moment[i] : NULL);
        struct contact_law_account a = contact_law_account(p, &s->c[i], t, &end);
        b->bond_change += a.change, b->bond_energy += a.stored, b->broken += a.broken;
        b->implicit += a.implicit, b->rise += a.rise;
    }
    b->dissipation -= b->bond_change + b->broken - b->rise;
}

/* The moment on b turns it, and the other way round a. */
static void balance_add_moment(struct balance_work *w, const struct packing *p,
                               const struct contact *c, const double moment[3],
                               const struct balance_mean *mean)
{
    vec3 m = contact_in_space(c, moment);
    *(p->mass[c->b] > 0 ? &w->free : &w->held) += v3_dot(m, mean[c->b].w);
    if (c->a < 0)
        w->held -= v3_dot(m, wall_spin(p, &p->wall[-1 - c->a]));
    else
        *(p->mass[c->a] > 0 ? &w->free : &w->held) -= v3_dot(m, mean[c->a].w);
}

/* Of the reaction r of contact i, without its moment */
static struct balance_work work_of(const struct packing *p, const struct contact *c,
                                   const double r[3], const struct impulses *sum,
                                   const struct balance_mean *mean)
{
    const struct push o = push_of(p, sum->ahead, sum->edge, c, r);
    const struct balance_mean *mb = &mean[c->b];
    struct balance_work w = { 0 };
    bool a_moves = c->a >= 0 && p->mass[c->a] > 0, b_moves = p->mass[c->b] > 0;
    *(b_moves ? &w.free : &w.held) += v3_dot(o.f, mb->v) + push_turns_b(&o, mb->w);
    if (c->a >= 0) {
        const struct balance_mean *ma = &mean[c->a];
        *(a_moves ? &w.free : &w.held) += push_turns_a(&o, ma->w) - v3_dot(o.f, ma->v);
    } else {
        const struct wall *wall = &p->wall[-1 - c->a];
        w.held -= v3_dot(o.f, v3_add(wall_held(p, wall, c->x), wall_belt(p, wall, c->n)));
    }
    if (sum->freedoms.n || cell_repeats(&p->cell)) add_beyond(&w, p, sum, c, o.f);
    return w;
}

static void balance_add_contacts(struct balance *b, const struct packing *p,
                                 const struct contacts *s, const struct impulses *sum,
                                 const struct balance_mean *mean)
{
    for (int64_t i = 0; i < s->n; i++) {
        const struct contact *c = &s->c[i];
        const double *r = s->found[i].r;
        if (r[0] == 0 && r[1] == 0 && r[2] == 0) continue;
        struct balance_work w = work_of(p, c, r, sum, mean);
        if (s->moment) balance_add_moment(&w, p, c, s->moment[i], mean);
        b->drives -= w.held;
        b->dissipation -= w.held + w.free;
        bool a_moves = c->a >= 0 && p->mass[c->a] > 0, b_moves = p->mass[c->b] > 0;
        if (a_moves == b_moves) continue;
        vec3 f = contact_in_space(c, r);
        balance_add_to(b->impulse, b_moves ? 1 : -1, f);
    }
}

/*
 * Of the pair whose contacts are first .. end-1. Restitution never gives more than the approach had: its part counts
 * where it takes energy, lest what a solve leaves of it be called a gain.
 */
static struct gain gain_of(const struct packing *p, const struct contacts *s, int64_t first,
                           int64_t end, const struct impulses *sum, const struct balance_mean *mean)
{
    double normal = 0, rest = 0, scale = 0;
    bool impact = false;
    for (int64_t i = first; i < end; i++) {
        const struct contact *c = &s->c[i];
        const double *r = s->found[i].r, push[3] = { r[0], 0, 0 }, rub[3] = { 0, r[1], r[2] };
        double approach = -opening_of(p, c, sum->ahead);
        struct balance_work n = work_of(p, c, push, sum, mean), t = work_of(p, c, rub, sum, mean);
        impact = impact || (c->en > 0 && r[0] > 0 && approach > freedoms_calm(p));
        normal += n.held + n.free, rest += t.held + t.free, scale += r[0] * fabs(approach);
    }
    if (!impact || !(rest > 0)) return (struct gain){ fmin(normal, 0) + fmin(rest, 0), 0 };
    return (struct gain){ fmin(normal, 0) + rest, scale };
}

/* The first contact after i that is of another pair */
int64_t balance_next_pair(const struct contacts *s, int64_t i)
{
    int64_t k = i + 1;
    while (k < s->n && s->c[k].a == s->c[i].a && s->c[k].b == s->c[i].b) k++;
    return k;
}

static void find_gains(struct gain *gain, const struct packing *p, const struct contacts *s,
                       const struct impulses *sum, const struct balance_mean *mean)
{
    for (int64_t i = 0, next; i < s->n; i = next) {
        next = balance_next_pair(s, i);
        gain[i] = gain_of(p, s, i, next, sum, mean);
        for (int64_t k = i + 1; k < next; k++) gain[k] = (struct gain){ 0, 0 };
    }
}

/* gain[s->n], at the first contact of each pair. Returns 0 or EX_SOFTWARE. */
static int balance_gains(struct gain *gain, const struct packing *p, const struct contacts *s,
                         const struct impulses *sum, struct failure *failure)
{
    struct balance_mean *mean = malloc(((size_t)p->n + 1) * sizeof *mean);
    struct balance unwanted = { 0 };
    if (!mean) return failure_set(failure, EX_SOFTWARE, "no memory for the balances");
    add_bodies(&unwanted, p, sum, NULL, mean);
    find_gains(gain, p, s, sum, mean);
    free(mean);
    return 0;
}

/* Of all impacts that gain; false when memory is short. */
static bool add_gains(struct balance *b, const struct packing *p, const struct contacts *s,
                      const struct impulses *sum, const struct balance_mean *mean)
{
    if (!packing_may_gain(p)) return true;
    struct gain *gain = malloc(((size_t)s->n + 1) * sizeof *gain);
    if (!gain) return false;
    find_gains(gain, p, s, sum, mean);
    for (int64_t i = 0; i < s->n; i++)
        if (gain[i].work > GAIN_LEAST * gain[i].scale) b->gained += gain[i].work;
    free(gain);
    return true;
}

int balance_step(struct balance *b, const struct packing *p, const struct contacts *s,
                 const struct impulses *sum, const bool *of, struct failure *failure)
{
    struct balance_mean *mean = malloc(((size_t)p->n + 1) * sizeof *mean);
    *b = (struct balance){ 0 };
    if (!mean) return failure_set(failure, EX_SOFTWARE, "no memory for the balances");
    add_bodies(b, p, sum, of, mean);
    if (energy_has_peculiar(p)) b->peculiar_change = -energy_peculiar(p, of);
    balance_add_freedoms(b, p, sum);
    balance_add_contacts(b, p, s, sum, mean);
    add_ties(b, p, s);
    bool good = add_gains(b, p, s, sum, mean);
    free(mean);
    return good ? 0 : failure_set(failure, EX_SOFTWARE, "no memory for the balances");
}

/* ---- the search for restitutions that gain nothing ---- */

enum {
    ROUNDS = 24 /* solves: of one impact 5 to 8 do */
};

/* Of the energy that an approach could give up: what a bounded impact may lose more than it must */
#define ENOUGH 1e-5

/* Of one pair: gains at most nothing with lo, something with hi */
struct bracket {
    double s, lo, hi;    /* of e_n and e_t */
    double at_lo, at_hi; /* J; at_lo NAN: not known */
    bool bounded;
};

struct rebound_search {
    int rounds;
    struct gain *gain;    /* [n] */
    struct bracket *pair; /* [n] */
};

void rebound_free(struct rebound_search *o)
{
    if (o) free(o->gain), free(o->pair);
    free(o);
}

static struct rebound_search *rebound_new(int64_t n)
{
    struct rebound_search *o = calloc(1, sizeof *o);
    if (!o) return NULL;
    o->gain = calloc((size_t)n + 1, sizeof *o->gain);
    o->pair = calloc((size_t)n + 1, sizeof *o->pair);
    for (int64_t i = 0; o->pair && i < n; i++)
        o->pair[i] = (struct bracket){ .s = 1, .hi = 1, .at_lo = NAN };
    if (o->gain && o->pair) return o;
    rebound_free(o);
    return NULL;
}

/* The next s, after the gain with this one; false: it stays. */
static bool narrow(struct bracket *b, const struct gain *g)
{
    bool gains = g->work > GAIN_LEAST * g->scale;
    if (!gains && (!b->bounded || g->work >= -ENOUGH * g->scale || b->s == 0)) return false;
    if (gains && b->s == 0) return false; // that is the others' doing
    b->bounded = true;
    if (gains) {
        b->hi = b->s, b->at_hi = g->work, b->at_lo *= 0.5; // the other end's share, lest it stays
    } else {
        b->lo = b->s, b->at_lo = g->work, b->at_hi *= 0.5;
    }
    double along = isnan(b->at_lo) ? 0.5 : b->at_lo / (b->at_lo - b->at_hi);
    b->s = b->lo + along * (b->hi - b->lo);
    return true;
}

/* Sets the restitution of the contacts from i to end-1. */
static void balance_set(const struct packing *p, struct contacts *s, int64_t i, int64_t end,
                        double times)
{
    for (; i < end; i++) {
        const double mu = s->c[i].mu;
        if (s->law && s->law[i].spring[0] > 0 && !(s->law[i].state & CONTACT_LAW_MEETS)) continue;
        packing_set_law(p, &s->c[i]);
        if (p->mu_s[packing_pair(p, s->c[i].a, s->c[i].b)] > 0) s->c[i].mu = mu;
        s->c[i].en *= times, s->c[i].et *= times;
    }
}

static int balance_find(struct rebound_search *o, const struct packing *p, const struct contacts *s,
                        struct failure *failure)
{
    struct impulses sum;
    if (!impulses_init(&sum, p, s, false, failure)) balance_gains(o->gain, p, s, &sum, failure);
    impulses_free(&sum);
    return failure->status;
}

int rebound_reduce(struct rebound_search **search, const struct packing *p, struct contacts *s,
                   bool *again, struct failure *failure)
{
    *again = false;
    bool any = false;
    for (int64_t i = 0; i < s->n && !any; i++) any = packing_bounds(p, &s->c[i]);
    if (!any) return 0;
    struct rebound_search *o = *search = *search ? *search : rebound_new(s->n);
    if (!o) return failure_set(failure, EX_SOFTWARE, "no memory for the impacts");
    if (balance_find(o, p, s, failure)) return failure->status;
    o->rounds++;
    for (int64_t i = 0, next; i < s->n; i = next) {
        struct bracket *b = &o->pair[i];
        next = balance_next_pair(s, i);
        if (!packing_bounds(p, &s->c[i]) || !narrow(b, &o->gain[i])) continue;
        if (o->rounds >= ROUNDS) b->s = b->lo = 0; // the last
        balance_set(p, s, i, next, b->s);
        *again = o->rounds <= ROUNDS;
    }
    return 0;
}
