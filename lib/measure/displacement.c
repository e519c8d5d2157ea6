/* measure/displacement.c: how far bodies have come since the first frame. */
#include "measure/measures.h"

static const struct quantity quantities[] = {
    { "since", "s", 1, "time since the first frame" },
    { "bodies", "1", 1, "number of movable bodies that existed in the first frame" },
    { "msd", "m2", 1, "mean square displacement" },
    { "components", "m2", 3, "mean square displacement along each axis" },
    { "drift", "m", 3, "mean displacement" },
    { "about_drift", "m2", 1, "mean square displacement about the drift" },
    { "diffusion", "m2/s", 1,
      "diffusion coefficient: about_drift over twice the dimension and the time" },
    { "along", "m2/s", 3, "diffusion coefficient along each axis" },
    { 0 },
};

/* m: of body i since the first frame; false: it was not there */
static bool displacement(const struct snapshot *s, int64_t i, vec3 *d)
{
    const struct frame_memory_body *then =
        s->p->mass[i] > 0 && snapshot_body(s, i) ? frame_memory_find(s->first, s->p->id[i]) : NULL;
    if (then) *d = v3_sub(frame_memory_place(s->p, i), then->x);
    return then;
}

static int displacement_rows(struct table *t, const struct snapshot *s, struct failure *failure)
{
    double n = 0, square[3] = { 0, 0, 0 }, *at = table_row(t, failure);
    vec3 drift = v3(0, 0, 0), d;
    if (!at) return failure->status;
    for (int64_t i = 0; i < s->p->n; i++)
        if (displacement(s, i, &d)) {
            n++, drift = v3_add(drift, d);
            square[0] += d.x * d.x, square[1] += d.y * d.y, square[2] += d.z * d.z;
        }
    put(&at, s->p->t - s->first->t), put(&at, n);
    if (!(n > 0)) {
        table_null(t, "no body that moves was there in the first frame");
        return 0;
    }
    drift = v3_scale(1 / n, drift);
    double msd = (square[0] + square[1] + square[2]) / n;
    put(&at, msd);
    for (int k = 0; k < 3; k++) put(&at, square[k] / n);
    put_vec(&at, drift);
    double about[3] = { 0, 0, 0 }, since = s->p->t - s->first->t;
    for (int64_t i = 0; i < s->p->n; i++)
        if (displacement(s, i, &d)) {
            d = v3_sub(d, drift);
            about[0] += d.x * d.x, about[1] += d.y * d.y, about[2] += d.z * d.z;
        }
    const double all = (about[0] + about[1] + about[2]) / n;
    put(&at, all);
    if (!(since > 0)) {
        table_null(t, "no time has passed since the first frame");
        return 0;
    }
    put(&at, all / (2 * s->p->dim * since));
    for (int k = 0; k < 3; k++) put(&at, about[k] / n / (2 * since));
    return 0;
}

const struct measure measure_displacement = {
    .name = "displacement",
    .help = "mean square displacement since the first frame",
    .quantity = quantities,
    .keeps_to = KEEPS_TO_BODIES,
    .needs = NEEDS_BEFORE,
    .rows = displacement_rows,
};
