/* solve/device.c: where the iterate is, and what is asked of a device [solve/device.h]. */
#include "solve/device.h"

#include "solve/backend.h"
#include "solve/lay.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The table; NULL ends it */
static const struct device_kind *const device_kinds[] = { &device_opencl, NULL };

static const struct device_kind *device_kind_named(const char *name, size_t n)
{
    for (int k = 0; device_kinds[k]; k++)
        if (strlen(device_kinds[k]->name) == n && !strncmp(device_kinds[k]->name, name, n))
            return device_kinds[k];
    return NULL;
}

/* The kind of device, and its number; NULL and EX_USAGE where the name is none */
static const struct device_kind *parse(const char *name, int *number, struct failure *failure)
{
    size_t n = strcspn(name, ":"), digits = name[n] ? strspn(name + n + 1, "0123456789") : 0;
    const struct device_kind *kind = device_kind_named(name, n);
    if (!kind || (name[n] && (!digits || digits > 3 || name[n + 1 + digits]))) {
        failure_set(failure, EX_USAGE, "--device: '%s' is none of list, opencl, opencl:N", name);
        return NULL;
    }
    *number = name[n] ? atoi(name + n + 1) : 0;
    return kind;
}

int device_named(const char *name, struct failure *failure)
{
    int number;
    return parse(name, &number, failure) ? 0 : failure->status;
}

struct device *device_open(const char *name, struct failure *failure)
{
    int number;
    const struct device_kind *kind = parse(name, &number, failure);
    return kind ? kind->open(number, failure) : NULL;
}

int device_list(FILE *to, struct failure *failure)
{
    for (int k = 0; device_kinds[k]; k++)
        if (device_kinds[k]->list(to, failure)) return failure->status;
    return 0;
}

void device_close(struct device *d)
{
    if (d) d->kind->close(d);
}

const char *device_declines(const struct problem *p)
{
    if (p->exchange) return "several processes share the contacts";
    if (p->kind.rolls) return "contacts have rolling friction";
    if (p->kind.extra) return "contacts have bonds";
    if (p->kind.levers) return "grains are no balls or discs";
    if (p->W && p->W->common) return "loads push contacts";
    return p->slots > INT32_MAX ? "there are too many contacts" : NULL;
}

int device_hold(struct device *d, struct problem *p, enum method_id method, struct failure *failure)
{
    if (d->kind->hold(d, p, method, failure)) return failure->status;
    p->device = d;
    d->problem = p, d->here = true, d->there = false, d->kept = 0;
    return 0;
}

int device_release(struct problem *p, struct failure *failure)
{
    struct device *d = p->device;
    if (!d->here && !d->lost.status) d->kind->download(d, p, false);
    p->device = NULL, d->problem = NULL;
    return d->lost.status ? failure_set(failure, d->lost.status, "%s", d->lost.text) : 0;
}

void device_home(struct problem *p, bool writes)
{
    struct device *d = p->device;
    if (!d) return;
    if (!d->here && !d->lost.status) d->kind->download(d, p, true);
    d->here = true;
    if (writes) d->there = false;
}

/* The device, with the iterate; NULL where it is lost */
static struct device *at_work(const struct problem *p)
{
    struct device *d = p->device;
    if (!d->there && !d->lost.status) d->kind->upload(d, p);
    d->there = true;
    return d->lost.status ? NULL : d;
}

void device_sweep(struct problem *p, const struct sweep_opt *o, struct tally *t)
{
    struct device *d = at_work(p);
    if (!d) return;
    d->here = false, d->kind->sweep(d, p, o, t);
}

void device_judge(const struct problem *p, bool believes, enum err_terms which, int64_t per_block,
                  struct sums *s)
{
    struct device *d = at_work(p);
    if (d) d->kind->judge(d, p, believes, which, per_block, s);
    if (p->device->lost.status) s->motion[0] = s->natural2[0] = s->velocity2[0] = NAN;
}

void device_velocities(const struct problem *p)
{
    struct device *d = at_work(p);
    if (d) d->here = false, d->kind->velocities(d, p);
}

void device_renew(struct problem *p)
{
    struct device *d = at_work(p);
    if (d) d->here = false, d->kind->renew(d, p);
}

int device_place(struct device *d)
{
    return d->kept < DEVICE_KEPT ? d->kept++ : -1;
}

void device_keep(struct problem *p, int place, bool u)
{
    struct device *d = at_work(p);
    if (d) d->kind->keep(d, p, place, u);
}

void device_restore(struct problem *p, int place, bool u)
{
    struct device *d = at_work(p);
    if (d) d->here = false, d->kind->restore(d, p, place, u);
}

int device_mixing(struct problem *p, int depth)
{
    struct device *d = at_work(p);
    return d ? d->kind->mixing(d, p, depth) : 0; // lost: the solve ends at its first judgement
}

void device_remember(struct problem *p, int next)
{
    struct device *d = at_work(p);
    if (d) d->kind->remember(d, p, next);
}

void device_measure(struct problem *p, const struct mixing *m, int64_t per_chunk,
                    struct mixing_sums *sums)
{
    struct device *d = at_work(p);
    if (d) d->kind->measure(d, p, m, per_chunk, sums);
    if (p->device->lost.status) sums->f2[0] = NAN;
}

void device_react(struct problem *p, const struct mixing *m, double leap,
                  const double gamma[MIXING_DEPTH])
{
    struct device *d = at_work(p);
    if (d) d->here = false, d->kind->react(d, p, m, leap, gamma);
}

/* ---- the small problem, and the comparison ---- */

enum {
    CHAIN =
        80, /* contacts: a chain of one more bodies, or of blocks of W; every other one in a group */
    HALF = CHAIN / 2,
    ROUNDS = 4,                                  /* of two sweeps and a mixing */
    NUMBERS = 6 * CHAIN + 8 * (CHAIN + 3) + 4096 /* of a result, at most */
};

/* What has come out, number by number */
struct result {
    int n;
    double x[NUMBERS];
};

static void device_note(struct result *r, const void *x, size_t n)
{
    if (r->n + (int)n > NUMBERS) n = (size_t)(NUMBERS - r->n);
    memcpy(r->x + r->n, x, n * sizeof *r->x);
    r->n += (int)n;
}

/* Numbers in -1 .. 1 of the generator of Park and Miller, the same everywhere */
static double device_number(uint64_t *state)
{
    *state = *state * 48271 % 2147483647;
    return 2 * (double)*state / 2147483647 - 1;
}

/* ---- the problem ---- */

static void fill_contact(struct problem *p, int64_t i, int64_t c, uint64_t *state)
{
    struct bundle *x = slot_bundle(p, i);
    struct rebound *e = slot_rebound(p, i);
    int k = slot_lane(i);
    const struct body *a = &p->body[c], *b = &p->body[c + 1];
    double n[3], len = 0, la = 0.5 + 0.2 * device_number(state),
                 lb = 0.5 + 0.2 * device_number(state);
    for (int j = 0; j < 3; j++) n[j] = device_number(state), len += n[j] * n[j];
    for (int j = 0; j < 3; j++) x->n[j][k] = n[j] / sqrt(len);
    double im = a->im + b->im, it = im + la * la * a->ii + lb * lb * b->ii;
    x->a[k] = body_place(c), x->b[k] = body_place(c + 1);
    x->la[k] = la, x->lb[k] = lb, x->mu[k] = 0.5 + 0.4 * device_number(state);
    for (int j = 0; j < 2; j++) {
        e->s[j][k] = 0.8 + 0.2 * device_number(state);
        e->soft[j][k] = c % 2 ? 0.1 * im : 0; // every other contact has springs
        p->w[i / BUNDLE][j][k] = e->s[j][k] * (j ? it : im) + e->soft[j][k];
        x->iw[j][k] = 1 / p->w[i / BUNDLE][j][k];
    }
    for (int j = 0; j < 3; j++) e->offset[j][k] = 0.1 * device_number(state);
    p->rho[i / BUNDLE][k] = 1 / slot_lambda(p, i);
}

/* Where slot i's contact is in the chain */
static int32_t place_in_chain(int i)
{
    return (int32_t)(2 * (i % HALF) + i / HALF);
}

/* A chain of balls that fly at random; false when memory is short */
static bool make_balls(struct problem *p, int32_t contact[CHAIN], int64_t group[3], uint64_t *state)
{
    for (int i = 0; i < CHAIN; i++) contact[i] = place_in_chain(i);
    struct problem_kind kind = kind_FAR_BALLS;
    kind.soft = true;
    *p = (struct problem){ .kind = kind,
                           .d = 3,
                           .n = CHAIN,
                           .bundles = CHAIN / BUNDLE,
                           .slots = CHAIN,
                           .contact = contact,
                           .groups = 2,
                           .group = group,
                           .bodies = CHAIN + 1,
                           .dt = 1,
                           .unit = 1,
                           .endless = { 1e9, 0 },
                           .rounded = 1e14,
                           .wild = 1e2 };
    p->body = lay_lines(p->bodies, sizeof *p->body);
    p->rebound = lay_lines(p->bundles, sizeof *p->rebound);
    if (!p->body || !p->rebound || !lay_bundles(p)) return false;
    for (int64_t i = 0; i < p->bodies; i++) {
        struct body *b = &p->body[i];
        for (int j = 0; j < 3; j++) b->v[j] = device_number(state), b->w[j] = device_number(state);
        b->im = i ? 1 + 0.5 * device_number(state) : 0, b->ii = i ? 2.5 * b->im : 0;
    }
    for (int i = 0; i < CHAIN; i++) fill_contact(p, i, contact[i], state);
    return true;
}

/* A chain of blocks; full: W_cc is more than its diagonal; false when memory is short */
static bool make_blocks(struct problem *p, struct delassus *W, bool full, double rho,
                        uint64_t *state)
{
    enum { ENTRIES = 9 * (3 * CHAIN - 2) };
    int32_t row[ENTRIES], col[ENTRIES];
    double x[ENTRIES], q[3 * CHAIN], mu[CHAIN];
    struct failure failure = { 0 };
    int n = 0;
    for (int c = 0; c < CHAIN; c++) {
        mu[c] = 0.6 + 0.5 * device_number(state);
        for (int j = 0; j < 3; j++) q[3 * c + j] = device_number(state) - (j == 0 ? 0.5 : 0);
        for (int b = c > 0 ? c - 1 : 0; b <= c + 1 && b < CHAIN; b++)
            for (int j = 0; j < 9; j++) {
                int across = j / 3, along = j % 3;
                row[n] = 3 * c + across, col[n] = 3 * b + along;
                if (b != c)
                    x[n] = 0.1 * device_number(state);
                else if (across == along)
                    x[n] = across ? 3.5 : 1;
                else
                    x[n] = full ? 0.05 * (across + along) : 0;
                n++;
            }
    }
    const struct sparse A = { .count = n, .row = row, .col = col, .x = x };
    if (delassus_init(W, 3, CHAIN, &A, &failure)) return false;
    memcpy(W->q, q, sizeof q), memcpy(W->mu, mu, sizeof mu);
    const struct prepare_opt form = { .rho_factor = rho, .order = ORDER_COLOUR };
    if (!problem_prepare_delassus(p, W, &form, &failure)) return true;
    delassus_free(W);
    return false;
}

/* ---- what both make of it ---- */

static void device_start(struct problem *p, const struct body *body)
{
    for (int64_t i = 0; i < p->slots; i++)
        slot_set(p, i, (const double[3]){ 0 }, (const double[3]){ 0 });
    if (p->body) memcpy(p->body, body, (size_t)p->bodies * sizeof *body);
    if (p->W) memset(p->W->r, 0, (size_t)(p->d * p->W->n) * sizeof *p->W->r);
}

static void device_finish(const struct problem *p, struct result *out)
{
    for (int64_t i = 0; i < p->slots; i++) {
        double r[3], u[3];
        slot_get(p, i, r, u);
        device_note(out, r, 3), device_note(out, u, 3);
    }
    if (p->body) device_note(out, p->body, 8 * (size_t)p->bodies);
}

static struct sweep_opt options(int sweep)
{
    return (struct sweep_opt){ { false, 1e-13, 0, 100 }, sweep % 2 ? 1 : 1.6, sweep % 2 };
}

/* As Anderson's mixing, with gammas of our own */
static const double gamma_of[MIXING_DEPTH] = { 0.2, -0.1, 0.05, 0.3, -0.2 };

static void on_cpu(struct problem *p, enum method_id method, struct mixing m, struct result *out)
{
    const struct backend *b = backend_widest();
    for (int k = 0; k < ROUNDS; k++) {
        struct tally t = { 0 };
        struct mixing_sums mixed = { 0 };
        for (int j = 0; j < 2; j++) {
            const struct sweep_opt o = options(j);
            b->sweep->sweep[method][p->kind.id](p, 0, 1, &o, &t);
        }
        double counts[] = { bundle_max(t.change), bundle_sum(t.newton), bundle_sum(t.safeguarded),
                            bundle_sum(t.gave_up) };
        struct sums s = { 0 };
        b->judge->judge(p, 0, p->bundles, true, ERR_ALL, &s);
        b->mixing->measure(p, &m, 0, p->bundles, &mixed);
        m.next = k % MIXING_DEPTH;
        b->mixing->react(p, 0, 1, &m, 0.5, gamma_of);
        device_note(out, counts, 4), device_note(out, &s, sizeof s / sizeof(double));
        device_note(out, &mixed, sizeof mixed / sizeof(double));
    }
    b->judge->velocities(p, 0, p->bundles);
    device_finish(p, out);
}

static void on_device(struct problem *p, struct mixing m, struct result *out)
{
    device_mixing(p, MIXING_DEPTH);
    for (int k = 0; k < ROUNDS; k++) {
        struct tally t = { 0 };
        struct mixing_sums mixed = { 0 };
        for (int j = 0; j < 2; j++) {
            const struct sweep_opt o = options(j);
            device_sweep(p, &o, &t);
        }
        double counts[] = { bundle_max(t.change), bundle_sum(t.newton), bundle_sum(t.safeguarded),
                            bundle_sum(t.gave_up) };
        struct sums s = { 0 };
        device_judge(p, true, ERR_ALL, p->bundles, &s);
        device_measure(p, &m, p->bundles, &mixed);
        m.next = k % MIXING_DEPTH;
        device_react(p, &m, 0.5, gamma_of);
        device_note(out, counts, 4), device_note(out, &s, sizeof s / sizeof(double));
        device_note(out, &mixed, sizeof mixed / sizeof(double));
    }
    device_velocities(p);
    device_home(p, false);
    device_finish(p, out);
}

/* ---- the comparison ---- */

/* Both, of a problem that is made; -1 when memory is short */
static int device_compare(struct device *d, struct problem *p, enum method_id method, bool *same,
                          struct failure *failure)
{
    size_t vector = (size_t)p->slots * 3, bodies = (size_t)p->bodies * sizeof *p->body;
    double *room = lay_lines((1 + 2 * MIXING_DEPTH) * (int64_t)vector, sizeof *room);
    struct result *out = calloc(2, sizeof *out);
    struct body *body = malloc(bodies + 1);
    struct mixing m = { .depth = MIXING_DEPTH, .f = room };
    int failed = room && out && body ? 0 : -1;
    for (int j = 0; !failed && j < MIXING_DEPTH; j++)
        m.dg[j] = room + (1 + 2 * (size_t)j) * vector,
        m.df[j] = room + (2 + 2 * (size_t)j) * vector;
    if (!failed) {
        if (p->body) memcpy(body, p->body, bodies);
        device_start(p, body), on_cpu(p, method, m, &out[0]);
        device_start(p, body);
        if (!device_hold(d, p, method, failure)) {
            on_device(p, m, &out[1]);
            device_release(p, failure);
            *same = out[0].n == out[1].n &&
                    !memcmp(out[0].x, out[1].x, (size_t)out[0].n * sizeof(double));
        }
    }
    free(room), free(out), free(body);
    return failed;
}

int device_check(struct device *d, const struct problem_kind *kind, enum method_id method,
                 struct failure *failure)
{
    int variant = !kind->given_by_W ? 0 : kind->full ? 1 : 2;
    uint64_t state = 1;
    bool same = false;
    struct problem p;
    struct delassus W = { 0 };
    int32_t contact[CHAIN];
    int64_t group[] = { 0, HALF / BUNDLE, CHAIN / BUNDLE };
    if (d->checked[method] & 1U << variant) return 0;
    bool made = variant ? make_blocks(&p, &W, kind->full, methods[method]->rho, &state)
                        : make_balls(&p, contact, group, &state);
    const struct device_account account = d->account; // not of a solve
    if (!made || device_compare(d, &p, method, &same, failure))
        failure_set(failure, EX_SOFTWARE, "--device: no memory");
    d->account = account;
    if (made || !variant) problem_free(&p);
    if (made && variant) delassus_free(&W);
    if (failure->status) return failure->status;
    d->checked[method] |= 1U << variant;
    if (same) return 0;
    failure_set(
        &d->lost, EX_UNAVAILABLE,
        "--device %s: %s: its driver computes other bits than the CPU (%s, %s): take another "
        "driver, or leave --device out",
        d->kind->name, d->name, methods[method]->name, kind->name);
    return failure_set(failure, d->lost.status, "%s", d->lost.text);
}
