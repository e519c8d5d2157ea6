/* measure/temperature.c: how much bodies move beside their mean motion. */
#include "measure/measures.h"
#include "measure/stress.h"

static const struct quantity quantities[] = {
    { "bodies", "1", 1, "number of movable bodies with their centre in the region" },
    { "velocity", "m/s", 3, "mean velocity, weighted by mass" },
    { "spin", "rad/s", 3, "mean angular velocity, weighted by moment of inertia" },
    { "temperature", "m2/s2", 1, "mean square of a velocity component about the mean" },
    { "tensor", "m2/s2", 9, "mean of v' v'^T, weighted by mass" },
    { "rotational", "m2/s2", 1, "rotational temperature: sum I w'^2 over mass and number of axes" },
    { 0 },
};

static int temperature_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    struct moving m;
    double *at = table_row(t, failure);
    if (!at) return failure->status;
    moving_of(&m, s, &s->region);
    put(&at, (double)m.bodies);
    if (!m.bodies) {
        table_null(t, "no body that moves is in the region");
        return 0;
    }
    tensor_scale(&m.kinetic, 1 / m.mass);
    put_vec(&at, m.velocity), put_vec(&at, m.spin);
    put(&at, tensor_trace(&m.kinetic) / s->p->dim);
    put_tensor(&at, &m.kinetic);
    put(&at, m.rotation / m.mass / (s->p->dim == 2 ? 1 : 3));
    return 0;
}

const struct measure measure_temperature = {
    .name = "temperature",
    .help = "mean velocity, granular temperature",
    .quantity = quantities,
    .keeps_to = KEEPS_TO_BODIES,
    .usual = true,
    .rows = temperature_rows,
};
