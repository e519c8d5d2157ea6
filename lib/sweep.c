/* sweep.c: see sweep.h. Compiled once a width, LANES = 2, 4, 8. */
#include "sweep.h"

#include "local_eal.h"
#include "local_ebp.h"
#include "local_exact.h"
#include "local_sal.h"
#include "local_sbp.h"

typedef void method_text(struct local *, const struct local_opt *);

/* b_c of lanes k.. of a problem that is given by W: from everybody's r as it is now */
ALWAYS_INLINE void blocks_gather(const struct problem *p, const struct bundle *c, int k, vd b[3])
{
    double sum[3][LANES], one[3];
    for (int i = 0; i < LANES; i++) {
        one[0] = one[1] = one[2] = 0;
        if (c->a[k + i] >= 0) delassus_gather(p->W, c->a[k + i], one);
        for (int j = 0; j < 3; j++) sum[j][i] = one[j];
    }
    for (int j = 0; j < 3; j++) b[j] = vload(sum[j]);
}

ALWAYS_INLINE void blocks_scatter(struct problem *p, const struct bundle *c, int k)
{
    for (int i = 0; i < LANES; i++)
        for (int j = 0; j < p->d && c->a[k + i] >= 0; j++)
            p->W->r[p->d * c->a[k + i] + j] = c->r[j][k + i];
}

/* Over-relaxation: past the new reaction, and back onto the cone. */
ALWAYS_INLINE void relax(struct local *l, const vd was[3], double omega)
{
    vd tau[3];
    for (int i = 0; i < 3; i++) tau[i] = was[i] + omega * (l->r[i] - was[i]);
    cone_project(l->mu, tau, l->r);
    local_velocity(l, l->r, l->u);
}

/* vectors of a tally, and of what a method finds */
struct count {
    vd change, newton, safeguarded, gave_up;
};

ALWAYS_INLINE void visit(struct problem *p, struct bundle *c, int k, const struct sweep_opt *o,
                         method_text *solve, bool given_by_W, struct count *t)
{
    struct bodies a, b;
    struct local l = { .d = p->d, .mu = vload(c->mu + k), .rho = vload(c->rho + k) };
    vd W[9], dr[3], was[3];
    for (int i = 0; i < 3; i++) was[i] = l.r[i] = vload(c->r[i] + k);
    if (given_by_W) {
        for (int i = 0; i < 9; i++) W[i] = vload(c->W[i] + k);
        for (int i = 0; i < 3; i++) l.w[i] = W[4 * i];
        l.W = W;
        blocks_gather(p, c, k, l.b);
    } else {
        l.W = NULL, l.w[0] = vload(c->w[0] + k), l.w[1] = l.w[2] = vload(c->w[1] + k);
        bodies_load(&a, p->body, c->a + k), bodies_load(&b, p->body, c->b + k);
        bundle_velocity(c, k, &a, &b, l.b);
        for (int i = 0; i < 3; i++) l.b[i] -= l.w[i] * was[i];
    }
    solve(&l, &o->local);
    if (o->relax != 1) relax(&l, was, o->relax);
    for (int i = 0; i < 3; i++) {
        dr[i] = l.r[i] - was[i];
        vstore(c->r[i] + k, l.r[i]), vstore(c->u[i] + k, l.u[i]);
    }
    if (given_by_W) {
        blocks_scatter(p, c, k);
    } else {
        bundle_push(c, k, dr, &a, &b);
        bodies_store(&a, p->body, c->a + k), bodies_store(&b, p->body, c->b + k);
    }
    t->change = larger(absolute(dr[0]) * l.w[0], t->change);
    vm here = lt(splat(0), l.rho);
    t->newton += pick(here, l.steps, splat(0));
    t->safeguarded += pick(l.safeguarded, splat(1), splat(0));
    t->gave_up += pick(l.gave_up, splat(1), splat(0));
}

/* One after the other in these bundles, the lanes to fold at the end */
ALWAYS_INLINE void visit_all(struct problem *p, int64_t first, int64_t end,
                             const struct sweep_opt *o, method_text *solve, bool given_by_W,
                             struct tally *tally)
{
    struct count t = { splat(0), splat(0), splat(0), splat(0) };
    for (int64_t i = first; i < end; i++)
        for (int k = 0; k < BUNDLE; k += LANES)
            visit(p, &p->bundle[i], k, o, solve, given_by_W, &t);
    double x[4][LANES];
    vstore(x[0], t.change), vstore(x[1], t.newton), vstore(x[2], t.safeguarded),
        vstore(x[3], t.gave_up);
    for (int i = 0; i < LANES; i++) {
        tally->change = tally->change > x[0][i] ? tally->change : x[0][i];
        tally->newton += x[1][i], tally->safeguarded += x[2][i], tally->gave_up += x[3][i];
    }
}

#define VISIT(name)                                                                                \
    static void visit_##name(struct problem *p, int64_t first, int64_t end,                        \
                             const struct sweep_opt *o, struct tally *t)                           \
    {                                                                                              \
        if (p->W)                                                                                  \
            visit_all(p, first, end, o, name##_solve, true, t);                                    \
        else                                                                                       \
            visit_all(p, first, end, o, name##_solve, false, t);                                   \
    }
EACH_METHOD(VISIT)

/* ---- the error ---- */

/* u~ by the motion that r makes: from the bodies, or W r + q */
ALWAYS_INLINE void motion(const struct problem *p, const struct bundle *c, int k, vd u[3])
{
    if (!p->W) {
        body_velocity(p->body, c, k, u);
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
            for (int j = 0; j < 3; j++) vstore(p->bundle[i].u[j] + k, u[j]);
        }
}

ALWAYS_INLINE void add(double *slot, vd a)
{
    vstore(slot, vload(slot) + a);
}

ALWAYS_INLINE void raise(double *slot, vd a)
{
    vstore(slot, larger(a, vload(slot)));
}

ALWAYS_INLINE vd distance(const vd a[3], const vd b[3])
{
    vd d[3] = { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
    return norm3(d);
}

ALWAYS_INLINE void add_terms(struct sums *s, const struct bundle *c, int k, bool believes,
                             const vd moves[3])
{
    vd mu = vload(c->mu + k), r[3], u[3], proj[3];
    for (int i = 0; i < 3; i++)
        r[i] = vload(c->r[i] + k), u[i] = believes ? vload(c->u[i] + k) : moves[i];
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
                  enum err_part part, struct sums *s)
{
    for (int64_t i = first; i < end; i++)
        for (int k = 0; k < BUNDLE; k += LANES) {
            vd u[3];
            motion(p, &p->bundle[i], k, u);
            if (part & ERR_TERMS) add_terms(s, &p->bundle[i], k, believes, u);
            if (part & ERR_NATURAL) add_natural(s, &p->bundle[i], k, u);
        }
}

/* ---- the table ---- */

#define VISITS(name)    visit_##name,
#define SWEEP_(lanes)   sweep_##lanes
#define SWEEP_OF(lanes) SWEEP_(lanes)
extern const struct sweep SWEEP_OF(LANES);
const struct sweep SWEEP_OF(LANES) = { LANES, { EACH_METHOD(VISITS) }, judge, velocities };
