/* solve/central_path.c: points, scalings and directions of the central path
   [solve/central_path.h]. */
#include "solve/central_path.h"

#include <stdlib.h>
#include <string.h>

#define MU_LEAST 1e-4   /* friction is taken to be at least this: a cone needs an inside */
#define CLEAR    1.5e-6 /* natural map: from it Newton finishes every second or third time */
#define AGAIN    0.4    /* Newton is tried again when the map has fallen to this fraction */

void central_free(struct central *m)
{
    free(m->side), free(m->room), best_free(&m->best);
}

/* x and z from the reactions in m->x and their velocities, moved into the cones */
static void start_inside(struct central *m, double gap)
{
    struct scaled *a = &m->newton->a;
    int d = a->W.d;
    double q2 = 0;
    for (int32_t i = 0; i < a->size; i++) q2 += a->W.q[i] * a->W.q[i];
    m->unit = q2 > 0 ? sqrt(q2 / (double)a->W.n) : 1;
    m->gap = 0;
    for (int64_t c = 0; c < a->W.n; c++) {
        struct side *s = &m->side[c];
        s->mu = fmax(a->W.mu[c], MU_LEAST);
        double r[3];
        scaled_load(d, m->x + d * c, r);
        s->x[0] = s->mu * r[0] / m->unit;
        for (int k = 1; k < 3; k++) s->x[k] = r[k] / m->unit;
    }
    central_evaluate(m);
    for (int64_t c = 0; c < a->W.n; c++) {
        memcpy(m->side[c].z, m->side[c].y, sizeof m->side[c].z);
        jordan_centre(m->side[c].x, m->side[c].z, gap);
    }
    m->gap = gap;
    best_forget(&m->best);
}

bool central_init(struct central *m, struct newton *newton, struct solve *s, double gap, bool cold)
{
    *m = (struct central){ .solve = s, .newton = newton, .tried = INFINITY };
    size_t size = (size_t)newton->a.size + 4, blocks = 9 * (size_t)newton->a.W.n;
    m->side = calloc((size_t)newton->a.W.n + 1, sizeof *m->side);
    m->room = calloc(3 * size + 2 * blocks, sizeof *m->room);
    if (best_init(&m->best, newton->a.size) || !m->side || !m->room) return central_free(m), false;
    m->x = m->room, m->v = m->x + size, m->b = m->v + size, m->L = m->b + size;
    m->D = m->L + blocks;
    if (!cold) scaled_get(&newton->a, s->p, m->x);
    start_inside(m, gap);
    return true;
}

double central_mean_gap(const struct central *m)
{
    double gap = 0;
    for (int64_t c = 0; c < m->newton->a.W.n; c++) gap += jordan_dot(m->side[c].x, m->side[c].z);
    return gap / (double)m->newton->a.W.n;
}

double central_evaluate(struct central *m)
{
    struct scaled *a = &m->newton->a;
    int d = a->W.d;
    for (int64_t c = 0; c < a->W.n; c++) {
        struct side *s = &m->side[c];
        const double r[3] = { s->x[0] / s->mu, s->x[1], s->x[2] };
        double in[3] = { 0 };
        for (int k = 0; k < 3; k++) in[k] = r[k] * m->unit;
        scaled_store(d, in, m->x + d * c);
    }
    scaled_velocity(a, m->x, m->v);
    for (int64_t c = 0; c < a->W.n; c++) {
        struct side *s = &m->side[c];
        double u[3];
        scaled_load(d, m->v + d * c, u);
        for (int k = 0; k < 3; k++) u[k] /= m->unit;
        double smooth = sqrt(u[1] * u[1] + u[2] * u[2] + m->gap * m->gap);
        s->y[0] = u[0] / s->mu + (smooth - m->gap), s->y[1] = u[1], s->y[2] = u[2];
        s->e[0] = smooth > 0 ? u[1] / smooth : 0, s->e[1] = smooth > 0 ? u[2] / smooth : 0;
    }
    double map = scaled_natural(a, m->x, m->v);
    double *x = best_offer(&m->best, map);
    if (x) memcpy(x, m->x, (size_t)a->size * sizeof *x);
    return map;
}

bool central_scale(struct central *m)
{
    for (int64_t c = 0; c < m->newton->a.W.n; c++) {
        struct side *s = &m->side[c];
        if (!scaling_of(&s->F, s->x, s->z)) return false;
        scaling_apply(&s->F, s->x, s->l);
    }
    return true;
}

/* L = I + t E, D = D T D */
void central_matrix(struct central *m, double t)
{
    for (int64_t c = 0; c < m->newton->a.W.n; c++) {
        const struct side *s = &m->side[c];
        const double L[9] = { 1, t * s->mu * s->e[0], t * s->mu * s->e[1], 0, 1, 0, 0, 0, 1 };
        memcpy(m->L + 9 * c, L, sizeof L);
        for (int j = 0; j < 3; j++) {
            double unit[3] = { 0 }, f[3], T[3];
            unit[j] = 1;
            scaling_apply(&s->F, unit, f);
            scaling_apply(&s->F, f, T);
            for (int i = 0; i < 3; i++)
                m->D[9 * c + 3 * i + j] = (i ? 1 : s->mu) * T[i] * (j ? 1 : s->mu);
        }
    }
}

bool central_direction(struct central *m, bool factorised)
{
    struct newton *w = m->newton;
    int d = w->a.W.d;
    for (int64_t c = 0; c < w->a.W.n; c++) {
        const struct side *s = &m->side[c];
        double b[3];
        scaling_apply(&s->F, s->c, b);
        for (int i = 0; i < 3; i++) b[i] = (b[i] - (s->y[i] - s->z[i]) - s->p[i]) * (i ? 1 : s->mu);
        scaled_store(d, b, m->b + d * c);
    }
    if (factorised) {
        if (!system_solve_again(w->system, m->b)) return false;
    } else {
        if (!solve_affords(m->solve, w->price)) return false;
        double since = report_seconds(CLOCK_WALL);
        bool solved = system_solve(w->system, m->L, m->D, m->b);
        solve_count_newton(m->solve, w->price, since);
        if (!solved) return false;
    }
    for (int64_t c = 0; c < w->a.W.n; c++) {
        struct side *s = &m->side[c];
        double f[3];
        scaled_load(d, m->b + d * c, s->dx);
        s->dx[0] *= s->mu;
        scaling_apply(&s->F, s->dx, f);
        for (int i = 0; i < 3; i++) f[i] = s->c[i] - f[i];
        scaling_apply(&s->F, f, s->dz);
        if (d == 2) s->dx[2] = s->dz[2] = 0;
    }
    return true;
}

bool central_finish(struct central *m, double map)
{
    // where one rho takes a contact that hardly slides for a sticking one, another may not
    static const double rhos[] = { 7, 50, 1 };
    if (!(map <= CLEAR) || map > AGAIN * m->tried) return false;
    m->tried = map;
    if (!newton_finish(m->newton, m->solve, m->x, rhos[m->tries++ % 3])) return false;
    best_forget(&m->best);
    return true;
}

void central_restore_best(struct central *m)
{
    struct scaled *a = &m->newton->a;
    if (!(m->best.value < INFINITY)) return;
    for (int64_t c = 0; c < a->W.n; c++) {
        double r[3], p[3] = { 0 };
        scaled_load(a->W.d, m->best.x + a->W.d * c, r);
        cone_project(a->W.mu[c], r, p);
        scaled_store(a->W.d, p, m->v + a->W.d * c);
    }
    scaled_put(a, m->solve, m->v);
    best_forget(&m->best);
}
