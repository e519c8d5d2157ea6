/*
 * solve/anderson.c: Gauss-Seidel accelerated by Anderson's mixing [Anderson 1965, Walker and Ni 2011].
 *
 * With G the sweeps, f(x) = G(x) - x, and the last differences of g = G(x) and f in the columns of dG
 * and dF, the next point is
 *
 *     x = g - dG gamma,     gamma = argmin |f - dF gamma|,
 *
 * back to what friction allows. G is two sweeps, the first of them over-relaxed between balls: fewer
 * are needed, and the plain one leaves u and r on the law. The law has corners, and the mixing may
 * lead astray: what has made f larger is taken back, and a mixing that does not pay gives way. What
 * then holds the sweeps up is often a chain of a few contacts whose reactions grow by the same amount
 * in every sweep, thousands of them, until one slips or opens; f is constant and its differences are
 * noise. There one leaps along f, twice as far each time. Last come sweeps alone, twice as many each
 * time, so that in the end this is Gauss-Seidel.
 */
#include "solve/anderson.h"

#include "problem/mixing.h"
#include "solve/nlgs.h"
#include "solve/prices.h"

#include <gsl/gsl_linalg.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum {
    PERIOD = 2,    /* sweeps to a mixing: a mixing costs about as much as one */
    EPOCH = 10,    /* mixings in which |f|^2 must halve */
    RESTS = 5,     /* sweeps before a leap: the change of the last is the leap's direction */
    SHORT = 50,    /* sweeps of leaps, or alone, at first, */
    LONG = 100000, /* and at most */
    BLOCK = 64,    /* bundles whose lanes are summed one after another: they stay in the cache */
    SUM_BUNDLES =
        1024 /* bundles whose sums one thread makes; added in order, whatever the threads */
};
#define GROWTH 4.0   /* |f|^2 may grow by this factor in a turn, or it is taken back; */
#define ASTRAY 2.0   /* in a leap, by this one */
#define RIDGE  1e-14 /* added to the scaled normal equations' diagonal of 1 */
#define LEAP   8.0   /* the first leap, in multiples of f */
#define BEYOND 1.6   /* omega of every other sweep of balls, where none is asked for */

struct anderson {
    struct solve *s;
    struct mixing m;
    struct watch watch;
    struct best since; /* the best iterate since it began anew */
    double *room;
    struct mixing_sums *sums;                /* [parts] */
    double gram[MIXING_DEPTH][MIXING_DEPTH]; /* dF'dF */
    double fd[MIXING_DEPTH];                 /* dF'f */
    int full;                                /* how many differences there are */
    bool begun;      /* f, and g in the room of the next change, are of a time before */
    double omega[2]; /* of the first sweep after a mixing, and of the second */
    int (*phase)(struct anderson *);  /* mix, leap or alone: a turn of it; */
    void (*begin)(struct anderson *); /* what the next turn does first; or NULL */
    int turns, left;                  /* turns that a mixing had; sweeps that are left of another */
    double was;                       /* |f|^2 the turn before, */
    double start, least;              /* at the epoch's start, the least of a mixing, */
    double best;                      /* and after which the rests began anew */
    double far;                       /* the next leap */
    int rest;                         /* sweeps of the next leaps, or alone */
    bool leaps;                       /* leaps are next */
};

static double sum(const double lane[BUNDLE])
{
    double s = 0;
    for (int k = 0; k < BUNDLE; k++) s += lane[k];
    return s;
}

static int depth(const struct anderson *a)
{
    return a->m.depth;
}

static int64_t chunks(const struct problem *p)
{
    return (p->bundles + SUM_BUNDLES - 1) / SUM_BUNDLES;
}

/* So many sweeps; as nlgs_sweep() */
static int sweeps(struct anderson *a, int n)
{
    for (int k = 0; k < n; k++) {
        a->watch.change = 0; // after a mixing the last one's says nothing
        int over = nlgs_sweep(a->s, a->omega[k % 2], &a->watch);
        if (a->watch.just_judged) solve_best_offer(a->s, &a->since);
        if (over) return over;
    }
    return 0;
}

static void forget(struct anderson *a)
{
    a->m.next = a->full = 0, a->begun = false;
}

/* x is the iterate's r. */
static void look(struct anderson *a)
{
    const struct problem *p = a->s->p;
    double *x = a->m.df[a->m.next];
    for (int64_t i = 0; i < p->bundles; i++, x += p->d * BUNDLE)
        memcpy(x, p->bundle[i].r, (size_t)(p->d * BUNDLE) * sizeof *x);
}

/* The sums of one part */
static void measure_chunk(const struct anderson *a, int64_t chunk)
{
    const struct problem *p = a->s->p;
    int64_t end = (chunk + 1) * SUM_BUNDLES < p->bundles ? (chunk + 1) * SUM_BUNDLES : p->bundles;
    struct mixing_sums *t = &a->sums[chunk];
    *t = (struct mixing_sums){ 0 };
    for (int64_t i = chunk * SUM_BUNDLES; i < end; i += BLOCK)
        mixing_widest()->measure(p, &a->m, i, i + BLOCK < end ? i + BLOCK : end, t);
}

/* What the sweeps made of x; |f|^2. */
static double measure(struct anderson *a)
{
    const struct problem *p = a->s->p;
    struct mixing_sums t = { 0 };
    int64_t n = chunks(p);
    a->s->rep->work += price_sweep(p); // with the mixing that follows
    int now = a->m.next;
    if (n == 1 || a->s->o->threads == 1) { // no team: that costs
        for (int64_t k = 0; k < n; k++) measure_chunk(a, k);
    } else {
#pragma omp parallel for num_threads(a->s->o->threads)
        for (int64_t k = 0; k < n; k++) measure_chunk(a, k);
    }
    for (int64_t k = 0; k < n; k++) mixing_sums_add(&t, &a->sums[k]);
    if (a->begun) {
        a->full = a->full < depth(a) ? a->full + 1 : depth(a);
        a->m.next = (now + 1) % depth(a);
        for (int j = 0; j < a->full; j++)
            a->gram[now][j] = a->gram[j][now] = sum(t.ff[j]), a->fd[j] = sum(t.fd[j]);
    }
    a->begun = true;
    return sum(t.f2);
}

/*
 * gamma by the normal equations, each difference scaled to length 1: pivoted, and with a ridge that
 * is far above what rounding makes of a column that is none of its own.
 */
static void weigh(const struct anderson *a, double gamma[MIXING_DEPTH])
{
    double A[MIXING_DEPTH * MIXING_DEPTH], b[MIXING_DEPTH], s[MIXING_DEPTH] = { 0 };
    size_t n = (size_t)a->full, order[MIXING_DEPTH];
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

static void react(struct anderson *a, double leap, const double gamma[MIXING_DEPTH])
{
    struct problem *p = a->s->p;
    int threads = problem_team(p, a->s->o->threads);
    a->s->renewed = false;
    if (threads == 1) {
        mixing_widest()->react(p, 0, 1, &a->m, leap, gamma);
        return;
    }
#pragma omp parallel num_threads(threads)
    mixing_widest()->react(p, omp_get_thread_num(), omp_get_num_threads(), &a->m, leap, gamma);
}

/* ---- what a turn begins with: the rows go to the next point ---- */

/* To none; nothing is remembered. */
static void anew(struct anderson *a)
{
    forget(a), look(a);
}

static void mixed(struct anderson *a)
{
    double gamma[MIXING_DEPTH] = { 0 };
    if (a->full) weigh(a, gamma);
    react(a, 0, gamma);
}

static void leapt(struct anderson *a)
{
    const double gamma[MIXING_DEPTH] = { 0 };
    react(a, a->far, gamma);
}

/* Where the last measure but one found them; nothing is remembered. */
static void taken_back(struct anderson *a)
{
    double gamma[MIXING_DEPTH] = { 0 };
    gamma[(a->m.next + depth(a) - 1) % depth(a)] = 1; // x = g - dg
    forget(a);
    react(a, 0, gamma);
}

/* ---- the phases, a turn of each: sweeps, and what comes next. 0 to go on, as nlgs_sweep() ---- */

static int mix(struct anderson *a), leap(struct anderson *a), alone(struct anderson *a);

static void begin_mixing(struct anderson *a)
{
    a->phase = mix, a->begin = anew, a->turns = 0;
    a->start = a->was = a->least = INFINITY;
}

/* Mixing gives way to leaps and to sweeps alone in turn. */
static void give_way(struct anderson *a)
{
    if (a->least <= a->best / 2) a->rest = SHORT, a->best = a->least;
    a->phase = a->leaps ? leap : alone, a->begin = anew, a->was = INFINITY;
    a->left = a->rest, a->far = LEAP;
    a->leaps = !a->leaps;
    a->rest = a->rest < LONG ? 2 * a->rest : LONG;
}

/* Mixes until that does not pay. */
static int mix(struct anderson *a)
{
    int over = sweeps(a, PERIOD);
    if (over) return over;
    double now = measure(a);
    bool well = now <= GROWTH * a->was, pays = a->turns % EPOCH || now <= a->start / 2;
    if (a->turns++ % EPOCH == 0) a->start = now;
    a->least = fmin(a->least, now);
    a->begin = well ? mixed : taken_back, a->was = well ? now : INFINITY;
    if (!pays) give_way(a);
    return 0;
}

/* Leaps along the change of a sweep, twice as far each time while that goes well. */
static int leap(struct anderson *a)
{
    int over = sweeps(a, RESTS - 1);
    if (over) return over;
    look(a);
    if ((over = sweeps(a, 1))) return over;
    double now = measure(a);
    bool well = now <= ASTRAY * a->was;
    if (!well) a->far = fmax(a->far / 4, 2);
    if (well && a->was < INFINITY) a->far *= 2;
    a->begin = well ? leapt : taken_back, a->was = well ? now : INFINITY;
    if (a->left <= 0) begin_mixing(a);
    a->left -= RESTS;
    return 0;
}

static int alone(struct anderson *a)
{
    int over = sweeps(a, PERIOD);
    a->left -= PERIOD;
    if (a->left <= 0) begin_mixing(a);
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
    a->rest = SHORT, a->leaps = true, a->best = INFINITY;
    best_forget(&a->since);
    begin_mixing(a);
}

struct anderson *anderson_new(struct solve *s)
{
    struct anderson *a = calloc(1, sizeof *a);
    if (!a) return NULL;
    a->s = s;
    a->m.depth = s->p->n > MANY_CONTACTS ? MIXING_DEPTH_MANY : MIXING_DEPTH;
    size_t size = (size_t)(s->p->slots * s->p->d),
           bytes = (size_t)(1 + 2 * depth(a)) * size * sizeof(double);
    for (int k = 0; k < 2; k++)
        a->omega[k] = s->o->relax > 0 ? s->o->relax : k || s->p->full ? 1 : BEYOND;
    a->room = aligned_alloc(64, bytes); // rows come in eights
    a->sums = malloc((size_t)(chunks(s->p) + 1) * sizeof *a->sums);
    if (!a->room || !a->sums || solve_best_init(&a->since, s->p)) {
        anderson_free(a);
        return NULL;
    }
    anderson_restart(a);
    memset(a->room, 0, bytes);
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
    begin_mixing(a);
}

static int run(struct solve *s)
{
    struct anderson *a = anderson_new(s);
    if (!a) return -1;
    int failed = anderson_sweeps(a, s->o->max_sweeps);
    anderson_restore_best(a);
    anderson_free(a);
    return failed;
}

const struct solver solver_anderson = { "anderson", "sweeps accelerated by Anderson's mixing", 0,
                                        run };
