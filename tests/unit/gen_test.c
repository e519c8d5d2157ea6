/* Scenes and the packings made from them. */
#include "scene/scene_build.h"
#include "tap.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics.h>
#include <jansson.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[] = "/tmp/gen_test.XXXXXX"; // tables of the tests

static char *slurp(const char *path, size_t *length)
{
    FILE *f = fopen(path, "r");
    if (!f) return NULL;
    char *text = malloc(1 << 20);
    *length = fread(text, 1, 1 << 20, f);
    fclose(f);
    return text;
}

static int build(struct packing *p, const char *text, const char *dir, struct failure *failure)
{
    struct scene s;
    *failure = (struct failure){ 0 };
    if (scene_parse(&s, text, strlen(text), NULL, failure)) return failure->status;
    scene_build(p, &s, dir, failure);
    scene_free(&s);
    return failure->status;
}

static int build_file(struct packing *p, const char *path, struct failure *failure)
{
    size_t length;
    char *text = slurp(path, &length);
    *failure = (struct failure){ 0 };
    if (!text) return failure_set(failure, EX_NOINPUT, "%s: not there", path);
    text[length] = 0;
    build(p, text, "scenes", failure);
    free(text);
    return failure->status;
}

static int build_paper(struct packing *p, int dim, int64_t n, uint64_t seed,
                       struct failure *failure)
{
    struct scene s;
    *failure = (struct failure){ 0 };
    if (scene_paper(&s, dim, n, failure)) return failure->status;
    if (seed) s.seed = seed;
    scene_build(p, &s, NULL, failure);
    scene_free(&s);
    return failure->status;
}

static bool same_bodies(const struct packing *a, const struct packing *b)
{
    size_t n = (size_t)a->n;
    return a->n == b->n && !memcmp(a->x, b->x, n * sizeof *a->x) &&
           !memcmp(a->v, b->v, n * sizeof *a->v) && !memcmp(a->w, b->w, n * sizeof *a->w) &&
           !memcmp(a->radius, b->radius, n * sizeof *a->radius) &&
           !memcmp(a->mass, b->mass, n * sizeof *a->mass) &&
           !memcmp(a->inertia, b->inertia, n * sizeof *a->inertia);
}

static bool same_packing(const struct packing *a, const struct packing *b)
{
    return same_bodies(a, b) && a->dim == b->dim && a->dt == b->dt && a->theta == b->theta &&
           !memcmp(&a->g, &b->g, sizeof a->g) && a->seed == b->seed && a->walls == b->walls &&
           !memcmp(a->wall, b->wall, (size_t)a->walls * sizeof *a->wall) && a->mu[1] == b->mu[1] &&
           !strcmp(a->scene, b->scene);
}

/* m: the least gap between two bodies; and between a body and a wall */
static double least_gap(const struct packing *p)
{
    double least = INFINITY;
    for (int64_t i = 0; i < p->n; i++)
        for (int64_t j = 0; j < i; j++)
            least = fmin(least, v3_norm(v3_sub(p->x[i], p->x[j])) - p->radius[i] - p->radius[j]);
    return least;
}

static double least_wall_gap(const struct packing *p)
{
    double least = INFINITY;
    for (int64_t i = 0; i < p->n; i++)
        for (int32_t w = 0; w < p->walls; w++)
            least = fmin(least, v3_dot(v3_sub(p->x[i], p->wall[w].x), p->wall[w].n) - p->radius[i]);
    return least;
}

/* Kolmogorov's sqrt(n) sup |F_n - F| of radii uniform in [lo, hi]; 1.63 is exceeded once in 100. */
static double distance_to_uniform(const struct packing *p, double lo, double hi)
{
    double *r = malloc((size_t)p->n * sizeof *r), worst = 0, n = (double)p->n;
    memcpy(r, p->radius, (size_t)p->n * sizeof *r);
    gsl_sort(r, 1, (size_t)p->n);
    for (int64_t i = 0; i < p->n; i++) {
        double F = (r[i] - lo) / (hi - lo);
        worst = fmax(worst, fmax(fabs(F - (double)i / n), fabs(F - (double)(i + 1) / n)));
    }
    free(r);
    return sqrt(n) * worst;
}

static void test_family(int dim, int64_t n, double lo, double hi)
{
    struct packing p;
    struct failure failure;
    const char *what = dim == 2 ? "discs" : "balls";
    long long k = n;
    if (!ok(!build_paper(&p, dim, n, 0, &failure), "%lld %s are made %s", k, what, failure.text))
        return;
    double min = INFINITY, max = 0;
    for (int64_t i = 0; i < p.n; i++) min = fmin(min, p.radius[i]), max = fmax(max, p.radius[i]);
    ok(p.n == n && p.walls == 2 * dim - 1, "%lld %s: a floor and its sides, no lid", k, what);
    ok(!(least_gap(&p) <= 0), "%lld %s: none overlap, least gap %.3g m", k, what, least_gap(&p));
    ok(!(least_wall_gap(&p) < 0), "%lld %s: all inside, least gap to a wall %.3g m", k, what,
       least_wall_gap(&p));
    ok(n == 0 || (min >= lo && max <= hi), "%lld %s: radii in [%g, %g] m", k, what, lo, hi);
    if (n >= 100) ok(distance_to_uniform(&p, lo, hi) < 1.63, "%lld %s: radii are uniform", k, what);
    packing_free(&p);
}

static void test_numbers(void)
{
    struct packing p;
    struct failure failure;
    build_paper(&p, 3, 500, 0, &failure);
    double r = 3e-4, density = 2500, top = 0;
    ok(p.dt == 5e-5 && p.theta == 0.5 && p.g.z == -9.81 && p.mu[0] == 0.3 && p.mu[1] == 0.3 &&
           p.en[0] == 0 && p.et[0] == 0 && p.seed == 1,
       "500 balls: dt, theta, g, mu, e and seed are those of the scene");
    r = p.radius[7];
    double mass = density * 4 / 3 * M_PI * r * r * r;
    ok(fabs(p.mass[7] / mass - 1) < 1e-14 && fabs(p.inertia[7] / (0.4 * mass * r * r) - 1) < 1e-14,
       "500 balls: mass and inertia of solid balls of density 2500");
    ok(p.wall[0].x.x == -0.00315 && p.wall[0].n.x == 1 && p.wall[1].x.x == 0.00315 &&
           p.wall[1].n.x == -1 && p.wall[4].x.z == 0 && p.wall[4].n.z == 1 &&
           p.wall[0].material == 1,
       "500 balls: the box of 6.3 mm, normals inwards");
    for (int64_t i = 0; i < p.n; i++) top = fmax(top, p.x[i].z);
    ok(top > 13.9e-3 && top < 14.5e-3, "500 balls: fourteen layers of 36, as on other codes");
    packing_free(&p);
}

static void test_seed(void)
{
    struct packing a, b, c;
    struct failure failure;
    build_paper(&a, 3, 500, 0, &failure), build_paper(&b, 3, 500, 1, &failure);
    build_paper(&c, 3, 500, 2, &failure);
    ok(same_packing(&a, &b), "same seed, same packing");
    ok(!same_bodies(&a, &c), "another seed, another packing");
    packing_free(&a), packing_free(&b), packing_free(&c);
}

static void test_paper_files(void)
{
    static const struct {
        const char *path;
        int dim;
        int64_t n;
    } row[] = { { "scenes/paper/example2.json", 3, 4 },
                { "scenes/paper/example3.json", 3, 500 },
                { "scenes/paper/example2-2d.json", 2, 4 },
                { "scenes/paper/example3-2d.json", 2, 500 } };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        struct packing a, b;
        struct failure failure;
        build_paper(&a, row[i].dim, row[i].n, 0, &failure);
        bool made = !build_file(&b, row[i].path, &failure);
        ok(made && same_packing(&a, &b), "%s is the paper's %d", row[i].path, (int)row[i].n);
        packing_free(&a);
        if (made) packing_free(&b);
    }
}

static void test_scene_files(void)
{
    static const char *const path[] = {
        "paper/example1", "paper/example1-2d", "column", "piston", "impact", "slope", "gas"
    };
    for (size_t i = 0; i < sizeof path / sizeof *path; i++) {
        char full[100];
        struct packing p;
        struct failure failure;
        snprintf(full, sizeof full, "scenes/%s.json", path[i]);
        if (!ok(!build_file(&p, full, &failure), "%s is made %s", full, failure.text)) continue;
        ok(!(fmin(least_gap(&p), least_wall_gap(&p)) < -1e-6 * p.radius[0]),
           "%s: no overlap at the start", full);
        packing_free(&p);
    }
}

static void test_example1(void)
{
    struct packing p;
    struct failure failure;
    if (build_file(&p, "scenes/paper/example1.json", &failure)) return;
    ok(p.n == 1 && p.radius[0] == 5e-3 && p.v[0].x == 1.5 && p.mu[1] == 0.7 && p.dt == 1e-4,
       "example 1 has the paper's numbers");
    ok(least_wall_gap(&p) == 0, "example 1 touches the floor, gap 0");
    packing_free(&p);
}

/* ---- sizes ---- */

static void test_bells(void)
{
    struct packing p;
    struct failure failure;
    double min, max;
    const char *box = "\"box\": {\"x\": [0, 0.1], \"y\": [0, 0.1], \"z\": [0, null]}";
    char text[500];
    snprintf(text, sizeof text,
             "{\"dt\": 1e-4, \"bodies\": [{\"count\": 20000, %s, \"radius\": {\"gaussian\":"
             "{\"mean\": 4e-4, \"sd\": 1e-4, \"min\": 3e-4, \"max\": 6e-4}}}]}",
             box);
    if (ok(!build(&p, text, NULL, &failure), "gaussian radii %s", failure.text)) {
        gsl_stats_minmax(&min, &max, p.radius, 1, (size_t)p.n);
        ok(min >= 3e-4 && max <= 6e-4, "gaussian radii keep to their cut-offs");
        double z = gsl_cdf_ugaussian_P(2) - gsl_cdf_ugaussian_P(-1);
        double mean = 4e-4 + 1e-4 * (exp(-0.5) - exp(-2)) / sqrt(2 * M_PI) / z;
        ok(fabs(gsl_stats_mean(p.radius, 1, (size_t)p.n) / mean - 1) < 0.005,
           "gaussian radii have the mean of the truncated law");
        packing_free(&p);
    }
    snprintf(text, sizeof text,
             "{\"dt\": 1, \"bodies\": [{\"count\": 1, %s, \"radius\": {\"lognormal\":"
             "{\"median\": 3e-4, \"sigma\": 0, \"min\": 3e-4, \"max\": 3e-4}}}]}",
             box);
    if (ok(!build(&p, text, NULL, &failure), "a lognormal law without width ends %s",
           failure.text)) {
        ok(p.radius[0] == 3e-4, "and gives its median");
        packing_free(&p);
    }
    snprintf(text, sizeof text,
             "{\"dt\": 1e-4, \"bodies\": [{\"count\": 20001, %s, \"radius\": {\"lognormal\":"
             "{\"median\": 4e-4, \"sigma\": 0.3, \"min\": 2e-4, \"max\": 8e-4}}}]}",
             box);
    if (ok(!build(&p, text, NULL, &failure), "lognormal radii %s", failure.text)) {
        gsl_stats_minmax(&min, &max, p.radius, 1, (size_t)p.n);
        ok(min >= 2e-4 && max <= 8e-4, "lognormal radii keep to their cut-offs");
        gsl_sort(p.radius, 1, (size_t)p.n);
        ok(fabs(p.radius[10000] / 4e-4 - 1) < 0.01, "lognormal radii have their median");
        packing_free(&p);
    }
}

/* The share of the mass below a diameter that a scene asks for: straight lines over log d. */
static double sieve_passing(const double (*point)[2], int n, double d)
{
    for (int i = 1; i < n; i++)
        if (d <= point[i][0])
            return point[i - 1][1] + (point[i][1] - point[i - 1][1]) * log(d / point[i - 1][0]) /
                                         log(point[i][0] / point[i - 1][0]);
    return 1;
}

/* The sample's curve by mass keeps to `point` within Kolmogorov's bound, at which a true sample of
   so many is refused once in a million; n_eff = (sum m)^2 / sum m^2 grains count as much. */
static void check_sieve(const char *name, const char *size, int dim, const double (*point)[2],
                        int n)
{
    struct packing p;
    struct failure failure;
    char text[900];
    snprintf(text, sizeof text,
             "{\"dt\": 1, \"dim\": %d, \"bodies\": [{\"count\": 400000, \"radius\": %s, \"box\":"
             "{\"x\": [0, 10]%s}}]}",
             dim, size, dim == 2 ? ", \"y\": [0, null]" : ", \"y\": [0, 10], \"z\": [0, null]");
    if (!ok(!build(&p, text, NULL, &failure), "%s %s", name, failure.text)) return;
    double sum = 0, square = 0, below = 0, worst = 0;
    gsl_sort(p.radius, 1, (size_t)p.n);
    for (int64_t i = 0; i < p.n; i++) {
        double m = pow(p.radius[i], dim);
        sum += m, square += m * m;
    }
    for (int64_t i = 0; i < p.n; i++) {
        below += pow(p.radius[i], dim);
        worst = fmax(worst, fabs(below / sum - sieve_passing(point, n, 2 * p.radius[i])));
    }
    double bound = sqrt(0.5 * log(2e6) * square) / sum;
    if (!ok(worst < bound && bound < 0.05, "%s: the sample's curve is the one asked for", name))
        diag("off by %g, at most %g", worst, bound);
    ok(2 * p.radius[0] >= point[0][0] && 2 * p.radius[p.n - 1] <= point[n - 1][0],
       "%s: within its ends", name);
    packing_free(&p);
}

static void test_sieves(void)
{
    static const double sand[][2] = { { 1.5e-4, 0 },   { 2.5e-4, 0.12 }, { 4e-4, 0.45 },
                                      { 6.3e-4, 0.8 }, { 1e-3, 0.97 },   { 1.4e-3, 1 } };
    const char *text = "{\"sieve\": [[1.5e-4, 0], [2.5e-4, 0.12], [4e-4, 0.45], [6.3e-4, 0.8],"
                       "[1e-3, 0.97], [1.4e-3, 1]]}";
    check_sieve("a sieve curve", text, 3, sand, 6);
    check_sieve("a sieve curve of discs", text, 2, sand, 6);
    static const double gap[][2] = { { 1e-3, 0 }, { 2e-3, 0.5 }, { 4e-3, 0.5 }, { 5e-3, 1 } };
    check_sieve("a curve with a gap",
                "{\"sieve\": [[1e-3, 0], [2e-3, 0.5], [4e-3, 0.5], [5e-3, 1]]}", 3, gap, 4);
    // as much mass at every radius is a density by number of r^-dim
    double line[401][2];
    for (int i = 0; i <= 400; i++) line[i][0] = 2e-4 * (1 + 0.0225 * i), line[i][1] = i / 400.0;
    line[400][0] = 2e-3;
    const double(*uniform)[2] = (const double(*)[2])line;
    check_sieve("uniform by mass", "{\"uniform_by_mass\": [1e-4, 1e-3]}", 3, uniform, 401);
    check_sieve("a power law", "{\"power\": {\"exponent\": 3, \"min\": 1e-4, \"max\": 1e-3}}", 3,
                uniform, 401);
    static const char *const bad[][2] = {
        { "{\"sieve\": [[1, 0]]}", "needs two points [size, passing] or more" },
        { "{\"sieve\": [[1, 0.1], [2, 1]]}", "must let nothing pass: put [SIZE, 0]" },
        { "{\"sieve\": [[1, 0], [2, 0.9]]}", "must let everything pass: put [SIZE, 1]" },
        { "{\"sieve\": [[2, 0], [1, 1]]}", "sizes and shares must not fall" },
        { "{\"sieve\": [[1, 0], [2, 0.5], [3, 0.4], [4, 1]]}", "sizes and shares must not fall" },
        { "{\"power\": {\"exponent\": 99, \"min\": 1, \"max\": 2}}", "must lie in [-20, 20]" },
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct packing p;
        struct failure failure;
        char scene[400];
        snprintf(scene, sizeof scene,
                 "{\"dt\": 1, \"bodies\": [{\"count\": 1, \"radius\": %s, \"box\":"
                 "{\"x\": [0, 99], \"y\": [0, 99], \"z\": [0, null]}}]}",
                 bad[i][0]);
        if (!ok(build(&p, scene, NULL, &failure) == EX_DATAERR && strstr(failure.text, bad[i][1]),
                "refused: %s", bad[i][1]))
            diag("%s", failure.text);
    }
}

static void test_thermal(void)
{
    struct packing p;
    struct failure failure;
    double sum = 0, square = 0;
    if (!ok(!build(
                &p,
                "{\"dt\": 1e-4, \"bodies\": [{\"count\": 10000, \"radius\": 1e-3, \"thermal\": 0.5,"
                "\"v\": [0, 2, 0], \"box\": {\"x\": [0, 1], \"y\": [0, 1], \"z\": [0, 1]}}]}",
                NULL, &failure),
            "thermal velocities %s", failure.text))
        return;
    for (int64_t i = 0; i < p.n; i++) sum += p.v[i].y, square += p.v[i].x * p.v[i].x;
    ok(fabs(sum / 1e4 - 2) < 0.02 && fabs(sqrt(square / 1e4) / 0.5 - 1) < 0.03,
       "thermal velocities have their mean and deviation");
    packing_free(&p);
}

/* ---- material ---- */

static void test_material(void)
{
    struct packing p;
    struct failure failure;
    if (!ok(!build(
                &p,
                "{\"dt\": 1e-4, \"mu\": 0.3, \"e_n\": 0.2, \"materials\": {\"steel\": {\"density\":"
                "7800}}, \"pairs\": [{\"pair\": [\"steel\", \"wall\"], \"mu\": 0.1}],"
                "\"bodies\": [{\"x\": [0, 0, 0], \"radius\": 1, \"material\": \"steel\"},"
                "{\"x\": [3, 0, 0], \"radius\": 1, \"mass\": 5, \"w\": [1, 2, 3]},"
                "{\"x\": [6, 0, 0], \"radius\": 1, \"fixed\": true, \"v\": [0, 1, 0]}],"
                "\"walls\": [{\"point\": [0, 0, -2], \"normal\": [0, 3, 4],"
                "\"velocity\": [1, 0, 0]}]}",
                NULL, &failure),
            "materials %s", failure.text))
        return;
    int32_t k = p.materials;
    ok(k == 3 && !strcmp(p.material_name[0], "ball") && !strcmp(p.material_name[2], "steel"),
       "kinds: ball, wall, then one's own");
    ok(p.mu[2 * k + 1] == 0.1 && p.mu[1 * k + 2] == 0.1 && p.mu[2 * k] == 0.3,
       "a pair's mu stands in both places and nowhere else");
    ok(p.en[2 * k + 1] == 0.2, "what a pair leaves out is the scene's");
    ok(fabs(p.mass[0] / (7800 * 4 * M_PI / 3) - 1) < 1e-14, "a kind's density");
    ok(p.mass[1] == 5 && p.inertia[1] == 2 && p.w[1].z == 3, "a mass of one's own, and a spin");
    ok(p.mass[2] == 0 && p.inertia[2] == 0 && p.v[2].y == 1, "fixed: no mass, its velocity kept");
    ok(fabs(p.wall[0].n.y - 0.6) < 1e-15 && fabs(p.wall[0].n.z - 0.8) < 1e-15 && p.wall[0].v.x == 1,
       "a wall's normal is made a unit vector");
    packing_free(&p);
}

/* ---- tables ---- */

static void put(const char *name, const char *text)
{
    char path[200];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, "w");
    fputs(text, f);
    fclose(f);
}

static void test_table(void)
{
    struct packing p;
    struct failure failure;
    put("good", "# x y z r\n\n 0 0 0 1 # the first\r\n3\t0 0 1.5\n");
    if (ok(!build(&p, "{\"dt\": 1, \"bodies\": [{\"file\": \"good\", \"v\": [0, 0, 1]}]}", folder,
                  &failure),
           "a table %s", failure.text)) {
        ok(p.n == 2 && p.x[1].x == 3 && p.radius[1] == 1.5 && p.v[1].z == 1,
           "a table's comments, blanks and rows");
        packing_free(&p);
    }
    put("flat", "0 0 1\n5 1 2");
    if (ok(!build(&p, "{\"dt\": 1, \"dim\": 2, \"bodies\": [{\"file\": \"flat\"}]}", folder,
                  &failure),
           "a table in the plane %s", failure.text)) {
        ok(p.n == 2 && p.x[1].y == 1 && p.x[1].z == 0 && p.radius[1] == 2, "x y r in the plane");
        packing_free(&p);
    }
    const char *others =
        "{\"dt\": 5e-5, \"mu\": 0.3, \"bodies\": [{\"file\": \"example3-balls.txt\"}],"
        "\"walls\": [{\"box\": {\"x\": [-3.15e-3, 3.15e-3],"
        "\"y\": [-3.15e-3, 3.15e-3], \"z\": [0, null]}}]}";
    if (access("../shared/problems/example3-balls.txt", R_OK)) {
        diag("../shared/problems is not there: the packing of other codes was not read");
        return;
    }
    if (!ok(!build(&p, others, "../shared/problems", &failure), "other codes' packing %s",
            failure.text))
        return;
    ok(p.n == 500 && least_gap(&p) > 0 && least_wall_gap(&p) > 0, "its 500 balls lie in the box");
    packing_free(&p);
}

static void test_bad_tables(void)
{
    static const struct {
        const char *text, *trouble;
        int status;
    } row[] = { { "0 0 0 1\n0 0 1\n", ":2: needs x y z r", EX_DATAERR },
                { "0 0 0 1 2\n", ":1: needs x y z r", EX_DATAERR },
                { "# one\n0 0 0 1x\n", ":2: needs x y z r", EX_DATAERR },
                { "0 nan 0 1\n", ":1: not finite", EX_DATAERR },
                { "0 0 0 -1\n", ":1: the radius must be positive", EX_DATAERR },
                { "0 0 0 1e-200\n", "body 0: a radius of 1e-200 m gives no mass", EX_DATAERR },
                { "0 0 0 1e200\n", "body 0: mass must be finite and not negative", EX_DATAERR },
                { NULL, ": No such file or directory", EX_NOINPUT } };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char wanted[300];
        struct packing p;
        struct failure failure;
        if (row[i].text) put("bad", row[i].text);
        bool named = row[i].trouble[0] == ':';
        snprintf(wanted, sizeof wanted, "%s%s%s%s", named ? folder : "", named ? "/" : "",
                 !named        ? ""
                 : row[i].text ? "bad"
                               : "none",
                 row[i].trouble);
        build(&p,
              row[i].text ? "{\"dt\": 1, \"bodies\": [{\"file\": \"bad\"}]}"
                          : "{\"dt\": 1, \"bodies\": [{\"file\": \"none\"}]}",
              folder, &failure);
        if (!ok(failure.status == row[i].status && !strcmp(failure.text, wanted), "a bad table: %s",
                row[i].trouble))
            diag("%d %s", failure.status, failure.text);
    }
    struct packing p;
    struct failure failure;
    ok(build(&p, "{\"dt\": 1, \"bodies\": [{\"file\": \".\"}]}", folder, &failure) == EX_NOINPUT,
       "a folder is no table: %s", strrchr(failure.text, ':'));
}

/* ---- bad scenes ---- */

#define BODY(s)  "{\"dt\": 1,\n \"bodies\": [" s "]}"
#define BOX      "\"box\": {\"x\": [0, 1], \"y\": [0, 1], \"z\": [0, null]}"
#define COUNT(s) BODY("{\"count\": 9, " BOX ", \"radius\": " s "}")

static void test_bad_scenes(void)
{
    static const struct {
        const char *text, *trouble;
    } row[] = {
        { "", "1:0: '[' or '{' expected near end of file" },
        { "{\"dt\": 1,\n \"dt\": 2}", "2:5: duplicate object key near '\"dt\"'" },
        { "{\"dt\": 1,\n  oops}", "2:6: string or '}' expected near 'oops'" },
        { "[1]", "1:1: needs an object {...}" },
        { "{}", "dt: is missing, and nothing in the scene moves, so no time step can be chosen: "
                "give a number of seconds" },
        { "{\"dt\": 0}", "1:2: dt: must be positive" },
        { "{\n \"dt\": \"1\"}", "2:2: dt: needs a number of seconds, or \"auto\"" },
        { "{\"dt\": 1, \"mu\": -0.1}", "1:11: mu: must not be negative" },
        { "{\"dt\": 1, \"e_n\": 1.5}", "1:11: e_n: must lie in [0, 1]" },
        { "{\"dt\": 1, \"dim\": 4}", "1:11: dim: must lie in [2, 3]" },
        { "{\"dt\": 1, \"seed\": 0.5}", "1:11: seed: needs an integer" },
        { "{\"dt\": 1, \"title\": 5}", "1:11: title: needs a string" },
        { "{\"dt\": 1, \"allow_overlap\": 1}", "1:11: allow_overlap: needs true or false" },
        { "{\"dt\": 1, \"overlap\": 1}", "1:11: overlap: needs true or false" },
        { "{\"dt\": 1, \"allow_overlap\": true, \"overlap\": true}",
          "1:34: overlap: now called \"allow_overlap\", which is given, too" },
        { "{\"dt\": 1, \"gravity\": [0, 1]}", "1:11: gravity: needs [x, y, z]" },
        { "{\"dt\": 1, \"gravity\": [0, 1, null]}", "1:29: gravity[2]: needs a number" },
        { "{\"dt\": 1, \"dim\": 2, \"gravity\": [0, 1, 2]}",
          "1:21: gravity: needs [x, y], for dim is 2" },
        { "{\"comment\": \"\\\"\xc3\xa9{[\", \"dt\": -1}", "1:22: dt: must be positive" },
        { BODY("{\"x\": [0, 0, 0], \"radius\": 1},\n  {\"x\": [3, 0, 0],\n   \"radius\": -1}"),
          "4:4: bodies[1].radius: must be positive" },
        { BODY("{\"x\": [0, 0, 0]}"), "2:13: bodies[0].radius: is missing" },
        { BODY("{\"x\": [0, 0, 0], \"count\": 3}"),
          "2:13: bodies[0]: needs one of the keys x count file document random import" },
        { BODY("7"), "2:13: bodies[0]: needs an object with one of the keys x count file document "
                     "random import" },
        { BODY("{\"x\": [0, 0, 0], \"raduis\": 1}"),
          "2:30: bodies[0].raduis: unknown key; did you mean \"radius\"? known here: x radius size "
          "shape orientation v w material density mass fixed name" },
        { BODY("{\"x\": [0, 0, 0], \"radius\": 1, \"mass\": 1, \"density\": 1}"),
          "2:43: bodies[0].mass: density is given too" },
        { BODY("{\"x\": [0, 0, 0], \"radius\": 1, \"material\": \"glass\"}"),
          "2:43: bodies[0].material: no material \"glass\"; name it under \"materials\"" },
        { BODY("{\"count\": 3, \"radius\": 1}"), "2:13: bodies[0].box: is missing" },
        { BODY("{\"count\": 3, \"radius\": 1, \"box\": {\"x\": [0, 1], \"z\": [0, 1]}}"),
          "2:39: bodies[0].box: a lattice may be open above only, y is not closed" },
        { BODY("{\"count\": 9, " BOX ", \"radius\": 1}"),
          "2:26: bodies[0].box: x is narrower than a cell, 2.1 m" },
        { BODY("{\"count\": 9, \"radius\": 0.2, \"box\": {\"x\": [0, 1], \"y\": [0, 1], \"z\": [0, "
               "1]}}"),
          "2:14: bodies[0].count: 9 bodies, but the box has cells for 8: they need a height of "
          "1.26 m along z" },
        { BODY("{\"count\": 1e10, " BOX ", \"radius\": 1}"),
          "2:14: bodies[0].count: must lie in [0, 2147483647]" },
        { BODY("{\"count\": 9, \"radius\": 1, \"box\": {\"x\": [1, 0]}}"),
          "2:47: bodies[0].box.x: its end must lie above its beginning" },
        { COUNT("{\"uniform\": [2, 1]}"), "2:88: bodies[0].radius.uniform: max is less than min" },
        { COUNT("{\"uniform\": [0, 1]}"), "2:100: bodies[0].radius.uniform[0]: must be positive" },
        { COUNT("{\"gaussian\": {\"mean\": 1, \"sd\": 0.1, \"min\": 2, \"max\": 3}}"),
          "2:88: bodies[0].radius.gaussian: [min, max] keeps less than a thousandth of it" },
        { COUNT("{\"lognormal\": {\"median\": 1, \"sigma\": 0, \"min\": 2, \"max\": 3}}"),
          "2:88: bodies[0].radius.lognormal: [min, max] keeps less than a thousandth of it" },
        { COUNT("{\"poisson\": 3}"),
          "2:77: bodies[0].radius: needs one of the keys uniform gaussian lognormal "
          "uniform_by_mass power sieve" },
        { "{\"dt\": 1, \"walls\": [{\"point\": [0, 0, 0], \"normal\": [0, 0, 0]}]}",
          "1:42: walls[0].normal: must not be zero" },
        { "{\"dt\": 1, \"pairs\": [{\"pair\": [\"ball\", \"wall\"]}, {\"pair\": [\"wall\", "
          "\"ball\"]}]}",
          "1:50: pairs[1].pair: this pair was given before" },
        { "{\"dt\": 1, \"pairs\": [{\"pair\": [\"ball\", \"wal\"]}]}",
          "1:39: pairs[0].pair[1]: no material \"wal\"; name it under \"materials\"" },
        { "{\"dt\": 1, \"a\\nb\": 1}", NULL }, // one line, whatever the key
        { "{\"dt\": 1e400}", NULL },
        { "{\"dt\": NaN}", NULL },
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        struct packing p;
        struct failure failure;
        bool refused = build(&p, row[i].text, NULL, &failure) == EX_DATAERR;
        bool told = row[i].trouble ? !strcmp(failure.text, row[i].trouble)
                                   : *failure.text && !strchr(failure.text, '\n');
        if (!ok(refused && told, "refused: %s", row[i].trouble ? row[i].trouble : failure.text))
            diag("%d %s", failure.status, failure.text);
        if (!failure.status) packing_free(&p);
    }
}

/* Cut at every length and with every byte changed: good or EX_DATAERR, never a crash. */
static void test_damage(void)
{
    size_t length;
    char *text = slurp("scenes/impact.json", &length);
    int cut = 0, odd = 0;
    if (!text) return;
    for (size_t i = 0; i < 2 * length; i++) {
        struct scene s;
        struct failure failure = { 0 };
        char *damaged = malloc(length); // exactly, so that reading past the end is seen
        memcpy(damaged, text, length);
        if (i >= length) damaged[i - length] ^= (char)(1 << i % 8);
        size_t n = i < length ? i : length;
        char *copy = malloc(n ? n : 1);
        memcpy(copy, damaged, n);
        int status = scene_parse(&s, copy, n, NULL, &failure);
        cut += i < length && status == EX_DATAERR;
        odd += status != 0 && status != EX_DATAERR;
        if (!status) scene_free(&s);
        free(copy), free(damaged);
    }
    ok(cut >= (int)length - 1, "a scene cut at any length is refused");
    ok(odd == 0, "a scene with any byte changed is refused or read");
    free(text);
}

/* ---- every value of a scene in turn ---- */

/* All that a scene may say, of space and of the plane, in few words. What says "build" is built, too. */
static const char *const whole_scene[] = {
    "{\"title\": \"all\", \"dim\": 3, \"dt\": 1e-3, \"theta\": 0.5, \"gravity\": [0, 0, -9.81],"
    "\"seed\": 3, \"density\": 2500, \"mu\": 0.3, \"e_n\": 0.1, \"e_t\": 0, \"time\": 0,"
    "\"allow_overlap\": true, \"materials\": {\"steel\": {\"density\": 7800}},"
    "\"pairs\": [{\"pair\": [\"ball\", \"steel\"], \"mu\": 0.1, \"e_n\": 0.5, \"e_t\": 0.1}],"
    "\"walls\": [{\"point\": [0, 0, -2], \"normal\": [0, 0, 1], \"material\": \"steel\","
    "  \"load\": {\"along\": [0, 0, 1], \"mass\": 2, \"force\": 3, \"speed\": 0.1}},"
    " {\"box\": {\"x\": [-20, 20], \"y\": [-20, 20], \"z\": [-1, null]}, \"until\": 9},"
    " {\"rectangle\": {\"center\": [0, 0, 0], \"normal\": [0, 0, 1], \"along\": [1, 0, 0],"
    "  \"sides\": [1, 2]}, \"velocity\": [0, 0, 1]},"
    " {\"disc\": {\"center\": [0, 0, 0], \"normal\": [0, 0, 1], \"radius\": 2, \"hole\": 1},"
    "  \"drives\": [{\"along\": [0, 0, 1], \"speed\": 1, \"from\": 0.1, \"until\": 0.2},"
    "   {\"about\": [0, 0, 0], \"axis\": [0, 0, 1], \"amplitude\": 0.1, \"frequency\": 2,"
    "    \"phase\": 1}, {\"along\": [1, 0, 0], \"table\": [[0, 1], [1, 2]]}]},"
    " {\"cylinder\": {\"point\": [0, 0, 0], \"axis\": [0, 0, 1], \"radius\": 9, \"length\": 9,"
    "  \"side\": \"inside\", \"along\": [1, 0, 0], \"arc\": 3}, \"load\": {\"about\": [0, 0, 0],"
    "  \"axis\": [0, 0, 1], \"mass\": 2, \"torque\": 1, \"speed\": 0}},"
    " {\"cone\": {\"point\": [0, 0, 0], \"axis\": [0, 0, 1], \"radii\": [8, 9], \"length\": 9,"
    "  \"side\": \"both\", \"along\": [1, 0, 0], \"arc\": 3}},"
    " {\"sphere\": {\"center\": [0, 0, 0], \"radius\": 30, \"side\": \"outside\"}},"
    " {\"mesh\": {\"file\": \"none.stl\", \"scale\": 2, \"at\": [0, 0, 0]}}],"
    "\"bodies\": [{\"x\": [0, 0, 0], \"radius\": 1, \"v\": [0, 0, 0], \"w\": [0, 0, 0],"
    "  \"material\": \"steel\", \"density\": 3, \"fixed\": true},"
    " {\"count\": 3, \"radius\": {\"uniform\": [0.1, 0.2]}, \"box\": {\"x\": [0, 9], \"y\": [0, 9],"
    "  \"z\": [0, null]}, \"cells\": \"own\", \"spacing\": 1.1, \"jitter\": 0.5, \"thermal\": 0.1,"
    "  \"mass\": 3}, {\"file\": \"balls\", \"v\": [0, 0, 0]},"
    " {\"document\": \"none.h5\", \"frame\": 3, \"at_rest\": true},"
    " {\"random\": {\"phi\": 0.1}, \"thermal\": 0.1, \"box\": {\"x\": [0, 9], \"y\": [0, 9],"
    "  \"z\": [0, 9]}, \"radius\": {\"gaussian\": {\"mean\": 1, \"sd\": 0.1, \"min\": 0.9,"
    "  \"max\": 1.1}}}, {\"count\": 1, \"radius\": {\"lognormal\": {\"median\": 1, \"sigma\": 0.1,"
    "  \"min\": 0.9, \"max\": 1.1}}}, {\"count\": 1, \"radius\": {\"uniform_by_mass\": [0.5, 1]}},"
    " {\"random\": {\"count\": 3}, \"box\": {\"x\": [0, 9], \"y\": [0, 9], \"z\": [0, 9]},"
    "  \"radius\": {\"sieve\": [[0.1, 0], [0.2, 0.5], [0.3, 1]]}}],"
    "\"pour\": [{\"rate\": 9, \"radius\": {\"power\": {\"exponent\": 3, \"min\": 0.1, \"max\": "
    "0.2}},"
    "  \"opening\": {\"disc\": {\"center\": [0, 0, 8], \"normal\": [0, 0, 1], \"radius\": 3}},"
    "  \"v\": [0, 0, -0.5], \"w\": [0, 0, 0], \"material\": \"steel\", \"mass\": 2, \"from\": 0.1,"
    "  \"until\": 0.5, \"count\": 9}, {\"mass_rate\": 9, \"radius\": 0.1, \"density\": 3,"
    "  \"opening\": {\"box\": {\"x\": [0, 1], \"y\": [0, 1], \"z\": [0, 1]}}}],"
    "\"remove\": [{\"outside\": {\"x\": [-9, 9]}, \"material\": \"steel\"}, {\"inside\": {\"y\": "
    "[5, "
    "6]}},"
    " {\"below\": {\"point\": [0, 0, -9], \"normal\": [0, 0, 1]}}]}",

    "{\"title\": \"build\", \"dim\": 2, \"dt\": 1e-3, \"gravity\": [0, -9.81], \"allow_overlap\": "
    "true,"
    "\"walls\": [{\"point\": [0, -9], \"normal\": [0, 1], \"load\": {\"along\": [0, 1],"
    "  \"mass\": 1}}, {\"segment\": [[-9, -5], [9, -5]], \"drives\": [{\"about\": [0, 0],"
    "  \"speed\": 0.1}]}, {\"circle\": {\"center\": [0, 0], \"radius\": 40, \"side\": \"inside\"},"
    "  \"load\": {\"about\": [0, 0], \"mass\": 2, \"torque\": 1}},"
    " {\"arc\": {\"center\": [0, 0], \"radius\": 30, \"along\": [1, 0], \"arc\": 1,"
    "  \"side\": \"both\"}}, {\"polygon\": {\"points\": [[20, 0], [21, 0], [21, 1]],"
    "  \"closed\": true}}, {\"box\": {\"x\": [-20, 20], \"y\": [-20, null]}}],"
    "\"bodies\": [{\"x\": [0, 0], \"radius\": 1, \"v\": [0, 1], \"w\": 2, \"mass\": 3},"
    " {\"count\": 4, \"radius\": 0.2, \"box\": {\"x\": [0, 9], \"y\": [0, null]}},"
    " {\"random\": {\"count\": 3}, \"radius\": {\"uniform\": [0.1, 0.2]}, \"box\": {\"x\": [0, 9],"
    "  \"y\": [0, 9]}}],"
    "\"pour\": [{\"rate\": 9, \"radius\": 0.1, \"w\": 1, \"opening\": {\"disc\": {\"center\": [0, "
    "8],"
    "  \"normal\": [0, 1], \"radius\": 3}}, \"count\": 9}], \"remove\": [{\"below\":"
    "  {\"point\": [0, -9], \"normal\": [0, 1]}}]}",

    "{\"title\": \"build\", \"dt\": 1e-3, \"gravity\": [0, 0, 0], \"cell\": {\"edges\": [[9, 0, 0],"
    "  [1, 9, 0], [0, 0, 9]], \"origin\": [1, 2, 3], \"repeats\": [true, true, true],"
    "  \"gradient\": [{\"t\": 0, \"L\": [[0, 0.1, 0], [0, 0, 0], [0, 0, 0]]}, {\"t\": 1,"
    "  \"L\": [[0, 0.2, 0], [0, 0, 0], [0, 0, 0]]}], \"affine\": true, \"stress\": {"
    "  \"target\": [[1, null, null], [null, 2, 0.5], [null, 0.5, null]],"
    "  \"mass\": [[1, null, null], [null, 1, 1], [null, 1, null]]}},"
    "\"bodies\": [{\"count\": 8, \"radius\": 0.5, \"spacing\": 1.2}]}",

    "{\"title\": \"build\", \"dt\": 1e-3, \"gravity\": [0, 0, -1], \"allow_overlap\": true, "
    "\"cell\": {"
    "  \"lengths\": [9, 9, 9], \"repeats\": [true, false, false]}, \"walls\": [{\"point\":"
    "  [0, 0, -1], \"normal\": [0, 0, 1], \"drives\": [{\"along\": [0, 0, 1], \"speed\": 1}]},"
    " {\"cylinder\": {\"point\": [0, 4, 4], \"axis\": [1, 0, 0], \"radius\": 9}, \"drives\":"
    "  [{\"about\": [0, 4, 4], \"axis\": [1, 0, 0], \"speed\": 1}]}],"
    "\"bodies\": [{\"x\": [1, 4, 4], \"radius\": 0.5}]}",

    "{\"title\": \"build\", \"dim\": 2, \"dt\": 1e-3, \"gravity\": [0, 0], \"cell\": {"
    "  \"lengths\": [9, 9], \"repeats\": [true, false], \"gradient\": [[0, 0.1], [0, 0]],"
    "  \"stress\": {\"pressure\": 3, \"mass\": 1}}, \"bodies\": [{\"count\": 4, \"radius\": 0.5}]}",
};

/* What stands in the place of each; the first two are wrong wherever they are. */
static const char *const other_value[] = {
    "{\"no such key\": 1}",
    "\"no such word\"",
    "null",
    "true",
    "false",
    "-1",
    "0",
    "0.5",
    "3",
    "1e30",
    "[]",
    "[1, 2]",
    "[3, 2, 1]",
    "[null, 1]",
    "{}",
    "[[1, 2], [3, 4]]",
};

static struct {
    json_t *root;
    bool builds;
    int tried, taken; /* scenes with one change, and those that are scenes still */
    int odd;          /* ... that have neither an answer nor a reason as it should be */
} turn;

static void odd(const char *path, const char *what, const struct failure *failure)
{
    if (turn.odd++ < 5) diag("%s, now %s: %d %s", path, what, failure->status, failure->text);
}

/* Is the reason "line:column: path: trouble", of this node, or one above or below it? */
static bool says_where(const char *text, const char *path)
{
    int line, column, n = 0;
    if (sscanf(text, "%d:%d: %n", &line, &column, &n) < 2 || !n || strchr(text, '\n')) return false;
    const char *said = text + n, *end = strstr(said, ": ");
    size_t length = end ? (size_t)(end - said) : 0;
    if (length > strlen(path)) length = strlen(path);
    return length && !strncmp(said, path, length);
}

static void try_change(const char *path, const char *what, bool wrong)
{
    struct scene s;
    struct packing p = { 0 };
    struct failure failure = { 0 };
    char *text = json_dumps(turn.root, JSON_INDENT(1));
    if (!text) return;
    turn.tried++;
    int e = scene_parse(&s, text, strlen(text), NULL, &failure);
    free(text);
    if (e) {
        int line, column;
        if (e != EX_DATAERR || failure.status != e ||
            sscanf(failure.text, "%d:%d: ", &line, &column) < 2 ||
            (wrong && !says_where(failure.text, path)))
            odd(path, what, &failure);
        return;
    }
    turn.taken++;
    if (wrong) odd(path, what, &failure);
    if (turn.builds && !scene_build(&p, &s, NULL, &failure)) {
        if (packing_check(&p, &failure)) odd(path, what, &failure); // no reader would take it
        packing_free(&p);
    } else if (turn.builds &&
               (failure.status != EX_DATAERR || !*failure.text || strchr(failure.text, '\n'))) {
        odd(path, what, &failure);
    }
    scene_free(&s);
}

/* Puts a value in the place of another, in an object (key) or an array. */
static void place(json_t *in, const char *key, size_t i, json_t *value)
{
    key ? json_object_set(in, key, value) : json_array_set(in, i, value);
}

static void change_all(json_t *in, const char *path);

static void change_one(json_t *in, const char *key, size_t i, const char *above)
{
    char path[300];
    if (key)
        snprintf(path, sizeof path, "%s%s%s", above, *above ? "." : "", key);
    else
        snprintf(path, sizeof path, "%s[%zu]", above, i);
    json_t *was = json_incref(key ? json_object_get(in, key) : json_array_get(in, i));
    for (size_t k = 0; k < sizeof other_value / sizeof *other_value; k++) {
        json_t *other = json_loads(other_value[k], JSON_DECODE_ANY, NULL);
        place(in, key, i, other);
        try_change(path, other_value[k], k == 0 || (k == 1 && !json_is_string(was)));
        json_decref(other);
    }
    place(in, key, i, was);
    change_all(was, path);
    key ? json_object_del(in, key) : json_array_remove(in, i);
    try_change(path, "gone", false);
    key ? json_object_set(in, key, was) : json_array_insert(in, i, was);
    json_decref(was);
}

static void change_all(json_t *in, const char *path)
{
    const char *key;
    json_t *value;
    char *keys[40];
    size_t n = 0;
    for (size_t i = 0; i < json_array_size(in); i++) change_one(in, NULL, i, path);
    if (!json_is_object(in)) return;
    json_object_foreach(in, key, value) if (n < 40) keys[n++] = strdup(key);
    for (size_t i = 0; i < n; i++) {
        change_one(in, keys[i], 0, path);
        free(keys[i]);
    }
    if (strcmp(path, "kinds") != 0) { // where any key is a name
        json_object_set_new(in, "unheard of", json_true());
        try_change(*path ? path : "unheard of", "with a key more", true);
        json_object_del(in, "unheard of");
    }
}

static void test_every_value(void)
{
    for (size_t k = 0; k < sizeof whole_scene / sizeof *whole_scene; k++) {
        struct scene s;
        struct failure failure = { 0 };
        const char *text = whole_scene[k];
        if (!ok(!scene_parse(&s, text, strlen(text), NULL, &failure), "a scene that says much %s",
                failure.text))
            continue;
        scene_free(&s);
        memset(&turn, 0, sizeof turn);
        turn.root = json_loads(text, 0, NULL);
        turn.builds = strstr(text, "build");
        change_all(turn.root, "");
        json_decref(turn.root);
        ok(!turn.odd && turn.taken > 0 && turn.taken < turn.tried,
           "of %d such scenes with a change, %d are scenes; the others are refused, where they "
           "should be by the place of the change",
           turn.tried, turn.taken);
    }
}

static void test_million(void)
{
    struct packing p;
    struct failure failure;
    if (!ok(!build_paper(&p, 3, 1000000, 0, &failure), "a million balls %s", failure.text)) return;
    ok(p.n == 1000000 && least_wall_gap(&p) >= 0, "a million balls, all inside");
    packing_free(&p);
}

int main(void)
{
    if (!mkdtemp(folder)) return 1;
    for (int dim = 2; dim <= 3; dim++) {
        test_family(dim, 0, 0, 0), test_family(dim, 1, 2.5e-4, 5e-4);
        test_family(dim, 4, 4e-4, 5e-4), test_family(dim, 500, 2.5e-4, 5e-4);
        test_family(dim, 1999, 2.5e-4, 5e-4);
    }
    test_numbers(), test_seed();
    test_paper_files(), test_scene_files(), test_example1();
    test_bells(), test_sieves(), test_thermal(), test_material();
    test_table(), test_bad_tables(), test_bad_scenes(), test_damage();
    test_every_value();
    test_million();
    static const char *const name[] = { "good", "flat", "bad" };
    for (int i = 0; i < 3; i++) {
        char path[200];
        snprintf(path, sizeof path, "%s/%s", folder, name[i]);
        unlink(path);
    }
    rmdir(folder);
    return tap_done();
}
