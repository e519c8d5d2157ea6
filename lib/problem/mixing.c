/* problem/mixing.c: measuring and mixing [problem/mixing.h]. Compiled with LANES = 2, 4 and 8. */
#include "problem/mixing.h"

#include "problem/walk.h"

/* d and the depth are constants of each call, so that the compiler unrolls the loops over them. */
#define BY_SHAPE(p, m, text, ...)                                                                  \
    do {                                                                                           \
        bool all = (m)->depth == MIXING_DEPTH;                                                     \
        if ((p)->d == 3 && all)                                                                    \
            text(3, MIXING_DEPTH, __VA_ARGS__);                                                    \
        else if ((p)->d == 3)                                                                      \
            text(3, MIXING_DEPTH_MANY, __VA_ARGS__);                                               \
        else if (all)                                                                              \
            text(2, MIXING_DEPTH, __VA_ARGS__);                                                    \
        else                                                                                       \
            text(2, MIXING_DEPTH_MANY, __VA_ARGS__);                                               \
    } while (0)

/* m is passed by value, so that the compiler knows that no store changes it. */
ALWAYS_INLINE void measure_text(int d, int depth, const struct problem *p, const struct mixing m,
                                int64_t first, int64_t end, struct mixing_sums *t)
{
    double *dg = m.dg[m.next], *df = m.df[m.next];
    for (int k = 0; k < BUNDLE; k += LANES) {
        vd f2 = vload(t->f2 + k), ff[MIXING_DEPTH], fd[MIXING_DEPTH];
        for (int j = 0; j < depth; j++) ff[j] = vload(t->ff[j] + k), fd[j] = vload(t->fd[j] + k);
        for (int64_t i = first; i < end; i++) {
            const struct bundle *c = &p->bundle[i];
            vd lambda = bundle_lambda(c, k);
            for (int l = 0; l < d; l++) {
                int64_t at = (i * d + l) * BUNDLE + k;
                vd g = vload(c->r[l] + k), f = g - vload(df + at), change = f - vload(m.f + at);
                vstore(dg + at, g - vload(dg + at)), vstore(df + at, change);
                vstore(m.f + at, f);
                vd wf = lambda * f, wdf = lambda * change;
                f2 += wf * f;
                for (int j = 0; j < depth; j++)
                    ff[j] += wdf * vload(m.df[j] + at), fd[j] += wf * vload(m.df[j] + at);
            }
        }
        vstore(t->f2 + k, f2);
        for (int j = 0; j < depth; j++) vstore(t->ff[j] + k, ff[j]), vstore(t->fd[j] + k, fd[j]);
    }
}

static void measure(const struct problem *p, const struct mixing *m, int64_t first, int64_t end,
                    struct mixing_sums *t)
{
    BY_SHAPE(p, m, measure_text, p, *m, first, end, t);
}

/* One mixing of all contacts */
struct jump {
    const struct mixing *m;
    double leap;
    const double *gamma;
};

/* Projects onto the disc, not onto the cone: the orthogonal projection on the cone would change r_n
   of contacts that slide. */
ALWAYS_INLINE void react_text(int d, int depth, struct problem *p, const struct mixing m,
                              const struct jump j, int64_t first, int64_t end)
{
    double *g = m.dg[m.next], *from = m.df[m.next];
    for (int64_t i = first; i < end; i++) {
        fetch_ahead(p, i);
        for (int k = 0; k < BUNDLE; k += LANES) {
            struct bundle *c = &p->bundle[i];
            vd x[3] = { splat(0), splat(0), splat(0) }, r[3], dr[3];
            for (int l = 0; l < d; l++) {
                int64_t at = (i * d + l) * BUNDLE + k;
                x[l] = vload(c->r[l] + k) + j.leap * vload(m.f + at);
                for (int n = 0; n < depth; n++) x[l] -= j.gamma[n] * vload(m.dg[n] + at);
            }
            disc_project(vload(c->mu + k), x, r);
            for (int l = 0; l < 3; l++) {
                vd was = vload(c->r[l] + k);
                int64_t at = (i * d + l) * BUNDLE + k;
                dr[l] = r[l] - was, vstore(c->r[l] + k, r[l]);
                if (l < d) vstore(g + at, was), vstore(from + at, r[l]);
            }
            if (p->W)
                blocks_scatter(p, c, k);
            else
                problem_push(p, p->body, c, k, dr);
        }
    }
}

ALWAYS_INLINE void react_group(struct problem *p, int64_t first, int64_t end, void *task)
{
    const struct jump *j = task;
    BY_SHAPE(p, j->m, react_text, p, *j->m, *j, first, end);
}

static void react(struct problem *p, int me, int threads, const struct mixing *m, double leap,
                  const double gamma[MIXING_DEPTH])
{
    struct jump jump = { m, leap, gamma };
    walk(p, me, threads, react_group, &jump);
}

/* ---- the table ---- */

#define MIXING_(lanes)   mixing_##lanes
#define MIXING_OF(lanes) MIXING_(lanes)
extern const struct mixing_loops MIXING_OF(LANES);
const struct mixing_loops MIXING_OF(LANES) = { measure, react };
