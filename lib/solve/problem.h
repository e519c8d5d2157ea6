/*
 * solve/problem.h: one step's contact problem in the form that the sweep reads, in bundles.
 *
 * For a packing W is never assembled: u_c is computed from the bodies' velocities, and a change of
 * r_c is added to them. For an FCLIB problem there is only W. The sweep is written once over these
 * two ways of computing b_c and passing on r_c.
 *
 * Newton's impact law [newtonlaw, corrected] is part of the bundles: the local methods see
 *
 *     u~ = D^-1 (u + E u^-),  W~ = D^-1 W,  D = 1 + E,  E = diag(e_n, e_t, e_t).
 *
 * For balls and discs the lever arms lie along n, hence W~_cc = diag(w_n, w_t, w_t). Where any body of
 * a contact has another shape, all bundles have levers [solve/bundle.h], W_cc is full, and, so that it
 * is symmetric, u in the slots is D u~, as it is where W is given.
 *
 * Slot i is lane i % 8 of bundle i / 8. Each contact has a copy of its own of a body that does not
 * move: the contacts of a group then share no body at all, and all bodies are written back alike.
 */
#pragma once

#include "solve/bundle.h"
#include "solve/coupling.h"
#include "solve/delassus.h"
#include "solve/extra.h"
#include "solve/kind.h"
#include "solve/schedule.h"
#include "state/contact.h"
#include "state/packing.h"

enum {
    FAR_BUNDLES = 1024 /* bundles, 0.8 MB: more do not stay in a near cache from sweep to sweep */
};

struct exchange;
struct mass_splitting;
struct device;
struct plan;

struct problem {
    struct problem_kind kind; /* a row of problem_kinds: which arrays there are */
    int d;
    int64_t n;                  /* contacts, of all processes */
    int64_t bundles, slots;     /* slots: 8 a bundle, some without a contact */
    struct bundle *bundle;      /* [bundles] in the order of the sweep: see bundle_at() */
    double (*w)[2][BUNDLE];     /* [bundles] kg^-1: W~_cc, normal and tangential; of a full W_cc,
                               lambda_max twice */
    double (*rho)[BUNDLE];      /* [bundles] kg: the step of the projections */
    double (*block)[9][BUNDLE]; /* [bundles] kg^-1: W_cc, full; NULL: between balls */
    struct rebound *rebound;    /* [bundles]; NULL: e_n = e_t = 0 everywhere, and no offset */
    struct levers *lever;       /* [bundles]; NULL: balls, or given by W */
    struct extra_levers *turn;  /* [bundles] the same between bodies with levers; else NULL */
    struct extra *extra;    /* [bundles]; NULL: no contact is bonded, none has rolling friction */
    struct extra *in_W;     /* [bundles] K and a of bonds that W has in it; NULL: none */
    double (*u)[3][BUNDLE]; /* [bundles] m/s: what the local method believes */
    int32_t *contact;       /* [slots] slot i is contact[i] of the packing or of W; -1: none */
    int64_t groups;         /* no two contacts of a group share a body (a block of W): */
    int64_t *group;         /* [groups + 1] bundles group[g] .. group[g+1]-1 may be done at once */
    struct plan *plan;      /* has contact, group and seat; NULL: it is kept, not of the problem */
    struct two_thread_split *split; /* NULL: the order has no halves */
    struct exchange
        *exchange;         /* borrowed: the other processes that have a part of it; NULL: none */
    struct device *device; /* borrowed: it has the iterate [solve/device.h]; NULL: the slots have */
    struct mass_splitting
        *brake;        /* slots that the sweeps have to solve by shorter steps; NULL: none */
    int64_t bodies;    /* of body[]; 0: given by W */
    struct body *body; /* [bodies] the packing's, by colours in the order in which the sweep first
                          meets them, and copies of what does not move; NULL: given by W */
    const struct packing *packing; /* borrowed: its velocities are those before the step; NULL:
                                      there is only W */
    vec3 *spin;                    /* [packing->n] y before the reactions; NULL without levers */
    double *pull;                  /* [slots] N s: of cohesion, against n; NULL: none */
    struct body *
        held; /* [bodies - packing->n] those beyond the packing's, which do not move, as they were */
    int32_t *seat;              /* [packing->n] body i of the packing is body[seat[i]] */
    struct couplings *coupling; /* what freedoms the packing has beyond its bodies; NULL: none */
    struct delassus *W;         /* NULL: given by bodies */
    struct delassus *own;       /* W where the problem is to free it, else NULL: W is borrowed */
    struct delassus sorted;     /* given by W: its block rows in the order of the slots */
    double dt;                  /* s: the paper's forces are r / dt; 1 where there are no steps */
    double scale_v;             /* m/s: the unit of velocities in scaled errors, g dt */
    double scale_r;             /* N s: that of reactions, m g dt */
    double fall;                /* m/s: |g| dt */
    double unit;           /* m/s: the scene's own velocity, in which CRITERION_VELOCITY counts */
    double mean_q, most_q; /* m/s: |u~_free| of a contact, the mean and the largest */
    double heaviest;       /* kg: the largest mass that a contact moves; 0: unknown */
    double endless
        [2]; /* m/s, N s: lambda r and r of a contact whose reaction grows without end are larger
                          than both [solve/judge.h] */
    double
        rounded; /* m/s: what a contact with a larger lambda r misses the law by is rounding, at least */
    double wild;   /* m/s: where contacts miss the law by more, reactions do not hold one another */
    double norm_q; /* m/s: |u~_free| of all contacts, |q| */
    double speed;  /* m/s: the fastest point before the step, plus g dt; 0: there is only W */
};

struct prepare_opt {
    double alpha;      /* rho = alpha m_red; 0: */
    double rho_factor; /* rho = rho_factor/lambda_max(W~_cc) */
    enum order order;
    struct plan **
        kept; /* a plan of the caller, used where it holds, else replaced by a new one, to be freed after
                           the problem [solve/plan.h]; *kept may be NULL. NULL: the problem has its own */

    /* Of a part of a problem; both NULL: of a whole one */
    const struct schedule *schedule; /* lays out the bundles, in place of `order` */
    struct exchange *exchange;       /* its after_group is called for the groups of the schedule */
};

/*
 * The problem of a packing's contacts, in bundles of bodies: freedoms beyond theirs keep their
 * speed here [solve/prepare.h has the problem in which they do not]. r from the contacts where
 * they are solved, else 0, and the bodies at v_free + M^-1 P r. Borrows pack. Returns 0,
 * EX_SOFTWARE, or EX_DATAERR where there are too many bodies, with nothing to free.
 */
int problem_prepare(struct problem *p, const struct packing *pack, const struct contacts *s,
                    const struct prepare_opt *o, struct failure *failure);
/* The same for a problem given by W, which it borrows; r from W->r. It is whole, and has a plan of its own. */
int problem_prepare_delassus(struct problem *p, struct delassus *W, const struct prepare_opt *o,
                             struct failure *failure);
void problem_free(struct problem *p);

/* What of an iterate is beyond r: z and m of a slot's contact */
enum { BESIDE_R = 6 };
void slot_get_beyond(const struct problem *p, int64_t i, double x[BESIDE_R]);
void slot_set_beyond(struct problem *p, int64_t i, const double x[BESIDE_R]);

/* Sets the bodies of a packing to v_free, their velocities before the step plus dt g, what the flow
   of the cell's edges gains, and what cohesion pulls. */
void problem_set_free_motion(struct problem *p);

/* Sets unit and endless from mean_q, most_q, fall and heaviest. */
void problem_set_unit(struct problem *p);
/* Is lambda r of a contact one that grows without end? */
bool problem_is_endless(const struct problem *p, double lambda, double r);

/* How many of these threads are to share a sweep: all where the groups are large enough, else two
   where the order has halves, else one */
int problem_team(const struct problem *p, int threads);

/* Stores r, u and the status of each contact of a packing in s->found; -1 when memory is short. */
int problem_store(const struct problem *p, struct contacts *s);

/* Bundle i, and what is behind it (NULL: nothing). It is so of all but balls without anything beyond that are
   too many for a near cache, and of problems given by W. */
ALWAYS_INLINE struct bundle *bundle_at(const struct problem *p, int64_t i)
{
    return p->kind.near ? &((struct near_bundle *)p->bundle)[i].bundle : &p->bundle[i];
}
ALWAYS_INLINE struct beside *bundle_beside(const struct problem *p, const struct bundle *c)
{
    return p->kind.near ? &((struct near_bundle *)c)->beside : NULL;
}

/* An array of a problem that has one element per bundle: x[bundles], of `size` bytes each; NULL: not of its kind */
struct array_of {
    void *x;
    size_t size;
};
struct array_of problem_array(const struct problem *p, enum array which);
void problem_set_array(struct problem *p, enum array which, void *x); /* x is freed with p */

/* Bytes from one bundle to the next */
static inline size_t bundle_size(const struct problem *p)
{
    return p->kind.near ? sizeof(struct near_bundle) : sizeof(struct bundle);
}

/* The bundle and the lane of slot i, its impact law (NULL: none), its r (N s) and u (m/s) */
static inline struct bundle *slot_bundle(const struct problem *p, int64_t i)
{
    return bundle_at(p, i / BUNDLE);
}
/* How many contacts a bundle has */
static inline int bundle_contacts(const struct problem *p, int64_t bundle)
{
    int n = 0;
    for (int k = 0; k < BUNDLE; k++) n += p->contact[bundle * BUNDLE + k] >= 0;
    return n;
}
static inline int slot_lane(int64_t i)
{
    return (int)(i % BUNDLE);
}
static inline struct rebound *slot_rebound(const struct problem *p, int64_t i)
{
    return p->rebound ? &p->rebound[i / BUNDLE] : NULL;
}
struct extra_levers *slot_turn(const struct problem *p, int64_t i); /* NULL: balls */
/* The slot with what is beyond it, of a problem in which there is anything */
struct extra_lane slot_extra(const struct problem *p, int64_t i);
void slot_get(const struct problem *p, int64_t i, double r[3], double u[3]);
void slot_set(struct problem *p, int64_t i, const double r[3], const double u[3]);

/* Bundles of all processes; whether all contacts are swept by halves */
int64_t problem_bundles(const struct problem *p);
bool problem_halves(const struct problem *p);

/* Whether u in the slots is D u~ */
static inline bool problem_undivided(const struct problem *p)
{
    return p->kind.given_by_W || p->kind.levers;
}

/* The largest eigenvalue of W~_cc: 1/rho_a of the natural map; of lanes k.. of bundle i, of slot i */
ALWAYS_INLINE vd bundle_lambda(const struct problem *p, int64_t i, int k)
{
    return larger(vload(p->w[i][0] + k), vload(p->w[i][1] + k));
}

static inline double slot_lambda(const struct problem *p, int64_t i)
{
    const double(*w)[BUNDLE] = (const double(*)[BUNDLE])p->w[i / BUNDLE];
    int k = slot_lane(i);
    return w[0][k] > w[1][k] ? w[0][k] : w[1][k];
}

/* The impact law of bundle i; NULL: none */
ALWAYS_INLINE const struct rebound *bundle_rebound(const struct problem *p, int64_t i)
{
    return p->rebound ? &p->rebound[i] : NULL;
}

/* As bundle_soften(), with the reactions that the bundle has */
ALWAYS_INLINE void problem_soften(const struct bundle *c, const struct rebound *e, int k, vd u[3])
{
    vd r[3];
    for (int i = 0; i < 3; i++) r[i] = vload(c->r[i] + k);
    bundle_soften(e, k, r, u);
}

/* u~ of lanes k.. of c from the velocities of body[], or u where e is NULL; between balls */
ALWAYS_INLINE void body_velocity(const struct problem *p, struct body *body, const struct bundle *c,
                                 const struct rebound *e, int k, vd u[3])
{
    struct bodies a, b;
    struct twist ma, mb;
    vd t1[3], t2[3];
    bodies_load(&a, body, c->a + k, &ma), bodies_load(&b, body, c->b + k, &mb);
    bundle_velocity(c, bundle_beside(p, c), e, k, &ma, &mb, u, t1, t2);
    if (e && p->kind.soft) problem_soften(c, e, k, u);
}

/* Adds to the velocities of body[] what a change dr of the reactions makes of them. */
ALWAYS_INLINE void body_push(const struct problem *p, struct body *body, const struct bundle *c,
                             int k, const vd dr[3])
{
    struct bodies a, b;
    struct twist ma, mb;
    vd n[3], t1[3], t2[3];
    bodies_load(&a, body, c->a + k, &ma), bodies_load(&b, body, c->b + k, &mb);
    bundle_basis(c, bundle_beside(p, c), k, n, t1, t2);
    bundle_push(c, k, t1, t2, dr, body, &a, &b);
}

/* Both for bundle i, whether the problem has levers or not */
ALWAYS_INLINE void problem_velocity(const struct problem *p, struct body *body, int64_t i,
                                    const struct rebound *e, int k, vd u[3])
{
    struct bodies a, b;
    struct twist ma, mb;
    vd t1[3], t2[3];
    const struct bundle *c = bundle_at(p, i);
    if (!p->kind.levers) {
        body_velocity(p, body, c, e, k, u);
        return;
    }
    bodies_load(&a, body, c->a + k, &ma), bodies_load(&b, body, c->b + k, &mb);
    levers_velocity(c, bundle_beside(p, c), &p->lever[i], e, k, &ma, &mb, u, t1, t2);
    if (e && p->kind.soft) problem_soften(c, e, k, u);
}

ALWAYS_INLINE void problem_push(const struct problem *p, struct body *body, int64_t i, int k,
                                const vd dr[3])
{
    struct bodies a, b;
    struct twist ma, mb;
    vd n[3], t1[3], t2[3];
    const struct bundle *c = bundle_at(p, i);
    if (!p->kind.levers) {
        body_push(p, body, c, k, dr);
        return;
    }
    bodies_load(&a, body, c->a + k, &ma), bodies_load(&b, body, c->b + k, &mb);
    bundle_basis(c, bundle_beside(p, c), k, n, t1, t2);
    levers_push(c, &p->lever[i], k, t1, t2, dr, body, &a, &b);
}
