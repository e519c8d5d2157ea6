/* path.c: see path.h. */
#include "path.h"

#include <stdlib.h>
#include <string.h>

/* Corrections, the largest of all contacts, relative to what is corrected: */
#define AIM  0.3 /* what a step is to leave to be corrected, */
#define NEAR 0.5 /* with how much it may go on, and */
#define FAR  1.0 /* what is too much: it was too long */

#define FALL     0.01 /* of s, at most, in a step */
#define ROUNDING 2e-6 /* natural maps below which a correction may be lost */
#define STANDING 1e-6 /* the reach of one that leads nowhere */

enum { BACKWARDS = 10 }; /* steps in which s grows, at most */

struct along {
    double p0[3];
    double tangent[2][3], correction[2][3]; /* dx and dz, by s and as such */
    double base[3], ahead[3];               /* tau where the step begins, corrected, and its own */
};

struct path {
    struct central *m;
    struct along *at; /* [n] */
    double g0, s;
    double base, ahead;    /* s, as tau */
    double reach, ceiling; /* how long a step is to be, and may be after one that was too long */
};

/* The product of two directions, in F's measure: that of relative changes */
static double inner(const struct central *m, const struct side *s, double a[2][3], double b[2][3])
{
    double fa[3], fb[3], sum;
    scaling_apply(&s->F, a[0], fa), scaling_apply(&s->F, b[0], fb);
    sum = jordan_dot(fa, fb);
    scaling_inverse(&s->F, a[1], fa), scaling_inverse(&s->F, b[1], fb);
    return (sum + jordan_dot(fa, fb)) / m->gap;
}

/* tau = base + ahead, and s likewise */
static void place(struct path *p)
{
    p->s = p->base + p->ahead;
    for (int64_t c = 0; c < p->m->w->whole.W.n; c++) {
        struct side *s = &p->m->side[c];
        for (int k = 0; k < 3; k++) s->x[k] = p->at[c].base[k] + p->at[c].ahead[k], s->z[k] = 0;
        jordan_centre(s->x, s->z, p->s * p->g0);
    }
}

/* The last step again, so much shorter; false where that has come to nothing. */
static bool shorten(struct path *p, double by)
{
    p->reach *= by, p->ahead *= by;
    if (p->ahead == 0 || p->reach < STANDING) return false;
    for (int64_t c = 0; c < p->m->w->whole.W.n; c++)
        for (int k = 0; k < 3; k++) p->at[c].ahead[k] *= by;
    place(p);
    return true;
}

/* dx/ds and dz/ds; false where the matrix is singular. */
static bool tangent(struct path *p)
{
    struct central *m = p->m;
    int64_t n = m->w->whole.W.n;
    central_matrix(m, 1);
    for (int64_t c = 0; c < n; c++) {
        struct side *s = &m->side[c];
        const double more[3] = { p->g0, 0, 0 };
        jordan_quotient(s->l, more, s->c);
        double t = jordan_tail(s->y), smooth = sqrt(t * t + m->gap * m->gap);
        for (int k = 0; k < 3; k++) s->p[k] = p->at[c].p0[k] - (s->y[k] - s->z[k]);
        s->p[0] += p->g0 * (m->gap / smooth - 1);
    }
    if (!central_direction(m, false)) return false;
    for (int64_t c = 0; c < n; c++) side_keep(&m->side[c], p->at[c].tangent);
    return true;
}

/* Newton's correction at this s, or none: false where it is lost in rounding. */
static bool correction(struct path *p)
{
    struct central *m = p->m;
    int64_t n = m->w->whole.W.n;
    for (int64_t c = 0; c < n; c++) {
        struct side *s = &m->side[c];
        double ll[3], want[3];
        jordan_product(s->l, s->l, ll);
        for (int k = 0; k < 3; k++)
            want[k] = (k ? 0 : m->gap) - ll[k], s->p[k] = p->s * p->at[c].p0[k];
        jordan_quotient(s->l, want, s->c);
    }
    bool seen = central_direction(m, true);
    for (int64_t c = 0; c < n; c++) {
        memset(p->at[c].correction, 0, sizeof p->at[c].correction);
        if (seen) side_keep(&m->side[c], p->at[c].correction);
    }
    return seen;
}

/* The correction is made orthogonal to the tangent; returns what it adds to s, and the largest of the
   corrections and of the tangents. */
static double straighten(struct path *p, double *most, double *steepest)
{
    struct central *m = p->m;
    int64_t n = m->w->whole.W.n;
    double tt = 1 / (p->s * p->s), tc = 0;
    for (int64_t c = 0; c < n; c++) {
        struct along *a = &p->at[c];
        tt += inner(m, &m->side[c], a->tangent, a->tangent);
        tc += inner(m, &m->side[c], a->tangent, a->correction);
    }
    *most = *steepest = 0;
    for (int64_t c = 0; c < n; c++) {
        struct along *a = &p->at[c];
        for (int j = 0; j < 2; j++)
            for (int k = 0; k < 3; k++) a->correction[j][k] -= tc / tt * a->tangent[j][k];
        *most = fmax(*most, sqrt(inner(m, &m->side[c], a->correction, a->correction)));
        *steepest = fmax(*steepest, sqrt(inner(m, &m->side[c], a->tangent, a->tangent)));
    }
    double s = p->s - tc / tt;
    return s < FALL * p->s || s > 2 * p->s ? 0 : -tc / tt;
}

/* Corrects, and goes on by ds along the tangent. */
static void step(struct path *p, double corrected, double ds)
{
    p->base = p->s + corrected, p->ahead = ds;
    for (int64_t c = 0; c < p->m->w->whole.W.n; c++) {
        const struct side *s = &p->m->side[c];
        struct along *a = &p->at[c];
        for (int k = 0; k < 3; k++) {
            a->base[k] = s->x[k] - s->z[k] + a->correction[0][k] - a->correction[1][k];
            a->ahead[k] = ds * (a->tangent[0][k] - a->tangent[1][k]);
        }
    }
    place(p);
}

/* Corrects alone: the step that it belongs to may still turn out too long. */
static void correct(struct path *p, double corrected)
{
    p->s += corrected;
    for (int64_t c = 0; c < p->m->w->whole.W.n; c++) {
        struct side *s = &p->m->side[c];
        const struct along *a = &p->at[c];
        for (int k = 0; k < 3; k++) s->x[k] += a->correction[0][k], s->z[k] += a->correction[1][k];
        jordan_centre(s->x, s->z, p->s * p->g0);
    }
}

/* How far s goes in a step of the reach from `s`, downwards or not */
static double stride(const struct path *p, double s, double steepest, bool down)
{
    double relative = p->reach / (steepest * p->s);
    if (down) return -fmax(0, fmin(s * (1 - exp(-relative)), s - FALL * p->s));
    return fmin(2, relative) * p->s;
}

static bool begin(struct path *p, struct central *m)
{
    int64_t n = m->w->whole.W.n;
    *p = (struct path){ .m = m, .g0 = central_mean(m), .s = 1, .reach = 1, .ceiling = INFINITY };
    p->at = calloc((size_t)n + 1, sizeof *p->at);
    if (!p->at) return false;
    for (int64_t c = 0; c < n; c++) jordan_centre(m->side[c].x, m->side[c].z, p->g0);
    m->gap = p->g0;
    central_motion(m);
    for (int64_t c = 0; c < n; c++)
        for (int k = 0; k < 3; k++) p->at[c].p0[k] = m->side[c].z[k] - m->side[c].y[k];
    return true;
}

bool path_follow(struct central *m, struct solve *s, double natural, int steps)
{
    struct path p;
    if (!begin(&p, m)) return false;
    double before = 0; // the last correction, where that was all of the last step
    int sign = 0, backwards = 0;
    bool there = false;
    for (int k = 0; k < steps && backwards <= BACKWARDS; k++) {
        m->gap = p.s * p.g0;
        double e = central_look(m, s), most, steepest;
        there = e <= natural || solve_met(s);
        if (there || !isfinite(e) || solve_spent(s) || !central_scale(m)) break;
        s->rep->newton++;
        if (!tangent(&p)) { // as near a fold
            if (!shorten(&p, 0.7)) break;
            before = 0;
            continue;
        }
        if (!correction(&p) && e < ROUNDING) break;
        if (!sign) sign = system_sign(m->w->system);
        double corrected = straighten(&p, &most, &steepest);
        bool down = system_sign(m->w->system) == sign;
        backwards += !down;
        if (before > 0 ? most > NEAR && most > 0.7 * before : k > 0 && most > FAR) {
            p.ceiling = 0.8 * p.reach;
            if (!shorten(&p, fmin(0.5, fmax(0.25, 0.7 * sqrt(AIM / most))))) break;
            before = 0;
            continue;
        }
        if (k > 0 && !(before > 0)) {
            p.reach = fmin(p.reach * fmin(3, fmax(0.5, sqrt(AIM / most))), p.ceiling);
            p.ceiling *= 1.2;
        }
        before = most < NEAR ? 0 : most;
        if (most < NEAR)
            step(&p, corrected, stride(&p, p.s + corrected, steepest, down));
        else
            correct(&p, corrected);
    }
    for (int64_t c = 0; c < m->w->whole.W.n; c++) memset(m->side[c].p, 0, sizeof m->side[c].p);
    free(p.at);
    central_settle(m, s);
    return there;
}
