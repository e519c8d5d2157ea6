/* solve/ipm.c: long steps along the central path, and the attempts of a solve [solve/ipm.h]. */
#include "solve/ipm.h"

#include "solve/arc.h"

#include <stdlib.h>

#define INTERIOR   0.99 /* a step goes at most this fraction of the way to the border */
#define LENGTHEN   0.3  /* a corrector aims at a step longer by this */
#define LENGTHENED 0.03 /* a corrector that gains less than this is the last */
#define STEP_SHORT 0.1  /* a step shorter than this gains too little: the next t is tried */

#define MAP_CLOSE 2e-7 /* scaled natural map to which long steps follow the path */
#define MAP_END   1e-9 /* the same by arc length, which costs only a few steps more */
#define GAP_LATE  1e-4 /* gap below which smaller t do not lead on */
#define GAP_COLD  0.1  /* gap at the start from r = 0 */

enum {
    STUCK_STEPS = 4,  /* steps below 1e-3 in a row: the method is stuck */
    CORRECTORS = 3,   /* correctors a step, at most; six save nothing */
    ROUNDS = 3,       /* rounds from r = 0, each to a map ten times smaller */
    COLD_STEPS = 200, /* steps of the first round, at most */
    NEXT_STEPS = 12,  /* steps of each later round, at most */
    WARM_STEPS = 25,  /* steps from the sweeps' reactions, at most */
    ARC_STEPS = 60,   /* steps by arc length, at most */
};

/* The t tried in turn: between balls, and where the W_cc are full (columns, walls) */
static const double ts[2][3] = { { 1, 0.9, 0.5 }, { 1, 0.7, 0.3 } };

/* Saved directions of one contact */
struct directions {
    double last[2][3]; /* dx and dz without the last corrector */
    double far[2][3];  /* dx and dz of the t with the longest step */
};

struct ipm {
    struct central c;
    struct directions *kept; /* [n] */
    bool full;               /* some W_cc are more than diag(w_n, w_t, w_t) */
    double fold_gap; /* below this gap only t = 1 is tried, and a short step ends the path */
    int last_t;      /* which of the t the next step tries first */
    int stuck;       /* steps below 1e-3 in a row */
};

/* The longest step that keeps x and z of all contacts in K */
static double ipm_longest(const struct central *m)
{
    double step = INFINITY;
    for (int64_t c = 0; c < m->newton->a.W.n; c++) {
        const struct side *s = &m->side[c];
        step = fmin(step, fmin(jordan_to_border(s->x, s->dx), jordan_to_border(s->z, s->dz)));
    }
    return step;
}

/*
 * Gondzio's corrector [Gondzio 1996]: changes c so that x o z, a little beyond the longest step,
 * has its eigenvalues within a factor of 10 of the target.
 */
static void recentre(struct side *s, double step, double target)
{
    double x[3], z[3], fx[3], fz[3], p[3], f[2], more[3];
    for (int k = 0; k < 3; k++) x[k] = s->x[k] + step * s->dx[k], z[k] = s->z[k] + step * s->dz[k];
    scaling_apply(&s->F, x, fx);
    scaling_inverse(&s->F, z, fz);
    jordan_product(fx, fz, p);
    double t = jordan_tail(p);
    for (int k = 0; k < 2; k++) {
        double l = k ? p[0] - t : p[0] + t;
        f[k] = fmax(fmin(fmax(l, target / 10), 10 * target) - l, -10 * target);
    }
    for (int k = 1; k < 3; k++) p[k] *= t > 0 ? (f[0] - f[1]) / 2 / t : 0;
    p[0] = (f[0] + f[1]) / 2;
    jordan_quotient(s->l, p, more);
    for (int k = 0; k < 3; k++) s->c[k] += more[k];
}

/* Correctors as long as they lengthen the step; each takes a substitution but no factorisation.
   Returns the longest step. */
static double lengthen(struct ipm *m, double step, double target)
{
    int64_t n = m->c.newton->a.W.n;
    for (int k = 0; k < CORRECTORS && INTERIOR * step < 0.95; k++) {
        for (int64_t c = 0; c < n; c++) {
            struct side *s = &m->c.side[c];
            side_save(s, m->kept[c].last);
            recentre(s, fmin(1, INTERIOR * step + LENGTHEN), target);
        }
        double before = step;
        step = central_direction(&m->c, true) ? ipm_longest(&m->c) : 0;
        if (step >= before + LENGTHENED) continue;
        if (step >= before) break;
        for (int64_t c = 0; c < n; c++) side_restore(&m->c.side[c], m->kept[c].last);
        return before;
    }
    return step;
}

/* Mehrotra's two directions with this t, and correctors; returns the step's length, 0 for none. */
static double predict_and_correct(struct ipm *m, double t)
{
    int64_t n = m->c.newton->a.W.n;
    central_matrix(&m->c, t);
    for (int64_t c = 0; c < n; c++)
        for (int k = 0; k < 3; k++) m->c.side[c].c[k] = -m->c.side[c].l[k];
    if (!central_direction(&m->c, false)) return 0;
    double a = fmin(1, ipm_longest(&m->c)), gap = 0;
    for (int64_t c = 0; c < n; c++) {
        const struct side *s = &m->c.side[c];
        for (int k = 0; k < 3; k++) gap += (s->x[k] + a * s->dx[k]) * (s->z[k] + a * s->dz[k]);
    }
    double sigma = fmin(1, fmax(0, gap / (double)n / m->c.gap)),
           target = sigma * sigma * sigma * m->c.gap;
    for (int64_t c = 0; c < n; c++) {
        struct side *s = &m->c.side[c];
        double fx[3], fz[3], second[3], ll[3], want[3];
        scaling_apply(&s->F, s->dx, fx);
        scaling_inverse(&s->F, s->dz, fz);
        jordan_product(fx, fz, second), jordan_product(s->l, s->l, ll);
        for (int k = 0; k < 3; k++) want[k] = (k ? 0 : target) - ll[k] - second[k];
        jordan_quotient(s->l, want, s->c);
    }
    if (!central_direction(&m->c, true)) return 0;
    return fmin(1, INTERIOR * lengthen(m, ipm_longest(&m->c), target));
}

static void ipm_move(struct central *m, double step)
{
    for (int64_t c = 0; c < m->newton->a.W.n; c++) {
        struct side *s = &m->side[c];
        for (int k = 0; k < 3; k++) s->x[k] += step * s->dx[k], s->z[k] += step * s->dz[k];
    }
}

/*
 * One step; false where there is none. The t used last is tried first, since a fold of the path
 * lasts for some steps.
 */
static bool ipm_step(struct ipm *m)
{
    int64_t n = m->c.newton->a.W.n;
    double step = 0;
    bool follow = m->c.gap < m->fold_gap;
    int at = follow ? 0 : m->last_t;
    for (int i = at; i < (follow ? 1 : 3) && step < STEP_SHORT; i++) {
        double far = predict_and_correct(m, ts[m->full][i]);
        if (far <= step) continue;
        step = far, at = i;
        for (int64_t c = 0; c < n; c++) side_save(&m->c.side[c], m->kept[c].far);
    }
    if (follow && step < STEP_SHORT) return false;
    for (int64_t c = 0; c < n; c++) side_restore(&m->c.side[c], m->kept[c].far);
    m->last_t = at > 0 && step > 0.3 ? at - 1 : at;
    m->stuck = step < 1e-3 ? m->stuck + 1 : 0;
    if (step > 0) ipm_move(&m->c, step);
    return step > 0 && m->stuck < STUCK_STEPS;
}

/*
 * Follows the path to where the scaled natural map is at most `natural`; false where `steps` steps
 * do not reach it. The best point found becomes the iterate.
 */
static bool follow_path(struct ipm *m, double natural, int steps)
{
    const struct solve *s = m->c.solve;
    bool more = true, there = false;
    for (int k = 0; more && k < steps; k++) {
        m->c.gap = central_mean_gap(&m->c);
        double e = central_evaluate(&m->c);
        if (s->o->progress) s->o->progress(s->rep->sweeps, e);
        there = central_finish(&m->c, e) || e <= natural;
        if (there || !isfinite(e) || solve_spent(s)) break;
        more = central_scale(&m->c) && ipm_step(m);
    }
    central_restore_best(&m->c);
    return there;
}

static void ipm_free(struct ipm *m)
{
    free(m->kept);
    central_free(&m->c);
}

static bool ipm_init(struct ipm *m, struct newton *w, struct solve *s, double gap, double fold_gap)
{
    *m = (struct ipm){ .full = s->p->kind.full, .fold_gap = fold_gap };
    if (!central_init(&m->c, w, s, gap, gap == GAP_COLD)) return false;
    m->kept = calloc((size_t)w->a.W.n + 1, sizeof *m->kept);
    if (!m->kept) ipm_free(m);
    return m->kept;
}

/*
 * Whether the solve is over: spent, or met near the solution. Where u' = u, eps_glob is a product
 * of the errors of r and of u, and small inside the cones even far from the solution.
 */
static bool arrived(struct ipm *m, struct solve *s)
{
    struct scaled *a = &m->c.newton->a;
    if (!solve_met(s)) return solve_spent(s);
    scaled_get(a, s->p, m->c.x);
    scaled_velocity(a, m->c.x, m->c.v);
    return scaled_natural(a, m->c.x, m->c.v) <= MAP_CLOSE || solve_spent(s);
}

/* Long steps, and steps by arc length where these end */
static void path_then_arc(struct newton *w, struct solve *s, double gap)
{
    bool cold = gap == GAP_COLD;
    struct ipm m;
    if (!ipm_init(&m, w, s, gap, cold ? INFINITY : GAP_LATE)) return;
    bool near = follow_path(&m, MAP_CLOSE, cold ? COLD_STEPS : WARM_STEPS);
    if (near && !solve_over(s)) newton_polish(w, s, 1e-7, 3);
    if (!arrived(&m, s)) near = arc_follow(&m.c, MAP_END, ARC_STEPS);
    if (!solve_over(s)) newton_polish(w, s, 1e-7, near ? 3 : 1);
    ipm_free(&m);
}

/* From r = 0, long steps with any of the t: for discs and capsules, whose paths fold often */
static void path_with_small_t(struct newton *w, struct solve *s)
{
    struct ipm m;
    if (!ipm_init(&m, w, s, GAP_COLD, 0)) return;
    bool more = true;
    for (int k = 0; more && k < ROUNDS && !solve_over(s); k++) {
        more = follow_path(&m, MAP_CLOSE / pow(10, k), k ? NEXT_STEPS : COLD_STEPS);
        if (!solve_over(s)) newton_polish(w, s, 1e-7, 3);
    }
    ipm_free(&m);
}

void ipm_from(struct newton *w, struct solve *s, double gap)
{
    if (!solve_over(s)) path_then_arc(w, s, gap);
}

void ipm_solve(struct newton *w, struct solve *s)
{
    ipm_from(w, s, 1e-3);
    if (!solve_over(s)) path_with_small_t(w, s);
    if (!solve_over(s)) path_then_arc(w, s, GAP_COLD);
}
