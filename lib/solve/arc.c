/* solve/arc.c: the steps along the central path by its arc length [solve/arc.h]. */
#include "solve/arc.h"

#include <stdlib.h>
#include <string.h>

/* Sizes of the largest correction of a contact after a step, relative to what is corrected */
#define AIM   0.3 /* what a step is to leave */
#define SMALL 0.7 /* with no more than this the next step follows at once */
#define LARGE 1.5 /* with more than this the step was too long */

#define FALL        0.01 /* s falls in a step to this fraction of itself, at most */
#define ROUNDING    2e-6 /* natural map: below it a correction may be lost in rounding */
#define REACH_LEAST 1e-6 /* reach of a step: a shorter one gains nothing */

enum {
    BACKWARDS = 10 /* steps in which s grows, at most */
};

/* Directions: the first and second derivatives by s, and Newton's correction */
enum { TANGENT, BEND, CORRECTION, DIRECTIONS };

struct course {
    double p0[3];
    double to[DIRECTIONS][2][3]; /* in x and in z */
    double tau[3][3];            /* x - z on the last step: tau[0] + h tau[1] + h^2/2 tau[2] */
};

struct arc {
    struct central *m;
    struct course *at; /* [n] */
    double g0, s;
    double h, last[3];     /* the length of the last step in s; s on it, as tau */
    double reach, ceiling; /* the length of the next step in F's measure, and the longest allowed */
    double before;         /* where the last step only corrected: by how much; else 0 */
};

/* The inner product of two directions in F's measure, that of changes relative to x and z */
static double inner(const struct central *m, const struct side *s, double a[2][3], double b[2][3])
{
    double fa[3], fb[3], sum;
    scaling_apply(&s->F, a[0], fa), scaling_apply(&s->F, b[0], fb);
    sum = jordan_dot(fa, fb);
    scaling_inverse(&s->F, a[1], fa), scaling_inverse(&s->F, b[1], fb);
    return (sum + jordan_dot(fa, fb)) / m->gap;
}

static double parabola(const double part[3], double h)
{
    return part[0] + h * (part[1] + h / 2 * part[2]);
}

/* Moves s, x and z to where the last step leads. */
static void move_to(struct arc *p)
{
    p->s = parabola(p->last, p->h);
    for (int64_t c = 0; c < p->m->newton->a.W.n; c++) {
        struct side *s = &p->m->side[c];
        const struct course *a = &p->at[c];
        for (int k = 0; k < 3; k++) {
            const double part[3] = { a->tau[0][k], a->tau[1][k], a->tau[2][k] };
            s->x[k] = parabola(part, p->h), s->z[k] = 0;
        }
        jordan_centre(s->x, s->z, p->s * p->g0);
    }
}

/* Makes the last step again, shorter by this factor; false where it gets too short. */
static bool shorten(struct arc *p, double by)
{
    p->reach *= by, p->h *= by, p->before = 0;
    if (p->h == 0 || p->reach < REACH_LEAST) return false;
    move_to(p);
    return true;
}

/* |u_t|, smoothed */
static double smooth_tail(const struct arc *p, const struct side *s)
{
    double t = jordan_tail(s->y), gap = p->m->gap;
    return sqrt(t * t + gap * gap);
}

/* dx/ds and dz/ds; false where the matrix is singular. */
static bool find_tangent(struct arc *p)
{
    struct central *m = p->m;
    int64_t n = m->newton->a.W.n;
    central_matrix(m, 1);
    for (int64_t c = 0; c < n; c++) {
        struct side *s = &m->side[c];
        const double more[3] = { p->g0, 0, 0 };
        jordan_quotient(s->l, more, s->c);
        for (int k = 0; k < 3; k++) s->p[k] = p->at[c].p0[k] - (s->y[k] - s->z[k]);
        s->p[0] += p->g0 * (m->gap / smooth_tail(p, s) - 1);
    }
    if (!central_direction(m, false)) return false;
    for (int64_t c = 0; c < n; c++) side_save(&m->side[c], p->at[c].to[TANGENT]);
    return true;
}

/* A direction other than the tangent, with its matrix; 0 and false where it is lost in rounding. */
static bool find_direction(struct arc *p, int which)
{
    struct central *m = p->m;
    bool found = central_direction(m, true);
    for (int64_t c = 0; c < m->newton->a.W.n; c++) {
        memset(p->at[c].to[which], 0, sizeof p->at[c].to[which]);
        if (found) side_save(&m->side[c], p->at[c].to[which]);
    }
    return found;
}

/* d2x/ds2 and d2z/ds2, from the product of the tangent's x and z and the curvature of |u_t| */
static void find_bend(struct arc *p)
{
    struct central *m = p->m;
    for (int64_t c = 0; c < m->newton->a.W.n; c++) {
        struct side *s = &m->side[c];
        const struct course *a = &p->at[c];
        const double *dx = a->to[TANGENT][0], *dz = a->to[TANGENT][1];
        double fx[3], fz[3], want[3];
        scaling_apply(&s->F, dx, fx), scaling_inverse(&s->F, dz, fz);
        jordan_product(fx, fz, want);
        for (int k = 0; k < 3; k++) want[k] *= -2, s->p[k] = -(s->y[k] - s->z[k]);
        jordan_quotient(s->l, want, s->c);
        double u1 = dz[1] - a->p0[1], u2 = dz[2] - a->p0[2], smooth = smooth_tail(p, s),
               along = (s->y[1] * u1 + s->y[2] * u2 + m->gap * p->g0) / smooth;
        s->p[0] += (u1 * u1 + u2 * u2 + p->g0 * p->g0 - along * along) / smooth;
    }
    find_direction(p, BEND);
}

/* Newton's correction at this s; false where it is lost in rounding. */
static bool find_correction(struct arc *p)
{
    struct central *m = p->m;
    for (int64_t c = 0; c < m->newton->a.W.n; c++) {
        struct side *s = &m->side[c];
        double ll[3], want[3];
        jordan_product(s->l, s->l, ll);
        for (int k = 0; k < 3; k++)
            want[k] = (k ? 0 : m->gap) - ll[k], s->p[k] = p->s * p->at[c].p0[k];
        jordan_quotient(s->l, want, s->c);
    }
    return find_direction(p, CORRECTION);
}

/* The largest length of this direction in any contact */
static double arc_longest(const struct arc *p, int which)
{
    double max2 = 0;
    for (int64_t c = 0; c < p->m->newton->a.W.n; c++) {
        double(*d)[3] = p->at[c].to[which];
        max2 = fmax(max2, inner(p->m, &p->m->side[c], d, d));
    }
    return sqrt(max2);
}

/* Makes a direction at constant s orthogonal to the tangent; returns what it then adds to s. */
static double orthogonalise(struct arc *p, int which)
{
    struct central *m = p->m;
    int64_t n = m->newton->a.W.n;
    double tt = 1 / (p->s * p->s), td = 0;
    for (int64_t c = 0; c < n; c++) {
        struct course *a = &p->at[c];
        tt += inner(m, &m->side[c], a->to[TANGENT], a->to[TANGENT]);
        td += inner(m, &m->side[c], a->to[TANGENT], a->to[which]);
    }
    for (int64_t c = 0; c < n; c++) {
        struct course *a = &p->at[c];
        for (int j = 0; j < 2; j++)
            for (int k = 0; k < 3; k++) a->to[which][j][k] -= td / tt * a->to[TANGENT][j][k];
    }
    return -td / tt;
}

/* Corrects, and goes on by h along the tangent and the bend. It adds
   `corrected` to s, and s'' is `turn`. */
static void arc_step(struct arc *p, double corrected, double h, double turn)
{
    double from = p->s + corrected;
    p->last[0] = from, p->last[1] = 1, p->last[2] = turn, p->h = h;
    while (parabola(p->last, p->h) < FALL * from) p->h *= 0.8;
    for (int64_t c = 0; c < p->m->newton->a.W.n; c++) {
        const struct side *s = &p->m->side[c];
        struct course *a = &p->at[c];
        for (int k = 0; k < 3; k++) {
            a->tau[0][k] = s->x[k] - s->z[k] + a->to[CORRECTION][0][k] - a->to[CORRECTION][1][k];
            a->tau[1][k] = a->to[TANGENT][0][k] - a->to[TANGENT][1][k];
            a->tau[2][k] = a->to[BEND][0][k] - a->to[BEND][1][k];
        }
    }
    move_to(p);
}

/* Only corrects: the step before may still turn out to have been too long. */
static void correct(struct arc *p, double corrected)
{
    p->s += corrected;
    for (int64_t c = 0; c < p->m->newton->a.W.n; c++) {
        struct side *s = &p->m->side[c];
        double(*d)[3] = p->at[c].to[CORRECTION];
        for (int k = 0; k < 3; k++) s->x[k] += d[0][k], s->z[k] += d[1][k];
        jordan_centre(s->x, s->z, p->s * p->g0);
    }
}

/* The change of s in a step of length p->reach from `s`, downwards or not */
static double stride(const struct arc *p, double s, double steepest, bool down)
{
    double relative = p->reach / (steepest * p->s);
    // about 1 - exp(-relative), but with the same bits on every machine
    double fall = 1 - 1 / (1 + relative * (1 + relative / 2));
    if (down) return -fmax(0, fmin(s * fall, s - FALL * p->s));
    return fmin(2, relative) * p->s;
}

/* Whether the last step was too long, or only corrected too little; `most`: the correction now */
static bool was_too_long(const struct arc *p, double most)
{
    if (p->before > 0) return most > SMALL && most > 0.7 * p->before;
    return p->h != 0 && most > LARGE;
}

/* The last step again, shorter; longer ones come back slowly. */
static bool retreat(struct arc *p, double most)
{
    p->ceiling = 0.8 * p->reach;
    return shorten(p, fmin(0.5, fmax(0.25, 0.7 * cbrt(AIM / most))));
}

/* The length of the next step, from the correction `most`, which grows with the cube of it */
static void choose_reach(struct arc *p, double most)
{
    if (p->h == 0 || p->before > 0) return;
    p->reach = fmin(p->reach * fmin(3, fmax(0.5, cbrt(AIM / most))), p->ceiling);
    p->ceiling *= 1.2;
}

static bool arc_begin(struct arc *p, struct central *m)
{
    int64_t n = m->newton->a.W.n;
    *p = (struct arc){ .m = m, .g0 = central_mean_gap(m), .s = 1, .reach = 1, .ceiling = INFINITY };
    p->at = calloc((size_t)n + 1, sizeof *p->at);
    if (!p->at) return false;
    for (int64_t c = 0; c < n; c++) jordan_centre(m->side[c].x, m->side[c].z, p->g0);
    m->gap = p->g0;
    central_evaluate(m);
    for (int64_t c = 0; c < n; c++)
        for (int k = 0; k < 3; k++) p->at[c].p0[k] = m->side[c].z[k] - m->side[c].y[k];
    return true;
}

bool arc_follow(struct central *m, double natural, int steps)
{
    struct solve *s = m->solve;
    struct arc p;
    if (!arc_begin(&p, m)) return false;
    int sign = 0, backwards = 0;
    bool there = false;
    for (int k = 0; k < steps && backwards <= BACKWARDS; k++) {
        m->gap = p.s * p.g0;
        double e = central_evaluate(m);
        if (s->o->progress) s->o->progress(s->rep->sweeps, e);
        there = central_finish(m, e) || e <= natural;
        if (there || !isfinite(e) || solve_spent(s) || !central_scale(m)) break;
        if (!find_tangent(&p)) { // as near a fold, or in rounding
            if (e < ROUNDING || !shorten(&p, 0.7)) break;
            continue;
        }
        if (!find_correction(&p) && e < ROUNDING) break;
        find_bend(&p);
        if (!sign) sign = system_sign(m->newton->system);
        bool down = system_sign(m->newton->system) == sign;
        backwards += !down;
        double corrected = orthogonalise(&p, CORRECTION), turn = orthogonalise(&p, BEND),
               most = arc_longest(&p, CORRECTION);
        if (p.s + corrected < FALL * p.s || corrected > p.s) corrected = 0;
        if (was_too_long(&p, most)) {
            if (!retreat(&p, most)) break;
            continue;
        }
        choose_reach(&p, most);
        p.before = most < SMALL ? 0 : most;
        if (p.before > 0)
            correct(&p, corrected);
        else
            arc_step(&p, corrected, stride(&p, p.s + corrected, arc_longest(&p, TANGENT), down),
                     turn);
    }
    for (int64_t c = 0; c < m->newton->a.W.n; c++) memset(m->side[c].p, 0, sizeof m->side[c].p);
    free(p.at);
    central_restore_best(m);
    return there;
}
