/* step/small_stress.c: a cell that yields to a stress, in small steps [step/small_stress.h]. */
#include "step/small_stress.h"

#include "step/small_meet.h"

#include <math.h>

/* Of the mass of a body and of bodies in a row, n^(1/3), in the plane 1: lighter edges are light */
#define LIGHT 0.6

bool small_stress_light(const struct packing *p)
{
    double mass = 0, n = 0, least = INFINITY;
    for (int64_t i = 0; i < p->n; i++)
        if (p->mass[i] > 0) mass += p->mass[i], n++;
    for (int k = 0; k < 9; k++)
        if (p->cell.mass[k / 3][k % 3] > 0) least = fmin(least, p->cell.mass[k / 3][k % 3]);
    if (p->cell.size_mass > 0)
        for (int k = 0; k < p->dim; k++)
            least = fmin(least, p->cell.size_mass / v3_dot(p->cell.edge[k], p->cell.edge[k]));
    return n > 0 && least < LIGHT * mass / pow(n, 2.0 / p->dim);
}

double small_stress_energy(const struct packing *p)
{
    const struct cell *c = &p->cell;
    const double s = c->size_mass > 0 ? cell_growth(c, step_after(p)) : 0;
    double sum = 0.5 * c->size_mass * s * s;
    for (int k = 0; k < 3; k++) {
        const double rate[3] = { c->rate[k].x, c->rate[k].y, c->rate[k].z };
        for (int i = 0; i < 3; i++) sum += 0.5 * c->mass[k][i] * rate[i] * rate[i];
    }
    return sum;
}

double small_stress_forces(const struct packing *p)
{
    struct freedoms list;
    struct failure failure = { 0 };
    double sum = 0;
    if (!cell_yields(&p->cell) || freedoms_init(&list, p, p->cell.edge, false, &failure)) return 0;
    for (int32_t k = 0; k < list.n; k++) {
        const struct freedom *f = &list.f[k];
        if (!freedom_of_cell(f)) continue;
        for (int j = 0; j < p->dim && f->wall == FREEDOM_SIZE; j++)
            sum += fabs(f->force) / v3_norm(p->cell.edge[j]);
        if (f->wall == FREEDOM_EDGE) sum += fabs(f->force);
    }
    freedoms_free(&list);
    return sum;
}

/* ---- the sum over contacts ---- */

/* m: from what moves of a to what moves of the image of b; what does not move does not follow the cell. */
static vec3 branch_between(const struct small_run *r, int32_t a, int32_t b, const int8_t shift[3])
{
    const struct small *s = &r->l->s;
    vec3 d = cell_shift(r->cell.edge, shift);
    for (int side = 0; side < 2; side++) {
        const int32_t i = side ? b : a;
        if (i < 0 || !(s->body[i].im > 0)) continue;
        d = v3_axpy(d, side ? 1 : -1, v3_sub(small_vec(s->place[i].x), r->cell.cell.origin));
    }
    return d;
}

/* N m s: the sum of r (x) d, of the reactions and the pulls that there are */
static void sum_pushes(const struct small_run *r, double to[3][3])
{
    const struct small_list *l = r->l;
    const int8_t none[3] = { 0, 0, 0 };
    for (int k = 0; k < 9; k++) to[k / 3][k % 3] = 0;
    for (int64_t i = 0; i < l->pairs.n; i++) {
        const struct pair *q = &l->pairs.pair[i];
        const vec3 f = small_slot_force(&l->s, l->slot[i]);
        if (f.x != 0 || f.y != 0 || f.z != 0)
            v3_outer(to, 1, f, branch_between(r, q->a, q->b, q->shift));
    }
    for (int64_t i = 0; i < l->touches; i++) {
        const struct small_touch *t = &l->touch[i];
        const vec3 f = v3_axpy(small_vec(t->f), -t->hold[HOLD_PULL], t->n);
        v3_outer(to, 1, f, branch_between(r, -1, t->body, none));
    }
    for (int64_t i = 0; i < l->meetings.n; i++) {
        const struct small_meeting *m = &l->meetings.of[i];
        vec3 f = v3(0, 0, 0);
        for (int64_t k = 0; k < m->points; k++)
            f = v3_add(f, v3_add(small_vec(m->point[k].f), m->point[k].pull));
        v3_outer(to, 1, f, branch_between(r, m->key.a, m->key.b, m->key.shift));
    }
}

/* J^T r of a freedom, where the sum over contacts is x */
static double push_of(const struct freedom *f, double x[3][3])
{
    const double axis[3] = { f->axis.x, f->axis.y, f->axis.z };
    double sum = 0;
    if (f->wall == FREEDOM_SIZE) return x[0][0] + x[1][1] + x[2][2];
    for (int i = 0; i < 3; i++) sum += axis[i] * v3_dot(small_vec(x[i]), f->inverse);
    return sum;
}

/* ---- a small step ---- */

void small_stress_free(struct small_run *r)
{
    freedoms_free(&r->cell.list);
}

void small_stress_begin(struct small_run *r)
{
    struct small_cell *c = &r->cell;
    struct packing here = *r->p;
    struct failure failure = { 0 };
    here.cell = c->cell;
    freedoms_free(&c->list);
    if (freedoms_init(&c->list, &here, c->edge, false, &failure)) r->lost = r->stop = true;
    sum_pushes(r, c->push);
    for (int32_t k = 0; k < c->list.n; k++) {
        const struct freedom *f = &c->list.f[k];
        if (freedom_of_cell(f))
            freedom_gain(f, (r->h * f->force + push_of(f, c->push)) / f->mass, c->next);
    }
}

/* All bodies follow what the rates gain. */
static void follow_flow(struct small_run *r, const vec3 gain[3])
{
    const struct small_cell *c = &r->cell;
    struct cell_flow flow;
    cell_flow_init(&flow, &c->cell, c->edge, gain);
    for (int64_t i = 0; flow.changes && i < r->p->n; i++) {
        struct body *b = &r->l->s.body[i];
        struct small_pull *y = &r->pull[i];
        if (!(b->im > 0)) continue;
        const vec3 v = cell_flow_gain(&flow, small_vec(r->l->s.place[i].x));
        const double x[3] = { v.x, v.y, v.z };
        // half of its work is that at the velocity before the step; the other one follows [step/small_pull.c]
        y->carried += 0.5 * r->p->mass[i] * v3_dot(v, small_vec(r->l->s.before[i].v));
        for (int k = 0; k < 3; k++) {
            b->v[k] += x[k], y->dv[k] += x[k], y->gain[k] += x[k];
            y->impulse[k] += r->p->mass[i] * x[k];
        }
    }
}

void small_stress_end(struct small_run *r)
{
    struct small_cell *c = &r->cell;
    double push[3][3];
    vec3 gain[3] = { { 0 } };
    sum_pushes(r, push);
    for (int32_t k = 0; k < c->list.n; k++) {
        const struct freedom *f = &c->list.f[k];
        if (!freedom_of_cell(f)) continue;
        const double got = push_of(f, push), had = push_of(f, c->push);
        const double mean = f->speed + 0.5 * (r->h * f->force + got) / f->mass;
        freedom_gain(f, (got - had) / f->mass, gain);
        c->work += got * mean, c->loads += r->h * f->force * mean;
    }
    for (int k = 0; k < 3; k++) c->next[k] = v3_add(c->next[k], gain[k]);
    follow_flow(r, gain);
}
