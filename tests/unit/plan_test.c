/* tests/unit/plan_test.c: a plan is kept where, and only where, a new one would be the same. */
#include "contact/detect.h"
#include "scene/scene_build.h"
#include "solve/plan.h"
#include "step/step.h"
#include "tap.h"

#include <gsl/gsl_rng.h>
#include <stdlib.h>
#include <string.h>

static gsl_rng *rng;

static void must(int failed, const struct failure *failure)
{
    if (!failed) return;
    printf("Bail out! %s\n", failure->text);
    exit(1);
}

/* A cube of touching balls, `side` a side, on a floor; every tenth ball of the lowest layer is fixed. */
static void cube(struct packing *p, struct contacts *s, int side)
{
    struct failure failure = { 0 };
    int64_t n = (int64_t)side * side * side;
    must(packing_init(p, 3, n, &failure) || packing_alloc_walls(p, 1, &failure), &failure);
    p->dt = 1e-4, p->g = v3(0, 0, -9.81);
    p->wall[0] = (struct wall){ .n = v3(0, 0, 1) };
    for (int64_t i = 0; i < n; i++) {
        p->radius[i] = 0.5, p->mass[i] = i < (int64_t)side * side && i % 10 == 0 ? 0 : 1;
        p->inertia[i] = 0.1, p->q[i] = (quat){ 1, 0, 0, 0 };
        p->x[i] =
            v3((double)(i % side), (double)(i / side % side), 0.5 + (double)(i / side / side));
    }
    must(detect_contacts(s, p, 1e-6, NULL, &failure), &failure);
}

static bool same(const struct plan *a, const struct plan *b)
{
    size_t groups = (size_t)a->schedule.groups + 1;
    return a->bundles == b->bundles && a->schedule.groups == b->schedule.groups &&
           a->schedule.beyond == b->schedule.beyond && a->schedule.inside == b->schedule.inside &&
           a->schedule.rim == b->schedule.rim && a->schedule.rest == b->schedule.rest &&
           !memcmp(a->group, b->group, groups * sizeof *a->group) &&
           !memcmp(a->contact, b->contact, (size_t)a->slots * sizeof *a->contact) &&
           !memcmp(a->seat, b->seat, (size_t)a->bodies * sizeof *a->seat) &&
           !memcmp(a->seats, b->seats, (size_t)a->slots * sizeof *a->seats);
}

/* What may be otherwise in the next step */
enum change { NOTHING, REST, ROLL, OTHER_PAIR, FIXED, LEAP, CHANGES };
static const char *const said[CHANGES] = { "nothing",      "a tremor",     "a roll",
                                           "another pair", "a fixed body", "a leap" };

static void change(struct packing *p, struct contacts *s, enum change what)
{
    int64_t c = (int64_t)gsl_rng_uniform_int(rng, (unsigned long)s->n), b = s->c[c].b;
    double far = what == REST ? 1e-13 : what == ROLL ? 1e-2 : 10;
    if (what == REST || what == ROLL || what == LEAP) {
        const vec3 d = v3(far * (gsl_rng_uniform(rng) - 0.5), far * (gsl_rng_uniform(rng) - 0.5),
                          far * (gsl_rng_uniform(rng) - 0.5));
        p->x[b] = v3_add(p->x[b], d), s->c[c].x = v3_add(s->c[c].x, d);
    }
    if (what == OTHER_PAIR) s->c[c].b = (int32_t)(b > 0 ? b - 1 : b + 1);
    if (what == FIXED) p->mass[b] = p->mass[b] > 0 ? 0 : 1;
}

/* kept: for how many of the changes a plan has to be kept. Where one is, a new one is the same; of a pair or a
   mass it never is. */
static void test_holds(int side, enum order order, int rounds)
{
    int kept[CHANGES] = { 0 }, wrong = 0;
    for (int what = 0; what < CHANGES; what++)
        for (int k = 0; k < rounds; k++) {
            struct packing p;
            struct contacts s = { 0 };
            cube(&p, &s, side);
            struct plan *plan = plan_of_contacts(order, &s, &p, NULL);
            change(&p, &s, (enum change)what);
            struct plan *fresh = plan_of_contacts(order, &s, &p, NULL);
            bool holds = plan_holds(plan, order, &s, &p);
            kept[what] += holds, wrong += holds && !same(plan, fresh);
            if (what == NOTHING)
                ok(!plan_holds(plan, order == ORDER_COLOUR ? ORDER_NATURAL : ORDER_COLOUR, &s, &p),
                   "%s, %lld contacts: not by another order", order_name[order], (long long)s.n);
            plan_free(plan), plan_free(fresh);
            contacts_free(&s), packing_free(&p);
        }
    ok(!wrong, "%s, side %d: what holds is what would be made", order_name[order], side);
    for (int what = 0; what < CHANGES; what++) {
        // of what is somewhere else it depends on the cut and on the curve: that what holds is right is all
        bool moved = what == REST || what == ROLL || what == LEAP;
        bool by_place = side > 40, always = what == NOTHING || moved;
        if (by_place && moved && !(side > 40 && what == LEAP)) continue;
        ok(kept[what] == (always && !(by_place && moved) ? rounds : 0),
           "%s, side %d, %s: kept %d of %d times", order_name[order], side, said[what], kept[what],
           rounds);
    }
}

/* Two runs from the same state, one of which remembers; how often its plan was kept */
static void test_run(const char *what, int steps, bool warm, int least, int most)
{
    struct failure failure = { 0 };
    struct scene scene;
    struct packing p[2];
    struct contacts s[2] = { { 0 }, { 0 } };
    struct report rep = { 0 };
    struct step_memory m = { 0 };
    struct step_opt o = { .order = ORDER_COLOUR,
                          .warm = warm,
                          .solve = { .global = &solver_nlgs,
                                     .method = &local_exact,
                                     .criterion = CRITERION_NATURAL,
                                     .eps = 1e-8,
                                     .max_sweeps = 1000,
                                     .relax = 1,
                                     .threads = 1,
                                     .local = { .newton_eps = 1e-13, .newton_max = 100 } } };
    int kept = 0;
    bool equal = true;
    must(scene_paper(&scene, 3, 20, &failure) || scene_build(&p[0], &scene, NULL, &failure),
         &failure);
    for (int k = 0; k < (warm ? 1500 : 0); k++)
        must(step_advance(&p[0], &s[0], NULL, &o, &rep, &failure), &failure);
    must(packing_copy(&p[1], &p[0], &failure) || contacts_copy(&s[1], &s[0]), &failure);
    for (int k = 0; k < steps; k++) {
        for (int j = 0; j < 2; j++)
            must(step_advance(&p[j], &s[j], j ? &m : NULL, &o, &rep, &failure), &failure);
        kept += m.plan->schedule.sequence != NULL; // a mark that a new plan has not
        if (!m.plan->schedule.sequence) m.plan->schedule.sequence = malloc(1);
        equal &= !memcmp(p[0].x, p[1].x, (size_t)p[0].n * sizeof *p[0].x) &&
                 !memcmp(p[0].w, p[1].w, (size_t)p[0].n * sizeof *p[0].w) && s[0].n == s[1].n;
        for (int64_t i = 0; equal && i < s[0].n; i++)
            equal = !memcmp(s[0].found[i].r, s[1].found[i].r, sizeof s[0].found[i].r);
    }
    ok(equal, "%s: with a memory the same bytes as without", what);
    ok(kept >= least && kept <= most, "%s: of %d plans %d are the last step's", what, steps, kept);
    step_forget(&m), report_free(&rep), scene_free(&scene);
    for (int j = 0; j < 2; j++) contacts_free(&s[j]), packing_free(&p[j]);
}

int main(void)
{
    rng = gsl_rng_alloc(gsl_rng_mt19937);
    test_holds(6, ORDER_NATURAL, 4);
    test_holds(6, ORDER_COLOUR, 4);
    test_holds(41, ORDER_COLOUR, 2); // sorted along the curve, and halved
    test_run("20 balls that rest", 100, true, 50, 99);
    test_run("20 balls that fall", 900, false, 1, 800);
    gsl_rng_free(rng);
    return tap_done();
}
