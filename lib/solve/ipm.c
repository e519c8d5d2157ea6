/* solve/ipm.c: see solve/ipm.h. */
#include "solve/ipm.h"

#include "solve/arc.h"
#include "solve/nlgs.h"

#include <stdlib.h>

#define INTERIOR 0.99 /* of the way to the border, a step goes at most */
#define LONGER   0.3  /* a corrector is to lengthen the step by this, */
#define GAINED   0.03 /* and has to by this */
#define SHORT    0.1  /* a step of this length leads nowhere */

#define CLOSE 2e-7 /* of the scaled natural map: close enough if nothing ends it sooner; */
#define END   1e-9 /* what the path by arc length is followed to, which costs a few steps more */
#define LATE  1e-4 /* the gap from which on smaller t would only lead about */
#define COLD  0.1  /* the gap at which one begins from r = 0 */

enum {
    SHORT_STEPS = 4, /* short steps in a row: it is stuck */
    CORRECTORS = 3,  /* a step, at most */
    ROUNDS = 3,      /* from r = 0, each ten times nearer */
    APPROACH = 200,  /* steps of the first round, at most, */
    AGAIN = 12,      /* and of the others */
    NEARBY = 25,     /* steps from the sweeps' reactions, at most */
    BENDS = 60,      /* steps along the path by its arc length, at most */
    SWEEPS = 500     /* of the solver before it begins: most contacts know by then what they do */
};

/* The t that are tried in turn: between balls, and where the W_cc are full (columns, walls) */
static const double ts[2][3] = { { 1, 0.9, 0.5 }, { 1, 0.7, 0.3 } };

/* Directions of one contact, to be had again */
struct directions {
    double last[2][3]; /* dx and dz without the last corrector, */
    double far[2][3];  /* and of the t that has led farthest */
};

struct ipm {
    struct central c;
    struct directions *kept; /* [n] */
    bool full;               /* the W_cc are */
    double folds;            /* at which gap folds of the path are followed, and no other t tried */
    int fold;                /* which t served last */
    int stuck;               /* steps in a row that led nowhere */
};

static double longest(const struct central *m)
{
    double step = INFINITY;
    for (int64_t c = 0; c < m->newton->a.W.n; c++) {
        const struct side *s = &m->side[c];
        step = fmin(step, fmin(jordan_to_border(s->x, s->dx), jordan_to_border(s->z, s->dz)));
    }
    return step;
}

/*
 * Gondzio's corrector: what x o z a little beyond the longest step would be, its eigenvalues brought to
 * within a factor of 10 of the target, is asked for in c.
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

/* Correctors for as long as they lengthen the step; a substitution each, and not a factorisation. */
static double lengthen(struct ipm *m, double step, double target)
{
    int64_t n = m->c.newton->a.W.n;
    for (int k = 0; k < CORRECTORS && INTERIOR * step < 0.95; k++) {
        for (int64_t c = 0; c < n; c++) {
            struct side *s = &m->c.side[c];
            side_save(s, m->kept[c].last);
            recentre(s, fmin(1, INTERIOR * step + LONGER), target);
        }
        double before = step;
        step = central_direction(&m->c, true) ? longest(&m->c) : 0;
        if (step >= before + GAINED) continue;
        if (step >= before) break;
        for (int64_t c = 0; c < n; c++) side_restore(&m->c.side[c], m->kept[c].last);
        return before;
    }
    return step;
}

/* Mehrotra's two directions with this t, and correctors; returns the length of the step to be made, 0
   for none. */
static double predict_and_correct(struct ipm *m, double t)
{
    int64_t n = m->c.newton->a.W.n;
    central_matrix(&m->c, t);
    for (int64_t c = 0; c < n; c++)
        for (int k = 0; k < 3; k++) m->c.side[c].c[k] = -m->c.side[c].l[k];
    if (!central_direction(&m->c, false)) return 0;
    double a = fmin(1, longest(&m->c)), gap = 0;
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
    return fmin(1, INTERIOR * lengthen(m, longest(&m->c), target));
}

static void move(struct central *m, double step)
{
    for (int64_t c = 0; c < m->newton->a.W.n; c++) {
        struct side *s = &m->side[c];
        for (int k = 0; k < 3; k++) s->x[k] += step * s->dx[k], s->z[k] += step * s->dz[k];
    }
}

/*
 * One step; false where there is none. The t that served last comes first: where the path has folded
 * it does so for a while.
 */
static bool ipm_step(struct ipm *m)
{
    int64_t n = m->c.newton->a.W.n;
    double step = 0;
    bool follow = m->c.gap < m->folds;
    int at = follow ? 0 : m->fold;
    for (int i = at; i < (follow ? 1 : 3) && step < SHORT; i++) {
        double far = predict_and_correct(m, ts[m->full][i]);
        if (far <= step) continue;
        step = far, at = i;
        for (int64_t c = 0; c < n; c++) side_save(&m->c.side[c], m->kept[c].far);
    }
    if (follow && step < SHORT) return false;
    for (int64_t c = 0; c < n; c++) side_restore(&m->c.side[c], m->kept[c].far);
    m->fold = at > 0 && step > 0.3 ? at - 1 : at;
    m->stuck = step < 1e-3 ? m->stuck + 1 : 0;
    if (step > 0) move(&m->c, step);
    return step > 0 && m->stuck < SHORT_STEPS;
}

/*
 * On to where the scaled natural map is at most `natural`; false where `steps` do not get it there. The best
 * that it found becomes the iterate.
 */
static bool approach(struct ipm *m, double natural, int steps)
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

static void leave(struct ipm *m)
{
    free(m->kept);
    central_free(&m->c);
}

static bool begin(struct ipm *m, struct newton *w, struct solve *s, double gap, double folds)
{
    *m = (struct ipm){ .full = s->p->full, .folds = folds };
    if (!central_init(&m->c, w, s, gap, gap == COLD)) return false;
    m->kept = calloc((size_t)w->a.W.n + 1, sizeof *m->kept);
    if (!m->kept) leave(m);
    return m->kept;
}

/*
 * Spent, or met near the solution: where u' = u, eps_glob is a product of two errors, and as small for
 * reactions inside their cones that are far from it.
 */
static bool arrived(struct ipm *m, struct solve *s)
{
    struct scaled *a = &m->c.newton->a;
    if (!solve_met(s)) return solve_spent(s);
    scaled_get(a, s->p, m->c.x);
    scaled_velocity(a, m->c.x, m->c.v);
    return scaled_natural(a, m->c.x, m->c.v) <= CLOSE || solve_spent(s);
}

/* Long steps, and by arc length where they end */
static void along(struct newton *w, struct solve *s, double gap)
{
    bool cold = gap == COLD;
    struct ipm m;
    if (!begin(&m, w, s, gap, cold ? INFINITY : LATE)) return;
    bool near = approach(&m, CLOSE, cold ? APPROACH : NEARBY);
    if (near && !solve_over(s)) newton_polish(w, s, 1e-7, 3);
    if (!arrived(&m, s)) near = arc_follow(&m.c, END, BENDS);
    if (!solve_over(s)) newton_polish(w, s, 1e-7, near ? 3 : 1);
    leave(&m);
}

/* Long steps with whatever t leads on, from afar: what discs and capsules want, whose paths fold often */
static void about(struct newton *w, struct solve *s)
{
    struct ipm m;
    if (!begin(&m, w, s, COLD, 0)) return;
    bool more = true;
    for (int k = 0; more && k < ROUNDS && !solve_over(s); k++) {
        more = approach(&m, CLOSE / pow(10, k), k ? AGAIN : APPROACH);
        if (!solve_over(s)) newton_polish(w, s, 1e-7, 3);
    }
    leave(&m);
}

void ipm_from(struct newton *w, struct solve *s, double gap)
{
    if (!solve_over(s)) along(w, s, gap);
}

void ipm_solve(struct newton *w, struct solve *s)
{
    ipm_from(w, s, 1e-3);
    if (!solve_over(s)) about(w, s);
    if (!solve_over(s)) along(w, s, COLD);
}

static int run(struct solve *s)
{
    struct newton w;
    const char *reason;
    if (nlgs_sweeps(s, SWEEPS, s->o->relax > 0 ? s->o->relax : 1.3)) return -1;
    if (solve_over(s)) return 0;
    int e = newton_init(&w, s, &reason);
    if (e) return e < 0 ? -1 : nlgs_fall_back(s, reason);
    e = solve_keep_best(s);
    if (!e) ipm_solve(&w, s);
    newton_free(&w);
    return e;
}

const struct solver solver_ipm = { "ipm", "interior point method on all contacts at once", 0, run };
