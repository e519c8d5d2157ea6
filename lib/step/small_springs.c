/* step/small_springs.c: springs of contacts in small steps [step/small_springs.h]. */
#include "step/small_springs.h"

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

/* Of a pair alone, whose spring is damped by zeta: its speed when it parts, in units of that before, in steps of h */
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
    if (l->stiffness || !packing_has_springs(p)) return true;
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

void small_springs_set(double x[SPRING_COUNT], const struct small_list *l, const struct packing *p,
                       int32_t a, int32_t b, double wn, double wt)
{
    const struct small_stiffness *k = &l->stiffness[packing_pair(p, a, b)];
    const double h = p->dt, W = inverse_mass(p, a) + inverse_mass(p, b);
    double kn = k->kn, kt = k->kt;
    if (k->soft > 0) kn = 1 / (k->soft * W * l->interval * l->interval), kt = SPRING_ACROSS * kn;
    x[SPRING_KN] = x[SPRING_KT] = x[SPRING_GN] = x[SPRING_GT] = 0;
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

double small_springs_count(const struct packing *p)
{
    const struct lightest y = lightest_of(p);
    double most = 0;
    if (!packing_has_springs(p)) return 0;
    for (int32_t k = 0; k < p->materials * p->materials; k++) {
        const struct pair_law *l = &p->law[k];
        const double soft = l->soft > 0 ? 1 / (l->soft * p->dt * p->dt) : 0; // k/W
        const double across = l->soft > 0 ? SPRING_ACROSS * soft : 2 * l->kt * y.im;
        const double along = l->soft > 0 ? soft : 2 * l->kn * y.im;
        most = fmax(most, fmax(p->shape ? y.turns * along : along, y.turns * across));
    }
    return p->dt * sqrt(most / RESOLVED);
}

bool small_springs_stiff(const struct packing *p)
{
    return small_springs_count(p) > SPRINGS_MOST;
}

/* ---- where springs are ---- */

/* A contact with springs, where its bodies are */
struct spring_place {
    double x[SPRING_COUNT], n[3], u[3]; /* u: m/s */
    double gap, spin, mu;
};

/* rad: by which bodies with these spins turn about n in a small step */
static double spin_about(const struct small_run *r, vec3 a, vec3 b, const double n[3])
{
    return 0.5 * r->h * v3_dot(v3_add(a, b), small_vec(n));
}

static bool place_touch(const struct small_run *r, struct small_touch *t, struct spring_place *y)
{
    const struct small *s = &r->l->s;
    const struct body *b = &s->body[t->body];
    if (!t->near || !(t->spring[SPRING_KN] > 0) || !small_look_at_touch(r, t, r->l->margin))
        return false;
    vec3 u = small_touch_velocity(t, b);
    if (small_is_loaded(r, t)) {
        const int32_t k = r->loads.of[t->wall];
        const double speed = r->loads.list.f[k].speed + r->loads.change[k];
        u = v3_axpy(u, -speed, small_load_direction(r, t));
    }
    memcpy(y->x, t->spring, sizeof y->x);
    small_array(y->n, t->n), small_array(y->u, u);
    y->gap = t->arm - s->place[t->body].r, y->mu = t->mu;
    y->spin = spin_about(r, r->wall[t->wall].spin, small_vec(b->w), y->n);
    return true;
}

static bool place_slot(const struct small_run *r, int64_t slot, struct spring_place *y)
{
    const struct small *s = &r->l->s;
    const int k = (int)(slot % BUNDLE);
    const struct small_bundle *c = &s->bundle[slot / BUNDLE];
    const int64_t ia = body_index(c->a[k]), ib = body_index(c->b[k]);
    const struct body *a = &s->body[ia], *b = &s->body[ib];
    if (!(s->spring[slot / BUNDLE].x[SPRING_KN][k] > 0)) return false;
    const vec3 d = small_branch(s, slot), n = small_normal(d);
    const double ra = s->place[ia].r, rb = s->place[ib].r;
    y->gap = v3_norm(d) - ra - rb, y->mu = c->mu[k];
    if (y->gap > r->l->margin) return false;
    for (int j = 0; j < SPRING_COUNT; j++) y->x[j] = s->spring[slot / BUNDLE].x[j][k];
    const vec3 wa = small_vec(a->w), wb = small_vec(b->w), half = v3_scale(0.5 * y->gap, n);
    const vec3 arms = v3_add(v3_scale(ra, wa), v3_scale(rb, wb));
    vec3 u = v3_sub(v3_sub(small_vec(b->v), small_vec(a->v)), v3_cross(arms, n));
    u = v3_sub(u, v3_cross(v3_add(wa, wb), half));
    if (s->moves) u = v3_add(u, small_image_velocity(s, slot));
    small_array(y->n, n), small_array(y->u, u);
    y->spin = spin_about(r, wa, wb, y->n);
    return true;
}

static bool place_point(const struct small_run *r, const struct small_meeting *m,
                        const struct small_point *t, const struct body *of, struct spring_place *y)
{
    const int32_t a = m->key.a;
    if (!(t->spring[SPRING_KN] > 0) || !t->there || t->seam) return false;
    memcpy(y->x, t->spring, sizeof y->x);
    small_array(y->n, t->n), small_array(y->u, small_point_velocity(r, m, t, of));
    y->gap = t->gap, y->mu = t->mu;
    y->spin = spin_about(r, a < 0 ? r->wall[-1 - a].spin : small_vec(of[a].w),
                         small_vec(of[m->key.b].w), y->n);
    return true;
}

/* x_t and g_0 are those of now. */
static void place_now(const struct small_run *r, struct spring_place *y)
{
    double q[3];
    small_spring_begin(y->x, y->n, y->gap, y->u, y->spin, y->mu, 0, r->h, q);
}

/* ---- from the packing ---- */

/* Of a pair that is first seen with this gap: an overlap pushes nothing. */
static void spring_start(double x[SPRING_COUNT], double gap)
{
    x[SPRING_REST] = fmin(0, gap);
    for (int k = SPRING_X; k < SPRING_COUNT; k++) x[k] = 0;
}

/* What a bond has kept; where the stiffness follows from dt, springs push as before [contact/spring.h]. */
static void spring_recall(double x[SPRING_COUNT], const struct bond *b, double gap, double h)
{
    const double times = b->spring > 0 && x[SPRING_KN] > 0 ? b->spring * h / x[SPRING_KN] : 1;
    x[SPRING_REST] = fmin(0, b->rest + (1 - times) * (gap - b->rest));
    small_array(x + SPRING_X, v3_scale(times, b->slip));
    x[SPRING_DUE] = 0;
}

static double slot_gap(const struct small *s, int64_t slot)
{
    const struct small_bundle *c = &s->bundle[slot / BUNDLE];
    const int k = (int)(slot % BUNDLE);
    return v3_norm(small_branch(s, slot)) - s->place[body_index(c->a[k])].r -
           s->place[body_index(c->b[k])].r;
}

static void set_slot(struct small *s, int64_t slot, const double x[SPRING_COUNT])
{
    for (int j = SPRING_REST; j < SPRING_COUNT; j++)
        s->spring[slot / BUNDLE].x[j][slot % BUNDLE] = x[j];
}

static void recall_bond(struct small_run *r, const struct bond *b, int64_t *at)
{
    struct small_list *l = r->l;
    struct small_meeting *m = small_meetings_find(&l->meetings, bond_key(b));
    double x[SPRING_COUNT] = { 0 };
    bool found;
    if (m) {
        m->pressed = true, m->rest = fmin(m->rest, b->rest);
        for (int64_t k = 0; k < m->points; k++)
            if (m->point[k].feature == b->feature) {
                small_springs_set(m->point[k].spring, l, r->p, b->a, b->b, 1, 1);
                spring_recall(m->point[k].spring, b, b->gap, r->h);
            }
        return;
    }
    if (b->a < 0) {
        struct small_touch *t = small_list_find_touch(l, b->b, -1 - b->a);
        if (t) spring_recall(t->spring, b, b->gap, r->h), t->near = true;
        return;
    }
    *at = small_list_pair(l, *at, bond_key(b), &found);
    if (!found) return;
    const int64_t slot = l->slot[*at];
    x[SPRING_KN] = l->s.spring[slot / BUNDLE].x[SPRING_KN][slot % BUNDLE];
    spring_recall(x, b, b->gap, r->h), set_slot(&l->s, slot, x), small_list_wake(&l->s, slot);
}

void small_springs_recall(struct small_run *r)
{
    struct small_list *l = r->l;
    int64_t at = 0;
    if (!l->s.spring) return;
    for (int64_t i = 0; i < l->pairs.n; i++) {
        double x[SPRING_COUNT];
        spring_start(x, slot_gap(&l->s, l->slot[i])), set_slot(&l->s, l->slot[i], x);
    }
    for (int64_t i = 0; i < l->touches; i++) {
        struct small_touch *t = &l->touch[i];
        if (small_look_at_touch(r, t, l->margin))
            spring_start(t->spring, t->arm - l->s.place[t->body].r);
    }
    for (int64_t i = 0; i < r->p->bonds.n; i++)
        if (r->p->bonds.bond[i].pressed) recall_bond(r, &r->p->bonds.bond[i], &at);
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

/* J: positions of bodies are r->ahead before those where contacts act. */
static double stored_at(const struct small_run *r, struct spring_place *y)
{
    place_now(r, y);
    const double un = dot3(y->n, y->u), xn = y->gap - y->x[SPRING_REST];
    for (int j = 0; j < 3 && xn < 0; j++) y->x[SPRING_X + j] -= r->ahead * (y->u[j] - un * y->n[j]);
    return small_spring_energy(y->x, xn - r->ahead * un, r->h);
}

double small_springs_stored_points(const struct small_run *r, const struct body *of)
{
    const struct small_list *l = r->l;
    struct spring_place y;
    double sum = 0;
    for (int64_t i = 0; l->stiffness && i < l->meetings.n; i++) {
        const struct small_meeting *m = &l->meetings.of[i];
        for (int64_t k = 0; k < m->points; k++)
            if (place_point(r, m, &m->point[k], of, &y)) sum += stored_at(r, &y);
    }
    return sum;
}

double small_springs_stored(const struct small_run *r)
{
    const struct small_list *l = r->l;
    struct spring_place y;
    double sum = 0;
    if (!l->s.spring) return 0;
    for (int64_t i = 0; i < l->touches; i++)
        if (place_touch(r, &l->touch[i], &y)) sum += stored_at(r, &y);
    for (int64_t i = 0; i < l->pairs.n; i++)
        if (place_slot(r, l->slot[i], &y)) sum += stored_at(r, &y);
    return sum;
}

/* ---- and back ---- */

static bool keep_place(const struct small_run *r, struct spring_place *y, struct bond *b)
{
    place_now(r, y);
    if (!(y->gap < 0)) return false;
    b->pressed = 1, b->gap = y->gap, b->n = small_vec(y->n);
    b->rest = y->x[SPRING_REST], b->slip = small_vec(y->x + SPRING_X);
    if (r->p->law[packing_pair(r->p, b->a, b->b)].soft > 0) b->spring = y->x[SPRING_KN] / r->h;
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
    if (!pair_law_springs(l)) return;
    law->spring[0] = l->soft > 0 ? 1 / (l->soft * W * p->dt * p->dt) : l->kn;
    law->spring[1] = l->soft > 0 ? SPRING_ACROSS * law->spring[0] : l->kt;
    law->jump[0] = c->gap;
    if (!b || !b->pressed) return;
    law->jump[0] -= b->rest;
    law->jump[1] = v3_dot(b->slip, c->t1), law->jump[2] = v3_dot(b->slip, contact_t2(c));
}
