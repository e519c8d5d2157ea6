/* ipm.c: see ipm.h. */
#include "ipm.h"

#include <stdlib.h>
#include <string.h>

#define INTERIOR 0.99 /* of the way to the border */
#define MU_LEAST 1e-4 /* a cone needs an inside */
#define LONGER   0.3  /* by which a corrector is to lengthen the step, and */
#define GAINED   0.03 /* what it has to, at least */

#define NEAR 2e-7 /* of the scaled natural map: from there on Newton sees the statuses */

enum {
    SHORT_STEPS = 4, /* in a row, and it is stuck */
    CORRECTORS = 3,  /* a step */
    ROUNDS = 3,      /* from a start, each ten times nearer; */
    APPROACH = 80,   /* steps of the first, and */
    AGAIN = 12       /* of the others */
};

/* The t that are tried in turn: between balls, and where the W_cc are full (columns, walls) */
static const double ts[2][3] = { { 1, 0.9, 0.5 }, { 1, 0.7, 0.3 } };

/* One contact: x, z in K, and what the scaling needs of them; d numbers of each, the third 0 in the
   plane. */
struct side {
    double mu;
    double x[3], z[3], dx[3], dz[3];
    double y[3];      /* z as the motion has it */
    double e[2];      /* u_t/|u_t|, smoothed */
    double v[3], eta; /* F = eta (2 v v' - J), F x = F^-1 z = l */
    double l[3];
    double c[3];      /* what F dx + F^-1 dz is to be */
    double was[2][3]; /* dx and dz without the last corrector, */
    double far[2][3]; /* and of the t that has led farthest */
};

struct ipm {
    struct newton *w;
    struct side *side;
    double *best; /* [n d] the reactions with the least natural map */
    double unit;  /* of velocities: q is of order 1 after it */
    double gap;   /* x.z, mean */
    bool full;    /* the W_cc are */
    int fold;     /* which t served last */
    int stuck;    /* steps in a row that led nowhere */
};

static double tangent(const double x[3])
{
    return sqrt(x[1] * x[1] + x[2] * x[2]);
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* x_0^2 - |x_t|^2 */
static double det(const double x[3])
{
    double t = tangent(x);
    return (x[0] - t) * (x[0] + t);
}

/* out = eta (2 v v' - J) a; its inverse is 1/eta (2 Jv Jv' - J) */
static void apply(const double v[3], double eta, const double a[3], double out[3])
{
    double s = 2 * dot(v, a);
    out[0] = eta * (s * v[0] - a[0]);
    out[1] = eta * (s * v[1] + a[1]), out[2] = eta * (s * v[2] + a[2]);
}

static void apply_inverse(const double v[3], double eta, const double a[3], double out[3])
{
    const double jv[3] = { v[0], -v[1], -v[2] };
    apply(jv, 1 / eta, a, out);
}

static void product(const double a[3], const double b[3], double out[3])
{
    out[0] = dot(a, b);
    out[1] = a[0] * b[1] + b[0] * a[1], out[2] = a[0] * b[2] + b[0] * a[2];
}

/* out: l o out = c */
static void quotient(const double l[3], const double c[3], double out[3])
{
    out[0] = (l[0] * c[0] - l[1] * c[1] - l[2] * c[2]) / det(l);
    out[1] = (c[1] - l[1] * out[0]) / l[0], out[2] = (c[2] - l[2] * out[0]) / l[0];
}

/* The largest step along dx that stays in K */
static double to_border(const double x[3], const double dx[3])
{
    double a = (dx[0] - tangent(dx)) * (dx[0] + tangent(dx));
    double b = x[0] * dx[0] - x[1] * dx[1] - x[2] * dx[2], c = det(x);
    double root = b * b - a * c, step = INFINITY;
    if (root >= 0) {
        double r = sqrt(root), first = c / (-b + r), second = c / (-b - r);
        if (first > 0) step = fmin(step, first);
        if (second > 0) step = fmin(step, second);
    }
    return dx[0] < 0 ? fmin(step, -x[0] / dx[0]) : step;
}

/* x o z = g e with x - z as it is: where the path begins near a given x and z */
static void centre(struct side *s, double gap)
{
    double tau[3] = { s->x[0] - s->z[0], s->x[1] - s->z[1], s->x[2] - s->z[2] }, t = tangent(tau);
    double f[2];
    for (int k = 0; k < 2; k++) {
        double l = k ? tau[0] - t : tau[0] + t, root = sqrt(l * l + 4 * gap);
        f[k] = l > 0 ? (l + root) / 2 : 2 * gap / (root - l);
    }
    double x = (f[0] - f[1]) / 2, z = (gap / f[0] - gap / f[1]) / 2;
    s->x[0] = (f[0] + f[1]) / 2, s->z[0] = (gap / f[0] + gap / f[1]) / 2;
    for (int k = 1; k < 3; k++) {
        s->x[k] = t > 0 ? x * tau[k] / t : 0;
        s->z[k] = t > 0 ? z * tau[k] / t : 0;
    }
}

/* y of all contacts at their x, |u_t| smoothed; the scaled natural map as the reactions stand */
static double look(struct ipm *m)
{
    struct newton *w = m->w;
    struct whole *a = &w->whole;
    int d = a->W.d;
    for (int64_t c = 0; c < a->W.n; c++) {
        struct side *s = &m->side[c];
        const double r[3] = { s->x[0] / s->mu, s->x[1], s->x[2] };
        double in[3] = { 0 };
        for (int k = 0; k < 3; k++) in[k] = r[k] * m->unit;
        whole_store(d, in, w->x + d * c);
    }
    whole_velocity(a, w->x, w->v);
    for (int64_t c = 0; c < a->W.n; c++) {
        struct side *s = &m->side[c];
        double u[3];
        whole_load(d, w->v + d * c, u);
        for (int k = 0; k < 3; k++) u[k] /= m->unit;
        double smooth = sqrt(u[1] * u[1] + u[2] * u[2] + m->gap * m->gap);
        s->y[0] = u[0] / s->mu + (smooth - m->gap), s->y[1] = u[1], s->y[2] = u[2];
        s->e[0] = smooth > 0 ? u[1] / smooth : 0, s->e[1] = smooth > 0 ? u[2] / smooth : 0;
    }
    return whole_natural(a, w->x, w->v);
}

/* The scaling at (x, z); false where one of them has come too near the border. */
static bool scaling(struct side *s)
{
    double dx = det(s->x), dz = det(s->z);
    if (!(dx > 0) || !(dz > 0)) return false;
    double rx = 1 / sqrt(dx), rz = 1 / sqrt(dz);
    double g = sqrt((1 + dot(s->x, s->z) * rx * rz) / 2);
    double wb[3] = { (s->z[0] * rz + s->x[0] * rx) / (2 * g),
                     (s->z[1] * rz - s->x[1] * rx) / (2 * g),
                     (s->z[2] * rz - s->x[2] * rx) / (2 * g) };
    double n = 1 / sqrt(2 * (wb[0] + 1));
    s->v[0] = (wb[0] + 1) * n, s->v[1] = wb[1] * n, s->v[2] = wb[2] * n;
    s->eta = sqrt(sqrt(dz / dx));
    apply(s->v, s->eta, s->x, s->l);
    return isfinite(s->eta);
}

/* The matrix with this t: L = I + t E, D = D T D, T = F F. */
static void matrix(struct ipm *m, double t)
{
    struct newton *w = m->w;
    for (int64_t c = 0; c < w->whole.W.n; c++) {
        const struct side *s = &m->side[c];
        const double L[9] = { 1, t * s->mu * s->e[0], t * s->mu * s->e[1], 0, 1, 0, 0, 0, 1 };
        memcpy(w->L + 9 * c, L, sizeof L);
        for (int j = 0; j < 3; j++) {
            double unit[3] = { 0 }, f[3], T[3];
            unit[j] = 1;
            apply(s->v, s->eta, unit, f);
            apply(s->v, s->eta, f, T);
            for (int i = 0; i < 3; i++)
                w->D[9 * c + 3 * i + j] = (i ? 1 : s->mu) * T[i] * (j ? 1 : s->mu);
        }
    }
}

/* dx and dz of all contacts for F dx + F^-1 dz = c and z + dz = y + dy; false: the matrix is singular */
static bool direction(struct ipm *m, bool factorised)
{
    struct newton *w = m->w;
    int d = w->whole.W.d;
    for (int64_t c = 0; c < w->whole.W.n; c++) {
        const struct side *s = &m->side[c];
        double b[3];
        apply(s->v, s->eta, s->c, b);
        for (int i = 0; i < 3; i++) b[i] = (b[i] - (s->y[i] - s->z[i])) * (i ? 1 : s->mu);
        whole_store(d, b, w->z + d * c);
    }
    if (factorised ? !system_again(w->system, w->z) : !system_solve(w->system, w->L, w->D, w->z))
        return false;
    for (int64_t c = 0; c < w->whole.W.n; c++) {
        struct side *s = &m->side[c];
        double f[3];
        whole_load(d, w->z + d * c, s->dx);
        s->dx[0] *= s->mu;
        apply(s->v, s->eta, s->dx, f);
        for (int i = 0; i < 3; i++) f[i] = s->c[i] - f[i];
        apply(s->v, s->eta, f, s->dz);
        if (d == 2) s->dx[2] = s->dz[2] = 0;
    }
    return true;
}

static double longest(const struct ipm *m)
{
    double step = INFINITY;
    for (int64_t c = 0; c < m->w->whole.W.n; c++) {
        const struct side *s = &m->side[c];
        step = fmin(step, fmin(to_border(s->x, s->dx), to_border(s->z, s->dz)));
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
    apply(s->v, s->eta, x, fx);
    apply_inverse(s->v, s->eta, z, fz);
    product(fx, fz, p);
    double t = tangent(p);
    for (int k = 0; k < 2; k++) {
        double l = k ? p[0] - t : p[0] + t;
        f[k] = fmax(fmin(fmax(l, target / 10), 10 * target) - l, -10 * target);
    }
    for (int k = 1; k < 3; k++) p[k] *= t > 0 ? (f[0] - f[1]) / 2 / t : 0;
    p[0] = (f[0] + f[1]) / 2;
    quotient(s->l, p, more);
    for (int k = 0; k < 3; k++) s->c[k] += more[k];
}

/* dx and dz, to be had again */
static void remember(const struct side *s, double to[2][3])
{
    memcpy(to[0], s->dx, sizeof s->dx), memcpy(to[1], s->dz, sizeof s->dz);
}

static void recall(struct side *s, double from[2][3])
{
    memcpy(s->dx, from[0], sizeof s->dx), memcpy(s->dz, from[1], sizeof s->dz);
}

/* Correctors for as long as they lengthen the step; a substitution each, and not a factorisation. */
static double lengthen(struct ipm *m, double step, double target)
{
    int64_t n = m->w->whole.W.n;
    for (int k = 0; k < CORRECTORS && INTERIOR * step < 0.95; k++) {
        for (int64_t c = 0; c < n; c++) {
            struct side *s = &m->side[c];
            remember(s, s->was);
            recentre(s, fmin(1, INTERIOR * step + LONGER), target);
        }
        double before = step;
        step = direction(m, true) ? longest(m) : 0;
        if (step >= before + GAINED) continue;
        if (step >= before) break;
        for (int64_t c = 0; c < n; c++) recall(&m->side[c], m->side[c].was);
        return before;
    }
    return step;
}

/* Mehrotra's two directions with this t, and correctors; returns the length of the step to be made, 0
   for none. */
static double predict_and_correct(struct ipm *m, double t)
{
    int64_t n = m->w->whole.W.n;
    matrix(m, t);
    for (int64_t c = 0; c < n; c++)
        for (int k = 0; k < 3; k++) m->side[c].c[k] = -m->side[c].l[k];
    if (!direction(m, false)) return 0;
    double a = fmin(1, longest(m)), gap = 0;
    for (int64_t c = 0; c < n; c++) {
        const struct side *s = &m->side[c];
        for (int k = 0; k < 3; k++) gap += (s->x[k] + a * s->dx[k]) * (s->z[k] + a * s->dz[k]);
    }
    double sigma = fmin(1, fmax(0, gap / (double)n / m->gap)),
           target = sigma * sigma * sigma * m->gap;
    for (int64_t c = 0; c < n; c++) {
        struct side *s = &m->side[c];
        double fx[3], fz[3], second[3], ll[3], want[3];
        apply(s->v, s->eta, s->dx, fx);
        apply_inverse(s->v, s->eta, s->dz, fz);
        product(fx, fz, second), product(s->l, s->l, ll);
        for (int k = 0; k < 3; k++) want[k] = (k ? 0 : target) - ll[k] - second[k];
        quotient(s->l, want, s->c);
    }
    return direction(m, true) ? fmin(1, INTERIOR * lengthen(m, longest(m), target)) : 0;
}

static void move(struct ipm *m, double step)
{
    for (int64_t c = 0; c < m->w->whole.W.n; c++) {
        struct side *s = &m->side[c];
        for (int k = 0; k < 3; k++) s->x[k] += step * s->dx[k], s->z[k] += step * s->dz[k];
    }
}

/* Where it starts: w's x and what it makes, moved into the cones. */
static void start(struct ipm *m, double gap)
{
    struct newton *w = m->w;
    struct whole *a = &w->whole;
    int d = a->W.d;
    double q2 = 0;
    for (int32_t i = 0; i < a->size; i++) q2 += a->W.q[i] * a->W.q[i];
    m->unit = q2 > 0 ? sqrt(q2 / (double)a->W.n) : 1;
    m->gap = 0;
    for (int64_t c = 0; c < a->W.n; c++) {
        struct side *s = &m->side[c];
        s->mu = fmax(a->W.mu[c], MU_LEAST);
        double r[3];
        whole_load(d, w->x + d * c, r);
        s->x[0] = s->mu * r[0] / m->unit;
        for (int k = 1; k < 3; k++) s->x[k] = r[k] / m->unit;
    }
    look(m);
    for (int64_t c = 0; c < a->W.n; c++) {
        memcpy(m->side[c].z, m->side[c].y, sizeof m->side[c].z);
        centre(&m->side[c], gap);
    }
}

/* The reactions, back in their cones, into the rows */
static void settle(struct ipm *m, struct solve *s)
{
    struct newton *w = m->w;
    int d = w->whole.W.d;
    for (int64_t c = 0; c < w->whole.W.n; c++) {
        double r[3], p[3] = { 0 };
        whole_load(d, w->x + d * c, r);
        cone_project(w->whole.W.mu[c], r, p);
        whole_store(d, p, w->x + d * c);
    }
    newton_put(w, s);
}

static void leave(struct ipm *m)
{
    free(m->side), free(m->best);
}

/* From the rows' reactions, or from none. */
static bool begin(struct ipm *m, struct newton *w, struct solve *s, double gap, bool cold)
{
    *m = (struct ipm){ .w = w, .full = s->p->full };
    m->side = calloc((size_t)w->whole.W.n + 1, sizeof *m->side);
    m->best = malloc(((size_t)w->whole.size + 1) * sizeof *m->best);
    if (!m->side || !m->best) return leave(m), false;
    newton_get(w, s);
    if (cold) memset(w->x, 0, (size_t)w->whole.size * sizeof *w->x);
    start(m, gap);
    return true;
}

static double mean_gap(const struct ipm *m)
{
    double gap = 0;
    for (int64_t c = 0; c < m->w->whole.W.n; c++) gap += dot(m->side[c].x, m->side[c].z);
    return gap / (double)m->w->whole.W.n;
}

/*
 * One step; false where there is none. The t that served last comes first: where the path has folded
 * it does so for a while.
 */
static bool ipm_step(struct ipm *m, struct report *rep)
{
    const double *t = ts[m->full];
    int64_t n = m->w->whole.W.n;
    double step = 0;
    int at = m->fold;
    for (int i = m->fold; i < 3 && step < 0.1; i++) {
        double far = predict_and_correct(m, t[i]);
        rep->newton++;
        if (far <= step) continue;
        step = far, at = i;
        for (int64_t c = 0; c < n; c++) remember(&m->side[c], m->side[c].far);
    }
    for (int64_t c = 0; c < n; c++) recall(&m->side[c], m->side[c].far);
    m->fold = at > 0 && step > 0.3 ? at - 1 : at;
    m->stuck = step < 1e-3 ? m->stuck + 1 : 0;
    if (step > 0) move(m, step);
    return step > 0 && m->stuck < SHORT_STEPS;
}

/*
 * On to where the scaled natural map is at most `natural`; false where so many steps do not get it
 * there. The best that it found is in the rows.
 */
static bool approach(struct ipm *m, struct solve *s, double natural, int steps)
{
    struct newton *w = m->w;
    double least = INFINITY;
    bool more = true;
    for (int k = 0; more && k < steps; k++) {
        m->gap = mean_gap(m);
        double e = look(m);
        if (e < least) least = e, memcpy(m->best, w->x, (size_t)w->whole.size * sizeof *w->x);
        if (s->o->progress) s->o->progress(s->rep->sweeps, e);
        if (e <= natural || !isfinite(e) || solve_spent(s)) break;
        for (int64_t c = 0; more && c < w->whole.W.n; c++) more = scaling(&m->side[c]);
        more = more && ipm_step(m, s->rep);
    }
    if (least < INFINITY) {
        memcpy(w->x, m->best, (size_t)w->whole.size * sizeof *w->x);
        settle(m, s);
    }
    return least <= natural;
}

void ipm_solve(struct newton *w, struct solve *s)
{
    static const struct {
        double gap;
        bool cold;
    } starts[] = { { 1e-3, false }, { 0.1, true } };
    bool near = false;
    for (int i = 0; i < 2 && !near && !solve_met(s) && !solve_spent(s); i++) {
        struct ipm m;
        newton_back(w, s);
        if (!begin(&m, w, s, starts[i].gap, starts[i].cold)) return;
        bool more = true;
        for (int k = 0; more && k < ROUNDS && !solve_met(s) && !solve_spent(s); k++) {
            more = approach(&m, s, NEAR / pow(10, k), k ? AGAIN : APPROACH);
            near = near || more;
            if (!solve_met(s)) newton_polish(w, s, 1e-7, 3);
        }
        leave(&m);
    }
}
