#include "problem.h"

#include "schedule.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

static_assert(sizeof(struct body) == 64, "a body is a cache line");

/* Zeroed memory on a cache line's border; not NULL for want of rows. */
static void *lines(int64_t n, size_t size)
{
    size_t bytes = ((size_t)(n > 0 ? n : 1) * size + 63) / 64 * 64;
    void *p = aligned_alloc(64, bytes);
    if (p) memset(p, 0, bytes);
    return p;
}

static int no_memory(struct problem *p, struct why *why)
{
    problem_free(p);
    return why_set(why, EX_SOFTWARE, "no memory for the contact problem");
}

void problem_free(struct problem *p)
{
    free(p->row), free(p->contact), free(p->group), free(p->body);
    *p = (struct problem){ 0 };
}

/* Bodies, then walls, with the velocities before the step. */
static void bodies(struct problem *p, const struct packing *pack)
{
    for (int64_t i = 0; i < pack->n; i++) {
        bool moves = pack->mass[i] > 0;
        vec3 v = pack->v[i], w = pack->w[i];
        p->body[i] = (struct body){ { v.x, v.y, v.z },
                                    { w.x, w.y, w.z },
                                    moves ? 1 / pack->mass[i] : 0,
                                    moves ? 1 / pack->inertia[i] : 0 };
    }
    for (int32_t w = 0; w < pack->walls; w++) {
        vec3 v = pack->wall[w].v;
        p->body[pack->n + w] = (struct body){ .v = { v.x, v.y, v.z } };
    }
}

void problem_arms(const struct packing *p, const struct contact *c, double *la, double *lb)
{
    *la = c->a < 0 ? 0 : v3_dot(v3_sub(c->x, packing_predict(p, c->a)), c->n);
    *lb = v3_dot(v3_sub(packing_predict(p, c->b), c->x), c->n);
}

/* All of a row but the reaction; the bodies still have the velocities before the step. */
static void row_init(struct row *r, const struct problem *p, const struct packing *pack,
                     const struct contact *c, double alpha, double factor)
{
    *r = (struct row){ .n = { c->n.x, c->n.y, c->n.z },
                       .t1 = { c->t1.x, c->t1.y, c->t1.z },
                       .t2 = { c->t2.x, c->t2.y, c->t2.z },
                       .mu = c->mu,
                       .a = (int32_t)(c->a < 0 ? pack->n - 1 - c->a : c->a),
                       .b = c->b };
    problem_arms(pack, c, &r->la, &r->lb);
    const struct body *a = &p->body[r->a], *b = &p->body[r->b];
    double im = a->im + b->im, e[3] = { c->en, c->et, c->et };
    double it = im + r->la * r->la * a->ii + r->lb * r->lb * b->ii;
    r->s[0] = r->s[1] = 1;
    body_velocity(p, r, r->offset); // u^-
    for (int k = 0; k < 3; k++) r->offset[k] *= e[k] / (1 + e[k]);
    r->s[0] = 1 / (1 + c->en), r->s[1] = 1 / (1 + c->et);
    r->w[0] = r->s[0] * im, r->w[1] = r->s[1] * it;
    double lambda = row_lambda(r);
    r->rho = lambda <= 0 ? 1 : alpha > 0 ? alpha / im : factor / lambda;
}

/* Mean mass of what moves, for the scaled errors. */
static double mean_mass(const struct packing *p)
{
    double sum = 0;
    int64_t n = 0;
    for (int64_t i = 0; i < p->n; i++) sum += p->mass[i], n += p->mass[i] > 0;
    return n ? sum / (double)n : 1;
}

int problem_prepare(struct problem *p, const struct packing *pack, const struct contacts *s,
                    double alpha, double factor, enum order order, struct why *why)
{
    *p = (struct problem){ .d = pack->dim, .n = s->n, .dt = pack->dt };
    p->row = lines(s->n, sizeof *p->row);
    p->body = lines(pack->n + pack->walls, sizeof *p->body);
    struct schedule plan = { 0 };
    if (!p->row || !p->body) return no_memory(p, why);
    bodies(p, pack);
    if (schedule_bodies(&plan, order, s, pack)) return no_memory(p, why);
    p->contact = plan.sequence, p->group = plan.group, p->groups = plan.groups;
    for (int64_t i = 0; i < p->n; i++)
        row_init(&p->row[i], p, pack, &s->c[p->contact[i]], alpha, factor);

    double g = v3_norm(pack->g);
    p->scale_v = (g > 0 ? g : 9.81) * pack->dt;
    p->scale_r = p->scale_v * mean_mass(pack);
    const double dv[3] = { pack->dt * pack->g.x, pack->dt * pack->g.y, pack->dt * pack->g.z };
    for (int64_t i = 0; i < pack->n; i++)
        for (int k = 0; k < 3 && p->body[i].im > 0; k++) p->body[i].v[k] += dv[k];
    for (int64_t i = 0; i < p->n; i++) {
        double q[3];
        body_velocity(p, &p->row[i], q);
        p->norm_q += q[0] * q[0] + q[1] * q[1] + q[2] * q[2];
    }
    p->norm_q = sqrt(p->norm_q);
    for (int64_t i = 0; s->solved && i < p->n; i++) {
        struct row *r = &p->row[i];
        const struct contact *c = &s->c[p->contact[i]];
        for (int k = 0; k < 3; k++) r->r[k] = c->r[k], r->u[k] = c->u[k];
        body_push(p, r, r->r);
    }
    return 0;
}

int problem_prepare_delassus(struct problem *p, struct delassus *W, double alpha, double factor,
                             enum order order, struct why *why)
{
    *p = (struct problem){ .d = W->d, .n = W->n, .W = W, .dt = 1, .scale_v = 1, .scale_r = 1 };
    p->row = lines(W->n, sizeof *p->row);
    struct schedule plan = { 0 };
    if (!p->row || schedule_blocks(&plan, order, W)) return no_memory(p, why);
    p->contact = plan.sequence, p->group = plan.group, p->groups = plan.groups;
    double trace = 0;
    for (int64_t i = 0; i < p->n; i++) {
        int64_t c = p->contact[i];
        const double *D = W->diag + 9 * c, *q = W->q + W->d * c;
        struct row *r = &p->row[i];
        double lambda = local_lambda_max(D);
        r->mu = W->mu[c];
        r->w[0] = r->w[1] = lambda;
        r->rho = lambda <= 0 ? 1 : alpha > 0 && D[0] > 0 ? alpha / D[0] : factor / lambda;
        for (int k = 0; k < W->d; k++) {
            r->r[k] = W->r[W->d * c + k];
            p->norm_q += q[k] * q[k];
            trace += D[4 * k];
        }
    }
    // no g, no m here: velocities in the root mean square of q, masses in the mean of 1/W_ii
    p->norm_q = sqrt(p->norm_q);
    if (p->norm_q > 0) p->scale_v = p->norm_q / sqrt((double)(W->d * W->n));
    p->scale_r = trace > 0 ? p->scale_v * (double)(W->d * W->n) / trace : p->scale_v;
    return 0;
}

void problem_store(const struct problem *p, struct contacts *s)
{
    for (int64_t i = 0; i < p->n; i++) {
        const struct row *r = &p->row[i];
        struct contact *c = &s->c[p->contact[i]];
        for (int k = 0; k < 3; k++) c->r[k] = r->r[k], c->u[k] = r->u[k];
        c->status = (int8_t)local_status(r->mu, r->r);
    }
    s->solved = true;
}
