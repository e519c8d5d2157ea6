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

/* What an inconsistent pull of the bond means: e = p + a + K u~, of which s e, or S^T e, would be taken back */
ALWAYS_INLINE void add_bonds(struct sums *s, const struct bundle *c, const struct beyond *x,
                             const struct beyond_levers *y, int k, enum err_terms which,
                             const vd u[3])
{
    vd lambda = bundle_lambda(c, k), off[3], p[3], e[3];
    for (int i = 0; i < 3; i++) {
        vd z = vload(x->z[i] + k);
        p[i] = z - vload(x->a[i] + k);
        e[i] = z + vload(x->K[i > 0] + k) * u[i];
        off[i] = vload(x->s[i > 0] + k) * e[i];
    }
    for (int i = 0; i < 3 && y; i++) {
        off[i] = splat(0);
        for (int j = 0; j < 3; j++) off[i] += vload(y->S[3 * j + i] + k) * e[j];
    }
    vd n2 = dot3(off, off);
    if (which & ERR_TERMS) add_to(s->motion + k, lambda * norm3(off));
    if (!(which & ERR_NATURAL)) return;
    add_to(s->natural2 + k, n2), add_to(s->velocity2 + k, n2 * lambda * lambda);
    add_to(s->siconos2 + k, n2), add_to(s->r2 + k, dot3(p, p));
}

/* The sums of lane k, whose contact has rolling friction, in place of those without it */
static void judge_rolling(struct sums *s, const struct problem *p, int64_t i, int k,
                          const double u[3])
{
    const struct bundle *c = &p->bundle[i];
    const struct rebound *e = bundle_rebound(p, c);
    const double scale[2] = { e ? e->s[0][k] : 1, e ? e->s[1][k] : 1 };
    double v[ROLLING], on[ROLLING], far = 0, r2 = 0;
    struct rolling q;
    const struct beyond_levers *y = p->turn ? &p->turn[i] : NULL;
    beyond_rolling(c, &p->beyond[i], y, p->body, k, scale, u, &q, v);
    rolling_project(&q, q.x, on);
    for (int j = 0; j < ROLLING; j++)
        far += (q.x[j] - on[j]) * (q.x[j] - on[j]), r2 += q.x[j] * q.x[j];
    double lambda = rolling_lambda(&q), n2 = rolling_natural2(&q, 1 / lambda, q.x, v);
    s->proj[k] = sqrt(far), s->bipotential[k] = fabs(rolling_bipotential(&q, q.x, v));
    s->natural2[k] = n2, s->velocity2[k] = n2 * lambda * lambda, s->r2[k] = r2;
    s->siconos2[k] = rolling_natural2(&q, 1, q.x, v);
}

/* judge() of a bundle with rolling friction: its sums apart, so that lanes can be replaced */
static void judge_moments(const struct problem *p, int64_t i, bool believes, enum err_terms which,
                          struct sums *s)
{
    struct sums one = { 0 };
    for (int k = 0; k < BUNDLE; k += LANES) {
        vd u[3];
        double lane[3][LANES];
        motion_velocity(p, &p->bundle[i], k, u);
        add_terms(&one, &p->bundle[i], p->u[i], k, believes, u);
        add_natural(&one, &p->bundle[i], k, u);
        for (int j = 0; j < 3; j++) vstore(lane[j], u[j]);
        for (int j = 0; j < LANES; j++) {
            const double v[3] = { lane[0][j], lane[1][j], lane[2][j] };
            if (beyond_rolls(&p->beyond[i], k + j)) judge_rolling(&one, p, i, k + j, v);
        }
        add_bonds(&one, &p->bundle[i], &p->beyond[i], p->turn ? &p->turn[i] : NULL, k, ERR_ALL, u);
    }
    for (int k = 0; k < BUNDLE; k++) {
        if (which & ERR_TERMS) {
            s->motion[k] += one.motion[k], s->proj[k] += one.proj[k];
            s->bipotential[k] += one.bipotential[k], s->penetration[k] += one.penetration[k];
            s->max_pen[k] = one.max_pen[k] > s->max_pen[k] ? one.max_pen[k] : s->max_pen[k];
            s->max_true[k] = one.max_true[k] > s->max_true[k] ? one.max_true[k] : s->max_true[k];
        }
        if (which & ERR_NATURAL) {
            s->natural2[k] += one.natural2[k], s->siconos2[k] += one.siconos2[k];
            s->velocity2[k] += one.velocity2[k], s->r2[k] += one.r2[k];
        }
    }
}

static void judge(const struct problem *p, int64_t first, int64_t end, bool believes,
                  enum err_terms which, struct sums *s)
{
    for (int64_t i = first; i < end; i++) {
        fetch_ahead(p, i);
        if (p->rolls) {
            judge_moments(p, i, believes, which, s);
            continue;
        }
        for (int k = 0; k < BUNDLE; k += LANES) {
            vd u[3];
            motion_velocity(p, &p->bundle[i], k, u);
            if (which & ERR_TERMS) add_terms(s, &p->bundle[i], p->u[i], k, believes, u);
            if (which & ERR_NATURAL) add_natural(s, &p->bundle[i], k, u);
            const struct beyond_levers *y = p->turn ? &p->turn[i] : NULL;
            if (p->beyond) add_bonds(s, &p->bundle[i], &p->beyond[i], y, k, which, u);
        }
    }
}

/* ---- the table ---- */

#define ENTRY_OF(name)  sweep_##name,
#define SWEEP_(lanes)   sweep_##lanes
#define SWEEP_OF(lanes) SWEEP_(lanes)
extern const struct sweep SWEEP_OF(LANES);
const struct sweep SWEEP_OF(LANES) = { LANES, { EACH_METHOD(ENTRY_OF) }, judge, velocities, push };
