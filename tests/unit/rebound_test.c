/*
 * Impacts under Newton's law with friction may gain energy; bounded, as they are by default, they do not, and where
 * Newton's law gains nothing it holds to the bit. Random impacts of all kinds of grains on a floor and on each other.
 */
#include "scene/scene_build.h"
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

/* Of a sequence that is the same everywhere */
static double uniform(double lo, double hi)
{
    static uint64_t state = 1;
    state = state * 6364136223846793005u + 1442695040888963407u;
    return lo + (hi - lo) * (double)(state >> 11) / 9007199254740992.0;
}

static struct step_opt options(void)
{
    return (struct step_opt){ .order = ORDER_COLOUR,
                              .solve = { .global = &solver_auto,
                                         .method = &local_exact,
                                         .criterion = CRITERION_NATURAL,
                                         .eps = 1e-12,
                                         .max_sweeps = 20000,
                                         .relax = solver_auto.relax,
                                         .threads = 1,
                                         .local = { .newton_eps = 1e-13, .newton_max = 100 } } };
}

struct grains {
    const char *name, *shape;
    int dim;
};

/* Two grains above a floor, at random turned and thrown at it and at each other */
static void throw(struct packing * p, const struct grains *g, bool newton)
{
    char text[2048];
    struct failure failure = { 0 };
    struct scene sc;
    snprintf(
        text, sizeof text,
        "{ \"dim\": %d, \"dt\": 1e-3, \"gravity\": [0, 0%s], \"mu\": %.17g, \"e_n\": %.17g,"
        "\"e_t\": %.17g, \"impact\": \"%s\", \"shapes\": { \"s\": %s }, \"walls\": [{ \"point\":"
        "[0, 0%s], \"normal\": [0, %s1] }], \"bodies\": [{ \"x\": [0, %s1.05], \"shape\": \"s\" },"
        "{ \"x\": [0.1, %s2.9], \"shape\": \"s\" }] }",
        g->dim, g->dim == 3 ? ", 0" : "", uniform(0.1, 1), uniform(0.6, 1),
        uniform(0, 1) < 0.5 ? 0 : uniform(0, 1), newton ? "newton" : "bounded", g->shape,
        g->dim == 3 ? ", 0" : "", g->dim == 3 ? "0, " : "", g->dim == 3 ? "0, " : "",
        g->dim == 3 ? "0, " : "");
    must(scene_parse(&sc, text, strlen(text), NULL, &failure) ||
             scene_build(p, &sc, NULL, &failure),
         &failure);
    scene_free(&sc);
    p->overlap = OVERLAP_GAP;
    for (int i = 0; i < 2; i++) {
        bool flat = g->dim == 2;
        vec3 turn = v3(uniform(-3, 3), uniform(-3, 3), uniform(-3, 3));
        p->v[i] = v3(uniform(-3, 3), uniform(-3, 3), -3);
        p->w[i] = v3(uniform(-6, 6), uniform(-6, 6), uniform(-6, 6));
        if (flat) p->v[i] = v3(p->v[i].x, -3, 0), p->w[i].x = p->w[i].y = turn.x = turn.y = 0;
        p->q[i] = quat_rotation(turn);
        if (uniform(0, 1) < 0.3)
            p->q[i] = quat_rotation(v3(0, flat ? 0 : turn.y, flat ? turn.z : 0));
    }
}

struct outcome {
    double gained, reported; /* of the energy before, the most in a step; what balances say */
    vec3 v[2];               /* at the end */
};

static struct outcome run(struct packing *p)
{
    struct outcome o = { 0 };
    struct failure failure = { 0 };
    struct contacts s = { 0 };
    struct report rep = { 0 };
    struct step_opt opt = options();
    for (int k = 0; k < 600; k++) {
        must(step_advance(p, &s, NULL, &opt, &rep, &failure), &failure);
        const struct balance *b = &rep.balance;
        o.gained = fmax(o.gained, b->change / (b->kinetic - b->change));
        o.reported = fmax(o.reported, b->gained / (b->kinetic - b->change));
    }
    o.v[0] = p->v[0], o.v[1] = p->v[1];
    contacts_free(&s), report_free(&rep), packing_free(p);
    return o;
}

static void test_grains(const struct grains *g)
{
    enum { THROWS = 60 };
    struct packing p;
    int gains = 0, changed = 0;
    double most = 0, bounded = 0, left = 0;
    for (int k = 0; k < THROWS; k++) {
        throw(&p, g, true);
        struct packing copy;
        struct failure failure = { 0 };
        must(packing_copy(&copy, &p, &failure), &failure);
        for (int32_t i = 0; copy.law && i < copy.materials * copy.materials; i++)
            copy.law[i].impact = IMPACT_DEFAULT;
        struct outcome newton = run(&p), safe = run(&copy);
        gains += newton.gained > 1e-9;
        most = fmax(most, newton.gained), bounded = fmax(bounded, safe.gained);
        left = fmax(left, safe.reported);
        changed += newton.reported == 0 && memcmp(newton.v, safe.v, sizeof safe.v);
    }
    ok(gains > 0, "%s: Newton's law gains in %d of %d runs, up to %.2g of the energy", g->name,
       gains, THROWS, most);
    ok(bounded < 1e-9 && left < 1e-9, "%s: bounded, no impact gains (%.1e of the energy)", g->name,
       bounded);
    ok(changed == 0, "%s: and where Newton's law gains nothing it holds to the bit", g->name);
}

int main(void)
{
    static const struct grains all[] = {
        { "rods in the plane", "{ \"box\": [2, 0.05] }", 2 },
        { "triangles", "{ \"polygon\": [[-0.8, -0.3], [0.9, -0.3], [-0.1, 0.6]] }", 2 },
        { "discs in a row", "{ \"balls\": [[-0.6, 0, 0.3], [0, 0, 0.3], [0.6, 0, 0.3]] }", 2 },
        { "bricks", "{ \"box\": [1.8, 0.3, 0.5] }", 3 },
        { "capsules", "{ \"capsule\": { \"length\": 1.6, \"radius\": 0.1 } }", 3 },
        { "ellipsoids", "{ \"superquadric\": { \"radii\": [1, 0.3, 0.2], \"exponents\": [2, 2] } }",
          3 },
    };
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) test_grains(&all[k]);
    return tap_done();
}
