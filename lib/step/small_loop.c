/* step/small_loop.c: the passes of a small step [step/small_loop.h]. */
#include "step/small_loop.h"

#include "base/team.h"
#include "step/small_cell.h"
#include "step/small_converge.h"
#include "step/small_error.h"
#include "step/small_gain.h"
#include "step/small_load.h"
#include "step/small_part.h"
#include "step/small_point.h"
#include "step/small_pull.h"
#include "step/small_seam.h"
#include "step/small_springs.h"
#include "step/small_sums.h"
#include "step/small_touch.h"
#include "step/small_wall.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    SWEEPS_MOST = 60,      /* of a small step; */
    SWEEPS_BOUNDED = 1000, /* of one whose error is bounded, and of one that is to converge */
};

/* Thread `me` of `threads` has first .. end-1 of n. */
static void small_share(int64_t n, int me, int threads, int64_t *first, int64_t *end)
{
    *first = n * me / threads, *end = n * (me + 1) / threads;
}

/* ---- bodies ---- */

/* Of the reactions of a step, FADES does not persist while bodies gain velocity as if they fell. Where forces balance, they
   persist wholly, and sweeps converge from step to step: a packing that is at rest stays there. Between the two is the mean
   change of a velocity in a step over that in a fall, times FADES_BY over the mean load of a body in weights, FADES_MOST at
   most: where bodies carry more, what fades changes their velocities by more, which is not to make more fade. Changes are
   summed as integers, so that any number of threads gives the same sum. */
#define FADES      0.02
#define FADES_BY   25
#define FADES_MOST 10
#define SHAKEN_ONE 1048576.0

static int64_t shaken_by(const struct small_run *r, int64_t i)
{
    const struct small *s = &r->l->s;
    const vec3 dv = v3_sub(small_vec(s->body[i].v), small_vec(s->before[i].v));
    const double x = v3_norm(dv) / r->fall, by = x < 1 ? x : 1;
    return s->body[i].im > 0 ? (int64_t)(SHAKEN_ONE * by) : 0;
}

static double small_warm(const struct small_run *r, int64_t shaken)
{
    const double mean = (double)shaken / SHAKEN_ONE / (double)(r->free + !r->free);
    const double by = fmin(FADES_MOST, FADES_BY / r->load);
    return 1 - FADES * (r->fall > 0 ? fmin(1, by * mean) : 1);
}

/* A sum over bodies is one over those of all processes. */
static int64_t small_of_all(const struct small_run *r, int64_t x)
{
    return r->part ? r->part->ranks->sum(r->part->ranks, x) : x;
}

/* v^- and v, with the part `warm` of the reactions of the last step; in the first step of an interval v is free, and the
   reactions follow. Returns the largest v^2. */
static double begin_bodies(struct small_run *r, double warm, int64_t first, int64_t end)
{
    struct small *s = &r->l->s;
    const vec3 g = r->p->g;
    const double fall[3] = { r->h * g.x, r->h * g.y, r->h * g.z };
    double most = 0;
    if (r->begins) warm = 0;
    if (r->pull) return small_pull_bodies(r, warm, first, end);
    for (int64_t k = first; k < end; k++) {
        const int64_t i = small_body_here(r, k);
        struct body *b = &s->body[i], *was = &s->before[i];
        double v2 = 0;
        for (int j = 0; j < 3; j++) {
            const double v = b->v[j], w = b->w[j], free = b->im > 0 ? fall[j] : 0;
            b->v[j] = v + free + warm * (v - was->v[j] - free);
            b->w[j] = w + warm * (w - was->w[j]);
            was->v[j] = v, was->w[j] = w;
            v2 += v * v;
        }
        if (r->meets) v2 = small_point_speed(r, i) * small_point_speed(r, i);
        most = v2 <= most ? most : v2; // not a number: it is the largest
    }
    return most;
}

static void move_bodies(struct small_run *r, int64_t first, int64_t end)
{
    const struct small_list *l = r->l;
    const struct small *s = &l->s;
    int64_t shaken = 0;
    double most = 0;
    for (int64_t k = first; k < end; k++) {
        const int64_t i = small_body_here(r, k);
        const struct body *b = &s->body[i];
        shaken += shaken_by(r, i);
        for (int j = 0; j < 3; j++) s->place[i].x[j] += r->h * b->v[j];
        const vec3 way = v3_axpy(l->listed[i], l->since, l->drift[i]);
        const vec3 d = v3_sub(small_vec(s->place[i].x), way);
        most = dmax(most, v3_dot(d, d));
        r->turned[i] = v3_axpy(r->turned[i], r->h, small_vec(b->w));
    }
    pthread_mutex_lock(&r->lock);
    r->shaken += shaken, r->strays = fmax(r->strays, most);
    pthread_mutex_unlock(&r->lock);
    if (r->meets) small_points_place(r, first, end);
}

/* ---- walls ---- */

static void solve_touch(struct small_run *r, struct small_touch *t, bool again)
{
    struct small_law l;
    double df[3];
    vec3 dp = v3(0, 0, 0);
    if (again ? !t->near : small_touch_waits(r, t) || !small_touch_near(r, t)) return;
    small_touch_law(r, t, &l);
    if (!again) dp = small_touch_begin(r, t, &l);
    small_touch_solve(t, &l, r->h, df);
    small_touch_give(r, t, &l, df, dp, 1, again);
}

/* Of bodies first .. end-1 */
static void sweep_touches(struct small_run *r, int64_t first, int64_t end, bool again)
{
    struct small_list *l = r->l;
    const int64_t last = small_list_touch(l, end, 0);
    for (int64_t i = small_list_touch(l, first, 0); i < last; i++)
        if (!small_is_loaded(r, &l->touch[i]) && small_is_own(r, l->touch[i].body) &&
            (!again || l->s.hot[l->touch[i].body] >= l->s.sweep - 1))
            solve_touch(r, &l->touch[i], again);
}

/* What persists of the reactions of touches, and what they have done to walls */
static void end_touches(struct small_run *r, int64_t first, int64_t end)
{
    struct small_list *l = r->l;
    const int64_t last = small_list_touch(l, end, 0);
    for (int64_t i = small_list_touch(l, first, 0); i < last; i++)
        if (!small_is_loaded(r, &l->touch[i]) && small_is_own(r, l->touch[i].body))
            small_touch_end(r, &l->touch[i]);
}

/* ---- pairs ---- */

/* Bundles from .. to-1 of a group, by all threads */
static bool sweep_share(struct small_run *r, int me, int threads, int64_t from, int64_t to,
                        bool again)
{
    int64_t first, end;
    small_share(to - from, me, threads, &first, &end);
    return r->kernel->sweep(&r->l->s, from + first, from + end, again);
}

/* By several processes: while what is told of a group flies, the rest of it is swept. */
static void sweep_part(struct small_run *r, int me, int threads, bool again)
{
    const struct small *s = &r->l->s;
    bool far = false;
    if (!me) small_part_send(r, 0);
    for (int64_t g = 0; g < s->groups; g++) {
        if (!me) small_part_receive(r, g);
        team_meet();
        far |= sweep_share(r, me, threads, s->group[g], r->l->early[g], again);
        team_meet();
        if (!me) small_part_send(r, g + 1);
        far |= sweep_share(r, me, threads, r->l->early[g], s->group[g + 1], again);
    }
    if (far) r->far = true;
}

/* Has a sweep changed a body of anybody by too much? */
static void agree_on_far(struct small_run *r)
{
    double far = r->far;
    r->part->ranks->most(r->part->ranks, &far, 1);
    r->far = far > 0;
}

static void sweep_pairs(struct small_run *r, int me, int threads, bool again)
{
    struct small *s = &r->l->s;
    bool far = false;
    if (r->part) {
        sweep_part(r, me, threads, again);
        team_meet();
        if (!me) agree_on_far(r);
        return;
    }
    for (int64_t g = 0; g < s->serial; g++) {
        int64_t first, end;
        small_share(s->group[g + 1] - s->group[g], me, threads, &first, &end);
        far |= r->kernel->sweep(s, s->group[g] + first, s->group[g] + end, again);
        team_meet();
    }
    if (s->serial < s->groups) {
        if (!me) far |= r->kernel->sweep(s, s->group[s->serial], s->bundles, again);
        team_meet();
    }
    if (far) r->far = true;
}

/* All bodies get the reactions that are remembered. */
static void push_reactions(struct small_run *r, int me, int threads)
{
    struct small_list *l = r->l;
    struct small *s = &l->s;
    for (int64_t g = 0; g < s->serial; g++) {
        int64_t first, end;
        small_share(s->group[g + 1] - s->group[g], me, threads, &first, &end);
        r->kernel->push(s, s->group[g] + first, s->group[g] + end);
        team_meet();
    }
    if (me) return;
    r->kernel->push(s, s->group[s->serial], s->group[s->groups]);
    for (int64_t i = 0; i < l->touches; i++) {
        struct small_touch *t = &l->touch[i];
        if (small_is_zero(t->f) && !(t->hold[HOLD_PULL] > 0)) continue;
        if (small_look_at_touch(r, t, l->margin))
            small_touch_push(r, t);
        else
            memset(t->f, 0, sizeof t->f), memset(t->couple, 0, sizeof t->couple),
                memset(t->m, 0, sizeof t->m), memset(t->sum, 0, sizeof t->sum),
                memset(t->turned, 0, sizeof t->turned);
    }
}

/* The load of a body by pairs and touches, over its weight: the mean of all */
static double mean_load(const struct small_run *r)
{
    const struct small_list *l = r->l;
    const int64_t lanes = r->part ? l->pairs.n : BUNDLE * l->s.bundles;
    double sum = 0;
    for (int64_t i = 0; i < lanes; i++) sum += 2 * v3_norm(small_along(r, l->s.bundle, i));
    for (int64_t i = 0; i < l->touches; i++) sum += v3_norm(small_vec(l->touch[i].f));
    return r->weight > 0 ? sum / r->weight : 0;
}

/* In the first step of an interval, where bodies have all of the reactions that are remembered: what does not persist is
   taken back. */
static void fade_reactions(struct small_run *r, int me, int threads)
{
    double *warm = &r->l->s.rate.warm;
    int64_t shaken = 0;
    team_meet();
    if (!me) r->load = mean_load(r);
    for (int64_t k = 0; !me && k < small_bodies_here(r); k++)
        shaken += shaken_by(r, small_body_here(r, k));
    if (!me) shaken = small_of_all(r, shaken);
    if (!me) *warm = small_warm(r, shaken) - 1;
    team_meet();
    if (*warm < 0) push_reactions(r, me, threads);
    team_meet();
    if (!me) *warm += 1;
}

/* What does not persist is taken out of v^-. */
static void settle_pairs(struct small_run *r, int me, int threads)
{
    struct small *s = &r->l->s;
    for (int64_t g = 0; g < s->serial; g++) {
        int64_t first, end;
        small_share(s->group[g + 1] - s->group[g], me, threads, &first, &end);
        r->kernel->settle(s, s->group[g] + first, s->group[g] + end);
        team_meet();
    }
    if (!me) r->kernel->settle(s, s->group[s->serial], s->group[s->groups]);
}

/* ---- a small step ---- */

/* m/s: of a point of a wall */
static double fastest_wall(const struct small_run *r)
{
    double most = 0;
    for (int32_t w = 0; w < r->p->walls; w++) most = fmax(most, r->wall[w].top);
    return most;
}

/* How fast bodies are, and how far beside their ways, of all processes; and whether one of them has no memory */
static void agree_on_bodies(struct small_run *r)
{
    double most[3] = { isfinite(r->fastest) ? r->fastest : INFINITY, r->strays, r->lost };
    r->part->ranks->most(r->part->ranks, most, 3);
    r->fastest = most[0], r->strays = most[1], r->lost = most[2] > 0;
    r->stop = r->stop || r->lost;
    small_part_begin(r);
}

/* By one thread: how far pairs may be that touch in the step, and whether the list will serve the next one */
static void prepare_step(struct small_run *r)
{
    struct small_list *l = r->l;
    if (r->part) agree_on_bodies(r);
    const double wall = fastest_wall(r),
                 way = r->h * (fmax(sqrt(r->fastest), wall) + small_cell_stretch(r));
    if (!isfinite(way)) r->failed = r->stop = true;
    l->s.rate.reach = fmin(2 * way + r->h * (l->s.rate.calm + l->s.rate.pulls), l->margin);
    l->strays = r->cell.moves ? l->strays + way : sqrt(r->strays);
    l->walls += r->h * (wall - l->wall), l->since += r->h, l->s.rate.gone += 2 * way;
    r->shaken = 0, r->strays = 0;
    r->stop = r->stop || fmax(l->strays, l->walls) + 2 * way > 0.49 * l->spare ||
              (l->serves > 0 && l->since + 0.5 * r->h > l->serves);
    r->fastest = 0;
}

/* Returns whether a body has changed by more than is allowed. */
static bool small_sweep_all(struct small_run *r, int me, int threads, bool again)
{
    int64_t first, end;
    small_share(r->l->s.bodies, me, threads, &first, &end);
    team_meet();
    if (!me && again && !r->l->s.mark) small_marks_make(&r->l->s);
    if (!me) r->l->s.sweep++, r->swept++, r->far = false;
    team_meet();
    sweep_touches(r, first, end, again);
    team_meet();
    if (r->loads.of) {
        if (!me) small_loads_sweep(r, again);
        team_meet();
    }
    if (r->meets) small_points_sweep(r, me, threads, again);
    if (again) {
        if (r->meets) team_meet();
        small_marks_begin(&r->l->s, first, end);
        team_meet();
    }
    sweep_pairs(r, me, threads, again);
    team_meet();
    return r->far;
}

static bool small_gains(struct small_run *r, int me, double *last)
{
    team_meet();
    if (!me) r->gained = small_gain_exceeds(r, last);
    team_meet();
    return r->gained;
}

static void small_sweeps(struct small_run *r, int me, int threads)
{
    const int most = r->bound > 0 ? SWEEPS_BOUNDED : SWEEPS_MOST;
    double gain = INFINITY;
    bool far = true;
    for (int k = 0; far && k < most; k++) {
        far = small_sweep_all(r, me, threads, k > 0);
        if (far) continue;
        far = r->bound > 0 && small_error_exceeds(r, me, threads);
        if (far && !me) small_copy_wake(r), r->far = true;
        if (!far && r->gains && (far = small_gains(r, me, &gain)) && !me)
            small_points_wake(r), r->far = true;
        team_meet();
    }
}

/* Of the fastest speed: a change of a velocity below which sweeps have converged */
#define CONVERGED 1e-9

/* How far the reactions are from what more sweeps make of them, which are then taken back [step/small_converge.h] */
static void small_converge(struct small_run *r, int me, int threads)
{
    struct small_copy copy;
    struct body *was = NULL;
    team_meet();
    if (!me) {
        was = calloc((size_t)r->l->s.bodies + 1, sizeof *was);
        r->lost = r->lost || !was || (r->part && !small_part_collect(r));
        r->compares = small_copy_init(&copy, r) && !r->lost;
        if (r->part) r->compares = small_of_all(r, r->compares) == r->part->ranks->n;
        r->lost = !r->compares;
        if (was) small_copy_change(r, was);
    }
    team_meet();
    for (r->compared = 0; r->compares && r->compared < SWEEPS_BOUNDED;) {
        if (!me) small_copy_wake(r);
        small_sweep_all(r, me, threads, true);
        if (!me) {
            double change = small_copy_change(r, was);
            if (r->part) r->part->ranks->most(r->part->ranks, &change, 1);
            r->compares = change > CONVERGED * r->l->s.rate.allowed[0];
            r->compared++;
        }
        team_meet();
    }
    if (!me && r->part && !r->lost) r->lost = !small_part_collect(r);
    if (!me && !r->lost) r->distance = small_copy_distance(&copy, r), small_copy_give(&copy, r);
    if (!me) small_copy_free(&copy, r), free(was);
    team_meet();
}

/* By one thread, after the sweeps */
static void finish_step(struct small_run *r)
{
    struct small *s = &r->l->s;
    if (r->far && r->uneven) r->failed = r->stop = true;
    r->unsolved += r->far;
    if (r->swept > 1) memset(s->change, 0, (size_t)s->bodies * sizeof *s->change);
    r->sweeps += r->swept, r->swept = 0;
    r->begins = false, r->made++;
    r->p->step0--; // the step that packing_next_time() ends with is the next small one
    r->p->t = r->p->t0 + (double)r->made * r->h;
}

void small_loop(void *arg, int me, int threads)
{
    struct small_run *r = arg;
    int64_t first, end, from, to; // bodies of this process; of all, for touches
    small_share(small_bodies_here(r), me, threads, &first, &end);
    small_share(r->l->s.bodies, me, threads, &from, &to);
    while (r->made < r->n && !r->stop) {
        if (r->cell.moves) {
            if (!me) small_cell_begin(r);
            team_meet();
            small_cell_images(r, me, threads);
        }
        const double warm = r->begins ? 1 : small_warm(r, r->shaken);
        if (!me) r->l->s.rate.warm = warm;
        const double fastest = begin_bodies(r, warm, first, end);
        pthread_mutex_lock(&r->lock);
        r->fastest = fastest <= r->fastest ? r->fastest : fastest;
        pthread_mutex_unlock(&r->lock);
        if (r->loads.of && !me) small_loads_begin(r);
        if (!me) small_walls_set(r);
        team_meet();
        if (r->begins) push_reactions(r, me, threads);
        if (!me) prepare_step(r);
        if (r->meets) small_points_look(r, me, threads);
        if (r->meets && r->begins && r->l->s.spring) {
            if (!me) {
                small_springs_recall_points(r);
                r->stored += small_springs_points(r, r->l->s.before).stored;
            }
            team_meet();
        }
        if (r->meets && r->l->s.hold && !me) small_attract(r);
        if (r->meets && r->l->s.hold) team_meet();
        if (r->meets) small_points_start(r, me, threads);
        if (r->meets && r->loads.of && !me) small_loads_start(r);
        if (r->begins) fade_reactions(r, me, threads);
        small_sweeps(r, me, threads);
        if (r->sums && !me) small_sums_step(r);
        if (r->sums) team_meet();
        if (r->judged) small_error_step(r, me, threads);
        if (r->compares && r->made + 1 == r->n) small_converge(r, me, threads);
        if (r->cell.moves && !me) small_cell_end(r);
        end_touches(r, from, to);
        team_meet();
        if (r->meets) small_points_end(r, me, threads);
        if (r->loads.of && !me) small_loads_end(r);
        if (r->meets || r->loads.of) team_meet();
        settle_pairs(r, me, threads);
        if (!me) finish_step(r);
        team_meet();
        move_bodies(r, first, end);
        team_meet();
        if (r->part && !me) r->shaken = small_of_all(r, r->shaken);
        if (r->part) team_meet();
    }
}
