/* problem/sweep.c: see problem/sweep.h. Compiled once a width, LANES = 2, 4, 8. */
#include "problem/sweep.h"

#include "law/local_eal.h"
#include "law/local_ebp.h"
#include "law/local_exact.h"
#include "law/local_sal.h"
#include "law/local_sbp.h"
#include "problem/walk.h"

typedef void method_text(struct local *, const struct local_opt *);

/* Of LANES slots */
ALWAYS_INLINE void add(double *slot, vd a)
{
    vstore(slot, vload(slot) + a);
}

ALWAYS_INLINE void raise(double *slot, vd a)
{
    vstore(slot, larger(a, vload(slot)));
}

/* A tally in the making */
struct count {
    vd change, newton, safeguarded, gave_up;
};

/* What is known of LANES rows before they are solved */
struct seat {
    struct bodies a, b;
    vd t2[3]; /* of the frames */
    vd v[3];  /* m/s: as r is; given by W: b_c */
};

ALWAYS_INLINE void begin(const struct problem *p, const struct bundle *c, int k, bool given_by_W,
                         struct seat *s)
{
    if (given_by_W) {
        blocks_gather(p, c, k, s->v);
        return;
    }
    struct twist a, b;
    bodies_load(&s->a, p->body, c->a + k, &a), bodies_load(&s->b, p->body, c->b + k, &b);
    bundle_velocity(c, bundle_rebound(p, c), k, &a, &b, s->v, s->t2);
}

/* The local problem; W[9] is room for what l->W shows. */
ALWAYS_INLINE void pose(const struct problem *p, const struct bundle *c, int k, bool given_by_W,
                        bool full, const struct seat *s, vd W[9], struct local *l)
{
    l->d = p->d, l->W = full ? W : NULL;
    l->mu = vload(c->mu + k), l->rho = vload(c->rho + k);
    for (int i = 0; i < 9 && full; i++) W[i] = vload(c->W[i] + k);
    for (int i = 0; i < 3; i++) {
        l->w[i] = full ? W[4 * i] : vload(c->w[i > 0] + k);
        l->iw[i] = full ? splat(0) : vload(c->iw[i > 0] + k);
        l->r[i] = vload(c->r[i] + k), l->v[i] = s->v[i];
        l->b[i] = given_by_W ? s->v[i] : l->v[i] - l->w[i] * l->r[i];
    }
    if (given_by_W) local_velocity(l, l->r, l->v);
}

/*
 * The solution, over-relaxed. Exact between balls goes past what stops the contact, and then onto the
 * disc [projected SOR], which costs nothing; others past the new reaction, and back onto the cone.
 */
ALWAYS_INLINE void relaxed(struct local *l, const struct bundle *c, int k, method_text *solve,
                           bool full, const struct sweep_opt *o)
{
    bool within = solve == exact_solve && !full;
    l->relax = within ? o->relax : 1;
    solve(l, &o->local);
    if (within || o->relax == 1) return;
    vd tau[3];
    for (int i = 0; i < 3; i++) {
        vd was = vload(c->r[i] + k);
        tau[i] = was + o->relax * (l->r[i] - was);
    }
    cone_project(l->mu, tau, l->r);
}

/* The solution into the rows; dr: by how much it changes them */
ALWAYS_INLINE void take(struct bundle *c, int k, double (*belief)[BUNDLE], const struct local *l,
                        vd dr[3], struct count *t)
{
    for (int i = 0; i < 3; i++) {
        dr[i] = l->r[i] - vload(c->r[i] + k);
        vstore(c->r[i] + k, l->r[i]);
    }
    if (__builtin_expect(belief != NULL, 0)) {
        vd u[3];
        local_velocity(l, l->r, u);
        for (int i = 0; i < 3; i++) vstore(belief[i] + k, u[i]);
    }
    t->change = larger(absolute(dr[0]) * l->w[0], t->change);
    t->newton += pick(lt(splat(0), l->rho), l->steps, splat(0));
    if (any(l->safeguarded | l->gave_up)) {
        t->safeguarded += pick(l->safeguarded, splat(1), splat(0));
        t->gave_up += pick(l->gave_up, splat(1), splat(0));
    }
}

/* and into their bodies, or W's reactions */
ALWAYS_INLINE void pass_on(struct problem *p, const struct bundle *c, int k, bool given_by_W,
                           const struct seat *s, const vd dr[3])
{
    if (given_by_W)
        blocks_scatter(p, c, k);
    else
        bundle_push(c, k, s->t2, dr, p->body, &s->a, &s->b);
}

/*
 * Bundles first .. end-1, of one group. The bodies of the next rows are fetched while the roots and
 * quotients of these are on their way: that takes a quarter off the time.
 */
ALWAYS_INLINE void visit(struct problem *p, int64_t first, int64_t end, const struct sweep_opt *o,
                         method_text *solve, bool given_by_W, bool full, struct count *t)
{
    if (first == end) return;
    struct seat s[2], *now = &s[0], *next = &s[1];
    begin(p, &p->bundle[first], 0, given_by_W, now);
    for (int64_t i = first; i < end; i++) {
        struct bundle *c = &p->bundle[i];
        double(*belief)[BUNDLE] = o->keep ? p->u[i] : NULL;
        fetch_ahead(p, i);
        for (int k = 0; k < BUNDLE; k += LANES) {
            struct local l;
            vd W[9], dr[3];
            pose(p, c, k, given_by_W, full, now, W, &l);
            relaxed(&l, c, k, solve, full, o);
            take(c, k, belief, &l, dr, t);
            if (k + LANES < BUNDLE)
                begin(p, c, k + LANES, given_by_W, next);
            else if (i + 1 < end)
                begin(p, c + 1, 0, given_by_W, next);
            pass_on(p, c, k, given_by_W, now, dr);
            struct seat *was = now;
            now = next, next = was;
        }
    }
}

/* A sweep of a method over its contacts */
struct task {
    const struct sweep_opt *o;
    method_text *solve;
    bool given_by_W, full;
    struct count *count;
};

ALWAYS_INLINE void visit_group(struct problem *p, int64_t first, int64_t end, void *task)
{
    const struct task *t = task;
    visit(p, first, end, t->o, t->solve, t->given_by_W, t->full, t->count);
}

ALWAYS_INLINE void sweep(struct problem *p, int me, int threads, const struct sweep_opt *o,
                         method_text *solve, bool given_by_W, bool full, struct tally *t)
{
    struct count c = { splat(0), splat(0), splat(0), splat(0) };
    struct task task = { o, solve, given_by_W, full, &c };
    walk(p, me, threads, visit_group, &task);
    raise(t->change, c.change), add(t->newton, c.newton);
    add(t->safeguarded, c.safeguarded), add(t->gave_up, c.gave_up);
}

#define VISIT(name)                                                                                \
    static void sweep_##name(struct problem *p, int me, int threads, const struct sweep_opt *o,    \
                             struct tally *t)                                                      \
    {                                                                                              \
        if (p->full)                                                                               \
            sweep(p, me, threads, o, name##_solve, true, true, t);                                 \
        else if (p->W)                                                                             \
            sweep(p, me, threads, o, name##_solve, true, false, t);                                \
        else                                                                                       \
            sweep(p, me, threads, o, name##_solve, false, false, t);                               \
    }
EACH_METHOD(VISIT)

/* ---- velocities from the reactions ---- */

ALWAYS_INLINE void push_group(struct problem *p, int64_t first, int64_t end, void *task)
{
    (void)task;
    for (int64_t i = first; i < end; i++) {
        fetch_ahead(p, i);
        for (int k = 0; k < BUNDLE; k += LANES) {
            const struct bundle *c = &p->bundle[i];
            const vd r[3] = { vload(c->r[0] + k), vload(c->r[1] + k), vload(c->r[2] + k) };
            body_push(p->body, c, k, r);
        }
    }
}

static void push(struct problem *p, int me, int threads)
{
    walk(p, me, threads, push_group, NULL);
}

/* ---- the error ---- */

/* u~ by the motion that r makes: from the bodies, or W r + q */
ALWAYS_INLINE void motion(const struct problem *p, const struct bundle *c, int k, vd u[3])
{
    if (!p->W) {
        body_velocity(p->body, c, bundle_rebound(p, c), k, u);
        return;
    }
    struct local l = { 0 };
    vd W[9], r[3];
    for (int i = 0; i < 9; i++) W[i] = vload(c->W[i] + k);
    for (int i = 0; i < 3; i++) r[i] = vload(c->r[i] + k);
    l.W = W;
    blocks_gather(p, c, k, l.b);
    local_velocity(&l, r, u);
}

static void velocities(struct problem *p, int64_t first, int64_t end)
{
    for (int64_t i = first; i < end; i++)
        for (int k = 0; k < BUNDLE; k += LANES) {
            vd u[3];
            motion(p, &p->bundle[i], k, u);
            for (int j = 0; j < 3; j++) vstore(p->u[i][j] + k, u[j]);
        }
}

ALWAYS_INLINE vd distance(const vd a[3], const vd b[3])
{
    vd d[3] = { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
    return norm3(d);
}

ALWAYS_INLINE void add_terms(struct sums *s, const struct bundle *c, double (*belief)[BUNDLE],
                             int k, bool believes, const vd moves[3])
{
    vd mu = vload(c->mu + k), r[3], u[3], proj[3];
    for (int i = 0; i < 3; i++)
        r[i] = vload(c->r[i] + k), u[i] = believes ? vload(belief[i] + k) : moves[i];
    cone_project(mu, r, proj);
    if (believes) add(s->motion + k, distance(u, moves));
    add(s->proj + k, distance(r, proj));
    add(s->bipotential + k, absolute(dot3(u, r) + mu * r[0] * norm2(u + 1)));
    add(s->penetration + k, larger(-u[0], splat(0)));
    raise(s->max_pen + k, -u[0]), raise(s->max_true + k, -moves[0]);
}

/* |r - P(r - rho u^)|^2, u^ = u + mu |u_t| n */
ALWAYS_INLINE vd natural2(vd mu, const vd r[3], vd rho, const vd u[3])
{
    vd tau[3] = { r[0] - rho * (u[0] + mu * norm2(u + 1)), r[1] - rho * u[1], r[2] - rho * u[2] };
    vd proj[3];
    cone_project(mu, tau, proj);
    vd d = distance(r, proj);
    return d * d;
}

ALWAYS_INLINE void add_natural(struct sums *s, const struct bundle *c, int k, const vd u[3])
{
    vd lambda = bundle_lambda(c, k), mu = vload(c->mu + k), r[3];
    vd rho = pick(lt(splat(0), lambda), 1.0 / lambda, splat(1));
    for (int i = 0; i < 3; i++) r[i] = vload(c->r[i] + k);
    vd n2 = natural2(mu, r, rho, u);
    add(s->natural2 + k, n2);
    add(s->velocity2 + k, n2 / (rho * rho));
    add(s->siconos2 + k, natural2(mu, r, splat(1), u));
    add(s->r2 + k, dot3(r, r));
}

static void judge(const struct problem *p, int64_t first, int64_t end, bool believes,
                  enum err_terms part, struct sums *s)
{
    for (int64_t i = first; i < end; i++) {
        fetch_ahead(p, i);
        for (int k = 0; k < BUNDLE; k += LANES) {
            vd u[3];
            motion(p, &p->bundle[i], k, u);
            if (part & ERR_TERMS) add_terms(s, &p->bundle[i], p->u[i], k, believes, u);
            if (part & ERR_NATURAL) add_natural(s, &p->bundle[i], k, u);
        }
    }
}

/* ---- the table ---- */

#define VISITS(name)    sweep_##name,
#define SWEEP_(lanes)   sweep_##lanes
#define SWEEP_OF(lanes) SWEEP_(lanes)
extern const struct sweep SWEEP_OF(LANES);
const struct sweep SWEEP_OF(LANES) = { LANES, { EACH_METHOD(VISITS) }, judge, velocities, push };
