/* solve/problem.c: the slots of a problem, and what is kept for each bundle [solve/problem.h]. */
#include "solve/problem.h"

#include "base/team.h"
#include "solve/exchange.h"
#include "solve/plan.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

enum {
    PER_THREAD = 4096, /* slots that are worth a thread: 100 us of work */
    PARALLEL_FROM = 64 /* bundles a group, on average, that are worth more than one thread */
};

static_assert(sizeof(struct body) == 64, "a body is a cache line");
static_assert(sizeof(struct bundle) % 64 == 0 && sizeof(struct near_bundle) % 64 == 0,
              "lanes begin a cache line");
static_assert(sizeof(struct levers) % 64 == 0, "lanes begin a cache line");

#define ARRAY_PLACE(name) { offsetof(struct problem, name), sizeof *((struct problem *)0)->name },
static const struct {
    size_t at, size; /* of the member in struct problem; bytes of an element */
} arrays[ARRAYS] = { EACH_ARRAY(ARRAY_PLACE) };

struct array_of problem_array(const struct problem *p, enum array which)
{
    struct array_of a = { .size = which == ARRAY_bundle ? bundle_size(p) : arrays[which].size };
    memcpy(&a.x, (const char *)p + arrays[which].at, sizeof a.x);
    return a;
}

void problem_set_array(struct problem *p, enum array which, void *x)
{
    memcpy((char *)p + arrays[which].at, &x, sizeof x);
}

void problem_free(struct problem *p)
{
    for (int k = 0; k < ARRAYS; k++) free(problem_array(p, (enum array)k).x);
    free(p->body), free(p->split), free(p->pull), free(p->in_W), free(p->spin), free(p->held);
    plan_free(p->plan);
    delassus_free(&p->sorted);
    free(p->brake);
    if (p->own) delassus_free(p->own);
    if (p->coupling) couplings_free(p->coupling);
    free(p->own), free(p->coupling);
    *p = (struct problem){ 0 };
}

/*
 * g dt, or a part of the mean |u~_free| where that is more: while much collides, errors of g dt would be a
 * thousandth of what the contacts change. A mean, so that one impact on a pile does not blur the rest.
 * Without gravity nothing but the mean is known of the motion. A tenth of this part makes steps of jammed
 * packings at constant volume sweep to their limit.
 */
#define UNIT_OF_SPEED 0.2

/*
 * Of reactions without end. A reaction r that has one changes the momentum of what it holds up: r is at most
 * m v, of the heaviest body and the fastest contact, times the chains and the wedges that amplify it. ENDLESS
 * m v is more than these give; lambda r is then ENDLESS times the mass ratio times v.
 */
#define JAMMED  1e9  /* of the unit that there is with gravity */
#define ROUNDED 1e14 /* v: the rounding of lambda r is then a third of v */
#define ENDLESS 1e3
#define WILD    1e2 /* v: a tenth of what a reaction without end makes of the heaviest body, or more */

void problem_set_unit(struct problem *p)
{
    const double unit = fmax(p->fall, UNIT_OF_SPEED * p->mean_q), v = fmax(p->fall, p->most_q);
    p->unit = unit;
    p->endless[0] = JAMMED * unit, p->endless[1] = ENDLESS * p->heaviest * v;
    p->rounded = ROUNDED * v, p->wild = WILD * v;
}

bool problem_is_endless(const struct problem *p, double lambda, double r)
{
    return lambda * r > p->endless[0] && r > p->endless[1];
}

int64_t problem_bundles(const struct problem *p)
{
    return p->exchange ? p->exchange->bundles : p->bundles;
}

bool problem_halves(const struct problem *p)
{
    return p->exchange ? p->exchange->halves : p->split != NULL;
}

struct extra_levers *slot_turn(const struct problem *p, int64_t i)
{
    return p->turn ? &p->turn[i / BUNDLE] : NULL;
}

struct extra_lane slot_extra(const struct problem *p, int64_t i)
{
    const struct bundle *c = slot_bundle(p, i);
    return (struct extra_lane){ slot_lane(i),    c,      bundle_beside(p, c), &p->extra[i / BUNDLE],
                                slot_turn(p, i), p->body };
}

void slot_get(const struct problem *p, int64_t i, double r[3], double u[3])
{
    const struct bundle *c = slot_bundle(p, i);
    for (int k = 0; k < 3; k++)
        r[k] = c->r[k][slot_lane(i)], u[k] = p->u[i / BUNDLE][k][slot_lane(i)];
}

void slot_set(struct problem *p, int64_t i, const double r[3], const double u[3])
{
    struct bundle *c = slot_bundle(p, i);
    for (int k = 0; k < 3; k++)
        c->r[k][slot_lane(i)] = r[k], p->u[i / BUNDLE][k][slot_lane(i)] = u[k];
}

void slot_get_beyond(const struct problem *p, int64_t i, double x[BESIDE_R])
{
    const struct extra *y = &p->extra[i / BUNDLE];
    for (int k = 0; k < 3; k++) x[k] = y->z[k][slot_lane(i)], x[3 + k] = y->m[k][slot_lane(i)];
}

void slot_set_beyond(struct problem *p, int64_t i, const double x[BESIDE_R])
{
    struct extra *y = &p->extra[i / BUNDLE];
    for (int k = 0; k < 3; k++) y->z[k][slot_lane(i)] = x[k], y->m[k][slot_lane(i)] = x[3 + k];
}

int problem_team(const struct problem *p, int threads)
{
    if (p->bundles >= PARALLEL_FROM * p->groups) return threads;
    return p->split && threads > 1 ? 2 : 1;
}

/* Slots whose contacts are told what was found */
struct storing {
    const struct problem *p;
    struct contacts *s;
};

static void store_some(void *arg, int64_t first, int64_t end)
{
    const struct storing *o = arg;
    const struct problem *p = o->p;
    for (int64_t i = BUNDLE * first; i < BUNDLE * end; i++) {
        if (p->contact[i] < 0) continue;
        struct found *c = &o->s->found[p->contact[i]];
        slot_get(p, i, c->r, c->u);
        const struct contact *law = &o->s->c[p->contact[i]];
        for (int k = 0; k < 3 && problem_undivided(p); k++)
            c->u[k] /= 1 + (k ? law->et : law->en); // it is D u~
        c->status = (int8_t)local_status(slot_bundle(p, i)->mu[slot_lane(i)], c->r);
        if (problem_is_endless(p, slot_lambda(p, i), c->r[0])) c->status = STATUS_JAMMED;
        double x[BESIDE_R];
        if (p->extra) slot_get_beyond(p, i, x);
        for (int k = 0; k < 3 && p->extra; k++) {
            c->r[k] += x[k] - p->extra[i / BUNDLE].a[k][slot_lane(i)];
            if (o->s->moment) o->s->moment[p->contact[i]][k] = x[3 + k];
        }
        const struct extra *in_W = p->in_W ? &p->in_W[i / BUNDLE] : NULL;
        for (int k = 0; k < 3 && in_W; k++) // e = 0 where there is a bond, so that D is 1
            c->r[k] -= in_W->a[k][slot_lane(i)] + in_W->K[k > 0][slot_lane(i)] * c->u[k];
        if (p->pull) c->r[0] -= p->pull[i];
    }
}

int problem_store(const struct problem *p, struct contacts *s)
{
    struct storing o = { p, s };
    if (contacts_alloc_found(s) || (p->kind.rolls && contacts_alloc_moment(s))) return -1;
    team_share(team_size(), p->bundles, PER_THREAD / BUNDLE, store_some, &o);
    return 0;
}
