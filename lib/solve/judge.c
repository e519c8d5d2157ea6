/* solve/judge.c: velocities and errors [solve/judge.h]. Compiled with LANES = 2, 4, 8. */
#include "solve/judge.h"

#include "solve/walk.h"

/* Sum and maximum of LANES partial results, in place */
ALWAYS_INLINE void add_to(double *slot, vd a)
{
    vstore(slot, vload(slot) + a);
}

ALWAYS_INLINE void raise_to(double *slot, vd a)
{
    vstore(slot, larger(a, vload(slot)));
}

/* u~ of the motion that r makes: from the bodies, or W r + q */
ALWAYS_INLINE void motion_velocity(const struct problem *p, int64_t i, int k, vd u[3])
{
    const struct bundle *c = bundle_at(p, i);
    if (!p->kind.given_by_W) {
        problem_velocity(p, p->body, i, bundle_rebound(p, i), k, u);
        return;
    }
    struct local l = { 0 };
    vd W[9], r[3];
    for (int j = 0; j < 9; j++) W[j] = vload(p->block[i][j] + k);
    for (int j = 0; j < 3; j++) r[j] = vload(c->r[j] + k);
    l.W = W;
    blocks_gather(p, i, k, l.b);
    local_velocity(&l, r, u);
}

static void judge_velocities(struct problem *p, int64_t first, int64_t end)
{
    for (int64_t i = first; i < end; i++)
        for (int k = 0; k < BUNDLE; k += LANES) {
            vd u[3];
            motion_velocity(p, i, k, u);
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

/* off2: the square of the velocity by which contacts miss the law; push2, r2: those of lambda r and r */
ALWAYS_INLINE void add_velocity(struct sums *s, const struct problem *p, int k, vd off2, vd push2,
                                vd r2)
{
    const double *end = p->endless, misses = MISSES * p->unit;
    vd seen2 = pick(lt(splat(p->rounded * p->rounded), push2),
                    larger(off2, ROUNDING_OF_R * ROUNDING_OF_R * push2), off2);
    vm jammed = lt(splat(end[0] * end[0]), push2) & lt(splat(end[1] * end[1]), r2) &
                lt(splat(misses * misses), seen2) & lt(off2, splat(p->wild * p->wild));
    add_to(s->velocity2 + k, off2);
    raise_to(s->max_velocity2 + k, pick(jammed, splat(0), seen2));
    add_to(s->jammed + k, pick(jammed, splat(1), splat(0)));
}

ALWAYS_INLINE void add_natural(struct sums *s, const struct problem *p, int64_t bundle, int k,
                               const vd u[3])
{
    const struct bundle *c = bundle_at(p, bundle);
    vd lambda = bundle_lambda(p, bundle, k), mu = vload(c->mu + k), r[3];
    vd rho = pick(lt(splat(0), lambda), 1.0 / lambda, splat(1));
    for (int i = 0; i < 3; i++) r[i] = vload(c->r[i] + k);
    vd n2 = natural2(mu, r, rho, u);
    add_to(s->natural2 + k, n2);
    vd r2 = dot3(r, r);
    add_velocity(s, p, k, n2 / (rho * rho), r2 / (rho * rho), r2);
    add_to(s->siconos2 + k, natural2(mu, r, splat(1), u));
    add_to(s->r2 + k, r2);
}

/* What an inconsistent pull of the bond means: e = p + a + K u~, of which s e, or S^T e, would be taken back */
ALWAYS_INLINE void add_bonds(struct sums *s, const struct problem *p, int64_t bundle, int k,
                             enum err_terms which, const vd u[3])
{
    const struct extra *x = &p->extra[bundle];
    const struct extra_levers *y = p->turn ? &p->turn[bundle] : NULL;
    vd lambda = bundle_lambda(p, bundle, k), off[3], pull[3], e[3];
    for (int i = 0; i < 3; i++) {
        vd z = vload(x->z[i] + k);
        pull[i] = z - vload(x->a[i] + k);
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
    add_to(s->natural2 + k, n2), add_velocity(s, p, k, n2 * lambda * lambda, splat(0), splat(0));
    add_to(s->siconos2 + k, n2), add_to(s->r2 + k, dot3(pull, pull));
}

/* The sums of lane k, whose contact has rolling friction, in place of those without it */
static void judge_rolling(struct sums *s, const struct problem *p, int64_t i, int k,
                          const double u[3])
{
    const struct rebound *e = bundle_rebound(p, i);
    const double scale[2] = { e ? e->s[0][k] : 1, e ? e->s[1][k] : 1 };
    double v[ROLLING], on[ROLLING], far = 0, r2 = 0;
    struct rolling q;
    const struct extra_lane at = slot_extra(p, i * BUNDLE + k);
    extra_rolling(&at, (const double[2]){ p->w[i][0][k], p->w[i][1][k] }, scale, u, &q, v);
    rolling_project(&q, q.x, on);
    for (int j = 0; j < ROLLING; j++)
        far += (q.x[j] - on[j]) * (q.x[j] - on[j]), r2 += q.x[j] * q.x[j];
    double lambda = rolling_lambda(&q), n2 = rolling_natural2(&q, 1 / lambda, q.x, v);
    s->proj[k] = sqrt(far), s->bipotential[k] = fabs(rolling_bipotential(&q, q.x, v));
    s->natural2[k] = n2, s->r2[k] = r2;
    s->velocity2[k] = s->max_velocity2[k] = n2 * lambda * lambda;
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
        motion_velocity(p, i, k, u);
        add_terms(&one, bundle_at(p, i), p->u[i], k, believes, u);
        add_natural(&one, p, i, k, u);
        for (int j = 0; j < 3; j++) vstore(lane[j], u[j]);
        for (int j = 0; j < LANES; j++) {
            const double v[3] = { lane[0][j], lane[1][j], lane[2][j] };
            if (extra_rolls(&p->extra[i], k + j)) judge_rolling(&one, p, i, k + j, v);
        }
        add_bonds(&one, p, i, k, ERR_ALL, u);
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
            s->jammed[k] += one.jammed[k];
            if (one.max_velocity2[k] > s->max_velocity2[k])
                s->max_velocity2[k] = one.max_velocity2[k];
        }
    }
}

static void judge_all(const struct problem *p, int64_t first, int64_t end, bool believes,
                      enum err_terms which, struct sums *s)
{
    for (int64_t i = first; i < end; i++) {
        fetch_ahead(p, i);
        if (p->kind.rolls) {
            judge_moments(p, i, believes, which, s);
            continue;
        }
        for (int k = 0; k < BUNDLE; k += LANES) {
            vd u[3];
            motion_velocity(p, i, k, u);
            if (which & ERR_TERMS) add_terms(s, bundle_at(p, i), p->u[i], k, believes, u);
            if (which & ERR_NATURAL) add_natural(s, p, i, k, u);
            if (p->kind.extra) add_bonds(s, p, i, k, which, u);
        }
    }
}

#define JUDGE_(lanes)   judge_##lanes
#define JUDGE_OF(lanes) JUDGE_(lanes)
extern const struct judge JUDGE_OF(LANES);
const struct judge JUDGE_OF(LANES) = { judge_all, judge_velocities };
