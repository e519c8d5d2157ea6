/* solve/central_path.c: see solve/central_path.h. */
#include "solve/central_path.h"

#include <stdlib.h>
#include <string.h>

#define MU_LEAST 1e-4 /* a cone needs an inside */

/* Natural maps: at which Newton sees all statuses, in one of two or three cases, and how much less before
   that is tried again */
#define CLEAR 1.5e-6
#define AGAIN 0.4

void central_end(struct central *m)
{
    free(m->side), free(m->best);
}

/* w's x and what it makes, moved into the cones */
static void start(struct central *m, double gap)
{
    struct newton *w = m->w;
    struct scaled *a = &w->whole;
    int d = a->W.d;
    double q2 = 0;
    for (int32_t i = 0; i < a->size; i++) q2 += a->W.q[i] * a->W.q[i];
    m->unit = q2 > 0 ? sqrt(q2 / (double)a->W.n) : 1;
    m->gap = 0;
    for (int64_t c = 0; c < a->W.n; c++) {
        struct side *s = &m->side[c];
        s->mu = fmax(a->W.mu[c], MU_LEAST);
        double r[3];
        scaled_load(d, w->x + d * c, r);
        s->x[0] = s->mu * r[0] / m->unit;
        for (int k = 1; k < 3; k++) s->x[k] = r[k] / m->unit;
    }
    central_look(m);
    for (int64_t c = 0; c < a->W.n; c++) {
        memcpy(m->side[c].z, m->side[c].y, sizeof m->side[c].z);
        jordan_centre(m->side[c].x, m->side[c].z, gap);
    }
    m->gap = gap, m->least = INFINITY;
}

bool central_begin(struct central *m, struct newton *w, struct solve *s, double gap, bool cold)
{
    *m = (struct central){ .w = w, .least = INFINITY, .tried = INFINITY };
    m->side = calloc((size_t)w->whole.W.n + 1, sizeof *m->side);
    m->best = malloc(((size_t)w->whole.size + 1) * sizeof *m->best);
    if (!m->side || !m->best) return central_end(m), false;
    newton_get(w, s);
    if (cold) memset(w->x, 0, (size_t)w->whole.size * sizeof *w->x);
    start(m, gap);
    return true;
}

double central_mean(const struct central *m)
{
    double gap = 0;
    for (int64_t c = 0; c < m->w->whole.W.n; c++) gap += jordan_dot(m->side[c].x, m->side[c].z);
    return gap / (double)m->w->whole.W.n;
}

double central_look(struct central *m)
{
    struct newton *w = m->w;
    struct scaled *a = &w->whole;
    int d = a->W.d;
    for (int64_t c = 0; c < a->W.n; c++) {
        struct side *s = &m->side[c];
        const double r[3] = { s->x[0] / s->mu, s->x[1], s->x[2] };
        double in[3] = { 0 };
        for (int k = 0; k < 3; k++) in[k] = r[k] * m->unit;
        scaled_store(d, in, w->x + d * c);
    }
    scaled_velocity(a, w->x, w->v);
    for (int64_t c = 0; c < a->W.n; c++) {
        struct side *s = &m->side[c];
        double u[3];
        scaled_load(d, w->v + d * c, u);
        for (int k = 0; k < 3; k++) u[k] /= m->unit;
        double smooth = sqrt(u[1] * u[1] + u[2] * u[2] + m->gap * m->gap);
        s->y[0] = u[0] / s->mu + (smooth - m->gap), s->y[1] = u[1], s->y[2] = u[2];
        s->e[0] = smooth > 0 ? u[1] / smooth : 0, s->e[1] = smooth > 0 ? u[2] / smooth : 0;
    }
    double map = scaled_natural(a, w->x, w->v);
    if (map < m->least) m->least = map, memcpy(m->best, w->x, (size_t)a->size * sizeof *w->x);
    return map;
}

bool central_scale(struct central *m)
{
    for (int64_t c = 0; c < m->w->whole.W.n; c++) {
        struct side *s = &m->side[c];
        if (!scaling_of(&s->F, s->x, s->z)) return false;
        scaling_apply(&s->F, s->x, s->l);
    }
    return true;
}

/* L = I + t E, D = D T D */
void central_matrix(struct central *m, double t)
{
    struct newton *w = m->w;
    for (int64_t c = 0; c < w->whole.W.n; c++) {
        const struct side *s = &m->side[c];
        const double L[9] = { 1, t * s->mu * s->e[0], t * s->mu * s->e[1], 0, 1, 0, 0, 0, 1 };
        memcpy(w->L + 9 * c, L, sizeof L);
        for (int j = 0; j < 3; j++) {
            double unit[3] = { 0 }, f[3], T[3];
            unit[j] = 1;
            scaling_apply(&s->F, unit, f);
            scaling_apply(&s->F, f, T);
            for (int i = 0; i < 3; i++)
                w->D[9 * c + 3 * i + j] = (i ? 1 : s->mu) * T[i] * (j ? 1 : s->mu);
        }
    }
}

bool central_direction(struct central *m, bool factorised)
{
    struct newton *w = m->w;
    int d = w->whole.W.d;
    for (int64_t c = 0; c < w->whole.W.n; c++) {
        const struct side *s = &m->side[c];
        double b[3];
        scaling_apply(&s->F, s->c, b);
        for (int i = 0; i < 3; i++) b[i] = (b[i] - (s->y[i] - s->z[i]) - s->p[i]) * (i ? 1 : s->mu);
        scaled_store(d, b, w->z + d * c);
    }
    if (factorised ? !system_again(w->system, w->z) : !system_solve(w->system, w->L, w->D, w->z))
        return false;
    for (int64_t c = 0; c < w->whole.W.n; c++) {
        struct side *s = &m->side[c];
        double f[3];
        scaled_load(d, w->z + d * c, s->dx);
        s->dx[0] *= s->mu;
        scaling_apply(&s->F, s->dx, f);
        for (int i = 0; i < 3; i++) f[i] = s->c[i] - f[i];
        scaling_apply(&s->F, f, s->dz);
        if (d == 2) s->dx[2] = s->dz[2] = 0;
    }
    return true;
}

bool central_finish(struct central *m, struct solve *s, double map)
{
    // where one takes a contact that hardly slides for one that holds, another may not
    static const double rhos[] = { 7, 50, 1 };
    if (!(map <= CLEAR) || map > AGAIN * m->tried) return false;
    m->tried = map;
    if (!newton_finish(m->w, s, rhos[m->tries++ % 3])) return false;
    m->least = INFINITY;
    return true;
}

void central_settle(struct central *m, struct solve *s)
{
    struct newton *w = m->w;
    int d = w->whole.W.d;
    if (!(m->least < INFINITY)) return;
    for (int64_t c = 0; c < w->whole.W.n; c++) {
        double r[3], p[3] = { 0 };
        scaled_load(d, m->best + d * c, r);
        cone_project(w->whole.W.mu[c], r, p);
        scaled_store(d, p, w->x + d * c);
    }
    newton_put(w, s);
    m->least = INFINITY;
}
