/* solve/err.c: the sums over the contacts, and the errors made of them [solve/err.h]. */
#include "solve/err.h"

#include "base/team.h"
#include "solve/apply.h"
#include "solve/backend.h"
#include "solve/device.h"
#include "solve/exchange.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

enum {
    BLOCK = 64,        /* bundles of one partial sum: the bits do not depend on the threads */
    PARALLEL_FROM = 8, /* blocks that are worth a second thread */
    STRIPE = 16,       /* blocks whose partial sums are held at a time */
    EXCHANGE_TERMS = 9 /* sums of struct sums */
};

#define ROUNDING (16 * DBL_EPSILON) /* of the top speed: smaller errors are rounding */
#define STRAY    0.1 /* err.stray: good steps have 0.025 at most, false ones 2 and more */

/* t += s; a NaN stays in the sums but not in the maxima. */
static void sums_add(struct sums *t, const struct sums *s)
{
    for (int k = 0; k < BUNDLE; k++) {
        t->motion[k] += s->motion[k], t->proj[k] += s->proj[k];
        t->bipotential[k] += s->bipotential[k], t->penetration[k] += s->penetration[k];
        t->natural2[k] += s->natural2[k], t->siconos2[k] += s->siconos2[k];
        t->velocity2[k] += s->velocity2[k], t->r2[k] += s->r2[k];
        t->jammed[k] += s->jammed[k];
        t->max_pen[k] = fmax(t->max_pen[k], s->max_pen[k]);
        t->max_true[k] = fmax(t->max_true[k], s->max_true[k]);
        t->max_velocity2[k] = fmax(t->max_velocity2[k], s->max_velocity2[k]);
    }
}

static struct terms mean_terms(const struct sums *s, int64_t n, double v, double r)
{
    struct terms t = { .motion = bundle_sum(s->motion) / v / (double)n,
                       .proj = bundle_sum(s->proj) / r / (double)n,
                       .bipotential = bundle_sum(s->bipotential) / (v * r) / (double)n,
                       .penetration = bundle_sum(s->penetration) / v / (double)n };
    t.eps_glob = t.motion + t.proj + t.bipotential + t.penetration;
    return t;
}

/* a / b; 0 / 0 = 0, and a / 0 = 1. NaN where a or b is NaN or b is infinite */
static double ratio(double a, double b)
{
    if (b == 0) return a > 0 ? 1 : a;
    return isfinite(b) ? a / b : NAN;
}

/* What is judged, and where the sums of blocks go */
struct judged {
    const struct problem *p;
    bool believes;
    enum err_terms which;
    int64_t first;
    struct sums *s;
};

/* The sums of one block */
static void judge_block(const struct problem *p, bool believes, enum err_terms which, int64_t block,
                        struct sums *s)
{
    int64_t from = block * BLOCK, to = from + BLOCK;
    *s = (struct sums){ 0 };
    backend_widest()->judge->judge(p, from, to < p->bundles ? to : p->bundles, believes, which, s);
}

/* Blocks from .. to-1 of a stripe */
static void judge_some(void *arg, int64_t from, int64_t to)
{
    const struct judged *j = arg;
    for (int64_t b = from; b < to; b++)
        judge_block(j->p, j->believes, j->which, j->first + b, &j->s[b]);
}

/* The sums of one bundle are its lanes' terms. */
static void err_take_terms(const struct sums *s, int k, double term[EXCHANGE_TERMS])
{
    const double t[EXCHANGE_TERMS] = { s->motion[k],      s->proj[k],     s->bipotential[k],
                                       s->penetration[k], s->natural2[k], s->siconos2[k],
                                       s->velocity2[k],   s->r2[k],       s->jammed[k] };
    for (int j = 0; j < EXCHANGE_TERMS; j++) term[j] = t[j];
}

static void sums_negate(struct sums *s)
{
    for (int k = 0; k < BUNDLE; k++) {
        s->motion[k] = -s->motion[k], s->proj[k] = -s->proj[k];
        s->bipotential[k] = -s->bipotential[k], s->penetration[k] = -s->penetration[k];
        s->natural2[k] = -s->natural2[k], s->siconos2[k] = -s->siconos2[k];
        s->velocity2[k] = -s->velocity2[k], s->r2[k] = -s->r2[k];
        s->jammed[k] = -s->jammed[k];
    }
}

/* The sums of one bundle without what its bonds add to them afterwards */
static void judge_unbonded(const struct problem *p, int64_t bundle, bool believes,
                           enum err_terms which, struct sums *s)
{
    struct problem unbonded = *p;
    unbonded.kind = *problem_kinds[p->kind.plain];
    unbonded.kind.soft = p->kind.soft;
    backend_widest()->judge->judge(&unbonded, bundle, bundle + 1, believes, which, s);
}

/* Of a problem that processes share */
static void judge_shared(const struct problem *p, bool believes, enum err_terms which,
                         struct sums *all)
{
    struct exchange *exchange = p->exchange;
    const int parts =
        p->kind.extra && !p->kind.rolls ? 2 : 1; // what the sweep's text adds of a slot at once
    double(*term)[EXCHANGE_TERMS] = malloc((size_t)(p->slots + 1) * (size_t)parts * sizeof *term);
    double out[EXCHANGE_TERMS][BUNDLE], most[3] = { 0 };
    if (!term) {
        exchange->fail(exchange);
        return;
    }
    exchange->judging(exchange, (struct problem *)p, true);
    for (int64_t i = 0; i < p->bundles; i++) {
        struct sums s = { 0 };
        if (exchange_is_copy(exchange, i)) continue;
        if (parts == 2) judge_unbonded(p, i, believes, which, &s);
        for (int k = 0; k < BUNDLE && parts == 2; k++)
            err_take_terms(&s, k, term[(BUNDLE * i + k) * parts]);
        if (parts == 2) sums_negate(&s); // so that what is added to them first leaves 0
        backend_widest()->judge->judge(p, i, i + 1, believes, which, &s);
        for (int k = 0; k < BUNDLE; k++)
            err_take_terms(&s, k, term[(BUNDLE * i + k) * parts + parts - 1]);
        most[0] = fmax(most[0], bundle_max(s.max_pen));
        most[1] = fmax(most[1], bundle_max(s.max_true));
        most[2] = fmax(most[2], bundle_max(s.max_velocity2));
    }
    exchange->judging(exchange, (struct problem *)p, false);
    const struct summands summands = { BLOCK, parts, EXCHANGE_TERMS, term[0] };
    exchange->sum(exchange, p, &summands, out[0]);
    free(term);
    for (int k = 0; k < BUNDLE; k++) {
        all->motion[k] = out[0][k], all->proj[k] = out[1][k];
        all->bipotential[k] = out[2][k], all->penetration[k] = out[3][k];
        all->natural2[k] = out[4][k], all->siconos2[k] = out[5][k];
        all->velocity2[k] = out[6][k], all->r2[k] = out[7][k];
        all->jammed[k] = out[8][k];
    }
    all->max_pen[0] = exchange->most(exchange, most[0]);
    all->max_true[0] = exchange->most(exchange, most[1]);
    all->max_velocity2[0] = exchange->most(exchange, most[2]);
}

static void judge_blocks(const struct problem *p, bool believes, enum err_terms which, int threads,
                         struct sums *all)
{
    int64_t blocks = (p->bundles + BLOCK - 1) / BLOCK;
    // the partial sums of a stripe of blocks, always added in the same order
    for (int64_t first = 0; first < blocks; first += STRIPE) {
        struct sums s[STRIPE];
        int64_t n = blocks - first < STRIPE ? blocks - first : STRIPE;
        struct judged j = { p, believes, which, first, s };
        team_share(n < PARALLEL_FROM && !p->split ? 1 : threads, n, 1, judge_some, &j);
        for (int64_t b = 0; b < n; b++) sums_add(all, &s[b]);
    }
}

/* Where each process adds up its own */
static void judge_and_add(const struct problem *p, bool believes, enum err_terms which, int threads,
                          struct sums *all)
{
    struct exchange *exchange = p->exchange;
    exchange->judging(exchange, (struct problem *)p, true);
    judge_blocks(p, believes, which, threads, all);
    exchange->judging(exchange, (struct problem *)p, false);
    double *const sum[EXCHANGE_TERMS] = { all->motion,      all->proj,     all->bipotential,
                                          all->penetration, all->natural2, all->siconos2,
                                          all->velocity2,   all->r2,       all->jammed };
    double x[EXCHANGE_TERMS];
    for (int j = 0; j < EXCHANGE_TERMS; j++) x[j] = bundle_sum(sum[j]);
    exchange->add(exchange, x, EXCHANGE_TERMS);
    for (int j = 0; j < EXCHANGE_TERMS; j++)
        for (int k = 0; k < BUNDLE; k++) sum[j][k] = k ? 0 : x[j];
    double pen = exchange->most(exchange, bundle_max(all->max_pen));
    double true_pen = exchange->most(exchange, bundle_max(all->max_true));
    double off2 = exchange->most(exchange, bundle_max(all->max_velocity2));
    for (int k = 0; k < BUNDLE; k++)
        all->max_pen[k] = pen, all->max_true[k] = true_pen, all->max_velocity2[k] = off2;
}

void err_eval(struct err *e, const struct problem *p, bool believes, enum err_terms which,
              int threads)
{
    struct sums all = { 0 };
    *e = (struct err){ .contacts = p->n };
    if (!p->n) return;
    if (p->exchange && p->exchange->add)
        judge_and_add(p, believes, which, threads, &all);
    else if (p->device)
        device_judge(p, believes, which, BLOCK, &all);
    else if (p->exchange)
        judge_shared(p, believes, which, &all);
    else
        judge_blocks(p, believes, which, threads, &all);
    if (which & ERR_TERMS) {
        e->paper = mean_terms(&all, p->n, 1, p->dt);
        e->scaled = mean_terms(&all, p->n, p->scale_v, p->scale_r);
        e->max_penetration = bundle_max(all.max_pen);
        e->max_penetration_true = bundle_max(all.max_true);
    }
    if (which & ERR_NATURAL) {
        double siconos = sqrt(bundle_sum(all.siconos2)), off = sqrt(bundle_sum(all.velocity2));
        double contacts = sqrt((double)p->n);
        e->natural = ratio(sqrt(bundle_sum(all.natural2)), sqrt(bundle_sum(all.r2)));
        // where no reactions are needed, r and its map are rounding, and their ratio is meaningless
        if (off <= ROUNDING * contacts * p->speed) e->natural = 0;
        if (p->packing) e->stray = ratio(off, fmax(p->norm_q, contacts * p->fall));
        e->natural_siconos = p->norm_q > 0 ? siconos / p->norm_q : siconos;
        e->natural_q = ratio(off, p->norm_q);
        e->velocity_error = isfinite(off) ? sqrt(bundle_max(all.max_velocity2)) : off;
        // reactions that make bodies that fast have only gone too far
        e->jammed = e->velocity_error > p->wild ? 0 : (int64_t)bundle_sum(all.jammed);
        if (!(e->velocity_error <= ROUNDING * p->speed))
            e->velocity = ratio(e->velocity_error, p->unit);
        if (!p->packing) e->stray = ratio(e->velocity_error, p->unit);
    }
}

double err_of(const struct err *e, enum criterion c)
{
    return c == CRITERION_GLOB       ? e->paper.eps_glob
           : c == CRITERION_SCALED   ? e->scaled.eps_glob
           : c == CRITERION_VELOCITY ? e->velocity
                                     : e->natural;
}

double err_value(const struct err *e, enum criterion c, double eps)
{
    double value = err_of(e, c);
    if (c != CRITERION_NATURAL || !(e->stray > STRAY)) return value;
    return fmax(value, eps * e->stray / STRAY);
}

enum err_terms err_terms_of(enum criterion c)
{
    return c == CRITERION_NATURAL || c == CRITERION_VELOCITY ? ERR_NATURAL : ERR_TERMS;
}

bool err_no_solution(const struct report *r)
{
    return !r->converged && (r->err.jammed || err_of(&r->err, r->criterion) <= r->eps);
}

/* ---- the velocities that reactions make, beside them ---- */

/* y = W r of the slots */
static int err_move(const struct problem *p, double *r, double *y)
{
    struct apply a;
    if (apply_init(&a, p)) return -1;
    for (int64_t i = 0; i < p->slots; i++) {
        double u[3];
        if (p->contact[i] >= 0) slot_get(p, i, r + 3 * i, u);
    }
    problem_apply(p, &a, r, y);
    apply_free(&a);
    return 0;
}

/* What reactions move, beside them */
struct moved {
    double steps, r2;    /* N^2 s^2: the squares of W r / lambda, and of r */
    double work, lambda; /* J: r . W r, and lambda r^2 */
    double most;         /* N s: the largest |r| of a contact */
};

static int err_measure(const struct problem *p, struct moved *m)
{
    size_t size = 3 * (size_t)p->slots + 1;
    double *r = calloc(size, sizeof *r), *y = calloc(size, sizeof *y);
    int e = r && y ? err_move(p, r, y) : -1;
    *m = (struct moved){ 0 };
    for (int64_t i = 0; !e && i < p->slots; i++) {
        if (p->contact[i] < 0) continue;
        double lambda = slot_lambda(p, i), r2 = 0;
        for (int k = 0; k < 3; k++) {
            double of = r[3 * i + k], to = y[3 * i + k], step = to / lambda;
            m->steps += step * step, m->work += of * to, r2 += of * of;
        }
        m->r2 += r2, m->lambda += lambda * r2, m->most = fmax(m->most, sqrt(r2));
    }
    free(r), free(y);
    return e;
}

int self_stress(const struct problem *p, double *ratio)
{
    struct moved m;
    int e = err_measure(p, &m);
    *ratio = m.r2 > 0 ? sqrt(m.steps / m.r2) : 0;
    return e;
}

int self_stress_work(const struct problem *p, double *work, double *most)
{
    struct moved m;
    int e = err_measure(p, &m);
    *work = m.lambda > 0 ? m.work / m.lambda : 0, *most = m.most;
    return e;
}
