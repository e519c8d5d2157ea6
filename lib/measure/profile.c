/* measure/profile.c: layers or shells: how full they are, how they move, their stress. */
#include "measure/ball_part.h"
#include "measure/measures.h"
#include "measure/stress.h"

static const struct quantity quantities[] = {
    { "from", "m", 1, "lower end of the layer, or inner radius of the shell" },
    { "to", "m", 1, "upper end, or outer radius" },
    { "at", "m", 1, "middle of the layer" },
    { "bodies", "1", 1, "number of movable bodies with their centre in the layer" },
    { "fraction", "1", 1, "solid volume over volume" },
    { "velocity", "m/s", 3, "mean velocity, weighted by mass" },
    { "spin", "rad/s", 3, "mean angular velocity, weighted by moment of inertia" },
    { "temperature", "m2/s2", 1,
      "granular temperature: mean square of a velocity component about the mean" },
    { "p", "Pa", 1, "mean pressure (2D: N/m)" },
    { "stress", "Pa", 9, "stress by contacts and motion, compression positive (2D: N/m)" },
    { 0 },
};

static double solid(const struct snapshot *s, const struct region *r)
{
    const struct packing *p = s->p;
    double sum = 0;
    for (int64_t i = 0; i < p->n; i++)
        if (snapshot_body(s, i)) sum += grain_fill(p, i) * region_ball(r, p->x[i], p->radius[i]);
    return sum;
}

/* The whole velocity: the flow that moving_of leaves out comes back, by the images in the layer. */
static vec3 velocity(const struct snapshot *s, const struct region *r, double mass)
{
    const struct packing *p = s->p;
    vec3 sum = v3(0, 0, 0);
    for (int64_t i = 0; i < p->n; i++)
        if (p->mass[i] > 0 && snapshot_body(s, i))
            sum = v3_axpy(sum, p->mass[i], region_velocities(r, p->x[i], p->v[i]));
    return v3_scale(1 / mass, sum);
}

static void profile_add_layer(struct table *t, const struct snapshot *s, const struct region *r,
                              double *at, const void *none)
{
    struct moving m;
    (void)none;
    moving_of(&m, s, r);
    put(&at, 0.5 * (at[-2] + at[-1])), put(&at, (double)m.bodies);
    put(&at, solid(s, r) / r->volume);
    if (m.bodies) {
        double *next = at;
        put_vec(&next, r->period.any ? velocity(s, r, m.mass) : m.velocity);
        put_vec(&next, m.spin), put(&next, tensor_trace(&m.kinetic) / s->p->dim / m.mass);
    } else {
        table_null(t, "layers without bodies have no velocity");
    }
    at += 7;
    if (s->only.bodies) {
        table_null(t, "no stress: contacts are not divided among groups of bodies");
        return;
    }
    if (!s->s || (!s->s->found && s->s->n)) {
        table_null(t, "no stress: the document has no solved contacts");
        return;
    }
    struct tensor T = stress_contacts(s, r);
    for (int k = 0; k < 9; k++) T.x[k / 3][k % 3] += m.kinetic.x[k / 3][k % 3];
    tensor_scale(&T, 1 / r->volume);
    put(&at, tensor_trace(&T) / s->p->dim), put_tensor(&at, &T);
}

static int profile_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    return snapshot_layers(s, t, profile_add_layer, NULL, failure);
}

const struct measure measure_profile = {
    .name = "profile",
    .help = "profiles by layer of fraction, velocity, temperature and stress",
    .quantity = quantities,
    .keeps_to = KEEPS_TO_BODIES,
    .list = true,
    .rows = profile_rows,
};
