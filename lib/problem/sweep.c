/* problem/sweep.c: the sweep, and the errors [problem/sweep.h]. Compiled with LANES = 2, 4, 8. */
#include "problem/sweep.h"

#include "law/local_eal.h"
#include "law/local_ebp.h"
#include "law/local_exact.h"
#include "law/local_sal.h"
#include "law/local_sbp.h"
#include "problem/walk.h"

typedef void method_text(struct local *, const struct local_opt *);

/* Sum and maximum of LANES partial results, in place */
ALWAYS_INLINE void add_to(double *slot, vd a)
{
    vstore(slot, vload(slot) + a);
}

ALWAYS_INLINE void raise_to(double *slot, vd a)
{
    vstore(slot, larger(a, vload(slot)));
}

/* A tally in registers */
struct counts {
    vd change, newton, safeguarded, gave_up;
};

/* What is loaded of LANES slots before they are solved */
struct loaded {
    struct bodies a, b;
    vd t2[3]; /* of the bases */
    vd v[3];  /* m/s: u~ with the present r; given by W: b_c */
};

/* full, but not given by W: with levers */
ALWAYS_INLINE void load_slots(const struct problem *p, const struct bundle *c, int k,
                              bool given_by_W, bool full, struct loaded *s)
{
    if (given_by_W) {
        blocks_gather(p, c, k, s->v);
        return;
    }
    struct twist a, b;
    bodies_load(&s->a, p->body, c->a + k, &a), bodies_load(&s->b, p->body, c->b + k, &b);
    if (full) {
        levers_velocity(&p->lever[c - p->bundle], bundle_rebound(p, c), k, &a, &b, s->v, s->t2);
        return;
    }
    bundle_velocity(c, bundle_rebound(p, c), k, &a, &b, s->v, s->t2);
}

/* The local problems of LANES slots; l->W points to W[9]. */
ALWAYS_INLINE void make_local(const struct problem *p, const struct bundle *c, int k,
                              bool given_by_W, bool full, const struct loaded *s, vd W[9],
                              struct local *l)
{
    l->d = p->d, l->W = full ? W : NULL;
    l->mu = vload(c->mu + k), l->rho = vload(c->rho + k);
    for (int i = 0; i < 9 && full; i++) W[i] = vload(c->W[i] + k);
    for (int i = 0; i < 3; i++) {
        l->w[i] = full ? W[4 * i] : vload(c->w[i > 0] + k);
        l->iw[i] = full ? splat(0) : vload(c->iw[i > 0] + k);
        l->r[i] = vload(c->r[i] + k), l->v[i] = s->v[i];
        l->b[i] = given_by_W || full ? s->v[i] : l->v[i] - l->w[i] * l->r[i];
    }
    for (int i = 0; i < 3 && full && !given_by_W; i++) l->b[i] -= dot3(W + 3 * i, l->r);
    if (given_by_W) local_velocity(l, l->r, l->v);
}

/*
 * The solution, over-relaxed. exact between balls relaxes its own step and projects onto the disc
 * [projected SOR], at no cost; other methods go past their new reaction, and back onto the cone.
 */
ALWAYS_INLINE void solve_relaxed(struct local *l, const struct bundle *c, int k, method_text *solve,
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

/* Stores r, and u where belief is not NULL; dr: the change of r */
ALWAYS_INLINE void store_solution(struct bundle *c, int k, double (*belief)[BUNDLE],
                                  const struct local *l, vd dr[3], struct counts *t)
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

/* Passes the change on to the bodies, or r to W->r. */
ALWAYS_INLINE void pass_on(struct problem *p, const struct bundle *c, int k, bool given_by_W,
                           bool full, const struct loaded *s, const vd dr[3])
{
    if (given_by_W)
        blocks_scatter(p, c, k);
    else if (full)
        levers_push(c, &p->lever[c - p->bundle], k, s->t2, dr, p->body, &s->a, &s->b);
    else
        bundle_push(c, k, s->t2, dr, p->body, &s->a, &s->b);
}

/*
 * Solves bundles first .. end-1, of one group. The next slots' bodies are loaded while the roots
 * and quotients of these are being computed, which saves a quarter of the time.
 */
ALWAYS_INLINE void solve_bundles(struct problem *p, int64_t first, int64_t end,
                                 const struct sweep_opt *o, method_text *solve, bool given_by_W,
                                 bool full, struct counts *t)
{
    if (first == end) return;
    struct loaded s[2], *now = &s[0], *next = &s[1];
    load_slots(p, &p->bundle[first], 0, given_by_W, full, now);
    for (int64_t i = first; i < end; i++) {
        struct bundle *c = &p->bundle[i];
        double(*belief)[BUNDLE] = o->keep ? p->u[i] : NULL;
        fetch_ahead(p, i);
        for (int k = 0; k < BUNDLE; k += LANES) {
            struct local l;
            vd W[9], dr[3];
            make_local(p, c, k, given_by_W, full, now, W, &l);
            solve_relaxed(&l, c, k, solve, full, o);
            store_solution(c, k, belief, &l, dr, t);
            if (k + LANES < BUNDLE)
                load_slots(p, c, k + LANES, given_by_W, full, next);
            else if (i + 1 < end)
                load_slots(p, c + 1, 0, given_by_W, full, next);
            pass_on(p, c, k, given_by_W, full, now, dr);
            struct loaded *was = now;
            now = next, next = was;
        }
    }
}

/* What solve_group() needs to know */
struct task {
    const struct sweep_opt *o;
    method_text *solve;
    bool given_by_W, full;
    struct counts *count;
};

ALWAYS_INLINE void solve_group(struct problem *p, int64_t first, int64_t end, void *task)
{
    const struct task *t = task;
    solve_bundles(p, first, end, t->o, t->solve, t->given_by_W, t->full, t->count);
}

ALWAYS_INLINE void sweep(struct problem *p, int me, int threads, const struct sweep_opt *o,
                         method_text *solve, bool given_by_W, bool full, struct tally *t)
{
    struct counts c = { splat(0), splat(0), splat(0), splat(0) };
    struct task task = { o, solve, given_by_W, full, &c };
    walk(p, me, threads, solve_group, &task);
    raise_to(t->change, c.change), add_to(t->newton, c.newton);
    add_to(t->safeguarded, c.safeguarded), add_to(t->gave_up, c.gave_up);
}

#define DEFINE_SWEEP(name)                                                                         \
    static void sweep_##name(struct problem *p, int me, int threads, const struct sweep_opt *o,    \
                             struct tally *t)                                                      \
    {                                                                                              \
        if (p->lever)                                                                              \
            sweep(p, me, threads, o, name##_solve, false, true, t);                                \
        else if (p->full)                                                                          \
            sweep(p, me, threads, o, name##_solve, true, true, t);                                 \
        else if (p->W)                                                                             \
            sweep(p, me, threads, o, name##_solve, true, false, t);                                \
        else                                                                                       \
            sweep(p, me, threads, o, name##_solve, false, false, t);                               \
    }
EACH_METHOD(DEFINE_SWEEP)

/* ---- velocities from the reactions ---- */

ALWAYS_INLINE void push_group(struct problem *p, int64_t first, int64_t end, void *task)
{
    (void)task;
    for (int64_t i = first; i < end; i++) {
        fetch_ahead(p, i);
        for (int k = 0; k < BUNDLE; k += LANES) {
            const struct bundle *c = &p->bundle[i];
            const vd r[3] = { vload(c->r[0] + k), vload(c->r[1] + k), vload(c->r[2] + k) };
            problem_push(p, p->body, c, k, r);
        }
    }
}

static void push(struct problem *p, int me, int threads)
{
    walk(p, me, threads, push_group, NULL);
}

/* ---- the error ---- */

/* u~ of the motion that r makes: from the bodies, or W r + q */
ALWAYS_INLINE void motion_velocity(const struct problem *p, const struct bundle *c, int k, vd u[3])
{
    if (!p->W) {
        problem_velocity(p, p->body, c, bundle_rebound(p, c), k, u);
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
            motion_velocity(p, &p->bundle[i], k, u);
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
    if (believes) add_to(s->motion + k, distance(u, moves));
    add_to(s->proj + k, distance(r, proj));
    add_to(s->bipotential + k, absolute(dot3(u, r) + mu * r[0] * norm2(u + 1)));
    add_to(s->penetration + k, larger(-u[0], splat(0)));
    raise_to(s->max_pen + k, -u[0]), raise_to(s->max_true + k, -moves[0]);
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
    add_to(s->natural2 + k, n2);
    add_to(s->velocity2 + k, n2 / (rho * rho));
    add_to(s->siconos2 + k, natural2(mu, r, splat(1), u));
    add_to(s->r2 + k, dot3(r, r));
}

static void judge(const struct problem *p, int64_t first, int64_t end, bool believes,
                  enum err_terms which, struct sums *s)
{
    for (int64_t i = first; i < end; i++) {
        fetch_ahead(p, i);
        for (int k = 0; k < BUNDLE; k += LANES) {
            vd u[3];
            motion_velocity(p, &p->bundle[i], k, u);
            if (which & ERR_TERMS) add_terms(s, &p->bundle[i], p->u[i], k, believes, u);
            if (which & ERR_NATURAL) add_natural(s, &p->bundle[i], k, u);
        }
    }
}

/* ---- the table ---- */

#define ENTRY_OF(name)  sweep_##name,
#define SWEEP_(lanes)   sweep_##lanes
#define SWEEP_OF(lanes) SWEEP_(lanes)
extern const struct sweep SWEEP_OF(LANES);
const struct sweep SWEEP_OF(LANES) = { LANES, { EACH_METHOD(ENTRY_OF) }, judge, velocities, push };
