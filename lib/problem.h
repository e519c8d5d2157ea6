/*
 * problem.h: one step's contact problem in the form that the sweep reads: hot rows.
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
 */
#ifndef NSD_PROBLEM_H
#define NSD_PROBLEM_H

#include "contact.h"
#include "delassus.h"
#include "local.h"
#include "packing.h"
#include "schedule.h"

struct body {
    double v[3], w[3]; /* m/s, rad/s */
    double im, ii;     /* 1/kg, 1/(kg m^2); 0: immovable, read but never written */
};

struct row {
    double n[3], t1[3], t2[3];
    double la, lb; /* m: centre of a to the point along n, and from the point to the centre of b */
    double w[2];   /* kg^-1: W~_cc, normal and tangential; of a W both are lambda_max(W_cc) */
    double s[2];   /* 1/(1 + e_n), 1/(1 + e_t) */
    double offset[3]; /* m/s: D^-1 E u^- */
    double mu, rho;   /* -, kg */
    double r[3];      /* N s */
    double u[3];      /* m/s: what the local method believes */
    int32_t a, b;     /* rows of body[] */
};

struct problem {
    int d;
    int64_t n;          /* contacts */
    struct row *row;    /* [n] in the order of the sweep */
    int64_t *contact;   /* [n] row i is contact[i] of the packing, of W */
    int64_t groups;     /* no two rows of a group share a movable body (a block of W): */
    int64_t *group;     /* [groups + 1] rows group[g] .. group[g+1]-1 may be done at once */
    struct body *body;  /* [bodies, then walls]; NULL: given by W */
    struct delassus *W; /* borrowed; NULL: given by bodies */
    double dt;          /* s: the paper's forces are r / dt; 1 where there are no steps */
    double scale_v;     /* m/s and */
    double scale_r;     /* N s: what the scaled errors are measured in: g dt and m g dt */
    double norm_q;      /* m/s: |u~_free| of all contacts, |q| */
};

/*
 * The rows of a packing's contacts; r from the contacts when they are solved, else 0, with the
 * bodies at v_free + M^-1 P r. rho = alpha m_red when alpha > 0, else factor/lambda_max(W~_cc).
 */
int problem_prepare(struct problem *, const struct packing *, const struct contacts *, double alpha,
                    double rho_factor, enum order, struct why *);
/* The same of a problem given by W; r from W->r. */
int problem_prepare_delassus(struct problem *, struct delassus *, double alpha, double rho_factor,
                             enum order, struct why *);
void problem_free(struct problem *);

/* r, u and status of every row into its contact. */
void problem_store(const struct problem *, struct contacts *);

/* The lever arms la, lb of a contact (0 for a wall), as the rows have them. */
void problem_arms(const struct packing *, const struct contact *, double *la, double *lb);

/* 1/rho_a of the natural map: the largest eigenvalue of the row's W~_cc */
static inline double row_lambda(const struct row *c)
{
    return fmax(c->w[0], c->w[1]);
}

/* u~ of row i from the bodies' velocities as they are now */
static inline void body_velocity(const struct problem *p, const struct row *c, double u[3])
{
    const struct body *a = &p->body[c->a], *b = &p->body[c->b];
    double dv[3], m[3];
    for (int k = 0; k < 3; k++) dv[k] = b->v[k] - a->v[k], m[k] = c->la * a->w[k] + c->lb * b->w[k];
    double un = c->n[0] * dv[0] + c->n[1] * dv[1] + c->n[2] * dv[2];
    double u1 = c->t1[0] * dv[0] + c->t1[1] * dv[1] + c->t1[2] * dv[2];
    double u2 = c->t2[0] * dv[0] + c->t2[1] * dv[1] + c->t2[2] * dv[2];
    // w x (l n) . t1 = l w . t2, and the arm of b is -lb n
    u1 -= c->t2[0] * m[0] + c->t2[1] * m[1] + c->t2[2] * m[2];
    u2 += c->t1[0] * m[0] + c->t1[1] * m[1] + c->t1[2] * m[2];
    u[0] = c->s[0] * un + c->offset[0];
    u[1] = c->s[1] * u1 + c->offset[1];
    u[2] = c->s[1] * u2 + c->offset[2];
}

/* The local problem of row i as it stands. */
static inline void problem_gather(const struct problem *p, int64_t i, struct local *l)
{
    const struct row *c = &p->row[i];
    l->d = p->d;
    l->mu = c->mu, l->rho = c->rho;
    for (int k = 0; k < 3; k++) l->r[k] = c->r[k];
    if (p->W) {
        l->W = p->W->diag + 9 * p->contact[i];
        for (int k = 0; k < 3; k++) l->w[k] = l->W[4 * k];
        delassus_gather(p->W, p->contact[i], l->b);
        return;
    }
    l->W = NULL;
    l->w[0] = c->w[0], l->w[1] = l->w[2] = c->w[1];
    body_velocity(p, c, l->b);
    for (int k = 0; k < 3; k++) l->b[k] -= l->w[k] * c->r[k];
}

/* A reaction changed by dr (n, t1, t2) moves the bodies. */
static inline void body_push(const struct problem *p, const struct row *c, const double dr[3])
{
    struct body *a = &p->body[c->a], *b = &p->body[c->b];
    double f[3], m[3]; // on b; m = -n x dr turns both
    for (int k = 0; k < 3; k++) {
        f[k] = dr[0] * c->n[k] + dr[1] * c->t1[k] + dr[2] * c->t2[k];
        m[k] = dr[2] * c->t1[k] - dr[1] * c->t2[k];
    }
    double turn_a = a->ii * c->la, turn_b = b->ii * c->lb;
    if (a->im > 0)
        for (int k = 0; k < 3; k++) a->v[k] -= a->im * f[k], a->w[k] += turn_a * m[k];
    if (b->im > 0)
        for (int k = 0; k < 3; k++) b->v[k] += b->im * f[k], b->w[k] += turn_b * m[k];
}

/* The local solution into row i, its bodies or W's reactions. */
static inline void problem_scatter(struct problem *p, int64_t i, const struct local *l)
{
    struct row *c = &p->row[i];
    if (p->W) {
        double *r = p->W->r + p->d * p->contact[i];
        for (int k = 0; k < p->d; k++) r[k] = l->r[k];
    } else {
        double dr[3] = { l->r[0] - c->r[0], l->r[1] - c->r[1], l->r[2] - c->r[2] };
        body_push(p, c, dr);
    }
    for (int k = 0; k < 3; k++) c->r[k] = l->r[k], c->u[k] = l->u[k];
}

#endif
