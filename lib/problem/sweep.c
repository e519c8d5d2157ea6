/* problem/sweep.c: the sweep [problem/sweep.h]. Compiled with LANES = 2, 4, 8. */
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

/* What contacts have beyond their bundles: each a text of its own, so that none pays for another */
enum beyond_what { NOTHING, BONDS, MOMENTS };

/*
 * The local problem of a bonded contact [problem/beyond.h]: W^ stands in the bundle already. What is
 * not bonded keeps its bits.
 */
ALWAYS_INLINE void bond_local(const struct beyond *x, const struct beyond_levers *y, int k,
                              struct local *l)
{
    if (y) {
        vd felt[3], b[3];
        for (int i = 0; i < 3; i++) felt[i] = l->r[i] + vload(x->z[i] + k);
        for (int i = 0; i < 3; i++) {
            b[i] = -dot3(l->W + 3 * i, felt);
            for (int j = 0; j < 3; j++) b[i] += vload(y->S[3 * i + j] + k) * l->v[j];
        }
        vm held = lt(splat(0), vload(x->K[0] + k) + vload(x->K[1] + k));
        for (int i = 0; i < 3; i++) l->b[i] = pick(held, b[i], l->b[i]);
        for (int i = 0; i < 3; i++)
            l->v[i] = pick(held, dot3(l->W + 3 * i, l->r) + l->b[i], l->v[i]);
        return;
    }
    for (int i = 0; i < 3; i++) {
        vd s = vload(x->s[i > 0] + k), felt = l->r[i] + vload(x->z[i] + k);
        l->b[i] = s * l->v[i] - l->w[i] * felt;
        l->v[i] = pick(lt(s, splat(1)), l->w[i] * l->r[i] + l->b[i], l->v[i]);
    }
}

/* dr = the change of what the bond pulls, with u~ = W^ r* + b^ */
ALWAYS_INLINE void bond_follow(struct beyond *x, int k, const struct local *l, vd dr[3])
{
    vd u[3];
    local_velocity(l, l->r, u);
    for (int i = 0; i < 3; i++) {
        vd z = -vload(x->K[i > 0] + k) * u[i];
        dr[i] += z - vload(x->z[i] + k);
        vstore(x->z[i] + k, z);
    }
}

/* The lanes with rolling friction, anew; before: their u~ of the last sweep; dm: the changes of their moments */
ALWAYS_INLINE void roll_lanes(struct problem *p, const struct bundle *c, struct beyond *x,
                              const struct beyond_levers *y, int k, enum method_id method,
                              const struct sweep_opt *o, const vd before[3], struct local *l,
                              double dm[LANES][3])
{
    const struct rebound *e = bundle_rebound(p, c);
    double b[3][LANES], r[3][LANES], w[3][LANES], u[3][LANES];
    double steps[LANES], safe[LANES], gave[LANES];
    for (int j = 0; j < 3; j++) vstore(b[j], l->b[j]), vstore(r[j], l->r[j]), vstore(w[j], l->w[j]);
    for (int j = 0; j < 3 && y; j++) vstore(u[j], before[j]);
    vstore(steps, l->steps), vstore(safe, pick(l->safeguarded, splat(1), splat(0)));
    vstore(gave, pick(l->gave_up, splat(1), splat(0)));
    for (int i = 0; i < LANES; i++) {
        if (!beyond_rolls(x, k + i)) continue;
        struct rolling_lane one = { .relax = o->relax, .w = { w[0][i], w[1][i] } };
        for (int j = 0; j < 3; j++) one.b[j] = b[j][i], one.r[j] = c->r[j][k + i];
        for (int j = 0; j < 3 && y; j++) one.u[j] = u[j][i];
        for (int j = 0; j < 2; j++) one.s[j] = e ? e->s[j][k + i] : 1;
        beyond_roll(c, x, y, p->body, k + i, method, &o->local, &one);
        for (int j = 0; j < 3; j++) b[j][i] = one.b[j], r[j][i] = one.r[j], dm[i][j] = one.dm[j];
        steps[i] = one.steps, safe[i] = one.safeguarded, gave[i] = one.gave_up;
    }
    for (int j = 0; j < 3; j++) l->b[j] = vload(b[j]), l->r[j] = vload(r[j]);
    l->steps = vload(steps), l->safeguarded = lt(splat(0), vload(safe));
    l->gave_up = lt(splat(0), vload(gave));
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
                                 const struct sweep_opt *o, enum method_id method,
                                 method_text *solve, bool given_by_W, bool full,
                                 enum beyond_what beyond, struct counts *t)
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
            struct beyond *x = beyond ? &p->beyond[i] : NULL;
            const struct beyond_levers *y = beyond && full ? &p->turn[i] : NULL;
            vd W[9], dr[3];
            double dm[LANES][3];
            make_local(p, c, k, given_by_W, full, now, W, &l);
            if (beyond) bond_local(x, y, k, &l);
            solve_relaxed(&l, c, k, solve, full, o);
            if (beyond == MOMENTS) roll_lanes(p, c, x, y, k, method, o, now->v, &l, dm);
            store_solution(c, k, belief, &l, dr, t);
            if (beyond) bond_follow(x, k, &l, dr);
            if (k + LANES < BUNDLE)
                load_slots(p, c, k + LANES, given_by_W, full, next);
            else if (i + 1 < end)
                load_slots(p, c + 1, 0, given_by_W, full, next);
            pass_on(p, c, k, given_by_W, full, now, dr);
            for (int j = 0; j < LANES && beyond == MOMENTS; j++)
                if (beyond_rolls(x, k + j)) beyond_push(c, x, y, k + j, p->body, dm[j]);
            struct loaded *was = now;
            now = next, next = was;
        }
    }
}

/* What solve_group() needs to know */
struct task {
    const struct sweep_opt *o;
    enum method_id method;
    method_text *solve;
    bool given_by_W, full;
    enum beyond_what beyond;
    struct counts *count;
};

ALWAYS_INLINE void solve_group(struct problem *p, int64_t first, int64_t end, void *task)
{
    const struct task *t = task;
    struct counts other = { splat(0), splat(0), splat(0), splat(0) }; // another process counts them
    bool copies = p->shared && first < end && shared_is_copy(p->shared, first);
    solve_bundles(p, first, end, t->o, t->method, t->solve, t->given_by_W, t->full, t->beyond,
                  copies ? &other : t->count);
}

ALWAYS_INLINE void sweep(struct problem *p, int me, int threads, const struct sweep_opt *o,
                         enum method_id method, method_text *solve, bool given_by_W, bool full,
                         enum beyond_what beyond, struct tally *t)
{
    struct counts c = { splat(0), splat(0), splat(0), splat(0) };
    struct task task = { o, method, solve, given_by_W, full, beyond, &c };
    walk(p, me, threads, solve_group, &task);
    raise_to(t->change, c.change), add_to(t->newton, c.newton);
    add_to(t->safeguarded, c.safeguarded), add_to(t->gave_up, c.gave_up);
}

#define DEFINE_SWEEP(name)                                                                         \
    static void sweep_##name(struct problem *p, int me, int threads, const struct sweep_opt *o,    \
                             struct tally *t)                                                      \
    {                                                                                              \
        if (p->turn)                                                                               \
            sweep(p, me, threads, o, METHOD_##name, name##_solve, false, true, MOMENTS, t);        \
        else if (p->lever)                                                                         \
            sweep(p, me, threads, o, METHOD_##name, name##_solve, false, true, NOTHING, t);        \
        else if (p->full)                                                                          \
            sweep(p, me, threads, o, METHOD_##name, name##_solve, true, true, NOTHING, t);         \
        else if (p->W)                                                                             \
            sweep(p, me, threads, o, METHOD_##name, name##_solve, true, false, NOTHING, t);        \
        else if (p->rolls)                                                                         \
            sweep(p, me, threads, o, METHOD_##name, name##_solve, false, false, MOMENTS, t);       \
        else if (p->beyond)                                                                        \
            sweep(p, me, threads, o, METHOD_##name, name##_solve, false, false, BONDS, t);         \
        else                                                                                       \
            sweep(p, me, threads, o, METHOD_##name, name##_solve, false, false, NOTHING, t);       \
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
            vd r[3] = { vload(c->r[0] + k), vload(c->r[1] + k), vload(c->r[2] + k) };
            for (int j = 0; j < 3 && p->beyond; j++)
                r[j] += vload(p->beyond[i].z[j] + k) - vload(p->beyond[i].a[j] + k);
            problem_push(p, p->body, c, k, r);
        }
        for (int k = 0; k < BUNDLE && p->rolls; k++) {
            const struct beyond *x = &p->beyond[i];
            const double m[3] = { x->m[0][k], x->m[1][k], x->m[2][k] };
            const struct beyond_levers *y = p->turn ? &p->turn[i] : NULL;
            if (beyond_rolls(x, k)) beyond_push(&p->bundle[i], x, y, k, p->body, m);
        }
    }
}

static void push(struct problem *p, int me, int threads)
{
    walk(p, me, threads, push_group, NULL);
}

/* ---- the table ---- */

#define ENTRY_OF(name)  sweep_##name,
#define SWEEP_(lanes)   sweep_##lanes
#define SWEEP_OF(lanes) SWEEP_(lanes)
extern const struct sweep SWEEP_OF(LANES);
const struct sweep SWEEP_OF(LANES) = { LANES, { EACH_METHOD(ENTRY_OF) }, push };
