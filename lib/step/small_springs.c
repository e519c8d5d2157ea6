/* step/small_springs.c: springs of contacts in small steps [step/small_springs.h]. */
#include "step/small_springs.h"

#include "contact/contact_law.h"
#include "contact/spring.h"
#include "state/rotation.h"
#include "step/small_point.h"
#include "step/small_touch.h"
#include "step/small_wall.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* k h^2 W of a contact at most: 16 small steps in an impact without damping */
#define RESOLVED 0.04
/* Small steps of a step: one whose springs need more is made at once, as many would cost more than its solve */
enum { SPRINGS_MOST = 1000 };
/* Restitution at least, and damping ratios at most */
#define E_LEAST   0.01
#define ZETA_MOST 20.0
/* Steps of the oscillator that they are sought with, in units of 1/frequency; between, they are linear */
static const double STEP[2] = { 0.01, 0.2 };
enum { BISECTIONS = 40 };

/* ---- what pairs of materials give ---- */

/* Of a pair alone, whose spring is damped by zeta: its speed when it parts, in units of that before, in steps of h. It has touched
   half a step before the first one. */
static double rebound(double zeta, double h)
{
    double x = -0.5 * h, u = -1;
    while (x < 0) {
        const double next = (u - h * x) / (1 + 2 * zeta * h);
        if (!(next > u)) break;
        u = next, x += h * u;
    }
    return u > 0 ? u : 0;
}

static void set_zeta(double zeta[2], double e)
{
    for (int j = 0; j < 2 && e < 1; j++) {
        double lo = 0, hi = ZETA_MOST;
        for (int k = 0; k < BISECTIONS; k++) {
            const double is = 0.5 * (lo + hi);
            *(rebound(is, STEP[j]) > fmax(e, E_LEAST) ? &lo : &hi) = is;
        }
        zeta[j] = hi;
    }
}

bool small_springs_table(struct small_list *l, const struct packing *p)
{
    const int32_t n = p->materials * p->materials;
    if (l->stiffness || !(packing_has_springs(p) || packing_adheres(p))) return true;
    l->stiffness = calloc((size_t)n + 1, sizeof *l->stiffness);
    for (int32_t k = 0; l->stiffness && k < n; k++) {
        struct small_stiffness *y = &l->stiffness[k];
        if (!pair_law_springs(&p->law[k])) continue;
        y->kn = p->law[k].kn, y->kt = p->law[k].kt, y->soft = p->law[k].soft;
        set_zeta(y->zeta[0], p->en[k]), set_zeta(y->zeta[1], p->et[k]);
    }
    return l->stiffness != NULL;
}

static double inverse_mass(const struct packing *p, int32_t i)
{
    return i >= 0 && p->mass[i] > 0 ? 1 / p->mass[i] : 0;
}

/* kg: h times what a dashpot pushes by for each m/s */
static double damping(const double zeta[2], double h, double k, double w)
{
    const double step = h * sqrt(k * w), part = fmin(1, step / STEP[1]);
    return 2 * (zeta[0] + part * (zeta[1] - zeta[0])) * step / w;
}

static void set_bond(double x[SPRING_COUNT], const struct packing *p, int32_t a, int32_t b)
{
    const struct pair_law *l = &p->law[packing_pair(p, a, b)];
    const struct contact c = { .a = a, .b = b };
    const double S = pair_law_adheres(l) ? contact_laws_area(p, &c) : 0;
    x[SPRING_SN] = p->dt * S * l->cn, x[SPRING_ST] = p->dt * S * l->ct;
    x[SPRING_SW] = S * l->w, x[SPRING_SETA] = S * l->eta;
    x[SPRING_FRESH] = S > 0 && l->forever ? l->beta : 0,
    x[SPRING_TOUCH] = contact_laws_touch(p, &c);
}

void small_springs_set(double x[SPRING_COUNT], const struct small_list *l, const struct packing *p,
                       int32_t a, int32_t b, double wn, double wt)
{
    const struct small_stiffness *k = &l->stiffness[packing_pair(p, a, b)];
    const double h = p->dt, W = inverse_mass(p, a) + inverse_mass(p, b);
    double kn = k->kn, kt = k->kt;
    if (k->soft > 0) kn = 1 / (k->soft * W * l->interval * l->interval), kt = SPRING_ACROSS * kn;
    x[SPRING_KN] = x[SPRING_KT] = x[SPRING_GN] = x[SPRING_GT] = 0;
    x[SPRING_YIELD] = a < 0 && p->wall[-1 - a].load.way ? h : 0;
    set_bond(x, p, a, b);
    if (!(kn > 0) || !isfinite(kn)) return;
    x[SPRING_KN] = h * kn, x[SPRING_KT] = h * kt;
    x[SPRING_GN] = damping(k->zeta[0], h, kn, wn);
    x[SPRING_GT] = damping(k->zeta[1], h, kt, wt);
}

/* ---- how many small steps ---- */

/* Of bodies: the largest 1/m, and by how much more a contact at the rim of one may have */
struct lightest {
    double im, turns;
};

static struct lightest lightest_of(const struct packing *p)
{
    struct lightest y = { 0, 1 };
    for (int64_t i = 0; i < p->n; i++) {
        if (!(p->mass[i] > 0)) continue;
        const vec3 m = rotation_moments(p, i);
        const double least = p->dim == 2 ? m.z : fmin(m.x, fmin(m.y, m.z));
        y.im = fmax(y.im, 1 / p->mass[i]);
        y.turns = fmax(y.turns, 1 + p->radius[i] * p->radius[i] * p->mass[i] / least);
    }
    return y;
}

/* m^2/kg: the largest S/m of bonds with this law, where the lighter of two bodies decides their area */
static double bond_per_mass(const struct packing *p, const struct pair_law *l,
                            const struct lightest *y)
{
    double most = 0;
    if (!pair_law_adheres(l)) return 0;
    if (l->area > 0) return l->area * y->im;
    for (int64_t i = 0; i < p->n; i++) {
        const double r = p->radius[i], S = p->dim == 2 ? 2 * r : M_PI * r * r;
        if (p->mass[i] > 0) most = fmax(most, S / p->mass[i]);
    }
    return most;
}

/* 1/s^2: the largest k W of a pair of materials */
static double stiffest(const struct packing *p, const struct pair_law *l, const struct lightest *y)
{
    const double soft = l->soft > 0 ? 1 / (l->soft * p->dt * p->dt) : 0;
    const double along = l->soft > 0 ? soft : 2 * l->kn * y->im;
    const double across = l->soft > 0 ? SPRING_ACROSS * soft : 2 * l->kt * y->im;
    const double S = 2 * bond_per_mass(p, l, y), turns = p->shape ? y->turns : 1;
    return fmax(turns * fmax(along, S * l->cn), y->turns * fmax(across, S * l->ct));
}

double small_springs_count(const struct packing *p)
{
    double most = 0;
    if (!packing_has_springs(p) && !packing_adheres(p)) return 0;
    const struct lightest y = lightest_of(p);
    for (int32_t k = 0; k < p->materials * p->materials; k++)
        most = fmax(most, stiffest(p, &p->law[k], &y));
    return p->dt * sqrt(most / RESOLVED);
}

bool small_springs_stiff(const struct packing *p)
{
    return small_springs_count(p) > SPRINGS_MOST;
}

/* ---- where springs are ---- */

/* A contact with springs or bonds, where its bodies are */
struct spring_place {
    double x[SPRING_COUNT];
    struct small_stretch at;
};

static bool may_act(double kn, double sn)
{
    return kn > 0 || sn > 0;
}

/* rad: by which bodies with these spins turn about n in a small step */
static double spin_about(const struct small_run *r, vec3 a, vec3 b, vec3 n)
{
    return 0.5 * r->h * v3_dot(v3_add(a, b), n);
}

/* But for the gap and mu; g_0 does not rise */
static void set_stretch(const struct small_run *r, struct small_stretch *at, vec3 n, vec3 u,
                        double spin, bool pushed)
{
    small_array(at->n, n), small_array(at->u, u);
    at->spin = spin, at->pushed = pushed ? -1 : 0, at->h = r->h, at->rise = 0;
}

static bool place_touch(const struct small_run *r, struct small_touch *t, struct spring_place *y)
{
    const struct small *s = &r->l->s;
    const struct body *b = &s->body[t->body];
    if (!t->near || !(may_act(t->spring[SPRING_KN], t->spring[SPRING_SN])) ||
        !small_look_at_touch(r, t, r->l->margin))
        return false;
    vec3 u = small_touch_velocity(t, b);
    if (small_is_loaded(r, t)) {
        const int32_t k = r->loads.of[t->wall];
        const double speed = r->loads.list.f[k].speed + r->loads.change[k];
        u = v3_axpy(u, -speed, small_load_direction(r, t));
    }
    memcpy(y->x, t->spring, sizeof y->x);
    const double spin = spin_about(r, r->wall[t->wall].spin, small_vec(b->w), t->n);
    set_stretch(r, &y->at, t->n, u, spin, v3_dot(small_vec(t->f), t->n) > 0);
    y->at.gap = t->arm - s->place[t->body].r, y->at.mu = t->mu;
    return true;
}

static bool place_slot(const struct small_run *r, int64_t slot, struct spring_place *y)
{
    const struct small *s = &r->l->s;
    const int k = (int)(slot % BUNDLE);
    const struct small_bundle *c = &s->bundle[slot / BUNDLE];
    const int64_t ia = body_index(c->a[k]), ib = body_index(c->b[k]);
    const struct body *a = &s->body[ia], *b = &s->body[ib];
    const struct small_springs *x = &s->spring[slot / BUNDLE];
    if (!may_act(x->x[SPRING_KN][k], x->x[SPRING_SN][k])) return false;
    const vec3 d = small_branch(s, slot), n = small_normal(d);
    const double ra = s->place[ia].r, rb = s->place[ib].r;
    y->at.gap = v3_norm(d) - ra - rb, y->at.mu = c->mu[k];
    if (y->at.gap > r->l->margin) return false;
    for (int j = 0; j < SPRING_COUNT; j++) y->x[j] = s->spring[slot / BUNDLE].x[j][k];
    const vec3 wa = small_vec(a->w), wb = small_vec(b->w), half = v3_scale(0.5 * y->at.gap, n);
    const vec3 arms = v3_add(v3_scale(ra, wa), v3_scale(rb, wb));
    vec3 u = v3_sub(v3_sub(small_vec(b->v), small_vec(a->v)), v3_cross(arms, n));
    u = v3_sub(u, v3_cross(v3_add(wa, wb), half));
    if (s->moves) u = v3_add(u, small_image_velocity(s, slot));
    const vec3 f = v3(c->f[0][k], c->f[1][k], c->f[2][k]);
    set_stretch(r, &y->at, n, u, spin_about(r, wa, wb, n), v3_dot(f, n) > 0);
    return true;
}

static bool place_point(const struct small_run *r, const struct small_meeting *m,
                        const struct small_point *t, const struct body *of, struct spring_place *y)
{
    const int32_t a = m->key.a;
    if (!(may_act(t->spring[SPRING_KN], t->spring[SPRING_SN])) || !t->there || t->seam)
        return false;
    memcpy(y->x, t->spring, sizeof y->x);
    const vec3 wa = a < 0 ? r->wall[-1 - a].spin : small_vec(of[a].w);
    const double spin = spin_about(r, wa, small_vec(of[m->key.b].w), t->n);
    set_stretch(r, &y->at, t->n, small_point_velocity(r, m, t, of), spin, false);
    y->at.gap = t->gap, y->at.mu = t->mu;
    return true;
}

/* What lasts is that of now. */
static void place_now(struct spring_place *y)
{
    double q[3];
    small_spring_begin(y->x, &y->at, q);
}

/* ---- from the packing ---- */

/* Of a pair that is first seen with this gap: an overlap pushes nothing. bonded: beta of a bond that is made if it touches */
static void spring_start(double x[SPRING_COUNT], double gap, double bonded)
{
    x[SPRING_REST] = fmin(0, gap);
    for (int k = SPRING_X; k <= SPRING_GIVEN; k++) x[k] = 0;
    if (bonded > 0 && gap <= x[SPRING_TOUCH]) x[SPRING_BETA] = bonded, x[SPRING_HELD] = 1;
}

/* What a bond has kept; where the stiffness follows from dt, springs push as before [contact/spring.h]. */
static void spring_recall(double x[SPRING_COUNT], const struct bond *b, double h)
{
    const double times = b->spring > 0 && x[SPRING_KN] > 0 ? b->spring * h / x[SPRING_KN] : 1;
    x[SPRING_REST] = b->pressed ? fmin(0, b->rest + (1 - times) * (b->gap - b->rest)) : 0;
    small_array(x + SPRING_X, v3_scale(times, b->slip));
    x[SPRING_DUE] = 0, x[SPRING_PART] = b->pressed;
    if (x[SPRING_SN] > 0) x[SPRING_BETA] = b->beta, x[SPRING_HELD] = 1;
}

/* Beta of bonds that are made of a pair of bodies that touches where the interval begins; 0: none are */
static double bonds_at_once(const struct small_run *r, int32_t a, int32_t b)
{
    const struct pair_law *l = &r->p->law[packing_pair(r->p, a, b)];
    struct packing whole = *r->p;
    whole.dt = r->l->interval;
    return contact_laws_bond(&whole, l) ? l->beta : 0;
}

static double slot_gap(const struct small *s, int64_t slot)
{
    const struct small_bundle *c = &s->bundle[slot / BUNDLE];
    const int k = (int)(slot % BUNDLE);
    return v3_norm(small_branch(s, slot)) - s->place[body_index(c->a[k])].r -
           s->place[body_index(c->b[k])].r;
}

static void get_slot(const struct small *s, int64_t slot, double x[SPRING_COUNT])
{
    for (int j = 0; j < SPRING_COUNT; j++) x[j] = s->spring[slot / BUNDLE].x[j][slot % BUNDLE];
}

static void set_slot(struct small *s, int64_t slot, const double x[SPRING_COUNT])
{
    for (int j = 0; j < SPRING_COUNT; j++) s->spring[slot / BUNDLE].x[j][slot % BUNDLE] = x[j];
    if (x[SPRING_BETA] > 0) small_list_wake(s, slot);
}

static void recall_bond(struct small_run *r, const struct bond *b, int64_t *at)
{
    struct small_list *l = r->l;
    struct small_meeting *m = small_meetings_find(&l->meetings, bond_key(b));
    double x[SPRING_COUNT];
    bool found;
    if (m) {
        m->pressed = true, m->rest = fmin(m->rest, b->rest);
        for (int64_t k = 0; k < m->points; k++)
            if (m->point[k].feature == b->feature) {
                small_springs_set(m->point[k].spring, l, r->p, b->a, b->b, 1, 1);
                spring_recall(m->point[k].spring, b, r->h);
            }
        return;
    }
    if (b->a < 0) {
        struct small_touch *t = small_list_find_touch(l, b->b, -1 - b->a);
        if (t) spring_recall(t->spring, b, r->h), t->near = true;
        return;
    }
    *at = small_list_pair(l, *at, bond_key(b), &found);
    if (!found) return;
    const int64_t slot = l->slot[*at];
    get_slot(&l->s, slot, x), spring_recall(x, b, r->h), set_slot(&l->s, slot, x);
}

void small_springs_recall(struct small_run *r)
{
    struct small_list *l = r->l;
    int64_t at = 0;
    if (!l->s.spring) return;
    for (int64_t i = 0; i < l->pairs.n; i++) {
        const struct pair *q = &l->pairs.pair[i];
        double x[SPRING_COUNT];
        get_slot(&l->s, l->slot[i], x);
        spring_start(x, slot_gap(&l->s, l->slot[i]), bonds_at_once(r, q->a, q->b));
        set_slot(&l->s, l->slot[i], x);
    }
    for (int64_t i = 0; i < l->touches; i++) {
        struct small_touch *t = &l->touch[i];
        if (!small_look_at_touch(r, t, l->margin)) continue;
        spring_start(t->spring, t->arm - l->s.place[t->body].r,
                     bonds_at_once(r, -1 - t->wall, t->body));
        t->near = t->spring[SPRING_BETA] > 0;
    }
    for (int64_t i = 0; i < r->p->bonds.n; i++) {
        const struct bond *b = &r->p->bonds.bond[i];
        const struct pair_law *law = &r->p->law[packing_pair(r->p, b->a, b->b)];
        if (b->pressed || (pair_law_adheres(law) && (b->beta > 0 || !b->wet)))
            recall_bond(r, b, &at);
    }
}

void small_springs_recall_points(struct small_run *r)
{
    for (int64_t i = 0; i < r->l->meetings.n; i++) {
        struct small_meeting *m = &r->l->meetings.of[i];
        const double gap = small_attract_gap(m);
        if (!m->pressed && gap < 0) m->rest = gap;
        for (int64_t k = 0; k < m->points; k++) {
            struct small_point *t = &m->point[k];
            small_springs_set(t->spring, r->l, r->p, m->key.a, m->key.b, 1, 1);
            if (!m->pressed) t->spring[SPRING_REST] = m->rest;
        }
    }
}

/* ---- what they store ---- */

/* Positions of bodies are r->ahead before those where contacts act. */
static void add_place(const struct small_run *r, struct spring_place *y,
                      struct small_spring_sums *to)
{
    const struct small_stretch *at = &y->at;
    place_now(y);
    const double un = dot3(at->n, at->u);
    const bool acts = y->x[SPRING_BETA] > 0 || at->gap < y->x[SPRING_REST];
    for (int j = 0; j < 3 && acts; j++) y->x[SPRING_X + j] -= r->ahead * (at->u[j] - un * at->n[j]);
    to->stored += small_spring_energy(y->x, at->gap - r->ahead * un, r->h);
    to->broken += y->x[SPRING_GIVEN];
}

struct small_spring_sums small_springs_points(const struct small_run *r, const struct body *of)
{
    const struct small_list *l = r->l;
    struct small_spring_sums sum = { 0, 0 };
    struct spring_place y;
    for (int64_t i = 0; l->stiffness && i < l->meetings.n; i++) {
        const struct small_meeting *m = &l->meetings.of[i];
        for (int64_t k = 0; k < m->points; k++)
            if (place_point(r, m, &m->point[k], of, &y)) add_place(r, &y, &sum);
    }
    return sum;
}

struct small_spring_sums small_springs_sums(const struct small_run *r)
{
    const struct small_list *l = r->l;
    struct small_spring_sums sum = { 0, 0 };
    struct spring_place y;
    if (!l->s.spring) return sum;
    for (int64_t i = 0; i < l->touches; i++)
        if (place_touch(r, &l->touch[i], &y)) add_place(r, &y, &sum);
    for (int64_t i = 0; i < l->pairs.n; i++)
        if (place_slot(r, l->slot[i], &y)) add_place(r, &y, &sum);
    return sum;
}

/* ---- and back ---- */

static bool keep_place(const struct small_run *r, struct spring_place *y, struct bond *b)
{
    const struct pair_law *law = &r->p->law[packing_pair(r->p, b->a, b->b)];
    place_now(y);
    const double *x = y->x, gap = y->at.gap;
    const bool bonded = x[SPRING_HELD] > 0 && (x[SPRING_BETA] > 0 || gap <= x[SPRING_TOUCH]);
    const bool pressed = x[SPRING_KN] > 0 && !(x[SPRING_BETA] > 0) && gap < 0;
    if (!bonded && !pressed) return false;
    b->gap = gap, b->n = small_vec(y->at.n), b->slip = small_vec(x + SPRING_X);
    b->beta = x[SPRING_BETA];
    if (pressed) b->pressed = 1, b->rest = x[SPRING_REST];
    if (pressed && law->soft > 0) b->spring = x[SPRING_KN] / r->h;
    return true;
}

bool small_springs_keep_touch(const struct small_run *r, struct small_touch *t, struct bond *b)
{
    struct spring_place y;
    return r->l->s.spring && place_touch(r, t, &y) && keep_place(r, &y, b);
}

bool small_springs_keep_slot(const struct small_run *r, int64_t slot, struct bond *b)
{
    struct spring_place y;
    return r->l->s.spring && place_slot(r, slot, &y) && keep_place(r, &y, b);
}

bool small_springs_keep_point(const struct small_run *r, const struct small_meeting *m,
                              const struct small_point *t, struct bond *b)
{
    struct spring_place y;
    return r->l->s.spring && place_point(r, m, t, r->l->s.body, &y) && keep_place(r, &y, b);
}

void small_springs_law(struct contact_law *law, const struct packing *p, const struct contact *c,
                       const struct bond *b)
{
    const struct pair_law *l = &p->law[packing_pair(p, c->a, c->b)];
    const double W = inverse_mass(p, c->a) + inverse_mass(p, c->b);
    if (b) law->jump[1] = v3_dot(b->slip, c->t1), law->jump[2] = v3_dot(b->slip, contact_t2(c));
    if (b && pair_law_adheres(l) && (b->beta > 0 || !(b->wet || b->pressed)))
        law->state |= CONTACT_LAW_BONDED;
    if (b && b->beta > 0) {
        const double S = contact_laws_area(p, c) * b->beta * b->beta;
        law->beta = b->beta, law->stiff[0] = S * l->cn, law->stiff[1] = S * l->ct;
        law->jump[0] = fmax(0, c->gap);
    } else if (pair_law_springs(l)) {
        law->spring[0] = l->soft > 0 ? 1 / (l->soft * W * p->dt * p->dt) : l->kn;
        law->spring[1] = l->soft > 0 ? SPRING_ACROSS * law->spring[0] : l->kt;
        law->jump[0] = c->gap - (b && b->pressed ? b->rest : 0);
    }
}
