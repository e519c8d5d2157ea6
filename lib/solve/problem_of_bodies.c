/* solve/problem_of_bodies.c: the bundles of a packing [solve/problem.h]. */
#include "base/team.h"
#include "solve/exchange.h"
#include "solve/fill.h"
#include "solve/lay.h"
#include "solve/mass_splitting.h"
#include "solve/plan.h"
#include "solve/problem.h"
#include "state/kinematics.h"
#include "state/offset.h"
#include "state/rotation.h"

#include <stdlib.h>
#include <string.h>

enum {
    PER_THREAD = 4096 /* bodies, contacts or slots that are worth a thread: 100 us of work */
};

static int problem_of_bodies_no_memory(struct problem *p, struct failure *failure)
{
    problem_free(p);
    return failure_set(failure, EX_SOFTWARE, "no memory for the contact problem");
}

/* Sets bodies first .. end-1, with their velocities before the step. */
static void set_some(void *arg, int64_t first, int64_t end)
{
    struct problem *p = arg;
    const struct packing *pack = p->packing;
    for (int64_t i = first; i < end; i++) {
        vec3 v = pack->v[i], w = p->spin ? p->spin[i] : pack->w[i];
        p->body[p->seat[i]] = (struct body){ { v.x, v.y, v.z },
                                             { w.x, w.y, w.z },
                                             pack->mass[i] > 0 ? 1 / pack->mass[i] : 0,
                                             pack->mass[i] > 0 ? 1 / pack->inertia[i] : 0 };
        if (p->spin && pack->mass[i] > 0) p->body[p->seat[i]].ii = 1;
    }
}

/* What pulls and the torque from outside make of the angular velocity of body i, or of what stands for it */
static vec3 torque_gain(const struct problem *p, int64_t i)
{
    const struct packing *pack = p->packing;
    vec3 torque = pack->outside.torque ? pack->outside.torque[i] : v3(0, 0, 0);
    if (pack->pulls.n) torque = v3_add(torque, packing_pull(pack, i, pack->t + pack->dt / 2, true));
    vec3 moment = v3_scale(pack->dt, torque);
    return p->spin ? rotation_inverse_root(pack, i, rotation_predict(pack, i), moment)
                   : v3_scale(1 / pack->inertia[i], moment);
}

static void free_some(void *arg, int64_t first, int64_t end)
{
    struct problem *p = arg;
    const struct packing *pack = p->packing;
    const struct cell_flow flow = packing_flow(pack);
    for (int64_t i = first; i < end; i++) {
        struct body *b = &p->body[p->seat[i]];
        if (!(b->im > 0)) continue;
        vec3 dv = packing_fall(pack, i);
        if (flow.changes) dv = v3_add(dv, cell_flow_gain(&flow, packing_predict(pack, i)));
        b->v[0] = pack->v[i].x + dv.x, b->v[1] = pack->v[i].y + dv.y, b->v[2] = pack->v[i].z + dv.z;
        vec3 w = p->spin ? p->spin[i] : pack->w[i];
        if (pack->outside.torque || pack->pulls.n) w = v3_add(w, torque_gain(p, i));
        b->w[0] = w.x, b->w[1] = w.y, b->w[2] = w.z;
    }
}

/* Has any process such a contact, where `here` says so of this one? All processes run the same sweep, which then
   has room for it. */
static bool anywhere(const struct problem *p, bool here)
{
    return p->exchange ? p->exchange->most(p->exchange, here) > 0 : here;
}

/* N s: of the contacts' ties */
static bool set_pulls(struct problem *p, const struct contacts *s)
{
    bool any = false;
    for (int64_t i = 0; s->law && i < s->n; i++) any = any || s->law[i].pull > 0;
    if (!anywhere(p, any)) return true;
    p->pull = calloc((size_t)p->slots + 1, sizeof *p->pull);
    for (int64_t i = 0; p->pull && i < p->slots; i++)
        if (s->law && p->contact[i] >= 0) p->pull[i] = p->dt * s->law[p->contact[i]].pull;
    return p->pull != NULL;
}

void problem_set_free_motion(struct problem *p)
{
    const int64_t n = p->packing->n;
    team_share(team_size(), n, PER_THREAD, free_some, p);
    memcpy(p->body + n, p->held, (size_t)(p->bodies - n) * sizeof *p->held);
    if (p->exchange) p->exchange->begin(p->exchange, p);
    for (int64_t i = 0; p->pull && i < p->slots; i++) {
        const double pulled[3] = { -p->pull[i], 0, 0 };
        if (p->pull[i] > 0) problem_push(p, p->body, i / BUNDLE, slot_lane(i), pulled);
    }
    if (p->exchange && p->pull) p->exchange->settle(p->exchange, p);
}

/* half[n] = the orientations in which contacts act, and p->spin; false when memory is short. */
static bool find_spins(struct problem *p, const struct packing *pack, quat **half)
{
    *half = calloc((size_t)pack->n + 1, sizeof **half);
    p->spin = calloc((size_t)pack->n + 1, sizeof *p->spin);
    if (!*half || !p->spin) return false;
    for (int64_t i = 0; i < pack->n; i++) {
        p->spin[i] = pack->w[i];
        if (!(pack->mass[i] > 0)) continue;
        (*half)[i] = rotation_is(pack, i) ? rotation_predict(pack, i) : pack->q[i];
        p->spin[i] = rotation_root(pack, i, (*half)[i], rotation_predict_spin(pack, i, (*half)[i]));
    }
    return true;
}

/* The reactions found, as r* and what is beyond it; the bodies get them. */
static void take_found(struct problem *p, int64_t i, const struct contacts *s)
{
    const struct found *c = &s->found[p->contact[i]];
    struct extra *x = p->extra ? &p->extra[i / BUNDLE] : NULL;
    int k = slot_lane(i);
    double r[3] = { c->r[0], c->r[1], c->r[2] };
    if (p->pull) r[0] += p->pull[i];
    problem_push(p, p->body, i / BUNDLE, k, r);
    for (int j = 0; x && j < 3; j++) {
        x->z[j][k] = -x->K[j > 0][k] * c->u[j];
        r[j] -= x->z[j][k] - x->a[j][k];
        if (s->moment) x->m[j][k] = s->moment[p->contact[i]][j];
    }
    const struct contact *law = &s->c[p->contact[i]];
    double u[3] = { c->u[0], c->u[1], c->u[2] };
    for (int j = 0; j < 3 && p->kind.levers; j++) u[j] *= 1 + (j ? law->et : law->en);
    slot_set(p, i, r, u);
    if (!x || !extra_rolls(x, k)) return;
    const double m[3] = { x->m[0][k], x->m[1][k], x->m[2][k] };
    const struct extra_lane at = slot_extra(p, i);
    extra_push(&at, m);
}

/* What the free motion makes of the slots */
struct measuring {
    struct problem *p;
    double *q2; /* [slots] m^2/s^2: |q|^2 */
};

static void measure_some(void *arg, int64_t first, int64_t end)
{
    const struct measuring *m = arg;
    const struct problem *p = m->p;
    for (int64_t i = BUNDLE * first; i < BUNDLE * end; i++) {
        double q[3] = { 0 };
        if (p->contact[i] >= 0)
            problem_velocity(p, p->body, i / BUNDLE, slot_rebound(p, i), slot_lane(i), q);
        m->q2[i] = q[0] * q[0] + q[1] * q[1] + q[2] * q[2];
    }
}

static double problem_of_bodies_fastest(void *arg, int64_t first, int64_t end)
{
    const struct packing *p = arg;
    double most = 0;
    for (int64_t i = first; i < end; i++)
        most = dmax(most, v3_norm(p->v[i]) + p->radius[i] * v3_norm(p->w[i]));
    return most;
}

/* m/s: the speed of the fastest point of a body or wall, plus g dt. The velocities at contacts are
   differences of such speeds, and have their rounding. */
static double rotation_speed(const struct packing *p)
{
    double most = team_most(team_size(), p->n, PER_THREAD, problem_of_bodies_fastest, (void *)p),
           images = 0;
    for (int32_t k = 0; k < p->walls; k++)
        most = fmax(most, wall_top_speed(p, &p->wall[k]) + v3_norm(p->wall[k].belt));
    for (int k = 0; k < 3; k++) images += p->cell.repeats[k] ? v3_norm(p->cell.rate[k]) : 0;
    most += images;
    return most + packing_most_fall(p);
}

/* What there is among the contacts, in any of them */
struct survey {
    const struct packing *p;
    const struct contacts *s;
    bool far; /* bundles do not stay in a near cache: what can be computed is not loaded */
    bool moving_images; /* images move otherwise than their bodies, now or at the end of the step */
    _Atomic bool shaped, rebounds; /* u~ is anything but u */
    _Atomic bool turned;       /* t1 is to be loaded: not what contact_basis() makes, or not far */
    _Atomic bool bonds, rolls; /* stiff ties; rolling friction */
    _Atomic bool soft;         /* contacts with a stiffness */
};

static bool problem_of_bodies_same(vec3 a, vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

static void survey_some(void *arg, int64_t first, int64_t end)
{
    struct survey *y = arg;
    bool shaped = false, rebounds = false, turned = !y->far || y->p->dim == 2;
    bool bonds = false, rolls = false, soft = false;
    for (int64_t i = first; i < end; i++) {
        const struct contact *c = &y->s->c[i];
        shaped |= contact_shaped(y->p, c);
        struct contact made = { 0 };
        if (!turned)
            contact_basis(&made, 3, c->n), turned = !problem_of_bodies_same(made.t1, c->t1);
        const struct contact_law *t = y->s->law ? &y->s->law[i] : NULL;
        rebounds |= c->en > 0 || c->et > 0 || offset_in(y->p, c, t) || (t && t->offset > 0) ||
                    (y->moving_images && contact_shifted(c));
        bonds |= t && (t->stiff[0] > 0 || t->stiff[1] > 0);
        rolls |= t && (t->mu_r > 0 || t->mu_p > 0);
        soft |= t && t->spring[0] > 0;
    }
    if (shaped) y->shaped = true;
    if (rebounds) y->rebounds = true;
    if (turned) y->turned = true;
    if (bonds) y->bonds = true;
    if (rolls) y->rolls = true;
    if (soft) y->soft = true;
}

static void survey(struct survey *y, const struct packing *p, const struct contacts *s,
                   const struct lattice *cell)
{
    double most = 0;
    for (int k = 0; k < 3; k++)
        most = fmax(most, fmax(v3_norm(cell->before[k]), v3_norm(cell->after[k])));
    *y = (struct survey){
        .p = p, .s = s, .far = s->n >= FAR_BUNDLES * BUNDLE, .moving_images = most > 0
    };
    team_share(team_size(), s->n, PER_THREAD, survey_some, y);
}

/* The sum of x[slots] of all processes, in one order always */
static double sum_of_slots(const struct problem *p, const double *x)
{
    double sum = 0;
    if (p->exchange) return p->exchange->sum_along(p->exchange, p, x);
    for (int64_t i = 0; i < p->slots; i++) sum += x[i];
    return sum;
}

static int prepare_by_plan(struct problem *p, const struct packing *pack, const struct contacts *s,
                           const struct plan *plan, const struct prepare_opt *o,
                           struct failure *failure)
{
    struct exchange *exchange = o->exchange;
    const struct lattice cell = lattice_of(pack);
    struct survey found;
    survey(&found, pack, s, &cell);
    *p = (struct problem){ .d = pack->dim, .n = s->n, .dt = pack->dt, .packing = pack };
    // those of the packing, the copies, and for the lanes without a contact one `nobody` in each half
    p->bodies = pack->n + 2 + plan->copies;
    p->exchange = exchange;
    if (exchange) p->n = exchange->contacts;
    if (p->bodies > BODIES_MAX)
        return failure_set(failure, EX_DATAERR, "more than %d bodies", BODIES_MAX);
    p->body = lay_lines(p->bodies, sizeof *p->body);
    bool room = p->body && lay_plan(p, plan);
    bool levers = anywhere(p, found.shaped), rebounds = anywhere(p, found.rebounds);
    bool bonds = anywhere(p, found.bonds), rolls = anywhere(p, found.rolls);
    bool soft = anywhere(p, found.soft);
    bool near = found.turned || (exchange && exchange->slower);
    p->kind = *kind_of_bodies(levers, bonds, rolls, near);
    p->kind.soft = soft;
    if (rebounds || soft) p->kind.arrays |= HAS_rebound;
    quat *half = NULL;
    room = room && set_pulls(p, s) && lay_bundles(p) && (!levers || find_spins(p, pack, &half));
    if (!room) return free(half), problem_of_bodies_no_memory(p, failure);
    team_share(team_size(), pack->n, PER_THREAD, set_some, p);
    lay_seats(p, plan, s);
    if (!(p->held = malloc((size_t)(p->bodies - pack->n) * sizeof *p->held)))
        return free(half), problem_of_bodies_no_memory(p, failure);
    memcpy(p->held, p->body + pack->n, (size_t)(p->bodies - pack->n) * sizeof *p->held);
    struct filling f = { p, s, &cell, o->alpha, o->rho_factor, half };
    team_share(team_size(), p->bundles, PER_THREAD / BUNDLE, fill_bundles, &f);
    room = !exchange || !exchange->slower || !mass_splitting_make(p, &f, exchange->slower);
    free(half);
    if (!room) return problem_of_bodies_no_memory(p, failure);
    if (freedoms_in(pack)) {
        if (!(p->coupling = calloc(1, sizeof *p->coupling)))
            return problem_of_bodies_no_memory(p, failure);
        if (couplings_init(p->coupling, pack, s, failure)) return problem_free(p), failure->status;
    }

    double g = v3_norm(pack->g);
    p->fall = g * pack->dt;
    p->scale_v = (g > 0 ? g : 9.81) * pack->dt;
    p->scale_r = p->scale_v * (exchange ? exchange->mean_mass : packing_mean_mass(pack));
    p->speed = rotation_speed(pack);
    if (exchange) p->speed = exchange->most(exchange, p->speed);
    problem_set_free_motion(p);
    struct measuring m = { p, malloc((size_t)(p->slots + 1) * sizeof *m.q2) };
    if (!m.q2) return problem_of_bodies_no_memory(p, failure);
    team_share(team_size(), p->bundles, PER_THREAD / BUNDLE, measure_some, &m);
    p->norm_q = sqrt(sum_of_slots(p, m.q2));
    for (int64_t i = 0; i < p->slots; i++) {
        m.q2[i] = sqrt(m.q2[i]);
        p->most_q = fmax(p->most_q, m.q2[i]);
    }
    p->mean_q = sum_of_slots(p, m.q2) / (double)(p->n ? p->n : 1);
    for (int64_t i = 0; i < pack->n; i++) p->heaviest = fmax(p->heaviest, pack->mass[i]);
    if (exchange) p->most_q = exchange->most(exchange, p->most_q);
    if (exchange) p->heaviest = exchange->most(exchange, p->heaviest);
    problem_set_unit(p);
    free(m.q2);
    for (int64_t i = 0; s->found && i < p->slots; i++)
        if (p->contact[i] >= 0) take_found(p, i, s);
    if (exchange && s->found) exchange->settle(exchange, p);
    return 0;
}

int problem_prepare(struct problem *p, const struct packing *pack, const struct contacts *s,
                    const struct prepare_opt *o, struct failure *failure)
{
    const enum order order = o->schedule ? ORDER_COLOUR : o->order;
    struct plan *plan = o->kept ? *o->kept : NULL;
    if (!plan || !plan_holds(plan, order, s, pack)) {
        plan_free(plan);
        plan = plan_of_contacts(order, s, pack, o->schedule);
    }
    if (o->kept) *o->kept = plan;
    *p = (struct problem){ 0 };
    if (!plan) return problem_of_bodies_no_memory(p, failure);
    int e = prepare_by_plan(p, pack, s, plan, o, failure);
    if (o->kept) return e;
    if (e)
        plan_free(plan);
    else
        p->plan = plan;
    return e;
}
