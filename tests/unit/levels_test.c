/* tests/unit/levels_test.c: contacts by levels are visited as they are in their order, and by threads at once. */
#include "base/team.h"
#include "contact/detect.h"
#include "step/project.h"
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

/* Every contact is in one level, above those of all earlier contacts of its bodies and at most one above. */
static void test_levels(int64_t bodies, int64_t n)
{
    struct contacts s = { 0 };
    struct levels l;
    for (int64_t i = 0; i < n; i++) {
        int32_t b = (int32_t)gsl_rng_uniform_int(rng, (unsigned long)bodies);
        int32_t a = (int32_t)gsl_rng_uniform_int(rng, (unsigned long)bodies);
        if (!contacts_add(&s, a == b ? -1 : a, b)) exit(1);
    }
    int32_t *after = calloc((size_t)bodies, sizeof *after),
            *level = calloc((size_t)n, sizeof *level);
    bool *seen = calloc((size_t)n, sizeof *seen), good = !levels_init(&l, &s, bodies);
    for (int64_t k = 0; good && k < l.n; k++)
        for (int64_t j = l.first[k]; j < l.first[k + 1]; j++) {
            good = good && !seen[l.contact[j]];
            seen[l.contact[j]] = true, level[l.contact[j]] = (int32_t)k;
        }
    for (int64_t i = 0; good && i < n; i++) {
        const struct contact *c = &s.c[i];
        int32_t least = after[c->b];
        if (c->a >= 0 && after[c->a] > least) least = after[c->a];
        good = seen[i] && level[i] == least;
        after[c->b] = level[i] + 1;
        if (c->a >= 0) after[c->a] = level[i] + 1;
    }
    ok(good, "%lld contacts of %lld bodies: each is one level above the earlier ones of its bodies",
       (long long)n, (long long)bodies);
    free(after), free(level), free(seen);
    levels_free(&l), contacts_free(&s);
}

/* A cube of balls that overlap by up to a tenth, their rows in order or at random, on a floor */
static void cube(struct packing *p, int side, bool shuffled)
{
    struct failure failure = { 0 };
    int64_t n = (int64_t)side * side * side;
    must(packing_init(p, 3, n, &failure) || packing_alloc_walls(p, 1, &failure), &failure);
    p->dt = 1e-4, p->g = v3(0, 0, -9.81);
    p->wall[0] = (struct wall){ .n = v3(0, 0, 1) };
    for (int64_t i = 0; i < n; i++) {
        p->radius[i] = 0.45 + 0.1 * gsl_rng_uniform(rng), p->mass[i] = 1, p->inertia[i] = 0.1;
        p->q[i] = (quat){ 1, 0, 0, 0 };
        p->x[i] =
            v3((double)(i % side), (double)(i / side % side), 0.5 + (double)(i / side / side));
    }
    for (int64_t i = n - 1; shuffled && i > 0; i--) {
        int64_t j = (int64_t)gsl_rng_uniform_int(rng, (unsigned long)i + 1);
        vec3 x = p->x[i];
        p->x[i] = p->x[j], p->x[j] = x;
    }
}

static void test_threads(int side, bool shuffled)
{
    vec3 *one = NULL;
    bool same = true, moved = false;
    struct packing p;
    struct contacts s = { 0 };
    struct failure failure = { 0 };
    cube(&p, side, shuffled);
    must(detect_contacts(&s, &p, 1e-6, NULL, &failure), &failure);
    size_t size = (size_t)p.n * sizeof *p.x;
    vec3 *start = malloc(size);
    if (!start || !(one = malloc(size))) exit(1);
    memcpy(start, p.x, size);
    for (int threads = 1; threads <= 4; threads++) {
        memcpy(p.x, start, size);
        team_set_size(threads);
        must(project_apart(&p, &s, NULL, &failure), &failure);
        if (threads == 1) memcpy(one, p.x, size), moved = memcmp(one, start, size) != 0;
        same = same && !memcmp(one, p.x, size);
    }
    team_set_size(1);
    ok(moved && same, "%lld balls%s are moved apart to the same bits by 1 to 4 threads",
       (long long)p.n, shuffled ? " in any order" : "");
    free(start), free(one);
    contacts_free(&s), packing_free(&p);
}

int main(void)
{
    rng = gsl_rng_alloc(gsl_rng_mt19937);
    test_levels(1, 5), test_levels(3, 40), test_levels(1000, 6000), test_levels(6000, 1000);
    test_threads(8, false), test_threads(14, false), test_threads(14, true), test_threads(22, true);
    gsl_rng_free(rng);
    return tap_done();
}
