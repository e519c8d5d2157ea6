/* What must hold where the cell repeats: detection among images, and motion that knows no border. */
#include "contact/detect.h"
#include "scene/scene_build.h"
#include "solve/assembly.h"
#include "state/placement.h"
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

static void repeat(struct packing *p, const vec3 *edge, const bool *repeats)
{
    struct failure failure = { 0 };
    for (int k = 0; k < 3; k++) p->cell.edge[k] = edge[k], p->cell.repeats[k] = repeats[k];
    must(packing_alloc_images(p, &failure), &failure);
}

static void set_gradient(struct packing *p, const double L[3][3])
{
    struct cell *c = &p->cell;
    if (!c->gradient) c->gradient = calloc(1, sizeof *c->gradient);
    c->gradients = 1;
    memcpy(c->gradient[0].L, L, sizeof c->gradient[0].L);
    cell_set_rate(c, p->t);
}

/* Exactly so many sweeps, whatever comes of them: runs that differ by rounding stay comparable. */
static struct step_opt sweeps(int32_t n)
{
    return (struct step_opt){ .warm = true,
                              .order = ORDER_NATURAL,
                              .solve = { .global = &solver_nlgs,
                                         .method = &local_exact,
                                         .eps = 0,
                                         .max_sweeps = n,
                                         .relax = 1,
                                         .threads = 1,
                                         .local = { .newton_eps = 1e-13, .newton_max = 100 } } };
}

static void run(struct packing *p, struct contacts *s, const struct step_opt *o, int steps)
{
    struct failure failure = { 0 };
    struct report rep = { 0 };
    struct step_memory memory = { 0 };
    for (int k = 0; k < steps; k++) must(step_advance(p, s, &memory, o, &rep, &failure), &failure);
    step_forget(&memory), report_free(&rep);
}

/* Where a body has got to, its images counted */
static vec3 way(const struct packing *p, int64_t i)
{
    vec3 x = p->x[i];
    for (int k = 0; k < 3; k++) x = v3_axpy(x, p->image[i][k], p->cell.edge[k]);
    return x;
}
/* and the velocity that belongs to it */
static vec3 way_velocity(const struct packing *p, int64_t i)
{
    vec3 v = p->v[i];
    for (int k = 0; k < 3; k++) v = v3_axpy(v, p->image[i][k], p->cell.rate[k]);
    return v;
}

/* ---- detection ---- */

/* Bodies of sizes 1:ratio anywhere in an oblique cell whose largest body just about fits */
static void cloud(struct packing *p, int dim, int64_t n, double ratio, double largest,
                  const bool *repeats)
{
    struct failure failure = { 0 };
    must(packing_init(p, dim, n, &failure), &failure);
    vec3 edge[3] = { v3(1, uniform(-0.3, 0.3), dim == 2 ? 0 : uniform(-0.3, 0.3)),
                     v3(uniform(-0.6, 0.6), 0.8, dim == 2 ? 0 : uniform(-0.3, 0.3)), v3(0, 0, 1) };
    if (dim == 3) edge[2] = v3(uniform(-0.5, 0.5), uniform(-0.5, 0.5), 0.7);
    repeat(p, edge, repeats);
    p->cell.origin = v3(uniform(-3, 3), uniform(-3, 3), dim == 2 ? 0 : uniform(-3, 3));
    double height[3], least = 1;
    cell_heights(&p->cell, height);
    for (int k = 0; k < dim; k++) least = fmin(least, height[k]);
    p->dt = 0.01;
    for (int64_t i = 0; i < n; i++) {
        p->radius[i] = 0.49 * least * largest * pow(ratio, i ? -gsl_rng_uniform(rng) : 0);
        p->mass[i] = gsl_rng_uniform(rng) < 0.1 ? 0 : 1;
        p->inertia[i] = 1;
        p->x[i] = p->cell.origin;
        for (int k = 0; k < dim; k++) p->x[i] = v3_axpy(p->x[i], uniform(-1, 2), edge[k]);
        p->v[i] = v3(uniform(-1, 1), uniform(-1, 1), dim == 2 ? 0 : uniform(-1, 1));
    }
    for (int k = 0; k < dim; k++)
        p->cell.rate[k] = v3(uniform(-1, 1), uniform(-1, 1), dim == 2 ? 0 : uniform(-1, 1));
    packing_wrap(p, NULL);
}

/* Every pair and every image of it by brute force, in the order that detection promises; how many are
   of pairs seen before. -1 at the first difference. */
static int64_t same_contacts(const struct packing *p, const struct contacts *s, double gap,
                             int64_t *again)
{
    int64_t n = 0;
    int m[3];
    vec3 edge[3];
    cell_predict(&p->cell, 0.5 * p->dt, edge);
    for (int k = 0; k < 3; k++) m[k] = p->cell.repeats[k] ? 3 : 0;
    *again = 0;
    for (int32_t a = 0; a < p->n; a++)
        for (int32_t b = a + 1; b < p->n; b++) {
            vec3 d = v3_sub(packing_predict(p, b), packing_predict(p, a));
            int64_t before = n;
            if (!(p->mass[a] > 0 || p->mass[b] > 0)) continue;
            for (int i = -m[0]; i <= m[0]; i++)
                for (int j = -m[1]; j <= m[1]; j++)
                    for (int k = -m[2]; k <= m[2]; k++) {
                        const int8_t shift[3] = { (int8_t)i, (int8_t)j, (int8_t)k };
                        vec3 e = v3_add(d, cell_shift(edge, shift));
                        double g = v3_norm(e) - (p->radius[a] + p->radius[b]);
                        if (!(g <= gap)) continue;
                        const struct contact *c = &s->c[n];
                        if (n == s->n || c->a != a || c->b != b || c->gap != g ||
                            memcmp(c->shift, shift, sizeof shift) != 0)
                            return -1;
                        n++;
                    }
            *again += n > before + 1;
        }
    return n == s->n ? n : -1;
}

static void test_detection(void)
{
    int64_t twice = 0, border = 0;
    for (int dim = 2; dim <= 3; dim++)
        for (int k = 0; k < 12; k++) {
            const double ratios[4] = { 1, 3, 30, 100 };
            const bool repeats[3] = { k % 3 != 1, k % 3 != 2, dim == 3 && k % 3 == 0 };
            // few large bodies, which touch their neighbours on both sides, or many
            double ratio = ratios[k % 4], largest = k < 6 ? 1 : 0.3, gap = k % 2 ? 0.003 : 0;
            struct failure failure = { 0 };
            struct packing p;
            struct contacts s = { 0 };
            int64_t again;
            cloud(&p, dim, k < 6 ? 60 : 500, ratio, largest, repeats);
            must(detect_contacts(&s, &p, gap, NULL, &failure), &failure);
            int64_t n = same_contacts(&p, &s, gap, &again), across = 0;
            for (int64_t i = 0; i < s.n; i++)
                across += s.c[i].shift[0] || s.c[i].shift[1] || s.c[i].shift[2];
            twice += again, border += across;
            ok(n > 0,
               "%dD, radii 1:%g, repeats %d%d%d: what brute force finds (%lld, %lld across, %lld "
               "pairs twice)",
               dim, ratio, repeats[0], repeats[1], repeats[2], (long long)n, (long long)across,
               (long long)again);
            contacts_free(&s), packing_free(&p);
        }
    ok(twice > 1000 && border > 5000,
       "among them pairs that meet across the border (%lld), and on two "
       "sides (%lld)",
       (long long)border, (long long)twice);
}

static void test_bound(void)
{
    const bool all[3] = { true, true, false };
    struct failure failure = { 0 };
    struct packing p;
    struct contacts s = { 0 };
    cloud(&p, 2, 10, 1, 1, all);
    ok(!detect_contacts(&s, &p, 0, NULL, &failure), "a body that fits into the cell is one");
    p.radius[3] *= 1.1;
    ok(detect_contacts(&s, &p, 0, NULL, &failure) == EX_DATAERR &&
           strstr(failure.text, "touch itself"),
       "a body larger than the cell is refused: %s", failure.text);
    contacts_free(&s), packing_free(&p);
}

/* ---- a dense packing under shear ---- */

/* Discs or balls compressed in a cube until they touch everywhere, with friction */
static void dense(struct packing *p, struct contacts *s, int dim, double e)
{
    char text[800];
    struct failure failure = { 0 };
    struct scene scene;
    snprintf(
        text, sizeof text,
        "{ \"dim\": %d, \"dt\": 1e-3, \"mu\": 0.4, \"e_n\": 0, \"gravity\": [0, 0%s],"
        "  \"cell\": { \"lengths\": [1, 1%s], \"affine\": true, \"gradient\": %s },"
        "  \"bodies\": [{ \"count\": %d, \"radius\": { \"uniform\": [%g, %g] }, \"spacing\": 1,"
        "                 \"box\": { \"x\": [0, 1], \"y\": [0, 1]%s } }] }",
        dim, dim == 2 ? "" : ", 0", dim == 2 ? "" : ", 1",
        dim == 2 ? "[[-0.5, 0], [0, -0.5]]" : "[[-0.5, 0, 0], [0, -0.5, 0], [0, 0, -0.5]]",
        dim == 2 ? 100 : 125, dim == 2 ? 0.035 : 0.07, dim == 2 ? 0.05 : 0.1,
        dim == 2 ? "" : ", \"z\": [0, 1]");
    must(scene_parse(&scene, text, strlen(text), NULL, &failure) ||
             scene_build(p, &scene, NULL, &failure),
         &failure);
    scene_free(&scene);
    struct step_opt o = sweeps(30);
    run(p, s, &o, dim == 2 ? 350 : 420);
    const double shear[3][3] = { { 0, 1, 0 } };
    set_gradient(p, shear);
    for (int k = 0; k < p->materials * p->materials; k++) p->en[k] = p->et[k] = e;
}

/* Runs both; the largest distance of a body from where the other packing has it, relative to a third */
static double apart(struct packing *p, struct packing *q, const struct step_opt *o, int steps,
                    int64_t *contacts)
{
    struct contacts s = { 0 }, t = { 0 };
    double worst = 0;
    vec3 *start = malloc((size_t)p->n * sizeof *start);
    for (int64_t i = 0; i < p->n; i++) start[i] = v3_sub(way(p, i), way(q, i));
    run(p, &s, o, steps), run(q, &t, o, steps);
    for (int64_t i = 0; i < p->n; i++) {
        vec3 d = v3_sub(v3_sub(way(p, i), way(q, i)), start[i]);
        worst = fmax(worst, v3_norm(d));
    }
    *contacts = s.n == t.n ? s.n : -1;
    free(start);
    contacts_free(&s), contacts_free(&t);
    return worst;
}

static void test_cuts(int dim, double e)
{
    struct failure failure = { 0 };
    struct packing p, q;
    struct contacts s = { 0 };
    struct step_opt o = sweeps(40);
    int64_t n;
    dense(&p, &s, dim, e);
    diag("%dD: %lld bodies, %lld contacts", dim, (long long)p.n, (long long)s.n);

    struct packing start;
    must(packing_copy(&start, &p, &failure) || packing_copy(&q, &p, &failure), &failure);
    q.cell.origin = v3(0.313, 0.117, dim == 2 ? 0 : 0.41);
    packing_wrap(&q, NULL);
    int64_t moved = 0;
    for (int64_t i = 0; i < q.n; i++) moved += memcmp(&q.x[i], &p.x[i], sizeof p.x[i]) != 0;
    double d = apart(&p, &q, &o, 200, &n);
    ok(d < 1e-8 && n > p.n / 10 && moved > p.n / 4,
       "%dD, e %g: 200 steps of shear do not depend on the cell's origin (%.1e m, %lld contacts)",
       dim, e, d, (long long)n);
    packing_free(&p), packing_free(&q);

    // the same lattice by another edge, not so oblique as to be cut; images are counted anew
    must(packing_copy(&p, &start, &failure), &failure);
    double side = p.cell.edge[0].x;
    run(&p, &s, &o, 720); // at 750 it leans too far
    must(packing_copy(&q, &p, &failure), &failure);
    q.cell.edge[1] = v3_axpy(q.cell.edge[1], -1, q.cell.edge[0]);
    memset(q.image, 0, (size_t)q.n * sizeof *q.image);
    memset(p.image, 0, (size_t)p.n * sizeof *p.image);
    memory_free(&p.memory), memory_free(&q.memory); // its shifts count the other edges
    d = apart(&p, &q, &o, 100, &n);
    ok(fabs(p.cell.edge[1].x + 0.18 * side) < 1e-9 && fabs(q.cell.edge[1].x + 0.18 * side) < 1e-9,
       "%dD: one of two cells has been cut, the other not", dim);
    ok(d < 1e-8 && n > p.n / 10,
       "%dD, e %g: nor on its edges, nor on when they are cut (%.1e m, %lld contacts)", dim, e, d,
       (long long)n);
    packing_free(&p), packing_free(&q);

    // far beyond where the cell is cut, from the bodies' ways alone
    must(packing_copy(&p, &start, &failure), &failure);
    vec3 sum = v3(0, 0, 0), after = sum;
    double size = 0;
    for (int64_t i = 0; i < p.n; i++) sum = v3_axpy(sum, p.mass[i], way_velocity(&p, i));
    run(&p, &s, &o, 300);
    for (int64_t i = 0; i < p.n; i++) {
        after = v3_axpy(after, p.mass[i], way_velocity(&p, i));
        size += p.mass[i] * v3_norm(p.v[i]);
    }
    d = v3_norm(v3_sub(after, sum)) / size;
    ok(d < 1e-13, "%dD, e %g: momentum is kept (%.1e of all that is there)", dim, e, d);
    packing_free(&p), packing_free(&start), contacts_free(&s);
}

/* The list of neighbours that is kept gives the same contacts as a search at each step. */
static void test_neighbours(int dim)
{
    struct failure failure = { 0 };
    struct packing p;
    struct contacts s = { 0 }, kept = { 0 }, anew = { 0 };
    struct neighbours near = { 0 };
    struct step_opt o = sweeps(20);
    struct report rep = { 0 };
    int searched = 0, same = 0, steps = 900, cuts = 0;
    dense(&p, &s, dim, 0);
    const double shear[3][3] = { { 0, 1.3, 0 } };
    set_gradient(&p, shear);
    for (int k = 0; k < steps; k++) {
        vec3 was = near.listed ? near.listed[0] : v3(NAN, 0, 0);
        double lean = p.cell.edge[1].x;
        must(step_advance(&p, &s, NULL, &o, &rep, &failure), &failure);
        packing_wrap(&p, &s);
        cuts += p.cell.edge[1].x < lean;
        must(detect_contacts(&kept, &p, 0, &near, &failure) ||
                 detect_contacts(&anew, &p, 0, NULL, &failure),
             &failure);
        searched += memcmp(&was, &near.listed[0], sizeof was) != 0;
        same += kept.n == anew.n &&
                !memcmp(kept.c, anew.c, (size_t)(kept.n ? kept.n : 1) * sizeof *kept.c);
    }
    ok(same == steps && cuts > 0 && searched < steps / 3,
       "%dD: %d steps, %d searches, %d cuts: the same contacts as with %d", dim, steps, searched,
       cuts, steps);
    neighbours_free(&near), report_free(&rep);
    contacts_free(&s), contacts_free(&kept), contacts_free(&anew), packing_free(&p);
}

/* ---- one step ---- */

static void test_back(int dim)
{
    struct failure failure = { 0 };
    struct packing p, q;
    struct contacts s = { 0 };
    struct step_opt o = sweeps(30);
    dense(&p, &s, dim, 0.5);
    packing_wrap(&p, &s);
    must(packing_copy(&q, &p, &failure), &failure);
    run(&q, &s, &o, 1);
    must(move_back(&q, &s, &failure), &failure);
    double worst = 0;
    for (int64_t i = 0; i < p.n; i++)
        worst = fmax(worst, v3_norm(v3_sub(p.x[i], q.x[i])) + v3_norm(v3_sub(p.v[i], q.v[i])));
    for (int k = 0; k < 3; k++)
        worst = fmax(worst, v3_norm(v3_sub(p.cell.edge[k], q.cell.edge[k])) +
                                v3_norm(v3_sub(p.cell.rate[k], q.cell.rate[k])));
    ok(worst < 1e-13, "%dD: a step taken back is not made, to rounding (%.1e)", dim, worst);
    packing_free(&p), packing_free(&q), contacts_free(&s);
}

/* u = W r + q of the assembled problem, against velocities computed by hand */
static void test_assembly(int dim)
{
    struct failure failure = { 0 };
    struct packing p;
    struct contacts s = { 0 }, t = { 0 };
    struct problem q;
    struct assembly A;
    dense(&p, &s, dim, 0.5);
    p.g = v3(0, -3, 0);
    packing_wrap(&p, &s);
    must(detect_contacts(&t, &p, 0, NULL, &failure) ||
             problem_prepare(&q, &p, &t, &(struct prepare_opt){ .rho_factor = 1 }, &failure) ||
             assembly_init(&A, &q, &failure),
         &failure);
    double worst = 0;
    int64_t across = 0;
    vec3 edge[3];
    cell_predict(&p.cell, 0.5 * p.dt, edge);
    for (int64_t i = 0; i < t.n; i++) {
        const struct contact *c = &t.c[i];
        vec3 image = v3(0, 0, 0), rate = image;
        for (int k = 0; k < 3; k++) {
            image = v3_axpy(image, c->shift[k], edge[k]);
            rate = v3_axpy(rate, c->shift[k], p.cell.rate[k]); // constant in simple shear
        }
        across += v3_norm(rate) > 0;
        vec3 xa = packing_predict(&p, c->a), xb = v3_add(packing_predict(&p, c->b), image);
        vec3 va = v3_add(p.v[c->a], v3_cross(p.w[c->a], v3_sub(c->x, xa)));
        vec3 vb = v3_add(p.v[c->b], v3_cross(p.w[c->b], v3_sub(c->x, xb)));
        vec3 u = v3_add(v3_sub(vb, va), rate); // gravity does not count between two that fall
        for (int k = 0; k < dim; k++) {
            vec3 axis = k == 0 ? c->n : k == 1 ? c->t1 : contact_t2(c);
            worst = fmax(worst, fabs(A.q[dim * i + k] - 1.5 * v3_dot(axis, u)));
        }
    }
    ok(worst < 1e-13 && across > 0,
       "%dD: q of contacts across the border has the rate of the edges (%.1e m/s, %lld contacts)",
       dim, worst, (long long)across);
    assembly_free(&A), problem_free(&q);
    contacts_free(&s), contacts_free(&t), packing_free(&p);
}

/* ---- few bodies ---- */

static void balls(struct packing *p, int64_t n)
{
    struct failure failure = { 0 };
    const bool all[3] = { true, true, true };
    const vec3 edge[3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
    must(packing_init(p, 3, n, &failure), &failure);
    p->dt = 1e-3, p->mu[0] = 0.3, p->en[0] = 0.6, p->et[0] = 0.2;
    for (int64_t i = 0; i < n; i++) {
        p->radius[i] = 0.1;
        packing_solid(3, 0.1, 1000, &p->mass[i], &p->inertia[i]);
    }
    repeat(p, edge, all);
}

/* A collision across the border is the collision inside. */
static void test_collision(void)
{
    double worst = 0;
    bool met = true;
    for (int trial = 0; trial < 20; trial++) {
        struct packing p[2];
        struct step_opt o = sweeps(50);
        vec3 way_off = v3(uniform(-0.5, 0.5), uniform(-0.5, 0.5), uniform(-0.5, 0.5));
        vec3 d = v3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
        vec3 w[2] = { v3(uniform(-9, 9), uniform(-9, 9), 1), v3(uniform(-9, 9), 2, 3) };
        d = v3_scale(1 / v3_norm(d), d);
        for (int k = 0; k < 2; k++) {
            struct contacts s = { 0 };
            balls(&p[k], 2);
            vec3 middle = k ? v3_add(v3(0.5, 0.5, 0.5), way_off) : v3(0.5, 0.5, 0.5);
            for (int i = 0; i < 2; i++) {
                p[k].x[i] = v3_axpy(middle, i ? 0.13 : -0.13, d);
                p[k].v[i] = v3_scale(i ? -1 : 1, v3_add(d, v3(0.1, 0.05, -0.1)));
                p[k].w[i] = w[i];
            }
            packing_wrap(&p[k], NULL);
            run(&p[k], &s, &o, 80);
            contacts_free(&s);
        }
        for (int i = 0; i < 2; i++) {
            worst = fmax(worst, v3_norm(v3_sub(p[0].v[i], p[1].v[i])));
            worst = fmax(worst, 0.1 * v3_norm(v3_sub(p[0].w[i], p[1].w[i])));
            met = met && v3_norm(v3_sub(p[0].w[i], w[i])) > 1e-3;
        }
        packing_free(&p[0]), packing_free(&p[1]);
    }
    ok(worst < 1e-13 && met, "20 collisions across the border are those inside (%.1e m/s)", worst);
}

/* Lees and Edwards: a free ball goes straight on, and what is seen of it changes by the rate. */
static void test_shear_of_one(void)
{
    const double shear[3][3] = { { 0, 2, 0 } };
    struct packing p;
    struct contacts s = { 0 };
    struct step_opt o = sweeps(1);
    balls(&p, 1);
    set_gradient(&p, shear);
    p.x[0] = v3(0.3, 0.9, 0.5), p.v[0] = v3(0.7, 1, 0);
    run(&p, &s, &o, 201); // the last begins with the border crossed
    double t = 201 * p.dt;
    bool moved = fabs(p.v[0].x - (0.7 - 2)) < 1e-13 && p.v[0].y == 1 && p.image[0][1] == 1;
    ok(moved, "a ball across the border of a sheared cell is %.3g m/s faster, by the rate -2",
       p.v[0].x - 0.7);
    double off = v3_norm(v3_sub(way(&p, 0), v3(0.3 + 0.7 * t, 0.9 + t, 0.5)));
    run(&p, &s, &o, 3000);
    t = 3201 * p.dt;
    double later = v3_norm(v3_sub(way(&p, 0), v3(0.3 + 0.7 * t, 0.9 + t, 0.5)));
    ok(off < 1e-13 && later < 1e-11 && fabs(p.cell.edge[1].x) < 0.76,
       "its way is straight, though the cell is cut (%.1e m, after 3 borders and 6 cuts %.1e m)",
       off, later);
    contacts_free(&s), packing_free(&p);
}

/* The edges under compression: the midpoint rule's closed form, second order in dt */
static void test_compression(void)
{
    const double L[3][3] = { { -0.7, 0, 0 }, { 0, -0.7, 0 }, { 0, 0, -0.7 } };
    struct packing p;
    struct contacts s = { 0 };
    struct step_opt o = sweeps(1);
    balls(&p, 0);
    set_gradient(&p, L);
    run(&p, &s, &o, 500);
    double h = 0.7 * p.dt / 2, closed = pow((1 - h) / (1 + h), 500), exact = exp(-0.7 * 0.5);
    double off = 0;
    for (int k = 0; k < 3; k++) {
        const double e[3] = { p.cell.edge[k].x, p.cell.edge[k].y, p.cell.edge[k].z };
        for (int i = 0; i < 3; i++) off = fmax(off, fabs(e[i] - (i == k ? closed : 0)));
    }
    ok(off < 1e-13 && fabs(closed - exact) < 1e-7,
       "compressed edges follow the midpoint rule (%.1e), which is near exp(-a t) (%.1e)", off,
       fabs(closed - exact));
    packing_free(&p);

    contacts_free(&s);
}

/* A lattice that moves with a cell under any gradient, changing in time, stays the cell's lattice. */
static void test_lattice(void)
{
    struct failure failure = { 0 };
    struct packing p, q;
    struct contacts s = { 0 };
    struct step_opt o = sweeps(1);
    enum { N = 4, STEPS = 400 };
    balls(&p, N * N * N);
    p.cell.gradient = calloc(2, sizeof *p.cell.gradient), p.cell.gradients = 2;
    for (int m = 0; m < 2; m++) {
        p.cell.gradient[m].t = 0.3 * m;
        for (int k = 0; k < 9; k++) p.cell.gradient[m].L[k / 3][k % 3] = uniform(-0.3, 0.3);
    }
    cell_set_rate(&p.cell, 0);
    p.cell.origin = v3(-0.2, 0.3, 0.7);
    struct cell_flow flow;
    cell_flow_init(&flow, &p.cell, p.cell.edge, p.cell.rate);
    for (int64_t i = 0; i < p.n; i++) {
        vec3 at = v3((double)(i % N), (double)(i / N % N), (double)(i / (N * N)));
        p.radius[i] = 0.05;
        p.x[i] = v3_axpy(p.cell.origin, 1.0 / N, v3_add(at, v3(0.4, 0.4, 0.4)));
        p.v[i] = cell_flow_gain(&flow, p.x[i]);
    }
    // and one that drifts through the cell while it lasts
    must(packing_copy(&q, &p, &failure), &failure);
    for (int64_t i = 0; i < q.n; i++) q.v[i] = v3_add(q.v[i], v3(3, 1, -2));
    run(&p, &s, &o, STEPS), run(&q, &s, &o, STEPS);
    double worst = 0, apart_most = 0;
    for (int64_t i = 0; i < p.n; i++) {
        const double at[3] = { (double)(i % N), (double)(i / N % N), (double)(i / (N * N)) };
        vec3 x = p.cell.origin;
        for (int k = 0; k < 3; k++) x = v3_axpy(x, (at[k] + 0.4) / N, p.cell.edge[k]);
        worst = fmax(worst, v3_norm(v3_sub(way(&p, i), x)));
        vec3 d = v3_sub(way(&q, i), way(&p, i)), d0 = v3_sub(way(&q, 0), way(&p, 0));
        apart_most = fmax(apart_most, v3_norm(v3_sub(d, d0)));
    }
    ok(worst < 1e-13 && s.n == 0, "a lattice in a cell that is deformed stays its lattice (%.1e m)",
       worst);
    ok(apart_most < 1e-12 && q.image[5][0] > 0,
       "and where it drifts across the border, too (%.1e m)", apart_most);
    contacts_free(&s), packing_free(&p), packing_free(&q);
}

/* Two balls side by side in a cell hardly wider than both meet twice, on either side. */
static void test_both_sides(void)
{
    struct failure failure = { 0 };
    struct packing p;
    struct contacts s = { 0 };
    struct step_opt o = sweeps(200);
    balls(&p, 2);
    p.cell.edge[0].x = 0.4 - 1e-5;
    p.x[0] = v3(0.1, 0.5, 0.5), p.x[1] = v3(0.3 - 0.5e-5, 0.5, 0.5);
    p.v[0] = v3(0, 0.2, 0), p.v[1] = v3(0, -0.2, 0);
    run(&p, &s, &o, 1);
    bool twice =
        s.n == 2 && s.c[0].b == 1 && s.c[1].b == 1 && s.c[0].shift[0] == -1 && s.c[1].shift[0] == 0;
    ok(twice, "two balls in a narrow cell touch on both sides (%lld contacts)", (long long)s.n);
    double sum = v3_norm(v3_add(p.v[0], p.v[1]));
    ok(sum < 1e-14, "and keep their momentum (%.1e)", sum);
    struct contacts next;
    must(contacts_copy(&next, &s), &failure);
    struct memory memory = { .on = true };
    for (int i = 0; i < 2; i++) s.found[i].r[0] = 1 + i;
    must(memory_keep(&memory, &s, &failure), &failure);
    must(memory_give(&memory, &next, false, &failure), &failure);
    ok(next.found[1].r[0] == 2 * next.found[0].r[0] && next.found[0].r[0] > 0,
       "the reactions of either side are found again");
    memory_free(&memory);
    contacts_free(&next);
    contacts_free(&s), packing_free(&p);
}

int main(void)
{
    rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(rng, 34);
    test_detection();
    test_bound();
    test_collision();
    test_shear_of_one();
    test_compression();
    test_lattice();
    test_both_sides();
    for (int dim = 2; dim <= 3; dim++) {
        test_cuts(dim, 0);
        test_cuts(dim, 0.5);
        test_neighbours(dim);
        test_back(dim);
        test_assembly(dim);
    }
    gsl_rng_free(rng);
    return tap_done();
}
