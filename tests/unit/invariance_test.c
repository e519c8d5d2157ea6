/*
 * What happens depends neither on where a scene lies, on how fast all of it glides, on where the border of a cell
 * runs and which image of a body stands for it, on how the scene is turned, in which order its bodies are, nor on
 * the units. Scenes with every kind of cell, load, law and shape are transformed, stepped, and transformed back.
 */
#include "scene/scene_build.h"
#include "step/step.h"
#include "tap.h"

#include <stdlib.h>
#include <string.h>

enum {
    STEPS = 60,
    STEPS_OF_BRICKS =
        30 /* later, faces lie on faces, and rounding decides which of their places are contacts */
};

static void must(int failed, struct failure *failure)
{
    if (!failed) return;
    printf("Bail out! %s\n", failure->text);
    exit(1);
}

/* ---- the scenes ---- */

#define DISCS                                                                                      \
    "\"bodies\": [{ \"count\": 25, \"radius\": { \"uniform\": [0.4, 0.48] }, \"spacing\": 1.02, "  \
    "\"thermal\": 0.3,"                                                                            \
    "\"box\": { \"x\": [0, 5], \"y\": [0, 5] } }] }"
#define BALLS                                                                                      \
    "\"bodies\": [{ \"count\": 27, \"radius\": { \"uniform\": [0.4, 0.48] }, \"spacing\": 1.02, "  \
    "\"thermal\": 0.3,"                                                                            \
    "\"box\": { \"x\": [0, 3], \"y\": [0, 3], \"z\": [0, 3] } }] }"
#define SHAPES(shape)                                                                              \
    "\"bodies\": [{ \"count\": 16, \"shape\": \"" shape "\", \"radius\": { \"uniform\": [0.4,"     \
    "0.48] }, \"spacing\": 1.02, \"orientation\": \"random\", \"thermal\": 0.3, \"box\": { "       \
    "\"x\": [0, 4], \"y\": [0,"                                                                    \
    "4] } }] }"
#define FLAT  "{ \"dim\": 2, \"dt\": 0.01, \"gravity\": [0, 0], \"density\": 1.2, \"mu\": 0.3,"
#define SPACE "{ \"dim\": 3, \"dt\": 0.01, \"gravity\": [0, 0, 0], \"density\": 1.5, \"mu\": 0.3,"
#define FIVE  "\"cell\": { \"lengths\": [5, 5],"
#define THREE "\"cell\": { \"lengths\": [3, 3, 3],"

static const struct scene_text {
    const char *name, *text;
} scenes[] = {
    { "discs in a cell at rest", FLAT "\"e_n\": 0.5," FIVE "\"repeats\": [true, true] }," DISCS },
    { "discs under a stress",
      FLAT "\"e_n\": 0.2, \"e_t\": 0.1," FIVE
           "\"stress\": { \"target\": [[4, 1], [1, 3]], \"mass\": 2 } }," DISCS },
    { "discs between edges that yield in one direction",
      FLAT FIVE "\"repeats\": [true, false], \"stress\": { \"target\": [[4, null],"
                "[null, null]], \"mass\": 2 } }," DISCS },
    { "plane shear under a pressure",
      FLAT "\"e_n\": 0.1," FIVE "\"affine\": true, \"gradient\": [[0, 0.5], [0, 0]], \"stress\":"
           "{ \"target\": [[null, null], [null, 4]], \"mass\": 3 } }," DISCS },
    { "balls under a pressure",
      SPACE THREE "\"stress\": { \"pressure\": 4, \"mass\": 3 } }," BALLS },
    { "triaxial compression", SPACE THREE
      "\"affine\": true, \"gradient\": [[0, 0, 0], [0, 0, 0], [0, 0, -0.4]], \"stress\":"
      "{ \"target\": [[2, null, null], [null, 2, null], [null, null, null]],"
      "\"mass\": 3 } }," BALLS },
    { "boxes under a pressure",
      FLAT "\"shapes\": { \"box\": { \"box\": [0.7, 0.5] } },\"cell\": { \"lengths\": [4, 4],"
           "\"stress\": { \"pressure\": 4, \"mass\": 2 } }," SHAPES("box") },
    { "bricks under a pressure",
      SPACE "\"shapes\": { \"brick\": { \"box\": [0.8, 0.6, 0.5] } }," THREE
            "\"stress\": { \"pressure\": 4, \"mass\": 3 } }, \"bodies\": [{ \"count\": 27,"
            "\"shape\": \"brick\", \"radius\": { \"uniform\": [0.4, 0.48] }, \"spacing\": 1.02,"
            "\"orientation\": \"random\", \"thermal\": 0.3, \"box\": { \"x\": [0, 3],"
            "\"y\": [0, 3], \"z\": [0, 3] } }] }" },
    { "cohesive discs under a pressure",
      FLAT "\"cohesion\": { \"force\": 2, \"range\": 0.05 }," FIVE
           "\"stress\": { \"pressure\": 1, \"mass\": 2 } }," DISCS },
    { "bonded discs under a pressure",
      FLAT "\"adhesion\": { \"c_n\": 1e3, \"w\": 0.1, \"forever\": true }," FIVE
           "\"stress\": { \"pressure\": 4, \"mass\": 2 } }," DISCS },
    { "discs that roll in a shear",
      FLAT "\"rolling\": { \"mu_r\": 0.05 }," FIVE
           "\"affine\": true, \"gradient\": [[-0.05, 0.5], [0, -0.05]] }," DISCS },
    { "wet balls that a cell compresses",
      SPACE "\"capillary\": { \"volume\": 1e-3, \"tension\": 0.5 }," THREE
            "\"affine\": true, \"gradient\": [[-0.3, 0, 0], [0, -0.3, 0], [0, 0, -0.3]] }," BALLS },
    { "discs under a piston",
      "{ \"dim\": 2, \"dt\": 0.01, \"gravity\": [1, -9], \"density\": 1.2, \"mu\": 0.3, \"e_n\": "
      "0.2,"
      "\"walls\": [{ \"point\": [0, 0], \"normal\": [0, 1] }, { \"point\": [0, 0], \"normal\": [1, "
      "0] },"
      "{ \"point\": [5, 0], \"normal\": [-1, 0] }, { \"point\": [0, 5], \"normal\": [0, -1],"
      "\"load\": { \"along\": [0, 1], \"mass\": 3, \"force\": -30 } }]," DISCS },
    { "capsules that fall",
      "{ \"dim\": 2, \"dt\": 0.01, \"gravity\": [1, -9], \"density\": 1.2, \"mu\": 0.3,"
      "\"shapes\": { \"pill\": { \"capsule\": { \"length\": 0.5, \"radius\": 0.2 } } },"
      "\"walls\": [{ \"point\": [0, 0], \"normal\": [0, 1] }, { \"point\": [0, 0], \"normal\": [1, "
      "0] },"
      "{ \"point\": [4, 0], \"normal\": [-1, 0] }]," SHAPES("pill") },
};

static void build(struct packing *p, const char *text)
{
    struct failure failure = { 0 };
    struct scene sc;
    must(scene_parse(&sc, text, strlen(text), NULL, &failure) ||
             scene_build(p, &sc, NULL, &failure),
         &failure);
    scene_free(&sc);
    p->overlap =
        OVERLAP_GAP; // a projection ends after a few sweeps: what it leaves depends on their order
}

static void run(struct packing *p, int steps)
{
    struct failure failure = { 0 };
    struct contacts s = { 0 };
    struct report rep = { 0 };
    struct step_opt o = { .order = ORDER_COLOUR,
                          .solve = { .global = &solver_auto,
                                     .method = &local_exact,
                                     .criterion = CRITERION_NATURAL,
                                     .eps = 1e-13,
                                     .max_sweeps = 20000,
                                     .relax = solver_auto.relax,
                                     .threads = 1,
                                     .local = { .newton_eps = 1e-13, .newton_max = 100 } } };
    for (int k = 0; k < steps; k++) must(step_advance(p, &s, NULL, &o, &rep, &failure), &failure);
    contacts_free(&s), report_free(&rep);
}

/* ---- the transformations ---- */

static const vec3 AWAY = { 3.7, -1.3, 2.2 }, GLIDE = { 0.7, 1.9, -0.4 };

static vec3 flat(const struct packing *p, vec3 x)
{
    return p->dim == 2 ? v3(x.x, x.y, 0) : x;
}

static void move(struct packing *p)
{
    vec3 d = flat(p, AWAY);
    for (int64_t i = 0; i < p->n; i++) p->x[i] = v3_add(p->x[i], d);
    for (int32_t k = 0; k < p->walls; k++) p->wall[k].x = v3_add(p->wall[k].x, d);
    p->cell.origin = v3_add(p->cell.origin, d);
}
static vec3 move_back_from(const struct packing *p, vec3 x)
{
    return v3_sub(x, flat(p, AWAY));
}

/* All glides with a common velocity u(t): that of the flow at a place that moves along, u = L x, x' = u. */
static void glide(struct packing *p)
{
    for (int64_t i = 0; i < p->n; i++) p->v[i] = v3_add(p->v[i], flat(p, GLIDE));
    for (int32_t k = 0; k < p->walls; k++) p->wall[k].v = v3_add(p->wall[k].v, flat(p, GLIDE));
}

static void shift_border(struct packing *p)
{
    for (int k = 0; k < 3; k++)
        if (p->cell.repeats[k])
            p->cell.origin = v3_axpy(p->cell.origin, 0.23 + 0.3 * k, p->cell.edge[k]);
}

static void choose_images(struct packing *p)
{
    for (int64_t i = 0; i < p->n; i++)
        for (int k = 0; k < 3; k++) {
            int edges = p->cell.repeats[k] ? (int)(i + k) % 4 - 1 : 0;
            p->x[i] = v3_axpy(p->x[i], edges, p->cell.edge[k]);
            p->v[i] = v3_axpy(p->v[i], edges, p->cell.rate[k]);
        }
}

/* x to y, y to -x */
static vec3 quarter(vec3 x)
{
    return v3(-x.y, x.x, x.z);
}
static vec3 quarter_back(const struct packing *p, vec3 x)
{
    (void)p;
    return v3(x.y, -x.x, x.z);
}
static void quarter_tensor(double T[3][3], bool of_edges)
{
    double was[3][3];
    const int from[3] = { 1, 0, 2 };
    const double sign[3] = { -1, 1, 1 };
    memcpy(was, T, sizeof was);
    for (int i = 0; i < 3; i++) // masses: edge i keeps its number, its components change
        for (int j = 0; j < 3; j++)
            T[i][j] = of_edges ? was[i][from[j]] : sign[i] * sign[j] * was[from[i]][from[j]];
}
static void turn(struct packing *p)
{
    struct cell *c = &p->cell;
    quat q = quat_rotation(v3(0, 0, M_PI / 2));
    for (int64_t i = 0; i < p->n; i++) {
        p->x[i] = quarter(p->x[i]), p->v[i] = quarter(p->v[i]), p->w[i] = quarter(p->w[i]);
        p->q[i] = quat_mul(q, p->q[i]);
    }
    for (int32_t k = 0; k < p->walls; k++) {
        struct wall *w = &p->wall[k];
        w->x = quarter(w->x), w->n = quarter(w->n), w->load.axis = quarter(w->load.axis);
    }
    p->g = quarter(p->g), c->origin = quarter(c->origin);
    for (int k = 0; k < 3; k++) c->edge[k] = quarter(c->edge[k]), c->rate[k] = quarter(c->rate[k]);
    quarter_tensor(c->stress, false), quarter_tensor(c->mass, true);
    for (int32_t m = 0; m < c->gradients; m++) quarter_tensor(c->gradient[m].L, false);
}

/* Body i becomes body 7 i mod n, n no multiple of 7 */
static int64_t place(const struct packing *p, int64_t i)
{
    return 7 * i % p->n;
}
static void renumber(struct packing *p)
{
    struct packing was;
    struct failure failure = { 0 };
    must(packing_copy(&was, p, &failure), &failure);
    for (int64_t i = 0; i < p->n; i++) {
        int64_t k = place(p, i);
        p->radius[k] = was.radius[i], p->mass[k] = was.mass[i], p->inertia[k] = was.inertia[i];
        p->material[k] = was.material[i], p->x[k] = was.x[i], p->q[k] = was.q[i];
        p->v[k] = was.v[i], p->w[k] = was.w[i];
        if (p->shape) p->shape[k] = was.shape[i];
    }
    packing_free(&was);
}

/* Units of 1/50 m, 1/7 s and 1/1000 kg */
static const double LENGTH = 50, TIME = 7, MASS = 1000;
static void change_units(struct packing *p)
{
    struct cell *c = &p->cell;
    const double speed = LENGTH / TIME, force = MASS * speed / TIME;
    const double stress = force / (p->dim == 3 ? LENGTH * LENGTH : LENGTH);
    for (int64_t i = 0; i < p->n; i++) {
        p->x[i] = v3_scale(LENGTH, p->x[i]), p->v[i] = v3_scale(speed, p->v[i]);
        p->w[i] = v3_scale(1 / TIME, p->w[i]), p->radius[i] *= LENGTH;
        p->mass[i] *= MASS, p->inertia[i] *= MASS * LENGTH * LENGTH;
    }
    for (int32_t k = 0; k < p->walls; k++) {
        struct wall *w = &p->wall[k];
        w->x = v3_scale(LENGTH, w->x), w->v = v3_scale(speed, w->v);
        w->load.mass *= MASS, w->load.force *= force;
    }
    p->dt *= TIME, p->g = v3_scale(speed / TIME, p->g);
    c->origin = v3_scale(LENGTH, c->origin);
    for (int k = 0; k < 3; k++)
        c->edge[k] = v3_scale(LENGTH, c->edge[k]), c->rate[k] = v3_scale(speed, c->rate[k]);
    for (int k = 0; k < 9; k++) c->mass[k / 3][k % 3] *= MASS, c->stress[k / 3][k % 3] *= stress;
    for (int32_t m = 0; m < c->gradients; m++)
        for (int k = 0; k < 9; k++) c->gradient[m].L[k / 3][k % 3] /= TIME;
    for (int32_t k = 0; p->law && k < p->materials * p->materials; k++) {
        struct pair_law *l = &p->law[k];
        double section = p->dim == 3 ? LENGTH * LENGTH : LENGTH; // of bonds, discs 1 m deep
        l->cohesion *= force, l->range *= LENGTH;
        l->volume *= LENGTH * LENGTH * LENGTH, l->tension *= force / LENGTH;
        l->mu_r *= LENGTH, l->mu_p *= LENGTH;
        l->cn *= force / LENGTH / section, l->ct *= force / LENGTH / section;
        l->w *= force * LENGTH / section;
    }
}
static vec3 metres(const struct packing *p, vec3 x)
{
    (void)p;
    return v3_scale(1 / LENGTH, x);
}

static const struct transformation {
    const char *name;
    void (*there)(struct packing *p);
    vec3 (*back)(const struct packing *p, vec3 x);
    bool renumbers, glides;
} transformations[] = {
    { "elsewhere", move, move_back_from, false, false },
    { "gliding", glide, NULL, false, true },
    { "with the border elsewhere", shift_border, NULL, false, true },
    { "with other images for its bodies", choose_images, NULL, false, false },
    { "turned by a quarter", turn, quarter_back, false, false },
    { "in another order", renumber, NULL, true, false },
    { "in other units", change_units, metres, false, false },
};

/* ---- what is compared ---- */

/* d less the nearest vector of the lattice, where it repeats */
static vec3 within(const struct cell *c, vec3 d)
{
    vec3 inverse[3], rest = d;
    if (!cell_repeats(c)) return d;
    cell_inverse(c->edge, inverse);
    for (int k = 0; k < 3; k++)
        if (c->repeats[k]) rest = v3_axpy(rest, -rint(v3_dot(inverse[k], d)), c->edge[k]);
    return rest;
}

/* m: how far the bodies of the transformed run are from those of the first, at most; one that glides has got
   ahead by the same way with all its bodies */
static double difference(const struct packing *p, const struct packing *q,
                         const struct transformation *t)
{
    double most = 0;
    vec3 first = v3(0, 0, 0);
    for (int64_t i = 0; i < p->n; i++) {
        vec3 y = q->x[t->renumbers ? place(p, i) : i];
        vec3 d = v3_sub(t->back ? t->back(q, y) : y, p->x[i]);
        if (t->glides && i == 0) first = d;
        most = fmax(most, v3_norm(within(&p->cell, v3_sub(d, first))));
    }
    for (int k = 0; k < 3; k++) {
        vec3 y = q->cell.edge[k], zero = v3(0, 0, 0);
        if (t->back) y = v3_sub(t->back(q, y), t->back(q, zero));
        if (p->cell.repeats[k]) most = fmax(most, v3_norm(v3_sub(y, p->cell.edge[k])));
    }
    return most;
}

static double moved(const struct packing *p, const struct packing *start)
{
    double most = 0;
    for (int64_t i = 0; i < p->n; i++)
        most = fmax(most, v3_norm(within(&p->cell, v3_sub(p->x[i], start->x[i]))));
    return most;
}

static void test_scene(const struct scene_text *s)
{
    struct packing start, first, p;
    struct failure failure = { 0 };
    build(&start, s->text);
    must(packing_copy(&first, &start, &failure), &failure);
    const int steps = strncmp(s->name, "bricks", 6) ? STEPS : STEPS_OF_BRICKS;
    run(&first, steps);
    ok(moved(&first, &start) > 0.05, "%s: bodies move by up to %.2f m", s->name,
       moved(&first, &start));
    for (size_t k = 0; k < sizeof transformations / sizeof *transformations; k++) {
        const struct transformation *t = &transformations[k];
        must(packing_copy(&p, &start, &failure), &failure);
        t->there(&p);
        run(&p, steps);
        double d = difference(&first, &p, t);
        // another order is another rounding of every solve, which what collides and what rests enlarges
        ok(d < (t->there == renumber ? 1e-6 : 1e-8), "%s %s: the same (%.1e m)", s->name, t->name,
           d);
        packing_free(&p);
    }
    packing_free(&start), packing_free(&first);
}

int main(void)
{
    for (size_t k = 0; k < sizeof scenes / sizeof *scenes; k++) test_scene(&scenes[k]);
    return tap_done();
}
