/* step/small_point_law.c: the law of points, their rounds, and what persists [step/small_point.h]. */
#include "base/team.h"
#include "solve/local_exact.h"
#include "step/small_anchor.h"
#include "step/small_point.h"
#include "step/small_stiff.h"
#include "step/small_tie.h"

#include <math.h>
#include <string.h>

/* Of h: tau, in which overlaps are left */
#define RELAXES 30

/* Rounds of the points of a meeting in one sweep: where some point is new, and in an impact, at most */
enum { ROUNDS = 2, ROUNDS_NEW = 6, ROUNDS_MOST = 20 };
static const double ENOUGH = 1e-3; /* of the first round: less needs no other */

/* Of the work of reactions before the impact: what of a gain may be an error of the rounds */
#define GAIN 2e-3
enum { BISECTIONS = 7 }; /* of a restitution that is reduced */

/* ---- the law ---- */

/* The load of a wall gets a reaction f on b: of a point whose material moves by D with it. */
static void push_load(const struct small_run *r, const struct body *of,
                      const struct small_meeting *y, vec3 D, vec3 f)
{
    const struct small_loads *o = &r->loads;
    if (!small_meeting_loaded(r, y) || o->tries) return;
    const int32_t k = o->of[-1 - y->key.a];
    const double gain = v3_dot(D, f) / o->list.f[k].mass;
    if (of == r->l->s.before)
        o->kept[k] += gain;
    else
        o->change[k] -= gain;
}

/* Bodies of[] get a reaction f on b, and its moment m. */
static void push_point(const struct small_run *r, struct body *of, const struct small_meeting *y,
                       const struct small_point *t, vec3 f, vec3 m)
{
    push_load(r, of, y, t->D, f);
    for (int side = 0; side < 2; side++) {
        const int32_t i = side ? y->key.b : y->key.a;
        const double sign = side ? 1 : -1;
        if (i < 0 || !(of[i].im > 0)) continue;
        const vec3 w = small_turned_by(r, i, v3_add(m, v3_cross(side ? t->b : t->a, f)));
        const double s = sign * of[i].im;
        of[i].v[0] += s * f.x, of[i].v[1] += s * f.y, of[i].v[2] += s * f.z;
        of[i].w[0] += sign * w.x, of[i].w[1] += sign * w.y, of[i].w[2] += sign * w.z;
    }
}

static vec3 spin_of(const struct small_run *r, const struct body *of, int32_t i)
{
    return i < 0 ? r->wall[-1 - i].spin : small_vec(of[i].w);
}

/* m/s: of the material of a at the point */
static vec3 velocity_at_a(const struct small_meeting *m, const struct small_point *t,
                          const struct body *of)
{
    if (m->key.a < 0) return t->v;
    const struct body *a = &of[m->key.a];
    return v3_add(small_vec(a->v), v3_cross(small_vec(a->w), t->a));
}

static vec3 velocity_at_b(const struct small_meeting *m, const struct small_point *t,
                          const struct body *of)
{
    const struct body *b = &of[m->key.b];
    return v3_add(small_vec(b->v), v3_cross(small_vec(b->w), t->b));
}

vec3 small_point_velocity(const struct small_run *r, const struct small_meeting *m,
                          const struct small_point *t, const struct body *of)
{
    vec3 u = v3_sub(velocity_at_b(m, t, of), velocity_at_a(m, t, of));
    if (small_meeting_loaded(r, m)) {
        const struct small_loads *o = &r->loads;
        const int32_t k = o->of[-1 - m->key.a];
        const double gain = of == r->l->s.before ? 0 : o->change[k] + o->trial;
        u = v3_axpy(u, -(o->list.f[k].speed + gain), t->D);
    }
    return r->cell.moves ? v3_add(u, cell_shift(r->cell.next, m->key.shift)) : u;
}

/* mu of the step, whose bodies slide with ut (m/s) before it */
static double friction_at(const struct packing *p, const struct small_meeting *m, vec3 ut)
{
    double mu[2], v_s;
    small_tie_stick(mu, &v_s, p, packing_pair(p, m->key.a, m->key.b));
    return mu[v3_norm(ut) > v_s];
}

/* Its springs; u: before the step (m/s) */
static void spring_point(struct small_point *t, struct small_law *l, const double u[3],
                         const struct small_rates *o)
{
    struct small_stretch at = {
        .gap = l->gap, .mu = t->mu, .spin = l->spin, .h = o->h, .rise = o->rise
    };
    memcpy(at.n, l->n, sizeof at.n), memcpy(at.u, u, sizeof at.u);
    small_spring_begin(t->spring, &at, l->q);
    t->soft = o->soft, t->kept = dot3(l->n, l->f);
}

/* The law in the first sweep of a step */
static void begin_point(const struct small_run *r, const struct small_meeting *m,
                        struct small_point *t)
{
    const struct small *s = &r->l->s;
    struct small_rates rate = s->rate;
    const struct small_rates *o = &rate;
    rate.relax = rate.per_h / (1 + RELAXES);
    struct small_law l = {
        .gap = t->gap, .wn = t->W[0], .wt = fmax(t->W[4], t->W[8]), .mu = t->mu, .calm = o->calm
    };
    double before[3];
    for (int k = 0; k < 3; k++) t->sum[k] += t->f[k], t->turned[k] += t->m[k];
    small_array(l.n, t->n), memcpy(l.f, t->f, sizeof l.f);
    l.cn = o->soft * l.wn, l.ct = o->soft * l.wt, t->soft = o->soft;
    if (small_point_holds(t)) {
        double pull[3];
        small_bond_pull(t->spring, l.n, l.gap, pull);
        for (int k = 0; k < 3; k++) l.f[k] -= pull[k];
    }
    t->kept = dot3(l.n, l.f), t->starts = false, l.calm += 2 * l.wn * t->pulls;
    const vec3 w = v3_add(spin_of(r, s->body, m->key.a), spin_of(r, s->body, m->key.b));
    l.spin = 0.5 * o->h * v3_dot(w, t->n);
    if (small_meeting_loaded(r, m)) { // an impact of the pair alone moves the wall, too
        const double mass = r->loads.list.f[r->loads.of[-1 - m->key.a]].mass;
        const double D2 = v3_dot(t->D, t->D), along = v3_dot(t->D, t->n);
        l.wn += along * along / mass, l.wt += (D2 - along * along) / mass;
    }
    small_press(&l, o);
    const vec3 u = small_point_velocity(r, m, t, s->before);
    if (packing_sticks(r->p)) t->mu = friction_at(r->p, m, v3_axpy(u, -v3_dot(u, t->n), t->n));
    small_array(before, u);
    l.cn = l.ct = 0;
    if (small_meet(&l, o, before, &t->kept, t->e[0], t->e[1])) t->soft = 0;
    if (r->l->stiffness) {
        small_anchor_stiff(r, m, t, l.wn, l.wt);
        if (t->spring[SPRING_KN] > 0) spring_point(t, &l, before, o);
    }
    memcpy(t->q, l.q, sizeof t->q);
}

void small_point_solve(int d, const double W[9], const double b[3], double mu, double f[3])
{
    struct local y = { .d = d, .W = W, .mu = mu };
    double found[3], u[3];
    memcpy(y.b, b, sizeof y.b), memcpy(y.r, f, sizeof y.r);
    if (exact_general(&y, found)) {
        memcpy(f, found, sizeof found);
        return;
    }
    const double w = local_lambda_max(W);
    local_velocity(&y, f, u);
    for (int k = 0; k < 3; k++) y.r[k] = f[k] - u[k] / w;
    disc_project(mu, y.r, f);
}

static void roll_point(const struct small_run *r, const struct small_meeting *y,
                       struct small_point *t, double rn)
{
    struct body *of = r->l->s.body;
    const int32_t a = y->key.a, b = y->key.b;
    const double wr = (a < 0 ? 0 : r->shapes.spread[a]) + r->shapes.spread[b];
    double n[3], w[3], dm[3];
    small_array(n, t->n), small_array(w, v3_sub(spin_of(r, of, b), spin_of(r, of, a)));
    small_roll(n, rn, w, wr, y->most, t->m, dm);
    push_point(r, of, y, t, v3(0, 0, 0), small_vec(dm));
}

/* The reaction of a point with springs, in its basis e */
static void spring_law(const struct small_run *r, const struct small_meeting *m,
                       const struct small_point *t, const vec3 e[3], double is[3])
{
    struct small_law l = { .wn = t->W[0], .wt = fmax(t->W[4], t->W[8]), .mu = t->mu };
    double df[3];
    small_array(l.n, t->n), memcpy(l.f, t->f, sizeof l.f), memcpy(l.q, t->q, sizeof l.q);
    small_array(l.u, small_point_velocity(r, m, t, r->l->s.body));
    small_solve_springs(&l, t->spring, r->h, df);
    for (int k = 0; k < 3; k++) is[k] = v3_dot(e[k], small_vec(l.f));
}

/* The reaction that a point has, f, and the one by its law, in its basis e. Returns what of it pushes (N s). */
static double point_law(const struct small_run *r, const struct small_meeting *m,
                        const struct small_point *t, const vec3 e[3], double f[3], double is[3])
{
    const vec3 u = v3_add(small_point_velocity(r, m, t, r->l->s.body), small_vec(t->q));
    const double soft = t->soft * fmax(t->W[4], t->W[8]);
    double W[9], b[3];
    for (int k = 0; k < 3; k++) f[k] = is[k] = v3_dot(e[k], small_vec(t->f));
    if (small_point_holds(t)) return small_bond_law(r, m, t, e, f, is);
    if (t->spring[SPRING_KN] > 0) {
        spring_law(r, m, t, e, is);
        return is[0];
    }
    for (int k = 0; k < 3; k++) b[k] = v3_dot(e[k], u) - dot3(t->W + 3 * k, f);
    memcpy(W, t->W, sizeof W);
    W[0] += t->soft * t->W[0], W[4] += soft, W[8] += soft;
    small_point_solve(r->p->dim, W, b, t->mu, is);
    return is[0];
}

/* Of the reactions of a meeting in a sweep: what they do to the bodies, and against what */
struct small_work {
    double done, scale; /* J */
};

/* Returns by how much (m/s) the point's u changes. */
static double solve_point(struct small_run *r, const struct small_meeting *m, struct small_point *t,
                          struct small_work *work)
{
    struct small *s = &r->l->s;
    const vec3 e[3] = { t->n, t->t1, v3_cross(t->n, t->t1) }, had = small_vec(t->f);
    const vec3 u = small_point_velocity(r, m, t, s->body);
    double f[3], is[3], change2 = 0;
    const double push = point_law(r, m, t, e, f, is);
    const vec3 new = v3_axpy(v3_axpy(v3_scale(is[0], e[0]), is[1], e[1]), is[2], e[2]);
    small_array(t->f, new);
    push_point(r, s->body, m, t, v3_sub(new, had), v3(0, 0, 0));
    if (s->turn || m->most[0] > 0 || m->most[1] > 0) roll_point(r, m, t, push);
    for (int k = 0; k < 3; k++) f[k] = is[k] - f[k];
    for (int k = 0; k < 3; k++) {
        const double du = dot3(t->W + 3 * k, f);
        const double does = f[k] * v3_dot(e[k], u);
        change2 += du * du;
        work->done += does + 0.5 * f[k] * du, work->scale += fabs(does);
    }
    return sqrt(change2);
}

/* A body has changed by x (m/s) [solve/small_sweep.c]. */
static bool mark_body(struct small *s, int32_t i, double x, double allowed)
{
    if (i < 0) return false;
    s->change[i] += x;
    if (!(s->change[i] > allowed)) return false;
    s->change[i] = 0, s->hot[i] = s->sweep;
    return true;
}

void small_meeting_mark(struct small_run *r, const struct small_meeting *m, double change,
                        bool again)
{
    struct small *s = &r->l->s;
    const int32_t a = m->key.a, b = m->key.b;
    const double ia = a < 0 ? 0 : s->body[a].im, ib = s->body[b].im, least = fmin(ia, ib);
    const double allowed = s->rate.allowed[again] * (least > 0 ? sqrt(least / fmax(ia, ib)) : 1);
    if (!again) change /= 1 + m->point[0].e[0];
    if (!(change > (again ? 0 : allowed))) return;
    const bool far = mark_body(s, a, change, allowed);
    if (mark_body(s, b, change, allowed) || far) r->far = true;
}

void small_points_wake(struct small_run *r)
{
    struct small *s = &r->l->s;
    for (int64_t i = 0; i < r->l->meetings.n; i++) {
        const struct small_meeting *m = &r->l->meetings.of[i];
        if (!m->points || !m->rounds) continue;
        s->hot[m->key.b] = s->sweep;
        if (m->key.a >= 0) s->hot[m->key.a] = s->sweep;
    }
}

static bool is_hot(const struct small *s, const struct small_meeting *m)
{
    const int32_t a = m->key.a, b = m->key.b, last = s->sweep - 1;
    return s->hot[b] >= last || (a >= 0 && s->hot[a] >= last);
}

/* The points in turn, until a round changes nothing by more than the part `enough` of the first one. *first: m/s, the
   largest change of that */
static struct small_work solve_points(struct small_run *r, struct small_meeting *m, int rounds,
                                      double enough, double *first)
{
    struct small_work work = { 0 };
    double most = INFINITY;
    for (int k = 0; k < rounds && most > (k ? enough * *first : 0); k++) {
        most = 0;
        for (int64_t i = 0; i < m->points; i++)
            if (m->point[i].near) most = fmax(most, solve_point(r, m, &m->point[i], &work));
        if (!k) *first = most;
    }
    return work;
}

void small_meeting_back(struct small_run *r, struct small_meeting *m)
{
    for (int64_t i = 0; i < m->points; i++) {
        struct small_point *t = &m->point[i];
        if (!t->near) continue;
        push_point(r, r->l->s.body, m, t, v3_sub(t->had, small_vec(t->f)), v3(0, 0, 0));
        small_array(t->f, t->had);
    }
}

/* The same once more, as before, with `times` the restitution. Returns whether the reactions gain energy. */
static bool solve_again(struct small_run *r, struct small_meeting *m, double times)
{
    double first;
    small_meeting_back(r, m);
    for (int64_t i = 0; i < m->points; i++)
        for (int k = 0; k < 3 && m->point[i].near && m->point[i].soft == 0; k++)
            m->point[i].q[k] *= times;
    return solve_points(r, m, ROUNDS_MOST, ENOUGH, &first).done > 0;
}

/* An impact that gains energy, as friction may make it [Kane 1984], has the largest restitution with which it does not, by
   bisection [step/balance.h]. */
static void bound_impact(struct small_run *r, struct small_meeting *m)
{
    double least = 0, most = 1, is = 1;
    for (int k = 0; k < BISECTIONS; k++) {
        const double next = 0.5 * (least + most);
        const bool gains = solve_again(r, m, next / is);
        is = next;
        if (gains)
            most = next;
        else
            least = next;
    }
    if (is > least) solve_again(r, m, least / is);
}

/* The points before a sweep, from which the law begins where it is the first one. m->rounds gets the most rounds; 0: no point
   is in reach. Returns whether an impact rebounds. */
static bool begin_meeting(struct small_run *r, struct small_meeting *m, bool again)
{
    bool hits = false, rebounds = false, new = false;
    int64_t near = 0;
    for (int64_t i = 0; i < m->points; i++) {
        struct small_point *t = &m->point[i];
        if (!t->near) continue;
        if (!again) begin_point(r, m, t);
        t->had = small_vec(t->f), near++;
        hits |= t->soft == 0, new |= t->kept <= 0;
        rebounds |= t->soft == 0 && (t->e[0] > 0 || t->e[1] > 0);
    }
    m->rounds = near > 1 ? hits ? ROUNDS_MOST : new ? ROUNDS_NEW : ROUNDS : near > 0;
    return rebounds;
}

static void sweep_meeting(struct small_run *r, struct small_meeting *m, bool again)
{
    double first = 0;
    const bool rebounds = begin_meeting(r, m, again);
    if (!m->rounds) return;
    const struct small_work work = solve_points(r, m, m->rounds, ENOUGH, &first);
    if (rebounds && !again && work.done > GAIN * work.scale) bound_impact(r, m);
    small_meeting_mark(r, m, first, again);
}

/* ---- meetings with walls that loads move ---- */

double small_meeting_moved(const struct small_run *r, const struct small_meeting *m)
{
    double most = 0;
    for (int64_t i = 0; i < m->points; i++) {
        const struct small_point *t = &m->point[i];
        const double change = v3_norm(v3_sub(small_vec(t->f), t->had));
        if (t->near) most = fmax(most, change * r->l->s.body[m->key.b].im);
    }
    return most;
}

bool small_meeting_begin(struct small_run *r, struct small_meeting *m, bool again)
{
    begin_meeting(r, m, again);
    return m->rounds > 0;
}

double small_meeting_try(struct small_run *r, struct small_meeting *m, double *slope)
{
    double sum = 0, steep = 0, pushes = 0, first;
    solve_points(r, m, m->rounds, 0, &first);
    for (int64_t i = 0; i < m->points; i++) {
        const struct small_point *t = &m->point[i];
        const double along = v3_dot(t->D, t->n);
        if (!t->near) continue;
        sum += v3_dot(t->D, v3_sub(small_vec(t->f), t->had));
        if (small_is_zero(t->f)) continue;
        steep += along * along / t->W[0], pushes++;
    }
    if (pushes > 0) *slope += steep / pushes;
    return sum;
}

/* Bodies have what persists of the attraction of the last step, at the arms of `had`, and get all of this one. */
static void pull_point(struct small_run *r, const struct small_meeting *m, struct small_point *t,
                       const struct small_point *had)
{
    const vec3 none = v3(0, 0, 0), pull = v3_scale(-t->pulls, t->n);
    if (!(t->pulls > 0) && v3_dot(t->pull, t->pull) == 0) return;
    if (!r->begins)
        push_point(r, r->l->s.body, m, had, v3_scale(-r->l->s.rate.warm, t->pull), none);
    push_point(r, r->l->s.body, m, t, pull, none);
    t->pull = pull;
    t->sum[0] += pull.x, t->sum[1] += pull.y, t->sum[2] += pull.z;
}

/* Bodies have what persists of the reactions of the last step, and get all; of points that start they have nothing, and of those
   that have gone they are to have nothing. */
void small_meeting_start(struct small_run *r, struct small_meeting *m)
{
    int64_t n = 0;
    m->rest = fmin(0, m->rest + r->l->s.rate.rise);
    for (int64_t i = 0; i < m->points; i++) {
        struct small_point t = m->point[i], had = t;
        const vec3 f = small_vec(t.f), moment = small_vec(t.m);
        const double has = t.starts ? 0 : r->l->s.rate.warm;
        had.a = t.was[0], had.b = t.was[1], had.D = t.had_D;
        if (has > 0 && !small_is_zero(t.f))
            push_point(r, r->l->s.body, m, &had, v3_scale(-has, f), v3_scale(-has, moment));
        if (t.near && !small_is_zero(t.f)) push_point(r, r->l->s.body, m, &t, f, moment);
        pull_point(r, m, &t, &had);
        t.was[0] = t.a, t.was[1] = t.b, t.had_D = t.D;
        for (int k = 0; k < 3 && t.starts && t.near; k++) // the step adds it
            t.sum[k] -= t.f[k], t.turned[k] -= t.m[k];
        if (t.starts && !t.near) memset(t.f, 0, sizeof t.f), memset(t.m, 0, sizeof t.m);
        if (!t.near) small_point_end(&t);
        t.starts = false;
        if (t.near || t.there || small_point_lasts(&t)) m->point[n++] = t;
    }
    m->points = n;
}

static void judge_meeting(struct small_run *r, const struct small_meeting *m)
{
    struct small *s = &r->l->s;
    for (int64_t i = 0; i < m->points; i++) {
        const struct small_point *t = &m->point[i];
        const vec3 e[3] = { t->n, t->t1, v3_cross(t->n, t->t1) };
        double f[3], is[3];
        if (!t->near) continue;
        point_law(r, m, t, e, f, is);
        for (int side = m->key.a < 0; side < 2; side++) {
            const int32_t body = side ? m->key.b : m->key.a;
            s->load[body] += norm3(f);
            s->missing[body] += norm3((double[3]){ is[0] - f[0], is[1] - f[1], is[2] - f[2] });
        }
    }
}

/* What persists of the reactions, and what they have done to walls and bodies that do not move */
void small_meeting_end(struct small_run *r, struct small_meeting *m)
{
    struct small *s = &r->l->s;
    for (int64_t i = 0; i < m->points; i++) {
        struct small_point *t = &m->point[i];
        const vec3 f = v3_add(small_vec(t->f), t->pull), moment = small_vec(t->m);
        const int32_t a = m->key.a, b = m->key.b;
        if (!t->near && !(t->pulls > 0)) continue;
        if (a < 0 || !(s->body[a].im > 0))
            m->work -=
                v3_dot(f, velocity_at_a(m, t, s->body)) + v3_dot(moment, spin_of(r, s->body, a));
        if (!(s->body[b].im > 0))
            m->work +=
                v3_dot(f, velocity_at_b(m, t, s->body)) + v3_dot(moment, spin_of(r, s->body, b));
        const double rn = v3_dot(small_vec(t->f), t->n), held = t->kept + 2 * t->pulls;
        const double most = small_persists(&s->rate, held, t->W[0], rn);
        if (!t->near || !(rn > most) || t->spring[SPRING_KN] > 0) continue;
        const double back = 1 - most / rn;
        for (int k = 0; k < 3; k++) {
            t->sum[k] += back * t->f[k], t->turned[k] += back * t->m[k];
            t->f[k] *= most / rn, t->m[k] *= most / rn;
        }
        push_point(r, s->before, m, t, v3_scale(back, v3_sub(f, t->pull)), v3_scale(back, moment));
    }
}

/* ---- all meetings ---- */

enum small_point_pass { PASS_START, PASS_SWEEP, PASS_AGAIN, PASS_JUDGE, PASS_END };

static void pass_meetings(struct small_run *r, int64_t first, int64_t end,
                          enum small_point_pass pass)
{
    for (int64_t i = first; i < end; i++) {
        struct small_meeting *m = &r->l->meetings.of[r->l->meetings.order[i]];
        if (!m->points || (pass != PASS_JUDGE && small_meeting_loaded(r, m))) continue;
        if (pass == PASS_START) small_meeting_start(r, m);
        if (pass == PASS_SWEEP) sweep_meeting(r, m, false);
        if (pass == PASS_AGAIN && is_hot(&r->l->s, m)) sweep_meeting(r, m, true);
        if (pass == PASS_JUDGE) judge_meeting(r, m);
        if (pass == PASS_END) small_meeting_end(r, m);
    }
}

static void pass_groups(struct small_run *r, int me, int threads, enum small_point_pass pass)
{
    const struct small_meetings *m = &r->l->meetings;
    for (int64_t g = 0; g < m->serial; g++) {
        const int64_t at = m->group[g], n = m->group[g + 1] - at;
        pass_meetings(r, at + n * me / threads, at + n * (me + 1) / threads, pass);
        team_meet();
    }
    if (m->serial == m->groups) return;
    if (!me) pass_meetings(r, m->group[m->serial], m->n, pass);
    team_meet();
}

void small_points_start(struct small_run *r, int me, int threads)
{
    pass_groups(r, me, threads, PASS_START);
}

void small_points_sweep(struct small_run *r, int me, int threads, bool again)
{
    pass_groups(r, me, threads, again ? PASS_AGAIN : PASS_SWEEP);
}

void small_points_judge(struct small_run *r, int me, int threads)
{
    pass_groups(r, me, threads, PASS_JUDGE);
}

void small_points_end(struct small_run *r, int me, int threads)
{
    pass_groups(r, me, threads, PASS_END);
}
