/* contact/spring.c: what springs of contacts do in a step, and keep [contact/spring.h]. */
#include "contact/spring.h"

#include "state/freedom.h"
#include "state/kinematics.h"
#include "state/rotation.h"

/* A contact's bodies: the arms to it, and the velocity of b against a before the step and without reactions */
struct spring_meeting {
    const struct packing *p;
    const struct contact *c;
    struct arms arm;
    vec3 before, free; /* m/s */
};

static vec3 fall_of(const struct packing *p, int32_t i)
{
    return i >= 0 && p->mass[i] > 0 ? packing_fall(p, i) : v3(0, 0, 0);
}

static struct spring_meeting meeting_of(const struct packing *p, const struct contact *c)
{
    struct spring_meeting m = { .p = p, .c = c };
    vec3 edge[3];
    cell_predict(&p->cell, step_ahead(p), edge);
    m.arm = arm_vectors(p, c, step_ahead(p), edge);
    m.before = velocity_of(p, c, &m.arm);
    m.free = v3_add(m.before, v3_sub(fall_of(p, c->b), fall_of(p, c->a)));
    return m;
}

/* m/s: what an impulse f (N s) makes of the velocity of body i at the contact, arm from its centre */
static vec3 spring_push(const struct packing *p, int32_t i, vec3 arm, vec3 f)
{
    if (i < 0 || !(p->mass[i] > 0)) return v3(0, 0, 0);
    vec3 moment = v3_cross(arm, f);
    vec3 w = rotation_is(p, i) ? rotation_spin(p, i, rotation_predict(p, i), moment)
                               : v3_scale(1 / p->inertia[i], moment);
    if (p->dim == 2) w = v3(0, 0, moment.z / p->inertia[i]);
    return v3_axpy(v3_cross(w, arm), 1 / p->mass[i], f);
}

/* x[3] = W_cc^-1 y, in the contact's basis; 0 where no body moves */
static void spring_impulse(const struct spring_meeting *m, const double y[3], double x[3])
{
    const struct contact *c = m->c;
    const vec3 e[3] = { c->n, c->t1, contact_t2(c) };
    vec3 W[3]; // columns, in the basis; W is symmetric
    for (int j = 0; j < 3; j++) {
        vec3 u = v3_add(spring_push(m->p, c->b, m->arm.b, e[j]),
                        spring_push(m->p, c->a, m->arm.a, e[j]));
        W[j] = v3(v3_dot(e[0], u), v3_dot(e[1], u), v3_dot(e[2], u));
    }
    const vec3 r = v3(y[0], y[1], y[2]);
    const double det = v3_dot(W[0], v3_cross(W[1], W[2]));
    x[0] = x[1] = x[2] = 0;
    if (!(det > 0)) return;
    x[0] = v3_dot(r, v3_cross(W[1], W[2])) / det;
    x[1] = v3_dot(W[0], v3_cross(r, W[2])) / det;
    x[2] = v3_dot(W[0], v3_cross(W[1], r)) / det;
}

/* On the disc of mu r_n */
static void spring_cut(double most, double x[2])
{
    const double t = sqrt(x[0] * x[0] + x[1] * x[1]);
    for (int k = 0; k < 2 && t > most; k++) x[k] *= most / t;
}

/* Of the impulse of an impact: what springs push in a step in which they are taken not to push */
#define SLIGHT 1e-2

/* Is it an impact? Sets t->hit. */
static bool spring_meets(struct contact_law *t, const struct packing *p, const struct contact *c)
{
    const struct spring_meeting m = meeting_of(p, c);
    const vec3 e[3] = { c->n, c->t1, contact_t2(c) };
    double off[3];
    if (!(-v3_dot(m.before, c->n) > freedoms_calm(p))) return false;
    if (!(t->jump[0] + p->dt * v3_dot(m.free, c->n) < 0)) return false; // not in this step
    for (int k = 0; k < 3; k++)
        off[k] = -v3_dot(m.free, e[k]) - (k ? c->et : c->en) * v3_dot(m.before, e[k]);
    if (!(c->en > 0)) off[0] -= fmax(0, t->jump[0]) / p->dt;
    spring_impulse(&m, off, t->hit);
    t->hit[0] = fmax(0, t->hit[0]);
    spring_cut(c->mu * t->hit[0], t->hit + 1);
    const bool meets =
        packing_complies(p, c) || -t->spring[0] * t->jump[0] * p->dt <= SLIGHT * t->hit[0];
    for (int k = 0; k < 3 && !meets; k++) t->hit[k] = 0;
    return meets;
}

/* t->turn, out of what is remembered, within the limits of the moment that n allows */
static void spring_turned(struct contact_law *t, const struct contact *c, const struct bond *old,
                          double scale)
{
    const vec3 turn = v3_scale(scale, v3_turn_along(old->n, c->n, old->turn));
    const double push = t->spring[0] * fmax(0, -t->jump[0]), most = t->mu_p * push / t->roll;
    t->turn[0] = fmax(-most, fmin(most, v3_dot(turn, c->n)));
    t->turn[1] = v3_dot(turn, c->t1), t->turn[2] = v3_dot(turn, contact_t2(c));
    spring_cut(t->mu_r * push / t->roll, t->turn + 1);
}

/* N/m: k_n and k_t of the contact; false: it is rigid. */
static bool spring_stiffness(const struct packing *p, const struct contact *c, double k[2])
{
    const struct pair_law *l = &p->law[packing_pair(p, c->a, c->b)];
    k[0] = l->kn, k[1] = l->kt;
    if (l->soft > 0) {
        const double W = packing_inverse_mass(p, c->a) + packing_inverse_mass(p, c->b);
        k[0] = 1 / (l->soft * W * p->dt * p->dt), k[1] = SPRING_ACROSS * k[0];
    }
    return k[1] > 0 && isfinite(k[0]);
}

/* Do its bodies part? */
static bool spring_parts(const struct packing *p, const struct contact *c)
{
    return v3_dot(meeting_of(p, c).before, c->n) > freedoms_calm(p);
}

/* Of a remembered spring: what its stretch is now, over what it was, to push as before. 1: k is that of the pair. */
static double spring_scale(const struct contact_law *t, const struct packing *p,
                           const struct contact *c, const struct bond *old)
{
    return packing_complies(p, c) && old->spring > 0 ? old->spring / t->spring[0] : 1;
}

void spring_set(struct contact_law *t, const struct packing *p, struct contact *c,
                const struct bond *old)
{
    const bool pressed = old && old->pressed;
    if (t->beta > 0 || !spring_stiffness(p, c, t->spring)) {
        t->spring[0] = t->spring[1] = 0;
        return;
    }
    const double R = packing_smaller_radius(p, c), scale = pressed ? spring_scale(t, p, c, old) : 1;
    if (t->mu_r > 0 || t->mu_p > 0) t->roll = t->spring[1] * R * R;
    double rest = pressed ? fmax(old->rest, c->gap) : c->gap;
    if (scale != 1) rest += (1 - scale) * (c->gap - rest);
    rest = fmin(0, rest);
    t->jump[0] = c->gap - rest;
    if (pressed) {
        vec3 slip = v3_scale(scale, v3_turn_along(old->n, c->n, old->slip));
        t->jump[1] = v3_dot(slip, c->t1), t->jump[2] = v3_dot(slip, contact_t2(c));
        spring_cut(c->mu * t->spring[0] * fmax(0, -t->jump[0]) / t->spring[1], t->jump + 1);
        if (t->roll > 0) spring_turned(t, c, old, scale);
    }
    const bool follows = packing_complies(p, c);
    if (pressed && !follows) c->en = c->et = 0;
    if (spring_meets(t, p, c))
        t->state |= CONTACT_LAW_MEETS, t->turn[0] = t->turn[1] = t->turn[2] = 0;
    else if (!(follows && t->jump[0] <= 0 && spring_parts(p, c)))
        c->en = c->et = 0;
}

void spring_seen(double dt, const struct contact *c, const struct contact_law *t, double law[3],
                 double compliance[2])
{
    const bool meets = t->state & CONTACT_LAW_MEETS;
    for (int k = 0; k < 2; k++) compliance[k] = 1 / (t->spring[k] * dt * dt);
    for (int k = 0; k < 3; k++) {
        law[k] = t->jump[k] / dt;
        if (meets) law[k] = k == 0 && !(c->en > 0) ? fmax(0, law[k]) : 0;
        if (t->hit[k] != 0) law[k] -= compliance[k > 0] * t->hit[k];
    }
}

/* Has the spring no part in an impact of its contact? */
static bool spring_rests(const struct packing *p, const struct contact *c,
                         const struct contact_law *t)
{
    return packing_complies(p, c) && (t->state & CONTACT_LAW_MEETS || c->en > 0);
}

struct spring_end spring_end(const struct packing *p, const struct contact *c,
                             const struct contact_law *t, const struct found *found, double before)
{
    const double dt = p->dt;
    double law[3], compliance[2];
    struct spring_end e;
    spring_seen(dt, c, t, law, compliance);
    e.un = (1 + c->en) * found->u[0] - c->en * before - law[0] - compliance[0] * found->r[0];
    e.stretch[0] = t->jump[0] + dt * e.un;
    const bool meets = t->state & CONTACT_LAW_MEETS;
    for (int k = 1; k < 3; k++)
        e.stretch[k] = meets ? 0 : -(found->r[k] - t->hit[k]) / (dt * t->spring[1]);
    if (spring_rests(p, c, t)) {
        e.stretch[0] = fmax(fmin(0, t->jump[0]), e.stretch[0]);
        for (int k = 1; k < 3; k++) e.stretch[k] = t->jump[k];
    }
    for (int k = 1; k < 3 && packing_complies(p, c) && !(found->r[0] > 0); k++) e.stretch[k] = 0;
    return e;
}

double spring_turn_seen(double dt, const struct contact_law *t, double law[3])
{
    for (int k = 0; k < 3; k++) law[k] = t->turn[k] / dt;
    return t->roll > 0 && !(t->state & CONTACT_LAW_MEETS) ? 1 / (t->roll * dt * dt) : 0;
}

void spring_turn_end(double dt, const struct contact_law *t, const double moment[3], double turn[3])
{
    const bool rolls = t->roll > 0 && !(t->state & CONTACT_LAW_MEETS);
    for (int k = 0; k < 3; k++) turn[k] = rolls ? -moment[k] / (dt * t->roll) : 0;
}

static double square_of(const double x[3])
{
    return x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
}

double spring_energy(const struct contact_law *t, const double x[3], const double phi[3])
{
    const double n = fmin(0, x[0]);
    const double across = t->spring[1] * (x[1] * x[1] + x[2] * x[2]);
    return 0.5 * (t->spring[0] * n * n + across + t->roll * square_of(phi));
}

double spring_implicit(const struct contact_law *t, const double end[3], const double phi[3])
{
    double d[3], turn[3];
    for (int k = 0; k < 3; k++) d[k] = end[k] - t->jump[k], turn[k] = phi[k] - t->turn[k];
    d[0] = fmin(0, end[0]) - fmin(0, t->jump[0]);
    return 0.5 * (t->spring[0] * d[0] * d[0] + t->spring[1] * (d[1] * d[1] + d[2] * d[2]) +
                  t->roll * square_of(turn));
}

/* m: g_0 when the step is over, before it rises */
static double spring_rest_end(const struct packing *p, const struct contact *c,
                              const struct contact_law *t, double gap, double stretch)
{
    return spring_rests(p, c, t) ? gap - stretch : c->gap - t->jump[0];
}

double spring_rest_after(const struct packing *p, const struct contact *c,
                         const struct contact_law *t, double gap, double stretch)
{
    const double soft = p->law[packing_pair(p, c->a, c->b)].soft;
    // a spring whose stiffness follows from dt then pushes by the weight of its pair more
    const double rise = (soft > 0 ? soft : 1) * p->dt * packing_most_fall(p);
    return fmin(0, spring_rest_end(p, c, t, gap, stretch) + rise);
}

double spring_rise(const struct packing *p, const struct contact *c, const struct contact_law *t,
                   double end, double x)
{
    const double rest = spring_rest_end(p, c, t, end, x), gap = rest + x;
    const double risen = gap - fmin(0, fmax(spring_rest_after(p, c, t, end, x), gap));
    const double before = fmin(0, x), after = fmin(0, risen);
    return rest < 0 ? 0.5 * t->spring[0] * (after * after - before * before) : 0;
}

double spring_unloaded_gap(const struct contact *c, const struct contact_law *t)
{
    return t->spring[0] > 0 ? c->gap - fmin(0, t->jump[0]) : c->gap;
}
