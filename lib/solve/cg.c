/*
 * solve/cg.c: the conjugate gradient method for frictional contact [RA04], with nothing assembled.
 *
 * With the friction bounds b = mu r_n held, Coulomb's problem is
 *
 *     min 1/2 r.W r + q.r,     r_n >= 0,  |r_t| <= b,
 *
 * with gradient u; when this is solved well enough the bounds are computed anew from r (the
 * quasi-optimisation). A step goes along p to the minimum on that line, and r is projected onto the
 * bounds. The new direction is
 *
 *     w = proj(-u),   z = proj(p),   p = w + beta z,   beta = -w.W p / p.W p,
 *
 * with proj onto the directions in which r may go: r_n not below 0, r_t not out of its disc.
 * Reactions are scaled by s = 1/sqrt(lambda_max(W_cc)), which serves as a preconditioner.
 *
 * Departures from the paper, without which packings do not get below 1e-2: after a step in which a
 * contact has changed its status, the next goes along -u itself, as far as the last changes of r
 * and u suggest (the spectral length), since on small discs it is the outward part of -u that turns
 * r_t; W p includes the curvature of the discs; a step that makes the energy larger than in all of
 * the last ten is shortened; and the bounds are held for up to a hundred steps, not for one.
 */
#include "solve/apply.h"
#include "solve/backend.h"
#include "solve/solver.h"

#include <stdlib.h>
#include <string.h>

enum {
    JUDGE_EVERY = 10, /* steps from one judgement to the next */
    PAST = 10,        /* steps: the energy may rise to the largest after these */
    INNER = 100       /* steps for which the bounds are held, at most */
};
#define FALL       1e-4  /* at first: a fall of |w|^2 after which the bounds are renewed */
#define FALL_LEAST 1e-10 /* the smallest such fraction */

enum cg_hold { OPEN = 1, BORDER = 2 }; /* r_n = 0; r_t on the border of its disc */

struct cg {
    struct solve *s;
    double *room;
    double *r, *u;               /* [slots][3] scaled reactions and velocities */
    double *w, *p, *Wp;          /* [slots][3] directions; the change of u along p */
    double *r_before, *way_back; /* [slots][3] r before the last step, and the way back there */
    double *x, *y;         /* [slots][3] unscaled: reactions, and what W makes of a direction */
    double *scale, *bound; /* [slots] s; b, scaled */
    int8_t *status;        /* [slots] which bounds r has reached: enum hold */
    bool conjugate;  /* the next step is one of conjugate gradients, not of the spectral length */
    double spectral; /* |dr|^2 / dr.du of the last step */
    double energy, past[PAST]; /* since the bounds last changed; after the last steps */
    struct apply apply;        /* room for W p */
};

static void cg_free(struct cg *a)
{
    free(a->room), free(a->status), apply_free(&a->apply);
}

static int cg_init(struct cg *a, struct solve *s)
{
    struct problem *p = s->p;
    size_t slots = (size_t)p->slots;
    *a = (struct cg){ .s = s, .spectral = 1 };
    a->room = calloc(29 * slots + 1, sizeof *a->room);
    a->status = calloc(slots + 1, sizeof *a->status);
    if (!a->room || !a->status || apply_init(&a->apply, p)) {
        cg_free(a);
        return -1;
    }
    a->r = a->room, a->w = a->r + 3 * slots, a->p = a->w + 3 * slots, a->Wp = a->p + 3 * slots;
    a->u = a->Wp + 3 * slots, a->scale = a->u + 3 * slots, a->bound = a->scale + slots;
    a->r_before = a->bound + slots, a->way_back = a->r_before + 3 * slots;
    a->x = a->way_back + 3 * slots, a->y = a->x + 3 * slots;
    for (int64_t i = 0; i < p->slots; i++) {
        double u[3], lambda = slot_lambda(p, i);
        if (p->contact[i] < 0) continue;
        a->scale[i] = lambda > 0 ? 1 / sqrt(lambda) : 1;
        slot_get(p, i, a->r + 3 * i, u);
        for (int k = 0; k < 3; k++) a->r[3 * i + k] /= a->scale[i];
    }
    return 0;
}

/* Wp = s W s p, plus the curvature of the discs' borders; returns p.W p */
static double cg_apply(struct cg *a)
{
    const struct problem *p = a->s->p;
    double sum = 0;
    for (int64_t i = 0; i < 3 * p->slots; i++) a->x[i] = a->scale[i / 3] * a->p[i];
    problem_apply(p, &a->apply, a->x, a->y);
    for (int64_t i = 0; i < p->slots; i++) {
        if (p->contact[i] < 0) continue;
        const double *v = a->u + 3 * i, *r = a->r + 3 * i;
        double b2 = a->bound[i] * a->bound[i], bend = -(v[1] * r[1] + v[2] * r[2]);
        bend = a->status[i] & BORDER && b2 > 0 && bend > 0 ? bend / b2 : 0;
        for (int k = 0; k < 3; k++) {
            a->Wp[3 * i + k] = a->scale[i] * a->y[3 * i + k] + (k ? bend * a->p[3 * i + k] : 0);
            sum += a->p[3 * i + k] * a->Wp[3 * i + k];
        }
    }
    return sum;
}

/* Takes out of x, at slot i, what leads out of the bounds. */
static void keep_admissible(const struct cg *a, int64_t i, double x[3])
{
    const double *r = a->r + 3 * i;
    if (a->status[i] & OPEN && x[0] < 0) x[0] = 0;
    if (!(a->status[i] & BORDER)) return;
    double b2 = a->bound[i] * a->bound[i], out = x[1] * r[1] + x[2] * r[2];
    if (b2 == 0) x[1] = x[2] = 0;
    if (b2 == 0 || out <= 0) return;
    x[1] -= out / b2 * r[1], x[2] -= out / b2 * r[2];
}

/*
 * r = r + step p, projected onto the bounds; it becomes the iterate, with its u. *fall: the
 * decrease of the energy, -(u + u').(r' - r)/2. Returns whether the status of a contact has
 * changed.
 */
static bool cg_advance(struct cg *a, const double *p, double step, double *fall)
{
    struct problem *prob = a->s->p;
    bool changed = false;
    double dr2 = 0, drdu = 0;
    *fall = 0;
    for (int64_t i = 0; i < prob->slots; i++) {
        double *r = a->r + 3 * i, *was = a->r_before + 3 * i;
        if (prob->contact[i] < 0) continue;
        for (int k = 0; k < 3; k++) was[k] = r[k], r[k] += step * p[3 * i + k];
        double t = sqrt(r[1] * r[1] + r[2] * r[2]), b = a->bound[i];
        int hold = (r[0] <= 0 ? OPEN : 0) | (t >= b * (1 - 1e-12) ? BORDER : 0);
        if (r[0] <= 0) r[0] = 0;
        if (t > b) r[1] *= b / t, r[2] *= b / t;
        changed |= hold != a->status[i], a->status[i] = (int8_t)hold;
        for (int k = 0; k < 3; k++) a->x[3 * i + k] = a->scale[i] * r[k];
    }
    solve_react(a->s, a->x);
    backend_widest()->judge->velocities(prob, 0, prob->bundles);
    for (int64_t i = 0; i < prob->slots; i++) {
        double r[3], u[3];
        if (prob->contact[i] < 0) continue;
        slot_get(prob, i, r, u);
        for (int k = 0; k < 3; k++) {
            double v = a->scale[i] * u[k], *old = a->u + 3 * i + k;
            double dr = a->r[3 * i + k] - a->r_before[3 * i + k];
            *fall -= 0.5 * (v + *old) * dr;
            dr2 += dr * dr, drdu += dr * (v - *old);
            *old = v;
        }
    }
    if (dr2 > 0) a->spectral = drdu > 0 ? dr2 / drdu : 1;
    return changed;
}

/* w = proj(-u); returns |w|^2, and w.W p */
static double find_descent(struct cg *a, double *wWp)
{
    double w2 = 0;
    *wWp = 0;
    for (int64_t i = 0; i < a->s->p->slots; i++) {
        double *w = a->w + 3 * i;
        if (a->s->p->contact[i] < 0) continue;
        for (int k = 0; k < 3; k++) w[k] = -a->u[3 * i + k];
        keep_admissible(a, i, w);
        for (int k = 0; k < 3; k++) w2 += w[k] * w[k], *wWp += w[k] * a->Wp[3 * i + k];
    }
    return w2;
}

/* p = w + beta proj(p), or -u; returns p.w, the rate of descent */
static double choose_direction(struct cg *a, double beta)
{
    double sum = 0;
    for (int64_t i = 0; i < a->s->p->slots; i++) {
        double *x = a->p + 3 * i;
        if (a->s->p->contact[i] < 0) continue;
        if (a->conjugate) keep_admissible(a, i, x);
        for (int k = 0; k < 3; k++) {
            x[k] = a->conjugate ? a->w[3 * i + k] + beta * x[k] : -a->u[3 * i + k];
            sum += x[k] * a->w[3 * i + k];
        }
    }
    return sum;
}

/* Renews the bounds from r, projects r_t, and starts the minimisation again; returns |w|^2. */
static double renew_bounds(struct cg *a)
{
    const struct problem *p = a->s->p;
    double fall, wWp;
    for (int64_t i = 0; i < p->slots; i++)
        a->bound[i] = slot_bundle(p, i)->mu[slot_lane(i)] * a->r[3 * i];
    cg_advance(a, a->p, 0, &fall);
    a->energy = 0, a->conjugate = false;
    for (int k = 0; k < PAST; k++) a->past[k] = 0;
    return find_descent(a, &wWp);
}

/* Judges the iterate if that is due; true when the solve is over. */
static bool judge_if_due(struct cg *a, bool due)
{
    struct solve *s = a->s;
    if (!due && s->rep->sweeps % JUDGE_EVERY && s->rep->sweeps < s->o->max_sweeps &&
        !s->o->every_sweep)
        return false;
    solve_judge(s);
    return solve_over(s) || !isfinite(s->value);
}

/* One step; returns 1 when the solve is over, -1 when memory is short. *w2: |w|^2 after it */
static int cg_step(struct cg *a, double *w2)
{
    double slope = 0, curve = 1, fall, wWp, length = a->spectral, worst = a->past[0];
    for (int k = 1; k < PAST; k++) worst = fmax(worst, a->past[k]);
    if (a->conjugate) curve = cg_apply(a);
    for (int64_t i = 0; i < 3 * a->s->p->slots; i++) slope += a->p[i] * a->w[i];
    if (a->conjugate && curve > 0) length = slope / curve;
    if (!(length > 0)) length = 1;
    bool changed = cg_advance(a, a->p, length, &fall);
    for (int k = 0; !(a->energy - fall <= worst) && k < 30; k++) {
        // the projection made it worse: back, and less far along -u
        double none;
        for (int64_t i = 0; i < 3 * a->s->p->slots; i++) a->way_back[i] = a->r_before[i] - a->r[i];
        cg_advance(a, a->way_back, 1, &none);
        length /= 4;
        for (int64_t i = 0; i < 3 * a->s->p->slots; i++) a->p[i] = -a->u[i];
        cg_advance(a, a->p, length, &fall), changed = true;
    }
    a->energy -= fall, a->past[a->s->rep->sweeps % PAST] = a->energy;
    *w2 = find_descent(a, &wWp);
    double beta = a->conjugate && !changed ? fmax(-wWp / curve, 0) : 0;
    a->conjugate = !changed;
    if (!(choose_direction(a, beta) > 0)) choose_direction(a, 0);
    a->s->rep->sweeps++, a->s->rep->work += price_sweep(a->s->p);
    if (solve_history(a->s)) return -1;
    return judge_if_due(a, false);
}

static int cg_run(struct solve *s)
{
    struct cg a;
    s->believes = false;
    if (solve_keep_best(s) || cg_init(&a, s)) return -1;
    int over = 0;
    double fall = FALL, last = INFINITY;
    while (!over) {
        double start = renew_bounds(&a), now = start;
        int k = 0;
        if (start > last / 2)
            fall = fmax(fall / 10, FALL_LEAST); // solve more exactly between bounds
        last = start;
        choose_direction(&a, 0);
        for (; k < INNER && now > fall * start && !over; k++) over = cg_step(&a, &now);
        if (over || k) continue;
        renew_bounds(&a), judge_if_due(&a, true); // no direction leads on
        over = 1;
    }
    cg_free(&a);
    return over < 0 ? -1 : 0;
}

const struct solver solver_cg = { "cg", "conjugate gradients, with nothing assembled", 0, cg_run };
