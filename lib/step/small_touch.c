/* step/small_touch.c: the law where a ball touches a wall [step/small_touch.h]. */
#include "step/small_touch.h"

#include "step/small_seam.h"
#include "step/small_wall.h"

#include <string.h>

void small_body_push(struct body *b, vec3 f, vec3 m)
{
    b->v[0] += b->im * f.x, b->v[1] += b->im * f.y, b->v[2] += b->im * f.z;
    b->w[0] += b->ii * m.x, b->w[1] += b->ii * m.y, b->w[2] += b->ii * m.z;
}

/* N m s: of a reaction at the contact, about the body's centre */
static vec3 touch_couple(const struct small_touch *t, const double f[3])
{
    return v3_scale(-t->arm, v3_cross(t->n, small_vec(f)));
}

/* N m s: of rolling friction and of the reaction, on the body */
static vec3 touch_moment(const struct small_touch *t)
{
    return v3_add(small_vec(t->couple), small_vec(t->m));
}

/* Springs and the bond, in the first sweep; u: before it (m/s). q: as of small_spring_begin() */
static void stretch_touch(const struct small_run *r, struct small_touch *t,
                          const struct small_law *l, const double u[3], bool pushed, double q[3])
{
    struct small_stretch at = { .gap = l->gap,
                                .mu = t->mu,
                                .spin = l->spin,
                                .pushed = pushed ? -1 : 0,
                                .h = r->h,
                                .rise = r->l->s.rate.rise };
    memcpy(at.n, l->n, sizeof at.n), memcpy(at.u, u, sizeof at.u);
    small_spring_begin(t->spring, &at, q);
}

/* The law in the first sweep of a step */
static void begin_touch(const struct small_run *r, struct small_touch *t, struct small_law *l)
{
    const struct small *s = &r->l->s;
    const double warm = s->rate.warm;
    double before[3];
    const bool pushed = dot3(l->n, l->f) > 0;
    for (int k = 0; k < 3; k++) t->sum[k] += t->f[k], l->f[k] *= warm, t->f[k] *= warm;
    for (int k = 0; k < 3; k++) t->turned[k] += t->m[k], t->m[k] *= warm, t->couple[k] *= warm;
    const vec3 lacks = v3_sub(touch_couple(t, l->f), small_vec(t->couple)); // where it is now
    const vec3 turn = v3_scale(-t->arm * s->body[t->body].ii, v3_cross(lacks, t->n));
    l->u[0] += turn.x, l->u[1] += turn.y, l->u[2] += turn.z;
    vec3 w = v3_add(r->wall[t->wall].spin, small_vec(s->body[t->body].w));
    l->spin = 0.5 * r->h * v3_dot(w, t->n);
    small_array(before, small_touch_before(r, t));
    double p[3] = { 0, 0, 0 }, q[3], e[2] = { t->e[0], t->e[1] };
    if (r->l->stiffness) stretch_touch(r, t, l, before, pushed, q);
    if (t->spring[SPRING_BETA] > 0) small_bond_pull(t->spring, l->n, l->gap, p);
    if (small_bond_stills(t->spring)) e[0] = e[1] = 0;
    for (int k = 0; k < 3; k++) l->f[k] -= p[k];
    t->kept = dot3(l->n, l->f);
    const double kept = t->kept;
    small_press(l, &s->rate);
    small_meet(l, &s->rate, before, &t->kept, e[0], e[1]);
    for (int k = 0; k < 3; k++) l->f[k] += p[k];
    if (small_spring_acts(t->spring)) memcpy(l->q, q, sizeof l->q), t->kept = kept;
    memcpy(t->q, l->q, sizeof t->q);
}

void small_touch_solve(const struct small_touch *t, struct small_law *l, double h, double df[3])
{
    if (t->spring[SPRING_KN] > 0 || t->spring[SPRING_SN] > 0)
        small_solve_springs(l, t->spring, h, df);
    else
        small_solve(l, df);
}

/* dc: the change of the couple, which leaves dm to be made */
static void roll_touch(const struct small_run *r, struct small_touch *t, const struct small_law *l,
                       vec3 dc, double dm[3])
{
    const struct body *b = &r->l->s.body[t->body];
    double w[3];
    vec3 spin = v3_axpy(small_vec(b->w), b->ii, dc);
    small_array(w, v3_sub(spin, r->wall[t->wall].spin));
    small_roll(l->n, l->rn, w, b->ii, t->most, t->m, dm);
}

/* Attraction of a body that has pushed l->f, in the first sweep: l->u gets it. Returns the change of the pull, of which
   rate.warm persists (N s). */
static vec3 hold_touch(const struct small_run *r, struct small_touch *t, struct small_law *l)
{
    double dp[3];
    const double pull = small_hold_pull(t->hold, l->n, l->gap, lt(0, dot3(l->n, l->f)), r->h,
                                        r->l->s.rate.warm, dp);
    for (int k = 0; k < 3; k++) t->sum[k] -= pull * l->n[k], l->u[k] -= l->wn * dp[k];
    l->calm = r->l->s.rate.calm + 2 * l->wn * pull;
    return small_vec(dp);
}

/* mu of the step, by the velocities before it */
static void stick_touch(const struct small_run *r, struct small_touch *t)
{
    const struct packing *p = r->p;
    const int32_t pair = packing_pair(p, -1 - t->wall, t->body);
    const vec3 u = small_touch_before(r, t);
    double mu[2], v_s;
    small_tie_stick(mu, &v_s, p, pair);
    t->mu = mu[v3_norm(v3_axpy(u, -v3_dot(u, t->n), t->n)) > v_s];
}

/* N s: what persists of the reaction and the pull of the last step, on the body */
static vec3 small_touch_persists(const struct small_run *r, const struct small_touch *t)
{
    return v3_scale(r->l->s.rate.warm,
                    v3_axpy(small_vec(t->f), -t->hold[HOLD_PULL], small_vec(&t->hold[HOLD_X])));
}

/* A touch whose body has left gives its reaction back. */
static void leave_touch(struct small_run *r, struct small_touch *t)
{
    vec3 f = v3_scale(-1, small_touch_persists(r, t)),
         m = v3_scale(-r->l->s.rate.warm, touch_moment(t));
    const bool pushed = !small_is_zero(t->f) || t->hold[HOLD_PULL] > 0;
    t->hold[HOLD_WET] = t->hold[HOLD_PULL] = 0;
    if (pushed) small_load_push(r, t, f);
    if (pushed) small_body_push(&r->l->s.body[t->body], f, m);
    for (int k = 0; k < 3; k++) t->sum[k] += t->f[k], t->turned[k] += t->m[k];
    for (int k = 0; k < 3; k++) t->f[k] = t->couple[k] = t->m[k] = 0;
    for (int k = SPRING_X; k <= SPRING_HELD; k++) t->spring[k] = 0;
    t->kept = 0, t->near = false;
}

bool small_touch_waits(const struct small_run *r, const struct small_touch *t)
{
    const struct small *s = &r->l->s;
    return !t->near && !s->hold && small_is_zero(t->f) && s->rate.gone + s->rate.reach < t->until;
}

bool small_touch_near(struct small_run *r, struct small_touch *t)
{
    const struct small *s = &r->l->s;
    const bool held = s->hold || t->spring[SPRING_BETA] > 0;
    const double reach = held ? r->l->margin : s->rate.reach;
    const bool within = small_look_at_touch(r, t, reach);
    t->near = within && !small_at_seam(r, t - r->l->touch, reach);
    if (!t->near) leave_touch(r, t);
    if (within || held || s->moves || !r->wall[t->wall].there) return t->near;
    const bool close = small_look_at_touch(r, t, r->l->margin);
    const double gap = close ? t->arm - s->place[t->body].r : r->l->margin;
    t->until = s->rate.gone + gap - s->slack;
    return t->near;
}

vec3 small_touch_begin(const struct small_run *r, struct small_touch *t, struct small_law *l)
{
    const struct small *s = &r->l->s;
    const vec3 dp = s->hold ? hold_touch(r, t, l) : v3(0, 0, 0);
    if (s->stick) stick_touch(r, t);
    l->mu = t->mu;
    begin_touch(r, t, l);
    l->most = small_most(l, &s->rate, t->kept);
    return dp;
}

void small_touch_give(struct small_run *r, struct small_touch *t, const struct small_law *l,
                      double df[3], vec3 dp, double heavy, bool again)
{
    struct small *s = &r->l->s;
    double dm[3] = { 0, 0, 0 };
    const vec3 couple = touch_couple(t, l->rt), dc = v3_sub(couple, small_vec(t->couple));
    memcpy(t->f, l->f, sizeof t->f), small_array(t->couple, couple);
    if (s->turn) roll_touch(r, t, l, dc, dm);
    const vec3 given = v3_sub(small_vec(df), dp);
    small_body_push(&s->body[t->body], given, v3_add(dc, small_vec(dm)));
    const double turn = t->arm * s->body[t->body].ii * norm3(dm);
    const double change = heavy * (l->wn * v3_norm(given) + turn);
    if (!again && !(change > (1 + t->e[0]) * s->rate.allowed[0])) return;
    s->change[t->body] += change;
    if (!(s->change[t->body] > s->rate.allowed[again])) return;
    s->change[t->body] = 0, s->hot[t->body] = s->sweep;
    r->far = true;
}

void small_touch_push(struct small_run *r, struct small_touch *t)
{
    if (t->mu > 0) small_array(t->couple, touch_couple(t, t->f));
    small_body_push(&r->l->s.body[t->body], small_touch_persists(r, t),
                    v3_scale(r->l->s.rate.warm, touch_moment(t)));
    small_load_push(r, t, small_touch_persists(r, t));
}

vec3 small_touch_end(struct small_run *r, struct small_touch *t)
{
    const struct small_list *l = r->l;
    const vec3 f = small_vec(t->f), m = small_vec(t->m), none = v3(0, 0, 0);
    if (t->near) t->work += t->hold[HOLD_PULL] * v3_dot(t->n, t->v);
    if (small_is_zero(t->f)) return none;
    t->work -= v3_dot(f, t->v) + v3_dot(m, r->wall[t->wall].spin);
    if (small_spring_acts(t->spring)) return none;
    const double rn = v3_dot(f, t->n), w = l->s.body[t->body].im;
    const double held = t->kept + 2 * t->hold[HOLD_PULL];
    const double most = small_persists(&l->s.rate, held, w, rn);
    if (rn <= most) return none;
    const double back = 1 - most / rn;
    small_body_push(&r->l->s.before[t->body], v3_scale(back, f), v3_scale(back, touch_moment(t)));
    for (int k = 0; k < 3; k++) {
        t->sum[k] += back * t->f[k], t->turned[k] += back * t->m[k];
        t->f[k] *= most / rn, t->couple[k] *= most / rn, t->m[k] *= most / rn;
    }
    return v3_scale(back, f);
}
