/* What must hold of loads: closed solutions, the same problem by all solvers, W by brute force, and the
   balances of energy and momentum. */
#include "contact/detect.h"
#include "scene/scene_build.h"
#include "solve/assembly.h"
#include "solve/prepare.h"
#include "state/placement.h"
#include "step/move.h"
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

static struct step_opt options(const struct solver *global, const struct method *m, double eps)
{
    return (struct step_opt){ .solve = { .global = global,
                                         .method = m,
                                         .criterion = CRITERION_NATURAL,
                                         .eps = eps,
                                         .max_sweeps = 200000,
                                         .relax = global->relax,
                                         .threads = 1,
                                         .local = { .newton_eps = 1e-13, .newton_max = 100 } } };
}

/* n balls of 1 kg and radius 1/2 in a row along z, the first on a floor, a ceiling above the last;
   no gravity, no friction, dt 1 ms. */
static void stack(struct packing *p, int dim, int64_t n)
{
    struct failure failure = { 0 };
    must(packing_init(p, dim, n, &failure) || packing_alloc_walls(p, 2, &failure), &failure);
    vec3 up = dim == 2 ? v3(0, 1, 0) : v3(0, 0, 1);
    p->dt = 1e-3;
    for (int64_t i = 0; i < n; i++) {
        p->radius[i] = 0.5, p->mass[i] = 1, p->inertia[i] = 0.1;
        p->x[i] = v3_scale(0.5 + (double)i, up);
    }
    p->wall[0].n = up;
    p->wall[1].n = v3_scale(-1, up), p->wall[1].x = v3_scale((double)n, up);
}

static struct load glides(vec3 axis, double mass, double force)
{
    return (struct load){ .way = LOAD_GLIDES, .axis = axis, .mass = mass, .force = force };
}

static void run(struct packing *p, struct contacts *c, const struct step_opt *o, int steps,
                struct report *rep)
{
    struct failure failure = { 0 };
    for (int k = 0; k < steps; k++) must(step_advance(p, c, NULL, o, rep, &failure), &failure);
}

/* r_n of the contact of a and b over dt, N; 0 where there is none */
static double force(const struct packing *p, const struct contacts *s, int32_t a, int32_t b)
{
    for (int64_t i = 0; i < s->n; i++)
        if (s->c[i].a == a && s->c[i].b == b) return s->found[i].r[0] / p->dt;
    return 0;
}

/* ---- closed solutions ---- */

static void test_free(void)
{
    struct packing p;
    struct contacts s = { 0 };
    struct report rep = { 0 };
    struct step_opt o = options(&solver_auto, &local_exact, 1e-12);
    stack(&p, 3, 1);
    p.wall[1].x.z = 100, p.wall[1].v = v3(0.25, 0, 0);
    p.wall[1].load = glides(v3(0, 0, 1), 4, -3);
    run(&p, &s, &o, 1000, &rep);
    vec3 x = wall_at(&p, &p.wall[1], p.t);
    ok(fabs(p.wall[1].load.speed + 0.75) < 1e-13 && fabs(x.z - (100 - 0.375)) < 1e-12 &&
           fabs(x.x - 0.25) < 1e-13,
       "a piston of 4 kg under 3 N falls 3/8 m in 1 s, and glides on as prescribed");
    ok(fabs(rep.balance.kinetic - 0.5 * 4 * 0.75 * 0.75) < 1e-12, "its kinetic energy is counted");
    p.wall[1].load =
        (struct load){ .way = LOAD_TURNS, .axis = v3(0, 0, -1), .mass = 0.5, .force = 2 };
    run(&p, &s, &o, 500, &rep);
    ok(fabs(p.wall[1].load.speed - 2) < 1e-12 && fabs(p.wall[1].load.travel - 0.5) < 1e-12,
       "a plate of 1/2 kg m^2 under 2 N m turns by 1/2 in 1/2 s");
    contacts_free(&s), packing_free(&p), report_free(&rep);
}

/* A piston of mass M presses on a column of n balls with F. */
static void test_static(int dim, int64_t n, double M, double F, bool gravity,
                        const struct solver *solver, const struct method *m)
{
    struct packing p;
    struct contacts s = { 0 };
    struct report rep = { 0 };
    struct step_opt o = options(solver, m, 1e-13);
    stack(&p, dim, n);
    vec3 up = p.wall[0].n;
    if (gravity) p.g = v3_scale(-9.81, up);
    p.wall[1].load = glides(up, M, -F);
    run(&p, &s, &o, 5, &rep);
    double worst = 0;
    for (int32_t i = 0; i <= n; i++) { // below ball i
        double want = F + (gravity ? 9.81 * (double)(n - i) : 0);
        double got = force(&p, &s, i < n ? i - 1 : -2, i < n ? i : (int32_t)n - 1);
        worst = fmax(worst, fabs(got - want) / want);
    }
    ok(worst < 1e-10 && fabs(p.wall[1].load.speed) < 1e-11 && rep.converged,
       "%dD, %s %s: a piston of %g kg presses %lld balls with %g N%s: so do they the floor (%.1e)",
       dim, solver->name, m->name, M, (long long)n, F, gravity ? " and their weight" : "", worst);
    contacts_free(&s), packing_free(&p), report_free(&rep);
}

/* A ball meets a piston: momentum is kept along the axis, the relative velocity is -e times what it
   was. */
static void test_impact(double mass, double e, double v, double speed)
{
    struct packing p;
    struct contacts s = { 0 };
    struct report rep = { 0 };
    struct step_opt o = options(&solver_auto, &local_exact, 1e-14);
    stack(&p, 3, 1);
    p.en[0] = e, p.et[0] = 0.3, p.mu[0] = 0;
    p.wall[1].load = glides(v3(0, 0, 1), mass, 0);
    p.wall[1].load.speed = speed;
    p.x[0].z = 0.5 + 1e-6, p.v[0].z = v; // clear of the floor
    run(&p, &s, &o, 1, &rep);
    double total = v + mass * speed, closing = v - speed;
    double ball = (total - mass * e * closing) / (1 + mass),
           piston = (total + e * closing) / (1 + mass);
    double off = fmax(fabs(p.v[0].z - ball), fabs(p.wall[1].load.speed - piston));
    double lost = 0.5 * mass / (1 + mass) * (1 - e * e) * closing * closing;
    ok(off < 1e-9 * fabs(closing) && s.n == 1,
       "a ball of 1 kg at %g m/s, a piston of %g kg at %g, e_n %g: as in closed form (%.1e)", v,
       mass, speed, e, off);
    ok(fabs(rep.balance.dissipation - lost) < 1e-9 * (lost + fmin(mass, 1) * closing * closing),
       "and what is dissipated, %g J", lost);
    ok(s.found && fabs(s.found[0].u[0]) < 1e-9 * fabs(closing), "u~_n is told as 0");
    contacts_free(&s), packing_free(&p), report_free(&rep);
}

/*
 * A plate turns under a ball too heavy to follow, 2 m from its axis, on which a piston presses with F:
 * it loses mu F R/I of its speed a second, and then stays under any torque below mu F R.
 */
static void test_plate(void)
{
    const double mu = 0.4, F = 5, R = 2, I = 3, spin = 0.5;
    struct packing p;
    struct contacts s = { 0 };
    struct report rep = { 0 };
    struct step_opt o = options(&solver_auto, &local_exact, 1e-12);
    stack(&p, 3, 1);
    p.mass[0] = 1e9, p.inertia[0] = 1e9, p.mu[0] = mu;
    p.wall[0].load = (struct load){ .way = LOAD_TURNS,
                                    .axis = v3(0, 0, 1),
                                    .point = v3(R * 0.6, R * 0.8, 0),
                                    .mass = I,
                                    .speed = spin };
    p.wall[1].load = glides(v3(0, 0, 1), 1, -F);
    run(&p, &s, &o, 100, &rep);
    double want = spin - mu * F * R / I * 0.1;
    ok(fabs(p.wall[0].load.speed - want) < 1e-7, "friction brakes a plate by mu F R/I (%.1e)",
       fabs(p.wall[0].load.speed - want));
    run(&p, &s, &o, 400, &rep);
    ok(fabs(p.wall[0].load.speed) < 1e-7, "until it stands");
    p.wall[0].load.force = 0.9 * mu * F * R;
    run(&p, &s, &o, 100, &rep);
    ok(fabs(p.wall[0].load.speed) < 1e-7, "and there it stays under 0.9 mu F R");
    p.wall[0].load.force = 1.5 * mu * F * R;
    run(&p, &s, &o, 100, &rep);
    want = 0.5 * mu * F * R / I * 0.1;
    ok(fabs(p.wall[0].load.speed - want) < 1e-6, "while 1.5 mu F R turns it by the excess (%.1e)",
       fabs(p.wall[0].load.speed - want));
    contacts_free(&s), packing_free(&p), report_free(&rep);
}

/*
 * n^dim touching bodies of 1 kg, on a square or cubic lattice that repeats, under a stress: in a step
 * the contacts along axis i that a plane cuts carry stress_ii times the face of the cell; an edge that nothing
 * holds, along which the bodies are far apart, moves as its mass says.
 */
static void test_lattice(int dim)
{
    enum { N = 3 };
    const double P[3] = { 7, 11, 13 }, mass = 5, close = 1 - 1e-9;
    struct failure failure = { 0 };
    struct packing p;
    struct contacts s = { 0 };
    struct report rep = { 0 };
    struct step_opt o = options(&solver_auto, &local_exact, 1e-13);
    must(packing_init(&p, dim, dim == 2 ? N * N : N * N * N, &failure), &failure);
    p.dt = 1e-3;
    for (int k = 0; k < dim; k++) {
        double L = N * (k == dim - 1 ? 1.5 : close); // the last edge holds bodies that are apart
        p.cell.repeats[k] = true, p.cell.mass[k][k] = mass, p.cell.stress[k][k] = P[k];
        p.cell.edge[k] = v3_scale(L, v3(k == 0, k == 1, k == 2));
    }
    for (int i = 0; i < p.n; i++) {
        const double at[3] = { i % N, (double)(i / N % N), (double)(i / N / N) };
        double x[3] = { 0 };
        for (int k = 0; k < dim; k++) x[k] = (0.5 + at[k]) * (k == dim - 1 ? 1.5 : close);
        p.x[i] = v3(x[0], x[1], x[2]);
        p.radius[i] = 0.5, p.mass[i] = 1, p.inertia[i] = 0.1;
    }
    run(&p, &s, &o, 1, &rep);
    double sum[2] = { 0 }, face = N * 1.5 * (dim == 2 ? 1 : N * close), worst = 0;
    for (int64_t i = 0; i < s.n; i++) sum[fabs(s.c[i].n.x) < 0.5] += s.found[i].r[0] / p.dt;
    for (int k = 0; k < dim - 1; k++) worst = fmax(worst, fabs(sum[k] / (N * P[k] * face) - 1));
    const double rate[3] = { p.cell.rate[0].x, p.cell.rate[1].y, p.cell.rate[2].z };
    double area = dim == 2 ? N * close : N * N * close * close;
    double want = -P[dim - 1] * area / mass * p.dt;
    ok(s.n == (dim - 1) * p.n && worst < 1e-9 && fabs(rate[0]) < 1e-11,
       "%dD: the contacts of a lattice carry the stress (%.1e)", dim, worst);
    double kinetic = 0.5 * mass * want * want, off = 0; // the bodies follow the edge
    for (int i = 0; i < p.n; i++) {
        const double x[3] = { p.x[i].x, p.x[i].y, p.x[i].z },
                     v[3] = { p.v[i].x, p.v[i].y, p.v[i].z };
        off = fmax(off, fabs(v[dim - 1] - want * x[dim - 1] / (N * 1.5)));
        kinetic += 0.5 * v3_dot(p.v[i], p.v[i]);
    }
    ok(fabs(rate[dim - 1] - want) < 1e-12 && fabs(rep.balance.kinetic - kinetic) < 1e-12,
       "and an edge without contacts moves as its mass says");
    ok(off < 1e-5 * fabs(want), "while the bodies follow it, each by its place (%.1e m/s)", off);
    contacts_free(&s), packing_free(&p), report_free(&rep);
}

/* ---- a heap under a lid ---- */

/*
 * 40 balls that have fallen into a box, of two kinds of restitution, under a lid that glides, beside a
 * wall that yields sideways, on a floor that turns about a slanting place.
 */
static void heap(struct packing *p, int dim, double e)
{
    struct failure failure = { 0 };
    struct scene sc;
    struct contacts s = { 0 };
    struct report rep = { 0 };
    struct step_opt o = options(&solver_auto, &local_exact, 1e-8);
    must(scene_paper(&sc, dim, 40, &failure) || scene_build(p, &sc, NULL, &failure), &failure);
    scene_free(&sc);
    run(p, &s, &o, 500, &rep);
    vec3 up = dim == 2 ? v3(0, 1, 0) : v3(0, 0, 1);
    double top = 0, weight = 0;
    for (int64_t i = 0; i < p->n; i++)
        top = fmax(top, v3_dot(up, p->x[i]) + p->radius[i]), weight += 9.81 * p->mass[i];
    struct wall *wall = realloc(p->wall, (size_t)(p->walls + 1) * sizeof *wall);
    must(!wall, &failure);
    p->wall = wall;
    wall[p->walls++] = wall_plane(v3_scale(top, up), v3_scale(-1, up), 1);
    wall[p->walls - 1].load = glides(up, 0.3 * p->mass[0], -2 * weight);
    wall[0].load = glides(wall[0].n, 5 * p->mass[0], 0.8 * weight);
    for (int32_t k = 0; dim == 3 && k < p->walls; k++)
        if (wall[k].n.z == 1)
            wall[k].load = (struct load){ .way = LOAD_TURNS,
                                          .axis = v3(0, 0, 1),
                                          .point = v3(1e-3, 0, 0),
                                          .mass = 1e-5 * p->mass[0],
                                          .force = 1e-4 * weight };
    for (int32_t k = 0; k < p->materials * p->materials; k++) p->en[k] = e, p->et[k] = 0.5 * e;
    contacts_free(&s), report_free(&rep);
}

/*
 * Bodies in a cell that repeats and that a pressure has brought together, along all edges, and a shear
 * stress along one.
 */
static void squeezed(struct packing *p, int dim, double e)
{
    static const char *const text[] = {
        "{ \"dim\": 2, \"dt\": 1e-4, \"mu\": 0.3, \"gravity\": [0, 0], \"cell\": { \"lengths\":"
        "[0.012, 0.012], \"stress\": { \"target\": [[20, 5], [5, 20]], \"mass\": 0.02 } },"
        "\"bodies\": [{ \"count\": 64, \"radius\": { \"uniform\": [4e-4, 6e-4] }, \"box\":"
        "{ \"x\": [0, 0.012], \"y\": [0, 0.012] } }] }",
        "{ \"dt\": 1e-4, \"mu\": 0.3, \"gravity\": [0, 0, 0], \"cell\": { \"lengths\":"
        "[6e-3, 6e-3, 6e-3], \"stress\": { \"pressure\": 300, \"mass\": 4e-3 } },"
        "\"bodies\": [{ \"count\": 64, \"radius\": { \"uniform\": [4e-4, 6e-4] }, \"box\":"
        "{ \"x\": [0, 6e-3], \"y\": [0, 6e-3], \"z\": [0, 6e-3] } }] }"
    };
    struct failure failure = { 0 };
    struct scene sc;
    struct contacts s = { 0 };
    struct report rep = { 0 };
    struct step_opt o = options(&solver_auto, &local_exact, 1e-6);
    must(scene_parse(&sc, text[dim - 2], strlen(text[dim - 2]), NULL, &failure) ||
             scene_build(p, &sc, NULL, &failure),
         &failure);
    scene_free(&sc);
    for (int k = 0; k < 5000 && s.n < 90 + 40 * (dim - 2); k++) run(p, &s, &o, 1, &rep);
    for (int32_t k = 0; k < p->materials * p->materials; k++) p->en[k] = e, p->et[k] = 0.5 * e;
    contacts_free(&s), report_free(&rep);
}

/* Bodies that a room has brought together between walls, one of which in space has a motion of its own */
static void enclosed(struct packing *p, int dim, double e)
{
    static const char *const text[] = {
        "{ \"dim\": 2, \"dt\": 1e-4, \"mu\": 0.3, \"gravity\": [1, -3], \"walls\": [{ \"box\": { "
        "\"x\": [0, 0.012],"
        "\"y\": [0, 0.012] }, \"name\": \"a\" }], \"room\": { \"walls\": \"a\", \"pressure\": 20, "
        "\"mass\": 0.02,"
        "\"strain_rate\": [0.1, -0.1], \"center\": [0.004, 0.003] },"
        "\"bodies\": [{ \"count\": 64, \"radius\": { \"uniform\": [4e-4, 6e-4] }, \"box\":"
        "{ \"x\": [0, 0.012], \"y\": [0, 0.012] } }] }",
        "{ \"dt\": 1e-4, \"mu\": 0.3, \"gravity\": [0.1, 0.2, -0.3], \"walls\": [{ \"box\": { "
        "\"x\": [0, "
        "6e-3],"
        "\"y\": [0, 6e-3], \"z\": [0, null] }, \"name\": \"a\" }, { \"point\": [0, 0, 6e-3], "
        "\"normal\": [0, 0, -1],"
        "\"velocity\": [0, 0, -0.001], \"name\": \"lid\" }], \"room\": { \"walls\": [\"a\", "
        "\"lid\"], \"pressure\": 300,"
        "\"mass\": 4e-3, \"strain_rate\": [0.1, -0.1, 0] },"
        "\"bodies\": [{ \"count\": 64, \"radius\": { \"uniform\": [4e-4, 6e-4] }, \"box\":"
        "{ \"x\": [0, 6e-3], \"y\": [0, 6e-3], \"z\": [0, 6e-3] } }] }"
    };
    struct failure failure = { 0 };
    struct scene sc;
    struct contacts s = { 0 };
    struct report rep = { 0 };
    struct step_opt o = options(&solver_auto, &local_exact, 1e-6);
    must(scene_parse(&sc, text[dim - 2], strlen(text[dim - 2]), NULL, &failure) ||
             scene_build(p, &sc, NULL, &failure),
         &failure);
    scene_free(&sc);
    for (int k = 0; k < 5000 && s.n < 95 + 15 * (dim - 2); k++) run(p, &s, &o, 1, &rep);
    for (int32_t k = 0; k < p->materials * p->materials; k++) p->en[k] = e, p->et[k] = 0.5 * e;
    contacts_free(&s), report_free(&rep);
}

/* Where the tests below take place */
static const struct place {
    const char *name;
    void (*make)(struct packing *p, int dim, double e);
} places[] = { { "under a lid", heap }, { "in a cell", squeezed }, { "in a room", enclosed } };

enum { PLACES = sizeof places / sizeof places[0] };

static double largest_difference(const struct packing *p, const struct packing *q)
{
    double d = 0, v = 0;
    for (int64_t i = 0; i < p->n; i++) {
        d = fmax(d, v3_norm(v3_sub(p->v[i], q->v[i])));
        d = fmax(d, p->radius[i] * v3_norm(v3_sub(p->w[i], q->w[i])));
        v = fmax(v, v3_norm(q->v[i]));
    }
    for (int32_t k = 0; k < p->walls; k++) {
        bool glides = p->wall[k].load.way == LOAD_GLIDES; // else at a distance of 3 mm
        d = fmax(d, (!glides ? 3e-3 : 1) * fabs(p->wall[k].load.speed - q->wall[k].load.speed));
    }
    for (int k = 0; k < 3; k++) d = fmax(d, v3_norm(v3_sub(p->cell.rate[k], q->cell.rate[k])));
    return d / v;
}

/* All solvers and methods make the same step of it. */
static void test_agree(const struct place *where, int dim, double e)
{
    struct failure failure = { 0 };
    struct packing start, first, p;
    struct contacts s = { 0 };
    struct report rep = { 0 };
    where->make(&start, dim, e);
    struct step_opt o = options(&solver_auto, &local_exact, 1e-11);
    must(packing_copy(&first, &start, &failure), &failure);
    run(&first, &s, &o, 1, &rep);
    ok(rep.converged && s.n > 40, "%dD, e %g: %lld contacts %s are solved, %d sweeps", dim, e,
       (long long)s.n, where->name, rep.sweeps);
    for (int m = -1; m < METHOD_COUNT; m++)
        for (int g = 0; solvers[g]; g++) {
            if ((m < 0) == (solvers[g] == &solver_nlgs)) continue;
            o = options(solvers[g], m < 0 ? &local_exact : methods[m], 1e-8);
            must(packing_copy(&p, &start, &failure), &failure);
            run(&p, &s, &o, 1, &rep);
            double d = largest_difference(&p, &first);
            ok(rep.converged && d < 1e-4, "%dD, e %g: so does %s %s (%.1e, natural %.1e)", dim, e,
               solvers[g]->name, m < 0 ? "" : methods[m]->name, d, rep.err.natural);
            packing_free(&p);
        }
    contacts_free(&s), packing_free(&start), packing_free(&first), report_free(&rep);
}

/* m/s: of wall w at x after a step from `arms`; the lever of a room is that where the contacts have acted. */
static vec3 wall_after(const struct packing *p, const struct packing *arms, int32_t w, vec3 x)
{
    const struct load *l = &p->wall[w].load, *was = &arms->wall[w].load;
    if (l->way != LOAD_ROOM) return wall_velocity(p, &p->wall[w], x);
    double lever = wall_lever(arms, &arms->wall[w], arms->t + 0.5 * arms->dt);
    return v3_axpy(wall_velocity(arms, &arms->wall[w], x), (l->speed - was->speed) * lever,
                   l->axis);
}

/* u of every contact, d numbers each, with the velocities that the packing has */
static void contact_velocities(const struct packing *p, const struct packing *arms,
                               const struct contacts *s, double *u)
{
    for (int64_t i = 0; i < s->n; i++) {
        const struct contact *c = &s->c[i];
        vec3 xb = packing_predict(arms, c->b), half[3];
        cell_predict(&arms->cell, 0.5 * arms->dt, half);
        xb = v3_add(xb, cell_shift(half, c->shift));
        vec3 v = v3_add(p->v[c->b], v3_cross(p->w[c->b], v3_sub(c->x, xb)));
        v = v3_add(v, cell_shift(p->cell.rate, c->shift));
        if (c->a < 0)
            v = v3_sub(v, wall_after(p, arms, -1 - c->a, c->x));
        else
            v = v3_sub(v, v3_add(p->v[c->a],
                                 v3_cross(p->w[c->a], v3_sub(c->x, packing_predict(arms, c->a)))));
        const vec3 basis[3] = { c->n, c->t1, contact_t2(c) };
        for (int k = 0; k < p->dim; k++) u[p->dim * i + k] = v3_dot(v, basis[k]);
    }
}

/* W, column by column: what a unit of r_c does to the velocities when everything is moved by it; and q */
static void test_W(const struct place *where, int dim)
{
    struct failure failure = { 0 };
    struct packing p, q;
    struct contacts s = { 0 };
    struct problem problem;
    where->make(&p, dim, 0);
    must(detect_contacts(&s, &p, 0, NULL, &failure) || contacts_alloc_found(&s), &failure);
    must(
        prepare_packing(&problem, &p, &s, true, &(struct prepare_opt){ .rho_factor = 1 }, &failure),
        &failure);
    const struct delassus *W = problem.W;
    size_t size = (size_t)(s.n * dim) + 4;
    double *free_u = calloc(size, 8), *u = calloc(size, 8), *r = calloc(size, 8),
           *v = calloc(size, 8), *zero = calloc(size, 8), worst = 0, worst_q = 0;
    must(packing_copy(&q, &p, &failure) || move_step(&q, &s, NULL, &failure), &failure);
    contact_velocities(&q, &p, &s, free_u);
    packing_free(&q);
    for (int64_t k = 0; k < s.n * dim; k++) worst_q = fmax(worst_q, fabs(W->q[k] - free_u[k]));
    for (int64_t k = 0; k < s.n * dim; k++) {
        double one = p.mass[0], largest = 0, off = 0;
        s.found[k / dim].r[k % dim] = r[k] = one;
        must(packing_copy(&q, &p, &failure) || move_step(&q, &s, NULL, &failure), &failure);
        contact_velocities(&q, &p, &s, u);
        delassus_apply(W, r, zero, v);
        for (int64_t i = 0; i < s.n * dim; i++) {
            off = fmax(off, fabs(u[i] - free_u[i] - v[i]));
            largest = fmax(largest, fabs(v[i]));
        }
        worst = fmax(worst, off / largest);
        s.found[k / dim].r[k % dim] = r[k] = 0;
        packing_free(&q);
    }
    ok(worst < 1e-12 && worst_q < 1e-14 && problem.own,
       "%dD, %s: W is what impulses do, column by column (%.1e), and q what none do (%.1e)", dim,
       where->name, worst, worst_q);
    free(free_u), free(u), free(r), free(v), free(zero);
    problem_free(&problem), contacts_free(&s), packing_free(&p);
}

/* Energy and momentum over steps; back again; as the parts of a step do it */
static void test_balance(const struct place *where, int dim, double e)
{
    struct failure failure = { 0 };
    struct packing p, was;
    struct contacts s = { 0 };
    struct report rep = { 0 };
    struct step_opt o = options(&solver_auto, &local_exact, 1e-4);
    double energy = 0, momentum = 0, back = 0, mass = 0, dissipated = 0;
    where->make(&p, dim, e);
    run(&p, &s, &o, 1, &rep);
    for (int64_t i = 0; i < p.n; i++) mass += p.mass[i];
    for (int k = 0; k < 50; k++) {
        const struct balance b = rep.balance, *n = &rep.balance;
        packing_wrap(&p, NULL); // as the step would begin
        must(packing_copy(&was, &p, &failure), &failure);
        run(&p, &s, &o, 1, &rep);
        // a body that has left the cell is replaced by an image of another velocity
        bool repeats = cell_repeats(&p.cell);
        double change = repeats ? n->change : n->kinetic - b.kinetic,
               work = n->gravity + n->loads + n->drives - n->dissipation;
        double size = n->kinetic + fabs(n->gravity) + fabs(n->loads) + fabs(n->dissipation);
        energy = fmax(energy, fabs(change - work) / size);
        const double g[3] = { p.g.x, p.g.y, p.g.z };
        double off = 0, most = 0;
        for (int j = 0; j < 3 && !repeats; j++) {
            off = fmax(off,
                       fabs(n->momentum[j] - b.momentum[j] - mass * p.dt * g[j] - n->impulse[j]));
            most = fmax(most, fabs(n->impulse[j]));
            // impulses of opposite walls cancel, and what is left is that of falling bodies
            if (where->make == enclosed) most = fmax(most, fabs(b.momentum[j]));
        }
        if (!repeats) momentum = fmax(momentum, off / most);
        dissipated += n->dissipation;
        must(move_back(&p, &s, &failure), &failure);
        back = fmax(back, largest_difference(&p, &was));
        for (int32_t j = 0; j < p.walls; j++)
            back = fmax(back, fabs(p.wall[j].load.travel - was.wall[j].load.travel) / 1e-3);
        must(move_step(&p, &s, NULL, &failure), &failure);
        packing_free(&was);
    }
    ok(energy < 1e-13, "%dD, e %g, %s: energy is balanced in 50 steps (%.1e)", dim, e, where->name,
       energy);
    ok(momentum < 1e-13, "and so is momentum, with the boundary's impulse (%.1e)", momentum);
    ok(back < 1e-9, "move_back() undoes what loads do (%.1e)", back);
    ok(dissipated > 0, "%.3g J are dissipated", dissipated);
    contacts_free(&s), packing_free(&p), report_free(&rep);
}

static void test_threads(void)
{
    struct failure failure = { 0 };
    struct packing start, p[3];
    struct contacts s = { 0 };
    struct report rep = { 0 };
    heap(&start, 3, 0.2);
    for (int k = 0; k < 3; k++) {
        struct step_opt o = options(&solver_auto, &local_exact, 1e-6);
        o.solve.threads = 1 << k, o.order = ORDER_COLOUR;
        must(packing_copy(&p[k], &start, &failure), &failure);
        run(&p[k], &s, &o, 10, &rep);
    }
    size_t size = (size_t)start.n * sizeof *start.v;
    bool same = true;
    for (int k = 1; k < 3; k++)
        same = same && !memcmp(p[k].v, p[0].v, size) && !memcmp(p[k].x, p[0].x, size) &&
               !memcmp(p[k].wall, p[0].wall, (size_t)start.walls * sizeof *start.wall);
    ok(same, "1, 2, 4 threads give the same bits");
    for (int k = 0; k < 3; k++) packing_free(&p[k]);
    contacts_free(&s), packing_free(&start), report_free(&rep);
}

/* Without contacts of a load the problem is the one of bodies, and its bits are those without it. */
static void test_untouched(void)
{
    struct failure failure = { 0 };
    struct packing p[2];
    struct contacts s = { 0 };
    struct report rep = { 0 };
    struct scene sc;
    struct step_opt o = options(&solver_auto, &local_exact, 1e-4);
    for (int k = 0; k < 2; k++) {
        must(scene_paper(&sc, 3, 60, &failure) || scene_build(&p[k], &sc, NULL, &failure),
             &failure);
        scene_free(&sc);
        struct wall *wall = realloc(p[k].wall, (size_t)(p[k].walls + 1) * sizeof *wall);
        must(!wall, &failure);
        p[k].wall = wall;
        wall[p[k].walls++] = wall_plane(v3(0, 0, 1), v3(0, 0, -1), 1);
        if (k) wall[p[k].walls - 1].load = glides(v3(0, 0, 1), 1, 0);
        run(&p[k], &s, &o, 300, &rep);
    }
    ok(s.n > 20 && !memcmp(p[0].x, p[1].x, (size_t)p[0].n * sizeof(vec3)),
       "a load that nothing touches changes no bit of %lld contacts' motion", (long long)s.n);
    for (int k = 0; k < 2; k++) packing_free(&p[k]);
    contacts_free(&s), report_free(&rep);
}

/* What a document may say of a load and must not */
static void test_checks(void)
{
    static const struct {
        const char *what;
        struct load load;
    } bad[] = {
        { "way", { .way = LOAD_WAYS, .axis = { 0, 0, 1 }, .mass = 1 } },
        { "negative way", { .way = -1, .axis = { 0, 0, 1 }, .mass = 1 } },
        { "axis", { .way = LOAD_GLIDES, .axis = { 0, 0, 0.9 }, .mass = 1 } },
        { "mass", { .way = LOAD_GLIDES, .axis = { 0, 0, 1 } } },
        { "infinite mass", { .way = LOAD_GLIDES, .axis = { 0, 0, 1 }, .mass = INFINITY } },
        { "force", { .way = LOAD_GLIDES, .axis = { 0, 0, 1 }, .mass = 1, .force = NAN } },
        { "speed", { .way = LOAD_GLIDES, .axis = { 0, 0, 1 }, .mass = 1, .speed = NAN } },
        { "travel", { .way = LOAD_GLIDES, .axis = { 0, 0, 1 }, .mass = 1, .travel = INFINITY } },
        { "tilt", { .way = LOAD_TURNS, .axis = { 1, 0, 0 }, .mass = 1 } },
    };
    struct packing p;
    stack(&p, 3, 1);
    p.wall[1].load = glides(v3(0, 0, 1), 1, -1);
    struct failure failure = { 0 };
    ok(!packing_check(&p, &failure), "a good load is accepted");
    for (size_t k = 0; k < sizeof bad / sizeof bad[0]; k++) {
        failure = (struct failure){ 0 };
        p.wall[1].load = bad[k].load;
        ok(packing_check(&p, &failure) == EX_DATAERR, "a bad %s is refused: %s", bad[k].what,
           failure.text);
    }
    packing_free(&p);
}

int main(void)
{
    test_checks();
    test_free();
    for (int g = 0; solvers[g]; g++) test_static(3, 1, 2, 7, true, solvers[g], &local_exact);
    for (int m = 0; m < METHOD_COUNT; m++) test_static(3, 1, 2, 7, true, &solver_nlgs, methods[m]);
    for (int dim = 2; dim <= 3; dim++) {
        test_static(dim, 2, 1, 3, false, &solver_auto, &local_exact);
        test_static(dim, 2, 1e-6, 3, true, &solver_auto, &local_exact);
        test_static(dim, 2, 1e6, 3, true, &solver_auto, &local_exact);
    }
    for (int k = 0; k < 4; k++) {
        test_impact(1, k / 3.0, 2, -1);
        test_impact(1e6, k / 3.0, 2, 0);
        test_impact(1e-6, k / 3.0, 2, -3);
    }
    test_plate();
    for (int dim = 2; dim <= 3; dim++) {
        for (int k = 0; k < PLACES; k++) {
            test_W(&places[k], dim);
            for (int e = 0; e < 2; e++)
                test_agree(&places[k], dim, 0.4 * e), test_balance(&places[k], dim, 0.4 * e);
        }
        test_lattice(dim);
    }
    test_threads();
    test_untouched();
    return tap_done();
}
