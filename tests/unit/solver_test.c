/* The solvers of a whole problem end where Gauss-Seidel ends, and in the same bytes on any machine. */
#include "contact/detect.h"
#include "scene/scene_build.h"
#include "solve/arc.h"
#include "solve/backend.h"
#include "solve/ipm.h"
#include "solve/nlgs.h"
#include "solve/subset.h"
#include "step/step.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>

static const struct solver *const tested[] = { &solver_anderson, &solver_cg };
enum { TESTED = sizeof tested / sizeof *tested };

static void must(int failed, struct failure *failure)
{
    if (!failed) return;
    printf("Bail out! %s\n", failure->text);
    exit(1);
}

static struct step_opt options(const struct solver *global, double eps, int32_t sweeps)
{
    return (struct step_opt){ .order = ORDER_COLOUR,
                              .solve = { .global = global,
                                         .method = &local_exact,
                                         .criterion = CRITERION_NATURAL,
                                         .eps = eps,
                                         .max_sweeps = sweeps,
                                         .relax = 1,
                                         .threads = 1,
                                         .local = { .newton_eps = 1e-13, .newton_max = 100 } } };
}

/* The paper's balls some steps on, with their contacts */
static void fallen(struct packing *p, struct contacts *s, int dim, int64_t n, double mu, double e,
                   int steps)
{
    struct failure failure = { 0 };
    struct scene scene;
    struct report rep = { 0 };
    struct step_opt o = options(&solver_nlgs, 1e-6, 200);
    o.warm = true, o.solve.relax = 1.5;
    must(scene_paper(&scene, dim, n, &failure) || scene_build(p, &scene, NULL, &failure), &failure);
    scene_free(&scene);
    for (int k = 0; k < p->materials * p->materials; k++) p->en[k] = e, p->et[k] = e / 2;
    for (int k = 0; k < p->materials * p->materials && mu >= 0; k++) p->mu[k] = mu;
    for (int k = 0; k < steps; k++) must(step_advance(p, s, NULL, &o, &rep, &failure), &failure);
    must(detect_contacts(s, p, 0, NULL, &failure), &failure);
    report_free(&rep);
}

/* The contacts solved, in a copy of their own */
static struct contacts solve(const struct packing *p, const struct contacts *s,
                             const struct step_opt *o, struct report *rep)
{
    struct failure failure = { 0 };
    struct contacts c;
    must(contacts_copy(&c, s) || step_solve(p, &c, o, rep, &failure), &failure);
    return c;
}

/* The largest difference of velocities, over g dt */
static double apart(const struct packing *p, const struct contacts *a, const struct contacts *b)
{
    double most = 0;
    for (int64_t i = 0; i < a->n; i++)
        for (int k = 0; k < 3; k++) most = fmax(most, fabs(a->found[i].u[k] - b->found[i].u[k]));
    return most / (9.81 * p->dt);
}

static bool same(const struct contacts *a, const struct contacts *b)
{
    bool good = a->n == b->n;
    for (int64_t i = 0; good && i < a->n; i++)
        good = !memcmp(a->found[i].r, b->found[i].r, sizeof a->found[i].r) &&
               !memcmp(a->found[i].u, b->found[i].u, sizeof a->found[i].u);
    return good;
}

static void test_agreement(const struct packing *p, const struct contacts *s, const char *what)
{
    struct report rep = { 0 };
    struct step_opt o = options(&solver_nlgs, 1e-12, 200000);
    struct contacts by_sweeps = solve(p, s, &o, &rep);
    double reached = rep.err.natural; // there are problems of few contacts on which it stalls
    for (int k = 0; k < TESTED; k++) {
        bool cg = tested[k] == &solver_cg;
        o = options(tested[k], cg ? 1e-8 : 1e-10, 200000);
        struct contacts c = solve(p, s, &o, &rep);
        double u = apart(p, &c, &by_sweeps);
        ok((rep.converged || rep.err.natural <= (cg ? 100 : 1.1) * reached) &&
               u < (cg ? 1e-3 : 1e-6),
           "%s, %s: the velocities are those of nlgs", what, tested[k]->name);
        diag("%lld contacts, %d sweeps, natural %.1e, u %.1e g dt apart", (long long)s->n,
             rep.sweeps, rep.err.natural, u);
        contacts_free(&c);
    }
    contacts_free(&by_sweeps), report_free(&rep);
}

static void test_bytes(const struct packing *p, const struct contacts *s, const char *what)
{
    static const int lanes[] = { 2, 4, 8 };
    struct report rep = { 0 };
    for (int k = 0; k < TESTED; k++) {
        struct step_opt o = options(tested[k], 1e-9, 300);
        backend_narrow(2);
        struct contacts first = solve(p, s, &o, &rep);
        bool good = true;
        for (int way = 0; way < 9; way++) {
            backend_narrow(lanes[way % 3]);
            o.solve.threads = 1 << way / 3;
            struct contacts c = solve(p, s, &o, &rep);
            good &= same(&first, &c);
            contacts_free(&c);
        }
        ok(good, "%s, %s: the same bytes for 2, 4 and 8 lanes and 1, 2 and 4 threads", what,
           tested[k]->name);
        contacts_free(&first);
    }
    report_free(&rep);
}

/* What ends early leaves the best that was judged. */
static void test_limits(const struct packing *p, const struct contacts *s, const char *what)
{
    struct report rep = { 0 };
    for (int k = 0; k < TESTED; k++) {
        double best = INFINITY, last = 0;
        for (int32_t sweeps = 1; sweeps <= 512; sweeps *= 2) {
            struct step_opt o = options(tested[k], 0, sweeps);
            o.solve.every_sweep = true;
            struct contacts c = solve(p, s, &o, &rep);
            contacts_free(&c);
            last = rep.err.natural;
            if (!ok(rep.sweeps <= sweeps && last <= fmax(best * (1 + 1e-9), 1e-13),
                    "%s, %s: %d sweeps, and none the worse for it", what, tested[k]->name, sweeps))
                diag("%d sweeps, %.3g after %.3g", rep.sweeps, last, best);
            best = last;
        }
    }
    report_free(&rep);
}

/* The central path by its arc length alone, from r = 0 */
static int follow(struct solve *s)
{
    struct newton w;
    struct central m;
    const char *reason;
    if (newton_init(&w, s, &reason) || solve_keep_best(s)) return -1;
    if (central_init(&m, &w, s, 0.1, true)) {
        arc_follow(&m, 1e-9, 200);
        central_free(&m);
    }
    newton_free(&w);
    return 0;
}

static void test_path(const struct packing *p, const struct contacts *s, const char *what)
{
    static const struct solver path = { "path", "", 0, follow };
    struct report exact = { 0 }, rep = { 0 };
    struct step_opt o = options(&solver_nlgs, 1e-12, 100000);
    struct contacts a = solve(p, s, &o, &exact);
    o = options(&path, 2e-6, 100000); // where what is left is lost in rounding it ends
    struct contacts b = solve(p, s, &o, &rep);
    ok(rep.converged && apart(p, &a, &b) < 1e-3,
       "%s: the central path leads there in %d steps, natural %.1e, velocities to %.1e", what,
       (int)rep.newton, rep.err.natural, apart(p, &a, &b));
    contacts_free(&a), contacts_free(&b), report_free(&exact), report_free(&rep);
}

/* The interior point method after so many sweeps */
static int after(struct solve *s, int32_t sweeps)
{
    struct newton w;
    const char *reason;
    if (nlgs_sweeps(s, sweeps, 1) || newton_init(&w, s, &reason) || solve_keep_best(s)) return -1;
    ipm_solve(&w, s);
    newton_free(&w);
    return 0;
}

static int after_few(struct solve *s)
{
    return after(s, 20);
}

static int after_all(struct solve *s)
{
    return after(s, 100000);
}

/* eps_glob is met far from the solution too, inside the cones, where the method comes from. */
static void test_arrival(const struct packing *p, const struct contacts *s, const char *what)
{
    static const struct solver few_first = { "20 sweeps, ipm", "", 0, after_few };
    struct report rep = { 0 };
    struct step_opt o = options(&few_first, 1e-12, 100000);
    o.solve.criterion = CRITERION_GLOB;
    struct contacts c = solve(p, s, &o, &rep);
    // of 4 balls each may be between two statuses; then it ends at a map of 2e-7
    ok(rep.converged && rep.err.natural < (s->n < 10 ? 3e-7 : 2e-9),
       "%s: what ends by eps_glob is a solution, after %d factorisations, natural %.1e", what,
       (int)rep.newton, rep.err.natural);
    contacts_free(&c), report_free(&rep);
}

/* What sweeps have solved costs it nothing. */
static void test_nothing_left(const struct packing *p, const struct contacts *s, const char *what)
{
    static const struct solver sweeps_first = { "sweeps, ipm", "", 0, after_all };
    struct report rep = { 0 };
    struct step_opt o = options(&sweeps_first, 1e-6, 100000);
    struct contacts c = solve(p, s, &o, &rep);
    ok(rep.converged && rep.newton == 0, "%s: solved already, and not factorised: %d", what,
       (int)rep.newton);
    contacts_free(&c), report_free(&rep);
}

/* How far each contact of x is from its law, and which have moved from where they were before */
static int64_t off_law(const struct scaled *a, const double *x, const double *before, double *v,
                       double *moved, double *largest)
{
    int d = a->W.d;
    int64_t count = 0;
    *moved = *largest = 0;
    scaled_velocity(a, x, v);
    for (int64_t c = 0; c < a->W.n; c++) {
        double r[3], u[3], tau[3], p[3], e = 0;
        scaled_load(d, x + d * c, r), scaled_load(d, v + d * c, u);
        cone_predict(a->W.mu[c], 1, r, u, tau);
        cone_project(a->W.mu[c], tau, p);
        for (int k = 0; k < 3; k++) e = fmax(e, fabs(r[k] - p[k]));
        *largest = fmax(*largest, e);
        if (!memcmp(x + d * c, before + d * c, (size_t)d * sizeof *x)) continue;
        *moved = fmax(*moved, e), count++;
    }
    return count;
}

static struct {
    int64_t all, few, most; /* contacts that were solved: asked for all, for 30, for half */
    int64_t dear;           /* the same for 30 with a budget that no factorisation fits */
    int64_t moved;          /* contacts whose reactions are not the same to the bit, of the 30 */
    double before, law;     /* |x - P|: the largest before; of those that moved, after */
} subset;

/* 40 sweeps, and then a subset */
static int in_subset(struct solve *s)
{
    struct scaled a;
    struct failure failure = { 0 };
    double unused;
    if (nlgs_sweeps(s, 40, 1) || scaled_init(&a, s->p, &failure)) return -1;
    size_t size = (size_t)a.size + 4;
    double *before = calloc(3 * size, sizeof *before), *x = before + size, *v = x + size;
    scaled_get(&a, s->p, before);
    off_law(&a, before, before, v, &unused, &subset.before);
    subset.all = subset_solve(&a, s, s->p->n, true, INFINITY);
    subset.dear = subset_solve(&a, s, 30, true, 1);
    subset.few = subset_solve(&a, s, 30, true, INFINITY);
    scaled_get(&a, s->p, x);
    subset.moved = off_law(&a, x, before, v, &subset.law, &unused);
    subset.most = subset_solve(&a, s, s->p->n / 2, true, INFINITY);
    free(before), scaled_free(&a);
    return 0;
}

/* A subset's contacts are on the law, with the others as they are. */
static void test_subset(const struct packing *p, const struct contacts *s, const char *what)
{
    static const struct solver by_subset = { "subset", "", 0, in_subset };
    struct report rep = { 0 };
    struct step_opt o = options(&by_subset, 0, 100000);
    struct contacts c = solve(p, s, &o, &rep);
    ok(subset.all == 0, "%s: all contacts are no subset", what);
    ok(subset.dear == 0, "%s: a subset that costs more than it may is left", what);
    ok(subset.few >= 30 && subset.few <= s->n / 2 && subset.most == s->n / 2,
       "%s: subsets of 30 contacts or more, %d, and of half", what, (int)subset.few);
    ok(subset.moved > 0 && subset.moved <= subset.few && subset.law < 1e-9 * subset.before,
       "%s: %d have moved, by their law to %.1e after %.1e", what, (int)subset.moved, subset.law,
       subset.before);
    contacts_free(&c), report_free(&rep);
}

int main(void)
{
    static const struct {
        const char *name;
        int dim;
        int64_t n;
        double mu, e;
        int steps;
    } scene[] = { { "no contact", 3, 4, -1, 0, 0 },
                  { "one ball", 3, 1, -1, 0, 400 },
                  { "4 balls that rebound", 3, 4, -1, 0.3, 680 },
                  { "100 balls", 3, 100, -1, 0, 508 },
                  { "100 balls without friction", 3, 100, 0, 0, 500 },
                  { "100 discs", 2, 100, -1, 0, 500 },
                  { "500 balls", 3, 500, -1, 0, 500 } };
    for (size_t k = 0; k < sizeof scene / sizeof *scene; k++) {
        struct packing p;
        struct contacts s = { 0 };
        fallen(&p, &s, scene[k].dim, scene[k].n, scene[k].mu, scene[k].e, scene[k].steps);
        test_agreement(&p, &s, scene[k].name);
        test_bytes(&p, &s, scene[k].name);
        test_limits(&p, &s, scene[k].name);
        if (s.n && scene[k].mu != 0) test_path(&p, &s, scene[k].name);
        if (s.n && scene[k].mu != 0) test_arrival(&p, &s, scene[k].name);
        if (s.n) test_nothing_left(&p, &s, scene[k].name);
        if (s.n > 200) test_subset(&p, &s, scene[k].name);
        contacts_free(&s), packing_free(&p);
    }
    return tap_done();
}
