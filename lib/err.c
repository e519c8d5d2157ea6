#include "err.h"

enum { BLOCK = 512 }; /* rows summed one after another, whatever the threads */

struct sums {
    double motion, proj, bipotential, penetration;
    double max_pen, max_true;
    double natural2, siconos2, velocity2, r2;
};

static inline double norm3(const double a[3])
{
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

static inline double distance(const double a[3], const double b[3])
{
    double d[3] = { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
    return norm3(d);
}

static inline double larger(double a, double b)
{
    return a < b ? b : a;
}

static void add_terms(struct sums *s, const struct row *c, bool believes, const double motion[3])
{
    const double *u = believes ? c->u : motion, *r = c->r;
    double proj[3], ut = sqrt(u[1] * u[1] + u[2] * u[2]);
    cone_project(c->mu, r, proj);
    s->motion += believes ? distance(u, motion) : 0;
    s->proj += distance(r, proj);
    s->bipotential += fabs(u[0] * r[0] + u[1] * r[1] + u[2] * r[2] + c->mu * r[0] * ut);
    s->penetration += larger(0, -u[0]);
    s->max_pen = larger(s->max_pen, -u[0]);
    s->max_true = larger(s->max_true, -motion[0]);
}

/* |r - P(r - rho u^)|^2, u^ = u + mu |u_t| n */
static double natural2(const struct row *c, double rho, const double u[3])
{
    double ut = sqrt(u[1] * u[1] + u[2] * u[2]), proj[3];
    double tau[3] = { c->r[0] - rho * (u[0] + c->mu * ut), c->r[1] - rho * u[1],
                      c->r[2] - rho * u[2] };
    cone_project(c->mu, tau, proj);
    double d = distance(c->r, proj);
    return d * d;
}

static void add_natural(struct sums *s, const struct row *c, const double u[3])
{
    double lambda = row_lambda(c), rho = lambda > 0 ? 1 / lambda : 1, n2 = natural2(c, rho, u);
    s->natural2 += n2;
    s->velocity2 += n2 / (rho * rho);
    s->siconos2 += natural2(c, 1, u);
    s->r2 += c->r[0] * c->r[0] + c->r[1] * c->r[1] + c->r[2] * c->r[2];
}

static struct sums block(const struct problem *p, int64_t b, bool believes, enum err_part part)
{
    struct sums s = { 0 };
    int64_t end = (b + 1) * BLOCK < p->n ? (b + 1) * BLOCK : p->n;
    for (int64_t i = b * BLOCK; i < end; i++) {
        double u[3];
        err_velocity(p, i, u);
        if (part & ERR_TERMS) add_terms(&s, &p->row[i], believes, u);
        if (part & ERR_NATURAL) add_natural(&s, &p->row[i], u);
    }
    return s;
}

static void sums_add(struct sums *t, const struct sums *s)
{
    t->motion += s->motion, t->proj += s->proj;
    t->bipotential += s->bipotential, t->penetration += s->penetration;
    t->max_pen = larger(t->max_pen, s->max_pen), t->max_true = larger(t->max_true, s->max_true);
    t->natural2 += s->natural2, t->siconos2 += s->siconos2;
    t->velocity2 += s->velocity2, t->r2 += s->r2;
}

static struct terms terms(const struct sums *s, int64_t n, double v, double r)
{
    struct terms t = { .motion = s->motion / v / (double)n,
                       .proj = s->proj / r / (double)n,
                       .bipotential = s->bipotential / (v * r) / (double)n,
                       .penetration = s->penetration / v / (double)n };
    t.eps_glob = t.motion + t.proj + t.bipotential + t.penetration;
    return t;
}

/* a / b, and 0 / 0 = 0: nothing is wrong with nothing; 1 when all of a is wrong */
static double ratio(double a, double b)
{
    return b > 0 ? a / b : a > 0 ? 1 : 0;
}

void err_eval(struct err *e, const struct problem *p, bool believes, enum err_part part,
              int threads)
{
    *e = (struct err){ .contacts = p->n };
    if (!p->n) return;
    int64_t blocks = (p->n + BLOCK - 1) / BLOCK;
    struct sums all = { 0 };
    // the partial sums of a stripe of blocks at a time, added in their order
    enum { STRIPE = 64 };
    for (int64_t first = 0; first < blocks; first += STRIPE) {
        struct sums s[STRIPE];
        int64_t n = blocks - first < STRIPE ? blocks - first : STRIPE;
#pragma omp parallel for num_threads(threads) if (threads > 1 && n > 1)
        for (int64_t b = 0; b < n; b++) s[b] = block(p, first + b, believes, part);
        for (int64_t b = 0; b < n; b++) sums_add(&all, &s[b]);
    }
    if (part & ERR_TERMS) {
        e->paper = terms(&all, p->n, 1, p->dt);
        e->scaled = terms(&all, p->n, p->scale_v, p->scale_r);
        e->max_penetration = all.max_pen;
        e->max_penetration_true = all.max_true;
    }
    if (part & ERR_NATURAL) {
        e->natural = ratio(sqrt(all.natural2), sqrt(all.r2));
        e->natural_siconos = p->norm_q > 0 ? sqrt(all.siconos2) / p->norm_q : sqrt(all.siconos2);
        e->natural_q = ratio(sqrt(all.velocity2), p->norm_q);
    }
}

double err_of(const struct err *e, enum criterion c)
{
    return c == CRITERION_GLOB     ? e->paper.eps_glob
           : c == CRITERION_SCALED ? e->scaled.eps_glob
                                   : e->natural;
}

enum err_part err_part_of(enum criterion c)
{
    return c == CRITERION_NATURAL ? ERR_NATURAL : ERR_TERMS;
}
