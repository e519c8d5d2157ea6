/* problem/sweep.c: see problem/sweep.h. Compiled once a width, LANES = 2, 4, 8. */
#include "problem/sweep.h"

#include "law/local_eal.h"
#include "law/local_ebp.h"
#include "law/local_exact.h"
#include "law/local_sal.h"
#include "law/local_sbp.h"

typedef void method_text(struct local *, const struct local_opt *);

/*
 * How many bundles ahead rows and bodies are sent for: as far as the second-level cache, for the first
 * waits for a dozen lines at a time at most; then the bodies all the way.
 */
enum { ROWS_AHEAD = 10, BODIES_AHEAD = 6, BODIES_NEXT = 2 };

/* Of LANES slots */
ALWAYS_INLINE void add(double *slot, vd a)
{
    vstore(slot, vload(slot) + a);
}

ALWAYS_INLINE void raise(double *slot, vd a)
{
    vstore(slot, larger(a, vload(slot)));
}

/* b_c of lanes k.. of a problem that is given by W: from everybody's r as it is now */
ALWAYS_INLINE void blocks_gather(const struct problem *p, const struct bundle *c, int k, vd b[3])
{
    double sum[3][LANES] = { 0 }, one[4];
    int64_t row = (c - p->bundle) * BUNDLE + k;
    for (int i = 0; i < LANES && c->a[k + i] >= 0; i++) {
        delassus_gather(&p->sorted, row + i, p->sorted.q, p->W->r, one);
        for (int j = 0; j < p->d; j++) sum[j][i] = one[j];
    }
    for (int j = 0; j < 3; j++) b[j] = vload(sum[j]);
}

ALWAYS_INLINE void blocks_scatter(struct problem *p, const struct bundle *c, int k)
{
    for (int i = 0; i < LANES; i++)
        for (int j = 0; j < p->d && c->a[k + i] >= 0; j++)
            p->W->r[p->d * c->a[k + i] + j] = c->r[j][k + i];
}

ALWAYS_INLINE const struct rebound *bundle_rebound(const struct problem *p, const struct bundle *c)
{
    return p->rebound ? p->rebound + (c - p->bundle) : NULL;
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

ALWAYS_INLINE void fetch_bodies(const struct problem *p, const struct bundle *c)
{
    for (int k = 0; k < BUNDLE; k++) {
        __builtin_prefetch(body_at(p->body, c->a[k]), 1);
        __builtin_prefetch(body_at(p->body, c->b[k]), 1);
    }
}

ALWAYS_INLINE void bring_bodies_nearer(const struct problem *p, const struct bundle *c)
{
    for (int k = 0; k < BUNDLE; k++) {
        __builtin_prefetch(body_at(p->body, c->a[k]), 0, 2);
        __builtin_prefetch(body_at(p->body, c->b[k]), 0, 2);
    }
}

/* What will be wanted while bundle i is at work */
ALWAYS_INLINE void fetch(const struct problem *p, int64_t i)
{
    if (p->bundles < SWEEP_FAR || i + ROWS_AHEAD >= p->bundles) return;
    const char *rows = (const char *)&p->bundle[i + ROWS_AHEAD];
    for (size_t k = 0; k < sizeof *p->bundle; k += 64) __builtin_prefetch(rows + k, 0, 2);
    if (!p->body) return;
    bring_bodies_nearer(p, &p->bundle[i + BODIES_AHEAD]);
    fetch_bodies(p, &p->bundle[i + BODIES_NEXT]);
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
        fetch(p, i);
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

/* Where the mixing goes, of all contacts at once */
struct jump {
    struct mixing m;
    double leap, gamma[MIXING_DEPTH];
};

/* Disc, not cone: the orthogonal projection on the cone would push contacts apart that slide. */
ALWAYS_INLINE void move_text(struct problem *p, int d, int memory, int64_t first, int64_t end,
                             const struct jump *jump)
{
    double *g = jump->m.dg[jump->m.slot], *from = jump->m.df[jump->m.slot];
    for (int64_t i = first; i < end; i++) {
        fetch(p, i);
        for (int k = 0; k < BUNDLE; k += LANES) {
            struct bundle *c = &p->bundle[i];
            vd x[3] = { splat(0), splat(0), splat(0) }, r[3], dr[3];
            mixing_point(&jump->m, c, d, memory, jump->leap, jump->gamma, i, k, x);
            disc_project(vload(c->mu + k), x, r);
            for (int j = 0; j < 3; j++) {
                vd was = vload(c->r[j] + k);
                int64_t at = (i * d + j) * BUNDLE + k;
                dr[j] = r[j] - was, vstore(c->r[j] + k, r[j]);
                if (j < d) vstore(g + at, was), vstore(from + at, r[j]);
            }
            if (p->W)
                blocks_scatter(p, c, k);
            else
                body_push(p->body, c, k, dr);
        }
    }
}

/* Bundles first .. end-1, of one group */
ALWAYS_INLINE void move(struct problem *p, int64_t first, int64_t end, const struct jump *jump)
{
    if (p->d == 3 && !jump->m.few)
        move_text(p, 3, MIXING_DEPTH, first, end, jump);
    else if (p->d == 3)
        move_text(p, 3, MIXING_DEPTH_MANY, first, end, jump);
    else if (!jump->m.few)
        move_text(p, 2, MIXING_DEPTH, first, end, jump);
    else
        move_text(p, 2, MIXING_DEPTH_MANY, first, end, jump);
}

/* Groups that a thread sweeps: `after` a number that another counts up, counting itself when `done` */
struct leg {
    int64_t first, end;
    _Atomic int64_t *after, *done;
};

/* One thread's legs of a sweep; returns their number. All groups are one leg, but by halves. */
ALWAYS_INLINE int route(const struct problem *p, int me, bool by_halves, struct leg leg[3])
{
    struct two_thread_split *h = p->split;
    if (!by_halves) {
        leg[0] = (struct leg){ 0, p->groups, NULL, NULL };
        return 1;
    }
    if (me == 0) {
        leg[0] = (struct leg){ 0, h->beyond, &h->rims, &h->borders };
        leg[1] = (struct leg){ h->beyond, h->inside, NULL, NULL };
        return 2;
    }
    leg[0] = (struct leg){ h->inside, h->rim, NULL, NULL };
    leg[1] = (struct leg){ h->rim, h->rest, &h->borders, &h->rims };
    leg[2] = (struct leg){ h->rest, p->groups, NULL, NULL };
    return 3;
}

/* Waits until the leg's bodies are ours, and asks for all at once: that takes less than one by one. */
ALWAYS_INLINE void set_out(const struct problem *p, const struct leg *leg, int me)
{
    if (!leg->done) return;
    two_thread_split_wait(leg->after, atomic_load_explicit(leg->done, memory_order_relaxed) + me);
    for (int64_t i = p->group[leg->first]; i < p->group[leg->end]; i++)
        fetch_bodies(p, &p->bundle[i]);
}

/* The count is this thread's alone: no need for an addition that waits for what was stored before. */
ALWAYS_INLINE void arrive(const struct leg *leg)
{
    if (!leg->done) return;
    int64_t n = atomic_load_explicit(leg->done, memory_order_relaxed);
    atomic_store_explicit(leg->done, n + 1, memory_order_release);
}

/* What is done with the contacts of a group: they are moved by a jump, or solved where there is none. */
struct task {
    const struct jump *jump;
    const struct sweep_opt *o;
    method_text *solve;
    bool given_by_W, full;
    struct count *count;
};

/* A thread's part of every group, or its half */
ALWAYS_INLINE void walk(struct problem *p, int me, int threads, const struct task t)
{
    struct leg leg[3];
    bool by_halves = p->split && threads == 2;
    int legs = route(p, me, by_halves, leg), share = by_halves ? 1 : threads,
        mine = by_halves ? 0 : me;
    for (int k = 0; k < legs; k++) {
        set_out(p, &leg[k], me);
        for (int64_t g = leg[k].first; g < leg[k].end; g++) {
            int64_t first = p->group[g], n = p->group[g + 1] - first;
            int64_t from = first + n * mine / share, to = first + n * (mine + 1) / share;
            if (t.jump)
                move(p, from, to, t.jump);
            else
                visit(p, from, to, t.o, t.solve, t.given_by_W, t.full, t.count);
            if (share == 1) continue;
#pragma omp barrier
        }
        arrive(&leg[k]);
    }
}

ALWAYS_INLINE void sweep(struct problem *p, int me, int threads, const struct sweep_opt *o,
                         method_text *solve, bool given_by_W, bool full, struct tally *t)
{
    struct count c = { splat(0), splat(0), splat(0), splat(0) };
    walk(p, me, threads, (struct task){ NULL, o, solve, given_by_W, full, &c });
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

/* ---- what accelerates the sweeps ---- */

static void mixing_measure(const struct problem *p, const struct mixing *m, int64_t first,
                           int64_t end, struct mixing_sums *t)
{
    if (p->d == 3 && !m->few)
        mixing_measure_text(p, *m, 3, MIXING_DEPTH, first, end, t);
    else if (p->d == 3)
        mixing_measure_text(p, *m, 3, MIXING_DEPTH_MANY, first, end, t);
    else if (!m->few)
        mixing_measure_text(p, *m, 2, MIXING_DEPTH, first, end, t);
    else
        mixing_measure_text(p, *m, 2, MIXING_DEPTH_MANY, first, end, t);
}

static void mixing_react(struct problem *p, int me, int threads, const struct mixing *m,
                         double leap, const double gamma[MIXING_DEPTH])
{
    struct jump jump = { *m, leap, { 0 } };
    for (int j = 0; j < MIXING_DEPTH; j++) jump.gamma[j] = gamma[j];
    walk(p, me, threads, (struct task){ .jump = &jump });
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
        fetch(p, i);
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
const struct sweep SWEEP_OF(LANES) = { LANES,      { EACH_METHOD(VISITS) }, judge,
                                       velocities, mixing_measure,          mixing_react };
