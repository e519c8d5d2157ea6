#include "scene/scene_height.h"

#include "base/random.h"

/* Solid fractions that a random start reaches in a wide box [scene/random_start.h] */
static const double DENSE_DISCS = 0.82, DENSE_BALLS = 0.6;

double scene_lattice_height(const struct scene_bodies *b, int dim)
{
    struct scene_lattice l = scene_lattice(b, dim);
    double floor_cells = dim == 2 ? l.cells[0] : l.cells[0] * l.cells[1];
    double least = 2 * b->spacing * b->size.max;
    return floor_cells >= 1 ? ceil((double)b->count / floor_cells) * least : INFINITY;
}

double scene_random_height(int dim, double volume, double area)
{
    return volume / ((dim == 2 ? DENSE_DISCS : DENSE_BALLS) * area);
}

/* m^3, m^2: of the balls around the grains of a random start, in the order in which they are drawn */
static double drawn_volume(const struct scene *s, int64_t g)
{
    const struct scene_bodies *b = &s->bodies[g];
    gsl_rng *rng = counter_alloc();
    double sum = 0, mass, inertia;
    if (!rng) return NAN;
    counter_start(rng, s->seed, COUNTER_GROUP, (uint64_t)g, 0, 0);
    for (int64_t i = 0; i < b->count; i++) {
        packing_solid(s->dim, scene_size_draw(&b->size, rng), 1, &mass, &inertia);
        sum += mass;
    }
    gsl_rng_free(rng);
    return sum;
}

double scene_height(const struct scene *s, int64_t g, double *has)
{
    const struct scene_bodies *b = &s->bodies[g];
    double area = 1;
    int last = s->dim - 1;
    *has = b->box.hi[last] - b->box.lo[last];
    for (int k = 0; k < last; k++) area *= b->box.hi[k] - b->box.lo[k];
    if (b->from == SCENE_LATTICE) return scene_lattice_height(b, s->dim);
    if (b->from != SCENE_RANDOM || !(b->count > 0)) return NAN;
    return scene_random_height(s->dim, drawn_volume(s, g), area);
}
