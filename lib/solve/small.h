/*
 * solve/small.h: small steps of balls: pairs that are kept over many steps, in bundles of eight, and one sweep of each
 * step, in which a pair finds its gap, starts from the part of its reaction that persists and is solved in closed form.
 * The passes of a step, and the bytes that each moves:
 *
 *     bodies    v <- v + h g + warm (v - v^- - h g): free motion, and what persists of all r   200 per body
 *     walls     each body against the walls that are near it                                   600 per contact
 *     pairs     gap, normal, u; the law; the change of the reaction to both bodies             550 per pair in reach,
 *                                                                                              140 per other pair
 *                                                                                              that may be in reach,
 *                                                                                              2 per one that may not
 *     again     pairs of bodies that a sweep has changed by more than is allowed
 *     judge     what is missing to the law, where it is asked for                              400 per pair in reach
 *     settle    what of a new reaction does not persist is taken out of v^-                    500 per such pair
 *     move      x <- x + h v                                                                   150 per body
 *
 * Reactions are vectors in space, f on b. A step begins with a part of the reactions of the one before, rate.warm. What these
 * have made of a body's velocity is v - v^- - h g, with v^- and v before and after that step of the same length, so that
 * no pass over the pairs has to apply them. What turns bodies is the couple d x f, which is kept with f: the next step takes
 * that back, and not what f would do along the normal of that step, so that angular momentum is kept and frictionless balls
 * do not turn.
 *
 * The law is that of rigid contacts, with a compliance C that is a small part of W_cc:
 *
 *     u~ = u + q + C (f - f_0),   C = diag(c_n, c_t, c_t)
 *
 *     pairs that push    q = n g/h where g > 0, else n max(g/(h + tau), -v_push - 2 c_n f_n^-),   f_0 = (0, f_t^-)
 *     impacts            q = E u^- (and n g/h where e_n = 0),                       f_0 = r^, of the pair alone
 *
 * C makes the reactions of a packing unique. Along n it gives way to no more of f than may persist, so that impacts pass
 * through rigid bodies, and has f_0 = 0 in impacts; where masses are very different it gives way to all. An impact is a pair that pushes little and
 * would meet in this step by u^-; it has Newton's law exactly where it is alone. Pairs that are apart, rebound and are not
 * met by their own motion wait: what others make of it is the impact of a later step. Overlaps are left slowly,
 * at v_push at most and what C takes of a load.
 *
 * Groups of bundles share no body, so that any number of threads gives the same bits.
 */
#pragma once

#include "solve/bundle.h"
#include "solve/small_hold.h"
#include "solve/small_spring.h"

#include <string.h>

/* Where a body is, in the place of its struct body */
struct small_place {
    double x[3], r; /* m */
    double spare[4];
};

struct small_bundle {
    int32_t a[BUNDLE], b[BUNDLE]; /* places of bodies [solve/bundle.h] */
    double f[3][BUNDLE];          /* N s: of this step; between steps, what persists of it */
    double couple[3][BUNDLE];     /* N m s: d x f where f was made; d: from a to b */
    double kept[BUNDLE];          /* N s: of f along n, with which the step began; SMALL_MEETS */
    double q[3][BUNDLE];          /* m/s: q - C f_0 */
    double sum[3][BUNDLE];        /* N s: of f, in the steps before this one */
    double mu[BUNDLE];
    double e[2][BUNDLE]; /* e_n, e_t */
};

/* Rolling and pivoting friction of a bundle */
struct small_turn {
    double m[3][BUNDLE];    /* N m s: on b */
    double sum[3][BUNDLE];  /* N m s: of m, in the steps before this one */
    double most[2][BUNDLE]; /* m: mu_p, mu_r */
};

/* What attracts the pairs of a bundle [solve/small_hold.h] */
struct small_holds {
    double x[HOLD_COUNT][BUNDLE];
};

/* The springs of the pairs of a bundle [solve/small_spring.h] */
struct small_springs {
    double x[SPRING_COUNT][BUNDLE];
};

/* Static and kinetic friction of a bundle, of which mu is one in each step [contact/contact_law.h] */
struct small_stick {
    double mu[2][BUNDLE]; /* mu_s and mu */
    double v_s[BUNDLE];   /* m/s */
};

/* The image of b that a meets */
struct small_shift {
    double d[3][BUNDLE]; /* m: it is so far from b, */
    double v[3][BUNDLE]; /* m/s: and so much faster, where the cell moves */
};

/* What a step is made with */
struct small_rates {
    double h, per_h; /* s, 1/s */
    double warm;     /* of the reactions of the last step: the part that a step starts from */
    double relax;    /* 1/s: 1/(h + tau) */
    double push;     /* m/s: v_push */
    double soft;     /* C over W of the pair */
    double gives;    /* N s: C gives way to so much of f along n: INFINITY; 0: what may persist */
    double calm;     /* m/s: no pair at rest approaches faster [state/freedom.h] */
    double reach;    /* m: pairs that are farther apart do not touch in this step */
    double pulls;    /* m/s: no pair is pulled faster in a step */
    double holds;    /* m: nor are held together without a bridge; 0 */
    double rise;     /* m: in a step, of overlaps that springs have not made */
    double gone;     /* m: by how much two bodies may have come nearer in this interval */
    double allowed
        [2]; /* m/s: a change of a velocity that is not followed up, in the first sweep and in others */
};

struct small {
    int64_t bodies; /* and two more at the end, far from each other, for lanes without a pair */
    struct small_place *place;
    struct body *body, *before; /* at v, w; at v^-, w^- */
    double *missing, *load;     /* [bodies] N s: of small_judge; NULL */
    int32_t *hot;   /* [bodies] the last sweep that has changed it by more than is allowed */
    double *change; /* [bodies] m/s: by sweeps of this step since then */
    /* For repeated sweeps, of bundles that have a hot body alone; NULL before the first one [step/small_mark.c] */
    int32_t *mark;          /* [bundles] the last repeated sweep that is to look at it */
    int64_t *meets, *first; /* bundles of body i: meets[first[i]] .. meets[first[i + 1] - 1] */
    int64_t bundles, groups, serial; /* groups from `serial` on are of one pair each */
    int64_t *group;                  /* [groups + 1] */
    struct small_bundle *bundle;
    struct small_turn *turn;      /* NULL: nothing rolls */
    struct small_shift *shift;    /* NULL: no images */
    bool moves;                   /* images do not move as their bodies */
    struct small_holds *hold;     /* NULL: nothing attracts */
    struct small_stick *stick;    /* NULL: no static friction */
    struct small_springs *spring; /* NULL: no contact has a stiffness */
    uint8_t *live, *late; /* [8 bundles] lanes from there on push; and push more than may persist */
    double *until; /* [8 bundles] m: lanes are looked at when rate.gone and the reach exceed it */
    double slack;  /* m: above the rounding of places */
    int32_t sweep; /* counted over all steps, from 1 on */
    struct small_rates rate;
};

/* ---- the law of a contact, in LANES lanes ---- */

struct small_law {
    vd n[3], gap;          /* m */
    vd spin;               /* rad: of the pair about n in the step */
    vd u[3];               /* m/s: of b against a, in space */
    vd wn, wt, cn, ct, mu; /* 1/kg */
    vd f[3];               /* N s */
    vd q[3];               /* m/s */
    vd rn, rt[3];          /* N s: f along n, and across */
    vd calm;               /* m/s: the pair at rest does not approach faster */
    vd most;               /* N s: of f along n, what C gives way to */
};

ALWAYS_INLINE void small_split(const vd n[3], const vd x[3], vd *along, vd across[3])
{
    *along = dot3(n, x);
    for (int i = 0; i < 3; i++) across[i] = x[i] - *along * n[i];
}

/* x cross y */
ALWAYS_INLINE void small_cross(const vd x[3], const vd y[3], vd to[3])
{
    for (int i = 0, j = 1, k = 2; i < 3; j = k, k = i++) to[i] = x[j] * y[k] - x[k] * y[j];
}

/* x on the disc of radius most */
ALWAYS_INLINE void small_cut(vd most, vd x[3])
{
    vd x2 = dot3(x, x), s = pick(lt(most * most, x2), most / root(x2), splat(1));
    for (int i = 0; i < 3; i++) x[i] = s * x[i];
}

/* q of a pair that pushes, whose friction turns with it */
ALWAYS_INLINE void small_press(struct small_law *l, const struct small_rates *o)
{
    vd rn, t[3], turn[3], zero = splat(0);
    small_split(l->n, l->f, &rn, t);
    vd most = o->push + 2 * l->cn * larger(rn, zero);
    vd qn = pick(lt(l->gap, zero), larger(l->gap * o->relax, -most), l->gap * o->per_h);
    small_cross(l->n, t, turn);
    for (int i = 0; i < 3; i++) l->q[i] = qn * l->n[i] - l->ct * (t[i] + l->spin * turn[i]);
}

/* Of the impulse of an impact: what a pair pushes that is taken to meet */
#define SMALL_SLIGHT 0.01

/* In place of what was kept: an impact across a gap, of which a trace persists: the next step sees by it that the pair has pushed
   [solve/small_hold.h]. Without restitution the pair closes the gap in this step and stops in the next one. */
#define SMALL_MEETS (-INFINITY)
#define SMALL_TRACE 1e-12

/* q of pairs that meet, and of those that wait; before: u^-. kept: of f, or SMALL_MEETS. Returns which ones meet. */
ALWAYS_INLINE vm small_meet(struct small_law *l, const struct small_rates *o, const vd before[3],
                            vd *kept, vd en, vd et)
{
    vd un, ut[3], hit[3], zero = splat(0);
    small_split(l->n, before, &un, ut);
    vm meets =
        lt(un, -l->calm) & lt(un + l->gap * o->per_h, zero) & le(l->wn * *kept, -SMALL_SLIGHT * un);
    vm waits = le(l->wn * *kept, splat(4 * SMALL_TRACE * o->reach * o->per_h)) & lt(zero, l->gap) &
               lt(zero, en) & ~meets;
    vd open = pick(le(en, zero), larger(l->gap, zero) * o->per_h, zero);
    vd rn = larger(-(un + en * un + open) / l->wn, zero);
    for (int i = 0; i < 3; i++) hit[i] = -(1 + et) * ut[i] / l->wt;
    small_cut(l->mu * rn, hit);
    vd alone = o->gives > 0 ? l->cn * rn : zero;
    for (int i = 0; i < 3; i++) {
        vd q = (en * un + open - alone) * l->n[i] + et * ut[i] - l->ct * hit[i];
        l->q[i] = pick(meets, q, pick(waits, 1e30 * l->n[i], l->q[i]));
    }
    *kept = pick(meets & lt(zero, l->gap), splat(SMALL_MEETS), *kept);
    return meets;
}

/* N s: of f along n, what C gives way to: what may persist [small_persists()], or all */
ALWAYS_INLINE vd small_most(const struct small_law *l, const struct small_rates *o, vd kept)
{
    return larger(2 * (kept + l->calm / l->wn), splat(o->gives));
}

/* f in closed form, where f makes u; df: its change */
ALWAYS_INLINE void small_solve(struct small_law *l, vd df[3])
{
    vd un, ut[3], qn, qt[3], rn, *rt = l->rt;
    small_split(l->n, l->u, &un, ut), small_split(l->n, l->q, &qn, qt);
    small_split(l->n, l->f, &rn, rt);
    vd soft = rn - (un + qn + l->cn * rn) / (l->wn + l->cn);
    vd hard = larger(rn - (un + qn + l->cn * l->most) / l->wn, l->most);
    l->rn = larger(pick(lt(l->most, soft), hard, soft), splat(0));
    vd s = 1 / (l->wt + l->ct);
    for (int i = 0; i < 3; i++) rt[i] -= s * (ut[i] + qt[i] + l->ct * rt[i]);
    small_cut(l->mu * l->rn, rt);
    for (int i = 0; i < 3; i++) {
        vd f = l->rn * l->n[i] + rt[i];
        df[i] = f - l->f[i], l->f[i] = f;
    }
}

/* f of pairs with springs x; q: of small_spring_begin() */
ALWAYS_INLINE void small_solve_soft(const struct small_law *l, const vd x[SPRING_COUNT], vd *fn,
                                    vd rt[3])
{
    vd un, qn, rn, ut[3], qt[3], zero = splat(0);
    small_split(l->n, l->u, &un, ut), small_split(l->n, l->q, &qn, qt);
    small_split(l->n, l->f, &rn, rt);
    vd gn = x[SPRING_PART] * x[SPRING_GN] + x[SPRING_YIELD] * x[SPRING_KN];
    vd gt = x[SPRING_PART] * x[SPRING_GT] + x[SPRING_YIELD] * x[SPRING_KT];
    *fn = rn - (rn + qn + gn * un) / (1 + gn * l->wn);
    *fn = pick(lt(qn, zero) | lt(zero, x[SPRING_YIELD]), larger(*fn, zero), zero);
    vd s = 1 / (1 + gt * l->wt);
    for (int i = 0; i < 3; i++) rt[i] -= s * (rt[i] + qt[i] + gt * ut[i]);
    small_cut(l->mu * *fn, rt);
}

/* small_solve() where pairs may have springs or a bond x, in steps of h; rn is without what a bond pulls. A bond alone gives f = b;
   r moves its pair by W/(1 + G W), and the bond, G = h^2 S beta^2 c, takes the rest of r. */
ALWAYS_INLINE void small_solve_springs(struct small_law *l, const vd x[SPRING_COUNT], double h,
                                       vd df[3])
{
    const struct small_law was = *l;
    vd un, rn, ut[3], rt[3], p[3], pn, pt[3], b[3], fn, ft[3], one = splat(1), zero = splat(0);
    vm springs = small_spring_acts(x), bonded = small_bond_holds(x);
    vd beta2 = x[SPRING_BETA] * x[SPRING_BETA], gn = h * beta2 * x[SPRING_SN];
    vd gt = h * beta2 * x[SPRING_ST], sn = 1 / (1 + gn * l->wn), st = 1 / (1 + gt * l->wt);
    small_solve_soft(l, x, &fn, ft);
    small_bond_pull(x, l->n, l->gap, p), small_split(l->n, p, &pn, pt);
    small_split(l->n, l->u, &un, ut), small_split(l->n, l->f, &rn, rt);
    vd bn = sn * (pn + gn * (l->wn * rn - un));
    for (int i = 0; i < 3; i++) {
        b[i] = st * (pt[i] + gt * (l->wt * rt[i] - ut[i]));
        vd moved = l->wn * (bn - rn) * l->n[i] + l->wt * (b[i] - rt[i]);
        l->u[i] = pick(bonded, l->u[i] + moved, l->u[i]), l->f[i] = pick(bonded, zero, l->f[i]);
    }
    l->wn = pick(bonded, sn * l->wn, l->wn), l->wt = pick(bonded, st * l->wt, l->wt);
    l->mu = l->mu * (one - x[SPRING_BETA]);
    small_solve(l, df);
    vd rigid = l->rn;
    l->rn = pick(springs, fn, rigid);
    for (int i = 0; i < 3; i++) {
        l->rt[i] = pick(bonded, b[i] + st * l->rt[i], pick(springs, ft[i], l->rt[i]));
        vd along = pick(bonded, bn + sn * rigid, l->rn);
        l->f[i] = along * l->n[i] + l->rt[i], df[i] = l->f[i] - was.f[i];
        l->u[i] = was.u[i];
    }
    l->wn = was.wn, l->wt = was.wt;
}

/* m of rolling and pivoting friction, where it makes w of b against a; wr (1/(kg m^2)), dm: its change */
ALWAYS_INLINE void small_roll(const vd n[3], vd rn, const vd w[3], vd wr, const vd most[2], vd m[3],
                              vd dm[3])
{
    vd wn, wt[3], mn, mt[3], s = 1 / wr, top = most[0] * rn;
    small_split(n, w, &wn, wt), small_split(n, m, &mn, mt);
    mn = mn - s * wn;
    mn = pick(lt(top, mn), top, pick(lt(mn, -top), -top, mn));
    for (int i = 0; i < 3; i++) mt[i] -= s * wt[i];
    small_cut(most[1] * rn, mt);
    for (int i = 0; i < 3; i++) {
        vd x = mn * n[i] + mt[i];
        dm[i] = x - m[i], m[i] = x;
    }
}

/* N s: so much at most persists of a reaction of which so much was kept before: twice that and what holds a body at
   rest; where nothing falls, an eighth of it, rn, at least; of an impact across a gap a trace. w (1/kg): of the pair along n */
ALWAYS_INLINE double small_persists(const struct small_rates *o, double kept, double w, double rn)
{
    if (kept < 0) return SMALL_TRACE * rn;
    const double most = 2 * (kept + o->calm / w);
    return o->calm > 0 || most > 0.125 * rn ? most : 0.125 * rn;
}

/* ---- marks ---- */

/* The sweep in hand is to look at the bundles of body i. Threads may mark the same bundle at the same time. */
static inline void small_mark_bundles(struct small *s, int64_t i)
{
    if (!s->mark) return;
    for (int64_t k = s->first[i]; k < s->first[i + 1]; k++)
        __atomic_store_n(&s->mark[s->meets[k]], s->sweep, __ATOMIC_RELAXED);
}

static inline bool small_is_marked(const struct small *s, int64_t bundle)
{
    return !s->mark || __atomic_load_n(&s->mark[bundle], __ATOMIC_RELAXED) == s->sweep;
}

/* ---- kernels ---- */

/* Bundles first .. end-1 of one group; again: it is not the first sweep of the step. Returns whether a body has changed by more
   than is allowed. */
typedef bool small_sweep(struct small *s, int64_t first, int64_t end, bool again);
/* Bodies get the reactions that the bundles have. */
typedef void small_push(struct small *s, int64_t first, int64_t end);

/* Both bodies of each pair: s->missing grows by how far its reaction is from the law, for the velocities that bodies have,
   and s->load by the reaction. */
typedef void small_judge(struct small *s, int64_t first, int64_t end);

/* After the sweeps: what does not persist of the reactions of bundles that are `late` is taken out of v^-. */
typedef void small_settle(struct small *s, int64_t first, int64_t end);

struct small_kernels {
    small_sweep *sweep;
    small_push *push;
    small_judge *judge;
    small_settle *settle;
};
