/* What must hold of whole steps: detection, momentum, energy, closed solutions, agreement. */
#include "contact/detect.h"
#include "scene/scene_build.h"
#include "step/move.h"
#include "step/step.h"
#include "tap.h"

#include <gsl/gsl_rng.h>
#include <stdlib.h>
#include <string.h>

static gsl_rng *rng;

static double uniform(double a, double b)
{
    return a + (b - a) * gsl_rng_uniform(rng);
}

static void must(int failed, struct failure *failure)
{
    if (!failed) return;
    printf("Bail out! %s\n", failure->text);
    exit(1);
}

static struct step_opt options(const struct method *m, double eps, int32_t sweeps)
{
    return (struct step_opt){ .solve = { .global = &solver_nlgs,
                                         .method = m,
                                         .eps = eps,
                                         .max_sweeps = sweeps,
                                         .relax = 1,
                                         .threads = 1,
                                         .local = { .newton_eps = 1e-13, .newton_max = 100 } } };
}

static void scene_file(struct packing *p, const char *path)
{
    struct failure failure = { 0 };
    struct scene s;
    static char text[1 << 16];
    FILE *f = fopen(path, "r");
    size_t n = f ? fread(text, 1, sizeof text, f) : 0;
    if (f) fclose(f);
    must(scene_parse(&s, text, n, NULL, &failure) || scene_build(p, &s, NULL, &failure), &failure);
    scene_free(&s);
}

static void paper(struct packing *p, int dim, int64_t n)
{
    struct failure failure = { 0 };
    struct scene s;
    must(scene_paper(&s, dim, n, &failure) || scene_build(p, &s, NULL, &failure), &failure);
    scene_free(&s);
}

static void run(struct packing *p, struct contacts *c, const struct step_opt *o, int steps)
{
    struct failure failure = { 0 };
    struct report rep = { 0 };
    for (int k = 0; k < steps; k++) must(step_advance(p, c, NULL, o, &rep, &failure), &failure);
    report_free(&rep);
}

/* ---- detection ---- */

/* Balls of very different sizes anywhere, some in one place, some far away, some fixed. */
static void cloud(struct packing *p, int dim, int64_t n, double ratio)
{
    struct failure failure = { 0 };
    must(packing_init(p, dim, n, &failure) || packing_alloc_walls(p, 3, &failure), &failure);
    p->dt = 0.01;
    for (int64_t i = 0; i < n; i++) {
        p->radius[i] = 0.02 * pow(ratio, -gsl_rng_uniform(rng));
        p->mass[i] = gsl_rng_uniform(rng) < 0.1 ? 0 : 1;
        p->inertia[i] = 1;
        p->x[i] = v3(uniform(0, 1), uniform(0, 1), dim == 2 ? 0 : uniform(0, 0.3));
        p->v[i] = v3(uniform(-1, 1), uniform(-1, 1), dim == 2 ? 0 : uniform(-1, 1));
        if (i % 97 == 1) p->x[i] = p->x[i - 1], p->v[i] = p->v[i - 1];
        if (i % 201 == 2) p->x[i].x = i % 2 ? 1e12 : -1e150;
    }
    for (int w = 0; w < 3; w++) p->wall[w] = wall_plane(v3(0, 0, 0), v3(w == 0, w == 1, w == 2), 0);
    if (dim == 2) p->wall[2].n = v3(0, -1, 0), p->wall[2].x = v3(0, 1, 0);
    p->wall[1].v = v3(0, 0.5, 0);
    p->t = 0.02;
}

/* Every pair by brute force, in the order that detection promises; -1 at the first difference. */
static int64_t same_contacts(const struct packing *p, const struct contacts *s, double gap)
{
    int64_t k = 0;
    for (int32_t a = -p->walls; a < p->n; a++)
        for (int32_t b = a < 0 ? 0 : a + 1; b < p->n; b++) {
            vec3 xb = packing_predict(p, b);
            double g;
            bool moves = p->mass[b] > 0 || (a >= 0 && p->mass[a] > 0);
            if (a < 0) {
                const struct wall *w = &p->wall[-1 - a];
                vec3 at = v3_axpy(w->x, p->t + 0.5 * p->dt, w->v);
                g = v3_dot(v3_sub(xb, at), w->n) - p->radius[b];
            } else {
                g = v3_norm(v3_sub(xb, packing_predict(p, a))) - (p->radius[a] + p->radius[b]);
            }
            if (!moves || !(g <= gap)) continue;
            if (k == s->n || s->c[k].a != a || s->c[k].b != b || s->c[k].gap != g) return -1;
            k++;
        }
    return k == s->n ? k : -1;
}

/* Do the neighbours of the steps before serve as well as a search anew? Returns how many steps had
   to search, -1 if one found other contacts. */
static int searches(struct packing *p, int steps, bool leaps)
{
    struct failure failure = { 0 };
    struct report rep = { 0 };
    struct neighbours near = { 0 };
    struct contacts s = { 0 }, kept = { 0 }, anew = { 0 };
    struct step_opt o = options(&local_exact, 1e-6, 200);
    int searched = 0;
    for (int k = 0; k < steps && searched >= 0; k++) {
        vec3 was = near.listed ? near.listed[0] : v3(NAN, 0, 0);
        must(detect_contacts(&kept, p, 0, &near, &failure) ||
                 detect_contacts(&anew, p, 0, NULL, &failure),
             &failure);
        searched += memcmp(&was, &near.listed[0], sizeof was) != 0;
        if (kept.n != anew.n || (kept.n && memcmp(kept.c, anew.c, (size_t)kept.n * sizeof *kept.c)))
            searched = -1;
        must(step_advance(p, &s, NULL, &o, &rep, &failure), &failure);
        if (leaps && k % 7 == 3)
            p->x[k % p->n] = v3_axpy(p->x[(k + 1) % p->n], 1.5e-3, v3(1, 0, 0));
    }
    neighbours_free(&near), report_free(&rep);
    contacts_free(&s), contacts_free(&kept), contacts_free(&anew);
    return searched;
}

static void test_neighbours(void)
{
    for (int dim = 2; dim <= 3; dim++) {
        struct packing p;
        paper(&p, dim, 60);
        int n = searches(&p, 400, false);
        ok(n > 0 && n < 200, "%dD: 400 steps, %d searches: the same contacts as with 400", dim, n);
        packing_free(&p);
        paper(&p, dim, 60);
        n = searches(&p, 200, true);
        ok(n > 0, "%dD: bodies that leap are seen (%d searches)", dim, n);
        packing_free(&p);
    }
}

static void test_detection(void)
{
    for (int dim = 2; dim <= 3; dim++)
        for (int k = 0; k < 8; k++) {
            const double ratios[4] = { 1, 3, 100, 1e4 };
            double gap = k < 4 ? 0 : 0.003;
            struct failure failure = { 0 };
            struct packing p;
            struct contacts s = { 0 };
            cloud(&p, dim, 1500, ratios[k % 4]);
            must(detect_contacts(&s, &p, gap, NULL, &failure), &failure);
            int64_t n = same_contacts(&p, &s, gap);
            ok(n > 20, "%dD, radii 1:%g, gap %g: the grid finds what brute force finds (%lld)", dim,
               ratios[k % 4], gap, (long long)s.n);
            double worst = 0;
            for (int64_t i = 0; i < s.n; i++) {
                const struct contact *c = &s.c[i];
                double across = fabs(v3_dot(c->n, c->t1)),
                       flat = dim == 2 ? contact_t2(c).z - 1 : 0;
                worst = fmax(worst, fmax(across + fabs(flat), fabs(v3_norm(c->t1) - 1)));
            }
            ok(worst < 1e-15 * 4, "%dD: frames are orthonormal (%.1e)", dim, worst);
            contacts_free(&s), packing_free(&p);
        }
}

/* ---- one step ---- */

/* The 500 balls when most have settled, and their contacts with reactions. */
static void settled(struct packing *p, struct contacts *s, int dim, int steps)
{
    struct step_opt o = options(&local_exact, 1e-9, 50);
    o.warm = true, o.solve.relax = 1.4;
    paper(p, dim, 500);
    run(p, s, &o, steps);
}

/* Bodies by the parts that their contacts lie in: a thread's own, or the border's and the rim's */
static void test_halves(const struct problem *q, const struct packing *p)
{
    const struct two_thread_split *h = q->split;
    enum { BORDER = 1, OUTSIDE = 2, INSIDE = 4, RIM = 8 };
    int *parts = calloc((size_t)p->n, sizeof *parts), wrong = 0;
    int64_t ours = 0, theirs = 0;
    for (int64_t i = 0; h && i < q->bundles; i++) {
        int64_t g = 0;
        while (q->group[g + 1] <= i) g++;
        int part = g < h->beyond ? BORDER : g < h->inside ? OUTSIDE : INSIDE;
        if (g >= h->rim && g < h->rest) part = RIM;
        *(part < INSIDE ? &ours : &theirs) += 1;
        const int32_t *both[2] = { bundle_at(q, i)->a, bundle_at(q, i)->b };
        for (int k = 0; k < 2 * BUNDLE; k++)
            if (both[k % 2][k / 2] < p->n) parts[both[k % 2][k / 2]] |= part;
    }
    for (int64_t i = 0; i < p->n; i++) {
        wrong += parts[i] & OUTSIDE && parts[i] & (INSIDE | RIM);
        wrong += parts[i] & BORDER && parts[i] & INSIDE;
    }
    free(parts);
    ok(h && !wrong, "halves: threads share no body but between border and rim (%d do)", wrong);
    ok(20 * llabs(ours - theirs) <= ours + theirs, "halves: %lld and %lld bundles", (long long)ours,
       (long long)theirs); // a plane between layers
}

/* A lattice with enough contacts for two halves */
static void test_lattice(void)
{
    enum { SIDE = 16 };
    struct failure failure = { 0 };
    struct packing p;
    struct problem q;
    struct contacts s = { 0 };
    must(packing_init(&p, 3, SIDE * SIDE * SIDE, &failure), &failure);
    for (int i = 0; i < p.n; i++) {
        p.radius[i] = 0.5, p.x[i] = v3(i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE);
        packing_solid(3, 0.5, 1000, &p.mass[i], &p.inertia[i]);
    }
    must(detect_contacts(&s, &p, 1e-6, NULL, &failure), &failure);
    const struct prepare_opt form = { .rho_factor = 1, .order = ORDER_COLOUR };
    must(problem_prepare(&q, &p, &s, &form, &failure), &failure);
    test_halves(&q, &p);
    problem_free(&q), contacts_free(&s), packing_free(&p);
}

static void test_identity(const struct packing *p, const struct contacts *s)
{
    struct failure failure = { 0 };
    struct problem q;
    struct contacts copy;
    for (int order = ORDER_NATURAL; order <= ORDER_COLOUR; order++) {
        must(contacts_copy(&copy, s), &failure);
        must(problem_prepare(&q, p, &copy,
                             &(struct prepare_opt){ .rho_factor = 1, .order = (enum order)order },
                             &failure),
             &failure);
        must(problem_store(&q, &copy), &failure);
        bool same = true, apart = true;
        for (int64_t i = 0; i < s->n; i++)
            same &= !memcmp(copy.found[i].r, s->found[i].r, sizeof s->found[i].r) &&
                    !memcmp(copy.found[i].u, s->found[i].u, sizeof s->found[i].u);
        ok(same, "order %d: prepare, then store, is the identity", order);
        int64_t rows = 0;
        for (int64_t i = 0; i < q.slots; i++) rows += q.contact[i] >= 0;
        for (int64_t g = 0; g < q.groups; g++)
            for (int64_t i = BUNDLE * q.group[g]; i < BUNDLE * q.group[g + 1]; i++)
                for (int64_t k = BUNDLE * q.group[g]; k < i; k++) {
                    if (q.contact[i] < 0 || q.contact[k] < 0) continue;
                    int32_t a[2] = { slot_bundle(&q, i)->a[slot_lane(i)],
                                     slot_bundle(&q, i)->b[slot_lane(i)] };
                    int32_t b[2] = { slot_bundle(&q, k)->a[slot_lane(k)],
                                     slot_bundle(&q, k)->b[slot_lane(k)] };
                    apart &= a[0] != b[0] && a[0] != b[1] && a[1] != b[0] && a[1] != b[1];
                }
        ok(apart && rows == s->n && q.group[q.groups] == q.bundles,
           "order %d: no two contacts of a group share a body (%lld groups)", order,
           (long long)q.groups);
        if (order == ORDER_COLOUR)
            ok(q.bundles <= (s->n + BUNDLE - 1) / BUNDLE + 1,
               "by colours %lld contacts lie in %lld bundles: few are not full", (long long)s->n,
               (long long)q.bundles);
        problem_free(&q);
        contacts_free(&copy);
    }
}

static vec3 momentum(const struct packing *p)
{
    vec3 sum = { 0 };
    for (int64_t i = 0; i < p->n; i++) sum = v3_axpy(sum, p->mass[i], p->v[i]);
    return sum;
}

/* About the origin, the bodies where they are predicted (there forces act in this step). */
static vec3 spin(const struct packing *p, const vec3 *x)
{
    vec3 sum = { 0 };
    for (int64_t i = 0; i < p->n; i++)
        sum = v3_axpy(v3_axpy(sum, p->mass[i], v3_cross(x[i], p->v[i])), p->inertia[i], p->w[i]);
    return sum;
}

/* A step's change of momentum is what gravity and the walls gave; balls take nothing from balls. */
static void test_momentum(const struct packing *start, const struct method *m)
{
    struct failure failure = { 0 };
    struct packing p;
    struct contacts s = { 0 };
    struct report rep = { 0 };
    struct step_opt o = options(m, 1e-6, 30); // far from converged: it must hold all the same
    must(packing_copy(&p, start, &failure), &failure);
    vec3 *x = malloc((size_t)p.n * sizeof *x);
    double mass = 0, size = 0;
    vec3 force = { 0 }, moment = { 0 }, p0 = momentum(&p);
    for (int64_t i = 0; i < p.n; i++) {
        x[i] = packing_predict(&p, i);
        mass += p.mass[i];
        force = v3_axpy(force, p.mass[i] * p.dt, p.g);
        moment = v3_add(moment, v3_cross(x[i], v3_scale(p.mass[i] * p.dt, p.g)));
    }
    vec3 l0 = spin(&p, x);
    must(step_advance(&p, &s, NULL, &o, &rep, &failure), &failure);
    for (int64_t i = 0; i < s.n; i++) {
        const struct contact *c = &s.c[i];
        const double *f = s.found[i].r;
        vec3 r = v3_axpy(v3_axpy(v3_scale(f[0], c->n), f[1], c->t1), f[2], contact_t2(c));
        size += v3_norm(r);
        if (c->a >= 0) continue;
        force = v3_add(force, r);
        moment = v3_add(moment, v3_cross(c->x, r));
    }
    for (int64_t i = 0; i < p.n; i++) size += p.mass[i] * v3_norm(p.v[i]);
    double lost = v3_norm(v3_sub(v3_sub(momentum(&p), p0), force)) / size;
    double turned = v3_norm(v3_sub(v3_sub(spin(&p, x), l0), moment)) / (size * 0.006);
    ok(lost < 2e-15 && turned < 2e-15,
       "%s: momentum and its moment are balanced to rounding (%.1e, %.1e of all that is there)",
       m->name, lost, turned);
    free(x);
    contacts_free(&s), packing_free(&p), report_free(&rep);
}

static double largest_difference(const struct packing *a, const struct packing *b)
{
    double worst = 0;
    for (int64_t i = 0; i < a->n; i++) worst = fmax(worst, v3_norm(v3_sub(a->v[i], b->v[i])));
    return worst;
}

/* All five methods from the same packing: the same velocities, though the reactions may differ. */
static void test_agreement(const struct packing *start, const char *what)
{
    struct failure failure = { 0 };
    struct packing exact;
    for (int m = 4; m >= 0; m--) {
        struct packing p;
        struct contacts s = { 0 };
        struct report rep = { 0 };
        struct step_opt o = options(methods[m], 1e-11, 100000);
        o.solve.relax = m >= 2 ? 1.5 : 1; // no over-relaxation of what is itself a long step
        must(packing_copy(&p, start, &failure) || step_advance(&p, &s, NULL, &o, &rep, &failure),
             &failure);
        if (m == 4) exact = p;
        double d = largest_difference(&p, &exact);
        ok(rep.converged && d < 1e-8,
           "%s, %s: the same velocities as exact, to %.1e m/s (%d sweeps)", what, methods[m]->name,
           d, rep.sweeps);
        if (m != 4) packing_free(&p);
        contacts_free(&s), report_free(&rep);
    }
    packing_free(&exact);
}

static bool same_motion(const struct packing *a, const struct packing *b)
{
    size_t n = (size_t)a->n;
    return !memcmp(a->x, b->x, n * sizeof *a->x) && !memcmp(a->v, b->v, n * sizeof *a->v) &&
           !memcmp(a->w, b->w, n * sizeof *a->w) && !memcmp(a->q, b->q, n * sizeof *a->q);
}

/* Threads, and the way the criterion is evaluated, leave every bit and every count as it is. */
static void test_threads(const struct packing *start)
{
    struct failure failure = { 0 };
    for (int order = ORDER_NATURAL; order <= ORDER_COLOUR; order++) {
        struct packing one;
        int32_t sweeps = 0;
        for (int k = 0; k < 4; k++) { // 1, 2, 4 threads; every sweep
            struct packing p;
            struct contacts s = { 0 };
            struct report rep = { 0 };
            struct step_opt o = options(&local_exact, 1e-5, 20000);
            o.order = (enum order)order;
            o.solve.threads = k < 3 ? 1 << k : 1;
            o.solve.every_sweep = k == 3;
            must(packing_copy(&p, start, &failure) ||
                     step_advance(&p, &s, NULL, &o, &rep, &failure),
                 &failure);
            if (k == 0)
                one = p, sweeps = rep.sweeps;
            else
                ok(same_motion(&p, &one) && rep.sweeps == sweeps,
                   "order %d: the same bits and the same %d sweeps %s", order, sweeps,
                   k == 1   ? "with 2 threads"
                   : k == 2 ? "with 4 threads"
                            : "with the criterion evaluated after every one");
            if (k) packing_free(&p);
            contacts_free(&s), report_free(&rep);
        }
        packing_free(&one);
    }
}

/* ---- many steps ---- */

static double energy(const struct packing *p)
{
    double e = 0;
    for (int64_t i = 0; i < p->n; i++)
        e += 0.5 * (p->mass[i] * v3_dot(p->v[i], p->v[i]) +
                    p->inertia[i] * v3_dot(p->w[i], p->w[i])) -
             p->mass[i] * v3_dot(p->g, p->x[i]);
    return e;
}

/*
 * With e = 0 a step changes the energy by r.(u^- + u^+)/2 = r.u^+ - r.W r/2 - dt r.P*g/2, and the
 * law makes r.u^+ <= 0. Without gravity it never grows. With gravity a body that was leaving, slower
 * than g dt, may be caught: the midpoint rule then gains of the order of m (g dt)^2, which is 2e-8
 * of what the pile has, and no more.
 */
static void test_energy(int dim, bool gravity)
{
    struct packing p;
    struct contacts s = { 0 };
    struct step_opt o = options(&local_exact, 1e-12, 1000);
    double mass = 0;
    o.warm = true, o.solve.relax = 1.5;
    paper(&p, dim, 30);
    if (!gravity) {
        p.g = v3(0, 0, 0);
        for (int64_t i = 0; i < p.n; i++)
            p.v[i] = v3(uniform(-1, 1), uniform(-1, 1), dim == 2 ? 0 : uniform(-1, 1));
    }
    for (int64_t i = 0; i < p.n; i++) mass += p.mass[i];
    double before = energy(&p), first = before, worst = -INFINITY;
    for (int k = 0; k < 700; k++) {
        run(&p, &s, &o, 1);
        double now = energy(&p);
        worst = fmax(worst, now - before);
        before = now;
    }
    double gdt = v3_norm(p.g) * p.dt, most = 0.5 * mass * gdt * gdt + 1e-14 * first;
    ok(worst <= most && before < 0.7 * first,
       "%dD, %s gravity: energy never grows with e = 0 (%.1e of it, may be %.1e; %.2g of it left)",
       dim, gravity ? "with" : "without", worst / first, most / first, before / first);
    contacts_free(&s), packing_free(&p);
}

/*
 * Example 1: v = v0 - mu g t and w = (5/2) mu g t/R until t = 2 v0/(7 mu g), then v = 5/7 v0 rolls;
 * of a disc 2 becomes 3: w = 2 mu g t/R, t = v0/(3 mu g), v = 2/3 v0.
 */
static void test_rolling(int dim, const struct method *m)
{
    struct packing p;
    struct contacts s = { 0 };
    struct step_opt o = options(m, 1e-12, 5000);
    scene_file(&p, dim == 3 ? "scenes/paper/example1.json" : "scenes/paper/example1-2d.json");
    double v0 = 1.5, mu = 0.7, g = 9.81, R = 5e-3, worst = 0;
    double share = dim == 3 ? 2.0 / 7 : 1.0 / 3, until = share * v0 / (mu * g);
    for (int k = 1; k <= 2000; k++) {
        run(&p, &s, &o, 1);
        double t = k * p.dt, v = t < until ? v0 - mu * g * t : (1 - share) * v0;
        double w = (dim == 3 ? 2.5 : 2) * mu * g * fmin(t, until) / R;
        worst = fmax(worst, fabs(p.v[0].x - v) / v0);
        worst = fmax(worst, fabs((dim == 3 ? p.w[0].y : -p.w[0].z) - w) * R / v0);
    }
    ok(worst <= mu * g * p.dt / v0,
       "example 1 in %dD, %s: slides, then rolls at %s v0, all to one dt (%.1e of v0)", dim,
       m->name, dim == 3 ? "5/7" : "2/3", worst);
    contacts_free(&s), packing_free(&p);
}

/* A ball dropped on a floor with e_n leaves with e_n times the speed; e_t likewise, sticking. */
static void test_restitution(double en, double et)
{
    struct failure failure = { 0 };
    struct packing p;
    struct contacts s = { 0 };
    struct step_opt o = options(&local_exact, 1e-14, 1000);
    must(packing_init(&p, 3, 1, &failure) || packing_alloc_walls(&p, 1, &failure), &failure);
    p.dt = 1e-3, p.radius[0] = 0.5;
    packing_solid(3, 0.5, 1000, &p.mass[0], &p.inertia[0]);
    p.wall[0].n = v3(0, 0, 1);
    p.x[0] = v3(0, 0, 0.5), p.v[0] = v3(0.3, -0.1, -2);
    p.mu[0] = 5, p.en[0] = en, p.et[0] = et;
    run(&p, &s, &o, 1);
    vec3 arm = v3(0, 0, -(0.5 - 0.5 * p.dt * 2)); // of the predicted position
    vec3 slip = v3_add(p.v[0], v3_cross(p.w[0], arm));
    ok(fabs(p.v[0].z - 2 * en) < 1e-12 && fabs(slip.x + 0.3 * et) < 1e-12 &&
           fabs(slip.y - 0.1 * et) < 1e-12,
       "e_n %g, e_t %g: the ball rebounds, and so does its point of contact", en, et);
    contacts_free(&s), packing_free(&p);
}

/* Balls that meet in the plane z = 0 of space do what the same in dim 2 does. */
static void test_plane(void)
{
    struct failure failure = { 0 };
    struct packing p[2];
    struct contacts s[2] = { { 0 }, { 0 } };
    struct step_opt o = options(&local_ebp, 1e-12, 20000);
    for (int k = 0; k < 2; k++) {
        paper(&p[k], 2, 30);
        p[k].dim = 2 + k;
        run(&p[k], &s[k], &o, 600);
    }
    double d = largest_difference(&p[0], &p[1]);
    ok(d < 1e-9 && s[0].n > 20, "30 discs, 600 steps: dim 2 and dim 3 agree to %.1e m/s", d);
    (void)failure;
    for (int k = 0; k < 2; k++) contacts_free(&s[k]), packing_free(&p[k]);
}

static void test_unmove(const struct packing *start)
{
    struct failure failure = { 0 };
    struct packing p;
    struct contacts s = { 0 };
    struct step_opt o = options(&local_exact, 1e-8, 2000);
    must(packing_copy(&p, start, &failure), &failure);
    run(&p, &s, &o, 1);
    must(move_back(&p, &s, &failure), &failure);
    double dx = 0, dv = largest_difference(&p, start);
    for (int64_t i = 0; i < p.n; i++) dx = fmax(dx, v3_norm(v3_sub(p.x[i], start->x[i])));
    ok(dx < 1e-16 && dv < 1e-14 && p.step == start->step, "unmove undoes move (%.1e m, %.1e m/s)",
       dx, dv);
    contacts_free(&s), packing_free(&p);
}

/* Beside libm's sine and cosine as far as an angle has a meaning; of length 1 also beyond, for solves
   that diverge. */
static void test_rotation(void)
{
    double worst = 0, length = 0;
    for (double angle = 1e-9; angle < 1e150; angle *= 1.7) {
        quat q = quat_rotation(v3(0.6 * angle, 0, 0.8 * angle));
        double sine = sin(angle / 2), d = fmax(fabs(q.x - 0.6 * sine), fabs(q.z - 0.8 * sine));
        if (angle < 1e3) worst = fmax(worst, fmax(d, fabs(q.w - cos(angle / 2))));
        length = fmax(length, fabs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1));
    }
    ok(worst < 1e-12 && length < 1e-14, "rotations: libm's to %.1e, of length 1 to %.1e", worst,
       length);
}

int main(void)
{
    rng = gsl_rng_alloc(gsl_rng_mt19937);
    test_rotation();
    test_detection();
    test_neighbours();
    for (int m = 0; methods[m]; m++) test_rolling(3, methods[m]), test_rolling(2, methods[m]);
    for (int k = 0; k < 5; k++) test_restitution(0.25 * k, 1 - 0.25 * k);
    test_plane();
    test_lattice();
    for (int dim = 2; dim <= 3; dim++) {
        struct packing p;
        struct contacts s = { 0 };
        settled(&p, &s, dim, 900);
        diag("%dD: %lld contacts after 900 steps", dim, (long long)s.n);
        test_identity(&p, &s);
        for (int m = 0; methods[m]; m++) test_momentum(&p, methods[m]);
        test_threads(&p);
        test_unmove(&p);
        contacts_free(&s), packing_free(&p);
        test_energy(dim, true), test_energy(dim, false);
    }
    for (int dim = 2; dim <= 3; dim++) {
        struct packing p;
        struct contacts s = { 0 };
        struct step_opt o = options(&local_exact, 1e-10, 1000);
        o.warm = true;
        paper(&p, dim, 20);
        run(&p, &s, &o, 1200);
        test_agreement(&p, dim == 2 ? "20 discs, settled" : "20 balls, settled");
        contacts_free(&s), packing_free(&p);
    }
    gsl_rng_free(rng);
    return tap_done();
}
