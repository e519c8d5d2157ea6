/* solve/sweep.c: the sweep [solve/sweep.h]. Compiled with LANES = 2, 4, 8. */
#include "solve/sweep.h"

#define METHOD_CODE
#include "solve/method.h"
#include "solve/walk.h"

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
struct sweep_counts {
    vd change, newton, safeguarded, gave_up;
};

/* A kernel: a method and a kind of problem, both constants */
struct kernel {
    enum method_id method;
    method_text *solve;
    const struct problem_kind *kind;
};
#define IS(kernel, what) ((kernel).kind->what)
#define FAR(kernel)      (!IS(kernel, near) && !IS(kernel, given_by_W)) /* t1 and w are computed */

/* bundle_at(), with the kind a constant */
ALWAYS_INLINE struct bundle *bundle_of(const struct problem *p, int64_t i,
                                       const struct kernel kernel)
{
    if (!IS(kernel, near)) return &p->bundle[i];
    return &((struct near_bundle *)p->bundle)[i].bundle;
}

ALWAYS_INLINE const struct beside *beside_of(const struct bundle *c)
{
    return &((const struct near_bundle *)c)->beside;
}

/* What is loaded of LANES slots before they are solved */
struct loaded {
    struct bodies a, b;
    vd t1[3], t2[3]; /* of the bases */
    vd v[3];         /* m/s: u~ with the present r; given by W: b_c */
};

ALWAYS_INLINE void load_slots(const struct problem *p, int64_t bundle, int k,
                              const struct kernel kernel, struct loaded *s)
{
    const struct bundle *c = bundle_of(p, bundle, kernel);
    if (IS(kernel, given_by_W)) {
        blocks_gather(p, bundle, k, s->v);
        return;
    }
    struct twist a, b;
    vd t1[3];
    const struct beside *t = IS(kernel, near) ? beside_of(c) : NULL;
    const struct rebound *e = bundle_rebound(p, bundle);
    bodies_load(&s->a, p->body, c->a + k, &a), bodies_load(&s->b, p->body, c->b + k, &b);
    if (IS(kernel, levers))
        levers_velocity(c, t, &p->lever[bundle], e, k, &a, &b, s->v, t1, s->t2);
    else
        bundle_velocity(c, t, e, k, &a, &b, s->v, t1, s->t2);
    if (p->kind.soft) problem_soften(c, e, k, s->v);
    for (int i = 0; i < 3 && !IS(kernel, near); i++)
        s->t1[i] = t1[i]; // what can be loaded is not kept
}

/* w of lanes k.. between balls, of nothing that is loaded for it: to the bit what stands in p->w */
ALWAYS_INLINE void weigh(const struct problem *p, int64_t bundle, const struct bundle *c, int k,
                         const struct loaded *s, vd w[3])
{
    const struct rebound *e = bundle_rebound(p, bundle);
    vd la = vload(c->la + k), lb = vload(c->lb + k), im = s->a.im + s->b.im;
    vd it = im + la * la * s->a.ii + lb * lb * s->b.ii;
    w[0] = e ? vload(e->s[0] + k) * im : im;
    w[1] = w[2] = e ? vload(e->s[1] + k) * it : it;
    if (!p->kind.soft || !e) return;
    w[0] += vload(e->soft[0] + k);
    w[1] = w[2] = w[1] + vload(e->soft[1] + k);
}

/* The local problems of LANES slots; l->W points to W[9]. exact has no use for rho. */
ALWAYS_INLINE void make_local(const struct problem *p, int64_t bundle, int k,
                              const struct kernel kernel, const struct loaded *s, vd W[9],
                              struct local *l)
{
    const struct bundle *c = bundle_of(p, bundle, kernel);
    l->d = p->d, l->W = IS(kernel, full) ? W : NULL;
    l->mu = vload(c->mu + k);
    l->rho = kernel.method == METHOD_exact ? splat(1) : vload(p->rho[bundle] + k);
    for (int i = 0; i < 9 && IS(kernel, full); i++) W[i] = vload(p->block[bundle][i] + k);
    for (int i = 0; i < 3; i++) l->r[i] = vload(c->r[i] + k), l->v[i] = s->v[i];
    if (FAR(kernel)) weigh(p, bundle, c, k, s, l->w);
    for (int i = 0; i < 3; i++) {
        if (IS(kernel, full)) l->w[i] = W[4 * i];
        if (IS(kernel, given_by_W) && !IS(kernel, full)) l->w[i] = vload(p->w[bundle][i > 0] + k);
        if (IS(kernel, near) && !IS(kernel, full)) l->w[i] = vload(beside_of(c)->w[i > 0] + k);
        l->iw[i] = IS(kernel, full) ? splat(0) : vload(c->iw[i > 0] + k);
        l->b[i] =
            IS(kernel, given_by_W) || IS(kernel, full) ? s->v[i] : l->v[i] - l->w[i] * l->r[i];
    }
    for (int i = 0; i < 3 && IS(kernel, levers); i++) l->b[i] -= dot3(W + 3 * i, l->r);
    if (IS(kernel, given_by_W)) local_velocity(l, l->r, l->v);
}

/*
 * The local problem of a bonded contact [solve/extra.h]: W^ stands in the bundle already. What is
 * not bonded keeps its bits.
 */
ALWAYS_INLINE void bond_local(const struct extra *x, const struct extra_levers *y, int k,
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
ALWAYS_INLINE void bond_follow(struct extra *x, int k, const struct local *l, vd dr[3])
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
ALWAYS_INLINE void roll_lanes(struct problem *p, int64_t bundle, int k, enum method_id method,
                              const struct sweep_opt *o, const vd before[3], struct local *l,
                              double dm[LANES][3])
{
    const struct rebound *e = bundle_rebound(p, bundle);
    const struct bundle *c = bundle_at(p, bundle);
    int64_t slot = bundle * BUNDLE + k;
    double b[3][LANES], r[3][LANES], w[3][LANES], u[3][LANES];
    double steps[LANES], safe[LANES], gave[LANES];
    for (int j = 0; j < 3; j++) vstore(b[j], l->b[j]), vstore(r[j], l->r[j]), vstore(w[j], l->w[j]);
    for (int j = 0; j < 3 && p->turn; j++) vstore(u[j], before[j]);
    vstore(steps, l->steps), vstore(safe, pick(l->safeguarded, splat(1), splat(0)));
    vstore(gave, pick(l->gave_up, splat(1), splat(0)));
    for (int i = 0; i < LANES; i++) {
        const struct extra_lane at = slot_extra(p, slot + i);
        if (!extra_rolls(at.x, at.i)) continue;
        struct rolling_lane one = { .relax = o->relax, .w = { w[0][i], w[1][i] } };
        for (int j = 0; j < 3; j++) one.b[j] = b[j][i], one.r[j] = c->r[j][k + i];
        for (int j = 0; j < 3 && p->turn; j++) one.u[j] = u[j][i];
        for (int j = 0; j < 2; j++) one.s[j] = e ? e->s[j][k + i] : 1;
        extra_roll(&at, method, &o->local, &one);
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
ALWAYS_INLINE void solve_relaxed(struct local *l, const struct bundle *c, int k,
                                 const struct kernel kernel, const struct sweep_opt *o)
{
    bool within = kernel.method == METHOD_exact && !IS(kernel, full);
    l->relax = within ? o->relax : 1;
    kernel.solve(l, &o->local);
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
                                  const struct local *l, vd dr[3], struct sweep_counts *t)
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
ALWAYS_INLINE void pass_on(struct problem *p, int64_t bundle, int k, const struct kernel kernel,
                           const struct loaded *s, const vd dr[3])
{
    const struct bundle *c = bundle_of(p, bundle, kernel);
    vd t1[3];
    for (int i = 0; i < 3 && !IS(kernel, given_by_W); i++)
        t1[i] = IS(kernel, near) ? vload(beside_of(c)->t1[i] + k) : s->t1[i]; // not kept in between
    if (IS(kernel, given_by_W))
        blocks_scatter(p, c, k);
    else if (IS(kernel, levers))
        levers_push(c, &p->lever[bundle], k, t1, s->t2, dr, p->body, &s->a, &s->b);
    else
        bundle_push(c, k, t1, s->t2, dr, p->body, &s->a, &s->b);
}

/*
 * Solves bundles first .. end-1, of one group. The next slots' bodies are loaded while the roots
 * and quotients of these are being computed, which saves a quarter of the time.
 */
ALWAYS_INLINE void solve_bundles(struct problem *p, int64_t first, int64_t end,
                                 const struct sweep_opt *o, const struct kernel kernel,
                                 struct sweep_counts *t)
{
    if (first == end) return;
#ifdef __clang_analyzer__ // which sees walk() ask for a W
    if (IS(kernel, given_by_W) && (!p->W || p->d > 3)) __builtin_unreachable();
#endif
    struct loaded s[2], *now = &s[0], *next = &s[1];
    load_slots(p, first, 0, kernel, now);
    for (int64_t i = first; i < end; i++) {
        struct bundle *c = bundle_of(p, i, kernel);
        double(*belief)[BUNDLE] = o->keep ? p->u[i] : NULL;
        fetch_ahead(p, i);
        for (int k = 0; k < BUNDLE; k += LANES) {
            struct local l;
            struct extra *x = IS(kernel, extra) ? &p->extra[i] : NULL;
            vd W[9], dr[3];
            double dm[LANES][3];
            make_local(p, i, k, kernel, now, W, &l);
            if (IS(kernel, extra)) bond_local(x, IS(kernel, levers) ? &p->turn[i] : NULL, k, &l);
            solve_relaxed(&l, c, k, kernel, o);
            if (IS(kernel, rolls)) roll_lanes(p, i, k, kernel.method, o, now->v, &l, dm);
            store_solution(c, k, belief, &l, dr, t);
            if (IS(kernel, extra)) bond_follow(x, k, &l, dr);
            if (k + LANES < BUNDLE)
                load_slots(p, i, k + LANES, kernel, next);
            else if (i + 1 < end)
                load_slots(p, i + 1, 0, kernel, next);
            pass_on(p, i, k, kernel, now, dr);
            for (int j = 0; j < LANES && IS(kernel, rolls); j++) {
                const struct extra_lane at = slot_extra(p, i * BUNDLE + k + j);
                if (extra_rolls(at.x, at.i)) extra_push(&at, dm[j]);
            }
            struct loaded *was = now;
            now = next, next = was;
        }
    }
}

/* What solve_group() needs to know */
struct task {
    const struct sweep_opt *o;
    struct kernel kernel;
    struct sweep_counts *count;
};

ALWAYS_INLINE void solve_group(struct problem *p, int64_t first, int64_t end, void *task)
{
    const struct task *t = task;
    struct sweep_counts other = { splat(0), splat(0), splat(0),
                                  splat(0) }; // another process counts them
    bool copies = p->exchange && first < end && exchange_is_copy(p->exchange, first);
    solve_bundles(p, first, end, t->o, t->kernel, copies ? &other : t->count);
}

ALWAYS_INLINE void sweep(struct problem *p, int me, int threads, const struct sweep_opt *o,
                         const struct kernel kernel, struct tally *t)
{
    struct sweep_counts c = { splat(0), splat(0), splat(0), splat(0) };
    struct task task = { o, kernel, &c };
    walk(p, me, threads, solve_group, &task);
    raise_to(t->change, c.change), add_to(t->newton, c.newton);
    add_to(t->safeguarded, c.safeguarded), add_to(t->gave_up, c.gave_up);
}

/*
 * A kernel for each kind of problem and each method, which is inlined. Kinds of three sorts share a kernel that
 * calls its method: those with moments, whose lanes are solved one by one, and the rare W_cc that are all
 * diagonal. A call costs a third of a contact of balls, a kernel seconds to compile.
 */
typedef void shared_kernel(struct problem *p, int me, int threads, const struct sweep_opt *o,
                           enum method_id method, method_text *solve, struct tally *t);

#define DEFINE_SHARED(name, id)                                                                    \
    static void name(struct problem *p, int me, int threads, const struct sweep_opt *o,            \
                     enum method_id method, method_text *solve, struct tally *t)                   \
    {                                                                                              \
        sweep(p, me, threads, o, (struct kernel){ method, solve, &kind_##id }, t);                 \
    }
DEFINE_SHARED(moments, MOMENTS)
DEFINE_SHARED(levers_moments, LEVERS_MOMENTS) // with bonds alone, too: no lane of theirs rolls
DEFINE_SHARED(diagonals, DIAGONALS)

#define DEFINE_KERNEL(method, what, id)                                                            \
    static __attribute__((noinline)) void what##_by_##method(                                      \
        struct problem *p, int me, int threads, const struct sweep_opt *o, struct tally *t)        \
    {                                                                                              \
        sweep(p, me, threads, o, (struct kernel){ METHOD_##method, method##_solve, &kind_##id },   \
              t);                                                                                  \
    }
#define DEFINE_CALL(method, what, solve)                                                           \
    static void what##_by_##method(struct problem *p, int me, int threads,                         \
                                   const struct sweep_opt *o, struct tally *t)                     \
    {                                                                                              \
        what(p, me, threads, o, METHOD_##method, solve, t);                                        \
    }

#define DEFINE_SWEEPS(name, ...)                                                                   \
    DEFINE_KERNEL(name, far_balls, FAR_BALLS)                                                      \
    DEFINE_KERNEL(name, balls, BALLS)                                                              \
    DEFINE_KERNEL(name, bonds, BONDS)                                                              \
    DEFINE_KERNEL(name, levers, LEVERS)                                                            \
    DEFINE_KERNEL(name, blocks, BLOCKS)                                                            \
    static void name##_full(struct local *l, const struct local_opt *o)                            \
    {                                                                                              \
        if (l->W) name##_solve(l, o);                                                              \
    }                                                                                              \
    static void name##_diagonal(struct local *l, const struct local_opt *o)                        \
    {                                                                                              \
        if (!l->W) name##_solve(l, o);                                                             \
    }                                                                                              \
    DEFINE_CALL(name, moments, name##_diagonal)                                                    \
    DEFINE_CALL(name, levers_moments, name##_full)                                                 \
    DEFINE_CALL(name, diagonals, name##_diagonal)
EACH_METHOD(DEFINE_SWEEPS)

#define SWEEPS_OF(name, ...)                                                                       \
    { [KIND_FAR_BALLS] = far_balls_by_##name,                                                      \
      [KIND_BALLS] = balls_by_##name,                                                              \
      [KIND_BONDS] = bonds_by_##name,                                                              \
      [KIND_MOMENTS] = moments_by_##name,                                                          \
      [KIND_LEVERS] = levers_by_##name,                                                            \
      [KIND_LEVERS_BONDS] = levers_moments_by_##name,                                              \
      [KIND_LEVERS_MOMENTS] = levers_moments_by_##name,                                            \
      [KIND_BLOCKS] = blocks_by_##name,                                                            \
      [KIND_DIAGONALS] = diagonals_by_##name },

/* ---- velocities from the reactions ---- */

ALWAYS_INLINE void push_group(struct problem *p, int64_t first, int64_t end, void *task)
{
    (void)task;
    for (int64_t i = first; i < end; i++) {
        fetch_ahead(p, i);
        for (int k = 0; k < BUNDLE; k += LANES) {
            const struct bundle *c = bundle_at(p, i);
            vd r[3] = { vload(c->r[0] + k), vload(c->r[1] + k), vload(c->r[2] + k) };
            for (int j = 0; j < 3 && p->kind.extra; j++)
                r[j] += vload(p->extra[i].z[j] + k) - vload(p->extra[i].a[j] + k);
            problem_push(p, p->body, i, k, r);
        }
        for (int k = 0; k < BUNDLE && p->kind.rolls; k++) {
            const struct extra_lane at = slot_extra(p, i * BUNDLE + k);
            const double m[3] = { at.x->m[0][k], at.x->m[1][k], at.x->m[2][k] };
            if (extra_rolls(at.x, k)) extra_push(&at, m);
        }
    }
}

static void sweep_push(struct problem *p, int me, int threads)
{
    walk(p, me, threads, push_group, NULL);
}

/* ---- the table ---- */

#define SWEEP_(lanes)   sweep_##lanes
#define SWEEP_OF(lanes) SWEEP_(lanes)
extern const struct sweep SWEEP_OF(LANES);
const struct sweep SWEEP_OF(LANES) = { LANES, { EACH_METHOD(SWEEPS_OF) }, sweep_push };
