/* measure/each_grain.c: numbers of each body: its stress, its contacts, its speed. */
#include "measure/ball_part.h"
#include "measure/branch.h"
#include "measure/measures.h"

#include <math.h>
#include <stdlib.h>

static const struct quantity quantities[] = {
    { "id", "1", 1, "id of the body" },
    { "radius", "m", 1, "radius of the circumscribed ball" },
    { "x", "m", 3, "position" },
    { "speed", "m/s", 1, "magnitude of the velocity" },
    { "spin", "rad/s", 1, "magnitude of the angular velocity" },
    { "z", "1", 1, "number of contacts" },
    { "p", "Pa", 1, "mean pressure (2D: N/m)" },
    { "q", "Pa", 1, "deviator (2D: N/m)" },
    { "stress", "Pa", 9, "sum of force times vector from centre to contact, over the volume" },
    { 0 },
};

/* N m, [n]: each body's sum of f (x_contact - x)^T, compression positive */
static struct tensor *moments(const struct snapshot *s)
{
    struct tensor *T = calloc((size_t)s->p->n + 1, sizeof *T);
    for (int64_t i = 0; T && i < s->s->n; i++) {
        const struct contact *c = &s->s->c[i];
        vec3 f = branch_force(s->p, s->s, i);
        if (contact_shaped(s->p, c)) {
            tensor_add(&T[c->b], 1, f, branch_to_b(s->p, c));
            if (c->a >= 0) tensor_add(&T[c->a], 1, f, branch_from_a(s->p, c));
            continue;
        }
        tensor_add(&T[c->b], branch_b(s->p, c), f, c->n);
        if (c->a >= 0) tensor_add(&T[c->a], branch_a(s->p, c), f, c->n);
    }
    return T;
}

static void each_grain_fill(double *at, const struct packing *p, int64_t i, const int32_t *count,
                            struct tensor *T)
{
    put(&at, p->id[i]), put(&at, p->radius[i]), put_vec(&at, p->x[i]);
    put(&at, v3_norm(p->v[i])), put(&at, v3_norm(p->w[i]));
    put(&at, count ? count[i] : NAN);
    if (!T) return;
    tensor_scale(&T[i], 1 / grain_volume(p, i));
    put(&at, tensor_trace(&T[i]) / p->dim), put(&at, tensor_deviator(&T[i], p->dim));
    put_tensor(&at, &T[i]);
}

static int each_grain_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    bool solved = s->s && (s->s->found || !s->s->n);
    int32_t *count = s->s ? counts_of(s) : NULL;
    struct tensor *T = solved ? moments(s) : NULL;
    bool memory = (count || !s->s) && (T || !solved);
    if (!memory) failure_set(failure, EX_SOFTWARE, "no memory for numbers of bodies");
    if (!solved) table_null(t, "no stress: the document has no solved contacts");
    for (int64_t i = 0; memory && i < s->p->n; i++) {
        if (!snapshot_body(s, i) || !region_holds(&s->region, s->p->x[i])) continue;
        double *at = table_row(t, failure);
        if (!at) break;
        each_grain_fill(at, s->p, i, count, T);
    }
    free(count), free(T);
    return failure->status;
}

const struct measure measure_grains = {
    .name = "grains",
    .help = "stress, contacts and speed of each body",
    .quantity = quantities,
    .keeps_to = KEEPS_TO_BODIES,
    .list = true,
    .rows = each_grain_rows,
};
