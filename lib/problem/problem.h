/*
 * problem/problem.h: one step's contact problem in the form that the sweep reads: hot rows, in bundles.
 *
 * Of a packing W is never assembled: u_c comes from the bodies' velocities, and a change of r_c goes
 * into them. Of an FCLIB problem there is only W. The sweep is one text over these two ways of
 * gathering b_c and scattering r_c.
 *
 * Newton's impact law [newtonlaw, corrected] is in the rows: the law sees
 *
 *     u~ = D^-1 (u + E u^-),  W~ = D^-1 W,  D = 1 + E,  E = diag(e_n, e_t, e_t).
 *
 * For balls and discs the lever arms lie along n, hence W~_cc = diag(w_n, w_t, w_t).
 *
 * Row i is lane i % 8 of bundle i / 8. What does not move has a copy of its own in every contact: two
 * contacts of a group then share no body at all, and all are written alike.
 */
#ifndef NSD_PROBLEM_H
#define NSD_PROBLEM_H

#include "bodies/contact.h"
#include "bodies/packing.h"
#include "problem/bundle.h"
#include "problem/delassus.h"
#include "problem/schedule.h"

/* Bundles of 1.2 MB: of more, none is in a near cache when a sweep comes back to it. */
enum { FAR_BUNDLES = 1024 };

struct problem {
    int d;
    int64_t n;               /* contacts */
    int64_t bundles, slots;  /* 8 slots a bundle, some without a contact */
    struct bundle *bundle;   /* [bundles] in the order of the sweep */
    struct rebound *rebound; /* [bundles]; NULL: e_n = e_t = 0 everywhere */
    double (*u)[3][BUNDLE];  /* [bundles] m/s: what the local method believes */
    int32_t *contact;        /* [rows] row i is contact[i] of the packing, of W; -1: none */
    int64_t groups;          /* no two rows of a group share a body (a block of W): */
    int64_t *group;          /* [groups + 1] bundles group[g] .. group[g+1]-1 may be done at once */
    struct two_thread_split *split; /* NULL: the order knows none */
    int64_t bodies;                 /* 0: given by W */
    struct body *body; /* [bodies] the packing's, by colours as the sweep first meets them, and
                           copies of what does not move; NULL: given by W */
    const struct packing *packing; /* borrowed: its velocities are those before the step */
    int32_t *seat;                 /* [packing->n] body i of the packing is body[seat[i]] */
    struct delassus *W;            /* borrowed; NULL: given by bodies */
    struct delassus sorted;        /* given by W: its rows as they are here */
    bool full;                     /* given by W, and some W_cc is more than diag(w_n, w_t, w_t) */
    double dt;      /* s: the paper's forces are r / dt; 1 where there are no steps */
    double scale_v; /* m/s and */
    double scale_r; /* N s: what the scaled errors are measured in: g dt and m g dt */
    double fall;    /* m/s: |g| dt */
    double norm_q;  /* m/s: |u~_free| of all contacts, |q| */
    double speed;   /* m/s: the fastest that anything is before the step; given by W 0 */
};

/*
 * The slots of a packing's contacts; r from the contacts when they are solved, else 0, with the
 * bodies at v_free + M^-1 P r. rho = alpha m_red when alpha > 0, else factor/lambda_max(W~_cc).
 */
int problem_prepare(struct problem *, const struct packing *, const struct contacts *, double alpha,
                    double rho_factor, enum order, struct why *);
/* The same of a problem given by W; r from W->r. */
int problem_prepare_delassus(struct problem *, struct delassus *, double alpha, double rho_factor,
                             enum order, struct why *);
void problem_free(struct problem *p);

/* Of a packing: the bodies get their velocities before the step and dt g, as without any reaction. */
void problem_set_free_motion(struct problem *p);

/* How many of these threads share a sweep: all, or where the groups are too small for that, one, or one a
   half. */
int problem_team(const struct problem *p, int threads);

/* What was found, slot by slot, into the contacts; -1 when memory is short. */
int problem_store(const struct problem *, struct contacts *);

/* Row i: its bundle and lane; its r and u. */
static inline struct bundle *slot_bundle(const struct problem *p, int64_t i)
{
    return &p->bundle[i / BUNDLE];
}
static inline int slot_lane(int64_t i)
{
    return (int)(i % BUNDLE);
}
static inline struct rebound *slot_rebound(const struct problem *p, int64_t i)
{
    return p->rebound ? &p->rebound[i / BUNDLE] : NULL;
}
void slot_get(const struct problem *, int64_t i, double r[3], double u[3]);
void slot_set(struct problem *, int64_t i, const double r[3], const double u[3]);

/* 1/rho_a of the natural map: the largest eigenvalue of the rows' W~_cc */
ALWAYS_INLINE vd bundle_lambda(const struct bundle *c, int k)
{
    return larger(vload(c->w[0] + k), vload(c->w[1] + k));
}

/* u~ of lanes k.. of c from these bodies' velocities */
ALWAYS_INLINE void body_velocity(struct body *body, const struct bundle *c, const struct rebound *e,
                                 int k, vd u[3])
{
    struct bodies a, b;
    struct twist ma, mb;
    vd t2[3];
    bodies_load(&a, body, c->a + k, &ma), bodies_load(&b, body, c->b + k, &mb);
    bundle_velocity(c, e, k, &ma, &mb, u, t2);
}

/* Reactions changed by dr move these bodies. */
ALWAYS_INLINE void body_push(struct body *body, const struct bundle *c, int k, const vd dr[3])
{
    struct bodies a, b;
    struct twist ma, mb;
    vd n[3], t1[3], t2[3];
    bodies_load(&a, body, c->a + k, &ma), bodies_load(&b, body, c->b + k, &mb);
    bundle_basis(c, k, n, t1, t2);
    bundle_push(c, k, t2, dr, body, &a, &b);
}

#endif
