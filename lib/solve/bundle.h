/*
 * solve/bundle.h: what the sweep reads of its contacts, in bundles of eight side by side. The
 * contacts of a bundle belong to one group: they do not depend on each other, so all may be solved
 * at once.
 *
 * Each quantity of a bundle fills a cache line; lane k belongs to contact k. Functions that work on
 * LANES lanes at once are given the first, k. A sweep over many contacts takes as long as it takes
 * to read their bundles, so what can be computed meanwhile (t1, t2, W~_cc of balls) or is seldom
 * needed stands elsewhere (solve/problem.h: w, rho, block, u, rebound).
 *
 * A lane without a contact (at the end of a group) has rho = 0 and w = 1: its contact separates,
 * and is not counted.
 */
#ifndef NSD_BUNDLE_H
#define NSD_BUNDLE_H

#include "solve/local.h"

enum { BUNDLE = 8 };

struct bundle {
    double n[3][BUNDLE];
    double la[BUNDLE], lb[BUNDLE]; /* m: lever arms along n, from a's centre and to b's; of balls */
    double iw[2][BUNDLE];          /* kg: 1/w, normal and tangential */
    double mu[BUNDLE];
    double r[3][BUNDLE];          /* N s */
    int32_t a[BUNDLE], b[BUNDLE]; /* places of bodies; given by W: a is the contact, -1: none */
};

/* What may stand behind a bundle, to be loaded rather than computed */
struct beside {
    double t1[3][BUNDLE]; /* else as contact_basis() makes it of n, in space */
    double w[2][BUNDLE];  /* kg^-1: as in solve/problem.h; else of masses and arms */
};
struct near_bundle {
    struct bundle bundle;
    struct beside beside;
};

/* Newton's impact law in a bundle, the velocity d by which an image moves faster than its body, what the law sees
   besides [state/offset.h], and the compliance of springs [contact/spring.h]: u~ = s u + offset + soft r */
struct rebound {
    double s[2][BUNDLE];      /* 1/(1 + e_n), 1/(1 + e_t) */
    double offset[3][BUNDLE]; /* m/s: D^-1 (E (u^- + d^-) + d + law) */
    double soft[2][BUNDLE];   /* kg^-1: D^-1 diag(c_n, c_t), part of W~_cc; 0: rigid */
};

/* Of eight partial results, one a lane: their sum; the largest, at least 0 and never NaN */
static inline double bundle_sum(const double lane[BUNDLE])
{
    double sum = 0;
    for (int k = 0; k < BUNDLE; k++) sum += lane[k];
    return sum;
}
static inline double bundle_max(const double lane[BUNDLE])
{
    double max = 0;
    for (int k = 0; k < BUNDLE; k++) max = lane[k] > max ? lane[k] : max;
    return max;
}

struct body {
    double v[3], w[3]; /* m/s, rad/s */
    double im, ii;     /* 1/kg, 1/(kg m^2); 0: immovable */
};

/*
 * The place of body[index], as bundles store it: its offset in doubles, of which a body has 8, so
 * that an instruction finds it without multiplying.
 */
enum { BODIES_MAX = INT32_MAX / 8 }; /* whose places are 32-bit */
static inline int32_t body_place(int64_t index)
{
    return (int32_t)(8 * index);
}
static inline int64_t body_index(int32_t place)
{
    return place / 8;
}
ALWAYS_INLINE GLOBAL double *body_at(GLOBAL struct body *body, int32_t place)
{
    return (GLOBAL double *)body + place;
}

/* LANES bodies side by side: their 1/mass and 1/inertia */
struct bodies {
    vd im, ii;
};
/* and their velocities, or changes of these */
struct twist {
    vd v[3], w[3];
};

ALWAYS_INLINE void bodies_load(struct bodies *m, GLOBAL struct body *body,
                               GLOBAL const int32_t *place, struct twist *moves)
{
    vd x[8];
    for (int k = 0; k < 8; k += LANES) {
        for (int i = 0; i < LANES; i++) x[k + i] = vload(body_at(body, place[i]) + k);
        transpose(x + k);
    }
    for (int k = 0; k < 8; k++) pin(&x[k]);
    for (int k = 0; k < 3; k++) moves->v[k] = x[k], moves->w[k] = x[3 + k];
    m->im = x[6], m->ii = x[7];
}

ALWAYS_INLINE void bodies_add(GLOBAL struct body *body, GLOBAL const int32_t *place,
                              const struct twist *d)
{
    vd x[8] = { d->v[0], d->v[1], d->v[2], d->w[0], d->w[1], d->w[2], splat(0), splat(0) };
    GLOBAL double *at[LANES];
    for (int i = 0; i < LANES; i++) at[i] = body_at(body, place[i]);
    for (int k = 0; k < 8; k += LANES) {
        transpose(x + k);
        for (int i = 0; i < LANES; i++) vstore(at[i] + k, vload(at[i] + k) + x[k + i]);
    }
}

/*
 * The bases, which are cheaper to compute than to load: t2 = n x t1, and, where t is NULL, t1 as
 * contact_basis() makes it, to the bit [Duff et al. 2017].
 */
ALWAYS_INLINE void bundle_basis(GLOBAL const struct bundle *c, GLOBAL const struct beside *t, int k,
                                vd n[3], vd t1[3], vd t2[3])
{
    for (int i = 0; i < 3; i++) n[i] = vload(c->n[i] + k);
    if (t) {
        for (int i = 0; i < 3; i++) t1[i] = vload(t->t1[i] + k);
    } else {
        vd sign = with_sign(splat(1), n[2]), a = -sign / (sign + n[2]);
        t1[0] = 1.0 + n[0] * n[0] * a, t1[1] = n[0] * n[1] * a, t1[2] = -sign * n[0];
    }
    for (int i = 0, j = 1, l = 2; i < 3; j = l, l = i++) t2[i] = n[j] * t1[l] - n[l] * t1[j];
}

/* u += what the springs add for the reactions r that made u~; what is rigid keeps its bits. */
ALWAYS_INLINE void bundle_soften(GLOBAL const struct rebound *e, int k, const vd r[3], vd u[3])
{
    for (int i = 0; i < 3; i++) {
        vd soft = vload(e->soft[i > 0] + k);
        u[i] = pick(lt(splat(0), soft), u[i] + soft * r[i], u[i]);
    }
}

/* u~ from the bodies' velocities, without springs, or u where e is NULL; and t1 and t2, which bundle_push() needs again */
ALWAYS_INLINE void bundle_velocity(GLOBAL const struct bundle *c, GLOBAL const struct beside *t,
                                   GLOBAL const struct rebound *e, int k, const struct twist *a,
                                   const struct twist *b, vd u[3], vd t1[3], vd t2[3])
{
    vd n[3], dv[3], m[3], la = vload(c->la + k), lb = vload(c->lb + k);
    bundle_basis(c, t, k, n, t1, t2);
    for (int i = 0; i < 3; i++) {
        dv[i] = b->v[i] - a->v[i], m[i] = la * a->w[i] + lb * b->w[i];
    }
    // w x (l n) . t1 = l w . t2, and the arm of b is -lb n
    vd un = dot3(n, dv), u1 = dot3(t1, dv) - dot3(t2, m), u2 = dot3(t2, dv) + dot3(t1, m);
    u[0] = un, u[1] = u1, u[2] = u2;
    for (int i = 0; i < 3 && e; i++) u[i] = vload(e->s[i > 0] + k) * u[i] + vload(e->offset[i] + k);
}

/* Adds to the bodies' velocities what a change dr (n, t1, t2) of the reactions makes of them. */
ALWAYS_INLINE void bundle_push(GLOBAL const struct bundle *c, int k, const vd t1[3], const vd t2[3],
                               const vd dr[3], GLOBAL struct body *body, const struct bodies *a,
                               const struct bodies *b)
{
    vd turn_a = a->ii * vload(c->la + k), turn_b = b->ii * vload(c->lb + k), im = -a->im;
    struct twist da, db;
    for (int i = 0; i < 3; i++) { // f on b; m = -n x dr turns both
        vd n = vload(c->n[i] + k);
        vd f = dr[0] * n + dr[1] * t1[i] + dr[2] * t2[i], m = dr[2] * t1[i] - dr[1] * t2[i];
        da.v[i] = im * f, da.w[i] = turn_a * m;
        db.v[i] = b->im * f, db.w[i] = turn_b * m;
    }
    bodies_add(body, c->a + k, &da), bodies_add(body, c->b + k, &db);
}

#ifndef ON_DEVICE // which has balls alone
/*
 * Bundles of contacts whose lever arms are any vectors, between bodies of any
 * inertia.
 *
 *     u_i = e_i . (v_b - v_a) + G_b,i . y_b - G_a,i . y_a,   y = I^1/2 w,   G_i = I^-1/2 (r x e_i)
 *
 * with e = (n, t1, t2), r from a body's centre to the point of contact, and I its inertia where the
 * contact acts. In y, which struct body holds in place of w, a body's inertia is 1: a change of the
 * reactions adds G^T dr, and a body stays a cache line. A body that does not move has y = w and
 * G_i = r x e_i, and keeps them. W_cc is full [solve/problem.h: block].
 */

struct levers {
    double Ga[9][BUNDLE], Gb[9][BUNDLE]; /* m (kg m^2)^-1/2: component j of G_i at 3 i + j */
};

/* As bundle_velocity() */
ALWAYS_INLINE void levers_velocity(const struct bundle *c, const struct beside *t,
                                   const struct levers *g, const struct rebound *e, int k,
                                   const struct twist *a, const struct twist *b, vd u[3], vd t1[3],
                                   vd t2[3])
{
    vd n[3], dv[3];
    bundle_basis(c, t, k, n, t1, t2);
    for (int i = 0; i < 3; i++) dv[i] = b->v[i] - a->v[i];
    u[0] = dot3(n, dv), u[1] = dot3(t1, dv), u[2] = dot3(t2, dv);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            u[i] += vload(g->Gb[3 * i + j] + k) * b->w[j] - vload(g->Ga[3 * i + j] + k) * a->w[j];
    for (int i = 0; i < 3 && e; i++) u[i] = vload(e->s[i > 0] + k) * u[i] + vload(e->offset[i] + k);
}

/* As bundle_push() */
ALWAYS_INLINE void levers_push(const struct bundle *c, const struct levers *g, int k,
                               const vd t1[3], const vd t2[3], const vd dr[3], struct body *body,
                               const struct bodies *a, const struct bodies *b)
{
    vd im = -a->im, ii = -a->ii;
    struct twist da, db;
    for (int i = 0; i < 3; i++) {
        vd f = dr[0] * vload(c->n[i] + k) + dr[1] * t1[i] + dr[2] * t2[i];
        vd ma = splat(0), mb = splat(0);
        for (int j = 0; j < 3; j++) {
            ma += vload(g->Ga[3 * j + i] + k) * dr[j];
            mb += vload(g->Gb[3 * j + i] + k) * dr[j];
        }
        da.v[i] = im * f, da.w[i] = ii * ma;
        db.v[i] = b->im * f, db.w[i] = b->ii * mb;
    }
    bodies_add(body, c->a + k, &da), bodies_add(body, c->b + k, &db);
}

#endif
#endif
