/* step/small_springs.c: springs of contacts in small steps [step/small_springs.h]. */
#include "step/small_springs.h"

#include "contact/contact_law.h"
#include "contact/spring.h"
#include "step/small_anchor.h"
#include "step/small_point.h"
#include "step/small_stiff.h"
#include "step/small_touch.h"
#include "step/small_wall.h"

#include <math.h>
#include <string.h>

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

static bool recall_bond(struct small_run *r, const struct bond *b, int64_t *at)
{
    struct small_list *l = r->l;
    struct small_meeting *m = small_meetings_find(&l->meetings, bond_key(b));
    double x[SPRING_COUNT];
    bool found;
    if (m && !b->pressed) return small_anchor_recall(r, m, b);
    if (m) {
        m->pressed = true, m->rest = fmin(m->rest, b->rest);
        for (int64_t k = 0; k < m->points; k++)
            if (m->point[k].feature == b->feature) {
                small_anchor_stiff(r, m, &m->point[k], 1, 1);
                spring_recall(m->point[k].spring, b, r->h);
            }
        return true;
    }
    if (b->a < 0) {
        struct small_touch *t = small_list_find_touch(l, b->b, -1 - b->a);
        if (t) spring_recall(t->spring, b, r->h), t->near = true;
        return true;
    }
    *at = small_list_pair(l, *at, bond_key(b), &found);
    if (!found) return true;
    const int64_t slot = l->slot[*at];
    get_slot(&l->s, slot, x), spring_recall(x, b, r->h), set_slot(&l->s, slot, x);
    return true;
}

bool small_springs_recall(struct small_run *r)
{
    struct small_list *l = r->l;
    int64_t at = 0;
    bool room = true;
    if (!l->s.spring) return true;
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
    for (int64_t i = 0; room && i < r->p->bonds.n; i++) {
        const struct bond *b = &r->p->bonds.bond[i];
        const struct pair_law *law = &r->p->law[packing_pair(r->p, b->a, b->b)];
        if (b->pressed || (pair_law_adheres(law) && (b->beta > 0 || !b->wet)))
            room = recall_bond(r, b, &at);
    }
    return room;
}

void small_springs_recall_points(struct small_run *r)
{
    for (int64_t i = 0; i < r->l->meetings.n; i++) {
        struct small_meeting *m = &r->l->meetings.of[i];
        const double gap = small_attract_gap(m);
        if (!m->pressed && gap < 0) m->rest = gap;
        for (int64_t k = 0; k < m->points; k++) {
            struct small_point *t = &m->point[k];
            small_anchor_stiff(r, m, t, 1, 1);
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
            if (place_point(r, m, &m->point[k], of, &y))
                add_place(r, &y, &sum);
            else
                sum.broken += m->point[k].spring[SPRING_GIVEN];
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
    const double W = packing_inverse_mass(p, c->a) + packing_inverse_mass(p, c->b);
    if (b) law->jump[1] = v3_dot(b->slip, c->t1), law->jump[2] = v3_dot(b->slip, contact_t2(c));
    if (b && pair_law_adheres(l) && (b->beta > 0 || !(b->wet || b->pressed)))
        law->state |= CONTACT_LAW_BONDED;
    if (b && b->beta > 0) {
        const double area = bond_anchored(b) ? b->area : contact_laws_area(p, c);
        const double S = area * b->beta * b->beta;
        law->beta = b->beta, law->stiff[0] = S * l->cn, law->stiff[1] = S * l->ct;
        law->jump[0] = fmax(0, c->gap);
    } else if (pair_law_springs(l)) {
        law->spring[0] = l->soft > 0 ? 1 / (l->soft * W * p->dt * p->dt) : l->kn;
        law->spring[1] = l->soft > 0 ? SPRING_ACROSS * law->spring[0] : l->kt;
        law->jump[0] = c->gap - (b && b->pressed ? b->rest : 0);
    }
}
