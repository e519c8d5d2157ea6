/* solve/fill.c: slots of balls, with levers, and what bonds and moments add [solve/fill.h]. */
#include "solve/fill.h"

#include "contact/spring.h"
#include "solve/problem.h"
#include "state/kinematics.h"
#include "state/offset.h"
#include "state/rotation.h"

/* The body at a place, so many times lighter */
static struct body lighter(const struct problem *p, int32_t place, double times)
{
    struct body b = p->body[body_index(place)];
    b.im *= times, b.ii *= times;
    return b;
}

/* un: u^-_n, m/s */
static void add_offset(struct rebound *e, int k, const struct packing *pack,
                       const struct contact *c, double un)
{
    e->offset[0][k] += offset_of(pack, c, un) / (1 + c->en);
}

struct lattice lattice_of(const struct packing *pack)
{
    struct lattice l;
    cell_predict(&pack->cell, step_ahead(pack), l.edge);
    for (int k = 0; k < 3; k++) l.before[k] = pack->cell.rate[k];
    cell_next_rate(&pack->cell, pack->t + pack->dt, step_ahead(pack), step_after(pack), l.after);
    return l;
}

/* Of a contact with a stiffness: what its springs add to D u~ besides C r, and their compliance, in units of D^-1 */
static void add_springs(const struct slot_filling *f, struct rebound *e, const double s[2])
{
    double law[3], c[2];
    const int k = slot_lane(f->i);
    spring_seen(f->of->p->dt, f->c, f->law, law, c);
    for (int j = 0; j < 3; j++) e->offset[j][k] += s[j > 0] * law[j];
    for (int j = 0; j < 2; j++) e->soft[j][k] = s[j] * c[j];
}

/* What the image of b is faster than b, in the basis of the contact */
static void image_velocity(const vec3 rate[3], const struct contact *c, double u[3])
{
    vec3 v = cell_shift(rate, c->shift);
    u[0] = v3_dot(c->n, v), u[1] = v3_dot(c->t1, v), u[2] = v3_dot(contact_t2(c), v);
}

/* The slot's n, its t1 where it must be known, mu; s of a rebound is 1 where there is no contact. */
static void set_basis(struct problem *p, int64_t i, const struct contact *c)
{
    const double n[3] = { c->n.x, c->n.y, c->n.z }, t1[3] = { c->t1.x, c->t1.y, c->t1.z };
    struct bundle *r = slot_bundle(p, i);
    int k = slot_lane(i);
    for (int j = 0; j < 3; j++) r->n[j][k] = n[j];
    struct beside *beside = bundle_beside(p, r);
    for (int j = 0; j < 3 && beside; j++) beside->t1[j][k] = t1[j];
    r->mu[k] = c->mu;
}

/* All but the reaction. The bodies still have their velocities before the step. */
void fill_ball(const struct slot_filling *f)
{
    struct problem *p = f->of->p;
    const struct packing *pack = p->packing;
    const struct lattice *cell = f->of->cell;
    const struct contact *c = f->c;
    const struct contact_law *law = f->law;
    const int64_t i = f->i;
    const double alpha = f->of->alpha, rho_factor = f->of->rho_factor;
    const double en[3] = { c->en, c->et, c->et }, s[2] = { 1 / (1 + c->en), 1 / (1 + c->et) };
    struct bundle *r = slot_bundle(p, i);
    struct rebound *e = slot_rebound(p, i);
    double(*w)[BUNDLE] = p->w[i / BUNDLE];
    int k = slot_lane(i);
    set_basis(p, i, c);
    arms_of(pack, c, step_ahead(pack), cell->edge, &r->la[k], &r->lb[k]);
    const struct body a = lighter(p, r->a[k], f->slower), b = lighter(p, r->b[k], f->slower);
    double u[3], im = a.im + b.im;
    double it = im + r->la[k] * r->la[k] * a.ii + r->lb[k] * r->lb[k] * b.ii;
    body_velocity(p, p->body, r, NULL, k, u); // u^-
    double before[3], after[3];
    if (contact_shifted(c)) {
        image_velocity(cell->before, c, before), image_velocity(cell->after, c, after);
        for (int j = 0; j < 3; j++) u[j] += before[j];
    }
    for (int j = 0; j < 3 && e; j++) e->offset[j][k] = u[j] * (en[j] / (1 + en[j]));
    for (int j = 0; j < 3 && e && contact_shifted(c); j++) e->offset[j][k] += s[j > 0] * after[j];
    if (e && law && law->offset > 0)
        e->offset[0][k] += law->offset;
    else if (e && offset_in(pack, c))
        add_offset(e, k, pack, c, u[0]);
    for (int j = 0; j < 2 && e; j++) e->s[j][k] = s[j], e->soft[j][k] = 0;
    w[0][k] = s[0] * im, w[1][k] = s[1] * it;
    if (e && law && law->spring[0] > 0) {
        add_springs(f, e, s);
        for (int j = 0; j < 2; j++) w[j][k] += e->soft[j][k];
    }
    for (int j = 0; j < 2; j++) r->iw[j][k] = 1 / w[j][k];
    double lambda = slot_lambda(p, i);
    p->rho[i / BUNDLE][k] = lambda <= 0 ? 1 : alpha > 0 ? alpha / im : rho_factor / lambda;
}

/* The rows G_i of a body with this arm; a wall's (i < 0) are 0. */
static void set_rows(const struct slot_filling *f, double G[9][BUNDLE], int32_t i, vec3 arm)
{
    const struct packing *pack = f->of->p->packing;
    const quat *half = f->of->half;
    const vec3 e[3] = { f->c->n, f->c->t1, contact_t2(f->c) };
    const int k = slot_lane(f->i);
    for (int j = 0; j < 3 && i >= 0; j++) {
        vec3 row = v3_cross(arm, e[j]);
        if (pack->dim == 2) row = j == 2 ? v3(0, 0, 0) : v3(0, 0, row.z);
        if (pack->mass[i] > 0) row = rotation_inverse_root(pack, i, half[i], row);
        G[3 * j][k] = row.x, G[3 * j + 1][k] = row.y, G[3 * j + 2][k] = row.z;
    }
}

/* Fills the slot's levers, W_cc and rho; its rebound, undivided: u + E u^- + d, with D law */
void fill_lever(const struct slot_filling *f)
{
    struct problem *p = f->of->p;
    const struct packing *pack = p->packing;
    const struct lattice *cell = f->of->cell;
    const struct contact *c = f->c;
    const struct contact_law *law = f->law;
    const int64_t i = f->i;
    const double alpha = f->of->alpha, rho_factor = f->of->rho_factor;
    const double en[3] = { c->en, c->et, c->et };
    struct bundle *r = slot_bundle(p, i);
    struct levers *g = &p->lever[i / BUNDLE];
    struct rebound *e = slot_rebound(p, i);
    int k = slot_lane(i);
    struct arms arm = arm_vectors(pack, c, step_ahead(pack), cell->edge);
    set_basis(p, i, c);
    set_rows(f, g->Ga, c->a, arm.a), set_rows(f, g->Gb, c->b, arm.b);
    const struct body a = lighter(p, r->a[k], f->slower), b = lighter(p, r->b[k], f->slower);
    double W[9], u[3];
    for (int j = 0; j < 9; j++) {
        W[j] = j % 4 == 0 ? a.im + b.im : 0;
        for (int l = 0; l < 3; l++)
            W[j] += a.ii * g->Ga[3 * (j / 3) + l][k] * g->Ga[3 * (j % 3) + l][k] +
                    b.ii * g->Gb[3 * (j / 3) + l][k] * g->Gb[3 * (j % 3) + l][k];
        p->block[i / BUNDLE][j][k] = W[j];
    }
    const bool soft = e && law && law->spring[0] > 0;
    for (int j = 0; j < 3 && e; j++) e->offset[j][k] = 0;
    for (int j = 0; j < 2 && e; j++) e->soft[j][k] = 0;
    if (soft) add_springs(f, e, (const double[2]){ 1, 1 });
    for (int j = 0; j < 9 && soft; j += 4)
        W[j] += e->soft[j > 0][k], p->block[i / BUNDLE][j][k] = W[j];
    double lambda = local_lambda_max(W);
    for (int j = 0; j < 2; j++) p->w[i / BUNDLE][j][k] = lambda, r->iw[j][k] = 1 / lambda;
    p->rho[i / BUNDLE][k] = lambda <= 0 ? 1 : alpha > 0 ? alpha / W[0] : rho_factor / lambda;
    if (!e) return;
    problem_velocity(p, p->body, i / BUNDLE, NULL, k, u); // u^-
    double before[3] = { 0 }, after[3] = { 0 };
    if (contact_shifted(c))
        image_velocity(cell->before, c, before), image_velocity(cell->after, c, after);
    for (int j = 0; j < 3; j++) {
        u[j] += before[j];
        e->offset[j][k] += en[j] * u[j] + after[j];
    }
    if (law && law->offset > 0)
        e->offset[0][k] += (1 + en[0]) * law->offset;
    else if (offset_in(pack, c))
        e->offset[0][k] += offset_of(pack, c, u[0]);
    for (int j = 0; j < 2; j++) e->s[j][k] = 1;
}

/* The same, and beyond W~, rho and the offset the bond's part, and that of moments */
void fill_bond(const struct slot_filling *f)
{
    struct problem *p = f->of->p;
    const struct contact *c = f->c;
    const struct contact_law *t = f->law;
    const int64_t i = f->i;
    const double alpha = f->of->alpha, rho_factor = f->of->rho_factor;
    fill_ball(f);
    if (!t) return;
    int k = slot_lane(i);
    struct bundle *r = slot_bundle(p, i);
    struct extra *x = &p->extra[i / BUNDLE];
    const struct rebound *e = slot_rebound(p, i);
    const struct body a = lighter(p, r->a[k], f->slower), b = lighter(p, r->b[k], f->slower);
    double h = p->dt, seen = t->offset > 0 ? t->offset : offset_of(p->packing, c, 0);
    double(*w)[BUNDLE] = p->w[i / BUNDLE], wt = w[1][k] / (e ? e->s[1][k] : 1);
    for (int j = 0; j < 2; j++) {
        x->K[j][k] = h * h * t->stiff[j], x->s[j][k] = 1 / (1 + w[j][k] * x->K[j][k]);
        w[j][k] *= x->s[j][k], r->iw[j][k] += x->K[j][k];
    }
    double lambda = slot_lambda(p, i), *rho = &p->rho[i / BUNDLE][k];
    if (t->beta > 0 && !(alpha > 0)) *rho = lambda > 0 ? rho_factor / lambda : 1;
    x->a[0][k] = x->K[0][k] * (t->jump[0] / h - seen);
    for (int j = 1; j < 3; j++) x->a[j][k] = h * t->stiff[1] * t->jump[j];
    for (int j = 0; j < 3; j++) x->z[j][k] = x->a[j][k]; // p = 0
    x->mu_r[k] = t->mu_r, x->mu_p[k] = t->mu_p;
    if (!extra_rolls(x, k)) return;
    x->k[k] = r->lb[k] * b.ii - r->la[k] * a.ii, x->wr[k] = a.ii + b.ii;
    x->length[k] = x->wr[k] > 0 ? sqrt(wt / x->wr[k]) : 1;
    struct rolling q;
    const double s[2] = { e ? e->s[0][k] : 1, e ? e->s[1][k] : 1 }, u[3] = { 0 };
    double v[ROLLING];
    const struct extra_lane at = slot_extra(p, i);
    extra_rolling(&at, (const double[2]){ w[0][k], w[1][k] }, s, u, &q, v);
    x->rho[k] = *rho * lambda / rolling_lambda(&q);
}

/* The rows R_i of a body, or a wall */
static void set_turning(double R[9][BUNDLE], int k, const struct packing *pack, int32_t i,
                        const struct contact *c, const quat *half)
{
    const vec3 e[3] = { c->n, v3_scale(-1, contact_t2(c)), c->t1 };
    for (int j = 0; j < 3; j++) {
        vec3 row = e[j];
        if (pack->dim == 2) row = v3(0, 0, row.z);
        if (i >= 0 && pack->mass[i] > 0) row = rotation_inverse_root(pack, i, half[i], row);
        R[3 * j][k] = row.x, R[3 * j + 1][k] = row.y, R[3 * j + 2][k] = row.z;
    }
}

/* The same for levers */
void fill_lever_bond(const struct slot_filling *f)
{
    struct problem *p = f->of->p;
    const struct contact *c = f->c;
    const struct contact_law *t = f->law;
    const int64_t i = f->i;
    const quat *half = f->of->half;
    const double alpha = f->of->alpha, rho_factor = f->of->rho_factor;
    fill_lever(f);
    if (!t) return;
    int k = slot_lane(i);
    struct bundle *r = slot_bundle(p, i);
    struct extra *x = &p->extra[i / BUNDLE];
    struct extra_levers *y = slot_turn(p, i);
    const struct body a = lighter(p, r->a[k], f->slower), b = lighter(p, r->b[k], f->slower);
    double h = p->dt, seen = t->offset > 0 ? t->offset : offset_of(p->packing, c, 0);
    double(*block)[BUNDLE] = p->block[i / BUNDLE], (*w)[BUNDLE] = p->w[i / BUNDLE];
    struct turning turning = { .K = { h * h * t->stiff[0], h * h * t->stiff[1] } };
    double *rho = &p->rho[i / BUNDLE][k], *K = turning.K;
    for (int j = 0; j < 9; j++) turning.W[j] = block[j][k];
    for (int j = 0; j < 2; j++) x->K[j][k] = K[j];
    x->a[0][k] = K[0] * (t->jump[0] / h - seen);
    for (int j = 1; j < 3; j++) x->a[j][k] = h * t->stiff[1] * t->jump[j];
    if (K[0] > 0 || K[1] > 0) {
        double hat[9];
        extra_levers_bond(block, y, k, K);
        for (int j = 0; j < 9; j++) hat[j] = block[j][k];
        double lambda = local_lambda_max(hat);
        for (int j = 0; j < 2; j++) w[j][k] = lambda, r->iw[j][k] = 1 / lambda;
        if (!(alpha > 0)) *rho = lambda > 0 ? rho_factor / lambda : 1;
    }
    for (int j = 0; j < 3; j++) x->z[j][k] = x->a[j][k]; // p = 0
    x->mu_r[k] = t->mu_r, x->mu_p[k] = t->mu_p;
    if (!extra_rolls(x, k)) return;
    set_turning(y->Ra, k, p->packing, c->a, c, half);
    set_turning(y->Rb, k, p->packing, c->b, c, half);
    turning.iia = a.ii, turning.iib = b.ii;
    x->length[k] = extra_levers_turn(&p->lever[i / BUNDLE], block, y, k, &turning);
    x->rho[k] = *rho * w[0][k] / y->lambda[k];
}

void fill_slot(const struct filling *f, int64_t i, double slower)
{
    struct problem *p = f->p;
    int32_t c = p->contact[i];
    for (int j = 0; j < 2 && c < 0 && p->rebound; j++) slot_rebound(p, i)->s[j][slot_lane(i)] = 1;
    if (c < 0) return;
    p->kind.fill(
        &(struct slot_filling){ f, i, &f->s->c[c], f->s->law ? &f->s->law[c] : NULL, slower });
    struct beside *beside = bundle_beside(p, slot_bundle(p, i));
    for (int j = 0, k = slot_lane(i); j < 2 && beside; j++)
        beside->w[j][k] = p->w[i / BUNDLE][j][k];
}

void fill_bundles(void *arg, int64_t first, int64_t end)
{
    for (int64_t i = BUNDLE * first; i < BUNDLE * end; i++) fill_slot(arg, i, 1);
}
