/* solve/small_sweep.c: the sweep of small steps, compiled once for each vector width [solve/small.h]. */
#include "solve/small_pairs.h"

/* The law in the first sweep of a step; bonds pull by p, and `still` ones do not rebound. l->f is then without p. */
ALWAYS_INLINE void small_begin(const struct small_pairs *y, const struct small *s,
                               struct small_law *l, const vd p[3], vm still)
{
    const struct small_rates *o = &s->rate;
    const int k = y->k;
    struct small_bundle *c = y->c;
    vd sum[3], w[3];
    small_load(sum, c->sum, k);
    for (int j = 0; j < 3; j++) sum[j] += l->f[j], l->f[j] = s->rate.warm * l->f[j];
    for (int j = 0; j < 3 && p; j++) l->f[j] = l->f[j] - p[j];
    vd kept = dot3(l->n, l->f);
    for (int j = 0; j < 3; j++) w[j] = y->ma.w[j] + y->mb.w[j];
    small_store(c->sum, k, sum);
    l->spin = 0.5 * o->h * dot3(w, l->n);
    small_press(l, o);
    vm near =
        le(l->gap, splat(o->reach)) & le(l->wn * kept, splat(SMALL_SLIGHT * o->reach * o->per_h));
    if (any(near)) {
        struct bodies a, b;
        struct twist ma, mb;
        vd before[3];
        bodies_load(&a, s->before, c->a + k, &ma), bodies_load(&b, s->before, c->b + k, &mb);
        small_velocity_image(y, s, &ma, &mb, before);
        vd en = vload(c->e[0] + k), et = vload(c->e[1] + k), zero = splat(0);
        if (p) en = pick(still, zero, en), et = pick(still, zero, et);
        small_meet(l, o, before, &kept, en, et);
    }
    vstore(c->kept + k, kept);
    small_store(c->q, k, l->q);
}

/* u, where bodies have `couple` of the reaction and not that of l->f where they are now */
ALWAYS_INLINE void small_turned(const struct small_pairs *y, struct small_law *l,
                                const vd couple[3])
{
    vd c[3], u[3], most = y->a.ii * y->la * y->sa + y->b.ii * y->lb * y->sb;
    small_cross(l->n, l->f, c);
    for (int j = 0; j < 3; j++) c[j] = y->length * c[j] - couple[j];
    small_cross(c, l->n, u);
    for (int j = 0; j < 3; j++) l->u[j] += most * u[j];
}

/* The change of the moments that the change dc of the couple leaves to be made */
ALWAYS_INLINE void small_turn_pairs(const struct small_pairs *y, const struct small *s,
                                    const struct small_law *l, vm acts, double begins,
                                    const vd dc[3], vd dm[3])
{
    struct small_turn *t = &s->turn[y->i];
    const double warm = begins > 0 ? s->rate.warm : 1;
    vd w[3], m[3], sum[3], most[2], turn = y->b.ii * y->sb - y->a.ii * y->sa;
    for (int j = 0; j < 3; j++) w[j] = y->mb.w[j] - y->ma.w[j] - turn * dc[j];
    small_load(m, t->m, y->k), small_load(sum, t->sum, y->k);
    for (int j = 0; j < 3; j++) sum[j] += begins * m[j], m[j] *= warm;
    small_store(t->sum, y->k, sum);
    for (int j = 0; j < 2; j++) most[j] = vload(t->most[j] + y->k);
    vd had[3] = { m[0], m[1], m[2] };
    small_roll(y->n, l->rn, w, y->a.ii + y->b.ii, most, m, dm);
    for (int j = 0; j < 3; j++)
        m[j] = pick(acts, m[j], had[j]), dm[j] = pick(acts, dm[j], splat(0));
    small_store(t->m, y->k, m);
}

/* A body has changed by x (m/s): marks it where that is more than is allowed, with what has not been followed up. */
static bool small_mark_body(struct small *s, int64_t i, double x, double allowed)
{
    s->change[i] += x;
    if (!(s->change[i] > allowed)) return false;
    s->change[i] = 0, s->hot[i] = s->sweep;
    small_mark_bundles(s, i);
    return true;
}

/* The same of pairs, whose u has changed. Where one body is much heavier less is allowed, for sweeps carry little from one
   to the other. */
ALWAYS_INLINE bool small_mark(const struct small_pairs *y, struct small *s, vd change, bool again)
{
    vd ia = y->a.im, ib = y->b.im, zero = splat(0);
    vd least = pick(lt(ia, ib), ia, ib), most = larger(ia, ib);
    vd allowed = s->rate.allowed[again] * pick(lt(zero, least), root(least / most), splat(1));
    double x[LANES], top[LANES];
    bool far = false;
    if (!again && !any(lt(allowed, change))) return false;
    if (!again) change = change / (1 + vload(y->c->e[0] + y->k));
    vstore(x, change), vstore(top, allowed);
    for (int j = 0; j < LANES; j++) {
        if (!(x[j] > (again ? 0 : top[j]))) continue;
        far |= small_mark_body(s, body_index(y->c->a[y->k + j]), x[j], top[j]);
        far |= small_mark_body(s, body_index(y->c->b[y->k + j]), x[j], top[j]);
    }
    return far;
}

/* Has a body of pair j of the bundle changed in this sweep or the one before? */
ALWAYS_INLINE bool small_is_hot(const struct small *s, const struct small_bundle *c, int j)
{
    const int32_t a = s->hot[body_index(c->a[j])], b = s->hot[body_index(c->b[j])];
    return (a > b ? a : b) >= s->sweep - 1;
}

/* The lanes that a later sweep of the step solves */
ALWAYS_INLINE vm small_hot(const struct small *s, const struct small_bundle *c, int k)
{
    double hot[LANES];
    for (int j = 0; j < LANES; j++) hot[j] = small_is_hot(s, c, k + j);
    return lt(splat(0), vload(hot));
}

/* Lanes that are not among `those` keep what they have, whatever the width; dc: the change of the couple. */
ALWAYS_INLINE void small_keep(const struct small_pairs *y, struct small_law *l, const vd had[3],
                              vd couple[3], vm those, vd df[3], vd dc[3])
{
    vd c[3];
    small_cross(l->n, l->rt, c);
    for (int j = 0; j < 3; j++) {
        l->f[j] = pick(those, l->f[j], had[j]), df[j] = pick(those, df[j], splat(0));
        dc[j] = pick(those, y->length * c[j] - couple[j], splat(0));
        couple[j] = pick(those, y->length * c[j], couple[j]);
    }
    l->rn = pick(those, l->rn, dot3(l->n, l->f));
}

/* But for u, f, q and rn */
ALWAYS_INLINE void small_set_law(struct small_law *l, const struct small_pairs *y,
                                 const struct small *s)
{
    for (int j = 0; j < 3; j++) l->n[j] = y->n[j];
    l->gap = y->gap, l->wn = y->a.im + y->b.im;
    l->wt = l->wn + y->la * y->la * y->a.ii + y->lb * y->lb * y->b.ii;
    l->cn = s->rate.soft * l->wn, l->ct = s->rate.soft * l->wt, l->mu = vload(y->c->mu + y->k);
}

/* Attraction of pairs that have pushed f: dp, the change of the pull, of which rate.warm persists; lanes that it holds */
ALWAYS_INLINE vm small_hold_pairs(const struct small_pairs *y, const struct small *s,
                                  struct small_law *l, bool again, vd dp[3])
{
    double(*to)[BUNDLE] = s->hold[y->i].x;
    const int k = y->k;
    vd x[HOLD_COUNT], sum[3], had = vload(to[HOLD_PULL] + k), zero = splat(0);
    for (int j = 0; j < HOLD_COUNT; j++) x[j] = vload(to[j] + k);
    for (int j = 0; j < 3; j++) dp[j] = zero;
    if (!again) {
        small_hold_pull(x, l->n, l->gap, lt(zero, dot3(l->n, l->f)), s->rate.h, s->rate.warm, dp);
        for (int j = HOLD_WET; j < HOLD_COUNT; j++) vstore(to[j] + k, x[j]);
        small_load(sum, y->c->sum, k);
        for (int j = 0; j < 3; j++) sum[j] -= x[HOLD_PULL] * l->n[j];
        small_store(y->c->sum, k, sum);
    }
    l->calm += 2 * l->wn * x[HOLD_PULL];
    for (int j = 0; j < 3; j++) l->u[j] -= l->wn * dp[j];
    return lt(zero, x[HOLD_PULL]) | lt(zero, had) | lt(zero, x[HOLD_WET]);
}

/* The law in the first sweep of a step, where pairs may have springs or bonds x, of which those that do not act keep what they have,
   whatever the width */
ALWAYS_INLINE void small_spring_pairs(const struct small_pairs *y, const struct small *s,
                                      struct small_law *l, vm acts, vd x[SPRING_COUNT])
{
    double(*to)[BUNDLE] = s->spring[y->i].x;
    const int k = y->k;
    struct bodies a, b;
    struct twist ma, mb;
    struct small_stretch at = { .gap = l->gap, .mu = l->mu, .h = s->rate.h, .rise = s->rate.rise };
    vd q[3], p[3], w[3];
    bodies_load(&a, s->before, y->c->a + k, &ma), bodies_load(&b, s->before, y->c->b + k, &mb);
    small_velocity_image(y, s, &ma, &mb, at.u);
    for (int j = 0; j < 3; j++) w[j] = y->ma.w[j] + y->mb.w[j], at.n[j] = l->n[j];
    at.spin = 0.5 * s->rate.h * dot3(w, l->n), at.pushed = lt(splat(0), dot3(l->n, l->f));
    small_spring_begin(x, &at, q);
    for (int j = SPRING_REST; j <= SPRING_GIVEN; j++) {
        x[j] = pick(acts, x[j], vload(to[j] + k));
        vstore(to[j] + k, x[j]);
    }
    vm springs = small_spring_acts(x);
    small_bond_pull(x, l->n, l->gap, p);
    small_begin(y, s, l, p, small_bond_stills(x));
    for (int j = 0; j < 3; j++) l->q[j] = pick(springs, q[j], l->q[j]), l->f[j] = l->f[j] + p[j];
    small_store(y->c->q, k, l->q);
    vstore(y->c->kept + k, pick(springs, dot3(l->n, l->f), vload(y->c->kept + k)));
}

/* mu of the step, by the velocities before it */
ALWAYS_INLINE void small_stick_pairs(const struct small_pairs *y, const struct small *s,
                                     struct small_law *l)
{
    struct small_stick *t = &s->stick[y->i];
    struct bodies a, b;
    struct twist ma, mb;
    vd u[3], un, ut[3];
    bodies_load(&a, s->before, y->c->a + y->k, &ma);
    bodies_load(&b, s->before, y->c->b + y->k, &mb);
    small_velocity_image(y, s, &ma, &mb, u), small_split(l->n, u, &un, ut);
    vm sticks = le(norm3(ut), vload(t->v_s + y->k));
    l->mu = pick(sticks, vload(t->mu[0] + y->k), vload(t->mu[1] + y->k));
    vstore(y->c->mu + y->k, l->mu);
}

/* hot: of small_hot() in a later sweep, else NULL; rich: pairs may attract or stick */
ALWAYS_INLINE bool small_lanes(struct small *s, int64_t i, int k, const vm *hot, bool rolls,
                               bool rich)
{
    struct small_pairs y;
    struct small_law l;
    vd had[3], couple[3], df[3], dc[3], dm[3], dp[3] = { splat(0), splat(0), splat(0) };
    const double reach = rich && s->rate.holds > s->rate.reach ? s->rate.holds : s->rate.reach;
    if (small_is_far(s, i, k, reach)) return false;
    small_pairs_look(&y, s, i, k);
    vd most = y.ra + y.rb + reach;
    vm near = le(y.d2, most * most);
    if (!s->live[BUNDLE * i + k] && !any(near)) {
        small_wait(&y, s);
        return false;
    }
    small_pairs_load(&y, s);
    if (rich)
        small_velocity_image(&y, s, &y.ma, &y.mb, l.u);
    else
        small_velocity(&y, &y.ma, &y.mb, l.u);
    small_set_law(&l, &y, s);
    l.calm = splat(s->rate.calm);
    small_load(l.f, y.c->f, k), small_load(couple, y.c->couple, k);
    const double warm = hot ? 1 : s->rate.warm;
    for (int j = 0; j < 3; j++) had[j] = warm * l.f[j], couple[j] *= warm;
    vm acts = near | lt(splat(0), dot3(had, had)), holds = NONE;
    vd x[SPRING_COUNT];
    for (int j = 0; j < SPRING_COUNT && rich && s->spring; j++) x[j] = vload(s->spring[i].x[j] + k);
    if (rich && s->spring) acts = acts | small_bond_holds(x);
    if (rich && s->hold) holds = small_hold_pairs(&y, s, &l, hot, dp), acts = acts | holds;
    if (rich && s->stick && !hot) small_stick_pairs(&y, s, &l);
    if (hot)
        small_load(l.q, y.c->q, k), acts = acts & *hot;
    else if (rich && s->spring)
        small_spring_pairs(&y, s, &l, acts, x), small_turned(&y, &l, couple);
    else
        small_begin(&y, s, &l, NULL, NONE), small_turned(&y, &l, couple);
    if (rich && s->spring) holds = holds | small_bond_holds(x);
    l.most = small_most(&l, &s->rate, vload(y.c->kept + k));
    if (rich && s->spring)
        small_solve_springs(&l, x, s->rate.h, df);
    else
        small_solve(&l, df);
    small_keep(&y, &l, had, couple, acts, df, dc);
    small_store(y.c->f, k, l.f), small_store(y.c->couple, k, couple);
    if (rolls) small_turn_pairs(&y, s, &l, acts, !hot, dc, dm);
    s->live[BUNDLE * i + k] = any(lt(splat(0), l.rn) | holds);
    s->late[BUNDLE * i + k] = any(lt(2 * (vload(y.c->kept + k) + l.calm / l.wn), l.rn));
    for (int j = 0; j < 3 && rich; j++) df[j] -= dp[j];
    small_give(&y, s, df, dc, rolls ? dm : NULL);
    vd change = l.wn * norm3(df);
    if (rolls) change = change + (y.a.ii * y.la + y.b.ii * y.lb) * norm3(dm);
    return small_mark(&y, s, change, hot);
}

ALWAYS_INLINE bool small_bundles(struct small *s, int64_t first, int64_t end, bool again,
                                 bool rolls, bool rich)
{
    bool far = false;
    for (int64_t i = first; i < end; i++) {
        if (again && !small_is_marked(s, i)) continue;
        for (int k = 0; k < BUNDLE; k += LANES) {
            vm hot = NONE;
            if (again) hot = small_hot(s, &s->bundle[i], k);
            if (!again || any(hot)) far |= small_lanes(s, i, k, again ? &hot : NULL, rolls, rich);
        }
    }
    return far;
}

static bool small_sweep_bundles(struct small *s, int64_t first, int64_t end, bool again)
{
    if (s->hold || s->stick || s->moves || s->spring)
        return again ? small_bundles(s, first, end, true, s->turn, true)
                     : small_bundles(s, first, end, false, s->turn, true);
    if (s->turn)
        return again ? small_bundles(s, first, end, true, true, false)
                     : small_bundles(s, first, end, false, true, false);
    return again ? small_bundles(s, first, end, true, false, false)
                 : small_bundles(s, first, end, false, false, false);
}

static void small_push_bundles(struct small *s, int64_t first, int64_t end)
{
    for (int64_t i = first; i < end; i++)
        for (int k = 0; k < BUNDLE; k += LANES) {
            struct small_pairs y;
            vd f[3], c[3], m[3] = { splat(0), splat(0), splat(0) };
            if (!s->live[BUNDLE * i + k]) continue;
            small_pairs_look(&y, s, i, k), small_pairs_load(&y, s);
            small_load(f, y.c->f, k);
            if (s->turn) small_load(m, s->turn[i].m, k);
            small_cross(y.n, f, c);
            for (int j = 0; j < 3; j++)
                c[j] = pick(lt(splat(0), vload(y.c->mu + k)), y.length * c[j], splat(0));
            small_store(y.c->couple, k, c);
            for (int j = 0; j < 3 && s->hold; j++)
                f[j] -= vload(s->hold[i].x[HOLD_PULL] + k) * y.n[j];
            for (int j = 0; j < 3; j++)
                f[j] *= s->rate.warm, c[j] *= s->rate.warm, m[j] *= s->rate.warm;
            small_give(&y, s, f, c, s->turn ? m : NULL);
        }
}

static void small_judge_lanes(struct small *s, int64_t i, int k)
{
    struct small_pairs y;
    struct small_law l;
    vd had[3], df[3], zero = splat(0);
    double far[LANES], load[LANES];
    if (small_is_far(s, i, k, s->rate.reach)) return;
    small_pairs_look(&y, s, i, k);
    vd most = y.ra + y.rb + s->rate.reach;
    vm near = le(y.d2, most * most);
    if (!s->live[BUNDLE * i + k] && !any(near)) return;
    small_pairs_load(&y, s);
    small_velocity_image(&y, s, &y.ma, &y.mb, l.u);
    small_load(had, y.c->f, k), small_load(l.q, y.c->q, k);
    small_set_law(&l, &y, s);
    l.calm = splat(s->rate.calm);
    if (s->hold) l.calm += 2 * l.wn * vload(s->hold[i].x[HOLD_PULL] + k);
    l.most = small_most(&l, &s->rate, vload(y.c->kept + k));
    for (int j = 0; j < 3; j++) l.f[j] = had[j];
    vd pushes = norm3(had), x[SPRING_COUNT];
    for (int j = 0; j < SPRING_COUNT && s->spring; j++) x[j] = vload(s->spring[i].x[j] + k);
    if (s->spring)
        small_solve_springs(&l, x, s->rate.h, df);
    else
        small_solve(&l, df);
    vstore(far, pick(near | lt(zero, pushes), norm3(df), zero)), vstore(load, pushes);
    for (int j = 0; j < LANES; j++) {
        if (!(far[j] > 0) && !(load[j] > 0)) continue;
        const int64_t a = body_index(y.c->a[k + j]), b = body_index(y.c->b[k + j]);
        s->missing[a] += far[j], s->missing[b] += far[j];
        s->load[a] += load[j], s->load[b] += load[j];
    }
}

static void small_judge_bundles(struct small *s, int64_t first, int64_t end)
{
    for (int64_t i = first; i < end; i++)
        for (int k = 0; k < BUNDLE; k += LANES) small_judge_lanes(s, i, k);
}

/* N s: what persists at most of reactions rn along the normal; w (1/kg): of the pairs along it [small_persists()] */
ALWAYS_INLINE vd small_persists_most(const struct small_pairs *y, const struct small *s, vd w,
                                     vd rn)
{
    const double calm = s->rate.calm;
    vd held = vload(y->c->kept + y->k), slight = 0.125 * rn;
    if (s->hold) held = held + 2 * vload(s->hold[y->i].x[HOLD_PULL] + y->k);
    vd most = 2 * (held + calm / w);
    if (!(calm > 0)) most = pick(lt(slight, most), most, slight);
    return pick(lt(held, splat(0)), SMALL_TRACE * rn, most);
}

/* Takes what does not persist of the reactions out of v^-: v + (v - v^-) then has less of it. */
static void small_settle_lanes(struct small *s, int64_t i, int k)
{
    struct small_pairs y;
    struct twist da, db;
    vd f[3], couple[3], sum[3], m[3], turned[3], zero = splat(0);
    small_pairs_look(&y, s, i, k);
    bodies_load(&y.a, s->before, y.c->a + k, &y.ma);
    bodies_load(&y.b, s->before, y.c->b + k, &y.mb);
    vd length = root(y.d2), per = 1 / length, half = 0.5 * (length - y.ra - y.rb);
    const vm apart = lt(zero, length);
    for (int j = 0; j < 3; j++) y.n[j] = pick(apart, y.d[j] * per, splat(j == 1));
    small_load(f, y.c->f, k), small_load(couple, y.c->couple, k), small_load(sum, y.c->sum, k);
    for (int j = 0; j < 3; j++) m[j] = turned[j] = zero;
    if (s->turn) small_load(m, s->turn[i].m, k), small_load(turned, s->turn[i].sum, k);
    vd rn = dot3(f, y.n), most = small_persists_most(&y, s, y.a.im + y.b.im, rn);
    vm acts = lt(zero, absolute(f[0]) + absolute(f[1]) + absolute(f[2])) & ~le(rn, most);
    if (s->spring) {
        const struct small_springs *x = &s->spring[i];
        acts = acts &
               ~(lt(zero, vload(x->x[SPRING_KN] + k)) & ~lt(zero, vload(x->x[SPRING_BETA] + k)));
    }
    if (!any(acts)) return;
    vd left = most / rn, back = 1 - left, nothing = splat(-0.0); // which added changes no sign
    vd part = pick(apart, back / length, zero);
    for (int j = 0; j < 3; j++) {
        vd c = part * couple[j], along = back * f[j], turn = back * m[j];
        da.v[j] = pick(acts, y.a.im * -along, nothing);
        db.v[j] = pick(acts, y.b.im * along, nothing);
        da.w[j] = pick(acts, y.a.ii * (-turn - (y.ra + half) * c), nothing);
        db.w[j] = pick(acts, y.b.ii * (turn - (y.rb + half) * c), nothing);
        sum[j] = pick(acts, sum[j] + along, sum[j]), f[j] = pick(acts, f[j] * left, f[j]);
        couple[j] = pick(acts, couple[j] * left, couple[j]);
        turned[j] = pick(acts, turned[j] + turn, turned[j]), m[j] = pick(acts, m[j] * left, m[j]);
    }
    small_store(y.c->f, k, f), small_store(y.c->couple, k, couple), small_store(y.c->sum, k, sum);
    if (s->turn) small_store(s->turn[i].m, k, m), small_store(s->turn[i].sum, k, turned);
    bodies_add(s->before, y.c->a + k, &da), bodies_add(s->before, y.c->b + k, &db);
}

static void small_settle_bundles(struct small *s, int64_t first, int64_t end)
{
    for (int64_t i = first; i < end; i++) {
        uint64_t late;
        memcpy(&late, &s->late[BUNDLE * i], sizeof late);
        if (!late) continue;
        memset(&s->late[BUNDLE * i], 0, BUNDLE);
        for (int k = 0; k < BUNDLE; k += LANES) small_settle_lanes(s, i, k);
    }
}

#define SMALL_(lanes)   small_##lanes
#define SMALL_OF(lanes) SMALL_(lanes)
extern const struct small_kernels SMALL_OF(LANES);
const struct small_kernels SMALL_OF(LANES) = { small_sweep_bundles, small_push_bundles,
                                               small_judge_bundles, small_settle_bundles };
