/*
 * solve/anderson.c: Gauss-Seidel accelerated by Anderson's mixing [Anderson 1965, Walker and Ni
 * 2011].
 *
 * With G the sweeps, f(x) = G(x) - x, and the last differences of g = G(x) and f in the columns of
 * dG and dF, the next point is
 *
 *     x = g - dG gamma,     gamma = argmin |f - dF gamma|,
 *
 * projected onto the discs of friction. G is two sweeps. Between balls the first is over-relaxed,
 * which saves sweeps, and the plain second one leaves u and r on the law. The law has corners, so
 * mixing may fail: a step that makes f much larger is taken back, and mixing that gains too little
 * is given up for a while. What holds up the sweeps then is often a chain of a few contacts whose
 * reactions grow by the same amount in every sweep, for thousands of sweeps, until one slips or
 * opens: f is constant and its differences are noise. So the next phase is leaps along f, each
 * twice as long as the last. When mixing fails again, plain sweeps follow; while |f| does not
 * halve, each such phase is twice as long as the one before, so that in the end this is
 * Gauss-Seidel.
 */
#include "solve/anderson.h"

#include "base/team.h"
#include "solve/backend.h"
#include "solve/device.h"
#include "solve/exchange.h"
#include "solve/nlgs.h"
#include "solve/solver.h"

#include <gsl/gsl_linalg.h>
#include <stdlib.h>
#include <string.h>

enum {
    PERIOD = 2,          /* sweeps before a mixing, which costs about as much as one */
    EPOCH = 10,          /* mixings within which |f|^2 must halve */
    LEAP_SWEEPS = 5,     /* sweeps before a leap: the change of the last is the leap's direction */
    RUN_FIRST = 50,      /* sweeps of a phase of leaps or of plain sweeps, at first */
    RUN_MAX = 100000,    /* sweeps from which on such a phase is made no longer */
    CACHED_BUNDLES = 64, /* bundles summed lane after lane: few enough to stay in the cache */
    CHUNK_BUNDLES = 1024 /* bundles of one partial sum: the bits do not depend on the threads */
};
#define MIX_GROWTH  4.0   /* |f|^2 may grow by this factor in a mixing, else it is taken back */
#define LEAP_GROWTH 2.0   /* the same in a leap */
#define RIDGE       1e-14 /* added to the scaled normal equations' diagonal of 1 */
#define LEAP_FIRST  8.0   /* the first leap, in multiples of f */
#define LEAP_MOST   1e15  /* and the longest: where f is 0, so is what is added */
#define OMEGA_BALLS 1.6   /* omega of every other sweep of balls by default; 1.7 is slower */

struct anderson {
    struct solve *s;
    struct mixing m;
    struct watch watch;
    struct best since; /* the best iterate since anderson_restart() */
    double *room;
    struct mixing_sums *sums;                /* [chunks] */
    double gram[MIXING_DEPTH][MIXING_DEPTH]; /* dF'dF */
    double fd[MIXING_DEPTH];                 /* dF'f */
    int count;                               /* differences stored */
    bool begun;      /* m.f, and g where the next change will be stored, are of the mixing before */
    double omega[2]; /* of the first sweep after a mixing, and of the second */
    int (*phase)(struct anderson *a);  /* one turn of the phase: mix, leap or alone */
    void (*begin)(struct anderson *a); /* how the next turn changes the iterate first; or NULL */
    int turns, left;                   /* turns that mixing had; sweeps left of another phase */
    double before;                     /* |f|^2 in the turn before */
    double epoch_f2, least_f2; /* |f|^2 at the epoch's start; the least since mixing began */
    double run_f2;             /* least_f2 when `run` was last set to RUN_FIRST */
    double reach;              /* of the next leap, in multiples of f */
    int run;                   /* sweeps of the next phase of leaps or plain sweeps */
    bool leap_next;            /* that phase has leaps */
};

static int depth(const struct anderson *a)
{
    return a->m.depth;
}

static int64_t chunks(const struct problem *p)
{
    return (p->bundles + CHUNK_BUNDLES - 1) / CHUNK_BUNDLES;
}

/* n sweeps; returns as nlgs_sweep() */
static int sweeps(struct anderson *a, int n)
{
    for (int k = 0; k < n; k++) {
        a->watch.change = 0; // what it was before the mixing says nothing of this sweep
        int over = nlgs_sweep(a->s, a->omega[k % 2], &a->watch);
        if (a->watch.just_judged) solve_best_offer(a->s, &a->since);
        if (over) return over;
    }
    return 0;
}

static void forget_differences(struct anderson *a)
{
    a->m.next = a->count = 0, a->begun = false;
}

/* The sweeps to come start at x, the iterate's r. */
static void remember_start(struct anderson *a)
{
    const struct problem *p = a->s->p;
    double *x = a->m.df[a->m.next];
    if (p->device) {
        device_remember(a->s->p, a->m.next);
        return;
    }
    for (int64_t i = 0; i < p->bundles; i++, x += mixing_width(p) * BUNDLE) {
        memcpy(x, bundle_at(p, i)->r, (size_t)(p->kind.extra ? 3 : p->d) * BUNDLE * sizeof *x);
        if (!p->kind.extra) continue;
        memcpy(x + 3 * BUNDLE, p->extra[i].z, sizeof p->extra[i].z);
        memcpy(x + 6 * BUNDLE, p->extra[i].m, sizeof p->extra[i].m);
    }
}

/* The sums of one chunk */
static void measure_chunk(const struct anderson *a, int64_t chunk)
{
    const struct problem *p = a->s->p;
    int64_t end =
        (chunk + 1) * CHUNK_BUNDLES < p->bundles ? (chunk + 1) * CHUNK_BUNDLES : p->bundles;
    struct mixing_sums *t = &a->sums[chunk];
    *t = (struct mixing_sums){ 0 };
    for (int64_t i = chunk * CHUNK_BUNDLES; i < end; i += CACHED_BUNDLES)
        backend_widest()->mixing->measure(p, &a->m, i,
                                          i + CACHED_BUNDLES < end ? i + CACHED_BUNDLES : end, t);
}

static void measure_chunks(void *arg, int64_t first, int64_t end)
{
    for (int64_t k = first; k < end; k++) measure_chunk(arg, k);
}

/* The terms of one slot, component by component, as mixing's measure() has just added them */
static void anderson_take_terms(const struct anderson *a, int64_t slot, double *term)
{
    const struct problem *p = a->s->p;
    const double *df = a->m.df[a->m.next];
    int k = slot_lane(slot);
    int width = mixing_width(p);
    double lambda = slot_lambda(p, slot);
    double length = p->kind.extra ? p->extra[slot / BUNDLE].length[k] : 0;
    for (int l = 0; l < width; l++) {
        int64_t at = (slot / BUNDLE * width + l) * BUNDLE + k;
        double w = l < 6 ? lambda : length > 0 ? lambda / (length * length) : 0; // 6 on: moments
        double wf = w * a->m.f[at], wdf = w * df[at];
        *term++ = wf * a->m.f[at];
        for (int j = 0; j < depth(a); j++)
            *term++ = wdf * a->m.df[j][at], *term++ = wf * a->m.df[j][at];
    }
}

/* The same of a problem that processes share, whose sums are made of all slots' terms */
static void measure_shared(const struct anderson *a, struct mixing_sums *t)
{
    const struct problem *p = a->s->p;
    const int n = 1 + 2 * depth(a), size = mixing_width(p) * n;
    double *term = malloc((size_t)(p->slots + 1) * (size_t)size * sizeof *term);
    double out[1 + 2 * MIXING_DEPTH][BUNDLE];
    struct mixing_sums here = { 0 };
    if (!term) {
        p->exchange->fail(p->exchange);
        return;
    }
    backend_widest()->mixing->measure(p, &a->m, 0, p->bundles, &here);
    for (int64_t i = 0; i < p->slots; i++) anderson_take_terms(a, i, term + size * i);
    const struct summands summands = { CHUNK_BUNDLES, mixing_width(p), n, term };
    p->exchange->sum(p->exchange, p, &summands, out[0]);
    for (int k = 0; k < BUNDLE; k++) {
        t->f2[k] = out[0][k];
        for (int j = 0; j < depth(a); j++)
            t->ff[j][k] = out[1 + 2 * j][k], t->fd[j][k] = out[2 + 2 * j][k];
    }
    free(term);
}

/* Where each process adds up its own */
static void anderson_add_shared(const struct anderson *a, struct mixing_sums *t)
{
    double x[1 + 2 * MIXING_DEPTH] = { bundle_sum(t->f2) };
    for (int j = 0; j < depth(a); j++)
        x[1 + 2 * j] = bundle_sum(t->ff[j]), x[2 + 2 * j] = bundle_sum(t->fd[j]);
    a->s->p->exchange->add(a->s->p->exchange, x, 1 + 2 * depth(a));
    *t = (struct mixing_sums){ .f2 = { x[0] } };
    for (int j = 0; j < depth(a); j++) t->ff[j][0] = x[1 + 2 * j], t->fd[j][0] = x[2 + 2 * j];
}

/* After the sweeps: f, the differences and their products; returns |f|^2. */
static double anderson_measure(struct anderson *a)
{
    const struct problem *p = a->s->p;
    struct mixing_sums t = { 0 };
    int64_t n = chunks(p);
    a->s->rep->work += price_sweep(p); // with the mixing that follows
    int now = a->m.next;
    if (p->device) {
        device_measure(a->s->p, &a->m, CHUNK_BUNDLES, &t);
    } else if (p->exchange && !p->exchange->add) {
        measure_shared(a, &t);
    } else {
        team_share(a->s->o->threads, n, 1, measure_chunks, a);
        for (int64_t k = 0; k < n; k++) mixing_sums_add(&t, &a->sums[k]);
        if (p->exchange) anderson_add_shared(a, &t);
    }
    if (a->begun) {
        a->count = a->count < depth(a) ? a->count + 1 : depth(a);
        a->m.next = (now + 1) % depth(a);
        for (int j = 0; j < a->count; j++)
            a->gram[now][j] = a->gram[j][now] = bundle_sum(t.ff[j]), a->fd[j] = bundle_sum(t.fd[j]);
    }
    a->begun = true;
    return bundle_sum(t.f2);
}

/*
 * gamma from the normal equations, each difference scaled to length 1. They are solved with
 * pivoting, and with a ridge far larger than the rounding that is left of a column which depends on
 * the others.
 */
static void solve_gamma(const struct anderson *a, double gamma[MIXING_DEPTH])
{
    double A[MIXING_DEPTH * MIXING_DEPTH], b[MIXING_DEPTH], s[MIXING_DEPTH] = { 0 };
    size_t n = (size_t)a->count, order[MIXING_DEPTH];
    for (size_t i = 0; i < n; i++) s[i] = a->gram[i][i] > 0 ? 1 / sqrt(a->gram[i][i]) : 0;
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++) A[i * n + j] = a->gram[i][j] * s[i] * s[j];
        A[i * n + i] = 1 + RIDGE, b[i] = a->fd[i] * s[i];
    }
    gsl_matrix_view M = gsl_matrix_view_array(A, n, n);
    gsl_vector_view x = gsl_vector_view_array(b, n);
    gsl_permutation pivots = { n, order };
    gsl_linalg_pcholesky_decomp(&M.matrix, &pivots);
    gsl_linalg_pcholesky_svx(&M.matrix, &pivots, &x.vector);
    for (size_t i = 0; i < n; i++) gamma[i] = b[i] * s[i];
}

/* How the iterate is changed */
struct anderson_jump {
    struct anderson *a;
    double leap;
    const double *gamma;
};

static void jump(void *arg, int me, int threads)
{
    const struct anderson_jump *j = arg;
    backend_widest()->mixing->react(j->a->s->p, me, threads, &j->a->m, j->leap, j->gamma);
}

static void anderson_react(struct anderson *a, double leap, const double gamma[MIXING_DEPTH])
{
    struct anderson_jump j = { a, leap, gamma };
    a->s->renewed = false;
    if (a->s->p->device) {
        device_react(a->s->p, &a->m, leap, gamma);
        return;
    }
    team_do(problem_team(a->s->p, a->s->o->threads), jump, &j);
}

/* ---- how a turn begins: by a step from the iterate to the next point ---- */

/* No step; the differences are forgotten. */
static void begin_plain(struct anderson *a)
{
    forget_differences(a), remember_start(a);
}

static void begin_mixed(struct anderson *a)
{
    double gamma[MIXING_DEPTH] = { 0 };
    if (a->count) solve_gamma(a, gamma);
    anderson_react(a, 0, gamma);
}

static void begin_leap(struct anderson *a)
{
    const double gamma[MIXING_DEPTH] = { 0 };
    anderson_react(a, a->reach, gamma);
}

/* Back to the g of the turn before; the differences are forgotten. */
static void begin_taken_back(struct anderson *a)
{
    double gamma[MIXING_DEPTH] = { 0 };
    gamma[(a->m.next + depth(a) - 1) % depth(a)] = 1; // x = g - dg
    forget_differences(a);
    anderson_react(a, 0, gamma);
}

/* ---- a turn of each phase: sweeps, and what comes next; returns as nlgs_sweep() ---- */

static int anderson_mix(struct anderson *a), leap(struct anderson *a),
    anderson_alone(struct anderson *a);

static void start_mixing(struct anderson *a)
{
    a->phase = anderson_mix, a->begin = begin_plain, a->turns = 0;
    a->epoch_f2 = a->before = a->least_f2 = INFINITY;
}

/* Mixing is followed by leaps and by plain sweeps in turn. */
static void stop_mixing(struct anderson *a)
{
    if (a->least_f2 <= a->run_f2 / 2) a->run = RUN_FIRST, a->run_f2 = a->least_f2;
    a->phase = a->leap_next && !a->s->jammed ? leap : anderson_alone, a->begin = begin_plain,
    a->before = INFINITY;
    a->left = a->run, a->reach = LEAP_FIRST;
    a->leap_next = !a->leap_next;
    a->run = a->run < RUN_MAX ? 2 * a->run : RUN_MAX;
}

static int anderson_mix(struct anderson *a)
{
    int over = sweeps(a, PERIOD);
    if (over) return over;
    double now = anderson_measure(a);
    bool well = now <= MIX_GROWTH * a->before, pays = a->turns % EPOCH || now <= a->epoch_f2 / 2;
    if (a->turns++ % EPOCH == 0) a->epoch_f2 = now;
    a->least_f2 = fmin(a->least_f2, now);
    a->begin = well ? begin_mixed : begin_taken_back, a->before = well ? now : INFINITY;
    if (!pays) stop_mixing(a);
    return 0;
}

/* Leaps along the change of a sweep, twice as far each time while that goes well. */
static int leap(struct anderson *a)
{
    int over = sweeps(a, LEAP_SWEEPS - 1);
    if (over) return over;
    remember_start(a);
    if ((over = sweeps(a, 1))) return over;
    double now = anderson_measure(a);
    bool well = now <= LEAP_GROWTH * a->before;
    if (!well) a->reach = fmax(a->reach / 4, 2);
    if (well && a->before < INFINITY) a->reach = fmin(2 * a->reach, LEAP_MOST);
    a->begin = well ? begin_leap : begin_taken_back, a->before = well ? now : INFINITY;
    if (a->left <= 0 || a->s->jammed) start_mixing(a);
    a->left -= LEAP_SWEEPS;
    return 0;
}

static int anderson_alone(struct anderson *a)
{
    int over = sweeps(a, PERIOD);
    a->left -= PERIOD;
    if (a->left <= 0) start_mixing(a);
    return over;
}

void anderson_free(struct anderson *a)
{
    if (a) best_free(&a->since), free(a->room), free(a->sums);
    free(a);
}

void anderson_restart(struct anderson *a)
{
    a->watch = (struct watch){ .due = INFINITY, .last_judged = a->s->rep->sweeps };
    a->run = RUN_FIRST, a->leap_next = true, a->run_f2 = INFINITY;
    best_forget(&a->since);
    start_mixing(a);
}

struct anderson *anderson_new(struct solve *s)
{
    struct anderson *a = calloc(1, sizeof *a);
    if (!a) return NULL;
    a->s = s;
    a->m.depth = s->p->n > MANY_CONTACTS ? MIXING_DEPTH_MANY : MIXING_DEPTH;
    size_t size = (size_t)(s->p->slots * mixing_width(s->p)),
           bytes = (size_t)(1 + 2 * depth(a)) * size * sizeof(double);
    for (int k = 0; k < 2; k++)
        a->omega[k] = s->o->relax > 0 ? s->o->relax : k || s->p->kind.full ? 1 : OMEGA_BALLS;
    if (s->p->device) bytes = 64;       // the device has the vectors
    a->room = aligned_alloc(64, bytes); // each vector is whole cache lines
    a->sums = malloc((size_t)(chunks(s->p) + 1) * sizeof *a->sums);
    if (!a->room || !a->sums || solve_best_init(&a->since, s->p)) {
        anderson_free(a);
        return NULL;
    }
    anderson_restart(a);
    memset(a->room, 0, bytes);
    if (s->p->device) {
        if (!device_mixing(s->p, depth(a))) return a;
        anderson_free(a);
        return NULL;
    }
    double *next = a->m.f = a->room;
    for (int j = 0; j < depth(a); j++) a->m.dg[j] = next += size, a->m.df[j] = next += size;
    return a;
}

int anderson_sweeps(struct anderson *a, int32_t more)
{
    struct solve *s = a->s;
    int32_t had = s->rep->sweeps;
    int over = 0;
    while (!over && s->rep->sweeps - had < more) {
        void (*begin)(struct anderson *) = a->begin;
        a->begin = NULL;
        if (begin) begin(a);
        over = a->phase(a);
    }
    if (!over && !a->watch.just_judged) solve_judge(s), solve_best_offer(s, &a->since);
    return over < 0 ? -1 : 0;
}

double anderson_best_value(const struct anderson *a)
{
    return a->since.value;
}

void anderson_restore_best(struct anderson *a)
{
    solve_best_restore(a->s, &a->since);
    start_mixing(a);
}

static int anderson_run(struct solve *s)
{
    struct anderson *a = anderson_new(s);
    if (!a) return -1;
    int failed = anderson_sweeps(a, s->o->max_sweeps);
    anderson_restore_best(a);
    anderson_free(a);
    return failed;
}

const struct solver solver_anderson = { "anderson", "sweeps accelerated by Anderson's mixing", 0,
                                        anderson_run };
