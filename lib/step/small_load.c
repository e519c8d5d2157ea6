/* step/small_load.c: loads of walls in small steps [step/small_load.h]. */
#include "step/small_load.h"

#include "base/array.h"
#include "state/servo_box.h"
#include "step/small_point.h"
#include "step/small_touch.h"
#include "step/small_wall.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A touch with a wall that a load moves, in the sweep in hand */
struct small_loaded {
    struct small_touch *t;
    struct small_law l;
    vec3 D;  /* of the wall's material there, per unit of the speed */
    vec3 dp; /* N s: the change of the pull */
};

enum { ROUNDS_MOST = 60 };
/* Layers of grains: a wall of more mass is heavy */
static const double HEAVY = 2;
static const double EXACT = 1e-13;          /* of the reactions: what may be missing; */
static const double EXACT_MEETINGS = 1e-10; /* where points are solved in rounds */

/* ---- the interval ---- */

static int find_freedoms(struct small_run *r, struct failure *failure)
{
    struct freedoms now = { 0 };
    if (freedoms_init(&now, r->p, r->cell.edge, false, failure)) {
        freedoms_free(&now); // the small step in hand ends with those before
        return failure->status;
    }
    freedoms_free(&r->loads.list);
    r->loads.list = now;
    while (now.n && freedom_of_cell(&now.f[now.n - 1])) now.n--; // those of walls come first
    r->loads.list.n = now.n;
    return 0;
}

int small_loads_init(struct small_run *r, struct failure *failure)
{
    const struct packing *p = r->p;
    struct small_loads *o = &r->loads;
    const size_t walls = (size_t)p->walls + 1;
    if (!freedoms_in(p)) return 0;
    if (find_freedoms(r, failure)) return failure->status;
    const size_t n = (size_t)o->list.n + 1;
    o->of = malloc(walls * sizeof *o->of), o->had = malloc(walls * sizeof *o->had);
    o->change = calloc(n, sizeof *o->change), o->free = calloc(n, sizeof *o->free);
    o->kept = calloc(n, sizeof *o->kept);
    if (!o->of || !o->had || !o->change || !o->free || !o->kept)
        return failure_set(failure, EX_SOFTWARE, "no memory for the loads");
    for (int32_t w = 0; w < p->walls; w++) o->of[w] = -1, o->had[w] = p->wall[w].load;
    for (int32_t k = 0; k < o->list.n; k++)
        for (int32_t w = 0; w < p->walls; w++)
            if (o->list.f[k].wall == w || (o->list.f[k].lever && servo_box_has(&p->wall[w])))
                o->of[w] = k;
    return 0;
}

void small_loads_free(struct small_run *r, bool failed)
{
    struct small_loads *o = &r->loads;
    for (int32_t w = 0; failed && o->had && o->of && w < r->p->walls; w++)
        r->p->wall[w].load = o->had[w];
    free(o->of), free(o->had), free(o->change), free(o->free), free(o->kept), free(o->touch);
    free(o->meeting);
    freedoms_free(&o->list);
    *o = (struct small_loads){ 0 };
}

/* Does a wall stay where it is as it turns? No body then meets its inertia. */
static bool turns_in_itself(const struct wall *w)
{
    const vec3 axis = w->load.axis, off = v3_cross(axis, v3_sub(w->x, w->load.point));
    const bool upright = v3_norm(v3_cross(axis, w->n)) < 1e-9;
    if (w->shape == WALL_MESH) return false;
    if (w->shape < WALL_CYLINDER) return upright; // flat
    return v3_norm(off) < 1e-9 * w->size[0] && (upright || w->shape == WALL_SPHERE);
}

/* kg, of a wall that turns kg m^2: of bodies, at the arm that the wall has at most */
static double mass_on(const struct packing *p, const struct wall *w)
{
    const struct load *l = &w->load;
    const double arm = v3_norm(v3_cross(l->axis, v3_sub(w->x, l->point))) + wall_reach(w);
    double mass = 0;
    for (int64_t i = 0; i < p->n; i++) {
        const double way = v3_norm(v3_cross(l->axis, v3_sub(p->x[i], l->point)));
        mass += p->mass[i] * (l->way == LOAD_TURNS ? pow(fmin(way, arm), 2) : 1);
    }
    return mass;
}

bool small_loads_heavy(const struct packing *p)
{
    double mass = 0, n = 0, levers = 0, most = 0;
    for (int64_t i = 0; i < p->n; i++)
        if (p->mass[i] > 0) mass += p->mass[i], n++;
    for (int32_t w = 0; w < p->walls && n > 0; w++) {
        const struct wall *wall = &p->wall[w];
        const struct load *l = &wall->load;
        if (l->way == LOAD_GLIDES || (l->way == LOAD_TURNS && !turns_in_itself(wall)))
            most = fmax(most, l->mass / mass_on(p, wall));
        if (l->way == LOAD_ROOM) levers += pow(wall_lever(p, wall, p->t), 2);
    }
    if (levers > 0) most = fmax(most, servo_box_mass(p) / levers / 3 / mass);
    const double layers = p->dim == 2 ? sqrt(n) : cbrt(n);
    return n > 0 && most > HEAVY / layers;
}

double small_loads_energy(const struct packing *p)
{
    double sum = 0.5 * servo_box_mass(p) * servo_box_growth(p) * servo_box_growth(p);
    for (int32_t w = 0; w < p->walls; w++) {
        const struct load *l = &p->wall[w].load;
        if (l->way && !servo_box_has(&p->wall[w])) sum += 0.5 * l->mass * l->speed * l->speed;
    }
    return sum;
}

/* ---- a small step ---- */

void small_loads_begin(struct small_run *r)
{
    struct small_loads *o = &r->loads;
    struct failure failure = { 0 };
    if (find_freedoms(r, &failure)) r->lost = r->stop = true;
    for (int32_t k = 0; k < o->list.n; k++) {
        o->free[k] = r->h * o->list.f[k].force / o->list.f[k].mass;
        o->change[k] = o->free[k] + (r->begins ? 0 : r->l->s.rate.warm * o->kept[k]);
    }
}

/* The law of the step: an impact of the pair alone moves the wall, too. */
static void begin_loaded(struct small_run *r, struct small_loaded *y, double mass)
{
    struct small_law *l = &y->l;
    const double wn = l->wn, wt = l->wt, D2 = v3_dot(y->D, y->D);
    const double along = v3_dot(y->D, small_vec(l->n));
    l->wn += along * along / mass, l->wt += (D2 - along * along) / mass;
    y->dp = small_touch_begin(r, y->t, l);
    l->wn = wn, l->wt = wt;
}

/* Adds touches of freedom k that are near. Returns how many; -1: memory is short. */
static int64_t gather_loaded(struct small_run *r, int32_t k, bool again)
{
    struct small_list *l = r->l;
    struct small_loads *o = &r->loads;
    int64_t n = 0;
    for (int64_t i = 0; i < l->touches; i++) {
        struct small_touch *t = &l->touch[i];
        if (o->of[t->wall] != k || (again ? !t->near : !small_touch_near(r, t))) continue;
        if (!array_grow(&o->touch, &o->room, n + 1, sizeof *o->touch)) return -1;
        struct small_loaded *y = &o->touch[n++];
        *y = (struct small_loaded){ .t = t, .D = small_load_direction(r, t) };
        small_touch_law(r, t, &y->l);
        if (!again) begin_loaded(r, y, o->list.f[k].mass);
    }
    return n;
}

/* N s: D . df of a touch in a step of h where the speed changes by ds; l, df: then. *slope gets the derivative of it. */
static double loaded_at(const struct small_loaded *y, double h, double ds, struct small_law *l,
                        double df[3], double *slope)
{
    const vec3 n = small_vec(y->l.n), along = v3_scale(v3_dot(y->D, n), n);
    const vec3 across = v3_sub(y->D, along);
    double f2, top;
    *l = y->l;
    l->u[0] -= ds * y->D.x, l->u[1] -= ds * y->D.y, l->u[2] -= ds * y->D.z;
    small_touch_solve(y->t, l, h, df);
    f2 = dot3(l->f, l->f) - l->rn * l->rn, top = l->mu * l->rn;
    if (small_spring_acts(y->t->spring)) {
        const double *x = y->t->spring;
        const double gn = x[SPRING_PART] * x[SPRING_GN] + x[SPRING_YIELD] * x[SPRING_KN];
        const double gt = x[SPRING_PART] * x[SPRING_GT] + x[SPRING_YIELD] * x[SPRING_KT];
        if (l->rn > 0) *slope += v3_dot(along, along) * gn / (1 + gn * l->wn);
        if (f2 < (1 - 1e-9) * top * top) *slope += v3_dot(across, across) * gt / (1 + gt * l->wt);
        return v3_dot(y->D, small_vec(df));
    }
    if (l->rn > 0) *slope += v3_dot(along, along) / (l->wn + l->cn);
    if (f2 < (1 - 1e-9) * top * top) *slope += v3_dot(across, across) / (l->wt + l->ct);
    return v3_dot(y->D, small_vec(df));
}

/* The meetings of freedom k whose sweep begins. Returns how many; -1: memory is short. */
static int64_t gather_meetings(struct small_run *r, int32_t k, bool again)
{
    const struct small_meetings *all = &r->l->meetings;
    struct small_loads *o = &r->loads;
    int64_t n = 0;
    for (int64_t i = 0; i < all->n; i++) {
        struct small_meeting *m = &all->of[i];
        if (!m->points || !small_meeting_loaded(r, m) || o->of[-1 - m->key.a] != k) continue;
        if (!small_meeting_begin(r, m, again)) continue;
        if (!array_grow(&o->meeting, &o->meeting_room, n + 1, sizeof(struct small_meeting *)))
            return -1;
        o->meeting[n++] = m;
    }
    return n;
}

/* What is near the walls of a freedom in a sweep */
struct near_load {
    int32_t k;
    int64_t touches, meetings;
};

/* kg m/s: what is missing of the balance of a load where its speed changes by ds; *slope, *size: its derivative, and its terms */
static double load_off(struct small_run *r, const struct near_load *y, double ds, double *slope,
                       double *size)
{
    const double m = r->loads.list.f[y->k].mass;
    double g = m * ds;
    *slope = m, *size = fabs(m * ds);
    for (int64_t i = 0; i < y->touches; i++) {
        const struct small_loaded *t = &r->loads.touch[i];
        struct small_law l;
        double df[3];
        const double got = loaded_at(t, r->h, ds, &l, df, slope);
        g += got - v3_dot(t->D, t->dp), *size += fabs(got);
    }
    r->loads.trial = ds;
    for (int64_t i = 0; i < y->meetings; i++) small_meeting_back(r, r->loads.meeting[i]);
    for (int64_t i = 0; i < y->meetings; i++) {
        const double got = small_meeting_try(r, r->loads.meeting[i], slope);
        g += got, *size += fabs(got);
    }
    r->loads.trial = 0;
    return g;
}

/* By how much the speed changes, so that what is near balances it: Newton steps, and the secant where the derivative is estimated,
   within a bracket */
static double balance_load(struct small_run *r, const struct near_load *y)
{
    const double m = r->loads.list.f[y->k].mass, exact = y->meetings ? EXACT_MEETINGS : EXACT;
    double lo = 0, hi = 0, ds = 0, was = 0, g_was = 0;
    r->loads.tries = true;
    for (int round = 0; round < ROUNDS_MOST; round++) {
        double slope, size;
        const double g = load_off(r, y, ds, &slope, &size);
        if (!(fabs(g) > exact * size)) break;
        if (!round) lo = g > 0 ? -g / m : 0, hi = g > 0 ? 0 : -g / m;
        *(g > 0 ? &hi : &lo) = ds;
        if (y->meetings && round && g != g_was) slope = (g - g_was) / (ds - was);
        was = ds, g_was = g;
        const double next = ds - g / slope;
        ds = next > lo && next < hi ? next : 0.5 * (lo + hi);
    }
    if (y->meetings) { // where the last trial was not the last of ds
        double slope, size;
        load_off(r, y, ds, &slope, &size);
    }
    r->loads.tries = false;
    return ds;
}

/* m/s: a change of a body, which counts more where its load is heavier */
static double load_weighs(const struct small_run *r, int32_t k, int32_t body, vec3 D)
{
    const double ratio = r->loads.list.f[k].mass * r->l->s.body[body].im / v3_dot(D, D);
    return ratio > 1 ? sqrt(ratio) : 1;
}

static void sweep_load(struct small_run *r, int32_t k, bool again)
{
    struct small_loads *o = &r->loads;
    const struct near_load y = { k, gather_loaded(r, k, again), gather_meetings(r, k, again) };
    if (y.touches < 0 || y.meetings < 0) {
        r->lost = r->stop = true;
        return;
    }
    const double ds = y.touches + y.meetings > 0 ? balance_load(r, &y) : 0;
    for (int64_t i = 0; i < y.touches; i++) {
        const struct small_loaded *t = &o->touch[i];
        struct small_law l;
        double df[3], slope = 0;
        loaded_at(t, r->h, ds, &l, df, &slope);
        small_touch_give(r, t->t, &l, df, t->dp, load_weighs(r, k, t->t->body, t->D), again);
    }
    for (int64_t i = 0; i < y.meetings; i++) {
        struct small_meeting *m = o->meeting[i];
        small_meeting_mark(
            r, m, load_weighs(r, k, m->key.b, m->point[0].D) * small_meeting_moved(r, m), again);
    }
    o->change[k] += ds;
}

void small_loads_sweep(struct small_run *r, bool again)
{
    for (int32_t k = 0; k < r->loads.list.n; k++) sweep_load(r, k, again);
}

void small_loads_start(struct small_run *r)
{
    for (int64_t i = 0; i < r->l->meetings.n; i++) {
        struct small_meeting *m = &r->l->meetings.of[i];
        if (m->points && small_meeting_loaded(r, m)) small_meeting_start(r, m);
    }
}

void small_loads_end(struct small_run *r)
{
    struct small_loads *o = &r->loads;
    for (int32_t k = 0; k < o->list.n; k++) o->kept[k] = o->change[k] - o->free[k];
    for (int64_t i = 0; i < r->l->touches; i++) {
        struct small_touch *t = &r->l->touch[i];
        if (!small_is_loaded(r, t)) continue;
        const int32_t k = o->of[t->wall];
        const vec3 D = small_load_direction(r, t), back = small_touch_end(r, t);
        o->kept[k] += v3_dot(D, back) / o->list.f[k].mass;
    }
    for (int64_t i = 0; i < r->l->meetings.n; i++) {
        struct small_meeting *m = &r->l->meetings.of[i];
        if (m->points && small_meeting_loaded(r, m)) small_meeting_end(r, m);
    }
    for (int32_t k = 0; k < o->list.n; k++) {
        const struct freedom *f = &o->list.f[k];
        o->work += r->h * f->force * (f->speed + 0.5 * o->change[k]);
        freedom_move(f, r->p, o->change[k], false);
    }
    freedoms_move_rates(&o->list, r->p, false);
    struct failure failure = { 0 };
    if (servo_box_check_growth(r->p, &failure)) r->failed = r->stop = true;
}
