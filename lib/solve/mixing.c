/* solve/mixing.c: measuring and mixing [solve/mixing.h]. Compiled with LANES = 2, 4 and 8. */
#include "solve/mixing.h"

#include "solve/walk.h"

/*
 * What a slot's vector is made of: r, and in a problem with bonds or moments their z and m, which
 * follow r through the sweeps and must be mixed as it is.
 */
enum { WITH_BESIDE = 3 + BESIDE_R };

ALWAYS_INLINE double *component(const struct problem *p, int64_t i, int l)
{
    if (l < 3) return bundle_at(p, i)->r[l];
    return l < 6 ? p->extra[i].z[l - 3] : p->extra[i].m[l - 6];
}

/* Its weight: of a moment that of the impulse which it is over the length of solve/rolling.h */
ALWAYS_INLINE vd weight(const struct problem *p, int64_t i, int k, int l, vd lambda)
{
    if (l < 6) return lambda;
    vd length = vload(p->extra[i].length + k);
    return pick(lt(splat(0), length), lambda / (length * length), splat(0));
}

/* d and the depth are constants of each call, so that the compiler unrolls the loops over them. */
#define BY_SHAPE(p, m, text, ...)                                                                  \
    do {                                                                                           \
        bool all = (m)->depth == MIXING_DEPTH;                                                     \
        if ((p)->kind.extra && all)                                                                \
            text(WITH_BESIDE, MIXING_DEPTH, __VA_ARGS__);                                          \
        else if ((p)->kind.extra)                                                                  \
            text(WITH_BESIDE, MIXING_DEPTH_MANY, __VA_ARGS__);                                     \
        else if ((p)->d == 3 && all)                                                               \
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
            vd lambda = bundle_lambda(p, i, k);
            for (int l = 0; l < d; l++) {
                int64_t at = (i * d + l) * BUNDLE + k;
                vd g = vload(component(p, i, l) + k), f = g - vload(df + at),
                   change = f - vload(m.f + at);
                vstore(dg + at, g - vload(dg + at)), vstore(df + at, change);
                vstore(m.f + at, f);
                vd w = weight(p, i, k, l, lambda), wf = w * f, wdf = w * change;
                f2 += wf * f;
                for (int j = 0; j < depth; j++)
                    ff[j] += wdf * vload(m.df[j] + at), fd[j] += wf * vload(m.df[j] + at);
            }
        }
        vstore(t->f2 + k, f2);
        for (int j = 0; j < depth; j++) vstore(t->ff[j] + k, ff[j]), vstore(t->fd[j] + k, fd[j]);
    }
}

static void mixing_measure(const struct problem *p, const struct mixing *m, int64_t first,
                           int64_t end, struct mixing_sums *t)
{
    BY_SHAPE(p, m, measure_text, p, *m, first, end, t);
}

/* One mixing of all contacts */
struct mixing_jump {
    const struct mixing *m;
    double leap;
    const double *gamma;
};

/* Stores x as the z and m of lanes k.., moments within their limits; dp, dm: their changes */
ALWAYS_INLINE void react_beside(struct problem *p, int64_t i, int k, const vd x[WITH_BESIDE],
                                vd dp[3], double dm[LANES][3])
{
    struct extra *y = &p->extra[i];
    double m[3][LANES], was[3][LANES];
    for (int l = 0; l < 3; l++) {
        dp[l] = x[3 + l] - vload(y->z[l] + k), vstore(y->z[l] + k, x[3 + l]);
        vstore(was[l], vload(y->m[l] + k)), vstore(m[l], x[6 + l]);
    }
    for (int j = 0; j < LANES; j++) {
        if (!extra_rolls(y, k + j)) continue;
        double rn = bundle_at(p, i)->r[0][k + j], most = y->mu_r[k + j] * rn;
        double t2 = m[1][j] * m[1][j] + m[2][j] * m[2][j], pivot = y->mu_p[k + j] * rn;
        double s = t2 > most * most ? most / sqrt(t2) : 1;
        m[0][j] = m[0][j] > pivot ? pivot : m[0][j] < -pivot ? -pivot : m[0][j];
        m[1][j] *= s, m[2][j] *= s;
        for (int l = 0; l < 3; l++) dm[j][l] = m[l][j] - was[l][j], y->m[l][k + j] = m[l][j];
    }
}

/* Projects onto the disc, not onto the cone: the orthogonal projection on the cone would change r_n
   of contacts that slide. */
ALWAYS_INLINE void react_text(int d, int depth, struct problem *p, const struct mixing m,
                              const struct mixing_jump j, int64_t first, int64_t end)
{
    double *g = m.dg[m.next], *from = m.df[m.next];
    for (int64_t i = first; i < end; i++) {
        fetch_ahead(p, i);
        for (int k = 0; k < BUNDLE; k += LANES) {
            struct bundle *c = bundle_at(p, i);
            vd x[WITH_BESIDE] = { splat(0), splat(0), splat(0) }, r[3], dr[3];
            double dm[LANES][3];
            for (int l = 0; l < d; l++) {
                int64_t at = (i * d + l) * BUNDLE + k;
                x[l] = vload(component(p, i, l) + k) + j.leap * vload(m.f + at);
                for (int n = 0; n < depth; n++) x[l] -= j.gamma[n] * vload(m.dg[n] + at);
            }
            disc_project(vload(c->mu + k), x, r);
            for (int l = 0; l < 3; l++) {
                vd was = vload(c->r[l] + k);
                int64_t at = (i * d + l) * BUNDLE + k;
                dr[l] = r[l] - was, vstore(c->r[l] + k, r[l]);
                if (l < d) vstore(g + at, was), vstore(from + at, r[l]);
            }
            if (d == WITH_BESIDE) {
                vd dp[3];
                for (int l = 3; l < d; l++) {
                    int64_t at = (i * d + l) * BUNDLE + k;
                    vstore(g + at, vload(component(p, i, l) + k));
                }
                react_beside(p, i, k, x, dp, dm);
                for (int l = 0; l < 3; l++) dr[l] += dp[l];
                for (int l = 3; l < d; l++) {
                    int64_t at = (i * d + l) * BUNDLE + k;
                    vstore(from + at, vload(component(p, i, l) + k));
                }
            }
            if (p->kind.given_by_W)
                blocks_scatter(p, c, k);
            else
                problem_push(p, p->body, i, k, dr);
            for (int l = 0; l < LANES && d == WITH_BESIDE; l++) {
                const struct extra_lane at = slot_extra(p, i * BUNDLE + k + l);
                if (extra_rolls(at.x, at.i)) extra_push(&at, dm[l]);
            }
        }
    }
}

ALWAYS_INLINE void react_group(struct problem *p, int64_t first, int64_t end, void *task)
{
    const struct mixing_jump *j = task;
    BY_SHAPE(p, j->m, react_text, p, *j->m, *j, first, end);
}

static void mixing_react(struct problem *p, int me, int threads, const struct mixing *m,
                         double leap, const double gamma[MIXING_DEPTH])
{
    struct mixing_jump jump = { m, leap, gamma };
    walk(p, me, threads, react_group, &jump);
}

/* ---- the table ---- */

#define MIXING_(lanes)   mixing_##lanes
#define MIXING_OF(lanes) MIXING_(lanes)
extern const struct mixing_loops MIXING_OF(LANES);
const struct mixing_loops MIXING_OF(LANES) = { mixing_measure, mixing_react };
