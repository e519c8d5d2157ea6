/* The laws beyond friction and restitution by themselves: forces are the slopes of energies, the
   damage of a bond follows its equation. */
#include "contact/contact_law.h"
#include "solve/rolling.h"
#include "tap.h"

#include <math.h>

/* The largest difference between a bridge's force and the slope of its energy, relative */
static double slope_error(const struct pair_law *l, double R)
{
    double worst = 0, most = bridge_force(l, R, 0), end = bridge_reach(l), h = 1e-6 * end;
    for (int k = 1; k < 1000; k++) {
        double g = end * k / 1000;
        double slope = (bridge_energy(l, R, g + h) - bridge_energy(l, R, g - h)) / (2 * h);
        worst = fmax(worst, fabs(slope - bridge_force(l, R, g)) / most);
    }
    return worst;
}

static void test_bridge(void)
{
    const struct pair_law l = { .volume = 2e-10, .tension = 0.072, .wetting = 0.4 };
    double R = bridge_radius(1e-3, 3e-3), end = bridge_reach(&l);
    ok(fabs(R - 1.5e-3) < 1e-18, "R of two balls is their harmonic mean");
    ok(fabs(bridge_radius(1e9, 3e-3) / bridge_radius(0, 3e-3) - 1) < 1e-6,
       "a boundary is a very large ball");
    ok(slope_error(&l, R) < 1e-6, "a bridge's force is the slope of its energy");
    ok(bridge_energy(&l, R, end) == 0 && bridge_force(&l, R, end) == 0, "it ruptures");
    double touch = 2 * M_PI * R * l.tension * cos(l.wetting);
    ok(fabs(bridge_force(&l, R, 0) / touch - 1) < 1e-14 && bridge_force(&l, R, -1e-6) == touch,
       "where bodies touch it pulls with 2 pi R sigma cos(theta)");
    // Rabinovich, Esayanur & Moudgil 2005, the other way to write it: 1/(1 + g/(2 d))
    double g = 0.3 * end, d = g / 2 * (-1 + sqrt(1 + 2 * l.volume / (M_PI * R * g * g)));
    ok(fabs(bridge_force(&l, R, g) / (touch / (1 + g / (2 * d))) - 1) < 1e-12,
       "apart with the closed form");
}

/* ---- rolling friction ---- */

static double uniform(uint64_t *seed)
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 11) / (double)(1ull << 53);
}

/* A contact as between balls of any size: |k| is less than the mean of w_t and w_r = w_t */
static struct rolling random_contact(uint64_t *seed, bool plane)
{
    struct rolling q = { .wn = 0.1 + uniform(seed) };
    q.wt = q.wn * (2 + 2 * uniform(seed)), q.wr = q.wt, q.wp = q.wt;
    q.k = q.wt * (1.8 * uniform(seed) - 0.9) * (uniform(seed) < 0.8);
    for (int i = 0; i < ROLLING_PARTS; i++) q.mu[i] = uniform(seed) < 0.1 ? 0 : uniform(seed);
    for (int i = 0; i < ROLLING; i++) q.b[i] = 2 * uniform(seed) - 1.4 + 0.4 * (i > 0);
    for (int i = 2; plane && i < ROLLING; i++) q.b[i] = i == 4 ? q.b[i] : 0;
    q.rho = 1 / rolling_lambda(&q);
    return q;
}

static double far(const struct rolling *a, const struct rolling *b)
{
    double sum = 0;
    for (int i = 0; i < ROLLING; i++) sum += (a->x[i] - b->x[i]) * (a->x[i] - b->x[i]);
    return sqrt(sum);
}

static void test_rolling(bool plane)
{
    const struct local_opt opt = { .newton_eps = 1e-13, .newton_max = 100 };
    double law = 0, newton = 0, uzawa = 0;
    int safeguarded = 0, n = 4000;
    uint64_t seed = 7;
    for (int k = 0; k < n; k++) {
        struct rolling q = random_contact(&seed, plane), exact = q;
        double u[ROLLING];
        rolling_solve(METHOD_exact, &exact, &opt);
        rolling_velocity(&q, exact.x, u);
        law = fmax(law, sqrt(rolling_natural2(&q, q.rho, exact.x, u)));
        for (enum method_id m = METHOD_ebp; m <= METHOD_eal; m++) {
            struct rolling one = q;
            rolling_solve(m, &one, &opt);
            newton = fmax(newton, far(&one, &exact)), safeguarded += one.safeguarded;
        }
        for (enum method_id m = METHOD_sbp; m <= METHOD_sal; m++) {
            struct rolling one = q;
            for (int i = 0; i < 3000; i++) rolling_solve(m, &one, &opt);
            uzawa = fmax(uzawa, far(&one, &exact));
        }
    }
    const char *where = plane ? "the plane" : "space";
    ok(law < 1e-13, "%s: exact is on the law of rolling friction (%.2g)", where, law);
    ok(newton < 1e-10, "%s: ebp and eal find the same (%.2g)", where, newton);
    ok(safeguarded < n / 20, "%s: and seldom need the safeguard (%d of %d)", where, safeguarded,
       2 * n);
    ok(uzawa < 1e-6, "%s: so do sbp and sal in the end (%.2g)", where, uzawa);
}

/* ---- the same where W is full ---- */

/* The W of balls as a matrix */
static void fill_up(struct rolling *q)
{
    double *W = q->W;
    q->lambda = rolling_lambda(q), q->full = true;
    W[0] = q->wn, W[21] = q->wp;
    for (int i = 1; i < 3; i++) {
        W[7 * i] = q->wt, W[7 * (3 + i)] = q->wr;
        W[ROLLING * i + 3 + i] = W[ROLLING * (3 + i) + i] = q->k;
    }
}

/* W = J J^T of any J, and little friction, so that there is a solution */
static struct rolling random_full(uint64_t *seed)
{
    struct rolling q = random_contact(seed, false);
    double J[ROLLING][ROLLING], trace = 0;
    q.full = true;
    for (int i = 0; i < ROLLING; i++)
        for (int j = 0; j < ROLLING; j++) J[i][j] = uniform(seed) - 0.5 + (i == j);
    for (int i = 0; i < ROLLING; i++)
        for (int j = 0; j < ROLLING; j++)
            for (int l = 0; l < ROLLING; l++) q.W[ROLLING * i + j] += J[i][l] * J[j][l];
    for (int i = 0; i < ROLLING; i++) trace += q.W[7 * i];
    for (int i = 0; i < ROLLING_PARTS; i++) q.mu[i] *= 0.5;
    q.lambda = trace, q.rho = 1 / trace; // at least the largest eigenvalue
    return q;
}

static double off_the_law(const struct rolling *q, const double x[ROLLING])
{
    double u[ROLLING];
    rolling_velocity(q, x, u);
    return sqrt(rolling_natural2(q, q->rho, x, u));
}

static void test_full(void)
{
    const struct local_opt opt = { .newton_eps = 1e-13, .newton_max = 100 };
    double balls = 0, search = 0, law = 0, newton = 0, uzawa = 0;
    int gave_up = 0, pushing = 0, missed = 0, n = 3000;
    uint64_t seed = 5;
    for (int k = 0; k < n; k++) {
        struct rolling q = random_contact(&seed, k % 2), full = q;
        rolling_solve(METHOD_exact, &q, &opt);
        fill_up(&full);
        struct rolling sought = full;
        rolling_solve(METHOD_exact, &full, &opt);
        balls = fmax(balls, far(&q, &full));
        if (!(sought.b[0] < 0)) continue;
        if (rolling_search(&sought))
            search = fmax(search, far(&q, &sought));
        else
            missed++;
    }
    ok(balls < 1e-10, "a full W: balls' contacts as by numbers (%.2g)", balls);
    ok(search < 1e-9 && missed == 0, "and by the search for r_n (%.2g; %d missed)", search, missed);
    search = 0, missed = 0;
    for (int k = 0; k < n; k++) {
        struct rolling q = random_full(&seed), exact = q, one;
        rolling_solve(METHOD_exact, &exact, &opt);
        gave_up += exact.gave_up, pushing += exact.x[0] > 0;
        if (exact.gave_up) continue;
        law = fmax(law, off_the_law(&q, exact.x));
        one = q;
        if (q.b[0] < 0 && rolling_search(&one))
            search = fmax(search, off_the_law(&q, one.x));
        else
            missed += q.b[0] < 0;
        for (enum method_id m = METHOD_ebp; m <= METHOD_eal; m++) {
            one = q;
            rolling_solve(m, &one, &opt);
            newton = fmax(newton, off_the_law(&q, one.x));
        }
        one = q;
        for (int i = 0; i < 3000; i++) rolling_solve(METHOD_sbp, &one, &opt);
        uzawa = fmax(uzawa, off_the_law(&q, one.x));
    }
    ok(gave_up == 0 && pushing > n / 2, "any W: exact gives none up (%d of %d, %d push)", gave_up,
       n, pushing);
    ok(law < 1e-12, "exact is on the law (%.2g)", law);
    ok(search < 1e-11 && missed == 0, "so is what the search finds (%.2g; %d missed)", search,
       missed);
    ok(newton < 1e-11, "so are ebp and eal (%.2g)", newton);
    ok(uzawa < 1e-5, "and sbp comes near (%.2g)", uzawa);
}

/* The projection on the cone of three limits, beside a search for its r_n */
static void test_projection(void)
{
    uint64_t seed = 3;
    double worst = 0;
    for (int k = 0; k < 2000; k++) {
        struct rolling q = random_contact(&seed, false);
        double p[ROLLING], low = 0, high = 10;
        for (int i = 0; i < ROLLING; i++) q.x[i] = 4 * uniform(&seed) - 2;
        rolling_project(&q, q.x, p);
        const double t[] = { hypot(q.x[1], q.x[2]), fabs(q.x[3]), hypot(q.x[4], q.x[5]) };
        for (int i = 0; i < 100; i++) {
            double r = 0.5 * (low + high), slope = r - q.x[0];
            for (int j = 0; j < ROLLING_PARTS; j++) slope -= q.mu[j] * fmax(0, t[j] - q.mu[j] * r);
            *(slope < 0 ? &low : &high) = r;
        }
        worst = fmax(worst, fabs(p[0] - low));
    }
    ok(worst < 1e-12, "the projection on the cone of all limits is the nearest point (%.2g)",
       worst);
}

int main(void)
{
    test_bridge();
    test_projection();
    test_rolling(false);
    test_rolling(true);
    test_full();
    return tap_done();
}
