/*
 * The same bytes for every width and any number of threads, whatever the method, order and scene; and
 * the same reactions whether a problem is given by bodies, by its W, or by a W whose diagonal blocks
 * are not those of balls.
 */
#include "contact/detect.h"
#include "scene/scene_build.h"
#include "solve/backend.h"
#include "solve/scaled.h"
#include "step/step.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>

static void must(int failed, struct failure *failure)
{
    if (!failed) return;
    printf("Bail out! %s\n", failure->text);
    exit(1);
}

static struct step_opt options(int m, double relax)
{
    return (struct step_opt){ .solve = { .global = &solver_nlgs,
                                         .method = methods[m],
                                         .eps = 0,
                                         .max_sweeps = 8,
                                         .relax = relax,
                                         .threads = 1,
                                         .every_sweep = true,
                                         .local = { .newton_eps = 1e-13, .newton_max = 100 } } };
}

/* The paper's balls some steps on, close enough to touch, with restitution or without */
static void fallen(struct packing *p, struct contacts *s, int dim, int64_t n, double e, int steps)
{
    struct failure failure = { 0 };
    struct scene scene;
    struct report rep = { 0 };
    struct step_opt o = options(4, 1.4);
    o.warm = true, o.order = ORDER_COLOUR;
    must(scene_paper(&scene, dim, n, &failure) || scene_build(p, &scene, NULL, &failure), &failure);
    scene_free(&scene);
    for (int k = 0; k < p->materials * p->materials; k++) p->en[k] = e, p->et[k] = e / 2;
    for (int k = 0; k < steps; k++) must(step_advance(p, s, NULL, &o, &rep, &failure), &failure);
    report_free(&rep);
}

/* What a solve leaves behind: reactions and velocities of every contact, and the report's numbers */
struct print {
    int64_t n;
    double *x;
    struct err err;
    int64_t newton;
};

static struct print solve(const struct packing *p, const struct contacts *s, struct step_opt *o)
{
    struct failure failure = { 0 };
    struct report rep = { 0 };
    struct contacts c;
    must(contacts_copy(&c, s) || step_solve(p, &c, o, &rep, &failure), &failure);
    struct print r = { 6 * s->n, malloc((size_t)(6 * s->n + 1) * sizeof(double)), rep.err,
                       rep.newton };
    for (int64_t i = 0; i < 6 * s->n; i++)
        r.x[i] = i % 6 < 3 ? c.found[i / 6].r[i % 6] : c.found[i / 6].u[i % 6 - 3];
    contacts_free(&c), report_free(&rep);
    return r;
}

static bool same(const struct print *a, const struct print *b)
{
    return a->n == b->n && a->newton == b->newton && !memcmp(&a->err, &b->err, sizeof a->err) &&
           !memcmp(a->x, b->x, (size_t)a->n * sizeof *a->x);
}

/* With 2, 4 and 8 lanes and 1, 2 and 4 threads, against two lanes and one thread */
static bool same_everywhere(const struct packing *p, const struct contacts *s, struct step_opt o)
{
    static const int lanes[] = { 2, 4, 8 };
    bool good = true;
    backend_narrow(2);
    struct print first = solve(p, s, &o);
    for (int k = 0; k < 9; k++) {
        backend_narrow(lanes[k % 3]);
        o.solve.threads = 1 << k / 3;
        struct print r = solve(p, s, &o);
        good &= same(&first, &r);
        free(r.x);
    }
    free(first.x);
    return good;
}

/* Ways to solve: all there are, or of a large packing one and three sweeps of it */
static void compare(const struct packing *p, const struct contacts *s, const char *what, bool all)
{
    static const enum order orders[] = { ORDER_NATURAL, ORDER_COLOUR, ORDER_NATURAL, ORDER_COLOUR };
    for (int m = 0; methods[m]; m++) {
        bool good = true;
        for (int way = 0; way < 8; way++) {
            if (!all && way != 3) continue;
            struct step_opt o = options(m, way & 1 ? 1.5 : 1);
            o.order = orders[way / 2], o.warm = way & 4;
            o.solve.local.plain = way == 7;
            if (!all) o.solve.max_sweeps = 3;
            good &= same_everywhere(p, s, o);
        }
        ok(good, "%s, %s: the same bytes for 2, 4 and 8 lanes and 1, 2 and 4 threads", what,
           methods[m]->name);
    }
    struct step_opt o = options(4, 0);
    o.order = ORDER_COLOUR, o.solve.global = &solver_anderson;
    o.solve.max_sweeps = 16; // enough to mix and gain by it
    ok(same_everywhere(p, s, o), "%s, anderson: the same", what);
}

/* W of a packing's problem; noise, relative to W_nn, in the coupling of n and t1 of every W_cc */
static struct delassus operator(const struct packing *pack, const struct contacts *s, double noise)
{
    struct failure failure = { 0 };
    struct problem p;
    struct delassus W;
    must(problem_prepare(&p, pack, s, &(struct prepare_opt){ .rho_factor = 1 }, &failure) ||
             scaled_assemble(&W, &p, &failure),
         &failure);
    for (int64_t c = 0; c < s->n; c++)
        for (int k = 1; k < 4; k += 2) W.diag[9 * c + k] += noise * W.diag[9 * c];
    problem_free(&p);
    return W;
}

/* The largest component by which the reactions differ, over the largest of W's */
static double apart(const struct delassus *W, const double *r)
{
    double most = 0, far = 0;
    for (int64_t i = 0; i < W->d * W->n; i++)
        most = fmax(most, fabs(W->r[i])), far = fmax(far, fabs(W->r[i] - r[i]));
    return far / most;
}

static void test_given(const struct packing *p, const struct contacts *s, const char *what)
{
    static const double noise[] = { 0, 1e-13 };
    double *u = malloc((size_t)(3 * s->n) * sizeof *u), *r = malloc((size_t)(3 * s->n) * sizeof *r);
    for (int m = 0; methods[m]; m++) {
        struct step_opt o = options(m, 1);
        struct print of_bodies = solve(p, s, &o);
        for (int64_t i = 0; i < s->n; i++)
            for (int k = 0; k < p->dim; k++) r[p->dim * i + k] = of_bodies.x[6 * i + k];
        for (int k = 0; k < 2; k++) {
            struct failure failure = { 0 };
            struct report rep = { 0 };
            struct problem shape;
            struct delassus W = operator(p, s, noise[k]);
            must(problem_prepare_delassus(&shape, &W, &(struct prepare_opt){ .rho_factor = 1 },
                                          &failure),
                 &failure);
            must(step_solve_delassus(&W, u, &o, &rep, &failure), &failure);
            double far = apart(&W, r);
            ok(shape.kind.full == (k == 1) && far < 1e-9,
               "%s, %s: the reactions of %s W are those of the bodies: %.1e", what,
               methods[m]->name, k ? "a full" : "the", far);
            problem_free(&shape), delassus_free(&W), report_free(&rep);
        }
        free(of_bodies.x);
    }
    free(u), free(r);
}

int main(void)
{
    static const struct {
        const char *name;
        int dim;
        int64_t n;
        double e;
        int steps;
    } scene[] = { { "no contact", 3, 4, 0, 0 },
                  { "4 balls", 3, 4, 0.3, 700 },
                  { "500 balls", 3, 500, 0, 800 },
                  { "500 balls that rebound", 3, 500, 0.5, 300 },
                  { "500 discs", 2, 500, 0, 500 } };
    for (size_t k = 0; k < sizeof scene / sizeof *scene; k++) {
        struct packing p;
        struct contacts s = { 0 };
        fallen(&p, &s, scene[k].dim, scene[k].n, scene[k].e, scene[k].steps);
        diag("%s: %lld contacts", scene[k].name, (long long)s.n);
        compare(&p, &s, scene[k].name, true);
        if (s.n > 0 && scene[k].e == 0) test_given(&p, &s, scene[k].name);
        contacts_free(&s), packing_free(&p);
    }
    // enough for threads; for more blocks of colours than one, and few differences to mix: neighbours,
    // as if they touched
    static const struct {
        const char *name;
        int64_t n;
    } large[] = { { "3000 balls", 3000 }, { "50 000 balls", 50000 } };
    for (int k = 0; k < 2; k++) {
        struct failure failure = { 0 };
        struct packing p;
        struct contacts s = { 0 };
        fallen(&p, &s, 3, large[k].n, 0, 0);
        must(detect_contacts(&s, &p, 4e-4, NULL, &failure), &failure);
        diag("%s: %lld contacts", large[k].name, (long long)s.n);
        compare(&p, &s, large[k].name, false);
        contacts_free(&s), packing_free(&p);
    }
    return tap_done();
}
